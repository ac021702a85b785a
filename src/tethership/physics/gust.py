"""A single "1 − cos" gust, uniform in space. Depends on: nothing.

References
----------
Section 4.1 of Riboldi et al. (side gust of one third of the wind, period 5 s, at t = 20 s); the pulse shape
is that of EASA CS-23/CS-25.341: ½A (1 − cos 2π(t − t₀)/T), zero before and after.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class CosineGust(eqx.Module):
    """One pulse in a fixed direction.

    Attributes
    ----------
    amplitude : Float[Array, "3"]
        Peak velocity of the pulse, a vector in ground axes [m/s].
    start : float
        Time at which it begins t₀ [s].
    period : float
        Its duration T [s].
    """

    amplitude: Float[Array, "3"]
    start: Float[Array, ""]
    period: Float[Array, ""]

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]; C¹ in t."""
        phase = jnp.clip((time - self.start) / self.period, 0.0, 1.0)
        return 0.5 * self.amplitude * (1.0 - jnp.cos(2.0 * jnp.pi * phase))

    def corners(self) -> Float[Array, "2"]:
        """Return the two times [s] at which its second derivative jumps, for the integrator to step on."""
        return jnp.stack([self.start, self.start + self.period])
