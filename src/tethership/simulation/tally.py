"""Metrics of Tables 3–6 summed up while a flight is flown, so that a batch keeps no samples.

Depends on: plant.loop, control, physics by their results, results.metrics. What is summed is defined there, and of the
cable's pace in `simulation.cable_pace`; a single flight reads the same off its samples.
"""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from tethership.control import misalignment
from tethership.plant import ClosedLoop, Instant, end_tension
from tethership.results import Sums, integrands, jumped, share_above, travelled
from tethership.simulation.cable_pace import LEAST_MASS, LEAST_TENSION, MEMORY, SLACK, TRUSTED, first_mode
from tethership.spatial import safe_norm


class Signals(NamedTuple):
    """What the metrics look at, at one time.

    Attributes
    ----------
    tension : Float[Array, ""]
        At the tether point of the cable that pulls hardest [N].
    largest : Float[Array, ""]
        Largest tension anywhere along any cable [N].
    anchor : Float[Array, ""]
        At the anchor of the cable that pulls hardest there, what its winch feels [N].
    throttle : Float[Array, "thrusters"]
        δ [-].
    roll, pitch : Float[Array, ""]
        φ, θ [rad].
    saturated : Float[Array, ""]
        1 where any thruster or fin is asked for more than it has.
    rewind_rate : Float[Array, ""]
        Slowest Ψ of the winches [m/s].
    clearance : Float[Array, ""]
        Of the hull [m].
    misalignment : Float[Array, ""]
        χ of the first cable [rad].
    ends : Float[Array, "cables"]
        Tension of each cable at its tether point [N].
    brisk : Float[Array, "cables"]
        Fastest change of it that a quasi-static cable may be trusted with, 0.3 T ω₁ [N/s].
    elongation : Float[Array, "cables"]
        e [-].
    wave : Float[Array, "cables"]
        Tension of the axial wave per rate of elongation, L√(EA m) [N s]: the ends part at v = L de/dt.
    """

    tension: Float[Array, ""]
    largest: Float[Array, ""]
    anchor: Float[Array, ""]
    throttle: Float[Array, "thrusters"]
    roll: Float[Array, ""]
    pitch: Float[Array, ""]
    saturated: Float[Array, ""]
    rewind_rate: Float[Array, ""]
    clearance: Float[Array, ""]
    misalignment: Float[Array, ""]
    ends: Float[Array, "cables"]
    brisk: Float[Array, "cables"]
    elongation: Float[Array, "cables"]
    wave: Float[Array, "cables"]


def signals(loop: ClosedLoop, now: Instant) -> Signals:
    """Return the signals at an instant.

    A ship without cables has tensions of 0 [N], a rewind rate of 0 [m/s] and a misalignment of 0 [rad].
    """
    cables, zero, none = now.cables, jnp.zeros(()), jnp.zeros(0)
    ends = jnp.stack([safe_norm(c.ship) for c in cables]) if cables else none
    mass = jnp.stack([jnp.maximum(c.load.linear_density, LEAST_MASS) for c in loop.plant.cables]) if cables else none
    stiffness = jnp.stack([c.law.stiffness for c in loop.plant.cables]) if cables else none
    floor = jnp.maximum(ends, LEAST_TENSION)
    return Signals(
        tension=jnp.max(ends) if cables else zero,
        largest=jnp.max(jnp.stack([end_tension(c) for c in cables])) if cables else zero,
        anchor=jnp.max(jnp.stack([safe_norm(c.anchor) for c in cables])) if cables else zero,
        throttle=now.command.throttle,
        roll=now.state.attitude[0],
        pitch=now.state.attitude[1],
        saturated=(jnp.any(now.saturated) | jnp.any(now.fins_saturated)).astype(float),
        rewind_rate=jnp.min(now.rewind_rate) if cables else zero,
        clearance=loop.plant.environment.ground - loop.plant.ship.lowest_point(now.state),
        misalignment=misalignment(now.state.attitude, cables[0].span) if cables else zero,
        ends=ends,
        brisk=TRUSTED * floor * first_mode(floor, now.lengths, mass),
        elongation=jnp.stack([safe_norm(c.span) for c in cables]) / now.lengths if cables else none,
        wave=now.lengths * jnp.sqrt(stiffness * mass),
    )


class Tally(NamedTuple):
    """Sums up to now.

    Attributes
    ----------
    time : Float[Array, ""]
        t [s].
    last, before : Signals
        Signals of the last step and of the one before.
    tension_max, largest_max, anchor_max : Float[Array, ""]
        Peaks [N].
    roll_max, pitch_max : Float[Array, ""]
        Largest |φ| and |θ| [rad].
    sums : Sums
        Integrals of |F| [N s], Σ|δ| [s], θ² [rad² s], and the time with a thruster or fin saturated [s].
    travel : Float[Array, ""]
        Σ∫|dδ/dt| dt [-].
    above : Float[Array, "limits"]
        Time above each limit [s].
    slowest, clearance : Float[Array, ""]
        Least Ψ [m/s] and hull clearance [m].
    jumps : Float[Array, ""]
        How often χ jumped by more than a right angle.
    swinging : Float[Array, ""]
        For how long a hurried cable still swings on [s].
    outside_sum : Float[Array, ""]
        Time with a cable outside the range in which the quasi-static one may be trusted [s].
    slack : Bool[Array, "cables"]
        Whether it was slack since it last came taut.
    impulse : Float[Array, ""]
        Largest tension of an axial wave, v√(EA m), of a cable that came taut [N].
    """

    time: Float[Array, ""]
    last: Signals
    before: Signals
    tension_max: Float[Array, ""]
    largest_max: Float[Array, ""]
    anchor_max: Float[Array, ""]
    roll_max: Float[Array, ""]
    pitch_max: Float[Array, ""]
    sums: Sums
    travel: Float[Array, ""]
    above: Float[Array, "limits"]
    slowest: Float[Array, ""]
    clearance: Float[Array, ""]
    jumps: Float[Array, ""]
    swinging: Float[Array, ""]
    outside_sum: Float[Array, ""]
    slack: Bool[Array, "cables"]
    impulse: Float[Array, ""]


def begin(first: Signals, limits: Float[Array, "limits"]) -> Tally:
    """Return the tally at t = 0 for the first signals and the limits of tension [N]."""
    zero = jnp.zeros(())
    return Tally(
        zero,
        first,
        first,
        first.tension,
        first.largest,
        first.anchor,
        jnp.abs(first.roll),
        jnp.abs(first.pitch),
        Sums(zero, zero, zero, zero),
        zero,
        jnp.zeros_like(limits),
        first.rewind_rate,
        first.clearance,
        zero,
        zero,
        zero,
        first.elongation < SLACK,
        zero,
    )


def _vertex(before: Array, middle: Array, after: Array) -> Array:
    """Return the top of the parabola through three samples where the middle one is highest, else the middle."""
    slope, bend = 0.5 * (after - before), before - 2.0 * middle + after
    top = (middle > before) & (middle >= after)
    return middle - jnp.where(top, 0.5 * slope**2 / jnp.where(top, bend, -1.0), 0.0)


def _summed(at: Signals) -> Sums:
    """Return what is integrated at one time."""
    return integrands(at.tension, at.throttle, at.pitch, at.saturated)


def add(
    tally: Tally, now: Signals, step: Float[Array, ""], share: Float[Array, ""], limits: Float[Array, "limits"]
) -> Tally:
    """Return the tally with one step more.

    Parameters
    ----------
    tally : Tally
        So far.
    now : Signals
        At the step's end.
    step : Float[Array, ""]
        Its length h [s].
    share : Float[Array, ""]
        Part of it that was flown before the flight ended, 0 … 1 [-].
    limits : Float[Array, "limits"]
        Tensions whose exceedance is timed [N].

    Notes
    -----
    Trapezia; where the flight ends inside the step, every signal is taken along a straight line up to there. The
    peak is the top of the parabola through three samples: a snap lasts a few of them.
    """
    last, span = tally.last, share * step
    partly = lambda start, end: span * (start + 0.5 * share * (end - start))  # noqa: E731
    reached = lambda start, end: start + share * (end - start)  # noqa: E731
    tension = reached(last.tension, now.tension)
    hurried = jnp.any(jnp.abs(now.ends - last.ends) > 0.5 * step * (now.brisk + last.brisk))
    taut = tally.slack & (now.elongation >= 1.0)
    waves = jnp.where(taut, (now.elongation - last.elongation) / step * now.wave, 0.0)
    top = _vertex(tally.before.tension, last.tension, jnp.where(share < 1.0, tension, now.tension))
    peak = jnp.maximum(jnp.where(span > 0, top, last.tension), jnp.maximum(last.tension, tension))
    return Tally(
        time=tally.time + span,
        last=now,
        before=last,
        tension_max=jnp.maximum(tally.tension_max, peak),
        largest_max=jnp.maximum(tally.largest_max, reached(last.largest, now.largest)),
        anchor_max=jnp.maximum(tally.anchor_max, reached(last.anchor, now.anchor)),
        roll_max=jnp.maximum(tally.roll_max, jnp.abs(reached(last.roll, now.roll))),
        pitch_max=jnp.maximum(tally.pitch_max, jnp.abs(reached(last.pitch, now.pitch))),
        sums=Sums(
            *(total + partly(*ends) for total, *ends in zip(tally.sums, _summed(last), _summed(now), strict=True))
        ),
        travel=tally.travel + share * travelled(last.throttle, now.throttle),
        above=tally.above + span * share_above(last.tension, tension, limits),
        slowest=jnp.minimum(tally.slowest, reached(last.rewind_rate, now.rewind_rate)),
        clearance=jnp.minimum(tally.clearance, reached(last.clearance, now.clearance)),
        jumps=tally.jumps + jumped(last.misalignment, now.misalignment) * (share >= 1.0),
        swinging=jnp.where(hurried, MEMORY, jnp.maximum(tally.swinging - span, 0.0)),
        outside_sum=tally.outside_sum + jnp.where(hurried, span, jnp.minimum(tally.swinging, span)),
        slack=(tally.slack & ~taut) | (now.elongation < SLACK),
        impulse=jnp.maximum(tally.impulse, jnp.max(waves, initial=0.0)),
    )
