"""`tethership trim`: the equilibrium of a scenario."""

from typing import TYPE_CHECKING, Annotated

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
from tethership.cli.points import clearance_rows, point_keys
from tethership.cli.progress import stage
from tethership.cli.result import Result, show
from tethership.cli.tables import CsvOption, Row, Table
from tethership.results import write_atomically

if TYPE_CHECKING:
    from tethership.analysis import TrimPoint
    from tethership.scenario import Scenario

EXAMPLE = "Example: tethership trim aerostat --wind 10 --json"

ANGLES = ("phi", "theta", "psi")


def trim(
    scenario: ScenarioArgument = "docking",
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    unknowns: Annotated[
        str | None,
        typer.Option(
            help="What is looked for, by commas: velocity_north … phi … down, thrusters, throttle, deflection."
        ),
    ] = None,
    trust: TrustOption = False,
    changes: SetOption = None,
    out: MaybeOutOption = None,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Find where the ship rests or flies steadily; throttles of least norm where there is a choice.

    With --out the result is also written there as trim.json.
    """
    import numpy as np

    from tethership.analysis import TrimOutcome
    from tethership.analysis import trim as solve
    from tethership.plant import STATE_NAMES

    loaded = chosen_scenario(scenario, wind, formulation, changes, line, trust)
    writable(out, csv)
    names = None if unknowns is None else [name.strip() for name in unknowns.split(",")]
    with stage("trim"):
        point = solve(loaded, names)
    values = np.asarray(point.state.as_vector())
    state = {
        name: float(np.degrees(value)) if name in ANGLES else float(value)
        for name, value in zip(STATE_NAMES, values, strict=True)
    }
    document = point_keys(point) | {
        "throttle": point.command.throttle,
        "deflection": np.degrees(point.command.deflection),
        "tension": point.tension,
        "residual": point.residual,
        "state": state,
        "wind": loaded.config.wind.speed,
        "formulation": loaded.formulation,
        "line": loaded.config.line_models(),
    }
    if out is not None:
        write_atomically(out / "trim.json", json_text(document))
    table = Table(_rows(loaded, point, state), f"{point.outcome.name}: {point.message}")
    met = point.outcome is TrimOutcome.converged
    show(Result(document, tables=[table], warnings=point.warnings, answered=met), json, csv)


def _rows(loaded: "Scenario", point: "TrimPoint", state: dict[str, float]) -> list[Row]:
    """Return throttles, deflections (of a ship that moves its fins), tensions and states as rows of a table."""
    import numpy as np

    throttles = zip(loaded.config.vehicle.thrusters, point.command.throttle, strict=True)
    angles = np.asarray(point.command.deflection)
    deflections = zip(loaded.config.vehicle.fins, angles, strict=True) if angles.any() else ()
    tensions = zip(loaded.config.cables, point.tension, strict=True)
    units = dict.fromkeys(ANGLES, "deg") | dict.fromkeys("uvw", "m/s") | dict.fromkeys("pqr", "rad/s")
    return [
        *[Row(thruster.name, float(throttle), "", ".4f") for thruster, throttle in throttles],
        *[Row(fin.name, float(np.degrees(angle)), "deg", ".3f") for fin, angle in deflections],
        *[Row(f"tension {cable.name}", float(tension), "N", ".2f") for cable, tension in tensions],
        *[Row(f"limit passed: {name}", ratio, "times", ".3f") for name, ratio in point.limits_passed.items()],
        *clearance_rows(point.clearance_hull, point.clearance_cable),
        *[Row(name, value, units.get(name, "m"), ".4f") for name, value in state.items()],
        Row("largest residual", float(np.abs(np.asarray(point.residual)).max()), "N, N m", ".2e"),
    ]
