"""The odds in place of one flight: how often the envelope is torn in gusty wind, under three laws."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import tethership as ts

found = ts.run_campaign("layers", "out/c2_campaign", {"samples": 48})
for law, answers in found.answers["laws"].items():
    tear = answers["exceedance"]["envelope_tear"]
    share, low, high = (100.0 * tear[key] for key in ("probability", "low", "high"))
    print(f"{law}: torn in {share:.0f} % of flights ({low:.0f} … {high:.0f} %)")

drawn = Figure(layout="constrained")
axes = drawn.subplots()
for law in found.data["law"].values:
    peaks = np.sort(found.data["tension_max"].sel(law=law))
    axes.semilogx(peaks, 1.0 - np.arange(len(peaks)) / len(peaks), drawstyle="steps-post", label=law)
axes.set_xlabel("largest tension [N]")
axes.set_ylabel("share of flights above it")
axes.legend()
Path("out").mkdir(exist_ok=True)
drawn.savefig("out/c2_campaign.png", dpi=120)
