"""What a claim is, and how eigenvalues and root loci are read to judge one. Depends on: analysis."""

from typing import Any, NamedTuple

import numpy as np

from tethership.analysis.loci import Sweep
from tethership.analysis.modes import Complex, Mode, Modes, Real


class Claim(NamedTuple):
    """What became of a claim.

    Attributes
    ----------
    name : str
        L1 … L9, D1 … D11.
    statement : str
        What the paper says.
    parts : dict[str, bool]
        Each part and whether it holds.
    numbers : dict
        What was computed: eigenvalues as [re, im] [1/s].
    """

    name: str
    statement: str
    parts: dict[str, bool]
    numbers: dict[str, Any]

    @property
    def holds(self) -> bool:
        """Whether every part holds."""
        return all(self.parts.values())

    @property
    def verdict(self) -> str:
        """In words."""
        return "holds" if self.holds else "does not hold"


def pair(value: complex) -> list[float]:
    """Return a complex number, an eigenvalue [1/s], as [real, imaginary]."""
    return [float(value.real), float(value.imag)]


def listed(modes: Modes) -> dict[str, list[float]]:
    """Return every mode's eigenvalue [1/s] by name."""
    return {mode.name: pair(mode.eigenvalue) for mode in modes.modes}


def find_mode(modes: Modes, name: str) -> Mode | None:
    """Return the mode of exactly that name."""
    return next((mode for mode in modes.modes if mode.name == name), None)


def is_real(mode: Mode | None) -> bool:
    """Return whether there is the mode and it does not oscillate."""
    return mode is not None and not mode.oscillates


def growth(mode: Mode | None) -> float:
    """Return Re λ [1/s]; NaN where there is no such mode, of which nothing holds."""
    return float("nan") if mode is None else float(mode.eigenvalue.real)


def where_met(found: Sweep, kind: str, *tracks: str) -> float | None:
    """Return where two tracks do something together, or None.

    It is the value of the sweep's first parameter there, in SI: a diameter or a place [m], a wind [m/s].
    """
    for event in found.events:
        if event.kind == kind and (set(event.tracks) == set(tracks) or event.name in _joined(tracks)):
            return next(iter(event.at.values()))
    return None


def _joined(words: tuple[str, ...]) -> set[str]:
    """Return the names that a mode coalesced of these may have."""
    return {"–".join(words), "–".join(reversed(words))}


def ends(found: Sweep, *tracks: str) -> dict[str, list[list[float]]]:
    """Return first and last eigenvalue of modes, λ [1/s] as pairs, as `followed` finds them."""
    values = {name: followed(found, name) for name in tracks}
    return {name: [pair(value[0]), pair(value[-1])] for name, value in values.items()}


def followed(found: Sweep, name: str) -> Complex:
    """Return a mode's eigenvalues λ [1/s] along a sweep, complex, shape (points,); NaN where there is none.

    Notes
    -----
    Slow modes exchange their character where they pass each other (north and vertical, with large fins): the paper
    speaks of them by what they are, so they are named at each point. The others are followed.
    """
    if name in ("surge", "north", "east", "heading", "vertical"):
        value = found.named(name)
        return np.where(value.imag < 0, value.conjugate(), value)
    return found.track(name)


def rises(values: Real) -> bool:
    """Return whether numbers never fall and end higher than they began."""
    return bool(np.all(np.diff(values) > -1e-9) and values[-1] > values[0])


def falls(values: Real) -> bool:
    """Return whether numbers never rise and end lower than they began."""
    return rises(-values)
