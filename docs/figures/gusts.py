"""The three shapes of a gust, and one that turns."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

from tethership.physics.gust import BareCosine, CosineGust, RepeatedCosine

east = jnp.array([0.0, 2.0, 0.0])
start, period = jnp.asarray(20.0), jnp.asarray(5.0)
time = jnp.linspace(17.0, 33.0, 800)
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2))
for name, kind in (("one_minus_cosine", CosineGust), ("repeated", RepeatedCosine), ("cosine", BareCosine)):
    left.plot(time, jax.vmap(kind(east, start, period).velocity)(time)[:, 1], label=name)
left.set(xlabel="time [s]", ylabel="added wind, east [m/s]", title="shapes, 2 m/s from the west")
left.legend(fontsize="small")
turning = jax.vmap(CosineGust(east, start, period, jnp.asarray(jnp.pi / 2)).velocity)(time)
right.plot(turning[:, 1], turning[:, 0])
right.set(xlabel="east [m/s]", ylabel="north [m/s]", title="one pulse that turns by 90°", aspect="equal")
