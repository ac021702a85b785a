"""The trim problem and its solution: residual, exact Jacobian, search. Depends on: analysis.unknowns, system.

The residual is the sum of all loads less the gyroscopic term, (f, m) about P in body axes. Thrust is *not* clipped:
a throttle beyond its limit is the answer to how much is missing.
"""

import itertools

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize
from jaxtyping import Array, Float

from tethership.analysis.unknowns import Unknowns
from tethership.spatial import STANDARD_GRAVITY, rotation_matrix, safe_norm
from tethership.system import Command, State, TetheredAirship

RESIDUAL_LIMIT = 1e-6
"""Largest residual of an equilibrium, as a fraction of 1 N and 1 N m per newton of weight."""

EFFORT = 1e-3
"""Weight of the throttles beside the residual, which is in units of 1e-3 of the weight: small enough to move the
minimum-norm solution by less than 1e-7; a last Newton step then takes the residual to rounding."""


class Problem(eqx.Module):
    """What the compiled solver needs.

    Attributes
    ----------
    plant : TetheredAirship
    base : Float[Array, "n"]
        All quantities (12 of the motion, throttles, deflections) with the fixed ones in place.
    unknowns : Unknowns
        Which of them are looked for.
    hold_tether : bool
        Whether the position follows the attitude so that the first tether point stays.
    """

    plant: TetheredAirship
    base: Float[Array, "n"]
    unknowns: Unknowns
    hold_tether: bool = eqx.field(static=True)

    def unpack(self, values: Float[Array, "unknowns"]) -> tuple[State, Command]:
        """Return state and command for values of the unknowns, in units of their scales."""
        ship = self.plant.ship
        everything = self.unknowns.placed(self.base, values)
        rotation = rotation_matrix(everything[6:9])
        state = State(rotation.T @ everything[0:3], everything[3:6], everything[6:9], everything[9:12])
        count = ship.thrusters.count
        if self.hold_tether:
            start = rotation_matrix(self.base[6:9])
            moved = (start - rotation_matrix(state.attitude)) @ self.plant.cables[0].tether_point
            state = State(state.velocity, state.rates, state.attitude, state.position + moved)
        return state, Command(everything[12 : 12 + count], everything[12 + count :])

    def residual(self, state: State, command: Command) -> Float[Array, "6"]:
        """Return the unbalanced force and moment [N, N m]."""
        plant, now = self.plant, jnp.zeros(())
        cables = plant.cable_states(now, state, plant.initial_lengths())
        loads = plant.wrenches(now, state, command, cables)
        left = plant.ship.body.gyroscopic(state.velocity, state.rates).as_vector()
        return sum((load.as_vector() for load in loads.values()), -left)

    def balance(self, values: Float[Array, "unknowns"]) -> Float[Array, "6"]:
        """Return the residual for values of the unknowns, in units of 1e-3 of the weight [-]."""
        unit = 1e-3 * self.plant.ship.gravity.mass * STANDARD_GRAVITY
        return self.residual(*self.unpack(values)) / unit


@eqx.filter_jit
def _balance(problem: Problem, values: Float[Array, "unknowns"]) -> tuple[Array, Array]:
    """Return the balance and its exact Jacobian."""
    return problem.balance(values), jax.jacfwd(problem.balance)(values)


def solve(problem: Problem) -> np.ndarray:
    """Return the values of the unknowns of least residual found.

    Notes
    -----
    Least squares by scipy, then Newton steps of least norm. A taut cable makes the problem stiff and the first
    search may stop in a valley, so it is repeated with other scales and starts until one is in equilibrium.
    """
    start = problem.unknowns.taken(np.asarray(problem.base))
    best, least = start, np.inf
    low, high = problem.unknowns.bounds()
    for bounded, scale, shift in itertools.product((False, True), (1.0, "jac"), (0.0, 0.3, -0.3, 1.0)):
        begin = np.clip(start + shift * (problem.unknowns.effort == 0), low, high)
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
    residual, jacobian = _balance(problem, jnp.asarray(values))
    return np.asarray(residual), np.asarray(jacobian)


def _searched(problem: Problem, start: np.ndarray, scale: float | str, bounded: bool) -> np.ndarray:
    """Return where least squares over residual and effort ends, from a start in the unknowns' units."""
    effort = np.asarray(EFFORT * problem.unknowns.effort)

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


@eqx.filter_jit
def described(problem: Problem, values: Float[Array, "unknowns"]) -> tuple[State, Command, Array, Array, Array]:
    """Return state, command, tensions, and the residual without and with clipped throttles."""
    state, command = problem.unpack(values)
    plant = problem.plant
    cables = plant.cable_states(jnp.zeros(()), state, plant.initial_lengths())
    tension = jnp.stack([safe_norm(c.ship) for c in cables]) if cables else jnp.zeros(0)
    clipped = Command(plant.ship.thrusters.saturate(command.throttle), command.deflection)
    return state, command, tension, problem.residual(state, command), problem.residual(state, clipped)
