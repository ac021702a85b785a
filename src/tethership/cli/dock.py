"""`tethership dock`: trim, fly, print the metrics, write the flight, its picture and its replay."""

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership.cli.common import (
    NO_ANSWER,
    FormulationOption,
    JsonOption,
    OutOption,
    ScenarioArgument,
    SetOption,
    WindOption,
    chosen_scenario,
    print_json,
    stage,
    writable_folder,
)
from tethership.cli.completion import complete_layers, complete_solver
from tethership.cli.points import trimmed_start, warn
from tethership.cli.tables import CsvOption, Row, print_table, writable_csv, write_rows
from tethership.errors import ConfigError
from tethership.results.files import write_together
from tethership.scenario import Scenario
from tethership.scenario.load import read_solver

if TYPE_CHECKING:
    from tethership.analysis import TrimPoint
    from tethership.simulation import Flight

EXAMPLE = "Example: tethership dock --wind 12 --layers rewind,heading --out flights/12"


def dock(
    scenario: ScenarioArgument = "docking",
    wind: WindOption = None,
    formulation: FormulationOption = None,
    layers: Annotated[
        str | None,
        typer.Option(
            help="Of rewind,heading,navigation, by commas; none for SAS alone. Default: the scenario's.",
            autocompletion=complete_layers,
        ),
    ] = None,
    no_sas: Annotated[bool, typer.Option("--no-sas", help="Switch SAS/attitude off.")] = False,
    solver: Annotated[
        str, typer.Option(help="adaptive, tight, fixed, or a path that ends in .toml.", autocompletion=complete_solver)
    ] = "adaptive",
    from_: Annotated[Path | None, typer.Option("--from", help="Fly the stored input of a flight file again.")] = None,
    changes: SetOption = None,
    out: OutOption = Path("out"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Trim the ship on its cable, fly the docking manoeuvre and show what happened.

    Writes flight.nc (labelled data with the full input), docking.png (the paper's four panels) and replay.html (the
    flight in space, opens in a browser without a network) into --out.
    """
    given = (scenario, wind, formulation, layers, changes, no_sas, solver)
    if from_ is not None and given != ("docking", None, None, None, None, False, "adaptive"):
        raise ConfigError(
            "--from flies the stored input as it is; leave out the scenario and all flags but --out, --csv, --json"
        )
    if from_ is not None and from_.resolve() == (out / "flight.nc").resolve():
        raise ConfigError(f"--from {from_} would be overwritten; choose another folder with --out")
    if from_ is not None:
        writable_folder(out)
        writable_csv(csv)
        flown_scenario, flight, trim_outcome = _again(from_)
    else:
        flown_scenario = chosen_scenario(scenario, wind, formulation, changes)
        names = None if layers is None else _split(layers)
        flown_scenario.law(names)  # a wrong name is found before anything is computed
        read_solver(solver)
        writable_folder(out)
        writable_csv(csv)
        point = trimmed_start(flown_scenario, json)
        trim_outcome = point.outcome.name
        flight = _flown(flown_scenario, point, names, False if no_sas else None, solver)
        if point.saturated:
            typer.echo(f"tethership: warning: the start is no equilibrium. {point.message}", err=True)
    written = _written(flight, out)
    result = summary(flown_scenario, flight) | {"trim_outcome": trim_outcome}
    rows = _rows(result, flight)
    result["files"] = [*written, *write_rows(csv, rows)]
    if json:
        print_json(result)
    else:
        _print(result, flight, rows)
        warn(flight.warnings)
    if not flight.outcome.is_answer:
        raise typer.Exit(NO_ANSWER)


def _split(layers: str) -> tuple[str, ...]:
    """Return the layers of a comma-separated list; `none` or nothing for none."""
    names = tuple(name.strip() for name in layers.split(",") if name.strip())
    return () if names == ("none",) else names


class _Stages:
    """Progress of a flight on a terminal: compiling until the first call, then flying."""

    def __init__(self, limit: float) -> None:
        self.limit = limit
        self.start = time.perf_counter()
        self.compiled = False
        self.shown = sys.stderr.isatty()
        if self.shown:
            typer.echo("  compile …", err=True, nl=False)

    def __call__(self, reached: float) -> None:
        if not self.shown:
            return
        if not self.compiled:
            self.compiled = True
            typer.echo(f"\r  {'compile':<28} {time.perf_counter() - self.start:6.2f} s", err=True)
            self.start = time.perf_counter()
        typer.echo(f"\r  fly: {reached:7.1f} s of at most {self.limit:.0f} s", err=True, nl=False)

    def done(self) -> None:
        """Close the line."""
        if self.shown:
            typer.echo(f"\r  {'fly':<28} {time.perf_counter() - self.start:6.2f} s      ", err=True)


def _flown(
    scenario: Scenario, point: "TrimPoint", layers: tuple[str, ...] | None, sas: bool | None, solver: str
) -> "Flight":
    from tethership.simulation import dock as fly

    stages = _Stages(scenario.config.stop.time_limit)
    flight = fly(scenario, point, layers, sas, solver, stages)
    stages.done()
    return flight


def _again(path: Path) -> tuple[Scenario, "Flight", str]:
    """Return scenario and flight of a stored input."""
    from tethership.simulation import fly_again

    stages = _Stages(float("inf"))
    scenario, flight = fly_again(path, stages)
    stages.done()
    return scenario, flight, "stored"


def _written(flight: "Flight", out: Path) -> list[str]:
    """Write flight, picture and replay in one go and return their paths; what cannot be drawn is taken away."""
    files: dict[Path, str | bytes | None] = {out / "flight.nc": flight.content()}
    picture, replay = out / "docking.png", out / "replay.html"
    try:
        files |= {picture: _picture(flight), replay: _replay(flight)}
    except BaseException:  # an interruption or a fault of the drawing costs the pictures, never the flight
        write_together(files | {picture: None, replay: None})
        raise
    return [str(path) for path in write_together(files)]


def _picture(flight: "Flight") -> bytes | None:
    """Return the picture; a flight too short to draw has none."""
    from tethership.view import plot_docking
    from tethership.view.picture import png

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


def summary(scenario: Scenario, flight: "Flight") -> dict[str, Any]:
    """Return the keys that scripts may rely on, SI, θ_rms in degrees."""
    from tethership.scenario.wind_file import record_warning
    from tethership.simulation.quasi_static import quasi_static_warning

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


def _print(result: dict[str, Any], flight: "Flight", rows: list[Row]) -> None:
    """Print the metrics as a table."""
    layers = " + ".join(result["layers"]) or "constant rewind"
    sas = "SAS, " if result["sas"] else ""
    print_table(rows, f"wind {result['wind']:g} m/s, {sas}{layers}, formulation {result['formulation']}")
    typer.echo(f"{flight.verdict[0].upper()}{flight.verdict[1:]}. {flight.outcome.value}")
    for path in result["files"]:
        typer.echo(f"wrote {path}")
