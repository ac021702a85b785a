"""Thrust over throttle and over axial airspeed, with and without lapse."""

import equinox as eqx
import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts
from tethership.spatial.constants import SEA_LEVEL_DENSITY

thrusters = ts.load_scenario("docking").system.ship.thrusters
lapsing = eqx.tree_at(lambda t: t.lapse, thrusters, jnp.full(6, 1.0 / 25.0))
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.2))
throttle = jnp.linspace(-1.0, 1.0, 51)
speed = jnp.linspace(-5.0, 25.0, 51)
density = jnp.asarray(SEA_LEVEL_DENSITY)


def first(thrusters, value, along):
    return thrusters.thrust(density, jnp.stack([along, 0.0, 0.0]), jnp.zeros(3), jnp.full(6, value))[0]


left.plot(throttle, [first(thrusters, value, jnp.asarray(0.0)) for value in throttle])
left.set(xlabel="throttle δ [-]", ylabel="thrust [N]", title="at rest, sea level")
for label, kind in (("no lapse", thrusters), ("no thrust at 25 m/s", lapsing)):
    right.plot(speed, [first(kind, 1.0, along) for along in speed], label=label)
right.set(xlabel="axial airspeed [m/s]", title="full throttle")
right.legend()
