"""Integration of a whole flight, segment by segment, until something ends it. Depends on: simulation."""

import dataclasses
from collections.abc import Callable

import jax
import numpy as np
from jaxtyping import Array, Float

from tethership.plant import ClosedLoop
from tethership.scenario import SolverConfig
from tethership.simulation.events import MARGINS, StopConditions
from tethership.simulation.integrate import SAMPLES, Segment, Stepping, fly_segment
from tethership.simulation.interrupt import Interruption
from tethership.simulation.outcome import Outcome
from tethership.simulation.ticks import INTERVALS, fly_ticks, ticks

Progress = Callable[[float], None]
"""Called with the time reached [s] after each segment."""


@dataclasses.dataclass(frozen=True)
class Flown:
    """Raw samples of a flight.

    Attributes
    ----------
    arrays : dict
        Outputs by the names and in the units of `results.schema`, first axis time, `time` [s] included.
    outcome : Outcome
    steps : int
        Steps of the integrator.
    """

    arrays: dict[str, np.ndarray]
    outcome: Outcome
    steps: int


def integrate(
    loop: ClosedLoop,
    vector: Float[Array, "n"],
    stop: StopConditions,
    solver: SolverConfig,
    time_limit: float,
    progress: Progress | None = None,
) -> Flown:
    """Fly until something ends the flight; never raises for what nature or the solver does.

    Parameters
    ----------
    loop : ClosedLoop
        Plant, law and trimmed command.
    vector : Float[Array, "n"]
        Start, from `ClosedLoop.initial`.
    stop : StopConditions
        What ends it.
    solver : SolverConfig
        Settings.
    time_limit : float
        Longest flight [s].
    progress : callable, optional
        Called with the time reached.
    """
    onward = (_Smooth if loop.sampling is None else _Ticking)(loop, stop, solver, time_limit)
    pieces: list[dict[str, np.ndarray]] = []
    time, done, steps, outcome = 0.0, 0, 0, None
    if progress is not None:  # compile first, so that the time of flying can be shown apart
        onward.compile(vector)
        progress(0.0)
    with Interruption() as interruption:
        while outcome is None:
            segment = onward.fly(time, done, vector)
            kept = _kept(segment)
            pieces.append(kept)
            done += len(kept["time"])
            time, vector = float(segment.time), segment.vector
            steps += int(segment.steps)
            outcome = _outcome(segment, time, time_limit, steps, solver.most_steps, interruption.raised)
            if progress is not None:
                progress(time)
            if outcome is not None and outcome is not Outcome.diverged:
                pieces.append(_end(segment, pieces))
    arrays = {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}
    return Flown(arrays, outcome, steps)


class _Smooth:
    """Segments of a flight under a continuous law."""

    def __init__(self, loop: ClosedLoop, stop: StopConditions, solver: SolverConfig, time_limit: float) -> None:
        self._fixed = loop, stop, Stepping.from_config(solver)
        self._interval, self._limit = solver.output_interval, time_limit

    def compile(self, vector: Array) -> None:
        """Have the program ready."""
        nowhere = np.asarray(0.0), vector, np.asarray(1e-6), np.zeros(SAMPLES)
        jax.block_until_ready(fly_segment(*self._fixed, *nowhere))

    def fly(self, time: float, done: int, vector: Array) -> Segment:
        """Fly on from a time [s] until which so many samples were kept."""
        times = (done + np.arange(SAMPLES)) * self._interval
        end = min(float(times[-1]), self._limit)
        segment = fly_segment(*self._fixed, np.asarray(time), vector, np.asarray(end), times)
        return jax.device_get(segment)


class _Ticking:
    """Segments of a flight under a sampled law: whole intervals between its ticks."""

    def __init__(self, loop: ClosedLoop, stop: StopConditions, solver: SolverConfig, time_limit: float) -> None:
        assert loop.sampling is not None
        delay = loop.sampling.delay
        self._fixed = loop, stop, Stepping.from_config(solver)
        self._ticks = float(loop.sampling.period), None if delay is None else float(delay)
        self._interval, self._limit, self._flown = solver.output_interval, time_limit, 0

    def compile(self, vector: Array) -> None:
        """Have the program ready."""
        fly_ticks(*self._fixed, vector, ticks(*self._ticks, 0, 0.0, self._interval))

    def fly(self, time: float, done: int, vector: Array) -> Segment:
        """Fly on from the last tick; arguments as in `_Smooth.fly`."""
        del time, done
        segment = fly_ticks(*self._fixed, vector, ticks(*self._ticks, self._flown, self._limit, self._interval))
        self._flown += INTERVALS
        return segment


def _kept(segment: Segment) -> dict[str, np.ndarray]:
    """Return the samples up to the time reached, and up to the last finite one."""
    times = np.asarray(segment.sample_times)
    within = times <= float(segment.time) + 1e-12
    finite = np.ones(len(times), dtype=bool)
    for name, value in segment.samples.items():
        if name != "cable_curve":
            finite &= np.isfinite(np.asarray(value).reshape(len(times), -1)).all(axis=1)
    count = int(np.argmin(within & finite)) if not (within & finite).all() else len(times)
    return {"time": times[:count], **{k: np.asarray(v)[:count] for k, v in segment.samples.items()}}


def _end(segment: Segment, pieces: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the sample at the very end, empty if a regular sample stands there already."""
    last_time = next((piece["time"][-1] for piece in reversed(pieces) if len(piece["time"])), -1.0)
    count = int(float(segment.time) > last_time + 1e-9)
    single = {"time": np.asarray(segment.time), **segment.last}
    return {name: np.asarray(value)[None][:count] for name, value in single.items()}


def _outcome(
    segment: Segment, time: float, time_limit: float, steps: int, most_steps: int, interrupted: bool
) -> Outcome | None:
    """Return why the flight ends here, or None."""
    if not bool(segment.finite):
        return Outcome.diverged
    if bool(segment.stopped):
        return MARGINS[int(np.argmin(np.asarray(segment.margins)))]
    if time >= time_limit - 1e-9:
        return Outcome.time_limit
    if interrupted:
        return Outcome.interrupted
    if steps >= most_steps:
        return Outcome.step_limit
    return None
