"""The command `tethership`. Exits 0 on success, 2 on wrong input, 3 when a computation has no answer."""

import contextlib
import os
import sys
import warnings
from typing import Annotated, Any, NoReturn

import typer

from tethership._interrupt import loaded
from tethership._studies import commands
from tethership._version import __version__
from tethership.cli import (
    campaign,
    dock,
    explore,
    export,
    files,
    fly,
    listing,
    modes,
    sweep,
    tension,
    trim,
    tune,
    view,
)
from tethership.cli.checked import checked
from tethership.cli.common import NO_ANSWER, WRONG_INPUT
from tethership.errors import ConfigError, SolveError, TethershipWarning, one_line

INTERRUPTED = 130
"""What typer returns after Ctrl-C."""

app = typer.Typer(
    name="tethership",
    help="Flight dynamics, control and certification of tethered airships.",
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _tell_version(asked: bool) -> None:
    """Print the version and end, before typer checks anything else, for which it may import pydantic."""
    if asked:
        typer.echo(__version__)
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _root(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", is_eager=True, callback=_tell_version)
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


app.command("dock", epilog=dock.EXAMPLE)(checked(dock.dock))
app.command("fly", epilog=fly.EXAMPLE)(checked(fly.fly))
app.command("trim", epilog=trim.EXAMPLE)(checked(trim.trim))
app.command("modes", epilog=modes.EXAMPLE)(checked(modes.modes))
app.command("sweep", epilog=sweep.EXAMPLE)(checked(sweep.sweep))
app.command("tension", epilog=tension.EXAMPLE)(checked(tension.tension))
app.command("tune", epilog=tune.EXAMPLE)(checked(tune.tune))
for entry in commands():
    command = entry.load()
    app.command(entry.name, epilog=command.__globals__["EXAMPLE"])(checked(command))
app.command("campaign", epilog=campaign.EXAMPLE)(checked(campaign.campaign))
app.command("view", epilog=view.EXAMPLE)(checked(view.view))
app.command("export", epilog=export.EXAMPLE)(checked(export.export))
app.command("explore", epilog=explore.EXAMPLE)(checked(explore.explore))
app.command("list", epilog=listing.EXAMPLE)(checked(listing.list_))
app.command("validate", epilog=files.VALIDATE_EXAMPLE)(checked(files.validate))
app.command("new", epilog=files.NEW_EXAMPLE)(checked(files.new))


def _fail(message: str, code: int) -> NoReturn:
    """Print one line on standard error and exit."""
    typer.echo(f"tethership: {one_line(message)}", err=True)
    sys.exit(code)


def _nothing_more_to_say() -> None:
    """Point standard output elsewhere: Python would try again to write what could not be, and print a traceback."""
    with contextlib.suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _warn(message: Warning | str, category: type[Warning], *where: Any) -> None:
    """Print a warning of this package as one line on standard error; others as Python does."""
    if issubclass(category, TethershipWarning):
        typer.echo(f"tethership: warning: {' '.join(str(message).split())}", err=True)
    else:
        _python_warns(message, category, *where)


_python_warns = warnings.showwarning


def main() -> None:
    """Run the command with the promised exit codes and one clear line for wrong input."""
    loaded()
    if sys.stdout is None:
        _fail("standard output is closed, so nothing can be told; leave it open or send it to /dev/null", WRONG_INPUT)
    warnings.showwarning = _warn
    try:
        code = app(prog_name="tethership", standalone_mode=False)
        sys.stdout.flush()
    except ConfigError as error:
        _fail(str(error), WRONG_INPUT)
    except SolveError as error:
        _fail(str(error), NO_ANSWER)
    except (KeyboardInterrupt, typer.Abort):
        _fail("interrupted before anything was flown", NO_ANSWER)
    except OSError as error:
        _nothing_more_to_say()
        place = "standard output" if error.filename is None else str(error.filename)
        _fail(f"cannot write or read {place}: {error.strerror or error}", WRONG_INPUT)
    except Exception as error:
        # typer carries a copy of click of its own: its usage errors are known by what they can do.
        spoken = getattr(error, "format_message", None)
        if spoken is None:
            raise
        context = getattr(error, "ctx", None)
        command = "tethership" if context is None else context.command_path
        _fail(f"{spoken()} ({command} --help shows what is allowed)", WRONG_INPUT)
    else:
        if code == INTERRUPTED:
            _fail("interrupted; what was not written yet is lost", NO_ANSWER)
        sys.exit(code if isinstance(code, int) else 0)
