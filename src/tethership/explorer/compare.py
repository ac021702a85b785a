"""A result that was pinned beside the present one: drawn with it in grey, and the numbers that differ in a table.

Depends on: explorer.numbers, explorer.standing. Figures are plotly's JSON here, no objects.
"""

import threading
from collections import OrderedDict
from collections.abc import Iterator
from typing import Any

from tethership.explorer.numbers import NUMBERS, Number
from tethership.explorer.standing import Standing

MOST_PINS = 30
"""Pinned results that are kept, of all pages: those that were pinned last."""

PINNED = "pinned"
"""How the traces of a pinned result are called."""

GREY = "#808080"
"""What was pinned: one colour for all of it, seen on white as on black."""

LEFT_OUT = ("showscale", "colorbar", "colorscale", "pattern")
"""Looks of marks that say what a pinned result does not."""


class Pins:
    """The result that each page has pinned of each view; safe to use from any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pins: OrderedDict[tuple[str, str], Standing] = OrderedDict()

    def of(self, client: str, view: str) -> Standing | None:
        """Return what a page has pinned of a view."""
        with self._lock:
            return self._pins.get((client, view))

    def toggle(self, client: str, view: str, shown: Standing | None) -> None:
        """Let go of what a page has pinned of a view, else pin what it shows, if that is kept."""
        with self._lock:
            if self._pins.pop((client, view), None) is None and shown is not None:
                self._pins[client, view] = shown
                while len(self._pins) > MOST_PINS:
                    self._pins.popitem(last=False)


def drawn_over(figure: dict[str, Any], pinned: dict[str, Any]) -> dict[str, Any]:
    """Return a figure over a pinned one of the same view, in grey, with axes wide enough for both.

    Pinned lines and bars lie below, pinned marks above, open, so that each is seen.

    Parameters
    ----------
    figure, pinned : dict
        Plotly's JSON; neither is changed.
    """
    layout = dict(figure["layout"])
    for name, axis in layout.items():
        other = pinned["layout"].get(name)
        if name[1:].startswith("axis") and "range" in axis and other and "range" in other:
            (low, high), (first, last) = axis["range"], other["range"]
            layout[name] = {**axis, "range": [min(low, first), max(high, last)]}
    layout["barmode"] = "overlay"
    above = [_narrow(trace) if trace["type"] == "bar" else trace for trace in figure["data"]]
    places = [_place(trace) for trace in figure["data"]]
    greyed = [_greyed(trace) for trace in pinned["data"] if _place(trace) not in places]
    below, marks = ([one for one in greyed if (one.get("mode") == "markers") is mark] for mark in (False, True))
    return {**figure, "data": [*below, *above, *marks], "layout": layout}


def _place(trace: dict[str, Any]) -> tuple[Any, ...]:
    """Return where a trace is drawn: one that lies under another is not to be seen; of a limit only its height."""
    limit = trace.get("hoverinfo") == "skip" and len(trace["x"]) == 2
    return tuple(trace.get(part) for part in ("type", "y", "xaxis", "yaxis", *(() if limit else ("x",))))


def _greyed(trace: dict[str, Any]) -> dict[str, Any]:
    """Return a trace as it looks while it is pinned."""
    found = {**trace, "name": PINNED, "showlegend": False, "opacity": 0.75, "hoverinfo": "skip"}
    found |= {"fillcolor": "rgba(0,0,0,0)"} if "fill" in trace else {}
    for leave in ("hovertemplate", "customdata", "text"):
        found.pop(leave, None)
    if "line" in trace:
        found["line"] = {**trace["line"], "color": GREY, "width": 2, "dash": "solid"}
    marker = {key: value for key, value in trace.get("marker", {}).items() if key not in LEFT_OUT}
    if trace["type"] == "bar":
        found["marker"] = {"color": "rgba(0,0,0,0)", "line": {"color": GREY, "width": 2}}
    elif marker:
        symbol = f"{marker.get('symbol', 'circle')}-open"
        found["marker"] = marker | {"symbol": symbol, "color": GREY, "line": {"color": GREY, "width": 1.5}}
    return found


def _narrow(trace: dict[str, Any]) -> dict[str, Any]:
    """Return bars that leave those below them to be seen."""
    return {**trace, "width": 0.45}


def differences(view: str, now: dict[str, Any], pinned: dict[str, Any]) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield what differs between two results of a view: words, pinned, now, the change, unit; – for what one lacks.

    Units are those in which the view tells its numbers.
    """
    numbers, before = ({one.words: one for one in NUMBERS[view](result)} for result in (now, pinned))
    for words in [*numbers, *(one for one in before if one not in numbers)]:
        here, there = numbers.get(words), before.get(words)
        if here is None or there is None or here.text != there.text:
            some = here or there
            assert some is not None
            yield words, _text(there), _text(here), _change(here, there), some.unit


def _text(number: Number | None) -> str:
    return "–" if number is None else number.text


def _change(here: Number | None, there: Number | None) -> str:
    """Return a difference with as many decimals as the numbers are told with; nothing where one is no number."""
    if here is None or there is None:
        return ""
    try:
        change = float(here.text) - float(there.text)
    except ValueError:
        return ""
    decimals = max(len(one.text.partition(".")[2]) for one in (here, there))
    return f"{change:+.{decimals}f}"
