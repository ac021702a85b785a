"""What the wind does about its mean: turbulence from a spectrum, or a measured history."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
