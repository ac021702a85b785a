"""Density over altitude: standard, and a warm day."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

from tethership.physics.atmosphere import StandardAtmosphere

altitude = jnp.linspace(0.0, 11_000.0, 111)
figure, axes = plt.subplots(figsize=(5, 3.5))
for offset in (0.0, 20.0):
    air = StandardAtmosphere(jnp.asarray(0.0), jnp.asarray(offset))
    axes.plot(jax.vmap(air.density)(altitude), altitude / 1000.0, label=f"ISA + {offset:g} K")
axes.set(xlabel="density [kg/m³]", ylabel="altitude [km]")
axes.legend()
