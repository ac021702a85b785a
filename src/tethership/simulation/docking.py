"""The docking manoeuvre: from a trimmed point to a flight with its full input. Depends on: simulation, scenario."""

import platform
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Protocol

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._version import __version__
from tethership.control import AbstractLaw
from tethership.errors import ConfigError, SolveError
from tethership.plant import Command, State, TetheredAirship
from tethership.plant.balance import DRIFT_LIMIT, drift, left_over, residual, residual_limit
from tethership.results import store
from tethership.scenario import Scenario, ScenarioConfig, SolverConfig, read_solver
from tethership.scenario.load import from_document
from tethership.simulation.closed_loop import ClosedLoop
from tethership.simulation.events import StopConditions
from tethership.simulation.flight import Flight, Progress, fly
from tethership.simulation.header import stored_solver
from tethership.simulation.outcome import Outcome
from tethership.spatial import rotation_matrix


class Start(Protocol):
    """A trimmed point: what a flight starts from."""

    @property
    def state(self) -> State:
        """State of the ship at trim."""
        ...

    @property
    def command(self) -> Command:
        """Trimmed throttles and deflections."""
        ...


def start_state(scenario: Scenario, trimmed: State) -> State:
    """Return the state in which the flight begins: trim with its attitude moved.

    Parameters
    ----------
    scenario : Scenario
        Says by how much (`start.attitude_offset`) and which point stays in place (`start.hold`).
    trimmed : State
        State at trim.
    """
    return _moved(scenario.config.as_arrays(), scenario.system, trimmed)


def moved_start(config: ScenarioConfig, plant: TetheredAirship, trimmed: State) -> State:
    """Return `start_state` of a configuration and its plant; can be traced."""
    start = config.start
    held = plant.cables[0].tether_point if start.hold == "tether_point" and plant.cables else jnp.zeros(3)
    attitude = trimmed.attitude + jnp.asarray(start.attitude_offset)
    moved = (rotation_matrix(trimmed.attitude) - rotation_matrix(attitude)) @ held
    return State(trimmed.velocity, trimmed.rates, attitude, trimmed.position + moved)


_moved = eqx.filter_jit(moved_start)


def stop_conditions(scenario: Scenario) -> StopConditions:
    """Return what ends a flight of a scenario."""
    stop = scenario.config.stop
    return StopConditions(
        jnp.asarray(stop.cable_length),
        jnp.asarray(stop.largest_pitch),
        scenario.config.ground.anchor_height is not None,
    )


@eqx.filter_jit
def _begin(loop: ClosedLoop, stop: StopConditions, state: State) -> tuple[Array, Array]:
    """Return the integrator's vector at the start, and the margins there."""
    vector = loop.initial(state)
    return vector, stop.margins(loop, jnp.zeros(()), vector)


@eqx.filter_jit
def _balance(plant: TetheredAirship, state: State, command: Command) -> tuple[Array, Array]:
    """Return what a point leaves over in the mean air of a plant [N, N m], and the rates of what must stand still."""
    return residual(plant.in_mean_air(), state, command), drift(plant, state)


def _check_point(scenario: Scenario, point: Start) -> None:
    """Raise ConfigError where a point is no equilibrium of the scenario: trimmed for another one, say.

    Notes
    -----
    Ten times what a trim may leave: a stored or continued point may differ from one found anew by its rounding.
    """
    left, moving = (np.asarray(part) for part in _balance(scenario.system, point.state, point.command))
    limit = 10.0 * float(residual_limit(scenario.system))
    worst = max(np.abs(left).max() / limit, np.abs(moving).max() / (10.0 * DRIFT_LIMIT))
    if not worst <= 1.0:
        raise ConfigError(
            f"dock: the point is no equilibrium of this scenario: {left_over(left, moving, limit)} left over; was it "
            "trimmed for another wind or ship? Give trim(scenario) of the scenario that is flown"
        )


def _check_start(margins: Float[Array, "4"]) -> None:
    """Raise ConfigError where the flight would be over before it begins."""
    docked, broken, contact, pitch = np.asarray(margins)
    if broken <= 0:
        raise ConfigError(
            f"the start is beyond breaking: a cable is at {1 - broken:.2f} of its breaking force; lengthen the cable "
            "or lower trim.elongation or start.attitude_offset"
        )
    if docked <= 0:
        raise ConfigError("the start is docked already: cables.length must be above stop.cable_length")
    if contact <= 0:
        raise ConfigError(
            f"the start has the hull {-contact:.2f} m below ground: raise ground.anchor_height (a higher mast), or "
            "start higher (trim.elevation, trim.elongation, a smaller start.attitude_offset)"
        )
    if pitch <= 0:
        raise ConfigError("the start is beyond stop.largest_pitch; lower start.attitude_offset")


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
    """Fly the docking manoeuvre.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    point : Start
        From `trim`.
    layers : iterable of str, optional
        Of `rewind`, `heading`, `navigation`, instead of the scenario's own; `()` for none.
    sas : bool, optional
        SAS/attitude on or off instead of the scenario's own.
    solver : str or SolverConfig
        Packaged name, TOML path or settings.
    progress : callable, optional
        Called with the time reached [s].
    throw : bool
        Raise SolveError instead of returning a flight that diverged, ran out of steps or was interrupted.
    own_laws : mapping of str to AbstractLaw, optional
        Laws of one's own by name, added to the layers.

    Raises
    ------
    ConfigError
        A layer is not known, the point is no equilibrium of this scenario, or the start is over before it begins.
    """
    config = read_solver(solver) if isinstance(solver, str) else solver
    known = {"attitude", "rewind", "heading", "navigation"} & set(own_laws or {})
    if known:
        raise ConfigError(f"a law of one's own is named {known.pop()!r}, as one of the package; give it another name")
    names = scenario.layers if layers is None else tuple(layers)
    active = scenario.config.control.sas if sas is None else sas
    law = scenario.law(names, active).joined(own_laws or {})
    loop = ClosedLoop(scenario.system, law, point.command)
    stop = stop_conditions(scenario)
    _check_point(scenario, point)
    vector, margins = _begin(loop, stop, start_state(scenario, point.state))
    _check_start(margins)
    flown = fly(loop, vector, stop, config, scenario.config.stop.time_limit, progress)
    if throw and not flown.outcome.is_answer:
        raise SolveError(flown.outcome.value)
    attributes = {
        "outcome": flown.outcome.name,
        "steps": flown.steps,
        "layers": list(names),
        "own_laws": list(own_laws or {}),
        "sas": active,
        "formulation": scenario.formulation,
        "limits": scenario.config.watched_tensions(),
        "scenario_name": scenario.name,
        "scenario": scenario.document,
        "solver": config.model_dump(mode="json"),
        "trim": _point_numbers(point),
        "versions": _versions(),
    }
    return Flight(store.to_dataset(flown.arrays, _labels(scenario), attributes), flown.outcome)


def _labels(scenario: Scenario) -> dict[str, list[str]]:
    """Return the labels of thrusters, fins, cables and loads."""
    config = scenario.config
    cables = [cable.name for cable in config.cables]
    loads = ["gravity", "buoyancy", "apparent_mass", "envelope", "fins", "thrust"]
    return {
        "thruster": [thruster.name for thruster in config.vehicle.thrusters],
        "fin": [fin.name for fin in config.vehicle.fins],
        "cable": cables,
        "load": loads + [f"cable_{i + 1}" for i in range(len(cables))],
    }


def _point_numbers(point: Start) -> dict[str, Any]:
    """Return a trimmed point as plain numbers, which JSON keeps bit for bit."""
    return {
        "state": np.asarray(point.state.as_vector()).tolist(),
        "throttle": np.asarray(point.command.throttle).tolist(),
        "deflection": np.asarray(point.command.deflection).tolist(),
    }


def _versions() -> dict[str, str]:
    return {
        "tethership": __version__,
        "jax": jax.__version__,
        "diffrax": diffrax.__version__,
        "numpy": np.__version__,
        "python": platform.python_version(),
    }


class _StoredStart:
    """A trimmed point read from a flight file."""

    def __init__(self, numbers: dict[str, Any]) -> None:
        self.state = State.from_vector(jnp.asarray(numbers["state"]))
        self.command = Command(
            jnp.asarray(numbers["throttle"], dtype=float), jnp.asarray(numbers["deflection"], dtype=float)
        )


def fly_again(path: str | Path, progress: Progress | None = None) -> tuple[Scenario, Flight]:
    """Fly the stored input of a flight file again, to the same numbers.

    Parameters
    ----------
    path : str or Path
        A file that `Flight.save` wrote.
    progress : callable, optional
        As in `dock`.

    Raises
    ------
    ConfigError
        The file is no flight, of another version, or its input is not readable.
    """
    stored = Flight.load(path).attributes
    scenario = from_document(stored["scenario"], stored["scenario_name"])
    if stored["own_laws"]:
        raise ConfigError(
            f"{path} was flown with a law of one's own, which no file holds: {', '.join(stored['own_laws'])}"
        )
    config = stored_solver(stored["solver"], str(path))
    vehicle, trim = scenario.config.vehicle, stored["trim"]
    if (len(trim["throttle"]), len(trim["deflection"])) != (len(vehicle.thrusters), len(vehicle.fins)):
        raise ConfigError(f"{path}: its trim has not as many throttles and deflections as the ship; fly it again")
    start = _StoredStart(trim)
    return scenario, dock(scenario, start, stored["layers"], stored["sas"], config, progress)


__all__ = ["Outcome", "Start", "dock", "fly_again", "start_state"]
