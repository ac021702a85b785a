"""Tension over elongation: both laws, slack to taut."""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt

import tethership as ts

elongation = jnp.linspace(0.5, 1.06, 600)
figure, (wide, near) = plt.subplots(1, 2, figsize=(9, 3.8))
for formulation in ("consistent", "published"):
    cable = ts.load_scenario("docking", {"formulation": formulation}).system.cables[0]

    def tension(e, cable=cable):
        span = e * cable.length * jnp.array([-1.0, 0.0, -1.0]) / jnp.sqrt(2.0)
        load = cable.load.per_length(jnp.asarray(1.225), jnp.zeros(3), span)
        return jnp.linalg.norm(cable.law.force(span, cable.length, load).ship)

    curve = jax.vmap(tension)(elongation)
    wide.semilogy(elongation, curve, label=formulation)
    near.plot(elongation, curve)
wide.axhline(3040.0, color="0.6", linewidth=0.8)
near.axhline(3040.0, color="0.6", linewidth=0.8)
near.axvspan(0.99, 1.05, color="0.93")
near.text(1.0, 3900.0, "joint of the paper", fontsize="small")
near.set(xlim=(0.98, 1.06), ylim=(0.0, 4300.0), xlabel="elongation e [-]")
wide.set(xlabel="elongation e [-]", ylabel="tension at the ship [N]")
wide.legend()
