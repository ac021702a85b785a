"""Motion of an anchor over the ground: a truck, a deck, a mast that swings. Depends on nothing.

An anchor without a motion stands still where its cable says. Motions are given in time, so position and velocity are
exact and belong together.
"""

import abc

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class AbstractAnchorMotion(eqx.Module):
    """Where an anchor is, beside its place in the scenario [m], and how fast it moves [m/s], ground axes."""

    @abc.abstractmethod
    def displacement(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the displacement at t [s], ground axes [m]."""

    @abc.abstractmethod
    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity at t [s], ground axes [m/s]."""

    @abc.abstractmethod
    def mean_velocity(self) -> Float[Array, "3"]:
        """Return the velocity with which a ship at rest on the cable goes along, ground axes [m/s]."""


class SteadyMotion(AbstractAnchorMotion):
    """A truck or a ship under way: constant velocity.

    Attributes
    ----------
    speed : Float[Array, "3"]
        Velocity over the ground, ground axes [m/s].
    """

    speed: Float[Array, "3"]

    def displacement(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return V t [m]."""
        return self.speed * time

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return V [m/s]."""
        del time
        return self.speed

    def mean_velocity(self) -> Float[Array, "3"]:
        """Return V [m/s]."""
        return self.speed


class HarmonicMotion(AbstractAnchorMotion):
    """A deck or a mast that swings about its place.

    Attributes
    ----------
    amplitude : Float[Array, "3"]
        a along north, east, down [m].
    period : float
        T [s].
    phase : float
        φ₀ [rad]; with 0 the anchor passes its place at t = 0, towards a.
    """

    amplitude: Float[Array, "3"]
    period: Float[Array, ""]
    phase: Float[Array, ""]

    def displacement(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return a sin(2πt/T + φ₀) [m]."""
        return self.amplitude * jnp.sin(2.0 * jnp.pi * time / self.period + self.phase)

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return a 2π/T cos(2πt/T + φ₀) [m/s]."""
        pace = 2.0 * jnp.pi / self.period
        return self.amplitude * pace * jnp.cos(pace * time + self.phase)

    def mean_velocity(self) -> Float[Array, "3"]:
        """Return zero [m/s]: the anchor stays about its place."""
        return jnp.zeros(3)
