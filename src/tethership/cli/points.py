"""What every command says of a trim: the same keys, the same sentences, the same exit. Depends on: typer."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import typer

from tethership.cli.progress import stage
from tethership.cli.result import Result, show
from tethership.cli.tables import Row

if TYPE_CHECKING:
    from tethership.analysis import TrimOutcome, TrimPoint
    from tethership.scenario import Scenario


def point_keys(point: "TrimPoint") -> dict[str, Any]:
    """Return the keys that scripts may rely on wherever a trim is told, SI."""
    return {
        "outcome": point.outcome.name,
        "message": point.message,
        "saturated": list(point.saturated),
        "limits_passed": point.limits_passed,
        "clearance_hull": point.clearance_hull,
        "clearance_cable": point.clearance_cable,
        "warnings": list(point.warnings),
    }


def clearance_rows(hull: float | None, cable: float | None) -> list[Row]:
    """Return the heights of the lowest points of hull and cables above the ground as rows of a table [m]."""
    parts = (("hull above ground", hull), ("cable above ground", cable))
    return [Row(name, height, "m", ".2f") for name, height in parts if height is not None]


def clearance_line(hull: float | None, cable: float | None, least: str = "") -> str:
    """Return the same in one line, nothing where no ground is known; `least` says that they are the least of many."""
    told = ", ".join(f"{row.name} {row.value:.2f} m" for row in clearance_rows(hull, cable))
    return f"  {least}{told}" if told else ""


def trimmed_start(scenario: "Scenario", as_json: bool) -> "TrimPoint":
    """Return the trim from which a ship can be flown, or say why there is none and exit."""
    point = _trimmed(scenario, as_json, lambda outcome: outcome.is_start)
    if point.saturated:
        typer.echo(f"tethership: warning: the start is no equilibrium. {point.message}", err=True)
    return point


def balanced(scenario: "Scenario", as_json: bool) -> "TrimPoint":
    """Return the trim about which a ship can be linearised, or say why there is none and exit."""
    return _trimmed(scenario, as_json, lambda outcome: outcome.is_balanced)


def _trimmed(scenario: "Scenario", as_json: bool, serves: Callable[["TrimOutcome"], bool]) -> "TrimPoint":
    """Return the trim if its outcome serves, else say that there is no answer and exit."""
    from tethership.analysis import trim

    with stage("trim"):
        point = trim(scenario)
    if not serves(point.outcome):
        document = point_keys(point) | {"residual": point.residual}
        show(Result(document, answered=False, reason=point.message), as_json)
    return point
