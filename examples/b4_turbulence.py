"""The same flight in ten records of turbulence: how much one flight says, and how little."""

from pathlib import Path

from matplotlib.figure import Figure

import tethership as ts

scenario = ts.load_scenario("docking_paper", {"wind.speed": 9.0, "turbulence.spectrum": "dryden"})
point = ts.trim(scenario)  # in the mean wind: one trim serves all
figure = Figure(figsize=(8.0, 4.5), layout="constrained")
above, below = figure.subplots(2, 1, sharex=True)
for seed in range(1, 11):
    flight = ts.dock(scenario.changed({"turbulence.seed": seed}), point)
    wind, tension = flight.data["wind"].sel(ground_axis="east"), flight.data["tension"].sel(cable="nose")
    print(f"seed {seed:2d}: {flight.outcome.name}, largest tension {flight.metrics['tension_max']:.0f} N")
    above.plot(flight.data["time"], wind, linewidth=0.8)
    below.semilogy(flight.data["time"], tension, linewidth=0.8)
above.set_ylabel("wind, east [m/s]")
below.set(xlabel="time [s]", ylabel="tension [N]", ylim=(1.0, 5000.0))
Path("out").mkdir(exist_ok=True)
figure.savefig("out/b4_turbulence.png", dpi=110)
