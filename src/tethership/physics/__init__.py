"""One phenomenon per file: equation, unit, axes and source in the file's docstring.

A physics module never imports another physics module; what composes them lives in `tethership.plant`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
