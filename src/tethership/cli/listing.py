"""`tethership list`: what is packaged, what a flight holds, what a scenario's numbers are called."""

from typing import Annotated, Any

import typer

from tethership.cli.common import JsonOption, ScenarioOption, writable
from tethership.cli.completion import complete_kind, complete_scenario
from tethership.cli.result import Result, show
from tethership.cli.tables import Cell, CsvOption, Table
from tethership.errors import ConfigError, shown, suggestion
from tethership.results import OWN_VARIABLES, VARIABLES
from tethership.scenario import KINDS, describe_packaged

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
    writable(None, csv)
    if kind == "outputs":
        result = _named(kind, _outputs())
    elif kind == "parameters":
        result = _named(kind, _parameters(named[0] if named else "docking"))
    else:
        result = _packaged(kind)
    show(result, json, csv)


def _outputs() -> dict[str, dict[str, Any]]:
    """Return every output of a flight with unit, dimensions, frame and meaning."""
    return {
        name: {"unit": of.unit, "dims": ["time", *of.dims], "frame": of.frame, "meaning": of.meaning}
        for name, of in (VARIABLES | OWN_VARIABLES).items()
    }


def _parameters(scenario: str) -> dict[str, dict[str, Any]]:
    """Return every number of a scenario with its value and unit."""
    from tethership.scenario import list_parameters, load_scenario

    found = list_parameters(load_scenario(scenario).config)
    return {name: {"value": of.value, "unit": of.unit} for name, of in found.items()}


def _named(kind: str, found: dict[str, dict[str, Any]]) -> Result:
    """Return a list of names with what belongs to them."""
    rows = [[name, *map(_word, of.values())] for name, of in found.items()]
    return Result({kind: found}, tables=[Table(rows, columns=("name", *next(iter(found.values()))))])


def _word(value: Any) -> Any:
    """Return a value as a table holds it."""
    return " × ".join(value) if isinstance(value, list) else value


def _packaged(kind: str | None) -> Result:
    """Return what is packaged, all of it or one kind."""
    found = {name: of for name, of in describe_packaged().items() if kind in (None, name)}
    columns = ("kind", "name", "meaning")  # the kind stands above its table
    rows = {each: [[Cell(each, ""), *entry] for entry in entries.items()] for each, entries in found.items()}
    return Result(found, tables=[Table(of, each, columns) for each, of in rows.items()])
