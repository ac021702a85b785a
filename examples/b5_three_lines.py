"""Another ship on several cables: an ellipsoidal aerostat on three lines, their tension for every wind direction."""

from pathlib import Path

import matplotlib.figure
import numpy as np

import tethership as ts

bearings = np.radians(np.arange(0.0, 361.0, 10.0))
still = ts.trim(ts.load_scenario("three_lines", {"wind.speed": 0.0}))
print("still air:", still.tension.round(1), "N")

figure = matplotlib.figure.Figure(figsize=(9.0, 5.2), layout="constrained")
for place, speed in enumerate((10.0, 20.0), 1):
    points = [
        ts.trim(ts.load_scenario("three_lines", {"wind.speed": speed, "wind.from_direction": bearing}), throw=True)
        for bearing in bearings
    ]
    tension = np.array([point.tension for point in points]) / 1e3
    axes = figure.add_subplot(1, 2, place, projection="polar")
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    for line, name, bearing in zip(tension.T, ("north", "south_east", "south_west"), (0.0, 120.0, 240.0), strict=True):
        axes.plot(bearings, line, label=f"line to the {name.replace('_', '-')} ({bearing:.0f}°)")
    axes.set_title(f"tension [kN] by where {speed:.0f} m/s come from", pad=14)
    taut, slack = tension.max(), tension.min()
    print(f"{speed:.0f} m/s: {slack:.2f} to {taut:.2f} kN, pitch {np.degrees(points[0].state.attitude[1]):.1f}°")
figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
Path("out").mkdir(exist_ok=True)
figure.savefig("out/b5_three_lines.png", dpi=120)
