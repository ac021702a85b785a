"""What a mode looks like: the ship at four instants of it, and which states take part."""

from pathlib import Path

from matplotlib.figure import Figure

import tethership as ts

scenario = ts.load_scenario("docking")
model = ts.linearize(scenario, ts.trim(scenario))
modes = model.modes()

figure = Figure(figsize=(10.0, 7.6), layout="constrained")
names = ("pendulum", "surge–north", "heading–east", "roll oscillation")
for axes, name in zip(figure.subplots(2, 2).flat, names, strict=True):
    shape = modes.find(name).shape  # lengths in m/s and m at the hull's end, the largest is 1
    largest = sorted(shape, key=lambda state: -abs(shape[state]))[:3]
    print(f"{name:<18} " + ", ".join(f"{state} {abs(shape[state]):.2f}" for state in largest))
    ts.plot_modes(model, name, axes)
Path("out").mkdir(exist_ok=True)
figure.savefig("out/b3_mode_shapes.png", dpi=110)
