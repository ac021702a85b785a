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

Importing this package switches JAX to double precision, turns on its persistent compilation cache in the user's
cache folder (unless `JAX_COMPILATION_CACHE_DIR` is set), and has Equinox's run-time checks give NaN
instead of raising (unless `EQX_ON_ERROR` is set), whichever package was imported first: checks that raise are host
callbacks, which would keep programs out of that cache. What is not finite is found by this package itself and returned
as an outcome.
"""

import importlib
from typing import TYPE_CHECKING, Any

import tethership._interrupt  # noqa: F401 (acts on being imported, before what takes long)

# isort: split

import jax

from tethership._cache import checks_without_callbacks, use_compilation_cache
from tethership._studies import studied
from tethership._version import __version__
from tethership.errors import ConfigError, SolveError, TethershipError, TethershipWarning

jax.config.update("jax_enable_x64", True)
use_compilation_cache()
checks_without_callbacks()

if TYPE_CHECKING:
    from tethership.analysis import (
        LinearModel,
        Modes,
        Sensitivities,
        Sweep,
        TrimOutcome,
        TrimPoint,
        linearize,
        sensitivities,
        sweep,
        trim,
    )
    from tethership.campaign import Campaign, open_results, run_campaign
    from tethership.control import AbstractLaw, Correction, Measurement, Request
    from tethership.plant import AbstractPart
    from tethership.scenario import Scenario, list_packaged, list_parameters, load_scenario, scenario_at
    from tethership.simulation import Flight, Outcome, Stop, dock, fly, fly_again
    from tethership.spatial import Wrench
    from tethership.view import (
        interactive_root_locus,
        plot_campaign,
        plot_docking,
        plot_loads,
        plot_modes,
        plot_root_locus,
        write_replay,
    )

_HOMES = {
    "AbstractLaw": "control",
    "AbstractPart": "plant",
    "Campaign": "campaign",
    "Correction": "control",
    "Flight": "simulation",
    "LinearModel": "analysis",
    "Measurement": "control",
    "Modes": "analysis",
    "Outcome": "simulation",
    "Request": "control",
    "Scenario": "scenario",
    "Stop": "simulation",
    "Sensitivities": "analysis",
    "Sweep": "analysis",
    "TrimOutcome": "analysis",
    "TrimPoint": "analysis",
    "Wrench": "spatial",
    "dock": "simulation",
    "fly": "simulation",
    "fly_again": "simulation",
    "interactive_root_locus": "view",
    "linearize": "analysis",
    "list_packaged": "scenario",
    "list_parameters": "scenario",
    "load_scenario": "scenario",
    "open_results": "campaign",
    "plot_campaign": "view",
    "plot_docking": "view",
    "plot_loads": "view",
    "plot_modes": "view",
    "plot_root_locus": "view",
    "run_campaign": "campaign",
    "scenario_at": "scenario",
    "sensitivities": "analysis",
    "sweep": "analysis",
    "trim": "analysis",
    "write_replay": "view",
}

_OFFERED = ("check_claims", "linear_figure", "plot_linear_figure")
"""Of the paper's study, which reaches the library by an entry point."""

_PARTS = (
    "analysis",
    "campaign",
    "control",
    "explorer",
    "physics",
    "results",
    "scenario",
    "simulation",
    "spatial",
    "studies",
    "tuning",
    "plant",
    "view",
)

__all__ = [
    "AbstractLaw",
    "AbstractPart",
    "Campaign",
    "ConfigError",
    "Correction",
    "Flight",
    "LinearModel",
    "Measurement",
    "Modes",
    "Outcome",
    "Request",
    "Scenario",
    "Sensitivities",
    "SolveError",
    "Stop",
    "Sweep",
    "TethershipError",
    "TethershipWarning",
    "TrimOutcome",
    "TrimPoint",
    "Wrench",
    "__version__",
    "dock",
    "fly",
    "fly_again",
    "interactive_root_locus",
    "linearize",
    "list_packaged",
    "list_parameters",
    "load_scenario",
    "open_results",
    "plot_campaign",
    "plot_docking",
    "plot_loads",
    "plot_modes",
    "plot_root_locus",
    "run_campaign",
    "scenario_at",
    "sensitivities",
    "sweep",
    "trim",
    "write_replay",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used: the command line then starts without what it does not need."""
    if name in _HOMES:
        return getattr(importlib.import_module(f"tethership.{_HOMES[name]}"), name)
    if name in _PARTS:
        return importlib.import_module(f"tethership.{name}")
    if name in _OFFERED:
        return studied(name)
    raise AttributeError(f"module 'tethership' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *_OFFERED])
