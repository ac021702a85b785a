"""Root loci and sensitivities: how trim and modes move with the numbers of a scenario."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
