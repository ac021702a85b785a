"""The modes of a tethered ship by name, and which of its numbers moves the pendulum most."""

from pathlib import Path

import matplotlib.figure

import tethership as ts

scenario = ts.load_scenario("docking", {"wind.speed": 9.0})
model = ts.linearize(scenario, ts.trim(scenario))
for mode in model.modes().modes:
    print(f"{mode.name:<18} {mode.eigenvalue:.4f} 1/s")

table = ts.sensitivities(scenario, "pendulum")
rows = [row for row in table.rows if row.shift is not None][:10][::-1]
figure = matplotlib.figure.Figure(figsize=(7.5, 4.0), layout="constrained")
axes = figure.subplots()
axes.barh([row.parameter for row in rows], [row.shift.real for row in rows])
axes.set(xlabel="change of the pendulum's Re λ by an ordinary step [1/s]", title=table.message)
Path("out").mkdir(exist_ok=True)
figure.savefig("out/a2_modes.png", dpi=120)
