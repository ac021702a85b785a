"""A flight from its file: which load turns the ship, and what the air did meanwhile."""

from pathlib import Path

from matplotlib.figure import Figure

import tethership as ts

out = Path("out")
out.mkdir(exist_ok=True)
scenario = ts.load_scenario("docking", {"wind.speed": 9.0})
ts.dock(scenario, ts.trim(scenario)).save(out / "a3_flight.nc")

flight = ts.Flight.load(out / "a3_flight.nc")  # labelled, with units and the whole input; any netCDF tool reads it too
data = flight.data.sel(time=slice(15.0, 35.0))  # around the gust from the west
yawing = data["load_moment"].sel(body_axis="down")

figure = Figure(figsize=(8.0, 6.0), layout="constrained")
air, loads, heading = figure.subplots(3, 1, sharex=True)
air.plot(data["time"], data["wind"].sel(ground_axis="east"))
air.set_ylabel(f"wind, east [{data['wind'].units}]")
for name in ("apparent_mass", "envelope", "fins", "thrust", "cable_1"):
    loads.plot(data["time"], yawing.sel(load=name), label=name)
loads.set_ylabel(f"yawing moment [{yawing.units}]")
loads.legend(ncols=5, fontsize="small")
heading.plot(data["time"], data["attitude"].sel(angle="yaw") * 57.29578)
heading.set(xlabel="time [s]", ylabel="heading [deg]")
figure.savefig(out / "a3_flight_from_file.png", dpi=110)
