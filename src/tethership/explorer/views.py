"""Results as tables and words: takes what `tasks` returned, gives Dash components. Depends on: dash."""

from collections.abc import Iterable, Sequence
from typing import Any

from dash import html

STATE = (
    ("north", "north of the origin", "m"),
    ("east", "east of the origin", "m"),
    ("down", "above the origin", "m"),
    ("phi", "roll φ", "°"),
    ("theta", "pitch θ", "°"),
    ("psi", "heading ψ", "°"),
    ("u", "forward u", "m/s"),
    ("v", "to starboard v", "m/s"),
    ("w", "downward w", "m/s"),
)
"""States at trim, with words and units.

x_P counts from the origin of the ground axes: the first anchor, unless the scenario puts that elsewhere. What is shown
of `down` is −D.
"""

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
    state = result["state"]
    values = [(words, _number(-state[n] if n == "down" else state[n]), unit) for n, words, unit in STATE]
    cables = [
        row
        for name, tension in result["tension"].items()
        for row in (
            (f"tension, {name}", _number(tension), "N"),
            (f"share of its breaking force, {name}", f"{100 * tension / result['breaking'][name]:.2f}", "%"),
        )
    ]
    thrusters = [
        (name.replace("_", " "), f"{value:+.4f}", f"{value * result['nominal'][name]:+.1f} N")
        for name, value in result["throttle"].items()
    ]
    left = [(name, f"{v:.2e}", unit) for (name, unit), v in zip(RESIDUAL, result["residual"], strict=True)]
    return html.Div(
        [
            _table("Where the ship rests", values),
            _table("Thrusters: throttle, thrust", thrusters),
            _table("Cables", cables),
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
    found = result["metrics"]
    rows = [
        ("largest tension", f"{found['tension_max']:.1f}", "N"),
        ("mean tension", f"{found['tension_mean']:.1f}", "N"),
        *[
            (f"time above {limit:g} N", f"{seconds:.2f}", "s")
            for limit, seconds in zip(result["limits"], found["seconds_above"], strict=True)
        ],
        ("slowest rewind rate", f"{found['rewind_rate_min']:.3f}", "m/s"),
        ("pitch, RMS", f"{found['theta_rms']:.2f}", "°"),
        ("duty cycle ADC", f"{found['ADC']:.3f}", "1/s"),
        ("control energy E", f"{found['E']:.3f}", ""),
        ("time saturated", f"{found['saturated_seconds']:.2f}", "s"),
        ("least hull clearance", f"{found['clearance_min']:.2f}", "m"),
    ]
    cells = [
        html.Div([html.Dt(words), html.Dd([value, html.Span(f" {unit}", className="unit")])])
        for words, value, unit in rows
        if value != "nan"
    ]
    laws = " + ".join((["SAS"] if result["sas"] else []) + result["layers"]) or "no law: constant rewind"
    return html.Div([line, html.P(f"Laws: {laws}.", className="laws"), html.Dl(cells, className="metrics")])


def flight_rest(result: dict[str, Any]) -> Any:
    """Return the warnings of a flight."""
    return html.Div([html.P(["Mind: ", warning], className="note") for warning in result.get("warnings", [])])


HEADS = {"trim": trim_head, "locus": locus_head, "flight": flight_head}

RESTS = {"trim": trim_rest, "locus": locus_rest, "flight": flight_rest}


def _number(value: float) -> str:
    return f"{value + 0.0:.4f}" if abs(value) < 1000 else f"{value:.1f}"


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
