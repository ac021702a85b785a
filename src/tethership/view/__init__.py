"""Plots: they draw the data they are given."""
