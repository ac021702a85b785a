"""The packaged hull, its strips, and what is left of the potential flow."""

import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts
from tethership.scenario.build_ship import STRIPS, build_hull

vehicle = ts.load_scenario("docking").config.vehicle
hull = build_hull(vehicle.hull)
station = jnp.linspace(0.0, hull.length, 400)
strips = hull.strips(jnp.asarray(0.0), jnp.asarray(vehicle.envelope.potential_length), STRIPS)
figure, axes = plt.subplots(figsize=(8, 3.2))
axes.plot(station, hull.radius(station), "k")
axes.plot(station, -hull.radius(station), "k")
axes.vlines(
    strips.station, -strips.radius, strips.radius, color="C0", linewidth=1, label="strips of the cross-flow drag"
)
axes.axvspan(vehicle.envelope.potential_length, hull.length, color="0.9", label="behind $l_h$")
axes.plot(hull.centre(), 0.0, "C3o", label="centre of volume")
axes.set(xlabel="distance from the nose ξ [m]", ylabel="radius [m]", aspect="equal")
axes.legend(loc="upper center", ncols=3, fontsize="small", bbox_to_anchor=(0.5, 1.35), frameon=False)
