"""The paper's study: its figures and claims, computed, drawn and reported.

Riboldi, Croce, Pagani, He, Bortolini, *Airship dynamics in a tethered docking maneuver*.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tethership.studies.docking_paper.claim import Claim
    from tethership.studies.docking_paper.linear_claims import CLAIMS, check_claims
    from tethership.studies.docking_paper.linear_figures import FIGURES, LinearFigure, linear_figure

__all__ = ["CLAIMS", "FIGURES", "Claim", "LinearFigure", "check_claims", "linear_figure"]

_HOMES = {
    "CLAIMS": "linear_claims",
    "Claim": "claim",
    "FIGURES": "linear_figures",
    "LinearFigure": "linear_figures",
    "check_claims": "linear_claims",
    "linear_figure": "linear_figures",
}


def __getattr__(name: str) -> Any:
    """Import a name when it is first used: the command starts without figures."""
    if name in _HOMES:
        return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
