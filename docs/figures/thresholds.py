"""A flight's tension with the four tensions that are watched."""

import matplotlib.pyplot as plt

import tethership as ts

scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
flight = ts.dock(scenario, ts.trim(scenario), layers=("rewind", "heading"))
figure, axes = plt.subplots(figsize=(8, 3.5))
axes.semilogy(flight.data["time"], flight.data["tension"][:, 0], linewidth=0.9)
for level, name in zip(flight.attributes["limits"], ("control", "tear", "tensile", "break"), strict=True):
    axes.axhline(level, color="C3", linewidth=0.7)
    axes.text(0.5, level * 1.05, f"{name} {level:g} N", fontsize="x-small", color="C3")
axes.set(xlabel="time [s]", ylabel="tension at the tether point [N]", ylim=(5.0, 6000.0))
