"""Drawing: takes the data it is given, returns figures."""

from typing import TYPE_CHECKING, Any

from tethership.view.docking import plot_docking
from tethership.view.root_locus import plot_linear_figure, plot_root_locus

if TYPE_CHECKING:
    from tethership.view.interactive import interactive_root_locus

__all__ = ["interactive_root_locus", "plot_docking", "plot_linear_figure", "plot_root_locus"]


def __getattr__(name: str) -> Any:
    """Import plotly only when an interactive figure is asked for."""
    if name == "interactive_root_locus":
        from tethership.view.interactive import interactive_root_locus

        return interactive_root_locus
    raise AttributeError(f"module 'tethership.view' has no attribute {name!r}")
