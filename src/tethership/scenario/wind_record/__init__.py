"""A measured wind's file: its columns, names, units, times and gaps, up to one record. Depends on: errors, xarray."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
