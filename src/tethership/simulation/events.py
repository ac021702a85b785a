"""What ends a flight, as margins that are positive while it goes on. Depends on: simulation.closed_loop.

One event function, the least of the margins, is given to the integrator: with several events its bisection may lock
on the wrong one; with one the root is always bracketed. Which margin ended the flight is read off afterwards.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.plant.plant import end_tension
from tethership.simulation.closed_loop import ClosedLoop
from tethership.simulation.outcome import Outcome

MARGINS = (Outcome.docked, Outcome.cable_broken, Outcome.ground_contact, Outcome.attitude_singular)
"""Outcomes in the order of the margins."""


class StopConditions(eqx.Module):
    """Limits of a flight.

    Attributes
    ----------
    cable_length : float
        Unstretched length at which a ship counts as docked [m].
    largest_pitch : float
        Largest |θ| [rad].
    ground_contact : bool
        Whether touching the ground ends the flight.
    """

    cable_length: Float[Array, ""]
    largest_pitch: Float[Array, ""]
    ground_contact: bool = eqx.field(static=True)

    def margins(self, loop: ClosedLoop, time: Float[Array, ""], vector: Float[Array, "n"]) -> Float[Array, "4"]:
        """Return the margins in the order of `MARGINS` [-], +inf for what cannot happen.

        Notes
        -----
        Length left over the docking length, 1 − T/F_b at the worse end, clearance [m], |θ|_max − |θ| [rad].
        """
        state, lengths, _ = loop.unpack(vector)
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
        """Return the least margin; 1 where it is not finite, so that divergence is left to be found as such."""
        margin = jnp.min(self.margins(loop, time, vector))
        return jnp.where(jnp.isfinite(margin), margin, 1.0)
