"""`tethership tension`: one cable between two points."""

from typing import Annotated, Any, NamedTuple

import numpy as np
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
from tethership.errors import ConfigError, SolveError
from tethership.results import GROUND, REGIMES, ratios_passed, write_atomically
from tethership.scenario import Scenario

FINE = 513
"""Points of the curve from which the sag is read off: 1e-5 of it for a parabola."""

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
    between = _Line(loaded, index, np.array(end), place, reach, anchor is not None)
    with np.errstate(all="ignore"):  # what is not finite is told by _check_finite
        document = _computed(between, np.array(velocity), wind_vector, points)
        _check_finite(between, document["tension"])
    if out is not None:
        write_atomically(out / "tension.json", json_text(document))
    tables = [Table(_rows(document), f"cable {chosen.name!r}, {reach:g} m, formulation {loaded.formulation}")]
    if points is not None:
        tables.append(_curve(document))
    show(Result(document, tables=tables, warnings=document["warnings"]), json, csv)


class _Line(NamedTuple):
    """One cable of a scenario with its ends put somewhere; positions in ground axes [m], length unstretched [m]."""

    scenario: Scenario
    place: int
    end: np.ndarray
    anchor: np.ndarray
    length: float
    moved: bool

    @property
    def ground(self) -> float:
        """Down coordinate of the ground [m]: the scenario's, or the level of an anchor that was put elsewhere."""
        given = self.scenario.config.ground.anchor_height is not None
        return float(self.anchor[2] if self.moved and not given else self.scenario.system.environment.ground)

    def limits_passed(self, tension: float, largest: float) -> dict[str, float]:
        """Return tension over limit [-] of every watched limit that is passed; a cable breaks at its own force."""
        limits = self.scenario.config.watched_limits()
        limits["cable_break"] = self.scenario.config.cables[self.place].breaking_force
        return ratios_passed(limits, dict.fromkeys(limits, tension) | {"cable_break": largest})

    def warnings(self, passed: dict[str, float], largest: float, clearance: float) -> list[str]:
        """Return what must be known of the result before it is used."""
        name, said = self.scenario.config.cables[self.place].name, []
        if "cable_break" in passed:
            said.append(
                f"the cable {name} would break: {largest:.4g} N are {passed['cable_break']:.3g} times its breaking "
                "force"
            )
        if clearance < -1e-3:
            said.append(
                f"the cable {name} hangs {-clearance:.2f} m below the ground, on which it would lie; contact is not "
                "modelled"
            )
        return said


def _check_finite(line: _Line, tension: float) -> None:
    """Raise SolveError where the tension [N] between two ends is not finite."""
    if not np.isfinite(tension):
        apart = float(np.linalg.norm(line.end - line.anchor))
        raise SolveError(
            f"the tension between these ends is not finite: {line.length:g} m of cable over {apart:.3g} m are beyond "
            "what can be computed; check --end, --anchor and --length"
        )


def _curve(result: dict[str, Any]) -> Table:
    """Return the points of the curve [m] and the tension there [N]."""
    rows = [
        [*(Cell(value, f"{value:.3f} m") for value in position), Cell(tension, f"{tension:.3f} N")]
        for position, tension in zip(result["points"].tolist(), result["tension_along"].tolist(), strict=True)
    ]
    return Table(rows, columns=(*GROUND, "tension"), heads=(*GROUND, "tension"))


def _rows(result: dict[str, Any]) -> list[Row]:
    """Return forces and place as rows of a table."""
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


def _cable_index(scenario: Scenario, name: str | None) -> int:
    """Return the place of the named cable, of the first if no name is given."""
    names = [cable.name for cable in scenario.config.cables]
    if not names:
        raise ConfigError(f"scenario {scenario.name} has no cable; name one that has (tethership list)")
    if name is not None and name not in names:
        raise ConfigError(f"--cable {name!r} is not in scenario {scenario.name}; it has {', '.join(names)}")
    return 0 if name is None else names.index(name)


def _computed(
    line: _Line,
    velocity: np.ndarray,
    wind_vector: tuple[float, float, float] | None,
    points: int | None,
) -> dict[str, Any]:
    """Return forces, shape, and what must be known of them; positions and vectors in ground axes, SI, angles in deg."""
    import jax.numpy as jnp

    from tethership.plant import cable_along, cable_between

    scenario = line.scenario
    cable, environment = scenario.system.cables[line.place], scenario.system.environment
    given = None if wind_vector is None else jnp.array(wind_vector)
    ends = jnp.asarray(line.end), jnp.asarray(line.anchor)
    found = cable_between(cable, environment, *ends, jnp.asarray(line.length), jnp.asarray(velocity), given)
    fine, _ = cable_along(cable, found, *ends, jnp.linspace(0.0, line.length, FINE))
    tension, largest = (float(np.linalg.norm(found.ship)), float(np.linalg.norm(found.anchor)))
    largest = max(tension, largest)
    clearance = line.ground - float(found.lowest[2])
    passed = line.limits_passed(tension, largest)
    result = {
        "force": found.ship,
        "tension": tension,
        "regime": REGIMES[int(found.regime)],
        "elongation": float(np.linalg.norm(line.end - line.anchor) / line.length),
        "anchor_force": found.anchor,
        "lowest_point": found.lowest,
        "load": found.load,
        "formulation": scenario.formulation,
        "line": scenario.config.line_models(),
        "angles": {"anchor": _elevation(found.anchor), "ship": _elevation(-np.asarray(found.ship))},
        "sag": _sag(np.asarray(fine)),
        "limits_passed": passed,
        "clearance_hull": None,
        "clearance_cable": clearance,
        "warnings": line.warnings(passed, largest, clearance),
    }
    if points is None:
        return result
    arc = jnp.linspace(0.0, line.length, points)
    curve, along = cable_along(cable, found, *ends, arc)
    return result | {"arc": arc, "points": curve, "tension_along": along}


def _elevation(direction: Any) -> float | None:
    """Return the angle above the horizontal of a direction from the anchor's side to the ship's [deg], None at rest."""
    vector = np.asarray(direction)
    length = float(np.linalg.norm(vector))
    return float(np.degrees(np.arcsin(-vector[2] / length))) if length > 0 else None


def _sag(curve: np.ndarray) -> float:
    """Return the largest distance of a curve from its chord [m]."""
    span, offset = curve[-1] - curve[0], curve - curve[0]
    share = np.clip(offset @ span / max(float(span @ span), 1e-300), 0.0, 1.0)
    return float(np.linalg.norm(offset - share[:, None] * span, axis=1).max())
