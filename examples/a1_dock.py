"""Trim the paper's airship on its cable, fly the docking manoeuvre, look at it."""

from pathlib import Path

import tethership as ts

scenario = ts.load_scenario("docking", {"wind.speed": 9.0})  # every value can be changed by its dotted name, in SI
point = ts.trim(scenario)
print(f"trim: {point.outcome.name}, tension {float(point.tension[0]):.2f} N")

flight = ts.dock(scenario, point, layers=("rewind", "heading"))
print(f"flight: {flight.outcome.name} after {flight.docking_time:.2f} s")
print(f"largest tension {flight.metrics['tension_max']:.0f} N, mean {flight.metrics['tension_mean']:.0f} N")

out = Path("out")
out.mkdir(exist_ok=True)
flight.save(out / "a1_dock.nc")  # netCDF with units and the whole input: `tethership dock --from` flies it again
ts.plot_docking(flight).savefig(out / "a1_dock.png", dpi=120)
