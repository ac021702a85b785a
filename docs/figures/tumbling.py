"""The ship as a free rigid body: a small disturbance of rotation about each axis, without air or weight."""

import diffrax
import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts

body = ts.load_scenario("docking").system.ship.body
matrix = body.mass_matrix()


def rate(time, motion, _):
    load = body.gyroscopic(motion[:3], motion[3:])
    return jnp.linalg.solve(matrix, -jnp.concatenate([load.force, load.moment]))


figure, panels = plt.subplots(1, 3, figsize=(10, 2.8), sharey=True)
for axis, (panel, name) in enumerate(zip(panels, ("roll", "pitch", "yaw"), strict=True)):
    spin = jnp.full(3, 0.01).at[axis].set(1.0)
    begin = jnp.concatenate([-jnp.cross(spin, body.centre), spin])
    saved = diffrax.SaveAt(ts=jnp.linspace(0.0, 40.0, 400))
    steps = diffrax.PIDController(rtol=1e-9, atol=1e-9)
    flown = diffrax.diffeqsolve(
        diffrax.ODETerm(rate), diffrax.Dopri8(), 0.0, 40.0, 0.01, begin, saveat=saved, stepsize_controller=steps
    )
    for part, label in enumerate("pqr"):
        panel.plot(flown.ts, flown.ys[:, 3 + part], label=label)
    panel.set(xlabel="time [s]", title=f"spun in {name}")
panels[0].set_ylabel("rates [rad/s]")
panels[0].legend()
