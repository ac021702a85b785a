"""`tethership tension`: one cable between two points."""

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
from tethership.cli.result import Result, show
from tethership.cli.tables import Cell, CsvOption, Row, Table
from tethership.errors import ConfigError
from tethership.results import GROUND, write_atomically

if TYPE_CHECKING:
    from tethership.scenario import Scenario

EXAMPLE = "Example: tethership tension --end -11.3137 0 -11.3137 --length 20 --wind-vector -6 0 0 --json"


def tension(
    end: Annotated[tuple[float, float, float], typer.Option(help="Ship's end: north, east, down [m].")],
    scenario: ScenarioArgument = "docking",
    length: Annotated[float | None, typer.Option(help="Unstretched length [m]. Default: the scenario's.")] = None,
    velocity: Annotated[
        tuple[float, float, float], typer.Option(help="Ground velocity of the ship's end, ground axes [m/s].")
    ] = (0.0, 0.0, 0.0),
    wind_vector: Annotated[
        tuple[float, float, float] | None,
        typer.Option(help="Velocity of the air, ground axes [m/s]. Default: the scenario's wind."),
    ] = None,
    anchor: Annotated[
        tuple[float, float, float] | None,
        typer.Option(help="Anchor: north, east, down [m]. Default: the scenario's."),
    ] = None,
    cable: Annotated[str | None, typer.Option(help="Name of the cable. Default: the first.")] = None,
    points: Annotated[
        int | None, typer.Option(min=2, max=10_000, help="Also so many points of the curve, with the tension there.")
    ] = None,
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    trust: TrustOption = False,
    changes: SetOption = None,
    out: MaybeOutOption = None,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Tension and shape of one cable of a scenario, its ends put where you say.

    Told are forces, angles at both ends, sag, height above the ground and limits that are passed; with --points the
    curve from the anchor to the ship too (north, east, down [m]), with the tension there [N]. With --out the result
    is also written there as tension.json.
    """
    import numpy as np

    from tethership.cli.between import Line, check_finite, computed

    if wind is not None and wind_vector is not None:
        raise ConfigError("--wind and --wind-vector both say what the wind is; give one of them")
    loaded = chosen_scenario(scenario, wind, formulation, changes, line, trust)
    index = _cable_index(loaded, cable)
    chosen = loaded.config.cables[index]
    reach = chosen.length if length is None else length
    if not reach > 0:
        raise ConfigError(f"--length is {reach:g}; it must be above 0 m")
    writable(out, csv)
    place = np.array(chosen.anchor if anchor is None else anchor)
    between = Line(loaded, index, np.array(end), place, reach, anchor is not None)
    with np.errstate(all="ignore"):  # what is not finite is told by check_finite
        document = computed(between, np.array(velocity), wind_vector, points)
        check_finite(between, document["tension"])
    if out is not None:
        write_atomically(out / "tension.json", json_text(document))
    tables = [Table(_rows(document), f"cable {chosen.name!r}, {reach:g} m, formulation {loaded.formulation}")]
    if points is not None:
        tables.append(_curve(document))
    show(Result(document, tables=tables, warnings=document["warnings"]), json, csv)


def _curve(result: dict[str, Any]) -> Table:
    """Return the points of the curve [m] and the tension there [N]."""
    rows = [
        [*(Cell(value, f"{value:.3f} m") for value in position), Cell(tension, f"{tension:.3f} N")]
        for position, tension in zip(result["points"].tolist(), result["tension_along"].tolist(), strict=True)
    ]
    return Table(rows, columns=(*GROUND, "tension"), heads=(*GROUND, "tension"))


def _rows(result: dict[str, Any]) -> list[Row]:
    """Return forces and place as rows of a table."""
    import numpy as np

    force = map(float, result["force"])
    return [
        Row("tension at the ship", result["tension"], "N", ".3f"),
        *[Row(f"force on the ship, {axis}", part, "N", ".3f") for axis, part in zip(GROUND, force, strict=True)],
        Row("tension at the anchor", float(np.linalg.norm(result["anchor_force"])), "N", ".3f"),
        Row("elongation", result["elongation"], "", ".5f"),
        Row("regime", result["regime"], note="beyond its breaking force" * ("cable_break" in result["limits_passed"])),
        Row("lowest point, down", float(result["lowest_point"][2]), "m", ".3f"),
        Row("cable above ground", result["clearance_cable"], "m", ".3f"),
        Row("sag off the chord", result["sag"], "m", ".3f"),
        *[
            Row(f"elevation at the {end}", angle, "deg", ".2f")
            for end, angle in result["angles"].items()
            if angle is not None
        ],
        *[Row(f"limit passed: {name}", ratio, "times", ".3f") for name, ratio in result["limits_passed"].items()],
    ]


def _cable_index(scenario: "Scenario", name: str | None) -> int:
    """Return the place of the named cable, of the first if no name is given."""
    names = [cable.name for cable in scenario.config.cables]
    if not names:
        raise ConfigError(f"scenario {scenario.name} has no cable; name one that has (tethership list)")
    if name is not None and name not in names:
        raise ConfigError(f"--cable {name!r} is not in scenario {scenario.name}; it has {', '.join(names)}")
    return 0 if name is None else names.index(name)
