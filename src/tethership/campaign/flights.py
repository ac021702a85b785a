"""Flights of one scenario with other values of its parameters, trimmed and flown in batches.

Depends on: analysis (trim), simulation (flights), scenario. Every flight is what `trim` and `dock` do for its values,
with fixed steps; the batch is the last axis, and two batches fly side by side on two cores.
"""

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.loci import nearby_equilibrium
from tethership.analysis.trim import Question, ask, pose
from tethership.campaign.engine import Terms, find_engine, find_lanes
from tethership.errors import ConfigError
from tethership.plant import ClosedLoop
from tethership.scenario import (
    Scenario,
    ScenarioConfig,
    build_loop,
    build_system,
    find_parameter,
    list_parameters,
    with_values,
)
from tethership.simulation import STEP, Stop, beats_of, metrics_of, moved_start

BATCH = 168
"""Flights of one compiled call: fixed, so that every campaign runs the same program."""

FINER = 8
"""How many steps of a flight that is verified are made of one: the error of Runge–Kutta's rule falls by 4 000."""

FEW = 24
"""The same where there are no more than twice as many."""

SWITCHES = {
    "rewind": ("control.rewind.gain",),
    "heading": ("control.heading.gain",),
    "navigation": tuple(
        f"control.navigation.{name}" for name in ("position_gain", "vertical_gain", "speed_gain", "climb_gain")
    ),
}
"""Gains of each layer: with all of them zero it does nothing, so that one program flies every set of layers."""

Progress = Callable[[int, int], None]
"""Called with the number of flights flown and their total."""


class Cases(NamedTuple):
    """What differs from flight to flight.

    Attributes
    ----------
    names : tuple of str
        Dotted names of the parameters.
    values : ndarray
        Their values in SI, e.g. `wind.speed` [m/s] or an angle [rad], shape (flights, parameters).
    """

    names: tuple[str, ...]
    values: np.ndarray

    @classmethod
    def of(cls, columns: Mapping[str, np.ndarray | float], count: int) -> "Cases":
        """Return so many cases with these parameters, in SI as in `Cases`; a number is the same in all."""
        return cls((), np.zeros((count, 0))).with_columns(columns)

    def with_columns(self, columns: Mapping[str, np.ndarray | float]) -> "Cases":
        """Return the cases with more parameters, or the same ones replaced; columns of shape (flights,) or numbers."""
        kept = [i for i, name in enumerate(self.names) if name not in columns]
        added = [np.broadcast_to(value, len(self.values)) for value in columns.values()]
        values = np.column_stack([self.values[:, kept], *added])
        return Cases((*(self.names[i] for i in kept), *columns), values)


def layer_switches(scenario: Scenario, layers: Sequence[str]) -> dict[str, float]:
    """Return the gains that make a scenario's law act with these layers only, the others being zero.

    Parameters
    ----------
    scenario : Scenario
        Its own gains are those of the layers that act.
    layers : sequence of str
        Of `SWITCHES`.

    Returns
    -------
    dict[str, float]
        Dotted name → gain: of rewind [m/(s N)], heading [1/rad], navigation's places [1/m] and speeds [s/m].
    """
    known = list_parameters(scenario.config)
    return {name: known[name].value if layer in layers else 0.0 for layer, names in SWITCHES.items() for name in names}


@kept
def _prepared(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    values: Float[Array, "parameters flights"],
    start: Float[Array, "unknowns"],
) -> tuple[ClosedLoop, Array, Array]:
    """Return closed loops, starting vectors and what is left unbalanced, the flight last."""

    def one(value: Float[Array, "parameters"]) -> tuple[ClosedLoop, Array, Array]:
        here = with_values(config, places, value)
        plant = build_system(here)
        problem = pose(here, plant, question)
        found = nearby_equilibrium(problem, start)
        state, command = problem.unpack(found)
        loop = build_loop(here, plant, command)
        vector = loop.initial(moved_start(here.start, plant, state))
        return loop, vector, jnp.max(jnp.abs(problem.balance(found)))

    example = eqx.filter_eval_shape(one, jax.ShapeDtypeStruct(values.shape[:1], values.dtype))
    static = eqx.filter(example[0], lambda leaf: isinstance(leaf, jax.ShapeDtypeStruct), inverse=True)

    def arrays(value: Float[Array, "parameters"]) -> tuple[ClosedLoop, Array, Array]:
        loop, vector, left = one(value)
        return eqx.filter(loop, eqx.is_array), vector, left

    loops, vectors, left = jax.vmap(arrays, in_axes=-1, out_axes=-1)(values)
    return eqx.combine(loops, static), vectors, left


class Flyer:
    """Flies cases of one scenario, a batch at a time; every call with as many lanes runs the same program.

    Parameters
    ----------
    scenario : Scenario
        What all cases have in common; all its control layers act (see `layer_switches`).
    names : sequence of str
        Dotted names of what differs.
    example : ndarray
        Values [SI] of one case, shape (names,).
    lanes : int
        Flights of one call.
    step : float
        Length of a step h [s].
    unbreakable : bool
        Let a flight go on beyond the cable's breaking force, as a fit needs it.

    Raises
    ------
    ConfigError
        A parameter does not exist or is named twice.
    """

    def __init__(
        self,
        scenario: Scenario,
        names: Sequence[str],
        example: np.ndarray,
        lanes: int = BATCH,
        step: float = STEP,
        unbreakable: bool = False,
    ) -> None:
        known = list_parameters(scenario.config)
        _check_ticks(names)
        self._names, self._longest = tuple(names), step
        check_lags(scenario, step)
        scenario.check_trust()
        parameters = [find_parameter(known, name, scenario.name) for name in names]
        self._places = tuple(parameter.places for parameter in parameters)
        flat = [place for group in self._places for place in group]
        if len(set(flat)) != len(flat):
            raise ConfigError(f"two of {', '.join(names)} are the same number; name each once")
        config = scenario.config.as_arrays()
        self._config = _unbreakable(config) if unbreakable else config
        self._question = ask(scenario)
        self._start = jnp.zeros(len(self._question.unknowns.effort))
        self.terms = Terms(
            Stop.docking(scenario).conditions(),
            jnp.asarray(scenario.config.watched_tensions()),
            jnp.asarray(scenario.config.stop.time_limit),
            beats_of(step, scenario.config.control.period, scenario.config.control.delay),
        )
        self.lanes = lanes
        loops, vectors, _ = self.prepare(_probe(example, lanes))
        self._engine = find_engine(loops, vectors, self.terms)
        control = scenario.config.control
        self._fine = self.terms._replace(rhythm=beats_of(step / FINER, control.period, control.delay))

    def prepare(self, values: np.ndarray) -> tuple[ClosedLoop, Array, Array]:
        """Return loops, starts and what the trims left, for values of shape (lanes, names)."""
        return _prepared(self._config, self._places, self._question, jnp.asarray(values.T), self._start)

    def fly(self, values: np.ndarray, threads: int = 1) -> dict[str, np.ndarray]:
        """Return the metrics of at most `lanes` cases, values [SI] of shape (cases, names), as `fly_cases` does.

        Parameters
        ----------
        values : ndarray
        threads : int
            How many may fly them at once.

        Raises
        ------
        ConfigError
            A lag [s] among the values is too short for the step.
        """
        return self.fly_verified(values, (), threads)[0]

    def fly_verified(
        self, values: np.ndarray, verified: Sequence[int], threads: int = 1
    ) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray] | None]:
        """Return the metrics of `fly`, and those of some of the cases flown with steps of h/8.

        Parameters
        ----------
        values, threads
            As in `fly`.
        verified : sequence of int
            Which cases are flown again. Where there are no lanes, and XLA would fly a whole batch for them, None is
            returned in place of their metrics.
        """
        for name, column in zip(self._names, values.T, strict=True):
            if name.endswith(".lag"):
                _check_lag(name, float(column.min()), self._longest)
        count = len(values)
        padded = np.concatenate([values, np.repeat(values[-1:], self.lanes - count, axis=0)])
        loops, vectors, left = self.prepare(padded)
        result = self._engine(loops, vectors, threads)
        found = {**metrics_of(result), "unbalanced": np.asarray(left)}
        found = {name: array[:count] for name, array in found.items()}
        finely = find_lanes(loops, vectors, self._fine) if len(verified) else None
        if finely is None:
            return found, None
        chosen = np.asarray(verified)
        few, starts = jax.tree.map(
            lambda leaf: np.asarray(leaf)[..., chosen] if eqx.is_array(leaf) else leaf, (loops, vectors)
        )
        return found, metrics_of(finely(few, starts, threads))


def _check_ticks(names: Sequence[str]) -> None:
    """Raise ConfigError where the ticks of a sampled law differ between flights: a batch keeps one time for all."""
    for name in names:
        if name in ("control.period", "control.delay"):
            raise ConfigError(
                f"{name} cannot differ between the flights of a batch, which share their steps; fly a "
                "campaign for each value"
            )


def check_lags(scenario: Scenario, step: float) -> None:
    """Raise ConfigError where fixed steps h [s] cannot follow a lag of a scenario's actuators."""
    vehicle = scenario.config.vehicle
    for kind, rows in (("thrusters", vehicle.thrusters), ("fins", vehicle.fins)):
        for row in rows:
            if row.lag is not None:
                _check_lag(f"vehicle.{kind}.{row.name}.lag", row.lag, step)


def _check_lag(name: str, lag: float, step: float) -> None:
    """Raise ConfigError where a step h [s] is longer than twice a lag τ [s]: Runge–Kutta's rule fails at 2.8."""
    if lag < 0.5 * step:
        raise ConfigError(
            f"{name} = {lag:g} s is too short for the fixed steps of a batch, {step:g} s: give at least {0.5 * step:g} "
            "s, or leave it out (an ideal actuator)"
        )


def _probe(example: np.ndarray, lanes: int) -> np.ndarray:
    """Return cases that differ in every number: by a little, and by one, for a seed is a whole number."""
    probe = np.repeat(example[None], lanes, axis=0)
    probe[1::3] = 1.01 * probe[1::3] + 1e-3
    probe[2::3] += 1.0
    return probe


def fly_cases(
    scenario: Scenario,
    cases: Cases,
    step: float = STEP,
    progress: Progress | None = None,
    unbreakable: bool = False,
) -> dict[str, np.ndarray]:
    """Return the metrics of many flights.

    Parameters
    ----------
    scenario : Scenario
        What they have in common; all its control layers act (see `layer_switches`).
    cases : Cases
        What differs.
    step : float
        Length of a step h [s].
    progress : callable, optional
        Called after every batch.
    unbreakable : bool
        As in `Flyer`.

    Returns
    -------
    dict[str, ndarray]
        As `simulation.batch.metrics_of`, first axis the flight: tensions [N], times [s], angles [deg], clearance [m]
        (`campaign.store.UNITS`); `unbalanced` is the largest of what the trim left: in 1e-3 of the weight [-], what
        must stand still in 1e-3 rad/s and m/s.

    Raises
    ------
    ConfigError
        A parameter does not exist or is named twice.
    """
    count = len(cases.values)
    size = FEW if count <= 2 * FEW else BATCH
    flyer = Flyer(scenario, cases.names, cases.values[0], size, step, unbreakable)
    chunks = [cases.values[first : first + size] for first in range(0, count, size)]
    done = 0
    found: list[dict[str, np.ndarray]] = []
    with ThreadPoolExecutor(max_workers=min(2, os.cpu_count() or 1)) as pool:
        for result in pool.map(flyer.fly, chunks):
            found.append(result)
            done = min(done + size, count)
            if progress is not None:
                progress(done, count)
    return {name: np.concatenate([part[name] for part in found]) for name in found[0]}


def fly_blocks(scenario: Scenario, blocks: Sequence[Cases], unbreakable: bool = False) -> list[dict[str, np.ndarray]]:
    """Return the metrics of several blocks of cases that move the same parameters, all flown in one go.

    Parameters
    ----------
    scenario : Scenario
        As in `fly_cases`.
    blocks : sequence of Cases
        With the same names in the same order.
    unbreakable : bool
        As in `fly_cases`.

    Returns
    -------
    list of dict[str, ndarray]
        One for each block, as `fly_cases` returns it: tensions [N], times [s], angles [deg], clearance [m].
    """
    cases = Cases(blocks[0].names, np.concatenate([block.values for block in blocks]))
    flown = fly_cases(scenario, cases, unbreakable=unbreakable)
    ends = np.cumsum([len(block.values) for block in blocks])[:-1]
    split = {name: np.split(array, ends) for name, array in flown.items()}
    return [{name: parts[i] for name, parts in split.items()} for i in range(len(blocks))]


def _unbreakable(config: ScenarioConfig) -> ScenarioConfig:
    """Return a configuration whose cables do not break."""
    cables = tuple(cable.model_copy(update={"breaking_force": np.asarray(1e12)}) for cable in config.cables)
    return config.model_copy(update={"cables": cables})
