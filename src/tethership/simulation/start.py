"""Where a flight starts: a trimmed point, checked against the scenario that is flown, with its attitude moved.

Depends on: plant, scenario.
"""

from typing import Any, Protocol

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.errors import ConfigError
from tethership.plant import (
    DRIFT_LIMIT,
    ClosedLoop,
    Command,
    State,
    TetheredAirship,
    check_parts,
    drift,
    left_over,
    residual,
    residual_limit,
)
from tethership.scenario import Scenario, StartConfig
from tethership.simulation.events import StopConditions
from tethership.spatial import rotation_matrix


class Start(Protocol):
    """A trimmed point: what a flight starts from."""

    @property
    def state(self) -> State:
        """State of the ship at trim: velocity and ω, body axes [m/s, rad/s], φ, θ, ψ [rad], x_P, ground axes [m]."""
        ...

    @property
    def command(self) -> Command:
        """Trimmed throttles δ [-] and deflections [rad]."""
        ...


def start_state(scenario: Scenario, trimmed: State) -> State:
    """Return the state in which the flight begins: trim with its attitude moved.

    Parameters
    ----------
    scenario : Scenario
        Says by how much (`start.attitude_offset`, added to φ, θ, ψ [rad]) and which point stays in place
        (`start.hold`).
    trimmed : State
        State at trim [m/s, rad/s, rad, m].

    Notes
    -----
    With q the point held, body axes [m], and R₀, R₁ the rotations before and after: x_P moves by (R₀ − R₁) q. Velocity
    and rates keep their *body* components, but for the velocity V_A of an anchor under way: (R₁ − R₀)ᵀ V_A is added.
    """
    return _moved(scenario.config.start.as_arrays(), scenario.system.with_a_gust(), trimmed)


def moved_start(start: StartConfig, plant: TetheredAirship, trimmed: State) -> State:
    """Return `start_state` of a scenario's table and its plant [m/s, rad/s, rad, m]; can be traced."""
    held = plant.cables[0].tether_point if start.hold == "tether_point" and plant.cables else jnp.zeros(3)
    attitude = trimmed.attitude + jnp.asarray(start.attitude_offset)
    before, after = rotation_matrix(trimmed.attitude), rotation_matrix(attitude)
    moved = (before - after) @ held
    velocity, drawn = trimmed.velocity, plant.anchor_velocity()
    if drawn is not None:  # what it has of an anchor under way does not turn with the ship
        velocity = velocity + (after - before).T @ drawn
    return State(velocity, trimmed.rates, attitude, trimmed.position + moved)


_moved = kept(moved_start)


@kept
def begin(loop: ClosedLoop, stop: StopConditions, state: State) -> tuple[Array, Array]:
    """Return the integrator's vector at the start, t = 0, shape (n,), and the margins there [m, -, m, rad]."""
    vector = loop.initial(state)
    return vector, stop.margins(loop, jnp.zeros(()), vector)


@kept
def _balance(
    plant: TetheredAirship, state: State, command: Command, turning: Float[Array, "3"] | None
) -> tuple[Array, Array, Array]:
    """Return what a point leaves over in the mean air [N, N m], the rates of what must stand still, and the limit."""
    return residual(plant.at_mean(), state, command), drift(plant, state, turning), residual_limit(plant)


def check_point(scenario: Scenario, point: Start) -> None:
    """Raise ConfigError where a point is no equilibrium of the scenario: trimmed for another one, say.

    Looked at are what is left of force and moment about P, body axes [N, N m], and the rates of what must stand still
    [rad/s, m/s].

    Notes
    -----
    Ten times what a trim may leave: a stored or continued point may differ from one found anew by its rounding.
    """
    check_parts(scenario.system, point.state)
    turning = scenario.config.turning()
    given = None if turning is None else jnp.asarray(turning)
    found = _balance(scenario.system.with_a_gust(), point.state, point.command, given)
    left, moving, limit = (np.asarray(part) for part in found)
    limit = 10.0 * float(limit)
    worst = max(np.abs(left).max() / limit, np.abs(moving).max() / (10.0 * DRIFT_LIMIT))
    if not worst <= 1.0:
        raise ConfigError(
            f"dock: the point is no equilibrium of this scenario: {left_over(left, moving, limit)} left over; was it "
            "trimmed for another wind or ship? Give trim(scenario) of the scenario that is flown"
        )


def check_start(margins: Float[Array, "4"]) -> None:
    """Raise ConfigError where the flight would be over before it begins, by its margins at t = 0 [m, -, m, rad]."""
    docked, broken, contact, pitch = np.asarray(margins)
    if broken <= 0:
        raise ConfigError(
            f"the start is beyond breaking: a cable is at {1 - broken:.2f} of its breaking force; lengthen the cable "
            "or lower trim.elongation or start.attitude_offset"
        )
    if docked <= 0:
        raise ConfigError("the start is docked already: cables.length must be above stop.cable_length")
    if contact <= 0:
        raise ConfigError(
            f"the start has the hull {-contact:.2f} m below ground: raise ground.anchor_height (a higher mast), or "
            "start higher (trim.elevation, trim.elongation, a smaller start.attitude_offset)"
        )
    if pitch <= 0:
        raise ConfigError("the start is beyond stop.largest_pitch; lower start.attitude_offset")


def point_numbers(point: Start) -> dict[str, Any]:
    """Return a trimmed point as plain numbers, which JSON keeps bit for bit.

    They are `state` [m/s, rad/s, rad, m], in the order of `STATE_NAMES`, `throttle` [-] and `deflection` [rad].
    """
    return {
        "state": np.asarray(point.state.as_vector()).tolist(),
        "throttle": np.asarray(point.command.throttle).tolist(),
        "deflection": np.asarray(point.command.deflection).tolist(),
    }


class StoredStart:
    """A trimmed point read from a flight file: numbers of `point_numbers` [m/s, rad/s, rad, m], [-] and [rad]."""

    def __init__(self, numbers: dict[str, Any]) -> None:
        self.state = State.from_vector(jnp.asarray(numbers["state"]))
        self.command = Command(
            jnp.asarray(numbers["throttle"], dtype=float), jnp.asarray(numbers["deflection"], dtype=float)
        )
