"""Mean wind over height: the three profiles through 6 m/s at 10 m."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

from tethership.physics.wind import LogarithmicWind, PowerLawWind, UniformWind

north = jnp.array([-6.0, 0.0, 0.0])
height = jnp.linspace(0.02, 40.0, 400)
reference, zero = jnp.asarray(10.0), jnp.asarray(0.0)
profiles = {
    "uniform": UniformWind(north),
    "power law, α = 1/7": PowerLawWind(north, reference, jnp.asarray(1.0 / 7.0), jnp.asarray(0.5), zero),
    "logarithmic, z₀ = 0.03 m": LogarithmicWind(north, reference, jnp.asarray(0.03), zero),
}
figure, axes = plt.subplots(figsize=(5, 3.5))
for name, profile in profiles.items():
    speed = jax.vmap(lambda h, profile=profile: -profile.velocity(jnp.stack([0.0, 0.0, -h]))[0])(height)
    axes.plot(speed, height, label=name)
axes.set(xlabel="wind [m/s]", ylabel="height above ground [m]")
axes.legend()
