"""The numbers of each view's result as they are told, for its tables and to compare two results of a view.

Depends on nothing of tethership: takes what `tasks` returned.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

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


class Number(NamedTuple):
    """A number of a result.

    Attributes
    ----------
    words : str
        What it is.
    text : str
        The number as it is told.
    unit : str
    """

    words: str
    text: str
    unit: str


def rest_numbers(result: dict[str, Any]) -> list[Number]:
    """Return where a trimmed ship rests: place of P [m], angles [°], speeds [m/s]."""
    state = result["state"]
    return [Number(words, _number(-state[n] if n == "down" else state[n]), unit) for n, words, unit in STATE]


def cable_numbers(result: dict[str, Any]) -> list[Number]:
    """Return the tensions of a trim [N], and their share of the breaking force [%]."""
    return [
        row
        for name, tension in result["tension"].items()
        for row in (
            Number(f"tension, {name}", _number(tension), "N"),
            Number(f"share of its breaking force, {name}", f"{100 * tension / result['breaking'][name]:.2f}", "%"),
        )
    ]


def metric_numbers(result: dict[str, Any]) -> list[Number]:
    """Return the metrics of a flight that it has.

    They are tensions [N], times [s], rewind rate [m/s], pitch [°], ADC [1/s], E [-], clearance [m].
    """
    found = result["metrics"]
    rows = [
        Number("largest tension", f"{found['tension_max']:.1f}", "N"),
        Number("mean tension", f"{found['tension_mean']:.1f}", "N"),
        *[
            Number(f"time above {limit:g} N", f"{seconds:.2f}", "s")
            for limit, seconds in zip(result["limits"], found["seconds_above"], strict=True)
        ],
        Number("slowest rewind rate", f"{found['rewind_rate_min']:.3f}", "m/s"),
        Number("pitch, RMS", f"{found['theta_rms']:.2f}", "°"),
        Number("duty cycle ADC", f"{found['ADC']:.3f}", "1/s"),
        Number("control energy E", f"{found['E']:.3f}", ""),
        Number("time saturated", f"{found['saturated_seconds']:.2f}", "s"),
        Number("least hull clearance", f"{found['clearance_min']:.2f}", "m"),
    ]
    return [row for row in rows if row.text != "nan"]


def _trim(result: dict[str, Any]) -> list[Number]:
    """Return what trims are compared by: how it ended, rest, throttles [-], tensions [N]."""
    throttles = [
        Number(f"throttle, {name.replace('_', ' ')}", f"{value:+.4f}", "") for name, value in result["throttle"].items()
    ]
    ended = Number("outcome", result["outcome"].replace("_", " "), "")
    return [ended, *rest_numbers(result), *throttles, *cable_numbers(result)]


def _locus(result: dict[str, Any]) -> list[Number]:
    """Return what loci are compared by: λ [1/s] and damping [-] of the chosen scenario's modes."""
    rows = [Number("points in equilibrium", str(result.get("trimmed", 0)), "")]
    for mode in result.get("modes", []):
        real, imaginary = mode["eigenvalue"]
        rows.append(Number(f"{mode['name']}, Re λ", f"{real:.4f}", "1/s"))
        if imaginary:
            rows.append(Number(f"{mode['name']}, Im λ", f"{abs(imaginary):.4f}", "rad/s"))
            rows.append(Number(f"{mode['name']}, damping", f"{mode['damping']:+.3f}", ""))
    return rows


def _flight(result: dict[str, Any]) -> list[Number]:
    """Return what flights are compared by: how and when [s] it ended, and its metrics."""
    if "metrics" not in result:
        return [Number("outcome", "no start", "")]
    ended = Number("outcome", result["outcome"].replace("_", " "), "")
    return [ended, Number("ends after", f"{result['time']:.2f}", "s"), *metric_numbers(result)]


NUMBERS: dict[str, Callable[[dict[str, Any]], list[Number]]] = {"trim": _trim, "locus": _locus, "flight": _flight}
"""By view."""


def _number(value: float) -> str:
    return f"{value + 0.0:.4f}" if abs(value) < 1000 else f"{value:.1f}"
