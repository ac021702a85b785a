"""A flight replayed in a browser: one self-contained page with the ship in space and its histories."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
