"""Integration under a sampled law: from tick to tick, each interval as any other segment. Depends on: simulation.

At a tick the law looks or acts, and what it holds jumps; between ticks nothing does. One call flies many intervals, so
that a flight of a thousand ticks is a handful of calls of one program.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from tethership._kept import kept
from tethership.plant import ClosedLoop
from tethership.simulation.events import StopConditions
from tethership.simulation.integrate import Segment, Stepping, least_traced, solved
from tethership.simulation.record import record

INTERVALS = 128
"""Intervals between ticks in one call."""


class Ticks(NamedTuple):
    """The intervals of one call.

    Attributes
    ----------
    start, end : ndarray
        Of each interval [s], shape (intervals,); those beyond the end of the flight are empty.
    looks, acts : ndarray of bool
        What the law does at the start of each; where it does both, it acts first.
    samples : int
        Samples at most in an interval.
    """

    start: np.ndarray
    end: np.ndarray
    looks: np.ndarray
    acts: np.ndarray
    samples: int


def ticks(period: float, delay: float | None, first: int, limit: float, interval: float) -> Ticks:
    """Return the intervals of a call.

    Parameters
    ----------
    period, delay : float
        T and d [s].
    first : int
        Number of the first interval, counted from t = 0.
    limit : float
        End of the flight [s].
    interval : float
        Between samples [s].
    """
    inside = delay is not None and delay < period
    count = np.arange(first, first + INTERVALS + 1)
    times = (count // 2) * period + (count % 2) * delay if inside and delay is not None else count * period
    times = np.minimum(times.astype(float), limit)
    even = count[:-1] % 2 == 0
    looks = even if inside else np.ones(INTERVALS, dtype=bool)
    acts = ~even if inside else np.full(INTERVALS, delay is not None)
    longest = max(delay, period - delay) if inside and delay is not None else period
    return Ticks(times[:-1], times[1:], looks, acts, int(np.ceil(longest / interval)) + 1)


class _Carry(NamedTuple):
    """What goes from one interval to the next."""

    time: Float[Array, ""]
    vector: Float[Array, "n"]
    stopped: Bool[Array, ""]
    whole: Bool[Array, ""]
    steps: Array


@kept
def _fly(
    loop: ClosedLoop,
    stop: StopConditions,
    stepping: Stepping,
    vector: Float[Array, "n"],
    edges: tuple[Array, Array, Array, Array],
    samples: int,
) -> tuple[_Carry, Array, Array, dict[str, Array], Array, dict[str, Array]]:
    """Return the end, times, whether each is a sample, outputs, margins and outputs at the end."""
    field, margin = least_traced(loop, stop, edges[0][0], vector)
    every = stepping.output_interval

    def interval(carry: _Carry, edge: tuple[Array, ...]) -> tuple[_Carry, tuple[Array, Array, dict[str, Array]]]:
        start, end, looks, acts = edge
        over = carry.stopped | ~carry.whole | (end <= start)
        begun = carry.vector
        if loop.sampling is not None and loop.sampling.delay is not None:
            begun = jnp.where(acts & ~over, loop.act(begun), begun)
        begun = jnp.where(looks & ~over, loop.look(start, begun), begun)
        times = (jnp.ceil(start / every - 1e-9) + jnp.arange(samples)) * every

        def flown() -> tuple[Array, Array, Array, Array, Array, Array]:
            solution = solved(field, margin, stepping, loop.plant.environment.corner_times(), start, begun, end)
            at = jax.vmap(lambda t: solution.evaluate(jnp.clip(t, start, solution.reached)))(times)
            at = jnp.where((times <= start)[:, None], begun, at)
            whole = solution.stopped | (solution.reached >= end - 1e-12)
            return solution.reached, solution.final, solution.stopped, whole, solution.steps, at

        def left() -> tuple[Array, Array, Array, Array, Array, Array]:
            none = jnp.zeros_like(carry.steps)
            return carry.time, begun, carry.stopped, carry.whole, none, jnp.broadcast_to(begun, (samples, len(begun)))

        reached, final, stopped, whole, steps, at = jax.lax.cond(over, left, flown)
        inside = ~over & (times < end - 1e-9) & (times <= reached + 1e-12)
        outputs = jax.vmap(lambda t, y: record(loop, t, y))(times, at)
        return _Carry(reached, final, stopped, whole, carry.steps + steps), (times, inside, outputs)

    no = jnp.zeros((), dtype=bool)
    begin = _Carry(edges[0][0], vector, no, ~no, jnp.zeros((), dtype=int))
    carry, (times, inside, outputs) = jax.lax.scan(interval, begin, edges)
    margins = stop.margins(loop, carry.time, carry.vector)
    return carry, times, inside, outputs, margins, record(loop, carry.time, carry.vector)


def fly_ticks(
    loop: ClosedLoop, stop: StopConditions, stepping: Stepping, vector: Float[Array, "n"], intervals: Ticks
) -> Segment:
    """Fly from tick to tick, or until a stop condition; other arguments as in `integrate.fly_segment`.

    Parameters
    ----------
    loop : ClosedLoop
        With a sampled law.
    stop, stepping
        What ends the flight, and how it is integrated.
    vector : Float[Array, "n"]
        All states at the first interval's start, before the law looks or acts there.
    intervals : Ticks
        From `ticks`, starts and ends [s].

    Returns
    -------
    Segment
        Time reached [s] and the vector there; samples at whole multiples of the output interval [s]. One that stops
        before its interval's end without a stop condition (steps used up) is told as not finite.
    """
    start, end, looks, acts = intervals[:4]
    edges = jnp.asarray(start), jnp.asarray(end), jnp.asarray(looks), jnp.asarray(acts)
    found = jax.device_get(_fly(loop, stop, stepping, vector, edges, intervals.samples))
    carry, times, inside, outputs, margins, last = found
    chosen = inside.reshape(-1)
    return Segment(
        time=carry.time,
        vector=carry.vector,
        stopped=carry.stopped,
        finite=np.isfinite(carry.vector).all() & np.isfinite(carry.time) & carry.whole,
        margins=margins,
        steps=carry.steps,
        sample_times=times.reshape(-1)[chosen],
        samples={name: value.reshape(chosen.size, *value.shape[2:])[chosen] for name, value in outputs.items()},
        last=last,
    )
