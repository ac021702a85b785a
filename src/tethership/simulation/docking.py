"""The docking manoeuvre: a flight whose winches take in the cable until the ship is at its anchor.

Depends on: simulation.fly.
"""

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path

from tethership.control import AbstractLaw
from tethership.errors import ConfigError, TethershipWarning
from tethership.scenario import Scenario, SolverConfig, find_beside, from_document
from tethership.simulation.events import Stop
from tethership.simulation.flight import Flight
from tethership.simulation.fly import fly
from tethership.simulation.header import stored_solver
from tethership.simulation.segments import Progress
from tethership.simulation.start import Start, StoredStart, start_state

__all__ = ["Start", "dock", "fly_again", "start_state"]


def dock(
    scenario: Scenario,
    point: Start,
    layers: Iterable[str] | None = None,
    sas: bool | None = None,
    solver: str | SolverConfig = "adaptive",
    progress: Progress | None = None,
    throw: bool = False,
    own_laws: Mapping[str, AbstractLaw] | None = None,
) -> Flight:
    """Fly the docking manoeuvre: the winches take in cable until its unstretched length is `stop.cable_length` [m].

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    point, layers, sas, solver, progress, throw, own_laws
        As in `fly`.

    Raises
    ------
    ConfigError
        As `fly`.

    Warns
    -----
    TethershipWarning
        The ship has no cable: it flies on and cannot dock.
    """
    if not scenario.config.cables:
        warnings.warn(
            f"{scenario.name} has no cable, so it cannot dock; it is flown as fly() does",
            TethershipWarning,
            stacklevel=2,
        )
    return fly(
        scenario,
        point,
        stop=Stop.docking(scenario),
        layers=layers,
        sas=sas,
        own_laws=own_laws,
        rewind=True,
        solver=solver,
        progress=progress,
        throw=throw,
    )


def fly_again(path: str | Path, progress: Progress | None = None, trust: bool = False) -> tuple[Scenario, Flight]:
    """Fly the stored input of a flight file again, to the same numbers.

    Parameters
    ----------
    path : str or Path
        A file that `Flight.save` wrote.
    progress : callable, optional
        As in `dock`.
    trust : bool
        Let laws of one's own that its scenario names be run.

    Raises
    ------
    ConfigError
        The file is no flight, of another version, or its input is not readable.
    """
    stored = Flight.load(path).attributes
    if trust:
        find_beside(stored["scenario_name"])
    scenario = from_document(stored["scenario"], stored["scenario_name"], trusted=trust)
    if stored["own_laws"]:
        raise ConfigError(
            f"{path} was flown with a law of one's own, which no file holds: {', '.join(stored['own_laws'])}"
        )
    config = stored_solver(stored["solver"], str(path))
    vehicle, trim = scenario.config.vehicle, stored["trim"]
    if (len(trim["throttle"]), len(trim["deflection"])) != (len(vehicle.thrusters), len(vehicle.fins)):
        raise ConfigError(f"{path}: its trim has not as many throttles and deflections as the ship; fly it again")
    flown = stored.get("stop")
    stop = Stop.docking(scenario) if flown is None else Stop(**{k: v for k, v in flown.items() if k != "rewind"})
    flight = fly(
        scenario,
        StoredStart(trim),
        stop=stop,
        layers=stored["layers"],
        sas=stored["sas"],
        rewind=flown is None or flown["rewind"],
        solver=config,
        progress=progress,
    )
    return scenario, flight
