"""Reference pages from the program itself: `{{generated:NAME}}` in a page becomes Markdown before it is parsed."""

import importlib
import inspect
import pkgutil
import re
import typing
from collections.abc import Callable
from pathlib import Path
from typing import Any

import file_reference
import typer.main
from sphinx.application import Sphinx
from sphinx.errors import SphinxError

import tethership as ts
from tethership.campaign.schema import CampaignConfig
from tethership.cli import app as command_line
from tethership.results.schema import OWN_VARIABLES, VARIABLES
from tethership.scenario import ScenarioConfig, SolverConfig
from tethership.scenario.packaged import describe_packaged
from tethership.scenario.vehicle_schema import VehicleConfig

MARK = re.compile(r"\{\{generated:([\w-]+)\}\}")


def outputs() -> list[str]:
    """Return the table of every output of a flight."""
    lines = ["| name | unit | dimensions | axes | what it is |", "|---|---|---|---|---|"]
    for name, entry in (VARIABLES | OWN_VARIABLES).items():
        dims = ", ".join(("time", *entry.dims))
        lines.append(f"| `{name}` | {entry.unit} | {dims} | {entry.frame or '–'} | {entry.meaning} |")
    return lines


def vehicle_file() -> list[str]:
    """Return the reference of vehicle files."""
    return file_reference.sections(VehicleConfig, "The file")


def scenario_file() -> list[str]:
    """Return the reference of scenario files; the vehicle has its own page."""
    lines = file_reference.sections(ScenarioConfig, "The file")
    start = next(i for i, line in enumerate(lines) if line.startswith("### `[vehicle]`"))
    end = next(i for i, line in enumerate(lines) if i > start and line.startswith("### "))
    return lines[:start] + lines[end:]


def campaign_file() -> list[str]:
    """Return the reference of campaign files."""
    return file_reference.sections(CampaignConfig, "The file")


def solver_file() -> list[str]:
    """Return the reference of solver files."""
    return file_reference.sections(SolverConfig, "The file")


def packaged() -> list[str]:
    """Return what is packaged, by kind."""
    lines = []
    for kind, entries in describe_packaged().items():
        lines += [f"**{kind.capitalize()}**", "", "| name | what it is |", "|---|---|"]
        lines += [f"| `{name}` | {text} |" for name, text in entries.items()]
        lines.append("")
    return lines


def parameters() -> list[str]:
    """Return every number of the packaged scenario `docking` by its dotted name."""
    lines = ["| name | unit | value |", "|---|---|---|"]
    for name, entry in sorted(ts.list_parameters(ts.load_scenario("docking").config).items()):
        lines.append(f"| `{name}` | {entry.unit} | {entry.value:.6g} |")
    return lines


KINDS = {float: "number", int: "whole number", str: "text", Path: "path", bool: "–"}

UNSAID = {"out": "Folder for the result as a file; none is written if left out."}
"""Options that the command line itself leaves without a word."""


def commands() -> list[str]:
    """Return the reference of the command and its subcommands."""
    lines: list[str] = []
    group: Any = typer.main.get_command(command_line)
    functions = {entry.name: entry.callback for entry in command_line.registered_commands}
    for name, command in group.commands.items():
        lines += [f"## tethership {name}", "", inspect.cleandoc(command.help or ""), ""]
        if command.epilog:
            lines += ["```sh", command.epilog.removeprefix("Example: "), "```", ""]
        hints = typing.get_type_hints(functions[name])
        lines += ["| option | value | default | meaning |", "|---|---|---|---|"]
        lines += [option(entry, hints[entry.name]) for entry in command.params if entry.name != "help"]
        lines.append("")
    return lines


def option(entry: Any, hint: Any) -> str:
    """Return the row of one option or argument."""
    argument = entry.param_type_name == "argument"
    name = f"`{entry.name.upper()}`" if argument else ", ".join(f"`{flag}`" for flag in entry.opts)
    kinds = [kind for kind in (hint, *typing.get_args(hint)) if kind is not type(None)]
    listed = [kind for kind in kinds if typing.get_origin(kind) in (tuple, list)]
    value = entry.metavar or next((KINDS[kind] for kind in kinds if kind in KINDS), "value")
    if listed:
        inner = KINDS[typing.get_args(listed[0])[0]]
        value = f"three {inner}s" if typing.get_origin(listed[0]) is tuple else f"{entry.metavar or inner}, repeatable"
    given = "–" if entry.default in (None, False, [], ()) else f"`{entry.default}`"
    default = "**required**" if entry.required else given
    return (
        f"| {name} | {value} | {default} | {(entry.help or UNSAID.get(entry.name, '')).replace('|', chr(92) + '|')} |"
    )


def api() -> list[str]:
    """Return the public names: autodoc writes each."""
    lines = ["```{eval-rst}"]
    for name in sorted(ts.__all__, key=str.lower):
        thing = getattr(ts, name)
        if name == "__version__":
            continue
        kind = "class" if inspect.isclass(thing) else "function"
        if inspect.isclass(thing) and issubclass(thing, Exception):
            kind = "exception"
        lines.append(f".. auto{kind}:: tethership.{name}")
        if kind == "class":
            lines.append("   :members:")
            if "__call__" in vars(thing):
                lines.append("   :special-members: __call__")
        lines.append("")
    return [*lines, "```"]


def physics() -> list[str]:
    """Return every module of physics and its public things: autodoc writes them."""
    lines: list[str] = []
    package = "tethership.physics"
    for info in pkgutil.walk_packages(importlib.import_module(package).__path__, f"{package}."):
        if info.ispkg:
            continue
        title = info.name.removeprefix(f"{package}.").replace(".", "/")
        lines += [f"## {title}", "", "```{eval-rst}", f".. automodule:: {info.name}", "   :members:", "```", ""]
    return lines


PARTS: dict[str, Callable[[], list[str]]] = {
    "outputs": outputs,
    "vehicle-file": vehicle_file,
    "scenario-file": scenario_file,
    "campaign-file": campaign_file,
    "solver-file": solver_file,
    "packaged": packaged,
    "parameters": parameters,
    "commands": commands,
    "api": api,
    "physics": physics,
}


def fill(app: Sphinx, docname: str, source: list[str]) -> None:
    """Replace the marks of a page."""
    unknown = set(MARK.findall(source[0])) - set(PARTS)
    if unknown:
        raise SphinxError(f"{docname}: nothing makes {sorted(unknown)}; known: {', '.join(PARTS)}")
    if MARK.search(source[0]):
        app.env.note_dependency(str(Path(__file__)), docname=docname)
        source[0] = MARK.sub(lambda mark: "\n".join(PARTS[mark[1]]()), source[0])


def setup(app: Sphinx) -> dict[str, Any]:
    """Fill pages as they are read."""
    app.connect("source-read", fill)
    return {"parallel_read_safe": True}
