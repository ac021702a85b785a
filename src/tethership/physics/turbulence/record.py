"""Continuous turbulence as a record made beforehand from a seed. Depends on: nothing.

The record is periodic, made in the frequency domain from the spectrum, and read between its samples by a cubic
B-spline, so that the plant stays a smooth function of time and any solver may call it twice. Frozen turbulence
(Taylor): what passes the ship at time t is what the mean wind U carries, Ω = ω/U.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.turbulence.fluctuation import AbstractFluctuation
from tethership.physics.turbulence.spectra import Scales, Spectrum

SAMPLES = 4096
"""Samples of a record N."""

INTERVAL = 0.1
"""Time between samples Δt [s]: the record holds frequencies up to 5 Hz and repeats itself after 409.6 s."""


class Turbulence(AbstractFluctuation):
    """A record of turbulence at the ship, and its slope along the wind.

    Attributes
    ----------
    coefficients : Float[Array, "4099 3"]
        Of the cubic B-spline through the record [m/s], ground axes; the first three again at the end.
    direction : Float[Array, "3"]
        Unit vector of the mean wind [-], ground axes.
    speed : Float[Array, ""]
        Mean wind U that carries it past [m/s].
    gradients : bool
        Whether the hull feels that the air differs from nose to tail.
    """

    coefficients: Float[Array, "4099 3"]
    direction: Float[Array, "3"]
    speed: Float[Array, ""]
    gradients: bool = eqx.field(static=True)

    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]; C² in t, period 409.6 s."""
        place = jnp.mod(time / INTERVAL, SAMPLES)
        first = jnp.floor(place)
        near = jax.lax.dynamic_slice_in_dim(self.coefficients, first.astype(int), 4)
        return _spline_weights(place - first) @ near

    def rotation(self, time: Float[Array, ""], axis: Float[Array, "3"]) -> Float[Array, "3"] | None:
        """Return the rate at which the air turns a slender hull [rad/s], ground axes, None where that is not felt.

        Parameters
        ----------
        time : Float[Array, ""]
            t [s].
        axis : Float[Array, "3"]
            Unit vector i along the hull, ground axes.

        Notes
        -----
        Frozen turbulence has the gradient G = −(dv/dt) ŵᵀ/U. A station at distance x along the hull meets v + G i x;
        across the hull that is ω × i x with ω = i × G i. Rolling rates of the air do not come of it. Of a record
        averaged over the hull's length ℓ the gradient along the wind is (v_nose − v_tail)/ℓ, whatever the wavelength.
        """
        if not self.gradients:
            return None
        _, rate = jax.jvp(self.velocity, (time,), (jnp.ones_like(time),))
        slope = -rate * (self.direction @ axis) / jnp.maximum(self.speed, 0.1)
        return jnp.cross(axis, slope)


def _spline_weights(share: Float[Array, ""]) -> Float[Array, "4"]:
    """Return the four values of a uniform cubic B-spline at a share 0 … 1 of an interval."""
    rest = 1.0 - share
    return jnp.stack(
        [
            rest**3,
            3.0 * share**3 - 6.0 * share**2 + 4.0,
            3.0 * rest**3 - 6.0 * rest**2 + 4.0,
            share**3,
        ]
    ) / 6.0  # fmt: skip


def make_turbulence(
    spectrum: Spectrum,
    scales: Scales,
    wind: Float[Array, "3"],
    seed: Float[Array, ""],
    hull_length: Float[Array, ""],
    gradients: bool,
) -> Turbulence:
    """Return a record of turbulence.

    Parameters
    ----------
    spectrum : callable
        One of `SPECTRA`.
    scales : Scales
        Lengths and intensities.
    wind : Float[Array, "3"]
        Mean wind, ground axes [m/s]; its level direction is that of the component u.
    seed : Float[Array, ""]
        A whole number: the same seed gives the same record.
    hull_length : Float[Array, ""]
        Length ℓ over which the air is averaged [m], 0 for turbulence at a point.
    gradients : bool
        As in `Turbulence`.

    Notes
    -----
    x(t) = √(½Φ(0) ΔΩ) a₀ + Σ √(Φ(Ω_k) ΔΩ) (a_k cos ω_k t − b_k sin ω_k t), a, b standard normal, ω_k = 2πk/(N Δt),
    Ω_k = ω_k/U: what is slower than the record is a constant in it, what is faster than 5 Hz is left out, not folded
    back. The mean over a hull aligned with the wind multiplies each harmonic by sin(½Ωℓ)/(½Ωℓ).
    """
    speed = jnp.sqrt(jnp.sum(wind**2) + 1e-12)
    carried = jnp.maximum(speed, 0.1)
    harmonic = jnp.arange(SAMPLES // 2)
    step = 2.0 * jnp.pi / (SAMPLES * INTERVAL) / carried
    wavenumber = (harmonic * step)[:, None]
    mean = jnp.sinc(wavenumber * hull_length / (2.0 * jnp.pi))
    strength = 0.5 * SAMPLES * jnp.sqrt(spectrum(wavenumber, scales) * step) * mean
    draw = jax.random.normal(jax.random.key(seed.astype(int)), (SAMPLES // 2, 3, 2))
    amplitude = strength * (draw[..., 0] + 1j * draw[..., 1])
    amplitude = amplitude.at[0].set(jnp.sqrt(2.0) * amplitude[0].real)
    symbol = (4.0 + 2.0 * jnp.cos(2.0 * jnp.pi * harmonic / SAMPLES)) / 6.0
    spline = jnp.concatenate([amplitude / symbol[:, None], jnp.zeros((1, 3))])
    knots = jnp.fft.irfft(spline, SAMPLES, axis=0)
    along = wind / carried
    level = jnp.stack([along[0], along[1], jnp.zeros(())])
    across = jnp.stack([-along[1], along[0], jnp.zeros(())])
    axes = jnp.stack([level, across, jnp.array([0.0, 0.0, 1.0])])
    ground = jnp.roll(knots, 1, axis=0) @ axes
    return Turbulence(jnp.concatenate([ground, ground[:3]]), along, speed, gradients)
