"""What ends a flight, as margins that are positive while it goes on. Depends on: plant.loop.

One event function, the least of the margins, is given to the integrator: with several events its bisection may lock
on the wrong one; with one the root is always bracketed. Which margin ended the flight is read off afterwards.
"""

import dataclasses
import math

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.errors import ConfigError
from tethership.plant import ClosedLoop, end_tension
from tethership.scenario import Scenario
from tethership.simulation.outcome import Outcome

MARGINS = (Outcome.docked, Outcome.cable_broken, Outcome.ground_contact, Outcome.attitude_singular)
"""Outcomes in the order of the margins."""


@dataclasses.dataclass(frozen=True)
class Stop:
    """What ends a flight besides a broken cable.

    Attributes
    ----------
    time_limit : float
        Longest flight [s].
    cable_length : float or None
        Unstretched length at which a ship is docked [m]; None where it is not to dock.
    largest_pitch : float
        Largest |θ| [rad].
    ground_contact : bool
        Whether touching the ground ends the flight.
    """

    time_limit: float
    cable_length: float | None = None
    largest_pitch: float = 1.3962634015954636
    ground_contact: bool = False

    def __post_init__(self) -> None:
        for name in ("time_limit", "cable_length", "largest_pitch"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise ConfigError(f"stop: {name} is {value}; it must be a number above 0")

    @classmethod
    def of(cls, scenario: Scenario, stop: "Stop | float | None") -> "Stop":
        """Return what ends a flight of a scenario.

        Parameters
        ----------
        scenario : Scenario
            Gives the largest |θ| [rad], and the time limit [s] where none is given; touching the ground ends a flight
            where the scenario has `ground.anchor_height`.
        stop : Stop or float, optional
            Taken as it is, or the time limit [s].
        """
        if isinstance(stop, Stop):
            return stop
        own = scenario.config.stop
        limit = own.time_limit if stop is None else float(stop)
        return cls(limit, None, own.largest_pitch, scenario.config.ground.anchor_height is not None)

    @classmethod
    def docking(cls, scenario: Scenario) -> "Stop":
        """Return what ends the docking of a scenario: as `of`, and its docking length `stop.cable_length` [m]."""
        return dataclasses.replace(cls.of(scenario, None), cable_length=scenario.config.stop.cable_length)

    def conditions(self) -> "StopConditions":
        """Return length [m] and largest pitch [rad] as the compiled program sees them; −inf where it is not to dock."""
        docked = -math.inf if self.cable_length is None else self.cable_length
        return StopConditions(jnp.asarray(docked), jnp.asarray(self.largest_pitch), self.ground_contact)


class StopConditions(eqx.Module):
    """Limits of a flight.

    Attributes
    ----------
    cable_length : float
        Unstretched length at which a ship counts as docked [m]; −inf where it is not to dock.
    largest_pitch : float
        Largest |θ| [rad].
    ground_contact : bool
        Whether touching the ground ends the flight.
    """

    cable_length: Float[Array, ""]
    largest_pitch: Float[Array, ""]
    ground_contact: bool = eqx.field(static=True)

    def margins(self, loop: ClosedLoop, time: Float[Array, ""], vector: Float[Array, "n"]) -> Float[Array, "4"]:
        """Return the margins in the order of `MARGINS` [m, -, m, rad], +inf for what cannot happen.

        Parameters
        ----------
        loop : ClosedLoop
            Gives cables, ground and hull.
        time : Float[Array, ""]
            t [s].
        vector : Float[Array, "n"]
            All states.

        Notes
        -----
        Longest L_t less the docking length [m], least 1 − T/F_b [-] with T the larger of a cable's end tensions,
        clearance of the hull's lowest point [m], |θ|_max − |θ| [rad].
        """
        now = loop.unpack(vector)
        state, lengths = now.ship, now.lengths
        never = jnp.asarray(jnp.inf)
        docked = broken = never
        if loop.plant.cables:
            docked = jnp.max(lengths) - self.cable_length
            forces = loop.plant.cable_states(time, state, lengths)
            strength = [
                1.0 - end_tension(force) / cable.breaking_force
                for force, cable in zip(forces, loop.plant.cables, strict=True)
            ]
            broken = jnp.min(jnp.stack(strength))
        contact = never
        if self.ground_contact:
            contact = loop.plant.environment.ground - loop.plant.ship.lowest_point(state)
        pitch = self.largest_pitch - jnp.abs(state.attitude[1])
        return jnp.stack([docked, broken, contact, pitch])

    def least(self, loop: ClosedLoop, time: Float[Array, ""], vector: Float[Array, "n"]) -> Float[Array, ""]:
        """Return the least of the margins [m, -, m, rad], each in its own unit; arguments as in `margins`.

        Where it is not finite 1 is returned, so that divergence is left to be found as such.
        """
        margin = jnp.min(self.margins(loop, time, vector))
        return jnp.where(jnp.isfinite(margin), margin, 1.0)
