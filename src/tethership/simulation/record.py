"""What is kept of a flight at one instant, by the names of `results.schema`. Depends on: plant.loop."""

from collections.abc import Callable

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control import misalignment
from tethership.plant import Cable, CableState, ClosedLoop, Instant, end_tension
from tethership.spatial import rotation_matrix, safe_norm

CURVE_POINTS = 17
"""Points of a cable that are kept."""


def record(loop: ClosedLoop, time: Float[Array, ""], vector: Float[Array, "n"]) -> dict[str, Array]:
    """Return all outputs at time t [s] for an integrator's vector; units and axes in `results.schema`."""
    now = loop.instant(time, vector)
    own = _own(now) if loop.plant.parts else {}
    return {**_ship(loop, time, now), **own, **_loads(now), **_cables(loop, now)}


def _ship(loop: ClosedLoop, time: Float[Array, ""], now: Instant) -> dict[str, Array]:
    """Return motion, air and command."""
    plant, state = loop.plant, now.state
    rotation = rotation_matrix(state.attitude)
    centre = plant.ship.buoyancy.centre
    velocity_b = state.velocity + jnp.cross(state.rates, centre)
    air = plant.environment.air(state.position + rotation @ centre, rotation @ velocity_b, rotation[:, 0], time)
    return {
        "velocity": state.velocity,
        "rates": state.rates,
        "attitude": state.attitude,
        "position": state.position,
        "air_velocity": velocity_b - rotation.T @ air.wind,
        "wind": air.wind,
        "density": air.density,
        "rate_of_climb": -rotation[2] @ velocity_b,
        "throttle": now.command.throttle,
        "throttle_asked": now.asked.throttle,
        "saturated": now.saturated.astype(float),
        "deflection": now.command.deflection,
        "deflection_asked": now.asked.deflection,
        "deflection_saturated": now.fins_saturated.astype(float),
        "clearance": plant.environment.ground - plant.ship.lowest_point(state),
    }


def _own(now: Instant) -> dict[str, Array]:
    """Return states and readings of parts of one's own, in their units."""
    told = list(now.measurement.readings.values())
    return {
        "part_states": jnp.concatenate([jnp.zeros(0), *now.now.parts]),
        "readings": jnp.stack(told) if told else jnp.zeros(0),
    }


def _loads(now: Instant) -> dict[str, Array]:
    """Return the named loads, stacked."""
    loads = list(now.loads.values())
    return {
        "load_force": jnp.stack([load.force for load in loads]),
        "load_moment": jnp.stack([load.moment for load in loads]),
    }


def _cables(loop: ClosedLoop, now: Instant) -> dict[str, Array]:
    """Return everything about the cables, the cable as first axis."""

    def each(function: Callable[[Cable, CableState, Array], Array], *shape: int) -> Array:
        rows = [
            function(cable, state, now.lengths[i])
            for i, (cable, state) in enumerate(zip(loop.plant.cables, now.cables, strict=True))
        ]
        return jnp.stack(rows) if rows else jnp.zeros((0, *shape))

    ground = loop.plant.environment.ground

    def curve(cable: Cable, state: CableState, length: Array) -> Array:
        arc = jnp.linspace(0.0, 1.0, CURVE_POINTS) * length
        return state.place + cable.law.shape(state.span, length, state.load, arc)

    curves = each(curve, CURVE_POINTS, 3)
    distance = each(lambda c, s, length: safe_norm(s.span))
    return {
        "cable_force": each(lambda c, s, length: s.ship, 3),
        "anchor_force": each(lambda c, s, length: s.anchor, 3),
        "tension": each(lambda c, s, length: safe_norm(s.ship)),
        "tension_largest": each(lambda c, s, length: end_tension(s)),
        "cable_curve": curves,
        "cable_clearance": ground - each(lambda c, s, length: c.lowest_point(s, length)[2]),
        "tether_offset": each(lambda c, s, length: s.span, 3),
        "distance": distance,
        "elongation": distance / now.lengths,
        "regime": each(lambda c, s, length: c.law.regime(safe_norm(s.span) / length).astype(float)),
        "cable_length": now.lengths,
        "rewind_rate": now.rewind_rate,
        "misalignment": each(lambda c, s, length: misalignment(now.state.attitude, s.span)),
    }
