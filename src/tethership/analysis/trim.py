"""Trim: the equilibrium of a ship, with any unknowns against any fixed quantities. Depends on: system, scenario.

The residual is the sum of all loads less the gyroscopic term, (f, m) about P in body axes; it vanishes in steady
flight. Thrust is *not* clipped while solving: a throttle beyond its limit is the answer to how much is missing,
and is reported as saturation.
"""

import enum
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy.optimize
from jaxtyping import Array, Float

from tethership.analysis.unknowns import Unknowns, find_unknowns
from tethership.errors import ConfigError, SolveError
from tethership.scenario import Scenario
from tethership.scenario.schema import TrimConfig
from tethership.spatial import STANDARD_GRAVITY, rotation_matrix, safe_norm
from tethership.system import Command, State, TetheredAirship

RESIDUAL_LIMIT = 1e-6
"""Largest residual of an equilibrium, as a fraction of 1 N and 1 N m per newton of weight."""

EFFORT = 1e-3
"""Weight of the throttles beside the residual, which is in units of 1e-3 of the weight: small enough to move the
minimum-norm solution by less than 1e-7; a last Newton step then takes the residual to rounding."""


class TrimOutcome(enum.Enum):
    """How a trim ended; the value is a sentence with the cure where one is needed."""

    converged = "In equilibrium."
    saturated = (
        "In equilibrium only with more thrust than there is; the named thrusters lack it. "
        "Less wind, a slacker cable or more nominal thrust are needed."
    )
    no_equilibrium = (
        "No equilibrium with these unknowns; the residual is what is left. "
        "Free more quantities (trim.unknowns) or start the search elsewhere (trim.position)."
    )


class TrimPoint(NamedTuple):
    """Where the ship rests, or flies steadily.

    Attributes
    ----------
    state : State
        The twelve states.
    command : Command
        Throttles [-] (beyond their limits where saturated) and deflections [rad].
    tension : Float[Array, "cables"]
        Tension at each tether point [N].
    residual : Float[Array, "6"]
        Force and moment left over, about P, body axes, with throttles clipped to their limits [N, N m].
    saturated : tuple of str
        Thrusters asked for more than they have.
    outcome : TrimOutcome
        Whether this is an equilibrium.
    """

    state: State
    command: Command
    tension: Float[Array, "cables"]
    residual: Float[Array, "6"]
    saturated: tuple[str, ...]
    outcome: TrimOutcome


class _Problem(eqx.Module):
    """What the compiled solver needs.

    Attributes
    ----------
    plant : TetheredAirship
    base : Float[Array, "n"]
        All quantities (12 states, throttles, deflections) with the fixed ones in place.
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
        state = State.from_vector(everything[:12])
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


@eqx.filter_jit
def _balance(problem: _Problem, values: Float[Array, "unknowns"]) -> tuple[Array, Array]:
    """Return the residual in units of 1e-3 of the weight, and its exact Jacobian."""
    unit = 1e-3 * problem.plant.ship.gravity.mass * STANDARD_GRAVITY

    def balance(x: Float[Array, "unknowns"]) -> Float[Array, "6"]:
        return problem.residual(*problem.unpack(x)) / unit

    return balance(values), jax.jacfwd(balance)(values)


def _solve(problem: _Problem) -> np.ndarray:
    """Return the values of the unknowns: least squares with scipy, then Newton steps of least norm."""
    effort = np.asarray(EFFORT * problem.unknowns.effort)

    def misfit(values: np.ndarray) -> np.ndarray:
        return np.concatenate([np.asarray(_balance(problem, values)[0]), effort * values])

    def slope(values: np.ndarray) -> np.ndarray:
        return np.vstack([np.asarray(_balance(problem, values)[1]), np.diag(effort)])

    start = np.asarray(problem.unknowns.taken(problem.base))
    found = scipy.optimize.least_squares(
        misfit, start, jac=slope, xtol=1e-12, ftol=1e-12, gtol=1e-12, max_nfev=200  # pyright: ignore[reportArgumentType]
    ).x
    for _ in range(3):
        residual, jacobian = map(np.asarray, _balance(problem, found))
        if not np.isfinite(jacobian).all():
            break
        found = found - np.linalg.pinv(jacobian, rcond=1e-9) @ residual
    return found


@eqx.filter_jit
def _described(problem: _Problem, values: Float[Array, "unknowns"]) -> tuple[State, Command, Array, Array, Array]:
    """Return state, command, tensions, and the residual without and with clipped throttles."""
    state, command = problem.unpack(values)
    plant = problem.plant
    cables = plant.cable_states(jnp.zeros(()), state, plant.initial_lengths())
    tension = jnp.stack([safe_norm(c.ship) for c in cables]) if cables else jnp.zeros(0)
    clipped = Command(plant.ship.thrusters.saturate(command.throttle), command.deflection)
    return state, command, tension, problem.residual(state, command), problem.residual(state, clipped)


@eqx.filter_jit
def start_position(config: TrimConfig, plant: TetheredAirship) -> Float[Array, "3"]:
    """Return x_P [m], ground axes, from which a trim begins; arguments are the scenario's."""
    if config.position is not None:
        return jnp.asarray(config.position)
    cable = plant.cables[0]
    level = jnp.cos(config.elevation)
    direction = jnp.stack(
        [
            level * jnp.cos(jnp.asarray(config.bearing)),
            level * jnp.sin(jnp.asarray(config.bearing)),
            -jnp.sin(jnp.asarray(config.elevation)),
        ]
    )
    reach = jnp.asarray(config.elongation) * cable.length
    rotation = rotation_matrix(jnp.asarray(config.attitude))
    return cable.anchor + reach * direction - rotation @ cable.tether_point


def _arrays(config: TrimConfig) -> TrimConfig:
    """Return the settings with numbers as arrays, which do not recompile when they change."""
    return jax.tree.map(lambda leaf: np.asarray(leaf) if isinstance(leaf, float) else leaf, config)


def trim(
    scenario: Scenario,
    unknowns: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    throw: bool = False,
) -> TrimPoint:
    """Return the equilibrium of a scenario.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`; its `trim` table holds the defaults.
    unknowns : sequence of str, optional
        What is looked for: states (`u` … `down`), names of thrusters or fins, `throttle`, `deflection`.
    fixed : mapping, optional
        Values of quantities that are not looked for, or where the search starts [SI, rad].
    throw : bool
        Raise SolveError where there is no equilibrium.

    Notes
    -----
    Where there are more unknowns than equations, the throttles and deflections of least Euclidean norm are taken.

    Raises
    ------
    ConfigError
        A name is not known.
    SolveError
        With `throw`, no equilibrium.
    """
    config = scenario.config.trim
    vehicle = scenario.config.vehicle
    plant = scenario.system
    thrusters = [thruster.name for thruster in vehicle.thrusters]
    fins = [fin.name for fin in vehicle.fins]
    hold = config.hold == "tether_point" and bool(plant.cables)
    names = tuple(config.unknowns if unknowns is None else unknowns)
    if hold and set(names) & {"north", "east", "down"}:
        raise ConfigError(
            f"trim: the tether point is held, so north, east and down follow; take them out of {list(names)} "
            'or set trim.hold = "reference_point"'
        )
    base = np.concatenate(
        [
            config.velocity,
            np.zeros(3),
            config.attitude,
            start_position(_arrays(config), plant),
            np.zeros(len(thrusters) + len(fins)),
        ]
    )
    chosen, base = find_unknowns(names, dict(fixed or {}), thrusters, fins, base)
    problem = _Problem(plant, base, chosen, hold)
    point = _judged(plant, thrusters, *_described(problem, _solve(problem)))
    if throw and point.outcome is TrimOutcome.no_equilibrium:
        raise SolveError(f"{point.outcome.value} Residual: {np.asarray(point.residual)} N, N m")
    return point


def _judged(plant: TetheredAirship, thrusters: list[str], *found: Any) -> TrimPoint:
    """Return the point with its outcome."""
    state, command, tension, free, clipped = found
    weight = float(plant.ship.gravity.mass) * STANDARD_GRAVITY
    throttle = np.asarray(command.throttle)
    allowed = np.asarray(plant.ship.thrusters.saturate(command.throttle))
    saturated = tuple(name for name, over in zip(thrusters, throttle != allowed, strict=True) if over)
    left = np.abs(np.asarray(free)).max()
    if not np.isfinite(left) or left > RESIDUAL_LIMIT * max(weight, 1.0):
        outcome = TrimOutcome.no_equilibrium
    else:
        outcome = TrimOutcome.saturated if saturated else TrimOutcome.converged
    return TrimPoint(state, command, tension, clipped, saturated, outcome)
