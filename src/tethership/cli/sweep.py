"""`tethership sweep`: root loci along parameters, or Figures 6–11 of the paper."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership.cli.common import (
    FormulationOption,
    JsonOption,
    LineOption,
    OutOption,
    ScenarioArgument,
    SetOption,
    TrustOption,
    WindOption,
    chosen_scenario,
    flag_changes,
    pair,
    writable,
)
from tethership.cli.completion import complete_parameter
from tethership.cli.points import clearance_line
from tethership.cli.progress import stage
from tethership.cli.result import Result, show
from tethership.cli.tables import CsvOption, Table
from tethership.errors import ConfigError, shown
from tethership.results import write_together
from tethership.scenario import parse_json

if TYPE_CHECKING:
    import numpy as np

    from tethership.analysis import Sweep
    from tethership.scenario import Scenario

EXAMPLE = "Example: tethership sweep --over wind=6:12:13 --out loci"

MEETINGS = ("coalesce", "split", "cross")
"""Events of the contract; passages of the imaginary axis are told under `stability`."""


def sweep(
    scenario: ScenarioArgument = "docking",
    over: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=FROM:TO:POINTS",
            help="What to vary; NAME=[v1,v2] lists values; commas move several together; repeat for a grid.",
            autocompletion=complete_parameter,
        ),
    ] = None,
    loop: Annotated[
        str, typer.Option(help="open (thrusters are inputs), or closed with the laws: a gain's root locus.")
    ] = "open",
    figure: Annotated[int | None, typer.Option(help="Redraw figure 6 to 11 of the paper instead.")] = None,
    wind: WindOption = None,
    formulation: FormulationOption = None,
    line: LineOption = None,
    trust: TrustOption = False,
    changes: SetOption = None,
    out: OutOption = Path("out"),
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """Trim and linearise along any parameters, follow every mode by name, draw the root locus.

    Writes a picture and an interactive page into --out. With --figure and no --formulation, both formulations.
    """
    from tethership._studies import studied
    from tethership.analysis.loci import sweep_warnings

    if (over is None) == (figure is None):
        raise ConfigError("name what to vary, --over wind=6:12:13, or a figure of the paper, --figure 7 (not both)")
    if figure is not None:
        if scenario != "docking":
            raise ConfigError(f"--figure has its own scenarios; leave out {scenario!r}, or change values with --set")
        writable(out, csv)
        document, found = studied("figures")(figure, formulation, flag_changes(wind, None, changes), out)
    else:
        loaded = chosen_scenario(scenario, wind, formulation, changes, line, trust)
        axes = [_axis(loaded, text) for text in over or []]
        writable(out, csv)
        document, found = _swept(loaded, axes, out, loop)
    result = Result(
        document,
        data=_table(found),
        lines=[line for one in found for line in _lines(one)],
        files=document["files"],
        warnings=[line for one in found for line in sweep_warnings(one)],
        answered=any(one.trimmed.any() for one in found),
        reason=f"no point could be trimmed. {found[0].outcomes[0].value}",
    )
    show(result, json, csv)


def _swept(
    scenario: "Scenario", axes: list[dict[str, "np.ndarray"]], out: Path, loop: str = "open"
) -> tuple[dict[str, Any], list["Sweep"]]:
    """Return the result of a sweep; writes root_locus.png and root_locus.html."""
    from tethership.analysis import sweep as compute
    from tethership.view import png
    from tethership.view.linear import interactive_root_locus, page, plot_root_loci

    with stage("sweep"):
        found = compute(scenario, *axes, loop=loop)
    head = {
        "wind": scenario.config.wind.speed,
        "formulation": scenario.formulation,
        "line": scenario.config.line_models(),
        "loop": loop,
    }
    result = head | summary(found)
    with stage("draw"):
        drawn = page(interactive_root_locus(found, scenario.config.title))
        picture = png(plot_root_loci(found), 120)
    pair = write_together({out / "root_locus.png": picture, out / "root_locus.html": drawn})
    result["files"] = [str(path) for path in pair]
    return result, [found]


def summary(found: "Sweep") -> dict[str, Any]:
    """Return the keys that scripts may rely on, SI; angles among the parameters in degrees."""
    import numpy as np

    from tethership.analysis.loci import sweep_warnings

    first = next(iter(found.values))
    factors = {name: 180.0 / math.pi if unit == "rad" else 1.0 for name, unit in found.units.items()}
    events = [
        {
            "kind": event.kind,
            "value": event.at[first] * factors[first],
            "at": {name: value * factors[name] for name, value in event.at.items()},
            "modes": list(event.tracks),
            "eigenvalue": event.eigenvalue,
        }
        for event in found.events
    ]
    return {
        "parameter": found.values[first] * factors[first],
        "parameters": {name: values * factors[name] for name, values in found.values.items()},
        "units": {name: "deg" if unit == "rad" else unit for name, unit in found.units.items()},
        "shape": list(found.shape),
        "tracks": {name: [_root(value) for value in found.track(name)] for name in found.tracks},
        "names": {
            name: [row[index] or None for row in map(found.names_at, range(len(found.outcomes)))]
            for index, name in enumerate(found.tracks)
        },
        "events": [event for event in events if event["kind"] in MEETINGS],
        "stability": [event for event in events if event["kind"] not in MEETINGS],
        "unstable_throughout": list(found.unstable_throughout),
        "outcome": [outcome.name for outcome in found.outcomes],
        "throttle": found.throttle,
        "tension": found.tension,
        "residual": np.abs(found.residual).max(axis=1),
        "limits_passed": [found.limits_passed(point) for point in range(len(found.outcomes))],
        "clearance_hull": found.clearance_hull,
        "clearance_cable": found.clearance_cable,
        "warnings": sweep_warnings(found),
    }


def _root(value: complex) -> list[float] | None:
    return None if math.isnan(value.real) else pair(value)


def _table(found: list["Sweep"]) -> Table:
    """Return a row for each point and track: parameters [SI], eigenvalue [1/s], how the trim ended."""
    names, rows = list(dict.fromkeys(name for one in found for name in one.values)), []
    for one in found:
        for i, outcome in enumerate(one.outcomes):
            place = [one.values[name][i] if name in one.values else "" for name in names]
            for track in one.tracks:
                root = complex(one.track(track)[i])
                numbers = ["", ""] if math.isnan(root.real) else [root.real, root.imag]
                rows.append([*place, track, *numbers, outcome.name])
    return Table(rows, columns=(*names, "track", "real", "imaginary", "outcome"))


def _axis(scenario: "Scenario", text: str) -> dict[str, "np.ndarray"]:
    """Return the parameters of one --over and their values [SI]."""
    axis: dict[str, "np.ndarray"] = {}
    for part in _parts(text):
        name, equals, values = part.partition("=")
        if not equals or not name or not values:
            raise ConfigError(f"--over {shown(part)} is no range; write --over name=from:to:points, e.g. wind=6:12:13")
        if name.strip() in axis:
            raise ConfigError(f"--over {shown(text)}: {name.strip()} is named twice; name each parameter once")
        axis[name.strip()] = _listed(part, values) if values.startswith("[") else _range(scenario, name.strip(), values)
    return axis


def _parts(text: str) -> list[str]:
    """Return the parts between commas that are not inside brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += {"[": 1, "]": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts


def _listed(part: str, values: str) -> "np.ndarray":
    """Return the values of name=[v1,v2,…]."""
    import numpy as np

    try:
        return np.array(parse_json(values, f"--over {shown(part)}"), dtype=float)
    except (ValueError, TypeError) as error:
        raise ConfigError(f"--over {shown(part)} is no list of numbers; write e.g. wind=[6,9,12]") from error


def _range(scenario: "Scenario", name: str, text: str) -> "np.ndarray":
    """Return the values of from:to:points, the ends with units if given."""
    import numpy as np

    pieces = text.split(":")
    if len(pieces) not in (2, 3):
        raise ConfigError(f"--over {name}={text}: write from:to:points, e.g. {name}=6:12:13")
    low, high = (_number(scenario, name, piece) for piece in pieces[:2])
    count = _points(name, text, pieces[2]) if len(pieces) == 3 else 25
    if count < 1 or (low == high and count > 1):
        raise ConfigError(f"--over {name}={text}: the range is empty; give two different ends and at least one point")
    if high < low:
        raise ConfigError(
            f"--over {name}={text}: the range is reversed; give the lower end first, {name}={high:g}:{low:g}"
        )
    return np.linspace(low, high, count)


def _points(name: str, text: str, typed: str) -> int:
    """Return the number of points, no more than a sweep may have."""
    from tethership.analysis.loci import MOST_POINTS

    try:
        count = int(typed)
    except ValueError as error:
        raise ConfigError(f"--over {name}={text}: {shown(typed)} is no number of points") from error
    if count > MOST_POINTS:
        raise ConfigError(f"--over {name}={text}: {typed} points are too many (at most {MOST_POINTS}); sweep in parts")
    return count


def _number(scenario: "Scenario", name: str, text: str) -> float:
    """Return one end of a range [SI]; a unit is converted to that of the parameter."""
    from tethership.scenario import SI_UNIT, converted, find_parameter, list_parameters, number_with_unit

    parameter = find_parameter(list_parameters(scenario.config), name, scenario.name)
    with_unit = number_with_unit(text)
    if text.strip().lower().lstrip("+-") in ("nan", "inf", "infinity"):
        raise ConfigError(f"--over {name}: the end {text!r} is not a finite number")
    try:
        return converted(*with_unit, parameter.unit) if with_unit else converted(float(text), SI_UNIT, parameter.unit)
    except ValueError as error:
        raise ConfigError(f"--over {name}: {shown(text)} is no number for an end: {error}") from error


def _least(heights: "np.ndarray") -> float | None:
    """Return the least of some heights [m], None where none is known."""
    import numpy as np

    known = heights[np.isfinite(heights)]
    return float(known.min()) if len(known) else None


def _lacking(found: "Sweep", point: int) -> str:
    """Return by how much a point fails to be a trim."""
    import numpy as np

    match found.outcomes[point].name:
        case "no_equilibrium":
            left = np.abs(found.residual[point]).max()
            return f"{left:.3g} N or N m left over" if np.isfinite(left) else "none that continues this line's"
        case "hull_below_ground":
            return f"hull {-found.clearance_hull[point]:.1f} m below the ground"
        case "cable_below_ground":
            return f"cable {-found.clearance_cable[point]:.1f} m below the ground: longer than the lift can hold up"
        case _:
            most = np.abs(found.throttle[point]).max(initial=0.0)
            turned = np.degrees(np.abs(found.deflection[point]).max(initial=0.0))
            fins = f", largest |deflection| {turned:.1f}°" if turned > 0 else ""
            return f"largest |throttle| {most:.2f} of nominal{fins}"


def _lines(one: "Sweep") -> Iterator[str]:
    """Yield what happened along a sweep, a line each."""
    first, last = ({name: float(v[i]) for name, v in one.values.items()} for i in (0, -1))
    words = ", ".join(f"{name} {first[name]:.4g} to {last[name]:.4g} {one.units[name]}" for name in one.values)
    yield f"{words}: {int(one.trimmed.sum())} of {len(one.outcomes)} points in trim"
    where = clearance_line(_least(one.clearance_hull), _least(one.clearance_cable), "least ")
    if where:
        yield where
    for point, value in enumerate(next(iter(one.values.values()))):
        if not one.trimmed[point]:
            yield f"  {value:<10.4g} {one.outcomes[point].name}: {_lacking(one, point)}"
    for name in one.unstable_throughout:
        growth = one.track(name)[one.trimmed].real
        yield f"  {name} unstable at every point (Re λ {growth.min():.3g} … {growth.max():.3g} 1/s)"
    for event in one.events:
        place = ", ".join(f"{name} = {value:.4g}" for name, value in event.at.items())
        verb = {"unstable": "becomes unstable", "stable": "becomes stable"}.get(event.kind, event.kind)
        yield f"  {' and '.join(event.tracks)} {verb} at {place} (λ = {event.eigenvalue:.4f} 1/s)"
