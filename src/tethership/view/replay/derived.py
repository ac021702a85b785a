"""What a replay shows and a flight file does not hold: thrust, gust, attitude as a quaternion, height.

Depends on: scenario (the models), scipy.
"""

import functools
from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
import xarray as xr
from jaxtyping import Float
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tethership._kept import kept
from tethership.physics import AbstractWind, Thrusters
from tethership.scenario import ScenarioConfig, build_thrusters, build_wind, ground_level

Array = NDArray[np.float64]

BLOCK = 1024
"""Rows that are computed at once."""

THRUST_NEEDS = ("density", "air_velocity", "rates", "throttle")
"""Outputs of a flight from which the thrust follows."""


def rotations(attitude: Array) -> Rotation:
    """Return body to ground for Euler angles φ, θ, ψ, 3-2-1 [rad], shape (n, 3)."""
    return Rotation.from_euler("ZYX", attitude[:, ::-1])


def quaternions(turned: Rotation) -> Array:
    """Return rotations as unit quaternions (x, y, z, w) [-], shape (n, 4), without jumps of sign between neighbours."""
    unit = turned.as_quat()
    flips = np.where(np.einsum("ni,ni->n", unit[1:], unit[:-1]) < 0.0, -1.0, 1.0)
    return unit * np.concatenate([[1.0], np.cumprod(flips)])[:, None]


def thrusts(data: xr.Dataset, config: ScenarioConfig) -> Array | None:
    """Return the thrust of each thruster along its direction [N], shape (n, thrusters); None if it cannot be known.

    Parameters
    ----------
    data : xr.Dataset
        Of a flight.
    config : ScenarioConfig
        Its scenario, P at the origin of the vehicle's body axes.

    Notes
    -----
    `Thrusters.thrust` at the recorded density, airspeed, rates and throttle. The airspeed recorded is that of B; that
    of P follows from ω. A gradient of turbulence along the hull, which is not recorded, is left out: it counts only
    for thrusters whose thrust falls with airspeed.
    """
    if not config.vehicle.thrusters or any(name not in data for name in THRUST_NEEDS):
        return None
    thrusters = build_thrusters(config.vehicle, jnp.zeros(3))
    centre = jnp.asarray(config.vehicle.buoyancy.centre)
    return _in_blocks(functools.partial(_thrusts, thrusters, centre), *(data[name].to_numpy() for name in THRUST_NEEDS))


def gusts(wind: Array, centre: Array, config: ScenarioConfig) -> Array:
    """Return what the air does besides the mean wind [m/s], ground axes, shape (n, 3).

    Parameters
    ----------
    wind : Array
        All of the wind at B, gusts, turbulence and ground effect included [m/s], ground axes, shape (n, 3).
    centre : Array
        B, ground axes [m], shape (n, 3).
    config : ScenarioConfig
        Says what the mean wind is.
    """
    mean = build_wind(config.wind, ground_level(config))
    return wind - _in_blocks(functools.partial(_mean_wind, mean), centre)


def _in_blocks(function: Callable[..., jax.Array], *columns: Array) -> Array:
    """Return a function's values for all rows, computed a block at a time: one program for flights of any length."""
    count = len(columns[0])
    filled = [np.pad(column, [(0, -count % BLOCK)] + [(0, 0)] * (column.ndim - 1), "edge") for column in columns]
    parts = [function(*(column[i : i + BLOCK] for column in filled)) for i in range(0, count, BLOCK)]
    return np.concatenate([np.asarray(part) for part in parts])[:count]


@kept
def _thrusts(
    thrusters: Thrusters,
    centre: Float[jax.Array, "3"],
    density: Float[jax.Array, "n"],
    air_velocity: Float[jax.Array, "n 3"],
    rates: Float[jax.Array, "n 3"],
    throttle: Float[jax.Array, "n thrusters"],
) -> Float[jax.Array, "n thrusters"]:
    at_p = air_velocity - jnp.cross(rates, centre)
    return jax.vmap(thrusters.thrust)(density, at_p, rates, throttle)


@kept
def _mean_wind(wind: AbstractWind, centre: Float[jax.Array, "n 3"]) -> Float[jax.Array, "n 3"]:
    return jax.vmap(wind.velocity)(centre)
