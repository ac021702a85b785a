"""Results as tables and words: takes what `tasks` returned, gives Dash components. Depends on: dash, explorer."""

from collections.abc import Iterable, Sequence
from typing import Any

from dash import html

from tethership.explorer.compare import differences
from tethership.explorer.numbers import cable_numbers, metric_numbers, rest_numbers
from tethership.explorer.standing import Request

REPLAYS = "/replay"
"""Where replays are served, each under its request's key."""

RESIDUAL = (("X", "N"), ("Y", "N"), ("Z", "N"), ("L", "N m"), ("M", "N m"), ("N", "N m"))
"""Force and moment left over, body axes."""


def verdict(good: str, words: str, notes: Iterable[str] = ()) -> html.Div:
    """Return how it ended, in one line; notes below.

    Parameters
    ----------
    good : str
        good, fair or bad.
    words : str
        The line.
    notes : iterable of str
        Warnings.
    """
    sign = {"good": "✓", "fair": "!", "bad": "✕"}[good]
    line = html.P([html.Span(sign, className="sign"), words], className=f"verdict {good}")
    return html.Div([line, *(html.P(note, className="note") for note in notes)])


def _sentence(words: str) -> str:
    """Return a line as a sentence."""
    return f"{words[0].upper()}{words[1:].removesuffix('.')}."


def trim_head(result: dict[str, Any]) -> Any:
    """Return how the trim ended."""
    kind = {"converged": "fair" if result["warnings"] else "good", "saturated": "fair"}.get(result["outcome"], "bad")
    return verdict(kind, result["message"], map(_sentence, result["warnings"]))


def trim_rest(result: dict[str, Any]) -> Any:
    """Return the numbers of a trim.

    They are the place of P [m], angles [°], speeds [m/s], throttles [-], thrust and tensions [N] and what is left
    [N, N m].
    """
    thrusters = [
        (name.replace("_", " "), f"{value:+.4f}", f"{value * result['nominal'][name]:+.1f} N")
        for name, value in result["throttle"].items()
    ]
    left = [(name, f"{v:.2e}", unit) for (name, unit), v in zip(RESIDUAL, result["residual"], strict=True)]
    return html.Div(
        [
            _table("Where the ship rests", rest_numbers(result)),
            _table("Thrusters: throttle, thrust", thrusters),
            _table("Cables", cable_numbers(result)),
            _table("Force and moment left over", left),
        ],
        className="tables",
    )


def locus_head(result: dict[str, Any]) -> Any:
    """Return how the sweep ended, and the modes of the chosen scenario below it."""
    if result["figure"] is None:
        return verdict("bad", result["message"])
    whole = result["trimmed"] == result["points"]
    words = f"{result['trimmed']} of {result['points']} points in equilibrium. {result['message']}".strip()
    notes = [f"The chosen scenario itself: {result['own']}", *map(_sentence, result["warnings"])]
    return verdict("good" if whole and not result["warnings"] else "fair", words, notes)


def locus_rest(result: dict[str, Any]) -> Any:
    """Return the modes of the chosen scenario and what happens along the sweep.

    Of each mode λ [1/s], frequency [rad/s], damping [-], period and time to halve or double [s].
    """
    if result["figure"] is None:
        return []
    header = ("mode", "λ [1/s]", "frequency [rad/s]", "damping", "period [s]", "amplitude")
    rows = [
        (
            mode["name"],
            _root(mode["eigenvalue"]),
            f"{mode['frequency']:.4f}",
            f"{mode['damping']:+.3f}",
            "–" if mode["period"] is None else f"{mode['period']:.2f}",
            _time(mode),
        )
        for mode in result["modes"]
    ]
    growing = [mode["name"] for mode in result["modes"] if mode["eigenvalue"][0] > 1e-9]
    verbs = {"unstable": "becomes unstable", "stable": "becomes stable"}
    happenings = [
        f"{' and '.join(event['tracks'])} {verbs.get(event['kind'], event['kind'])} at {event['at']:.4g} "
        f"{'' if result['unit'] == '1' else result['unit']} (λ = {_root(event['eigenvalue'])} 1/s)"
        for event in result["events"]
    ]
    return html.Div(
        [
            _grid("Modes of the chosen scenario (stars)", header, rows, {0}),
            html.H3("Along the sweep"),
            html.Ul([html.Li(text) for text in (happenings or ["no coalescence, splitting or change of stability"])]),
            *([html.P(f"Unstable at the chosen scenario: {', '.join(growing)}.")] if growing else []),
        ]
    )


def flight_head(result: dict[str, Any]) -> Any:
    """Return how the flight ended and its metrics.

    They are tensions [N], times [s], rewind rate [m/s], pitch [°], ADC [1/s], E [-], clearance [m].
    """
    if result["figure"] is None:
        return verdict("bad", result["message"])
    sound = "fair" if result["reserved"] else "good"
    kind = {"docked": sound, "time_limit": "fair", "ground_contact": "fair"}.get(result["outcome"], "bad")
    line = verdict(kind, f"{result['verdict']}. {result['message']}")
    cells = [
        html.Div([html.Dt(words), html.Dd([value, html.Span(f" {unit}", className="unit")])])
        for words, value, unit in metric_numbers(result)
    ]
    laws = " + ".join((["SAS"] if result["sas"] else []) + result["layers"]) or "no law: constant rewind"
    return html.Div([line, html.P(f"Laws: {laws}.", className="laws"), html.Dl(cells, className="metrics")])


def flight_rest(result: dict[str, Any]) -> Any:
    """Return the warnings of a flight."""
    return html.Div([html.P(["Mind: ", warning], className="note") for warning in result.get("warnings", [])])


HEADS = {"trim": trim_head, "locus": locus_head, "flight": flight_head}

RESTS = {"trim": trim_rest, "locus": locus_rest, "flight": flight_rest}


def asked(request: Request) -> html.P:
    """Return what a result is of."""
    scenario, _, changes = request.words.partition(" · ")
    return html.P([html.B(scenario), f" · {changes}"], className="asked")


def pinned_line(pinned: Request) -> html.P:
    """Return what was pinned, in words."""
    return html.P([html.Span(className="key"), f"pinned, in grey: {pinned.words}"], className="pinned")


def compared(view: str, now: dict[str, Any], pinned: dict[str, Any]) -> Any:
    """Return the numbers that differ from a pinned result's, each in the unit in which it is told."""
    rows = list(differences(view, now, pinned))
    if not rows:
        return html.P("No number differs from the pinned result's.", className="note")
    return _grid("Changed since it was pinned", ("number", "pinned", "now", "change", "unit"), rows, {0, 4})


def frame(request: Request) -> html.Iframe:
    """Return the place of a flight's replay in space, which the page's script loads once it is to be seen."""
    place = {"data-src": f"{REPLAYS}/{request.key}", "title": "the flight in space"}
    return html.Iframe(key=request.key, className="space", sandbox="allow-scripts", **place)  # pyright: ignore[reportArgumentType]


def _root(pair: Sequence[float]) -> str:
    real, imaginary = pair
    return f"{real:.4f} ± {abs(imaginary):.4f} i" if imaginary else f"{real:.4f}"


def _time(mode: dict[str, Any]) -> str:
    if mode["half_or_double_time"] is None:
        return "–"
    return f"{'halves' if mode['stable'] else 'doubles'} in {mode['half_or_double_time']:.2f} s"


def _table(title: str, rows: Sequence[tuple[str, str, str]]) -> Any:
    """Return rows of words, number and unit; nothing without rows."""
    if not rows:
        return None
    body = [html.Tr([html.Th(words, scope="row"), html.Td(v, className="n"), html.Td(unit)]) for words, v, unit in rows]
    return html.Div([html.H3(title), html.Table(html.Tbody(body))])


def _grid(title: str, header: Sequence[str], rows: Sequence[Sequence[str]], words: set[int]) -> html.Div:
    """Return a table with a heading; columns of words are set left."""
    sides = ["" if index in words else "n" for index in range(len(header))]
    head = html.Tr([html.Th(text, className=side, scope="col") for text, side in zip(header, sides, strict=True)])
    body = [html.Tr([html.Td(text, className=s) for text, s in zip(row, sides, strict=True)]) for row in rows]
    table = html.Table([html.Thead(head), html.Tbody(body)])
    return html.Div([html.H3(title), html.Div(table, className="wide", tabIndex=0, **{"aria-label": title})])  # pyright: ignore[reportArgumentType]
