"""Root loci: trim, linear model and modes along any parameters of a scenario, every mode followed by name.

Depends on: analysis.loci.continuation, analysis.loci.tracking, analysis.trim.trim, scenario.
"""

import dataclasses
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from tethership.analysis.linear.closed import states_kept
from tethership.analysis.linear.linearize import LOOPS
from tethership.analysis.loci.continuation import Batch, in_equilibrium, solve_points
from tethership.analysis.loci.grid import Axis, fill_lines, lay_grid, usual_places
from tethership.analysis.loci.locus_events import find_events, unstable_throughout
from tethership.analysis.loci.tracking import (
    Path,
    eigen_path,
    follow,
    matched,
    named_order,
    participation,
)
from tethership.analysis.modes.names import assign, mode_name, slots_of, track_names
from tethership.analysis.modes.spectrum import Complex
from tethership.analysis.trim.judgement import limits_passed
from tethership.analysis.trim.outcome import Points, TrimOutcome, outcomes
from tethership.analysis.trim.problem import Question, ask
from tethership.analysis.trim.trim import solved
from tethership.errors import ConfigError, TethershipError, suggestion
from tethership.plant import STATE_NAMES, Command, closed_loop, open_loop
from tethership.scenario import Parameter, Scenario, build_loop, find_parameter, list_parameters, scenario_at

FINE = 160
"""Points along a line between which eigenvectors are compared: coarser sweeps are filled up to as many."""


class Happening(NamedTuple):
    """An event of a sweep.

    Attributes
    ----------
    kind : str
        coalesce, split, cross, unstable, stable (see `locus_events.Event`).
    tracks : tuple of str
        Whose.
    name : str
        Name of the first of them by participation just behind, e.g. surge–north.
    at : dict[str, float]
        Parameters where it happens [SI].
    eigenvalue : complex
        λ there [1/s].
    """

    kind: str
    tracks: tuple[str, ...]
    name: str
    at: dict[str, float]
    eigenvalue: complex


@dataclasses.dataclass(frozen=True, eq=False)
class Sweep:
    """Root loci over a line or a grid of points; arrays have the points first, the last axis of the grid fastest.

    Attributes
    ----------
    scenario : Scenario
        What was swept.
    axes : tuple
        Names of the parameters moved together along each axis.
    units : dict[str, str]
        SI unit of each parameter.
    values : dict[str, ndarray]
        Each parameter at every point [SI].
    shape : tuple of int
        Number of points along each axis.
    tracks : tuple of str
        Names of the tracks, one for every eigenvalue, given where each line starts.
    eigenvalues : ndarray
        λ [1/s], complex, shape (points, tracks); NaN where there is no equilibrium (see `outcomes`).
    outcomes : tuple of TrimOutcome
        How each point's trim ended: points without one stay.
    states, throttle, deflection, tension, residual : ndarray
        The trims: twelve states [m/s, rad/s, rad, m], δ of thrusters [-] and fins [rad] (not clipped), tensions [N],
        force and moment left over [N, N m]; shapes (points, 12), (points, thrusters), (points, fins), (points, cables)
        and (points, 6).
    largest : ndarray
        Largest tension along each cable [N], shape (points, cables).
    clearance_hull : ndarray
        Height of the hull's lowest point above the ground [m], NaN without ground; shape (points,).
    clearance_cable : ndarray
        The same of the cables' lowest point [m], NaN without cables.
    matrices : ndarray
        A at every point [state unit/s per state unit], shape (points, states, states).
    path : Path
        Eigenvalues and eigenvectors (columns, comparable coordinates) at every point, in the solver's order.
    orders : ndarray of int
        Place in `path` of each track's eigenvalue, shape (points, tracks).
    events : tuple of Happening
        Coalescence, splits, crossings and passages of the imaginary axis.
    state_names : tuple of str
        Names of the states of the matrices: those of the ship, of actuators that lag, and in a closed loop of the laws.
    loop : str
        `open` or `closed`.
    """

    scenario: Scenario
    axes: tuple[tuple[str, ...], ...]
    units: dict[str, str]
    values: dict[str, np.ndarray]
    shape: tuple[int, ...]
    tracks: tuple[str, ...]
    eigenvalues: Complex
    outcomes: tuple[TrimOutcome, ...]
    states: np.ndarray
    throttle: np.ndarray
    deflection: np.ndarray
    tension: np.ndarray
    largest: np.ndarray
    residual: np.ndarray
    clearance_hull: np.ndarray
    clearance_cable: np.ndarray
    matrices: np.ndarray
    path: Path
    orders: np.ndarray
    events: tuple[Happening, ...]
    state_names: tuple[str, ...] = STATE_NAMES
    loop: str = "open"

    @property
    def trimmed(self) -> np.ndarray:
        """Which points are in equilibrium with the thrust there is."""
        return np.array([outcome is TrimOutcome.converged for outcome in self.outcomes])

    @property
    def unstable_throughout(self) -> tuple[str, ...]:
        """Tracks with Re λ [1/s] above rounding at every point in equilibrium, so that no event tells of them."""
        growing = unstable_throughout(self.eigenvalues, self.trimmed)
        return tuple(name for name, of in zip(self.tracks, growing, strict=True) if of)

    def track(self, name: str) -> Complex:
        """Return one track's eigenvalues [1/s]; NaN where the point cannot be trimmed with the thrust there is.

        Raises
        ------
        ConfigError
            There is no such track.
        """
        if name not in self.tracks:
            raise ConfigError(f"the sweep has no track {name!r}; it has {', '.join(self.tracks)}")
        return np.where(self.trimmed, self.eigenvalues[:, self.tracks.index(name)], np.nan)

    def names_at(self, point: int) -> tuple[str, ...]:
        """Return the name of each track's mode at a point, from participation there; empty where there is none."""
        if not self.path.valid[point]:
            return tuple("" for _ in self.tracks)
        return tuple(local_names(self.path, point, self.state_names)[place] for place in self.orders[point])

    def named(self, word: str) -> Complex:
        """Return λ [1/s] of the mode that is, or has coalesced with, `word`, by participation at each point.

        NaN where there is none. Unlike a track it changes over where two modes exchange their character.
        """
        found = np.full(len(self.outcomes), np.nan, dtype=np.complex128)
        for point in np.flatnonzero(self.trimmed):
            for place, name in enumerate(local_names(self.path, int(point), self.state_names)):
                if word == name or word in name.split("–"):
                    found[point] = self.path.values[point][place]
                    break
        return found

    def limits_passed(self, point: int) -> dict[str, float]:
        """Return tension over limit [-] of every watched limit that a point passes; nothing without an equilibrium."""
        if not self.path.valid[point]:
            return {}
        moved = any(name.startswith("limits.") or name.endswith(".breaking_force") for name in self.values)
        config = self.at(point).config if moved else self.scenario.config
        return limits_passed(config, self.tension[point], self.largest[point])

    def at(self, point: int) -> Scenario:
        """Return the scenario of one point, to be trimmed, linearised or flown."""
        return scenario_at(self.scenario, {name: float(values[point]) for name, values in self.values.items()})


def sweep(scenario: Scenario, *axes: Axis, loop: str = "open") -> Sweep:
    """Return trim, state matrix and named, followed modes along parameters of a scenario.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    *axes : mapping
        Each axis moves one parameter or several together: ``{"wind.speed": np.linspace(6, 12, 13)}``. More than one
        axis make a grid. Values in SI, speeds [m/s], angles [rad]; names as in the file (`cables.nose.length`,
        `vehicle.fins.*.area`).
    loop : str
        `open`, or `closed` with the scenario's laws: a sweep of a gain is then its root locus.

    Returns
    -------
    Sweep
        λ [1/s] of every track at every point, the trims, and the events between.

    Notes
    -----
    Trims start from the scenario's own (or that of an end of the sweep) and are continued along the parameters, all
    points in one compiled batch; where several equilibria exist, every line keeps to one branch, and points at which it
    has ended are `no_equilibrium`. Lines are filled with points in between until eigenvectors of neighbours are alike,
    so that modes are followed through crossings and coalescence; events are placed between those points.

    Raises
    ------
    ConfigError
        A parameter does not exist (nearest names offered), a range is empty, not finite or out of the file's bounds.
    """
    parameters, grid, shape = lay_grid(scenario, axes)
    fill = max(1, math.ceil(FINE / max(shape[-1] - 1, 1))) if shape[-1] > 1 else 1
    fine, per_line = fill_lines(grid, shape[-1], fill)
    question = ask(scenario)
    states = _states(scenario, loop)
    reference, start = _reference(scenario, parameters, grid, question)
    batch = solve_points(
        scenario.config.as_arrays(),
        [p.places for p in parameters],
        question,
        fine,
        reference,
        start,
        per_line,
        usual_places(scenario),
        loop == "closed",
    )
    path = _path(batch)
    orders, lines = _followed(path, per_line, shape[:-1], states)
    ordered = np.take_along_axis(path.values, orders, axis=1)
    names = [parameter.name for parameter in parameters]
    tracks = track_names(states)
    events = [event for line in lines for event in _happenings(path, orders, line, fine, names, tracks, states)]
    kept = np.concatenate([np.arange(line.start, line.stop, fill) for line in lines])
    valid = path.valid[kept]
    found = Batch(*(array[kept] for array in batch))
    return Sweep(
        scenario=scenario,
        axes=tuple(tuple(_full_name(scenario, name) for name in axis) for axis in axes),
        units={parameter.name: parameter.unit for parameter in parameters},
        values={name: grid[:, i] for i, name in enumerate(names)},
        shape=shape,
        tracks=tuple(tracks),
        eigenvalues=np.where(valid[:, None], ordered[kept], np.nan),
        outcomes=_outcomes(scenario, found, valid, question.height_sought),
        states=found.state,
        throttle=found.throttle,
        deflection=found.deflection,
        tension=found.tension,
        largest=found.largest,
        residual=found.residual,
        clearance_hull=found.hull if scenario.config.has_ground() else np.full(len(kept), np.nan),
        clearance_cable=found.cables.min(axis=1) if found.cables.shape[1] else np.full(len(kept), np.nan),
        matrices=found.matrix,
        path=Path(*(array[kept] for array in path)),
        orders=orders[kept],
        events=tuple(events),
        state_names=states,
        loop=loop,
    )


def _full_name(scenario: Scenario, name: str) -> str:
    return find_parameter(list_parameters(scenario.config), name, scenario.name).name


def _reference(
    scenario: Scenario, parameters: list[Parameter], grid: np.ndarray, question: Question
) -> tuple[np.ndarray, np.ndarray]:
    """Return parameters and unknowns of a known trim: the scenario's own, or that of an end or the middle."""
    names = [parameter.name for parameter in parameters]
    own = np.array([parameter.value for parameter in parameters])
    candidates = [own, grid[0], grid[-1], grid[len(grid) // 2]]
    start = np.zeros(len(question.unknowns.index))
    for values in candidates:
        try:
            here = scenario if values is own else scenario_at(scenario, dict(zip(names, values, strict=True)))
            unknowns, found = solved(here, question)
        except TethershipError:
            continue
        if found.outcome is not TrimOutcome.no_equilibrium:
            return values, unknowns
    return own, start


def _path(batch: Batch) -> Path:
    """Return the eigenvalues and eigenvectors of all points."""
    valid = in_equilibrium(batch)
    comparable = batch.comparable @ batch.matrix @ np.linalg.inv(batch.comparable)
    return eigen_path(comparable, valid)


def _states(scenario: Scenario, loop: str) -> tuple[str, ...]:
    """Return the names of the states of a loop; raises ConfigError for a loop that is not known, or sampled."""
    if loop not in LOOPS:
        raise ConfigError(f"sweep: unknown loop {loop!r}{suggestion(loop, LOOPS)} Allowed: {', '.join(LOOPS)}")
    if loop == "open":
        return open_loop(scenario.system).names
    if scenario.config.control.period is not None:
        raise ConfigError(
            "sweep: the laws are sampled (control.period), and loci are of continuous ones; leave control.period out, "
            "or ask modes --loop closed at each point"
        )
    scenario.check_trust()
    ship = scenario.system.ship
    none = Command(jnp.zeros(ship.thrusters.count), jnp.zeros(ship.fins.count))
    closed = build_loop(scenario.config, scenario.system, none)
    return tuple(closed_loop(closed).names[i] for i in states_kept(closed))


def _followed(
    path: Path, per_line: int, outer: tuple[int, ...], states: tuple[str, ...]
) -> tuple[np.ndarray, list[range]]:
    """Return the order of the eigenvalues at every point and the lines; every line continues the one before it."""
    slots = slots_of(states)
    orders = np.zeros((len(path.values), len(states)), dtype=int)
    lines = [range(first, first + per_line) for first in range(0, len(path.values), per_line)]
    starts: dict[tuple[int, ...], int] = {}
    for place, line in zip(np.ndindex(*outer) if outer else [()], lines, strict=True):
        valid = [i for i in line if path.valid[i]]
        if not valid:
            continue
        start = valid[0]
        order = _linked(path, orders, start, starts, place, states)
        starts[place] = start
        rows = slice(line.start, line.stop)
        orders[rows] = follow(path.part(rows), start - line.start, order, states, slots)
    return orders, lines


def _linked(
    path: Path,
    orders: np.ndarray,
    start: int,
    starts: dict[tuple[int, ...], int],
    place: tuple[int, ...],
    states: tuple[str, ...],
) -> np.ndarray:
    """Return the order where a line starts: matched to its neighbour's start, or by names on the first line."""
    for axis in reversed(range(len(place))):
        neighbour = (*place[:axis], place[axis] - 1, *place[axis + 1 :])
        if neighbour in starts:
            return matched(path, starts[neighbour], start, orders[starts[neighbour]])
    return named_order(path, start, states)


def _happenings(
    path: Path,
    orders: np.ndarray,
    line: range,
    fine: np.ndarray,
    names: list[str],
    tracks: list[str],
    states: tuple[str, ...],
) -> Iterator[Happening]:
    """Yield the events of one line with the parameters where they happen."""
    rows = slice(line.start, line.stop)
    ordered = np.take_along_axis(path.values[rows], orders[rows], axis=1)
    for event in find_events(ordered, path.valid[rows], tracks):
        before = min(int(event.position), len(line) - 2)
        share = event.position - before
        here = (1.0 - share) * fine[line.start + before] + share * fine[line.start + before + 1]
        behind = next(i for i in range(line.start + before + 1, line.stop) if path.valid[i])
        name = local_names(path, behind, states)[orders[behind][tracks.index(event.tracks[0])]]
        where = dict(zip(names, here.tolist(), strict=True))
        yield Happening(event.kind, event.tracks, name, where, event.eigenvalue)


def local_names(path: Path, point: int, states: Sequence[str] = STATE_NAMES) -> list[str]:
    """Return the name of every eigenvalue's mode at a valid point, from participation [-], in the path's order."""
    share, partner = participation(path, point), path.partners[point]
    slots, chosen = slots_of(states), assign(share, states, partner)
    names = []
    for place in range(len(partner)):
        pair = sorted({int(chosen[place]), int(chosen[partner[place]])})
        parts: dict[str, float] = {s: float(x) for s, x in zip(states, share[:, place], strict=True)}
        names.append(mode_name(slots[pair[0]], slots[pair[1]] if len(pair) > 1 else None, parts))
    return names


def _outcomes(scenario: Scenario, found: Batch, valid: np.ndarray, height_sought: bool) -> tuple[TrimOutcome, ...]:
    """Return how each point's trim ended; one that is not on its line's branch has no equilibrium."""
    allowed = jax.vmap(scenario.system.ship.allowed)(
        Command(jnp.asarray(found.throttle), jnp.asarray(found.deflection))
    )
    over = (np.asarray(allowed.throttle) != found.throttle).any(axis=1)
    over |= (np.asarray(allowed.deflection) != found.deflection).any(axis=1)
    points = Points(found.residual, found.drift, found.hull, found.cables)
    return tuple(
        outcomes(points, over, np.where(valid, found.limit, -1.0), scenario.config.has_ground(), height_sought)
    )
