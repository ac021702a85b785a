"""Normal force of one fin over its incidence: attached part, cross-flow part, sum."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts

fins = ts.load_scenario("docking").system.ship.fins
angles = jnp.radians(jnp.linspace(-90.0, 90.0, 181))


def normal_force(incidence):
    axial, normal = jnp.cos(incidence), jnp.sin(incidence)
    return fins.lift_area[0] * jnp.abs(axial) * normal, fins.cross_flow_area[0] * jnp.abs(normal) * normal


attached, separated = jax.vmap(normal_force)(angles)
figure, axes = plt.subplots(figsize=(6, 3.5))
axes.plot(jnp.degrees(angles), attached, "--", label=r"attached, $S C_{N\alpha}\eta_f\,\frac{1}{2}\sin 2\alpha$")
axes.plot(jnp.degrees(angles), separated, ":", label=r"cross-flow, $S C_{Dc}|\sin\alpha|\sin\alpha$")
axes.plot(jnp.degrees(angles), attached + separated, "k", label="sum")
axes.set(xlabel="incidence α [°]", ylabel=r"$-F_n/(\frac{1}{2}\rho V^2)$ [m²]")
axes.legend()
