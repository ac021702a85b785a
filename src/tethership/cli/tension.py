"""`tethership tension`: one cable between two points."""

from typing import Annotated, Any

import numpy as np
import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    MaybeOutOption,
    ScenarioArgument,
    SetOption,
    WindOption,
    chosen_scenario,
    json_text,
    print_json,
    writable_folder,
)
from tethership.cli.tables import CsvOption, Row, print_table, writable_csv, write_rows
from tethership.errors import ConfigError
from tethership.results.files import write_atomically
from tethership.results.schema import GROUND, REGIMES
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
    wind: WindOption = None,
    formulation: FormulationOption = None,
    changes: SetOption = None,
    out: MaybeOutOption = None,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Tension and shape of one cable of a scenario, its ends put where you say.

    With --out the result is also written there as tension.json.
    """
    loaded = chosen_scenario(scenario, wind, formulation, changes)
    index = _cable_index(loaded, cable)
    writable_csv(csv)
    folder = None if out is None else writable_folder(out)
    chosen = loaded.config.cables[index]
    reach = chosen.length if length is None else length
    if not reach > 0:
        raise ConfigError(f"--length is {reach:g}; it must be above 0 m")
    place = np.array(chosen.anchor if anchor is None else anchor)
    result = _computed(loaded, index, np.array(end), place, reach, np.array(velocity), wind_vector)
    if folder is not None:
        write_atomically(folder / "tension.json", json_text(result))
    rows = _rows(result)
    write_rows(csv, rows)
    if json:
        print_json(result)
        return
    print_table(rows, f"cable {chosen.name!r}, {reach:g} m, formulation {loaded.formulation}")


def _rows(result: dict[str, Any]) -> list[Row]:
    """Return forces and place as rows of a table."""
    force = map(float, result["force"])
    return [
        Row("tension at the ship", result["tension"], "N", ".3f"),
        *[Row(f"force on the ship, {axis}", part, "N", ".3f") for axis, part in zip(GROUND, force, strict=True)],
        Row("tension at the anchor", float(np.linalg.norm(result["anchor_force"])), "N", ".3f"),
        Row("elongation", result["elongation"], "", ".5f"),
        Row("regime", result["regime"]),
        Row("lowest point, down", float(result["lowest_point"][2]), "m", ".3f"),
    ]


def _cable_index(scenario: Scenario, name: str | None) -> int:
    """Return the place of the named cable, of the first if no name is given."""
    names = [cable.name for cable in scenario.config.cables]
    if not names:
        raise ConfigError(f"scenario {scenario.name} has no cable; name one that has (tethership list)")
    if name is not None and name not in names:
        raise ConfigError(f"--cable {name!r} is not in scenario {scenario.name}; it has {', '.join(names)}")
    return 0 if name is None else names.index(name)


def _computed(
    scenario: Scenario,
    index: int,
    end: np.ndarray,
    anchor: np.ndarray,
    length: float,
    velocity: np.ndarray,
    wind_vector: tuple[float, float, float] | None,
) -> dict[str, Any]:
    """Return forces, regime and lowest point; positions and vectors in ground axes, SI."""
    import jax.numpy as jnp

    from tethership.system.tethered import cable_between

    cable, environment = scenario.system.cables[index], scenario.system.environment
    given = None if wind_vector is None else jnp.array(wind_vector)
    places = jnp.asarray(end), jnp.asarray(anchor), jnp.asarray(length), jnp.asarray(velocity)
    found = cable_between(cable, environment, *places, given)
    return {
        "force": found.ship,
        "tension": float(np.linalg.norm(found.ship)),
        "regime": REGIMES[int(found.regime)],
        "elongation": float(np.linalg.norm(end - anchor) / length),
        "anchor_force": found.anchor,
        "lowest_point": found.lowest,
        "load": found.load,
        "formulation": scenario.formulation,
    }
