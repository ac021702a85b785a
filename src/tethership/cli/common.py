"""What all commands share: the scenario argument, common flags, JSON, provenance. Depends on: scenario, typer."""

import json
import math
import platform
import time
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tethership._version import __version__
from tethership.cli.completion import complete_formulation, complete_line, complete_parameter, complete_scenario
from tethership.cli.tables import check_csv
from tethership.errors import ConfigError, shown, suggestion
from tethership.results import check_writable
from tethership.scenario import parse_json

if TYPE_CHECKING:
    from tethership.scenario import Scenario

WRONG_INPUT = 2
"""Exit code for wrong input."""

NO_ANSWER = 3
"""Exit code when a computation has no answer."""

ScenarioArgument = Annotated[
    str,
    typer.Argument(
        help="Packaged scenario (see `tethership list`) or a path that ends in .toml.", autocompletion=complete_scenario
    ),
]
ScenarioOption = Annotated[
    str | None,
    typer.Option(
        "--scenario", help="Packaged scenario or a path that ends in .toml.", autocompletion=complete_scenario
    ),
]
WindOption = Annotated[float | None, typer.Option("--wind", metavar="M_PER_S", help="Speed of the wind [m/s].")]
FormulationOption = Annotated[
    str | None,
    typer.Option(help="consistent or published: hull and cable laws together.", autocompletion=complete_formulation),
]
LineOption = Annotated[
    str | None,
    typer.Option(
        "--line",
        metavar="MODEL",
        help="catenary or published: the model of every cable's line.",
        autocompletion=complete_line,
    ),
]
TrustOption = Annotated[bool, typer.Option("--trust", help="Let code of one's own that the file names be run.")]
OutOption = Annotated[Path, typer.Option(help="Folder for the files that are written.")]
MaybeOutOption = Annotated[Path | None, typer.Option(help="Folder for the files; without it none are written.")]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object on standard output, nothing else.")]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change one value of the scenario: SI and radians, or with its unit (270deg); repeatable.",
        autocompletion=complete_parameter,
    ),
]


def chosen_scenario(
    name: str,
    wind: float | None,
    formulation: str | None,
    changes: list[str] | None,
    line: str | None = None,
    trust: bool = False,
) -> "Scenario":
    """Return the scenario with the flags applied; a flag wins over the file.

    Parameters
    ----------
    name : str
        Packaged name or path.
    wind : float, optional
        Wind speed [m/s].
    formulation : str, optional
        `consistent` or `published`.
    changes : list of str, optional
        `key=value` pairs.
    line : str, optional
        Model of every cable's line.
    trust : bool
        Let laws of one's own that the file names be run.

    Raises
    ------
    ConfigError
        As `load_scenario`, or a change that is not `key=value`.
    """
    from tethership.scenario import load_scenario

    if wind is not None and "wind.speed" in parsed_changes(changes):
        raise ConfigError("--wind and --set wind.speed both say what the wind is; give one of them")
    scenario = load_scenario(name, flag_changes(wind, formulation, changes), trust)
    if line is None:
        return scenario
    change = line_change(line)
    if not scenario.config.cables:
        raise ConfigError(f"--line {line} needs a cable, and {scenario.name} has none; leave --line out")
    return scenario.changed(change)


def flag_changes(wind: float | None, formulation: str | None, changes: list[str] | None) -> dict[str, Any]:
    """Return the changes of --set, --wind [m/s] and --formulation by dotted names; a flag of its own wins."""
    flags = {"wind.speed": wind, "formulation": formulation}
    return parsed_changes(changes) | {name: value for name, value in flags.items() if value is not None}


def line_change(line: str | None) -> dict[str, Any]:
    """Return the change that gives every cable a model of its line; raises ConfigError for an unknown one."""
    if line is None:
        return {}
    from tethership.scenario import LINES

    models = tuple(LINES.values())
    if line not in models:
        raise ConfigError(f"--line {shown(line)} is no line{suggestion(line, models)} Allowed: {', '.join(models)}")
    return {"cables.*.line": {"model": line}}


def parsed_changes(changes: list[str] | None) -> dict[str, Any]:
    """Return dotted names and values of `key=value` pairs."""
    return dict(_change(text) for text in changes or [])


def pair(value: complex) -> list[float]:
    """Return a complex number as [real, imaginary]."""
    return [float(value.real), float(value.imag)]


def _change(text: str) -> tuple[str, Any]:
    """Return key and value of `key=value`; JSON, a number with a unit, or else a word."""
    from tethership.scenario import number_with_unit

    key, equals, value = text.partition("=")
    if not equals or not key:
        raise ConfigError(f"--set {shown(text)} is no change; write --set key=value, e.g. --set wind.speed=9")
    with_unit = number_with_unit(value)
    if with_unit is None:
        return key, parse_json(value, f"--set {shown(key)}")
    return key, dict(zip(("value", "unit"), with_unit, strict=True))


def json_text(result: dict[str, Any]) -> str:
    """Return a result as JSON; a number that is not finite becomes null."""
    return json.dumps(_plain(result))


def _plain(value: Any) -> Any:
    """Return a value as JSON can hold it."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, complex):
        return _plain(pair(value))
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def provenance(**of: Any) -> dict[str, Any]:
    """Return versions and time of a report, with what it is of."""
    import jax

    return {
        "tethership": __version__,
        **of,
        "jax": jax.__version__,
        "python": platform.python_version(),
        "written": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime()),
    }


def named_file(out: Path | None, beside: Path, endings: Collection[str], refusal: str) -> Path:
    """Return where a file is written: `beside` another, in the folder `out`, or by a name with one of the endings."""
    if out is None:
        return beside
    if out.is_dir() or not out.suffix:
        return out / beside.name
    if out.suffix.lower() not in endings:
        raise ConfigError(f"--out {out} is no {refusal}, or a folder")
    return out


def writable(out: Path | None, csv: Path | None) -> None:
    """Raise ConfigError before any work if folder or table cannot be written. Nothing is made yet."""
    try:
        if out is not None:
            check_writable(out)
    except OSError as error:
        raise ConfigError(
            f"cannot write into {out}: {error.strerror or error}; choose another folder with --out"
        ) from error
    if csv is not None:
        check_csv(csv)
