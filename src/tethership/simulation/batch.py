"""Many flights side by side, with fixed steps, each summed up while it is flown. Depends on: simulation.

The batch is the last axis of every array. What is the same in all flights is not repeated (`hoisted`), so that the
hull's shape or the anchors' places are read once for all. Every flight ends by the same conditions as a single one;
the batch goes on until three of four have ended, then the rest go on without them.
"""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from tethership.plant import ClosedLoop
from tethership.results import averages
from tethership.simulation.beats import Beat, Clock
from tethership.simulation.events import MARGINS, StopConditions
from tethership.simulation.outcome import Outcome
from tethership.simulation.tally import Signals, Tally, add, begin, signals

STEP = 0.025
"""Length of a step [s], the paper's largest."""

STRAGGLERS = 4
"""When no more than one flight in so many is under way, those go on by themselves: a few that end late would
otherwise cost as many steps of all."""

WIDE = 96
"""Flights of the narrowest batch for which that is worth a second loop to compile."""

CODES = (*MARGINS, Outcome.time_limit, Outcome.diverged)
"""Outcomes by the number that a batch gives."""


class Lane(NamedTuple):
    """One flight of a batch, under way.

    Attributes
    ----------
    vector : Float[Array, "n"]
        Integrator's vector of all states, in the order of `plant.layout.closed_loop`, SI and radians.
    slope : Float[Array, "n"]
        Its rate, per second.
    margins : Float[Array, "4"]
        In the order of `events.MARGINS` [m, -, m, rad].
    tally : Tally
        Sums.
    active : Bool[Array, ""]
        Whether it goes on.
    outcome : Int[Array, ""]
        Place in `CODES` where it ended.
    """

    vector: Float[Array, "n"]
    slope: Float[Array, "n"]
    margins: Float[Array, "4"]
    tally: Tally
    active: Bool[Array, ""]
    outcome: Int[Array, ""]


class BatchResult(NamedTuple):
    """Metrics of many flights, one array each, flights last.

    Attributes
    ----------
    tally : Tally
        Sums at the end of each: times [s], tensions [N], angles [rad] and the others in the units of `Tally`.
    outcome : Int[Array, "flights"]
        Place in `CODES`.
    """

    tally: Tally
    outcome: Int[Array, "flights"]


def _look(
    loop: ClosedLoop, stop: StopConditions, time: Float[Array, ""], vector: Float[Array, "n"]
) -> tuple[Array, Array, Signals]:
    """Return rate, margins and signals at a time."""
    now = loop.instant(time, vector)
    return loop.rate(now), stop.margins(loop, time, vector), signals(loop, now)


def _ticked(loop: ClosedLoop, time: Float[Array, ""], lane: Lane, beat: Beat) -> Lane:
    """Return a lane after what a sampled law does at the start of a step."""
    if loop.sampling is None:
        return lane

    def jumped() -> tuple[Array, Array]:
        vector = lane.vector
        if loop.sampling is not None and loop.sampling.delay is not None:
            vector = jnp.where(beat.acts, loop.act(vector), vector)
        vector = jnp.where(beat.looks, loop.look(time, vector), vector)
        return vector, loop.vector_field(time, vector)

    vector, slope = jax.lax.cond(beat.acts | beat.looks, jumped, lambda: (lane.vector, lane.slope))
    return lane._replace(vector=vector, slope=slope)


def _advanced(loop: ClosedLoop, time: Float[Array, ""], lane: Lane, step: Float[Array, ""]) -> Float[Array, "n"]:
    """Return the vector a step h [s] on: classical Runge–Kutta of order 4, its first stage known."""
    half = 0.5 * step
    second = loop.vector_field(time + half, lane.vector + half * lane.slope)
    third = loop.vector_field(time + half, lane.vector + half * second)
    fourth = loop.vector_field(time + step, lane.vector + step * third)
    return lane.vector + step / 6.0 * (lane.slope + 2.0 * (second + third) + fourth)


def _stepped(
    loop: ClosedLoop,
    stop: StopConditions,
    limits: Float[Array, "limits"],
    time: Float[Array, ""],
    lane: Lane,
    beat: Beat,
) -> Lane:
    """Return a lane one step on; one that has ended stays as it is."""
    step = beat.step
    begun = _ticked(loop, time, lane, beat)
    vector = _advanced(loop, time, begun, step)
    slope, margins, now = _look(loop, stop, time + step, vector)
    finite = jnp.all(jnp.isfinite(vector)) & jnp.all(jnp.isfinite(slope))
    worst = jnp.argmin(margins)
    ended = margins[worst] <= 0.0
    fall = jnp.where(ended, lane.margins[worst] - margins[worst], 1.0)
    share = jnp.where(ended, jnp.clip(lane.margins[worst] / fall, 0.0, 1.0), 1.0)
    tally = add(lane.tally, now, step, share, limits)
    ahead = Lane(
        vector,
        slope,
        margins,
        tally,
        lane.active & finite & ~ended,
        jnp.where(finite, jnp.where(ended, worst, len(MARGINS)), len(MARGINS) + 1),
    )
    kept = lane._replace(active=jnp.zeros((), bool), outcome=jnp.where(lane.active, ahead.outcome, lane.outcome))
    moving = lane.active & finite
    return jax.tree.map(lambda new, old: jnp.where(moving, new, old), ahead, kept)


def _started(loop: ClosedLoop, stop: StopConditions, limits: Float[Array, "limits"], vector: Float[Array, "n"]) -> Lane:
    """Return a lane at t = 0; one that is over before it begins ends there."""
    slope, margins, now = _look(loop, stop, jnp.zeros(()), vector)
    finite = jnp.all(jnp.isfinite(vector)) & jnp.all(jnp.isfinite(slope))
    worst = jnp.argmin(margins)
    outcome = jnp.where(finite, jnp.where(margins[worst] <= 0.0, worst, len(MARGINS)), len(MARGINS) + 1)
    return Lane(vector, slope, margins, begin(now, limits), finite & (margins[worst] > 0.0), outcome)


def fly_to_its_end(
    loop: ClosedLoop,
    stop: StopConditions,
    limits: Float[Array, "limits"],
    vector: Float[Array, "n"],
    time_limit: Float[Array, ""],
    rhythm: Beat,
) -> BatchResult:
    """Fly one flight to its end, as `fly_lanes` flies many; to be compiled over lanes by the caller.

    Parameters
    ----------
    loop : ClosedLoop
    stop, limits, time_limit, rhythm
        As in `fly_lanes`.
    vector : Float[Array, "n"]
        Start.
    """
    clock = Clock.of(rhythm)

    def unfinished(carry: tuple[Array, Lane]) -> Array:
        return carry[1].active & (clock.time(carry[0]) < time_limit - 1e-9)

    def forward(carry: tuple[Array, Lane]) -> tuple[Array, Lane]:
        count, now = carry
        return count + 1, _stepped(loop, stop, limits, clock.time(count), now, clock.beat(count))

    begun = _started(loop, stop, limits, vector)
    _, lane = jax.lax.while_loop(unfinished, forward, (jnp.zeros((), int), begun))
    return BatchResult(lane.tally, lane.outcome)


def fly_lanes(
    loops: ClosedLoop,
    axes: ClosedLoop,
    stop: StopConditions,
    limits: Float[Array, "limits"],
    vectors: Float[Array, "n flights"],
    time_limit: Float[Array, ""],
    rhythm: Beat,
) -> BatchResult:
    """Fly a batch to its end; to be compiled by the caller.

    Parameters
    ----------
    loops : ClosedLoop
        Arrays of all flights, the flight last where `axes` says so.
    axes : ClosedLoop
        −1 where a flight has its own value, None where all have the same.
    stop : StopConditions
        What ends a flight, the same for all.
    limits : Float[Array, "limits"]
        Tensions to be timed [N].
    vectors : Float[Array, "n flights"]
        Starts.
    time_limit : Float[Array, ""]
        [s].
    rhythm : Beat
        The steps, over and over again, shape (beats,).
    """
    lanes = jax.vmap(_started, in_axes=(axes, None, None, -1), out_axes=-1)(loops, stop, limits, vectors)
    advance = jax.vmap(_stepped, in_axes=(axes, None, None, None, -1, None), out_axes=-1)
    clock = Clock.of(rhythm)

    def onward(loops: ClosedLoop, count: Int[Array, ""], lanes: Lane, fewest: int) -> tuple[Int[Array, ""], Lane]:
        """Fly from a number of steps on until no more than so many flights are under way, or the time is up."""

        def unfinished(carry: tuple[Array, Lane]) -> Array:
            return (jnp.sum(carry[1].active) > fewest) & (clock.time(carry[0]) < time_limit - 1e-9)

        def forward(carry: tuple[Array, Lane]) -> tuple[Array, Lane]:
            count, now = carry
            return count + 1, advance(loops, stop, limits, clock.time(count), now, clock.beat(count))

        return jax.lax.while_loop(unfinished, forward, (count, lanes))

    few = vectors.shape[-1] // STRAGGLERS if vectors.shape[-1] >= WIDE else 0
    count, lanes = onward(loops, jnp.zeros((), int), lanes, few)
    if few:
        last = jnp.argsort(~lanes.active)[:few]
        _, ended = onward(_picked(loops, axes, last), count, jax.tree.map(lambda leaf: leaf[..., last], lanes), 0)
        lanes = jax.tree.map(lambda leaf, new: leaf.at[..., last].set(new), lanes, ended)
    return BatchResult(lanes.tally, lanes.outcome)


def _picked(loops: ClosedLoop, axes: ClosedLoop, which: Int[Array, "few"]) -> ClosedLoop:
    """Return the loops of some flights of a batch; what all share stays as it is."""
    return jax.tree.map(
        lambda axis, leaf: leaf if axis is None else leaf[..., which], axes, loops, is_leaf=lambda axis: axis is None
    )


def differing(loops: ClosedLoop) -> tuple[bool, ...]:
    """Return which arrays of a batch of loops (the flight last) differ between flights, in the order of leaves."""
    leaves = (np.asarray(leaf) for leaf in jax.tree.leaves(eqx.filter(loops, eqx.is_array)))
    return tuple(not bool(np.all(leaf == leaf[..., :1])) for leaf in leaves)


def hoisted(loops: ClosedLoop, differ: tuple[bool, ...]) -> tuple[ClosedLoop, ClosedLoop]:
    """Return a batch of loops with what all share held once, and its axes: −1 where flights differ, else None.

    Parameters
    ----------
    loops : ClosedLoop
        Every array with the flight last.
    differ : tuple of bool
        From `differing`.
    """
    arrays, rest = eqx.partition(loops, eqx.is_array)
    leaves, structure = jax.tree.flatten(arrays)
    kept = [leaf if own else leaf[..., 0] for leaf, own in zip(leaves, differ, strict=True)]
    axes = structure.unflatten([-1 if own else None for own in differ])
    return eqx.combine(structure.unflatten(kept), rest), axes


def metrics_of(result: BatchResult) -> dict[str, np.ndarray]:
    """Return the metrics of a batch by the names of `results.docking_metrics`, flights first.

    Notes
    -----
    `docking_time` is NaN for a flight that did not dock; `flight_time` is that of every one. Angles in degrees.
    `quasi_static_outside` [-] and `snap_impulse` [N] are `share_outside` and `largest_impulse` of
    `simulation.quasi_static`.
    """
    tally = jax.device_get(result.tally)
    outcome = np.asarray(result.outcome)
    span = np.where(tally.time > 0, tally.time, 1.0)
    return {
        "outcome": outcome,
        "flight_time": tally.time,
        "docking_time": np.where(outcome == 0, tally.time, np.nan),
        "tension_max": tally.tension_max,
        **averages(tally.sums, tally.travel, span),
        "tension_largest": tally.largest_max,
        "tension_anchor": tally.anchor_max,
        "roll_max": np.degrees(tally.roll_max),
        "pitch_max": np.degrees(tally.pitch_max),
        "rewind_rate_min": tally.slowest,
        "seconds_above": np.moveaxis(tally.above, -1, 0),
        "clearance_min": tally.clearance,
        "misalignment_jumps": tally.jumps,
        "quasi_static_outside": tally.outside_sum / span,
        "snap_impulse": tally.impulse,
    }
