"""The plant of parts: ship, air, cables, actuators, a law; named loads, all states and their derivative."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
