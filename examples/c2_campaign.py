"""The odds in place of one flight: how often each limit is exceeded in gusty wind, under three laws."""

from pathlib import Path

import tethership as ts

found = ts.run_campaign("layers", "out/c2_campaign", {"samples": 48})
for law, answers in found.answers["laws"].items():
    tear = answers["exceedance"]["envelope_tear"]
    share, low, high = (100.0 * tear[key] for key in ("probability", "low", "high"))
    print(f"{law}: torn in {share:.0f} % of flights ({low:.0f} … {high:.0f} %)")

axes = ts.plot_campaign(found)  # kind="peaks", "times", "convergence", "importance" show other sides
axes.axvline(0.01, color="0.6", linestyle="--", label="1 %")
axes.legend()
Path("out").mkdir(exist_ok=True)
axes.figure.savefig("out/c2_campaign.png", dpi=120)
