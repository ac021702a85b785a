"""One phenomenon per file: equation, unit, axes and source in the file's docstring.

A physics module never imports another physics module; what composes them lives in `tethership.plant`.
"""
