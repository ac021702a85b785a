"""Scenarios: from TOML files to a validated system, its laws and its run settings."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
