"""A measured wind history. Depends on: diffrax to look up and evaluate the cubics."""

import diffrax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.turbulence.fluctuation import AbstractFluctuation

STEEPEST = 3.0
"""Slope at a sample over the smaller of its two secants, up to which a cubic never leaves the range of its ends."""


class MeasuredHistory(AbstractFluctuation):
    """A measured wind less its mean, the same everywhere; constant before its first sample and after its last.

    Attributes
    ----------
    path : diffrax.CubicInterpolation
        Monotone Hermite cubics through the samples [m/s], ground axes, of time [s].
    """

    path: diffrax.CubicInterpolation

    @classmethod
    def through(cls, times: Float[Array, "n"], velocities: Float[Array, "n 3"]) -> "MeasuredHistory":
        """Return the history through samples: times [s], rising, and wind less its mean, ground axes [m/s].

        Notes
        -----
        Each component lies between its neighbouring samples (Fritsch and Carlson 1980): a wind that was not measured
        is not flown.
        """
        steps = jnp.diff(times)[:, None]
        secants = jnp.diff(velocities, axis=0) / steps
        slopes = monotone_slopes(steps, secants)
        first, last = slopes[:-1], slopes[1:]
        quadratic = (3.0 * secants - 2.0 * first - last) / steps
        cubic = (first + last - 2.0 * secants) / steps**2
        return cls(diffrax.CubicInterpolation(times, (cubic, quadratic, first, velocities[:-1])))

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]; C¹ in t between the ends."""
        inside = jnp.where(time < self.path.t0, self.path.t0, jnp.where(time > self.path.t1, self.path.t1, time))
        return self.path.evaluate(inside)

    def rotation(self, time: Float[Array, ""], axis: Float[Array, "3"]) -> None:
        """Return None in place of a rate [rad/s]: one point was measured."""
        return


def monotone_slopes(steps: Float[Array, "n-1 1"], secants: Float[Array, "n-1 3"]) -> Float[Array, "n 3"]:
    """Return slopes at n samples that leave no overshoot between them [m/s²].

    Parameters
    ----------
    steps : Float[Array, "n-1 1"]
        hᵢ between samples [s].
    secants : Float[Array, "n-1 3"]
        δᵢ, slopes from each sample to the next [m/s²].

    Notes
    -----
    The slope of the parabola through three samples, (hᵢ δᵢ₋₁ + hᵢ₋₁ δᵢ)/(hᵢ₋₁ + hᵢ), at the ends of that through the
    outer three; zero where the secants differ in sign, and at most 3 min(|δᵢ₋₁|, |δᵢ|).
    """
    before, after, h0, h1 = secants[:-1], secants[1:], steps[:-1], steps[1:]
    inner = (h1 * before + h0 * after) / (h0 + h1)
    start = secants[:1] + h0[:1] / (h0[:1] + h1[:1]) * (before[:1] - after[:1])
    end = secants[-1:] + h1[-1:] / (h0[-1:] + h1[-1:]) * (after[-1:] - before[-1:])
    slopes = jnp.concatenate([start, inner, end])
    left, right = jnp.concatenate([secants[:1], secants]), jnp.concatenate([secants, secants[-1:]])
    steepest = STEEPEST * jnp.minimum(jnp.abs(left), jnp.abs(right))
    agree = (left * right > 0.0) & (slopes * left > 0.0)
    return jnp.where(agree, jnp.sign(left) * jnp.minimum(jnp.abs(slopes), steepest), 0.0)
