"""Spectra of both forms at 6.1 m above ground in 10 m/s, and the estimate from records."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np

from tethership.physics.turbulence import (
    INTERVAL,
    SAMPLES,
    dryden1952,
    low_altitude_scales,
    make_turbulence,
    von_karman1948,
)

speed = 10.0
scales = low_altitude_scales(jnp.asarray(6.096), jnp.asarray(speed))
wind = jnp.array([-speed, 0.0, 0.0])
time = jnp.arange(SAMPLES) * INTERVAL
waves = np.fft.rfftfreq(SAMPLES, INTERVAL)[1:] * 2.0 * np.pi / speed


def periodogram(seed, length):
    record = make_turbulence(dryden1952, scales, wind, seed, length, False)
    vertical = jax.vmap(record.velocity)(time)[:, 2]
    spectrum = jnp.abs(jnp.fft.rfft(vertical)[1:]) ** 2 * 2.0 * INTERVAL / SAMPLES
    return spectrum * speed / (2.0 * jnp.pi)


seeds = jnp.arange(1.0, 41.0)
figure, axes = plt.subplots(1, 2, figsize=(10, 3.8))
for name, form in (("Dryden", dryden1952), ("von Kármán", von_karman1948)):
    along, _, vertical = np.asarray(form(jnp.asarray(waves)[:, None], scales)).T
    axes[0].loglog(waves, along, label=f"{name}, $\\Phi_u$")
    axes[0].loglog(waves, vertical, "--", label=f"{name}, $\\Phi_w$")
for length, label in ((0.0, "at a point"), (16.0, "averaged over 16 m")):
    mean = np.asarray(jax.vmap(lambda s, length=length: periodogram(s, jnp.asarray(length)))(seeds)).mean(axis=0)
    axes[1].loglog(waves, mean, label=f"40 records, {label}")
axes[1].loglog(waves, np.asarray(dryden1952(jnp.asarray(waves)[:, None], scales))[:, 2], "k", label="Dryden, $\\Phi_w$")
axes[1].set_ylim(1e-5, 30.0)
for panel in axes:
    panel.set(xlabel="spatial frequency Ω [rad/m]")
    panel.legend(fontsize="small")
axes[0].set_ylabel("Φ [m³/s² per rad]")
