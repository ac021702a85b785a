"""Cables: the load on a cable, and two laws for its tension (`published`, `elastic_catenary`)."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
