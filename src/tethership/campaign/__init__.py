"""Many flights of one scenario, each with its own values of some parameters; campaigns over distributions of them."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
