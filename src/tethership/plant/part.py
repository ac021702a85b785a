"""What a part of the ship is that brings loads, states or readings of its own. Depends on: spatial.

A drogue, a ballonet that breathes, a radar altimeter: a subclass of `AbstractPart` with its numbers as fields. It says
only what it has; trim, linear model, flight, campaign, file, report and replay ask it. Points and axes are those of the
vehicle's file: O is the origin of its body axes, wherever the reference point P of the equations is put.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import Wrench


class Seen(NamedTuple):
    """What a part meets at one instant.

    Attributes
    ----------
    velocity : Float[Array, "3"]
        *Ground* velocity of O, body axes [m/s].
    air_velocity : Float[Array, "3"]
        Velocity of O relative to the air at the centre of buoyancy, body axes [m/s].
    rates : Float[Array, "3"]
        ω = (p, q, r), body axes [rad/s].
    air_rates : Float[Array, "3"]
        ω relative to the air where the air differs along the hull, else ω [rad/s].
    attitude : Float[Array, "3"]
        Euler angles φ, θ, ψ, 3-2-1 [rad].
    position : Float[Array, "3"]
        Of O, ground axes [m].
    height : Float[Array, ""]
        Of O above the ground [m].
    density : Float[Array, ""]
        ρ at the centre of buoyancy [kg/m³].
    gravity : Float[Array, "3"]
        g, body axes [m/s²].
    cables : tuple
        Force of each cable on the ship, ground axes [N], shape (3,) each.
    """

    velocity: Float[Array, "3"]
    air_velocity: Float[Array, "3"]
    rates: Float[Array, "3"]
    air_rates: Float[Array, "3"]
    attitude: Float[Array, "3"]
    position: Float[Array, "3"]
    height: Float[Array, ""]
    density: Float[Array, ""]
    gravity: Float[Array, "3"]
    cables: tuple[Float[Array, "3"], ...]

    @classmethod
    def example(cls, cables: int = 0) -> "Seen":
        """Return what a part would meet level at 10 m/s, 100 m above the ground, on so many slack cables."""
        zero, one = jnp.zeros(3), jnp.ones(())
        ahead, gravity = jnp.array([10.0, 0.0, 0.0]), jnp.array([0.0, 0.0, 9.81])
        return cls(
            ahead,
            ahead,
            zero,
            zero,
            zero,
            jnp.array([0.0, 0.0, -100.0]),
            100.0 * one,
            1.2 * one,
            gravity,
            (zero,) * cables,
        )


class AbstractPart(eqx.Module):
    """A part of the ship; its numbers are fields, and what it does not say it does not have."""

    def states(self) -> tuple[tuple[str, str], ...]:
        """Return name and SI unit of each of its states; none, unless a part says otherwise."""
        return ()

    def rest(self, seen: Seen) -> Float[Array, "states"]:
        """Return its states where they no longer change, in their units: trim needs no unknown for them."""
        del seen
        return jnp.zeros(len(self.states()))

    def rate(self, time: Float[Array, ""], own: Float[Array, "states"], seen: Seen) -> Float[Array, "states"]:
        """Return the rates of its states [their unit per second] at t [s]."""
        del time, seen
        return jnp.zeros_like(own)

    def wrench(self, time: Float[Array, ""], own: Float[Array, "states"], seen: Seen) -> Wrench | None:
        """Return its load about O, body axes [N, N m], by the part's own name; None for none."""
        del time, own, seen
        return None

    def reading(self, time: Float[Array, ""], own: Float[Array, "states"], seen: Seen) -> Float[Array, ""] | None:
        """Return what it tells the laws as a sensor, `measurement.readings[name]`, any unit; None for nothing."""
        del time, own, seen
        return None


def says(part: AbstractPart, what: str) -> bool:
    """Return whether a part has a method of its own: `rate`, `wrench`, `reading` and so on."""
    return getattr(type(part), what) is not getattr(AbstractPart, what)


PartStates = tuple[Any, ...]
"""States of each part, Float[Array, "states"] each, in the order of the parts."""
