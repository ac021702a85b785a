"""A root locus over two numbers moved together: a lighter or heavier cable, and where its modes coalesce."""

from pathlib import Path

import numpy as np

import tethership as ts

scenario = ts.load_scenario("docking")
diameter = np.linspace(0.5e-3, 14e-3, 28)
cable = {"cables.nose.diameter": diameter, "cables.nose.linear_density": 800.0 * diameter**2}
loci = ts.sweep(scenario, cable)
for event in loci.events:
    print(event.kind, " and ".join(event.tracks), f"at {event.at['cables.nose.diameter'] * 1e3:.1f} mm")

axes = ts.plot_root_locus(loci, slow=True)
axes.set_title("A nose cable from 0.5 to 14 mm, wind 6 m/s")
Path("out").mkdir(exist_ok=True)
axes.figure.savefig("out/b2_root_locus.png", dpi=120)
