"""The command `tethership`. Exits 0 on success, 2 on wrong input, 3 when a computation has no answer."""

import sys
import warnings
from typing import Annotated, Any

import typer

from tethership._version import __version__
from tethership.cli import (
    campaign,
    dock,
    explore,
    files,
    identify,
    listing,
    modes,
    reproduce,
    sweep,
    tension,
    trim,
    tune,
    view,
)
from tethership.cli.common import NO_ANSWER, WRONG_INPUT
from tethership.errors import ConfigError, SolveError, TethershipWarning

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


@app.callback(invoke_without_command=True)
def _root(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    if version:
        typer.echo(__version__)
        raise typer.Exit
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


app.command("dock", epilog=dock.EXAMPLE)(dock.dock)
app.command("trim", epilog=trim.EXAMPLE)(trim.trim)
app.command("modes", epilog=modes.EXAMPLE)(modes.modes)
app.command("sweep", epilog=sweep.EXAMPLE)(sweep.sweep)
app.command("tension", epilog=tension.EXAMPLE)(tension.tension)
app.command("identify", epilog=identify.EXAMPLE)(identify.identify)
app.command("tune", epilog=tune.EXAMPLE)(tune.tune)
app.command("reproduce", epilog=reproduce.EXAMPLE)(reproduce.reproduce)
app.command("campaign", epilog=campaign.EXAMPLE)(campaign.campaign)
app.command("view", epilog=view.EXAMPLE)(view.view)
app.command("explore", epilog=explore.EXAMPLE)(explore.explore)
app.command("list", epilog=listing.EXAMPLE)(listing.list_)
app.command("validate", epilog=files.VALIDATE_EXAMPLE)(files.validate)
app.command("new", epilog=files.NEW_EXAMPLE)(files.new)


def _fail(message: str, code: int) -> None:
    """Print one line on standard error and exit."""
    typer.echo(f"tethership: {' '.join(message.split())}", err=True)
    sys.exit(code)


def _show_warning(message: Warning | str, *where: Any) -> None:
    """Print what the package warns of as one line on standard error."""
    if isinstance(message, TethershipWarning):
        typer.echo(f"tethership: warning: {' '.join(str(message).split())}", err=True)
    else:
        _PLAIN(message, *where)


_PLAIN = warnings.showwarning


def main() -> None:
    """Run the command with the promised exit codes and one clear line for wrong input."""
    warnings.showwarning = _show_warning
    try:
        code = app(prog_name="tethership", standalone_mode=False)
    except ConfigError as error:
        _fail(str(error), WRONG_INPUT)
    except SolveError as error:
        _fail(str(error), NO_ANSWER)
    except (KeyboardInterrupt, typer.Abort):
        _fail("interrupted before anything was flown", NO_ANSWER)
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
