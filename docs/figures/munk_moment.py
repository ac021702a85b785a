"""Pitching moment of hull and fins over incidence, in steady flight at 6 m/s."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts

system = ts.load_scenario("docking").system
ship, environment = system.ship, system.environment
angles = jnp.radians(jnp.linspace(-60.0, 60.0, 121))
still = jnp.zeros(3)


def loads(incidence):
    air = 6.0 * jnp.stack([jnp.cos(incidence), 0.0, jnp.sin(incidence)])
    density = jnp.asarray(1.225)
    return {
        "apparent mass (Munk)": ship.apparent_mass.wrench(density, air, still, still, still, still),
        "envelope": ship.envelope.wrench(density, air, still),
        "fins": ship.fins.wrench(density, air, still, jnp.zeros(4)),
    }


moments = {name: wrench.moment[:, 1] for name, wrench in jax.vmap(loads)(angles).items()}
figure, axes = plt.subplots(figsize=(6, 3.8))
for name, moment in moments.items():
    axes.plot(jnp.degrees(angles), moment, label=name)
axes.plot(jnp.degrees(angles), sum(moments.values()), "k", linewidth=2, label="sum")
axes.axhline(0.0, color="0.7", linewidth=0.8)
axes.set(xlabel="incidence [°], positive with air from below", ylabel="moment about B, nose up [N m]")
axes.legend()
