"""`tethership export`: a flight as a table for other tools."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from tethership.cli.common import JsonOption, named_file
from tethership.cli.result import Result, show
from tethership.errors import ConfigError

EXAMPLE = "Example: tethership export windy/flight.nc --to mat"


class Format(StrEnum):
    """What a flight can be written as."""

    csv = "csv"
    parquet = "parquet"
    mat = "mat"


def export(
    flight: Annotated[Path, typer.Argument(metavar="FLIGHT", help="A flight (flight.nc).")],
    to: Annotated[Format, typer.Option("--to", help="Format of the table.")] = Format.csv,
    out: Annotated[
        Path | None,
        typer.Option(metavar="PATH", help="File, or folder for it. Default: beside the flight, by its name."),
    ] = None,
    json: JsonOption = False,
) -> None:
    """Write the histories of a flight as one table for other tools: a row an instant, units in the names.

    In MATLAB the columns are variables and their units are in the struct `units`. Parquet needs pyarrow.
    """
    from tethership.results import write_table
    from tethership.simulation import Flight

    if flight.is_dir():
        raise ConfigError(f"{flight} is a folder, not a flight; name a flight.nc that `dock` wrote")
    refusal = f"name for --to {to}: give one that ends in .{to}"
    path = named_file(out, flight.with_name(f"{flight.stem}.{to}"), (f".{to}",), refusal)
    write_table(Flight.load(flight).to_frame(), path, to)
    show(Result({}, files=[str(path)]), json)
