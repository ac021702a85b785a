"""What an equilibrium is: no force or moment left over, and nothing moving that must stand still.

Depends on: plant.state, plant.plant, spatial.

Balanced loads alone are none: with a pitch rate held at 0.1 rad/s they may balance at one instant, and θ turns on. What
must stand still is the attitude, and on a cable, whose anchor does, the ship itself.
"""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.errors import ConfigError
from tethership.plant.layout import part_layout
from tethership.plant.plant import TetheredAirship
from tethership.plant.state import Command, State
from tethership.spatial import STANDARD_GRAVITY, euler_rates, rotation_matrix

BALANCES = ("surge force", "sway force", "heave force", "roll moment", "pitch moment", "yaw moment")
"""The six balances about P, body axes, in the order of the residual [N, N, N, N m, N m, N m]."""

RESIDUAL_LIMIT = 1e-6
"""Largest residual of an equilibrium, as a fraction of 1 N and 1 N m per newton of weight."""

MOTIONS = ("phi", "theta", "psi", "north", "east", "down")
"""What must stand still, in the order of `drift` [rad/s, m/s]; the last three only on a cable."""

STILL = 1e-6
"""Largest rate of a part's state at rest [its unit per second]."""

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


@kept
def _part_rates(plant: TetheredAirship, state: State) -> Array:
    """Return how fast the states of parts of one's own change where they say they rest [their unit per second]."""
    now, mean = jnp.zeros(()), plant.at_mean()
    cables = mean.cable_states(now, state, mean.initial_lengths())
    return jnp.concatenate(mean.part_rates(now, state, cables, mean.parts_at_rest(now, state, cables)))


def check_parts(plant: TetheredAirship, state: State) -> None:
    """Raise ConfigError where a part of one's own does not rest where it says so.

    At rest each state changes by no more than `STILL` [their unit per second], in the mean air at t = 0 [s].
    """
    if not plant.parts:
        return
    for name, rate in zip(part_layout(plant).names, np.asarray(_part_rates(plant, state)), strict=True):
        if not abs(rate) <= STILL:
            raise ConfigError(
                f"the part's state {name} changes at {rate:.3g} a second where rest() puts it; "
                "let rest() be where rate() is zero"
            )


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
