"""What a mode looks like: which states take part in it, and how they lag behind each other."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import tethership as ts

scenario = ts.load_scenario("docking")
modes = ts.linearize(scenario, ts.trim(scenario)).modes()
names = ("pendulum", "surge–north", "heading–east", "roll oscillation")

figure, dials = plt.subplots(1, 4, figsize=(11.0, 4.4), subplot_kw={"projection": "polar"}, layout="constrained")
for dial, name in zip(dials, names, strict=True):
    mode = modes.find(name)
    print(f"{mode.name:<18} period {mode.period:5.1f} s, damping {mode.damping:+.2f}")
    largest = sorted(mode.shape, key=lambda state: -abs(mode.shape[state]))[:4]
    for state in largest:  # lengths in m/s and m at the hull's end, angles are phases
        part = mode.shape[state]
        dial.plot([0.0, np.angle(part)], [0.0, abs(part)], marker="o", markevery=[1], label=state)
    dial.set(title=f"{mode.name}\n{mode.period:.0f} s, damping {mode.damping:+.2f}", yticks=[0.5, 1.0], xticklabels=[])
    dial.legend(loc="lower center", ncols=2, fontsize="small", bbox_to_anchor=(0.5, -0.3), handlelength=1.0)
Path("out").mkdir(exist_ok=True)
figure.savefig("out/b3_mode_shapes.png", dpi=110)
