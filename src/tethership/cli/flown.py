"""What the commands that fly have in common: options, progress, files, metrics. Depends on: typer."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership.cli.completion import complete_layers, complete_solver
from tethership.cli.progress import flying, stage
from tethership.cli.result import Result, show
from tethership.cli.tables import Row, Table
from tethership.results import write_together

if TYPE_CHECKING:
    from tethership.scenario import Scenario
    from tethership.simulation import Flight

LayersOption = Annotated[
    str | None,
    typer.Option(
        help="Of rewind,heading,navigation, by commas; none for SAS alone. Default: the scenario's.",
        autocompletion=complete_layers,
    ),
]
SolverOption = Annotated[
    str, typer.Option(help="adaptive, tight, fixed, or a path that ends in .toml.", autocompletion=complete_solver)
]
NoSasOption = Annotated[bool, typer.Option("--no-sas", help="Switch SAS/attitude off.")]


def split(layers: str) -> tuple[str, ...]:
    """Return the layers of a comma-separated list; `none` or nothing for none."""
    names = tuple(name.strip() for name in layers.split(",") if name.strip())
    return () if names == ("none",) else names


def again(path: Path, trust: bool) -> tuple["Scenario", "Flight"]:
    """Return scenario and flight of a stored input."""
    from tethership.simulation import fly_again

    with flying() as reached:
        return fly_again(path, reached, trust)


def tell(
    scenario: "Scenario", flight: "Flight", trim_outcome: str, out: Path, picture: str, csv: Path | None, json: bool
) -> None:
    """Write a flight's files, print its numbers or its JSON, and exit with 3 where it is no answer.

    Parameters
    ----------
    scenario, flight
        What was flown.
    trim_outcome : str
        How its start was trimmed.
    out : Path
        Folder.
    picture : str
        Name of the picture in it.
    csv : Path or None
        Table of the metrics.
    json : bool
        Print one JSON object and nothing else.
    """
    written = _written(flight, out, picture)
    document = summary(scenario, flight) | {"trim_outcome": trim_outcome}
    result = Result(
        document,
        tables=[Table(_rows(document, flight), _title(document, flight))],
        lines=[f"{flight.verdict[0].upper()}{flight.verdict[1:]}. {flight.outcome.value}"],
        files=written,
        warnings=flight.warnings,
        answered=flight.outcome.is_answer,
    )
    show(result, json, csv)


def _written(flight: "Flight", out: Path, name: str) -> list[str]:
    """Write flight, picture and replay in one go and return their paths; what cannot be drawn is taken away."""
    files: dict[Path, str | bytes | None] = {out / "flight.nc": flight.content()}
    picture, replay = out / name, out / "replay.html"
    try:
        files |= {picture: _picture(flight), replay: _replay(flight)}
    except BaseException:  # an interruption or a fault of the drawing costs the pictures, never the flight
        write_together(files | {picture: None, replay: None})
        raise
    return [str(path) for path in write_together(files)]


def _picture(flight: "Flight") -> bytes | None:
    """Return the picture; a flight too short to draw has none."""
    from tethership.view import plot_docking, png

    if flight.data.sizes["time"] < 2:
        return None
    with stage("draw"):
        return png(plot_docking(flight), 120, flight.run)


def _replay(flight: "Flight") -> str | None:
    """Return the page of the replay; a flight too short to draw has none."""
    from tethership.view.replay import replay_text

    if flight.data.sizes["time"] < 2:
        return None
    with stage("replay"):
        return replay_text(flight)


def summary(scenario: "Scenario", flight: "Flight") -> dict[str, Any]:
    """Return the keys that scripts may rely on, SI, θ_rms in degrees."""
    from tethership.scenario import record_warning
    from tethership.simulation import quasi_static_warning

    flown = float(flight.data["time"][-1]) if flight.data.sizes["time"] else 0.0
    return {
        "outcome": flight.outcome.name,
        "message": flight.outcome.value,
        "verdict": flight.verdict,
        "docking_time": flight.docking_time,
        "flight_time": flown,
        **flight.metrics,
        "wind": scenario.config.wind.speed,
        "layers": flight.attributes["layers"],
        "sas": flight.attributes["sas"],
        "formulation": scenario.formulation,
        "line": scenario.config.line_models(),
        "limits": flight.attributes["limits"],
        "steps": flight.attributes["steps"],
        "limits_passed": flight.limits_passed,
        "clearance_hull": flight.metrics["clearance_min"],
        "clearance_cable": flight.metrics["cable_clearance_min"],
        "warnings": [*([flight.verdict] if flight.reservations else []), *flight.warnings],
        "cable_warning": quasi_static_warning(flight),
        "wind_warning": record_warning(scenario.config.wind, flown),
    }


def _rows(result: dict[str, Any], flight: "Flight") -> list[Row]:
    """Return the metrics as rows of a table."""
    watched = zip(flight.attributes["limits"], result["seconds_above"], strict=True)
    return [
        Row("outcome", result["outcome"]),
        Row("flight time", result["flight_time"], "s", ".2f"),
        Row("largest tension", result["tension_max"], "N", ".1f"),
        Row("mean tension", result["tension_mean"], "N", ".1f"),
        Row("slowest rewind rate", result["rewind_rate_min"], "m/s", ".3f"),
        *[Row(f"time above {limit:g} N", seconds, "s", ".2f") for limit, seconds in watched],
        Row("actuator duty cycle ADC", result["ADC"], "1/s", ".3f"),
        Row("control energy E", result["E"], "", ".3f"),
        Row("pitch, root mean square", result["theta_rms"], "deg", ".2f"),
        Row("least hull clearance", result["clearance_min"], "m", ".2f"),
        Row("time saturated", result["saturated_seconds"], "s", ".2f"),
        Row("jumps of the misalignment", result["misalignment_jumps"]),
    ]


def _title(result: dict[str, Any], flight: "Flight") -> str:
    """Return what was flown, in a line: wind [m/s], laws, formulation."""
    rewinds = (flight.attributes.get("stop") or {"rewind": True})["rewind"]
    none = "constant rewind" if rewinds else "winches hold" if flight.config.cables else "no layers"
    layers = " + ".join(result["layers"]) or none
    sas = "SAS, " if result["sas"] else ""
    return f"wind {result['wind']:g} m/s, {sas}{layers}, formulation {result['formulation']}"
