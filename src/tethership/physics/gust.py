"""Changes of the wind in time, uniform in space: a "1 − cos" gust, and a small change for a linear model.

Depends on: nothing.

References
----------
Section 4.1 of Riboldi et al. (side gust of one third of the wind, period 5 s, at t = 20 s); the pulse shape
is that of EASA CS-23/CS-25.341: ½A (1 − cos 2π(t − t₀)/T), zero before and after.
"""

import abc

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

NEVER = 1e9
"""A time after every flight [s]."""


class AbstractGust(eqx.Module):
    """A velocity added to the wind, ground axes [m/s], the same everywhere."""

    @abc.abstractmethod
    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]."""

    @abc.abstractmethod
    def corners(self) -> Float[Array, "n"]:
        """Return the times [s] at which it is not smooth, for the integrator to step on."""


class CosineGust(AbstractGust):
    """One pulse, whose direction may turn about the vertical while it lasts.

    Attributes
    ----------
    amplitude : Float[Array, "3"]
        Peak velocity of the pulse, a vector in ground axes [m/s].
    start : float
        Time at which it begins t₀ [s].
    period : float
        Its duration T [s].
    turn : float
        Angle by which it turns in that time [rad], clockwise seen from above; `amplitude` is its vector at the start.
    """

    amplitude: Float[Array, "3"]
    start: Float[Array, ""]
    period: Float[Array, ""]
    turn: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))

    @classmethod
    def silent(cls) -> "CosineGust":
        """Return a gust that adds 0 [m/s] and begins at `NEVER` [s], after every flight: a switch that is off."""
        return cls(jnp.zeros(3), jnp.full((), NEVER, dtype=float), jnp.ones(()), jnp.zeros(()))

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]; C¹ in t."""
        phase = jnp.clip((time - self.start) / self.period, 0.0, 1.0)
        north, east, down = self.amplitude
        cosine, sine = jnp.cos(self.turn * phase), jnp.sin(self.turn * phase)
        turned = jnp.stack([cosine * north - sine * east, sine * north + cosine * east, down])
        return 0.5 * turned * (1.0 - jnp.cos(2.0 * jnp.pi * phase))

    def corners(self) -> Float[Array, "2"]:
        """Return the two times [s] at which its second derivative jumps, for the integrator to step on."""
        return jnp.stack([self.start, self.start + self.period])


class RepeatedCosine(AbstractGust):
    """Pulses as `CosineGust`'s, one after the other to the end.

    Attributes
    ----------
    amplitude : Float[Array, "3"]
        Peak velocity, a vector in ground axes [m/s].
    start : float
        Time at which the first begins t₀ [s].
    period : float
        Duration of each T [s].
    """

    amplitude: Float[Array, "3"]
    start: Float[Array, ""]
    period: Float[Array, ""]

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return ½A (1 − cos 2π(t − t₀)/T) for t > t₀ [m/s], ground axes, at time t [s]; C¹ in t."""
        phase = jnp.maximum((time - self.start) / self.period, 0.0)
        return 0.5 * self.amplitude * (1.0 - jnp.cos(2.0 * jnp.pi * phase))

    def corners(self) -> Float[Array, "1"]:
        """Return the time [s] at which it begins."""
        return jnp.stack([self.start])


class BareCosine(AbstractGust):
    """One period of A cos 2π(t − t₀)/T, which begins and ends with a jump.

    Attributes
    ----------
    amplitude : Float[Array, "3"]
        Peak velocity A, a vector in ground axes [m/s].
    start : float
        Time at which it begins t₀ [s].
    period : float
        Its duration T [s].
    """

    amplitude: Float[Array, "3"]
    start: Float[Array, ""]
    period: Float[Array, ""]

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]; the jumps have no rate."""
        phase = (time - self.start) / self.period
        inside = (phase >= 0.0) & (phase < 1.0)
        return jnp.where(inside, 1.0, 0.0) * self.amplitude * jnp.cos(2.0 * jnp.pi * jnp.where(inside, phase, 0.0))

    def corners(self) -> Float[Array, "2"]:
        """Return the times [s] of its jumps, for the integrator to step on."""
        return jnp.stack([self.start, self.start + self.period])


class WindChange(AbstractGust):
    """A change of the wind and of its rate at t = 0: the wind as an input of a linear model.

    Attributes
    ----------
    change : Float[Array, "3"]
        Added velocity of the air Δv_w at t = 0, ground axes [m/s].
    rate : Float[Array, "3"]
        Its rate dv_w/dt, ground axes [m/s²].
    """

    change: Float[Array, "3"]
    rate: Float[Array, "3"]

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return Δv_w + t dv_w/dt [m/s], ground axes, at time t [s]."""
        return self.change + time * self.rate

    def corners(self) -> Float[Array, "0"]:
        """Return no times [s]: it is smooth."""
        return jnp.zeros(0)
