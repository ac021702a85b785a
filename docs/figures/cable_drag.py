"""Wind load on one metre of cable over the angle between wind and cable."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts

load = ts.load_scenario("docking").system.cables[0].load
angles = jnp.radians(jnp.linspace(0.0, 180.0, 181))


def parts(angle):
    span = jnp.stack([jnp.cos(angle), 0.0, -jnp.sin(angle)])
    wind = load.per_length(jnp.asarray(1.225), jnp.array([10.0, 0.0, 0.0]), span)
    still = load.per_length(jnp.asarray(1.225), jnp.zeros(3), span)
    return wind - still


forces = jax.vmap(parts)(angles)
figure, axes = plt.subplots(figsize=(6, 3.5))
axes.plot(jnp.degrees(angles), -forces[:, 0], label="drag, against the motion")
axes.plot(jnp.degrees(angles), forces[:, 2], label="across the motion, downward")
axes.set(xlabel="angle between motion and cable [°]", ylabel="load at 10 m/s [N/m]")
axes.legend()
