"""The page of a replay: scenes, scripts and styles in one file that needs no network. Depends on: view.replay.scene.

The scripts are in `data/replay`, one concern a file, and share one scope; three.js and uPlot are in
`data/replay/vendor`, whose README says how they are built.
"""

import html
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tethership._version import __version__
from tethership.errors import ConfigError
from tethership.results.seal import RUN
from tethership.simulation import Flight
from tethership.view import style
from tethership.view.replay.scene import scene
from tethership.view.report.page_file import page_text, write_page_text

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

POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:"
"""What the page may load: nothing that is not in it."""

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
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    own = "\n".join(_packaged(f"{name}.js") for name in SCRIPTS)
    palette = page_text("report", "palette.css")
    title = html.escape(scenes[0]["title"])
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="generator" content="tethership {__version__}">\n'
        f'<meta name="tethership-{RUN}" content="{" ".join(runs)}">\n<title>{title}: replay</title>\n'
        f"<style>\n{_packaged('vendor/uplot.min.css')}\n{palette}{_packaged('replay.css')}</style>\n</head>\n"
        f"{_packaged('body.html')}"
        f"{_licensed('three')}{_licensed('uplot')}"
        f'<script type="application/json" id="flights">{text}</script>\n'
        f'<script>\n(() => {{\n"use strict";\n{own}\n}})();\n</script>\n</body>\n</html>\n'
    )


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


def _licensed(name: str) -> str:
    """Return a library of the vendor's folder as a script with its licence."""
    licence = _packaged(f"vendor/{name}.LICENSE").replace("*/", "* /")
    return f"<script>\n/*!\n{licence}*/\n{_packaged(f'vendor/{name}.min.js')}\n</script>\n"


def _packaged(name: str) -> str:
    """Return the text of a packaged file of the replay."""
    return page_text("replay", name)
