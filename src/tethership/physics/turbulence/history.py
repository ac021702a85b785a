"""A measured wind history. Depends on: diffrax for the interpolation."""

import diffrax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.turbulence.fluctuation import AbstractFluctuation


class MeasuredHistory(AbstractFluctuation):
    """A measured wind less its mean, the same everywhere; constant before its first sample and after its last.

    Attributes
    ----------
    path : diffrax.CubicInterpolation
        Hermite cubics through the samples, slopes by backward differences [m/s], ground axes, of time [s].
    """

    path: diffrax.CubicInterpolation

    @classmethod
    def through(cls, times: Float[Array, "n"], velocities: Float[Array, "n 3"]) -> "MeasuredHistory":
        """Return the history through samples: times [s], rising, and wind less its mean, ground axes [m/s]."""
        coefficients = diffrax.backward_hermite_coefficients(times, velocities)
        return cls(diffrax.CubicInterpolation(times, coefficients))

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]; C¹ in t between the ends."""
        return self.path.evaluate(jnp.clip(time, self.path.t0, self.path.t1))

    def rotation(self, time: Float[Array, ""], axis: Float[Array, "3"]) -> None:
        """Return None in place of a rate [rad/s]: one point was measured."""
        return
