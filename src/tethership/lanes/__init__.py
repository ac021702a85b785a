"""Functions of one flight, compiled over lanes of flights by a C++ compiler."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
