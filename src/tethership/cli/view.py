"""`tethership view`: one flight, or two side by side, as a page to be played in a browser."""

import os
import re
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tethership.cli.common import NO_ANSWER, JsonOption, named_file
from tethership.cli.progress import stage
from tethership.cli.result import Result, show
from tethership.errors import ConfigError

if TYPE_CHECKING:
    from tethership.simulation import Flight

EXAMPLE = "Example: tethership view rewind/flight.nc navigation/flight.nc --out compared.html"

PAGES = (".html", ".htm")
"""Endings of a page's name."""


def view(
    files: Annotated[list[Path], typer.Argument(metavar="FILE [FILE2]", help="One or two flights (flight.nc).")],
    out: Annotated[
        Path | None,
        typer.Option(metavar="PATH", help="Page, or folder for it. Default: FILE_replay.html beside the file."),
    ] = None,
    no_open: Annotated[bool, typer.Option("--no-open", help="Write the page and do not open it.")] = False,
    json: JsonOption = False,
) -> None:
    """Show a flight in space, with its histories, in a browser: to play, seek and look at from any side.

    Two flights are shown side by side at the same time. The page is one file that needs no network.
    """
    from tethership.view import write_replay

    named = _flights(files)
    stems = [file.stem for file in files] if len(files) == 1 else [Path(name).name for name in named]
    beside = files[0].parent / (re.sub(r"[^\w.-]+", "_", "_".join(stems)) + "_replay.html")
    page = named_file(out, beside, PAGES, "page: give a name that ends in .html")
    with stage("write"):
        write_replay(named, page)
    show(Result({"file": str(page), "flights": [str(file) for file in files]}, f"wrote {page}"), json)
    if not no_open:
        _open(page)


def _flights(files: list[Path]) -> dict[str, "Flight"]:
    """Return the flights of the files by the names under which they are shown."""
    from tethership.simulation import Flight

    if len(files) > 2:
        raise ConfigError(f"view shows one flight or two side by side; {len(files)} files were given")
    for file in files:
        if file.is_dir():
            inside = sorted(file.glob("*.nc")) or sorted(file.glob("*/*.nc"))
            hint = f"name one of its flights, e.g. {inside[0]}" if inside else "name a flight.nc that `dock` wrote"
            raise ConfigError(f"{file} is a folder, not a flight; {hint}")
    found = [Flight.load(file) for file in files]
    for file, flight in zip(files, found, strict=True):
        if flight.data.sizes.get("time", 0) == 0:
            typer.echo(f"tethership: {file} has no sample to show: it diverged at its start", err=True)
            raise typer.Exit(NO_ANSWER)
    return dict(zip(_names(files), found, strict=True))


def _names(files: list[Path]) -> list[str]:
    """Return short names: stems, or folders where the stems are the same, or paths."""
    for names in ([f.stem for f in files], [f.resolve().parent.name for f in files], [str(f) for f in files]):
        if len(set(names)) == len(files):
            return names
    return [f"{file.stem} {i}" for i, file in enumerate(files, start=1)]


def _open(page: Path) -> None:
    """Open a page in the user's browser; where there is none, say where the page is."""
    try:
        browser = webbrowser.get()
        in_terminal = type(browser) is webbrowser.GenericBrowser and "BROWSER" not in os.environ  # lynx and its like
        opened = not in_terminal and browser.open(page.resolve().as_uri())
    except (webbrowser.Error, OSError):
        opened = False
    if not opened:
        typer.echo(f"tethership: no browser could be opened; the page is {page.resolve()}", err=True)
