"""`tethership modes`: eigenvalues and named modes of the trimmed ship."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    LineOption,
    MaybeOutOption,
    ScenarioArgument,
    SetOption,
    TrustOption,
    WindOption,
    chosen_scenario,
    json_text,
    writable,
)
from tethership.cli.points import balanced, clearance_line, point_keys
from tethership.cli.progress import stage
from tethership.cli.result import Result, show
from tethership.cli.tables import Cell, CsvOption, Table
from tethership.errors import ConfigError, suggestion
from tethership.results import write_together

if TYPE_CHECKING:
    from tethership.analysis import LinearModel, Mode, Modes, Sensitivities, TrimPoint
    from tethership.scenario import Scenario

EXAMPLE = "Example: tethership modes --wind 9 --sensitivity pendulum"

COLUMNS = ("name", "real", "imaginary", "frequency", "damping", "half_or_double_time", "period", "stable")
"""Of the table of modes, SI: λ [1/s], frequency [rad/s], times [s]."""

LOOPS = ("open", "closed")

PARTS = ("full", "nine", "longitudinal", "lateral")


def modes(
    scenario: ScenarioArgument = "docking",
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    trust: TrustOption = False,
    part: Annotated[
        str, typer.Option(help="full (all states), nine (position held), longitudinal or lateral.")
    ] = "full",
    loop: Annotated[
        str, typer.Option(help="open (thrusters are inputs), or closed: with laws, actuators and sampling.")
    ] = "open",
    sensitivity: Annotated[
        str | None, typer.Option(metavar="MODE", help="Also rank what moves this mode, e.g. pendulum.")
    ] = None,
    changes: SetOption = None,
    out: MaybeOutOption = None,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Linearise the ship about its trim and name its modes.

    With --out the result is also written there as modes.json, the linear model as model.nc, and every mode drawn as
    motion of the ship in modes.png.
    """
    from tethership.analysis import TrimOutcome, linearize, sensitivities

    _check(part, loop, sensitivity)
    loaded = chosen_scenario(scenario, wind, formulation, changes, line, trust)
    writable(out, csv)
    point = balanced(loaded, json)
    with stage("linearise"):
        model = _part(linearize(loaded, point, loop=loop), part)
        found = model.modes()
    document = _head(loaded, point, model, loop) | summary(model, found)
    tables, lines = [_table(found, _title(loaded, point))], []
    if sensitivity is not None:
        with stage("sensitivities"):
            ranked = sensitivities(loaded, sensitivity, point)
        document["sensitivity"] = _ranked(ranked)
        tables.append(_ranked_table(ranked))
        lines.append(_count(ranked))
    if out is not None:
        _write(out, model, document)
    result = Result(
        document,
        tables=tables,
        lines=lines,
        warnings=document["warnings"],
        answered=point.outcome is TrimOutcome.converged,
        reason=point.message,
    )
    show(result, json, csv)


def _check(part: str, loop: str, sensitivity: str | None) -> None:
    """Raise ConfigError where a part or a loop is unknown, or they do not go with sensitivities."""
    if part not in PARTS:
        raise ConfigError(f"--part {part!r} is no part{suggestion(part, PARTS)} Allowed: {', '.join(PARTS)}")
    if loop not in LOOPS:
        raise ConfigError(f"--loop {loop!r} is none{suggestion(loop, LOOPS)} Allowed: {', '.join(LOOPS)}")
    if loop == "closed" and sensitivity is not None:
        raise ConfigError(
            "--sensitivity is of the open loop; leave --loop closed out, or sweep a gain with --loop closed"
        )


def _write(folder: Path, model: "LinearModel", document: dict[str, Any]) -> None:
    """Write the result, the linear model and its modes drawn as motion of the ship."""
    with stage("draw"):
        from tethership.view import png
        from tethership.view.linear import plot_all_modes

        drawn = png(plot_all_modes(model), 120, model.run)
    files = {"model.nc": model.content(), "modes.json": json_text(document), "modes.png": drawn}
    write_together({folder / name: content for name, content in files.items()})


def _part(model: "LinearModel", part: str) -> "LinearModel":
    """Return the model or a part of it."""
    match part:
        case "nine":
            return model.without_position()
        case "longitudinal":
            return model.longitudinal()
        case "lateral":
            return model.lateral()
        case _:
            return model


def _head(scenario: "Scenario", point: "TrimPoint", model: "LinearModel", loop: str) -> dict[str, Any]:
    """Return what was linearised, SI."""
    return point_keys(point) | {
        "wind": scenario.config.wind.speed,
        "formulation": scenario.formulation,
        "line": scenario.config.line_models(),
        "loop": loop,
        "sample_time": model.sample_time or None,
        "warnings": [*point.warnings, *model.attributes.get("warnings", ())],
    }


def summary(model: "LinearModel", found: "Modes") -> dict[str, Any]:
    """Return the keys that scripts may rely on, SI; rates in rad/s."""
    return {
        "eigenvalues": found.eigenvalues,
        "modes": [_mode(mode) for mode in found.modes],
        "A": model.A,
        "U": model.U,
        "states": list(model.states),
        "inputs": list(model.inputs),
        "state_units": list(model.state_units),
        "input_units": list(model.input_units),
    }


def _mode(mode: "Mode") -> dict[str, Any]:
    """Return one mode as JSON holds it."""
    kept = {key: value for key, value in mode._asdict().items() if key != "places"}
    return kept | {"stable": mode.stable}


def _ranked(table: "Sensitivities") -> dict[str, Any]:
    """Return the ranked table as JSON holds it."""
    return table._asdict() | {"message": table.message, "rows": [row._asdict() for row in table.rows]}


def _title(scenario: "Scenario", point: "TrimPoint") -> str:
    """Return what was linearised: wind [m/s], formulation, heights above the ground [m]."""
    title = f"{scenario.config.title}: wind {scenario.config.wind.speed:g} m/s, {scenario.formulation}"
    return f"{title}\n{clearance_line(point.clearance_hull, point.clearance_cable)}".rstrip()


def _table(found: "Modes", title: str) -> Table:
    """Return the modes as a table, a remark behind each."""
    heads = ("mode", "λ [1/s]", "", "ω [rad/s]", "ζ", "half/double [s]")
    return Table([[*_row(mode), _remark(mode)] for mode in found.modes], title, COLUMNS, heads)


def _row(mode: "Mode") -> list[Any]:
    """Return one mode's values of COLUMNS; people are shown λ in one piece, and no period."""
    root, time = mode.eigenvalue, mode.half_or_double_time
    value = f"{0.0 if mode.null else root.real:.5f}" + (f" ± {root.imag:.5f}i" if mode.oscillates else "")
    return [
        mode.name,
        Cell(root.real, value),
        Cell(root.imag, ""),
        Cell(mode.frequency, f"{mode.frequency:.4f}"),
        Cell(mode.damping, f"{mode.damping:.3f}"),
        Cell(time, "–" if time is None else f"{time:.1f}"),
        Cell(mode.period, ""),
        Cell(mode.stable, ""),
    ]


def _remark(mode: "Mode") -> str:
    """Return what is to be known of a mode besides its numbers."""
    growing = "" if mode.half_or_double_time is None or mode.stable else "doubles"
    alike = f"{mode.multiplicity} coincide" if mode.multiplicity > 1 else ""
    defective = "defective" if alike and mode.defective else ""
    return ", ".join(filter(None, ("null" if mode.null else growing, alike, defective)))


def _ranked_table(table: "Sensitivities") -> Table:
    """Return the parameters that move the mode most by an ordinary step."""
    rows = [
        [
            row.parameter,
            Cell(row.value, f"{row.value:.4g}"),
            row.unit,
            Cell(row.step, f"{row.step:.2g}"),
            Cell(row.shift, f"{row.shift.real:+.2e} {row.shift.imag:+.2e}i"),
        ]
        for row in table.rows[:20]
        if row.shift is not None
    ]
    heads = ("parameter", "value", "unit", "step", "shift of λ [1/s]")
    return Table(rows, f"\n{table.message}; ranked by what an ordinary step does", heads, heads)


def _count(table: "Sensitivities") -> str:
    """Return how many parameters there are, and how many cannot be ranked."""
    missing = sum(row.derivative is None for row in table.rows)
    note = f"{missing} have no derivative (no trim beside, or a corner)."
    return f"  {len(table.rows)} parameters; --json has all. {note}"
