"""Pictures of an identification: ranges, correlations, residuals. Depends on: fitting (a fit's data), matplotlib."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tethership.studies.docking_paper.fit.space import UNKNOWNS, to_shares
from tethership.view import style

LAYERS = ("rewind", "heading", "navigation")


def _words(name: str) -> str:
    return name.replace("_", " ")


@style.styled
def plot_marginals(fit: dict[str, Any]) -> Figure:
    """Draw where every unknown lies between its bounds, 0 … 1 [-]: the best vector, and 5–95 % of the set."""
    members = to_shares(np.array(fit["members"]))
    best = to_shares(np.array(list(fit["parameters"].values())))
    drawn = Figure(figsize=(8.0, 0.42 * len(UNKNOWNS) + 1.2), layout="constrained")
    axes = drawn.subplots()
    generator = np.random.default_rng(0)
    for row, unknown in enumerate(UNKNOWNS):
        low, high = np.percentile(members[:, row], [5.0, 95.0])
        axes.plot([low, high], [row, row], color=style.SERIES[0], linewidth=6.0, alpha=0.35, solid_capstyle="round")
        jitter = row + generator.uniform(-0.18, 0.18, len(members))
        axes.plot(members[:, row], jitter, ".", color=style.SERIES[0], markersize=2.5, alpha=0.6)
        axes.plot(best[row], row, "D", color=style.END, markersize=5.0)
        for place, value in ((-0.015, unknown.low), (1.015, unknown.high)):
            side = "right" if place < 0 else "left"
            axes.text(place, row, f"{value:g}", ha=side, va="center", fontsize=style.SMALL, color="0.35")
    axes.set_yticks(range(len(UNKNOWNS)), [f"{_words(u.name)} [{u.unit}]" for u in UNKNOWNS])
    axes.tick_params(axis="y", pad=34, length=0)
    axes.set_xlim(0.0, 1.0)
    axes.set_xticks([])
    axes.grid(False)
    axes.invert_yaxis()
    axes.set_title(
        f"Between the bounds: best vector (diamond) and 5–95 % of the set, {fit['formulation']}",
    )
    axes.margins(x=0.0)
    return drawn


@style.styled
def plot_correlation(fit: dict[str, Any]) -> Figure:
    """Draw how the unknowns go together over the set that fits nearly as well: correlations [-]."""
    matrix = np.array(fit["correlation"])
    names = [_words(u.name) for u in UNKNOWNS]
    drawn = Figure(figsize=(7.2, 6.4), layout="constrained")
    axes = drawn.subplots()
    image = axes.imshow(matrix, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    axes.grid(False)
    axes.set_xticks(range(len(names)), names, rotation=45, ha="right")
    axes.set_yticks(range(len(names)), names)
    for i, j in np.ndindex(matrix.shape):
        if i != j and abs(matrix[i, j]) >= 0.3:
            dark = abs(matrix[i, j]) > 0.7
            text = f"{matrix[i, j]:.1f}".replace("-", "−")
            axes.text(j, i, text, ha="center", va="center", fontsize=style.SMALL, color="white" if dark else "black")
    drawn.colorbar(image, ax=axes, shrink=0.8, label="correlation")
    axes.set_title(f"Correlation over {len(fit['members'])} vectors of the set")
    return drawn


@style.styled
def plot_residuals(fit: dict[str, Any]) -> Figure:
    """Draw computed over published [-] of every fitted number, by table and wind [m/s]."""
    metrics = list(dict.fromkeys(entry["metric"] for entry in fit["items"]))
    drawn = Figure(figsize=(8.4, 3.6), layout="constrained")
    axes = drawn.subplots()
    axes.axhspan(1 / 1.2, 1.2, color="0.9", zorder=0)
    axes.axhline(1.0, color="0.5", linewidth=style.THIN)
    marks = {"rewind": "o", "heading": "s", "navigation": "^"}
    for table, mark in marks.items():
        for wind, shade in ((6.0, style.START), (12.0, style.END)):
            chosen = [e for e in fit["items"] if e["table"] == table and e["wind"] == wind]
            shift = 0.09 * (LAYERS.index(table) - 1) * 2 + (0.05 if wind > 9.0 else -0.05)
            places = [metrics.index(e["metric"]) + shift for e in chosen]
            ratios = [float(np.exp(e["residual"] * e["tolerance"])) for e in chosen]
            axes.plot(places, ratios, mark, color=shade, markersize=5.0, label=f"{table}, {wind:g} m/s")
    axes.set_yscale("log")
    axes.set_yticks([0.5, 0.7, 1.0, 1.4, 2.0], ["0.5", "0.7", "1", "1.4", "2"])
    axes.minorticks_off()
    labels = [
        _words(metric).replace("seconds above.0", "time > 144 N").replace("seconds above.1", "time > 481 N")
        for metric in metrics
    ]
    axes.set_xticks(range(len(metrics)), labels)
    axes.set_ylabel("computed / published")
    axes.legend(ncols=3, loc="best")
    axes.set_title("Fitted numbers; the band is 20 %")
    return drawn
