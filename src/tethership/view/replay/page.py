"""The page of a replay: scenes, scripts and styles in one file that needs no network. Depends on: view.replay.scene.

The scripts are in `data/replay`, one concern a file, and share one scope; three.js and uPlot are in
`data/replay/vendor`, whose README says how they are built.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tethership._version import __version__
from tethership.errors import ConfigError
from tethership.results import RUN
from tethership.simulation import Flight
from tethership.view import style
from tethership.view.replay.scene import scene
from tethership.view.report.page_file import rendered, write_page_text

SCRIPTS = (
    "tracks",
    "axes",
    "colours",
    "clock",
    "arrows",
    "ship",
    "cables",
    "ground",
    "wind",
    "labels",
    "cameras",
    "stage",
    "no_stage",
    "readout",
    "panels",
    "plots",
    "state",
    "controls",
    "main",
)
"""Own scripts, in the order in which they are read."""

MOST_FLIGHTS = 2
"""Flights side by side."""

Flights = Flight | Sequence[Flight] | Mapping[str, Flight]
"""One flight, two, or two with their names."""


def write_replay(flights: Flights, path: str | Path) -> Path:
    """Write a flight, or two side by side, as one page to be played in a browser; returns where.

    The page opens from disk and loads nothing. It shows the ship and its cables in space with the forces of the
    thrusters and the wind, and histories of tension, length, throttles and attitude, all at one time.

    Parameters
    ----------
    flights : Flight, sequence or mapping of Flight
        One or two, from `dock` or `Flight.load`. The keys of a mapping are the names shown; without, they are the
        layers flown.
    path : str or Path
        Where; its folder is made.

    Raises
    ------
    ConfigError
        More than two flights or none, a flight that cannot be replayed, or a file that cannot be written.
    SolveError
        A flight diverged before its first sample.

    Examples
    --------
    >>> import tethership as ts
    >>> system = ts.load_scenario("docking", {"stop.time_limit": 0.5})
    >>> flight = ts.dock(system, ts.trim(system))
    >>> import tempfile
    >>> ts.write_replay(flight, Path(tempfile.mkdtemp()) / "replay.html").name
    'replay.html'
    """
    return write_page_text(path, replay_text(flights))


def replay_text(flights: Flights) -> str:
    """Return the page that `write_replay` writes; errors as there."""
    named = _named(flights)
    return replay_page([scene(flight, name) for name, flight in named], [flight.run for _, flight in named])


def _named(flights: Flights) -> list[tuple[str, Flight]]:
    """Return flights with their names."""
    if isinstance(flights, Mapping):
        named = list(flights.items())
    else:
        listed = [flights] if isinstance(flights, Flight) else list(flights)
        named = [(", ".join(flight.attributes["layers"]) or "no layers", flight) for flight in listed]
        if len(named) == MOST_FLIGHTS and named[0][0] == named[1][0]:
            named = [(f"flight {i}", flight) for i, flight in enumerate(listed, start=1)]
    if not 1 <= len(named) <= MOST_FLIGHTS:
        raise ConfigError(f"a replay shows one flight, or two side by side; {len(named)} were given")
    return named


def replay_page(scenes: list[dict[str, Any]], runs: Sequence[str] = ()) -> str:
    """Return the page of one or two scenes of `view.replay.scene`, with the ids of the runs they show."""
    data = {"flights": scenes, "colours": _colours(), "version": __version__}
    return rendered("replay/replay.html", data=data, run=RUN, runs=runs, scripts=SCRIPTS)


def _colours() -> dict[str, Any]:
    """Return the house's colours, so that page and figures agree."""
    return {
        "ink": style.INK,
        "guide": style.GUIDE,
        "path": style.END,
        "ground": style.GROUND,
        "gust": style.GUST,
        "series": style.SERIES,
        "dashes": style.DASHES,
        "flights": style.FLIGHTS,
        "tension": style.TENSION,
        "arrows": style.ARROWS,
        "limits": style.LIMITS,
    }
