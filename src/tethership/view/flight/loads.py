"""The loads of a flight in one plot. Depends on: matplotlib, results (their names), view."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tethership.errors import ConfigError, SolveError, suggestion
from tethership.results import BODY
from tethership.simulation import Flight
from tethership.view import style

Array = NDArray[np.float64]

KINDS = {"force": "force [N]", "moment": "moment about P [N m]"}
"""What a load has, and its unit."""

DECADES = 4.0
"""Most decades of the axis below the largest load [-]."""


@style.styled
def plot_loads(
    flight: Flight,
    axes: Axes | None = None,
    kind: str = "force",
    component: str | None = None,
    names: Sequence[str] | None = None,
) -> Axes:
    """Draw every named load over time: its size on a logarithmic axis, or one of its components in body axes.

    Weight and buoyancy nearly cancel and are drawn together as `net_weight`. The legend is sorted by root mean square.

    Parameters
    ----------
    flight : Flight
        From `dock` or `Flight.load`; any number of cables.
    axes : Axes, optional
        Draw there; new ones if not given.
    kind : str
        `force` [N] or `moment` about P [N m].
    component : str, optional
        `forward`, `starboard` or `down`, body axes; the size if not given.
    names : sequence of str, optional
        Only these loads; all if not given.

    Returns
    -------
    Axes
        Time [s] across; not shown and not saved: ``plot_loads(flight).figure.savefig("loads.png")``.

    Raises
    ------
    ConfigError
        There is no such kind, component or load.
    SolveError
        The flight has no sample.
    """
    loads = _chosen(flight, kind, names)
    if component is not None:
        loads = {name: load[:, _place(component)] for name, load in loads.items()}
    else:
        loads = {name: np.linalg.norm(load, axis=1) for name, load in loads.items()}
    if axes is None:
        axes = Figure(figsize=(8.6, 4.4), layout="constrained").subplots()
    unit = KINDS[kind].rsplit("[", 1)[1].rstrip("]")
    time = flight.data["time"].to_numpy()
    strengths = {name: float(np.sqrt(np.mean(load**2))) for name, load in loads.items()}
    ordered = sorted(loads, key=lambda name: -strengths[name])
    for place, name in enumerate(ordered):
        dashes = style.dash(place)
        line = (0.0, tuple(0.7 * part for part in dashes)) if dashes else "-"
        label = f"{name.replace('_', ' ')}, rms {strengths[name]:.3g} {unit}"
        look = {"linestyle": line, "color": style.cable_colour(place)}
        axes.plot(time, loads[name], label=label, gid=name, **look)
    _dress(axes, loads, component is None)
    of = "" if component is None else f"{component} component of "
    axes.set_ylabel(of + KINDS[kind])
    return axes


def _chosen(flight: Flight, kind: str, names: Sequence[str] | None) -> dict[str, Array]:
    """Return the loads that are drawn by name, body axes, shape (samples, 3) each."""
    if kind not in KINDS:
        raise ConfigError(f"there is no kind {kind!r} of load{suggestion(kind, KINDS)} Allowed: {', '.join(KINDS)}")
    if flight.data.sizes["time"] == 0:
        raise SolveError("the flight has no sample to draw: it diverged at its start")
    loads = load_vectors(flight, kind)
    for name in names or ():
        if name not in loads:
            raise ConfigError(f"the flight has no load {name!r}{suggestion(name, loads)} There are: {', '.join(loads)}")
    return loads if names is None else {name: loads[name] for name in names}


def load_vectors(flight: Flight, kind: str) -> dict[str, Array]:
    """Return each load over time by its label, `net_weight` for weight and buoyancy together.

    Parameters
    ----------
    flight : Flight
        Flown or loaded.
    kind : str
        `force` [N] or `moment` about P [N m].

    Returns
    -------
    dict of str to Array
        Body axes, shape (samples, 3) each.
    """
    stored = flight.data[f"load_{kind}"]
    loads = {str(name): stored.sel(load=name).to_numpy() for name in stored["load"].to_numpy()}
    return {"net_weight": loads.pop("gravity") + loads.pop("buoyancy"), **loads}


def _place(component: str) -> int:
    """Return the place of a component among the body axes."""
    if component not in BODY:
        raise ConfigError(
            f"there is no component {component!r}{suggestion(component, BODY)} Allowed: {', '.join(BODY)}"
        )
    return BODY.index(component)


def _dress(axes: Axes, loads: dict[str, Array], logarithmic: bool) -> None:
    """Set the axes, their labels and the legend."""
    top = max((float(load.max()) for load in loads.values()), default=0.0)
    if logarithmic and top > 0.0:
        least = min(float(np.quantile(load, 0.05)) for load in loads.values())
        axes.set_yscale("log", nonpositive="clip")
        axes.set_ylim(max(0.5 * least, 10.0**-DECADES * top), 2.0 * top)
        axes.yaxis.set_major_formatter("{x:g}")
    axes.set_xlabel("time [s]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
