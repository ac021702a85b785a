"""Root loci: every mode's track in the complex plane, coloured along the parameter. Depends on: matplotlib, view."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tethership.analysis.loci import Sweep, partners_of
from tethership.analysis.modes import Complex, Modes
from tethership.errors import ConfigError
from tethership.scenario import ALIASES, list_parameters
from tethership.view import style
from tethership.view.linear.panel import Panel

SLOWEST = 0.4
"""Modulus within which a mode counts as slow [1/s]: what the zooms show."""

PANELS = (("all modes", False), ("slow modes", True))
"""Title of each plot of a sweep, and whether only the slow modes are shown."""

PANEL = (6.2, 5.2)
"""Width and height of one panel [inch]."""


def display(name: str, unit: str) -> tuple[str, str, float]:
    """Return label, unit and factor with which a parameter is shown: degrees for angles, millimetres for diameters.

    Parameters
    ----------
    name : str
        Dotted name.
    unit : str
        Its SI unit; "1" is shown as none.

    Returns
    -------
    tuple of str, str, float
        The factor is in the unit shown per SI unit: 180/π [°/rad] of angles, 1000 [mm/m] of a cable's diameter, else 1.
    """
    *path, last = name.replace("cables.*.", "cables.").replace("cables.", "cable ").replace("vehicle.", "").split(".")
    if path and path[-1] in ("tether_point", "position", "centre", "centre_of_gravity") and last in "012":
        last = ("forward", "starboard", "down")[int(last)]
    label = " ".join([*path, last]).replace("_", " ")
    if unit == "rad":
        return label, "°", 180.0 / np.pi
    if name.endswith("diameter") and "cables" in name:
        return label, "mm", 1e3
    return label, "" if unit == "1" else unit, 1.0


def colour_parameter(found: Sweep, name: str | None) -> str:
    """Return the parameter that colours a sweep; raises ConfigError for one that it does not have."""
    if name is None:
        return next(iter(found.values))
    full = ALIASES.get(name, name)
    if full not in found.values:
        raise ConfigError(f"the sweep has no parameter {name!r}; it has {', '.join(found.values)}")
    return full


@style.styled
def plot_root_locus(
    found: Sweep,
    axes: Axes | None = None,
    parameter: str | None = None,
    star: int | None = None,
    free: Modes | None = None,
    slow: bool = False,
) -> Axes:
    """Draw the eigenvalues of a sweep in the complex plane.

    Every mode is a line of dots coloured by the parameter, with an arrow where it ends and its name; points that
    cannot be trimmed are left out.

    Parameters
    ----------
    found : Sweep
        From `sweep`; of a grid, all lines are drawn.
    axes : Axes, optional
        Draw there; new ones if not given.
    parameter : str, optional
        Which parameter colours the dots; the first if not given.
    star : int, optional
        Point drawn as a star, the reference.
    free : Modes, optional
        Drawn as circles: the untethered ship.
    slow : bool
        Show only |λ| < 0.4 [1/s].

    Returns
    -------
    Axes
        Re λ [1/s] across, Im λ [rad/s] up; not shown and not saved.
    """
    if axes is None:
        axes = Figure(figsize=PANEL, layout="constrained").subplots()
    name = colour_parameter(found, parameter)
    label, unit, factor = display(name, found.units[name])
    value = found.values[name] * factor
    colours = ScalarMappable(Normalize(float(value.min()), float(value.max())), "viridis")
    good = found.trimmed
    kept = [track for track in found.tracks if not slow or np.any(np.abs(found.track(track)[good]) < SLOWEST)]
    _frame(axes, found, kept, free, slow)
    lines = np.arange(len(value)).reshape(-1, found.shape[-1])
    partners = partners_of(found.eigenvalues)
    for track in kept:
        roots, index = found.track(track), found.tracks.index(track)
        for line in lines:
            inside = line[good[line]]
            for part in _unbroken(roots[inside], partners[inside, index]):
                axes.plot(part.real, part.imag, color=style.BETWEEN, linewidth=style.HAIR, zorder=1)
            _arrow(axes, roots[inside])
        shade = style.INK if len(value) == 1 else colours.to_rgba(value[good])
        axes.scatter(roots[good].real, roots[good].imag, c=shade, s=16, zorder=2)
    _marks(axes, found, kept, star, free)
    _named(axes, found, kept)
    if len(value) > 1 and axes.figure is not None:
        bar = axes.figure.colorbar(colours, ax=axes, pad=0.02)
        bar.set_label(f"{label} [{unit}]" if unit else label)
    return axes


@style.styled
def plot_root_loci(found: Sweep) -> Figure:
    """Draw a sweep twice, all modes and the slow ones, |λ| < 0.4 [1/s]; the scenario's own values are the reference.

    Returns a figure that is not shown and not saved.
    """
    config = found.scenario.config
    drawn = Figure(figsize=(2 * PANEL[0], PANEL[1]), layout="constrained")
    title = f"{config.title}\nwind {config.wind.speed:g} m/s, {found.scenario.formulation} formulation"
    if "wind.speed" in found.values:
        title = f"{config.title}\n{found.scenario.formulation} formulation"
    title += ", closed loop" if found.loop == "closed" else ""
    drawn.suptitle(title)
    star = own_point(found)
    for axes, (words, slow) in zip(drawn.subplots(1, 2), PANELS, strict=True):
        plot_root_locus(found, axes, star=star, slow=slow)
        axes.set_title(words)
    return drawn


def own_point(found: Sweep) -> int | None:
    """Return the point whose parameters are the scenario's own, if there is one."""
    known = list_parameters(found.scenario.config)
    same = np.ones(len(found.outcomes), dtype=bool)
    for name, values in found.values.items():
        same &= np.isclose(values, known[name].value, rtol=1e-9, atol=1e-12)
    return int(np.flatnonzero(same)[0]) if same.any() else None


@style.styled
def plot_panels(panels: Sequence[Panel], title: str) -> Figure:
    """Draw root loci beside each other, Re λ [1/s] across, Im λ [rad/s] up.

    Returns a figure that is not shown and not saved.
    """
    count = len(panels)
    drawn = Figure(figsize=(PANEL[0] * count, PANEL[1]), layout="constrained")
    drawn.suptitle(title)
    for axes, panel in zip(np.atleast_1d(drawn.subplots(1, count)), panels, strict=True):
        _panel(axes, panel)
    return drawn


def _panel(axes: Axes, panel: Panel) -> None:
    plot_root_locus(panel.sweep, axes, panel.parameter, panel.star, panel.free, panel.slow)
    axes.set_title(panel.title)


def _frame(axes: Axes, found: Sweep, kept: list[str], free: Modes | None, slow: bool) -> None:
    """Set limits, axes through zero and labels."""
    drawn = [found.track(track)[found.trimmed] for track in kept]
    roots: Complex = np.concatenate([*drawn, np.zeros(1, dtype=np.complex128)])
    if free is not None:
        roots = np.concatenate([roots, free.eigenvalues])
    if slow:
        roots = roots[np.abs(roots) < SLOWEST]
    for low, high, limit in (
        (roots.real.min(initial=0.0), roots.real.max(initial=0.0), axes.set_xlim),
        (roots.imag.min(initial=0.0), roots.imag.max(initial=0.0), axes.set_ylim),
    ):
        margin = 0.08 * max(high - low, 1e-3)
        limit(low - 1.6 * margin, high + 1.6 * margin)
    axes.axvline(0.0, color=style.INK, linewidth=style.THIN)
    axes.axhline(0.0, color=style.INK, linewidth=style.THIN)
    axes.set_xlabel("Re λ [1/s]")
    axes.set_ylabel("Im λ [rad/s]")


def _unbroken(roots: Complex, partner: np.ndarray) -> list[Complex]:
    """Return a track in parts without the steps in which its conjugate becomes another one: its way is not straight."""
    return np.split(roots, np.flatnonzero(np.diff(partner)) + 1)


def _arrow(axes: Axes, roots: Complex) -> None:
    """Draw an arrow at the end of a track, in its last direction."""
    moved = np.flatnonzero(np.abs(roots - roots[-1]) > 1e-6) if len(roots) > 1 else np.array([], int)
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    inside = len(roots) > 0 and left <= roots[-1].real <= right and low <= roots[-1].imag <= high
    if len(moved) and inside:
        start, end = roots[moved[-1]], roots[-1]
        axes.annotate(
            "",
            xy=(end.real, end.imag),
            xytext=(start.real, start.imag),
            arrowprops={"arrowstyle": "-|>", "color": style.INK, "linewidth": style.THIN, "shrinkA": 0, "shrinkB": 0},
            annotation_clip=True,
        )


def _marks(axes: Axes, found: Sweep, kept: list[str], star: int | None, free: Modes | None) -> None:
    """Draw the reference as stars and the untethered ship as circles, and explain them."""
    handles = []
    if star is not None and found.trimmed[star] and len(found.outcomes) > 1:
        roots: Complex = np.array([found.track(track)[star] for track in kept], dtype=np.complex128)
        axes.plot(roots.real, roots.imag, "*", color=style.END, markersize=11, zorder=3)
        handles.append(Line2D([], [], marker="*", color=style.END, linestyle="none", markersize=9, label="reference"))
    if free is not None:
        roots = free.eigenvalues
        label = f"untethered, {len(roots)} states"
        axes.plot(roots.real, roots.imag, "o", color=style.INK, fillstyle="none", markersize=8, zorder=3)
        handles.append(Line2D([], [], marker="o", color=style.INK, fillstyle="none", linestyle="none", label=label))
    missing = int((~found.trimmed).sum())
    if missing:
        handles.append(Line2D([], [], linestyle="none", label=f"{missing} of {len(found.outcomes)} points: no trim"))
    if handles:
        axes.legend(handles=handles, loc="lower left", frameon=True)


def _named(axes: Axes, found: Sweep, kept: list[str]) -> None:
    """Write each mode's name at the middle of its track; of a pair once, at the upper member."""
    points = np.flatnonzero(found.trimmed)
    if not len(points):
        return
    point = points[len(points) // 2]
    names = dict(zip(found.tracks, found.names_at(int(point)), strict=True))
    (low, high), (left, right) = axes.get_ylim(), axes.get_xlim()
    placed: list[tuple[float, float]] = []
    for track in sorted(kept, key=lambda track: found.track(track)[point].real):
        root = found.track(track)[point]
        if root.imag < 0 or not (left <= root.real <= right and low <= root.imag <= high):
            continue
        x, y = (root.real - left) / (right - left), (root.imag - low) / (high - low)
        rise = 0.03
        while any(abs(x - other[0]) < 0.22 and abs(y + rise - other[1]) < 0.035 for other in placed):
            rise += 0.036
        placed.append((float(x), float(y + rise)))
        axes.annotate(
            names[track],
            xy=(root.real, root.imag),
            xytext=(float(x), float(y + rise)),
            textcoords="axes fraction",
            fontsize=style.SMALL,
            ha="center" if 0.1 < x < 0.9 else ("left" if x <= 0.1 else "right"),
            arrowprops={"arrowstyle": "-", "color": style.BETWEEN, "linewidth": style.HAIR} if rise > 0.05 else None,
            annotation_clip=True,
        )
