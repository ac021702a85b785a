"""`tethership modes`: eigenvalues and named modes of the trimmed ship."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership.cli.common import (
    NO_ANSWER,
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
    pair,
    print_json,
    stage,
    writable_folder,
)
from tethership.cli.points import balanced, clearance_line, point_keys, warn
from tethership.cli.tables import CsvOption, writable_csv, write_csv
from tethership.errors import ConfigError, suggestion
from tethership.results.files import write_together

if TYPE_CHECKING:
    from tethership.analysis import LinearModel, Mode, Modes, Sensitivities

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
    from tethership.analysis import TrimOutcome, linearize

    if part not in PARTS:
        raise ConfigError(f"--part {part!r} is no part{suggestion(part, PARTS)} Allowed: {', '.join(PARTS)}")
    if loop not in LOOPS:
        raise ConfigError(f"--loop {loop!r} is none{suggestion(loop, LOOPS)} Allowed: {', '.join(LOOPS)}")
    if loop == "closed" and sensitivity is not None:
        raise ConfigError(
            "--sensitivity is of the open loop; leave --loop closed out, or sweep a gain with --loop closed"
        )
    loaded = chosen_scenario(scenario, wind, formulation, changes, line, trust)
    writable_csv(csv)
    folder = None if out is None else writable_folder(out)
    point = balanced(loaded, json)
    with stage("linearise"):
        model = _part(linearize(loaded, point, loop=loop), part)
        found = model.modes()
    ranked = None
    if sensitivity is not None:
        from tethership.analysis import sensitivities

        with stage("sensitivities"):
            ranked = sensitivities(loaded, sensitivity, point)
    head = point_keys(point) | {"wind": loaded.config.wind.speed, "formulation": loaded.formulation}
    told = [*point.warnings, *model.attributes.get("warnings", ())]
    head |= {
        "line": loaded.config.line_models(),
        "loop": loop,
        "sample_time": model.sample_time or None,
        "warnings": told,
    }
    result = head | summary(model, found) | ({} if ranked is None else {"sensitivity": _ranked(ranked)})
    if folder is not None:
        with stage("draw"):
            from tethership.view.linear.mode_shape import plot_all_modes
            from tethership.view.picture import png

            drawn = png(plot_all_modes(model), 120, model.run)
        files = {"model.nc": model.content(), "modes.json": json_text(result), "modes.png": drawn}
        write_together({folder / name: content for name, content in files.items()})
    write_csv(csv, COLUMNS, ([values[key] for key in COLUMNS] for values in map(_numbers, found.modes)))
    if json:
        print_json(result)
    else:
        title = f"{loaded.config.title}: wind {loaded.config.wind.speed:g} m/s, {loaded.formulation}"
        where = clearance_line(point.clearance_hull, point.clearance_cable)
        _print(found, ranked, f"{title}\n{where}".rstrip())
        warn(told)
    if point.outcome is not TrimOutcome.converged:
        typer.echo(f"tethership: {point.message}", err=True)
        raise typer.Exit(NO_ANSWER)


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


def summary(model: "LinearModel", found: "Modes") -> dict[str, Any]:
    """Return the keys that scripts may rely on, SI; rates in rad/s."""
    return {
        "eigenvalues": [pair(value) for value in found.eigenvalues],
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
    return {
        "name": mode.name,
        "eigenvalue": pair(mode.eigenvalue),
        "frequency": mode.frequency,
        "damping": mode.damping,
        "half_or_double_time": mode.half_or_double_time,
        "period": mode.period,
        "stable": mode.stable,
        "null": mode.null,
        "multiplicity": mode.multiplicity,
        "defective": mode.defective,
        "participation": mode.participation,
        "shape": {state: pair(value) for state, value in mode.shape.items()},
    }


def _numbers(mode: "Mode") -> dict[str, Any]:
    """Return one mode as a row of a table."""
    return {**mode._asdict(), "real": mode.eigenvalue.real, "imaginary": mode.eigenvalue.imag, "stable": mode.stable}


def _ranked(table: "Sensitivities") -> dict[str, Any]:
    """Return the ranked table as JSON holds it."""
    return {
        "mode": table.mode,
        "eigenvalue": pair(table.eigenvalue),
        "multiplicity": table.multiplicity,
        "message": table.message,
        "rows": [
            {
                "parameter": row.parameter,
                "unit": row.unit,
                "value": row.value,
                "derivative": None if row.derivative is None else pair(row.derivative),
                "step": row.step,
                "shift": None if row.shift is None else pair(row.shift),
                "reason": row.reason,
            }
            for row in table.rows
        ],
    }


def _print(found: "Modes", ranked: "Sensitivities | None", title: str) -> None:
    """Print the modes, and what moves one of them."""
    typer.echo(title)
    typer.echo(f"  {'mode':<22} {'λ [1/s]':>22} {'ω [rad/s]':>10} {'ζ':>7} {'half/double [s]':>16}")
    for mode in found.modes:
        value = f"{0.0 if mode.null else mode.eigenvalue.real:.5f}" + (
            f" ± {mode.eigenvalue.imag:.5f}i" if mode.oscillates else ""
        )
        time = "–" if mode.half_or_double_time is None else f"{mode.half_or_double_time:.1f}"
        growing = "" if mode.half_or_double_time is None or mode.stable else "  doubles"
        note = "  null" if mode.null else growing
        if mode.multiplicity > 1:
            note += f", {mode.multiplicity} coincide" + (", defective" if mode.defective else "")
        typer.echo(f"  {mode.name:<22} {value:>22} {mode.frequency:>10.4f} {mode.damping:>7.3f} {time:>16}{note}")
    if ranked is None:
        return
    typer.echo(f"\n{ranked.message}; ranked by what an ordinary step does")
    typer.echo(f"  {'parameter':<48} {'value':>10} {'unit':<9} {'step':>9} {'shift of λ [1/s]':>24}")
    for row in ranked.rows[:20]:
        if row.shift is not None:
            shift = f"{row.shift.real:+.2e} {row.shift.imag:+.2e}i"
            typer.echo(f"  {row.parameter:<48} {row.value:>10.4g} {row.unit:<9} {row.step:>9.2g} {shift:>24}")
    missing = sum(row.derivative is None for row in ranked.rows)
    typer.echo(
        f"  {len(ranked.rows)} parameters; --json has all. {missing} have no derivative (no trim beside, or a corner)."
    )
