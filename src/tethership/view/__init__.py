"""Plots: they draw the data they are given."""

from tethership.view.docking import plot_docking

__all__ = ["plot_docking"]
