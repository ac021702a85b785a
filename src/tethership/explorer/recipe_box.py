"""How to repeat what a view shows: the command, the file, buttons to copy, download and save. Depends on: dash."""

from typing import Any

from dash import dcc, html

from tethership.errors import ConfigError
from tethership.explorer.panel import LONGEST, dom_id
from tethership.explorer.requests import Understanding
from tethership.explorer.standing import Request


def recipe(view: str, request: Request, known: Understanding) -> html.Details:
    """Return the disclosure under a view.

    Parameters
    ----------
    view : str
        Its name.
    request : Request
        What it shows.
    known : Understanding
        Writes commands and files.
    """
    stem = request.choice.scenario.removesuffix(".toml")
    name = f"{stem}_explored.toml" if request.choice.values else f"{stem}_copy.toml"
    try:
        text = known.file_text(request)
    except ConfigError as error:
        return _command_alone(view, request, known, str(error))
    own = request.choice.scenario.endswith(".toml")
    place = {"view": view, "part": "file-name"}
    beside = " Keep it in the same folder: it may name files beside it." if own else ""
    return html.Details(
        [
            html.Summary("Show the command and the TOML that give this"),
            html.H3("Command"),
            _copied(f"command-{view}", "\n".join(known.commands(request)), "copied short"),
            html.H3("Or the scenario as a file"),
            html.P(["The changes stand in its table ", html.Code("[changes]"), f".{beside} Saved as {name}:"]),
            _copied(f"again-{view}", "\n".join(known.commands_on_file(request, name)), "copied short"),
            _copied(f"toml-{view}", text, "copied long"),
            html.Div(
                [
                    html.Button("Download", id={"view": view, "part": "download"}),
                    html.Label("file name", htmlFor=dom_id(place), className="unit"),
                    dcc.Input(id=place, value=name, type="text", className="file-name", maxLength=LONGEST),
                    html.Button("Save in the folder", id={"view": view, "part": "save"}),
                    html.Span("", id={"view": view, "part": "saved"}, className="saved", role="status"),
                ],
                className="save",
            ),
            dcc.Store(id={"view": view, "part": "file"}, data=text),
        ],
        className="recipe",
        id={"disclosure": view},
    )


def _command_alone(view: str, request: Request, known: Understanding, reason: str) -> html.Details:
    """Return the disclosure where no file can be written, and why."""
    command = _copied(f"command-{view}", "\n".join(known.commands(request)), "copied short")
    summary = html.Summary("Show the command that gives this")
    return html.Details([summary, command, html.P(f"No file: {reason}")], className="recipe", id={"disclosure": view})


def _copied(name: str, text: str, style: str) -> Any:
    """Return text that can be copied with a button."""
    return html.Div(
        [html.Pre(text, id=name), dcc.Clipboard(target_id=name, title="copy", className="copy")], className=style
    )
