"""The two tension laws of a cable, from slack to taut: where the paper's joint departs from the exact catenary."""

from pathlib import Path

import jax
import jax.numpy as jnp
import matplotlib.figure

import tethership as ts

elongation = jnp.linspace(0.5, 1.04, 400)
direction = jnp.array([-1.0, 0.0, -1.0]) / jnp.sqrt(2.0)
figure = matplotlib.figure.Figure(figsize=(6.0, 4.0), layout="constrained")
axes = figure.subplots()

for formulation in ("published", "consistent"):
    cable = ts.load_scenario("docking", {"formulation": formulation}).system.cables[0]

    def tension(e, cable=cable):
        span = e * cable.length * direction
        load = cable.load.per_length(jnp.asarray(1.225), jnp.zeros(3), span)  # still air: weight alone
        return jnp.linalg.norm(cable.law.force(span, cable.length, load).ship)

    axes.semilogy(elongation, jax.vmap(tension)(elongation), label=type(cable.law).__name__)

axes.axhline(3040.0, color="grey", linewidth=0.8, label="breaking force")
axes.set(xlabel="elongation e [-]", ylabel="tension at the ship [N]")
axes.legend()
Path("out").mkdir(exist_ok=True)
figure.savefig("out/b1_tension_laws.png", dpi=120)
