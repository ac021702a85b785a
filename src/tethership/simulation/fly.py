"""Flying: any scenario, any law, until something ends it. Depends on: simulation, scenario."""

import dataclasses
import importlib.metadata
import platform
from collections.abc import Iterable, Mapping

import jax
import numpy as np

from tethership._version import __version__
from tethership.control import AbstractLaw, LayeredLaw
from tethership.errors import ConfigError, SolveError
from tethership.plant import TetheredAirship, load_names, part_layout, reading_names
from tethership.results import store
from tethership.scenario import LAWS, Scenario, SolverConfig, build_loop, read_solver
from tethership.simulation.events import Stop
from tethership.simulation.flight import Flight
from tethership.simulation.segments import Progress, integrate
from tethership.simulation.start import Start, begin, check_point, check_start, point_numbers, start_state


def fly(
    scenario: Scenario,
    point: Start,
    law: AbstractLaw | None = None,
    stop: Stop | float | None = None,
    *,
    layers: Iterable[str] | None = None,
    sas: bool | None = None,
    own_laws: Mapping[str, AbstractLaw] | None = None,
    rewind: bool = False,
    solver: str | SolverConfig = "adaptive",
    progress: Progress | None = None,
    throw: bool = False,
) -> Flight:
    """Fly a scenario from a trimmed point until something ends the flight.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    point : Start
        From `trim` of that scenario.
    law : AbstractLaw, optional
        Instead of the scenario's layers and SAS.
    stop : Stop or float, optional
        What ends the flight, or for how long to fly [s]; the scenario's time limit if not given. The cable's break, the
        ground (where its height is given) and a vertical pitch end it in any case.
    layers : iterable of str, optional
        Of `rewind`, `heading`, `navigation`, instead of the scenario's own; `()` for none.
    sas : bool, optional
        SAS/attitude on or off instead of the scenario's own.
    own_laws : mapping of str to AbstractLaw, optional
        Laws of one's own by name, added to the layers.
    rewind : bool
        Let the winches take in cable at their default rate, as `dock` does; else they hold, but for what laws ask.
    solver : str or SolverConfig
        Packaged name, TOML path or settings.
    progress : callable, optional
        Called with the time reached [s].
    throw : bool
        Raise SolveError instead of returning a flight that diverged, ran out of steps or was interrupted.

    Raises
    ------
    ConfigError
        A layer is not known, the point is no equilibrium of this scenario, or the start is over before it begins.

    Examples
    --------
    >>> import tethership as ts
    >>> scenario = ts.load_scenario("hover")
    >>> flight = ts.fly(scenario, ts.trim(scenario), stop=2.0)
    >>> flight.outcome.name
    'time_limit'
    """
    config = read_solver(solver) if isinstance(solver, str) else solver
    acting, names, active = _law(scenario, law, layers, sas, own_laws or {})
    ends = Stop.of(scenario, stop)
    try:
        scenario.config.control.check_period(ends.time_limit, "")
    except ValueError as error:
        raise ConfigError(str(error)) from error
    check_point(scenario, point)
    plant = scenario.system if rewind else scenario.system.with_winches_held()
    loop = build_loop(scenario.config, plant.with_a_gust(), point.command, acting)
    conditions = ends.conditions()
    vector, margins = begin(loop, conditions, start_state(scenario, point.state))
    check_start(margins)
    flown = integrate(loop, vector, conditions, config, ends.time_limit, progress)
    if throw and not flown.outcome.is_answer:
        raise SolveError(flown.outcome.value)
    attributes = {
        "outcome": flown.outcome.name,
        "steps": flown.steps,
        "layers": list(names),
        "own_laws": ["law"] if law is not None else list(own_laws or {}),
        "sas": active,
        "formulation": scenario.formulation,
        "line": scenario.config.line_models(),
        "limits": scenario.config.watched_tensions(),
        "scenario_name": scenario.name,
        "scenario": scenario.document,
        "solver": config.model_dump(mode="json"),
        "stop": {**dataclasses.asdict(ends), "rewind": rewind},
        "trim": point_numbers(point),
        "versions": _versions(),
    }
    return Flight(store.to_dataset(flown.arrays, _labels(plant), attributes), flown.outcome)


def _law(
    scenario: Scenario,
    law: AbstractLaw | None,
    layers: Iterable[str] | None,
    sas: bool | None,
    own: Mapping[str, AbstractLaw],
) -> tuple[AbstractLaw, tuple[str, ...], bool]:
    """Return the law that acts, the names of its layers, and whether SAS is among it."""
    if law is not None:
        if layers is not None or sas is not None or own:
            raise ConfigError("fly: a law is given, and layers, sas or own_laws too; give the law alone, or only those")
        return law, (), False
    taken = {*LAWS, *(law.name for law in scenario.config.control.laws)} & set(own)
    if taken:
        raise ConfigError(
            f"a law of one's own is named {taken.pop()!r}, as one of the package or the file; give it another name"
        )
    names = scenario.layers if layers is None else tuple(layers)
    active = scenario.config.control.sas if sas is None else sas
    layered: LayeredLaw = scenario.law(names, active, switched=True)
    return layered.joined(own), names, active


def _labels(plant: TetheredAirship) -> dict[str, list[str]]:
    """Return the labels of thrusters, fins, cables and loads, as the plant's parts name them."""
    names = plant.part_names
    return {
        "thruster": list(names.thrusters),
        "fin": list(names.fins),
        "cable": list(names.cables),
        "load": list(load_names(plant)),
        "part_state": list(part_layout(plant).names),
        "reading": list(reading_names(plant)),
    }


def _versions() -> dict[str, str]:
    return {
        "tethership": __version__,
        "jax": jax.__version__,
        "diffrax": importlib.metadata.version("diffrax"),
        "numpy": np.__version__,
        "python": platform.python_version(),
    }
