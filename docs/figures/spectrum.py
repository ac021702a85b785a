"""Eigenvalues of the moored ship at 6 m/s in both formulations, by name; right, those near zero."""

import matplotlib.pyplot as plt

import tethership as ts

figure, panels = plt.subplots(1, 2, figsize=(10, 4.0))
for formulation, mark in (("consistent", "o"), ("published", "x")):
    scenario = ts.load_scenario("docking", {"formulation": formulation})
    for mode in ts.linearize(scenario, ts.trim(scenario)).modes().modes:
        place = (mode.eigenvalue.real, abs(mode.eigenvalue.imag))
        for panel in panels:
            panel.plot(*place, mark, color="C0" if mark == "o" else "C1")
        if mark == "o":
            fast = abs(mode.eigenvalue) > 0.3
            panels[0 if fast else 1].annotate(mode.name, place, (4, 5), textcoords="offset points", fontsize="small")
for panel in panels:
    panel.axvline(0.0, color="0.7", linewidth=0.8)
    panel.set(xlabel="Re λ [1/s]")
panels[0].plot([], [], "C0o", label="consistent")
panels[0].plot([], [], "C1x", label="published")
panels[0].set(ylabel="|Im λ| [rad/s]", xlim=(-1.2, 0.3))
panels[0].legend(loc="center")
panels[1].set(xlim=(-0.15, 0.14), ylim=(-0.01, 0.27))
