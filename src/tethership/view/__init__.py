"""Drawing: takes the data it is given, returns figures."""

import importlib
from typing import TYPE_CHECKING, Any

from tethership.view.docking import plot_docking
from tethership.view.loads import plot_loads
from tethership.view.replay import write_replay
from tethership.view.root_locus import plot_linear_figure, plot_root_locus

if TYPE_CHECKING:
    from tethership.view.campaign_plot import plot_campaign
    from tethership.view.interactive import interactive_root_locus
    from tethership.view.mode_shape import plot_modes

__all__ = [
    "interactive_root_locus",
    "plot_campaign",
    "plot_docking",
    "plot_linear_figure",
    "plot_loads",
    "plot_modes",
    "plot_root_locus",
    "write_replay",
]

_LATER = {"interactive_root_locus": "interactive", "plot_campaign": "campaign_plot", "plot_modes": "mode_shape"}


def __getattr__(name: str) -> Any:
    """Import plotly, campaigns and linear models only when their figures are asked for."""
    if name in _LATER:
        return getattr(importlib.import_module(f"tethership.view.{_LATER[name]}"), name)
    raise AttributeError(f"module 'tethership.view' has no attribute {name!r}")
