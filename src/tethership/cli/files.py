"""`tethership validate` and `new`: checking a file, a copy to edit."""

import os
from pathlib import Path
from typing import Annotated

import typer

from tethership.cli.common import JsonOption
from tethership.cli.completion import complete_scenario
from tethership.cli.result import Result, show
from tethership.errors import ConfigError
from tethership.results import write_atomically
from tethership.scenario import packaged_text

VALIDATE_EXAMPLE = "Example: tethership validate my_docking.toml"
NEW_EXAMPLE = "Example: tethership new my_docking"


def validate(
    file: Annotated[str, typer.Argument(help="A scenario, vehicle, solver or campaign file that ends in .toml.")],
    json: JsonOption = False,
) -> None:
    """Check a file: every key, unit and value, and whether the parts fit together."""
    kind = _checked(file)
    show(Result({"file": file, "valid": True, "kind": kind}, f"{file}: a valid {kind}"), json)


def _checked(file: str) -> str:
    """Return what a file is after checking all of it; a campaign's cases are drawn, none is flown."""
    from tethership.scenario import check_file, read_document

    if "vary" not in read_document("scenarios", file):
        return check_file(file)
    from tethership.campaign import make_plan

    make_plan(file)
    return "campaign"


def new(
    name: Annotated[str, typer.Argument(help="Name of the new scenario; NAME.toml and NAME_vehicle.toml are written.")],
    scenario: Annotated[
        str, typer.Option("--from", help="Packaged scenario to copy.", autocompletion=complete_scenario)
    ] = "docking",
    out: Annotated[Path, typer.Option(help="Folder for the files.")] = Path(),
    json: JsonOption = False,
) -> None:
    """Write a commented copy of a packaged scenario and its vehicle, to edit."""
    from tethership.scenario import check_title

    given = Path(name.removesuffix(".toml"))
    try:
        check_title(given.name)
    except ValueError as error:
        raise ConfigError(f"{error}; a folder goes before it or into --out") from error
    text = packaged_text("scenarios", scenario)
    vehicle = next(line for line in text.splitlines() if line.startswith("vehicle ="))
    source = vehicle.split('"')[1]
    texts = {
        out / f"{given}.toml": text.replace(vehicle, f'vehicle = "{given.name}_vehicle.toml"'),
        out / f"{given}_vehicle.toml": packaged_text("vehicles", source),
    }
    for path in texts:
        if os.path.lexists(path):
            raise ConfigError(f"{path} exists already; nothing is overwritten: choose another name or folder")
    for path, content in texts.items():
        write_atomically(path, content, new=True)
    show(Result({}, files=[str(path) for path in texts]), json)
