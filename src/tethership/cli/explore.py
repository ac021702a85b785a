"""`tethership explore`: a local page on which numbers are changed and trim, root locus and flight follow."""

import os
import sys
import tempfile
import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from tethership.cli.common import JsonOption, ScenarioArgument
from tethership.cli.result import Result, show
from tethership.errors import ConfigError

EXAMPLE = "Example: tethership explore docking --port 8050"

LOOPBACK = ("127.0.0.1", "localhost")

DOOR = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>tethership explore</title>
<meta http-equiv="refresh" content="0; url={address}"><p><a href="{address}">Open the explorer</a></p></html>
"""
"""Leads a browser to the page."""


def explore(
    scenario: ScenarioArgument = "docking",
    port: Annotated[int, typer.Option(help="Where the page is served; 0 for a free port.")] = 8050,
    host: Annotated[str, typer.Option(help="Only this machine: 127.0.0.1 or localhost.")] = "127.0.0.1",
    folder: Annotated[
        Path | None,
        typer.Option(help="Scenario files are read and saved there, nowhere else. Default: the scenario's, or here."),
    ] = None,
    no_open: Annotated[bool, typer.Option("--no-open", help="Do not open a browser.")] = False,
    json: JsonOption = False,
) -> None:
    """Serve a local page: change numbers, see trim, root locus and flight; Ctrl-C ends it.

    The address holds a token; who does not have it is refused. With --json one object with the address, and for a
    script the server and its cookie, is printed once the page is served.
    """
    if host not in LOOPBACK:
        raise ConfigError(f"--host {host}: the page is served to this machine alone; leave --host out")
    name, place = _placed(scenario, folder)
    from tethership.explorer import server

    explorer = server.Explorer(name, place, port)

    def ready() -> None:
        said = {"address": explorer.address, "server": explorer.base, "cookie": explorer.ticket.cookie}
        said |= {"folder": str(explorer.folder), "pid": os.getpid()}
        words = f"tethership explore: {explorer.address} (files in {explorer.folder}; Ctrl-C ends it)"
        show(Result(said, words), json)
        sys.stdout.flush()
        if not no_open and not _opened(explorer.address, Path(private)):
            typer.echo(f"tethership: no browser was found; open {explorer.address} yourself", err=True)

    with tempfile.TemporaryDirectory(prefix="tethership-") as private:
        server.serve_until_signal(explorer, ready)


def _placed(scenario: str, folder: Path | None) -> tuple[str, Path]:
    """Return the scenario's name and its folder: a file must lie in the folder."""
    if not scenario.endswith(".toml"):
        return scenario, Path() if folder is None else folder
    path = Path(scenario)
    if folder is None:
        return path.name, path.parent
    if path.resolve().parent != folder.resolve():
        raise ConfigError(f"{scenario} is not in --folder {folder}; leave --folder out or move the file there")
    return path.name, folder


def _opened(address: str, private: Path) -> bool:
    """Return whether a browser with a window was found and told to open the page.

    The token is not given to it on its command line, which every user of the machine can read, but in a file of a
    private folder that leads to the page.
    """
    windowless = sys.platform.startswith("linux") and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
    if windowless:
        return False
    door = private / "open_explorer.html"
    door.write_text(DOOR.format(address=address), encoding="utf-8")
    try:
        return webbrowser.open(door.as_uri())
    except (webbrowser.Error, OSError):
        return False
