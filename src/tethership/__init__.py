"""Flight dynamics, control and certification of tethered airships.

::

                 studies                                   one paper's whole study, with commands of its own
                     cli                                   commands
                  explorer                                 a local page: numbers are changed, views follow
                    view                                   plots: draws the data it is given
                  tuning                                   gains and designs over many flights
                  campaign                                 many flights, odds
          simulation  │   analysis                         one flight │ trim, linear model, modes, loci
                  scenario                                 TOML → plant + laws + run settings, validated
             plant    │   control                          the plant │ the laws
                   physics                                 one phenomenon per file
                   results                                 names, units and files of outputs; metrics on arrays
                   spatial                                 rotations, wrenches, constants

Imports point down only. Everything inside is SI and radians; body axes are nose, starboard, down; ground axes north,
east, down with the origin at the first anchor.

Importing this package imports neither JAX nor any of its rooms: each name brings what it needs when it is first used.
JAX, as soon as anything imports it, is switched to double precision and keeps what it compiles in the user's cache
folder (unless `JAX_COMPILATION_CACHE_DIR` is set); Equinox's run-time checks give NaN instead of raising (unless
`EQX_ON_ERROR` is set), whichever package was imported first: checks that raise are host callbacks, which would keep
programs out of that cache. What is not finite is found by this package itself and returned as an outcome.
"""

import pkgutil
from typing import Any

import tethership._interrupt  # noqa: F401 (acts on being imported, before what takes long)

# isort: split

import lazy_loader

from tethership._cache import checks_without_callbacks
from tethership._jax import set_up_once_imported

set_up_once_imported()
checks_without_callbacks()

_OFFERED = ("check_claims", "linear_figure", "plot_linear_figure")
"""Of the paper's study, which reaches the library by an entry point."""

_ours, _, _names = lazy_loader.attach_stub(__name__, __file__)

__all__ = sorted(  # pyright: ignore[reportUnsupportedDunderAll]
    set(_names) - {module.name for module in pkgutil.iter_modules(__path__)}
)


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: the command line then starts without what it does not need."""
    if name in _OFFERED:
        from tethership._studies import studied

        return studied(name)
    if name in _names:
        return _ours(name)
    raise AttributeError(f"module 'tethership' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_OFFERED])
