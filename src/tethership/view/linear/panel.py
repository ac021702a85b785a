"""One plot of a root locus, as data: what is drawn, and how. Depends on: analysis."""

from typing import NamedTuple

from tethership.analysis.loci import Sweep
from tethership.analysis.modes import Modes


class Panel(NamedTuple):
    """One plot.

    Attributes
    ----------
    title : str
        What is varied.
    sweep : Sweep
        The root loci.
    parameter : str
        The parameter that colours them.
    star : int or None
        Point of the sweep that is the reference.
    free : Modes or None
        The untethered ship, drawn as circles.
    slow : bool
        Show only the slow modes, |λ| < 0.4 [1/s], as the paper's zooms do.
    """

    title: str
    sweep: Sweep
    parameter: str
    star: int | None
    free: Modes | None
    slow: bool
