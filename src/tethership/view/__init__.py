"""Drawing: takes the data it is given, returns figures."""

import importlib
from typing import TYPE_CHECKING, Any

from tethership.view.flight.docking import plot_docking
from tethership.view.flight.loads import plot_loads
from tethership.view.linear.root_locus import plot_root_locus
from tethership.view.replay import write_replay

if TYPE_CHECKING:
    from tethership.view.campaign.plot import plot_campaign
    from tethership.view.linear.interactive_locus import interactive_root_locus
    from tethership.view.linear.mode_shape import plot_modes

__all__ = [
    "interactive_root_locus",
    "plot_campaign",
    "plot_docking",
    "plot_loads",
    "plot_modes",
    "plot_root_locus",
    "write_replay",
]

_LATER = {
    "interactive_root_locus": "linear.interactive_locus",
    "plot_campaign": "campaign.plot",
    "plot_modes": "linear.mode_shape",
}


def __getattr__(name: str) -> Any:
    """Import plotly, campaigns and linear models only when their figures are asked for."""
    if name in _LATER:
        return getattr(importlib.import_module(f"tethership.view.{_LATER[name]}"), name)
    raise AttributeError(f"module 'tethership.view' has no attribute {name!r}")
