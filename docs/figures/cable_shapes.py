"""One cable from slack to all but taut, under its weight, and in the wind."""

import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts

figure, axes = plt.subplots(1, 2, figsize=(9, 4.2), sharey=True)
for panel, speed in zip(axes, (0.0, 12.0), strict=True):
    cable = ts.load_scenario("docking").system.cables[0]
    arc = jnp.linspace(0.0, cable.length, 101)
    for elongation in (0.3, 0.6, 0.8, 0.95, 0.999):
        span = elongation * cable.length * jnp.array([-1.0, 0.0, -1.0]) / jnp.sqrt(2.0)
        load = cable.load.per_length(jnp.asarray(1.225), jnp.array([speed, 0.0, 0.0]), span)
        curve = cable.law.shape(span, cable.length, load, arc)
        panel.plot(curve[:, 0], -curve[:, 2], label=f"e = {elongation:g}")
    panel.set(xlabel="north [m]", aspect="equal", title=f"wind from the north {speed:g} m/s")
axes[0].set_ylabel("height above the anchor [m]")
axes[1].legend(loc="lower left")
