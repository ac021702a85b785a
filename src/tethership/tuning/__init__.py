"""Fits: the paper's unpublished parameters, and control gains."""
