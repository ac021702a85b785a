"""A local web page that trims, sweeps and flies a scenario while its numbers are changed. Depends on: view, dash.

The web process shows pages and answers at once; one fresh process computes (`worker`), and every result carries the
request that it answers (`requests`), so that what is shown is never taken for something else.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
