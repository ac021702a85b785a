"""What an observer measures, as a function of two vectors, states and inputs, to be differentiated.

Depends on: analysis.linear.right_side, plant, spatial. Airspeed V, angle of attack α = atan2(w, u) and side-slip
β = atan2(v, √(u² + w²)) are of B relative to the air there, (u, v, w) in body axes; the outputs are those of a flight
by the same names (`results.schema`), and the two angles, which a flight has as components.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.right_side import unpack_inputs
from tethership.plant import TetheredAirship, reading_names, split_open
from tethership.spatial import rotation_matrix, safe_norm

OF_SHIP = ("airspeed", "angle_of_attack", "sideslip", "rate_of_climb", "clearance")
"""Outputs of the ship; before them comes the tension at the tether point of each cable."""

OF_SHIP_UNITS = ("m/s", "rad", "rad", "m/s", "m")
"""Their SI units."""

OWN_UNIT = "its own unit"
"""Unit of what a part of one's own reads: its own."""

STILL = 1e-2
"""Airspeed [m/s] below which it has no direction: airspeed and the two angles have no derivative at rest."""


class Outputs(NamedTuple):
    """Outputs about a point: Δy = C Δs + D Δδ.

    Attributes
    ----------
    names, units : tuple of str
        Names and SI units, in the order of the rows.
    values : ndarray
        y₀ at the point, in these units: tensions [N], airspeed and rate of climb [m/s], α and β [rad], clearance [m].
    state, input : ndarray
        C [output unit per state unit], shape (outputs, states), and D [output unit per input unit], shape (outputs,
        inputs).
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    values: np.ndarray
    state: np.ndarray
    input: np.ndarray


def measure(
    plant: TetheredAirship, state: Float[Array, "n"], inputs: Float[Array, "inputs"]
) -> Float[Array, "outputs"]:
    """Return tensions [N], `OF_SHIP` [SI], readings of parts, at t = 0; arguments as in `right_side`."""
    changed, _, lengths = unpack_inputs(plant, inputs)
    now, (pose, _, own) = jnp.zeros(()), split_open(plant, state)
    rotation = rotation_matrix(pose.attitude)
    centre = changed.ship.buoyancy.centre
    velocity = pose.velocity + jnp.cross(pose.rates, centre)
    air = changed.environment.air(pose.position + rotation @ centre, rotation @ velocity, rotation[:, 0], now)
    u, v, w = through_air = velocity - rotation.T @ air.wind
    cables = changed.cable_states(now, pose, lengths)
    tensions = [safe_norm(cable.ship) for cable in cables]
    return jnp.stack(
        [
            *tensions,
            safe_norm(through_air),
            jnp.arctan2(w, u),
            jnp.arctan2(v, safe_norm(jnp.stack([u, w]))),
            -rotation[2] @ velocity,
            changed.environment.ground - changed.ship.lowest_point(pose),
            *changed.readings(now, pose, cables, own).values(),
        ]
    )


@kept
def _slopes(
    plant: TetheredAirship, state: Float[Array, "n"], inputs: Float[Array, "inputs"]
) -> tuple[Float[Array, "m"], Float[Array, "m n"]]:
    """Return the outputs and their slopes, states before inputs."""

    def measured(vector: Float[Array, "n"]) -> Float[Array, "m"]:
        return measure(plant, vector[: len(state)], vector[len(state) :])

    together = jnp.concatenate([state, inputs])
    return measured(together), jax.jacfwd(measured)(together)


def linear_outputs(
    plant: TetheredAirship,
    state: Float[Array, "n"],
    inputs: Float[Array, "inputs"],
    cables: tuple[str, ...],
) -> Outputs:
    """Return the outputs about a point, exact; those that have no derivative there are left out.

    Parameters
    ----------
    plant : TetheredAirship
    state, inputs : Float[Array, "n"]
        s₀ and δ₀, as in `right_side`.
    cables : tuple of str
        Names of the cables.

    Notes
    -----
    Airspeed, α and β are left out below an airspeed of `STILL` [m/s], as is all that is not finite or has slopes that
    are not.
    """
    values, slopes = map(np.asarray, _slopes(plant, state, inputs))
    told = reading_names(plant)
    names = np.array([*(f"tension_{name}" for name in cables), *OF_SHIP, *told])
    units = np.array(["N"] * len(cables) + list(OF_SHIP_UNITS) + [OWN_UNIT] * len(told))
    kept = np.isfinite(slopes).all(axis=1) & np.isfinite(values)
    if values[len(cables)] < STILL:
        kept &= ~np.isin(names, OF_SHIP[:3])
    chosen = slopes[kept]
    return Outputs(
        tuple(map(str, names[kept])),
        tuple(map(str, units[kept])),
        values[kept],
        chosen[:, : len(state)],
        chosen[:, len(state) :],
    )
