"""`tethership list`: what is packaged, what a flight holds, what a scenario's numbers are called."""

from collections.abc import Iterable
from typing import Annotated, Any

import typer

from tethership.cli.common import JsonOption, ScenarioOption, print_json
from tethership.cli.completion import complete_kind, complete_scenario
from tethership.cli.tables import CsvOption, writable_csv, write_csv
from tethership.errors import ConfigError, shown, suggestion
from tethership.results.schema import VARIABLES
from tethership.scenario import list_parameters, load_scenario
from tethership.scenario.load import KINDS, describe_packaged

EXAMPLE = "Example: tethership list parameters mine.toml --csv parameters.csv"

LISTS = (*KINDS, "outputs", "parameters")
"""What may be listed."""


def list_(
    kind: Annotated[
        str | None,
        typer.Argument(
            help=f"One of {', '.join(LISTS)}. Default: all that is packaged.",
            autocompletion=complete_kind,
        ),
    ] = None,
    of: Annotated[
        str | None,
        typer.Argument(
            metavar="[SCENARIO]",
            help="Whose parameters: a packaged scenario or a path that ends in .toml. Default: docking.",
            autocompletion=complete_scenario,
        ),
    ] = None,
    scenario: ScenarioOption = None,
    csv: CsvOption = None,
    json: JsonOption = False,
) -> None:
    """List packaged scenarios, vehicles, solvers and campaigns, the outputs of a flight, or a scenario's parameters.

    Parameters are what --set, --over and a campaign's [vary] take, in SI units and radians.
    """
    if kind is not None and kind not in LISTS:
        raise ConfigError(f"there is no list {shown(kind)}{suggestion(kind, LISTS)} Allowed: {', '.join(LISTS)}")
    named = [name for name in (of, scenario) if name is not None]
    if named and kind != "parameters":
        raise ConfigError(f"only parameters are a scenario's; write tethership list parameters {named[0]}")
    if len(set(named)) > 1:
        raise ConfigError(f"two scenarios are named, {of} and --scenario {scenario}; name one")
    writable_csv(csv)
    if kind == "outputs":
        _show(kind, _outputs(), csv, json)
    elif kind == "parameters":
        _show(kind, _parameters(named[0] if named else "docking"), csv, json)
    else:
        _packaged(kind, csv, json)


def _outputs() -> dict[str, dict[str, Any]]:
    """Return every output of a flight with unit, dimensions, frame and meaning."""
    return {
        name: {"unit": of.unit, "dims": ["time", *of.dims], "frame": of.frame, "meaning": of.meaning}
        for name, of in VARIABLES.items()
    }


def _parameters(scenario: str) -> dict[str, dict[str, Any]]:
    """Return every number of a scenario with its value and unit."""
    found = list_parameters(load_scenario(scenario).config)
    return {name: {"value": of.value, "unit": of.unit} for name, of in found.items()}


def _show(kind: str, found: dict[str, dict[str, Any]], csv: Any, json: bool) -> None:
    """Print a list of names with what belongs to them."""
    keys = list(next(iter(found.values())))
    write_csv(csv, ("name", *keys), ([name, *map(_word, of.values())] for name, of in found.items()))
    if json:
        print_json({kind: found})
        return
    width = max(map(len, found))
    for name, of in found.items():
        typer.echo(f"{name:<{width}}  {'  '.join(filter(None, map(_word, of.values())))}")


def _word(value: Any) -> str:
    """Return a value as a table shows it."""
    if isinstance(value, float):
        return repr(value)
    return " × ".join(value) if isinstance(value, list) else str(value)


def _packaged(kind: str | None, csv: Any, json: bool) -> None:
    """Print what is packaged, all of it or one kind."""
    found = {name: of for name, of in describe_packaged().items() if kind in (None, name)}
    write_csv(csv, ("kind", "name", "meaning"), _rows(found))
    if json:
        print_json(found)
        return
    width = max(len(name) for of in found.values() for name in of)
    for each, entries in found.items():
        typer.echo(each)
        for name, meaning in entries.items():
            typer.echo(f"  {name:<{width}}  {meaning}")


def _rows(found: dict[str, dict[str, str]]) -> Iterable[list[str]]:
    """Yield kind, name and meaning."""
    for kind, entries in found.items():
        for name, meaning in entries.items():
            yield [kind, name, meaning]
