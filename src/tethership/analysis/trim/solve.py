"""The trim problem and its solution: balance, exact Jacobian, search. Depends on: analysis.trim.unknowns, plant.

Balanced are the forces and moments about P, and what must stand still where it is looked for (`plant.balance`).
Commands are *not* clipped: a throttle beyond its limit is the answer to how much is missing.
"""

import itertools
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.trim.unknowns import Unknowns
from tethership.plant import (
    RESIDUAL_LIMIT,
    Command,
    State,
    TetheredAirship,
    drift,
    end_tension,
    residual,
    residual_limit,
)
from tethership.spatial import STANDARD_GRAVITY, body_rates, rotation_matrix, safe_norm

EFFORT = 1e-3
"""Weight of the throttles beside the residual, which is in units of 1e-3 of the weight: small enough to move the
minimum-norm solution by less than 1e-7; a last Newton step then takes the residual to rounding."""


class Problem(eqx.Module):
    """What the compiled solver needs.

    Attributes
    ----------
    plant : TetheredAirship
    base : Float[Array, "n"]
        All quantities with the fixed ones in place: twelve of the motion as `plant.names.QUANTITIES`, the velocity in
        *ground* axes [m/s, rad/s, rad, m], then throttles [-] and deflections [rad].
    unknowns : Unknowns
        Which of them are looked for.
    hold_tether : bool
        Whether the position follows the attitude so that the first tether point stays.
    turning : Float[Array, "3"], optional
        Rates of φ, θ, ψ of a steady turn or a pull-up [rad/s]; p, q, r follow from them.
    """

    plant: TetheredAirship
    base: Float[Array, "n"]
    unknowns: Unknowns
    hold_tether: bool = eqx.field(static=True)
    turning: Float[Array, "3"] | None = None

    def unpack(self, values: Float[Array, "unknowns"]) -> tuple[State, Command]:
        """Return state and command for values of the unknowns.

        Parameters
        ----------
        values : Float[Array, "unknowns"]
            In units of their scales: 1 m/s, 0.1 rad/s, 0.1 rad, 1 m, and throttles [-] and deflections [rad] as they
            are.

        Returns
        -------
        tuple of State and Command
            Velocity [m/s] and rates [rad/s] in body axes, φ, θ, ψ [rad], x_P in ground axes [m]; the command is not
            clipped.
        """
        ship = self.plant.ship
        everything = self.unknowns.placed(self.base, values)
        rotation = rotation_matrix(everything[6:9])
        rates = everything[3:6] if self.turning is None else body_rates(everything[6:9], self.turning)
        state = State(rotation.T @ everything[0:3], rates, everything[6:9], everything[9:12])
        count = ship.thrusters.count
        if self.hold_tether:
            start = rotation_matrix(self.base[6:9])
            moved = (start - rotation_matrix(state.attitude)) @ self.plant.cables[0].tether_point
            state = State(state.velocity, state.rates, state.attitude, state.position + moved)
        return state, Command(everything[12 : 12 + count], everything[12 + count :])

    def balance(self, values: Float[Array, "unknowns"]) -> Float[Array, "balances"]:
        """Return the residual for values of the unknowns, in units of 1e-3 of the weight [-]; moments times 1 m.

        Where motion is looked for, the rates of what must stand still follow, in units of 1e-3 rad/s and m/s.
        """
        unit = 1e-3 * self.plant.ship.gravity.mass * STANDARD_GRAVITY
        state, command = self.unpack(values)
        left = residual(self.plant, state, command) / unit
        if not any(place in self.moving for place in self.unknowns.index):
            return left
        return jnp.concatenate([left, drift(self.plant, state, self.turning) / 1e-3])

    @property
    def moving(self) -> range:
        """Places of quantities that move what must stand still: rates [rad/s], and on a cable the velocity [m/s]."""
        return range(0 if self.plant.cables else 3, 6)


@kept
def _balance(problem: Problem, values: Float[Array, "unknowns"]) -> tuple[Array, Array]:
    """Return the balance and its exact Jacobian."""
    return problem.balance(values), jax.jacfwd(problem.balance)(values)


def solve(problem: Problem) -> np.ndarray:
    """Return the values of the unknowns of least residual found.

    Parameters
    ----------
    problem : Problem
        As `posed` returns it.

    Returns
    -------
    ndarray
        In units of `Unknowns.scale`: 1 m/s, 0.1 rad/s, 0.1 rad, 1 m, and throttles [-] and deflections [rad] as they
        are.

    Notes
    -----
    Least squares by scipy, then Newton steps of least norm. A taut cable makes the problem stiff and the first
    search may stop in a valley, so it is repeated with other scales and starts until one is in equilibrium.
    """
    start = problem.unknowns.taken(np.asarray(problem.base))
    best, least = start, np.inf
    low, high = problem.unknowns.bounds()
    states = np.asarray(problem.unknowns.effort) == 0
    for bounded, scale, shift in itertools.product((False, True), (1.0, "jac"), (0.0, 0.3, -0.3, 1.0)):
        begin = np.clip(start + shift * states, low, high)
        try:
            found = _polished(problem, _searched(problem, begin, scale, bounded))
        except ValueError:  # loads or their slopes are not finite there: no search begins or goes on
            continue
        left = np.abs(_evaluated(problem, found)[0]).max()
        if left < least and np.all((low <= found) & (found <= high)):
            best, least = found, left
        if least < 1e3 * RESIDUAL_LIMIT:  # the balance is in units of 1e-3 of the weight
            break
    return best


def _evaluated(problem: Problem, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return `_balance` as numpy arrays."""
    residual, jacobian = _balance(problem, values)
    return np.asarray(residual), np.asarray(jacobian)


def _searched(problem: Problem, start: np.ndarray, scale: float | str, bounded: bool) -> np.ndarray:
    """Return where least squares over residual and effort ends, from a start in the unknowns' units."""
    effort = EFFORT * np.asarray(problem.unknowns.effort)

    def misfit(values: np.ndarray) -> np.ndarray:
        return np.concatenate([_evaluated(problem, values)[0], effort * values])

    def slope(values: np.ndarray) -> np.ndarray:
        return np.vstack([_evaluated(problem, values)[1], np.diag(effort)])

    return scipy.optimize.least_squares(
        misfit,
        start,
        jac=slope,  # pyright: ignore[reportArgumentType]
        bounds=problem.unknowns.bounds() if bounded else (-np.inf, np.inf),
        x_scale=scale,  # pyright: ignore[reportArgumentType]
        xtol=1e-12,
        ftol=1e-12,
        gtol=1e-12,
        max_nfev=300,
    ).x


def _polished(problem: Problem, found: np.ndarray) -> np.ndarray:
    """Return the point after Newton steps of least norm, as long as they lower the residual."""
    residual, jacobian = _evaluated(problem, found)
    for _ in range(4):
        if not np.isfinite(jacobian).all():
            break
        trial = found - np.linalg.pinv(jacobian, rcond=1e-9) @ residual
        left, jacobian = _evaluated(problem, trial)
        if not np.abs(left).max() < np.abs(residual).max():
            break
        found, residual = trial, left
    return found


class Described(NamedTuple):
    """What there is at a solution of a trim.

    Attributes
    ----------
    state, command, allowed
        Of the ship; the command as it was found, and clipped to its limits.
    limit : Float[Array, ""]
        Largest residual of an equilibrium [N, N m].
    tension, largest : Float[Array, "cables"]
        Tension at each tether point, and the largest along each cable [N].
    residual, clipped : Float[Array, "6"]
        Force and moment left over with the command as found and clipped to its limits [N, N m].
    drift : Float[Array, "motions"]
        Rates of what must stand still, as `plant.balance.drift` [rad/s, m/s].
    hull : Float[Array, ""]
        Height of the hull's lowest point above the ground [m].
    cables : Float[Array, "cables"]
        The same of each cable [m].
    """

    state: State
    command: Command
    allowed: Command
    limit: Float[Array, ""]
    tension: Float[Array, "cables"]
    largest: Float[Array, "cables"]
    residual: Float[Array, "6"]
    clipped: Float[Array, "6"]
    drift: Float[Array, "motions"]
    hull: Float[Array, ""]
    cables: Float[Array, "cables"]


@kept
def described(problem: Problem, values: Float[Array, "unknowns"]) -> Described:
    """Return what there is for values of the unknowns: state, tensions [N], residual [N, N m], heights [m] at t = 0.

    Parameters
    ----------
    problem : Problem
        As `pose` returns it.
    values : Float[Array, "unknowns"]
        In the units that `Problem.unpack` takes.
    """
    state, command = problem.unpack(values)
    plant, ground = problem.plant, problem.plant.environment.ground
    lengths = plant.initial_lengths()
    cables = plant.cable_states(jnp.zeros(()), state, lengths)
    allowed, none = plant.ship.allowed(command), jnp.zeros(0)
    lowest = [c.lowest_point(s, lengths[i])[2] for i, (c, s) in enumerate(zip(plant.cables, cables, strict=True))]
    return Described(
        state,
        command,
        allowed,
        residual_limit(plant),
        jnp.stack([safe_norm(c.ship) for c in cables]) if cables else none,
        jnp.stack([end_tension(c) for c in cables]) if cables else none,
        residual(plant, state, command),
        residual(plant, state, allowed),
        drift(plant, state, problem.turning),
        ground - plant.ship.lowest_point(state),
        ground - jnp.stack(lowest) if lowest else none,
    )
