"""The exact linear model: the whole right-hand side differentiated by JAX at a point.

Depends on: analysis.linear.right_side, analysis.linear.outputs, analysis.linear.model, scenario, plant.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.closed import closed_model
from tethership.analysis.linear.differences import central_differences
from tethership.analysis.linear.model import LinearModel
from tethership.analysis.linear.outputs import linear_outputs
from tethership.analysis.linear.right_side import WIND_UNITS, input_vector, loads, right_side
from tethership.analysis.linear.semi_analytic import semi_analytic
from tethership.analysis.trim.trim import TrimOutcome, TrimPoint
from tethership.control import AbstractLaw
from tethership.errors import ConfigError, suggestion
from tethership.plant import (
    DRIFT_LIMIT,
    LENGTH,
    REWIND_RATE,
    STATE_NAMES,
    WIND_INPUTS,
    Command,
    State,
    TetheredAirship,
    drift,
    left_over,
    mass_matrix,
    open_loop,
    open_state,
    residual_limit,
)
from tethership.scenario import Scenario
from tethership.spatial import rotation_matrix

ROUTES = ("exact", "semi_analytic", "differences")
"""The three independent routes to A and U."""

LOOPS = ("open", "closed")
"""Whether the channels are inputs, or laws command them."""

WORST_CONDITION = 1e8
"""Largest condition number of the mass matrix, lengths in half hulls: beyond it half of the digits are gone."""


class Matrices(NamedTuple):
    """A and U of a point: Δṡ = A Δs + U Δδ.

    Attributes
    ----------
    state : Float[Array, "n n"]
        A [state unit/s per state unit]: [1/s] on the diagonal.
    input : Float[Array, "n inputs"]
        U [state unit/s per input unit].
    """

    state: Float[Array, "n n"]
    input: Float[Array, "n inputs"]


def differentiate(plant: TetheredAirship, state: Float[Array, "n"], inputs: Float[Array, "inputs"]) -> Matrices:
    """Return A and U by exact differentiation, not compiled.

    Parameters
    ----------
    plant : TetheredAirship
    state : Float[Array, "n"]
        s₀, in the order of `plant.layout.open_loop`: U, V, W [m/s] and p, q, r [rad/s] in body axes, φ, θ, ψ [rad],
        north, east, down [m], then throttles [-] and deflections [rad] that actuators which lag have reached.
    inputs : Float[Array, "inputs"]
        δ₀, as `input_vector` returns them.
    """

    def rates(together: Float[Array, "n"]) -> Float[Array, "n"]:
        return right_side(plant, together[: len(state)], together[len(state) :])

    slopes = jax.jacfwd(rates)(jnp.concatenate([state, inputs]))
    return Matrices(slopes[:, : len(state)], slopes[:, len(state) :])


def comparable_coordinates(plant: TetheredAirship, state: Float[Array, "n"]) -> Float[Array, "n n"]:
    """Return the matrix to comparable coordinates at a state.

    Parameters
    ----------
    plant : TetheredAirship
    state : Float[Array, "n"]
        As in `differentiate` [m/s, rad/s, rad, m, and units of the actuators].

    Returns
    -------
    Float[Array, "n n"]
        Times Δs it gives velocities and turning speeds at the hull's end [m/s], displacements there and of P [m].

    Notes
    -----
    Velocities become those relative to the air, v − Rᵀv_w: in them the heading mode of a free ship is ψ alone and
    side-slip is what the word says. Rates and angles are multiplied by half the hull's length [m]; states of actuators
    are left in their own units.
    """

    def coordinates(vector: Float[Array, "n"]) -> Float[Array, "n"]:
        wind = plant.environment.without_fluctuations().wind_at(vector[9:12], jnp.zeros(()))
        return vector.at[:3].add(-rotation_matrix(vector[6:9]).T @ wind)

    reach = 0.5 * plant.ship.outline.station[-1]
    scale = jnp.ones(len(state)).at[3:9].set(reach)
    return scale[:, None] * jax.jacfwd(coordinates)(state)


class _Balance(NamedTuple):
    """What is left over at a point [N, N m], its limit, and the rates of what must stand still [rad/s, m/s]."""

    residual: Float[Array, "6"]
    limit: Float[Array, ""]
    drift: Float[Array, "motions"]


@kept
def _exact(
    plant: TetheredAirship,
    state: Float[Array, "n"],
    inputs: Float[Array, "inputs"],
    turning: Float[Array, "3"] | None,
) -> tuple[Matrices, Float[Array, "n n"], _Balance, Float[Array, "6 6"]]:
    """Return A and U, the comparable coordinates, what is left over, Mⁱ + Mᵃ over half hulls."""
    here = State.from_vector(state)
    left = -plant.ship.body.gyroscopic(here.velocity, here.rates).as_vector()
    residual = sum(loads(plant, state, inputs).values(), left)
    reach = 0.5 * plant.ship.outline.station[-1]
    scale = jnp.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) + jnp.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]) * reach
    mass = mass_matrix(here, plant.ship, plant.environment) / jnp.outer(scale, scale)
    left_over = _Balance(residual, residual_limit(plant), drift(plant, here, turning))
    return differentiate(plant, state, inputs), comparable_coordinates(plant, state), left_over, mass


def linearize(
    system: Scenario | TetheredAirship | TrimPoint,
    point: TrimPoint | tuple[State, Command] | None = None,
    route: str = "exact",
    length_states: bool = False,
    require_equilibrium: bool = True,
    loop: str = "open",
    law: AbstractLaw | None = None,
) -> LinearModel:
    """Return the linear model of a ship, free or on cables, about a point.

    Parameters
    ----------
    system : Scenario or TetheredAirship
        A scenario gives the names of thrusters, fins and cables; a bare plant has them numbered. Or a TrimPoint, which
        knows its scenario.
    point : TrimPoint or (State, Command), optional
        Where; from `trim`, at rest or in steady motion.
    route : str
        `exact` (automatic differentiation of the whole right-hand side), `semi_analytic` (Eqs. 26–39 of the paper) or
        `differences` (central differences).
    length_states : bool
        Make each cable's unstretched length a state, dL_t/dt = −Ψ, with the rewind rate Ψ as a control.
    require_equilibrium : bool
        Refuse a point that is none.
    loop : str
        `open` (the channels are inputs) or `closed` (with the scenario's laws; what is added to what they ask is an
        input). A sampled law gives a discrete model, `LinearModel.sample_time` apart.
    law : AbstractLaw, optional
        Closes the loop instead of the scenario's layers.

    Returns
    -------
    LinearModel
        States as `STATE_NAMES` (ground velocity and rates in body axes, Euler angles, position in ground axes), then
        those of actuators that lag, and in a closed loop those of the laws; inputs
        are throttles [-], deflections [rad], the wind's change [m/s] and rate [m/s²] in ground axes, lengths [m];
        outputs as `LinearModel` lists them, differentiated exactly whatever the route. About a steady turn the nine
        states without position, whose coefficients are constant.

    Raises
    ------
    ConfigError
        The point is not in equilibrium (it says how far off), the route is not known, or the model is too singular to
        divide by (mass matrix, pitch of ±90°).
    """
    if isinstance(system, TrimPoint) and point is None and system.scenario is not None:
        system, point = system.scenario, system
    if not isinstance(system, Scenario | TetheredAirship):
        raise ConfigError(f"linearize: a scenario is needed, not {system!r}; give what load_scenario() returns")
    if not isinstance(point, TrimPoint) and not (isinstance(point, tuple) and len(point) == 2):
        raise ConfigError(f"linearize: a point is needed, not {point!r}; give what trim() returns, or (State, Command)")
    if require_equilibrium and isinstance(point, TrimPoint) and point.outcome is TrimOutcome.no_equilibrium:
        left = np.abs(np.asarray(point.residual))
        raise ConfigError(
            f"linearize: the trim found no equilibrium: {left[:3].max():.3g} N and {left[3:].max():.3g} N m are left "
            f"over. {point.message}"
        )
    if loop not in LOOPS:
        raise ConfigError(f"linearize: unknown loop {loop!r}{suggestion(loop, LOOPS)} Allowed: {', '.join(LOOPS)}")
    plant = (system.system if isinstance(system, Scenario) else system).at_mean()
    state, command = (point.state, point.command) if isinstance(point, TrimPoint) else point
    vector, inputs = open_state(plant, state, command), input_vector(plant, command)
    if not np.isfinite(np.asarray(vector)).all():
        raise ConfigError("linearize: the point has states that are not finite; check its state")
    exact, comparable, balance, mass = _exact(plant, vector, inputs, _turning(system))
    _check_dividable(np.asarray(mass), float(state.attitude[1]))
    if require_equilibrium:
        _check_equilibrium(jax.device_get(balance))
    matrices = _by_route(route, exact, plant, vector, inputs)
    names, units = _inputs(system)
    first_length = len(names) - len(plant.cables)
    cables = tuple(name.removeprefix(LENGTH) for name in names[first_length:])
    measured = linear_outputs(plant, vector, inputs, cables)
    layout = open_loop(plant)
    model = LinearModel(
        np.asarray(matrices[0]),
        np.asarray(matrices[1]),
        layout.names,
        names,
        layout.units,
        units,
        np.asarray(vector),
        np.asarray(inputs),
        np.asarray(comparable),
        _attributes(system, point, route),
        names[: first_length - len(WIND_INPUTS)],
        *measured,
    )
    if loop == "closed":
        if not isinstance(system, Scenario):
            raise ConfigError("linearize: a closed loop needs a scenario, which says its laws; a bare plant has none")
        model = closed_model(system, model, state, command, law, length_states)
    if _turning(system) is not None:  # heading and place go round: what stays are the other states
        return model.without_position()
    return _with_lengths(model, plant) if length_states and loop == "open" else model


def _check_dividable(mass: np.ndarray, pitch: float) -> None:
    """Raise ConfigError where a mass matrix (lengths in half hulls) or a pitch [rad] cannot be divided by."""
    condition = np.linalg.cond(mass) if np.isfinite(mass).all() else np.inf
    if condition > WORST_CONDITION:
        raise ConfigError(
            f"linearize: the mass matrix is too singular to divide by (condition number {condition:.2g}, at most "
            f"{WORST_CONDITION:.0g}); check mass, inertia and apparent mass of the vehicle"
        )
    if abs(np.cos(pitch)) < 1e-6:
        raise ConfigError(
            f"linearize: at a pitch of {np.degrees(pitch):.4g}° Euler angles are singular: there is no linear model in "
            "them; trim within ±80°"
        )


def _turning(system: Scenario | TetheredAirship) -> Float[Array, "3"] | None:
    """Return the rates of φ, θ, ψ of a scenario's manoeuvre [rad/s]; None for none."""
    turning = system.config.turning() if isinstance(system, Scenario) else None
    return None if turning is None else jnp.asarray(turning)


def _check_equilibrium(balance: _Balance) -> None:
    """Raise ConfigError where a point is not in equilibrium; the balance is in numpy arrays."""
    residual, moving, limit = np.asarray(balance.residual), np.asarray(balance.drift), float(balance.limit)
    if not np.isfinite(residual).all():
        raise ConfigError("linearize: the point has loads that are not finite; check its state")
    force, moment = np.abs(residual[:3]).max(), np.abs(residual[3:]).max()
    if max(force, moment) > limit or np.abs(moving).max() > DRIFT_LIMIT:
        raise ConfigError(
            f"linearize: the point is not in equilibrium: {force:.3g} N and {moment:.3g} N m are left over (at most "
            f"{limit:.2g}): {left_over(residual, moving, limit)}; give the point that trim() returns for this "
            "scenario, or require_equilibrium=False"
        )


def _by_route(
    route: str, exact: Matrices, plant: TetheredAirship, state: Float[Array, "n"], inputs: Float[Array, "inputs"]
) -> tuple[Any, Any]:
    """Return A and U by the route of that name."""
    match route:
        case "exact":
            return exact.state, exact.input
        case "semi_analytic" if len(state) > len(STATE_NAMES):
            raise ConfigError(
                "linearize: the semi_analytic route is the paper's, whose actuators have no states; take exact, or "
                "leave lag and rate_limit out"
            )
        case "semi_analytic":
            found = semi_analytic(plant, state, inputs)
            return found.state_matrix(), found.input_matrix()
        case "differences":
            return central_differences(plant, state, inputs)
        case _:
            raise ConfigError(
                f"linearize: unknown route {route!r}{suggestion(route, ROUTES)} Allowed: {', '.join(ROUTES)}"
            )


def _inputs(system: Scenario | TetheredAirship) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return names and units of the inputs."""
    if isinstance(system, Scenario):
        vehicle = system.config.vehicle
        thrusters = [thruster.name for thruster in vehicle.thrusters]
        fins = [fin.name for fin in vehicle.fins]
        cables = [f"{LENGTH}{cable.name}" for cable in system.config.cables]
    else:
        thrusters = [f"thruster_{i + 1}" for i in range(system.ship.thrusters.count)]
        fins = [f"fin_{i + 1}" for i in range(system.ship.fins.count)]
        cables = [f"{LENGTH}cable_{i + 1}" for i in range(len(system.cables))]
    names = (*thrusters, *fins, *WIND_INPUTS, *cables)
    return names, ("1",) * len(thrusters) + ("rad",) * len(fins) + WIND_UNITS + ("m",) * len(cables)


def _attributes(system: Scenario | TetheredAirship, point: Any, route: str) -> dict[str, Any]:
    """Return what the model carries of its origin."""
    attributes: dict[str, Any] = {"route": route}
    if isinstance(system, Scenario):
        attributes |= {"formulation": system.formulation, "name": system.name, "scenario": system.document}
    if isinstance(point, TrimPoint):
        attributes |= {"outcome": point.outcome.name, "saturated": list(point.saturated)}
    return attributes


def _with_lengths(model: LinearModel, plant: TetheredAirship) -> LinearModel:
    """Return the model with the cables' lengths as states and their rewind rates Ψ as inputs."""
    count, width, size = len(plant.cables), len(model.inputs), len(model.states)
    kept = width - count
    lengths = model.inputs[kept:]
    state = np.zeros((size + count, size + count))
    state[:size, :size], state[:size, size:] = model.A, model.U[:, kept:]
    control = np.zeros((size + count, width))
    control[:size, :kept] = model.U[:, :kept]
    control[size:, kept:] = -np.eye(count)
    comparable = np.eye(size + count)
    comparable[:size, :size] = model.comparable
    rewinds = tuple(name.replace(LENGTH, REWIND_RATE, 1) for name in lengths)
    return LinearModel(
        state,
        control,
        (*model.states, *lengths),
        (*model.inputs[:kept], *rewinds),
        (*model.state_units, *("m",) * count),
        (*model.input_units[:kept], *("m/s",) * count),
        np.concatenate([model.state_values, model.input_values[kept:]]),
        np.concatenate([model.input_values[:kept], np.zeros(count)]),
        comparable,
        model.attributes,
        (*model.controls, *rewinds),
        model.outputs,
        model.output_units,
        model.output_values,
        np.hstack([model.C, model.D[:, kept:]]),
        np.hstack([model.D[:, :kept], np.zeros((len(model.outputs), count))]),
    )
