"""Lamb's factors of a spheroid over its fineness, with the paper's Table 2."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

from tethership.physics.apparent_mass import lamb1932

fineness = jnp.linspace(1.05, 10.0, 200)
factors = jax.vmap(lamb1932)(fineness)
figure, axes = plt.subplots(figsize=(6, 3.5))
axes.plot(fineness, factors.axial, label="$k_1$, along the axis")
axes.plot(fineness, factors.lateral, label="$k_2$, across it")
axes.plot(fineness, factors.rotational, label="$k'$, about a transverse axis")
axes.plot([4.02] * 3, [0.08, 0.86, 0.69], "kx", label="Table 2 of the paper")
axes.set(xlabel="length over diameter [-]", ylabel="factor [-]")
axes.legend()
