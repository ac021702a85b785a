"""Flight dynamics, control and certification of tethered airships.

::

                     cli                                   commands
                    view                                   plots: draws the data it is given
          simulation  │   analysis                         one flight │ trim
                  scenario                                 TOML → system + laws + run settings, validated
            system    │   control                          the plant │ the laws
                   physics                                 one phenomenon per file
                   results                                 names, units and files of outputs; metrics on arrays
                   spatial                                 rotations, wrenches, constants

Imports point down only. Everything inside is SI and radians; body axes are nose, starboard, down; ground axes north,
east, down with the origin at the first anchor.

Importing this package switches JAX to double precision, turns on its persistent compilation cache in the user's
cache folder (unless `JAX_COMPILATION_CACHE_DIR` is set), and, if Equinox is not imported yet, sets `EQX_ON_ERROR=nan`:
run-time checks are host callbacks, which would keep programs out of that cache. What is not finite is found by this
package itself and returned as an outcome.
"""

import importlib
import os
from typing import TYPE_CHECKING, Any

os.environ.setdefault("EQX_ON_ERROR", "nan")

import jax

from tethership._cache import use_compilation_cache
from tethership._version import __version__
from tethership.errors import ConfigError, SolveError, TethershipError

jax.config.update("jax_enable_x64", True)
use_compilation_cache()

if TYPE_CHECKING:
    from tethership.analysis import TrimOutcome, TrimPoint, trim
    from tethership.control import AbstractLaw, Correction, Measurement
    from tethership.scenario import Scenario, list_packaged, load_scenario
    from tethership.simulation import Flight, Outcome, dock, fly_again
    from tethership.view import plot_docking

_HOMES = {
    "AbstractLaw": "control",
    "Correction": "control",
    "Flight": "simulation",
    "Measurement": "control",
    "Outcome": "simulation",
    "Scenario": "scenario",
    "TrimOutcome": "analysis",
    "TrimPoint": "analysis",
    "dock": "simulation",
    "fly_again": "simulation",
    "list_packaged": "scenario",
    "load_scenario": "scenario",
    "plot_docking": "view",
    "trim": "analysis",
}

_PARTS = ("analysis", "control", "physics", "results", "scenario", "simulation", "spatial", "system", "view")

__all__ = [
    "AbstractLaw",
    "ConfigError",
    "Correction",
    "Flight",
    "Measurement",
    "Outcome",
    "Scenario",
    "SolveError",
    "TethershipError",
    "TrimOutcome",
    "TrimPoint",
    "__version__",
    "dock",
    "fly_again",
    "list_packaged",
    "load_scenario",
    "plot_docking",
    "trim",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: the command line then starts without what it does not need."""
    if name in _HOMES:
        return getattr(importlib.import_module(f"tethership.{_HOMES[name]}"), name)
    if name in _PARTS:
        return importlib.import_module(f"tethership.{name}")
    raise AttributeError(f"module 'tethership' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
