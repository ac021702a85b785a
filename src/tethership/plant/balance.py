"""What an equilibrium is: no force or moment left over, and nothing moving that must stand still.

Depends on: plant.state, plant.plant, spatial.

Balanced loads alone are none: with a pitch rate held at 0.1 rad/s they may balance at one instant, and θ turns on. What
must stand still is the attitude, and on a cable, whose anchor does, the ship itself.
"""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.plant.plant import TetheredAirship
from tethership.plant.state import Command, State
from tethership.spatial import STANDARD_GRAVITY, euler_rates, rotation_matrix

BALANCES = ("surge force", "sway force", "heave force", "roll moment", "pitch moment", "yaw moment")
"""The six balances about P, body axes, in the order of the residual [N, N, N, N m, N m, N m]."""

RESIDUAL_LIMIT = 1e-6
"""Largest residual of an equilibrium, as a fraction of 1 N and 1 N m per newton of weight."""

MOTIONS = ("phi", "theta", "psi", "north", "east", "down")
"""What must stand still, in the order of `drift` [rad/s, m/s]; the last three only on a cable."""

DRIFT_LIMIT = 1e-6
"""Largest rate of what must stand still [rad/s, m/s]: a search for it ends at rounding."""


def residual(plant: TetheredAirship, state: State, command: Command) -> Float[Array, "6"]:
    """Return the unbalanced force and moment about P at t = 0, body axes [N, N m]: all loads less the gyroscopic term.

    Parameters
    ----------
    plant : TetheredAirship
        At its mean (`at_mean`) where an equilibrium is meant.
    state : State
        Of the ship.
    command : Command
        Throttles [-] and deflections [rad], used as they come, not clipped.
    """
    now = jnp.zeros(())
    loads = plant.wrenches(now, state, command, plant.cable_states(now, state, plant.initial_lengths()))
    left = plant.ship.body.gyroscopic(state.velocity, state.rates).as_vector()
    return sum((load.as_vector() for load in loads.values()), -left)


def drift(plant: TetheredAirship, state: State, turning: Float[Array, "3"] | None = None) -> Float[Array, "motions"]:
    """Return the rates of what must stand still: Euler angles [rad/s] and, on a cable, x_P beside the anchor [m/s].

    Parameters
    ----------
    plant, state
        The ship.
    turning : Float[Array, "3"], optional
        Rates of φ, θ, ψ that a manoeuvre has [rad/s]: what differs from them must stand still.
    """
    turns = euler_rates(state.attitude, state.rates)
    turns = turns if turning is None else turns - turning
    if not plant.cables:
        return turns
    moving = rotation_matrix(state.attitude) @ state.velocity
    drawn = plant.anchor_velocity()
    return jnp.concatenate([turns, moving if drawn is None else moving - drawn])


def residual_limit(plant: TetheredAirship) -> Float[Array, ""]:
    """Return the largest residual of an equilibrium [N, N m]."""
    return RESIDUAL_LIMIT * jnp.maximum(plant.ship.gravity.mass * STANDARD_GRAVITY, 1.0)


def left_over(residual: np.ndarray, drift: np.ndarray, limit: float) -> str:
    """Return in words which balances are not met and what moves, the largest first; "nothing" where all are met.

    Parameters
    ----------
    residual : ndarray
        As `residual` returns it [N, N m].
    drift : ndarray
        As `drift` returns it [rad/s, m/s].
    limit : float
        From `residual_limit` [N, N m].
    """
    if not (np.isfinite(residual).all() and np.isfinite(drift).all()):
        return "loads that are not finite"
    parts = [
        f"{value:+.3g} {'N m' if 'moment' in name else 'N'} of {name}"
        for name, value in _largest_first(BALANCES, residual, limit)
    ]
    parts += [
        f"{name} moving at {np.degrees(value):.3g}°/s" if i < 3 else f"{name} moving at {value:.3g} m/s"
        for i, name, value in _indexed(drift)
    ]
    return ", ".join(parts) or "nothing"


def _largest_first(names: tuple[str, ...], values: np.ndarray, limit: float) -> list[tuple[str, float]]:
    """Return names and values beyond a limit, the largest first."""
    order = np.argsort(-np.abs(values))
    return [(names[i], float(values[i])) for i in order if abs(values[i]) > limit]


def _indexed(drift: np.ndarray) -> list[tuple[int, str, float]]:
    """Return place, name and rate of everything that moves."""
    return [(i, MOTIONS[i], float(rate)) for i, rate in enumerate(drift) if abs(rate) > DRIFT_LIMIT]
