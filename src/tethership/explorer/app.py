"""The Dash app: what is typed becomes requests, how they stand becomes the page. Depends on: dash, explorer, view."""

from importlib import resources
from typing import Any

import dash
from dash import ALL, MATCH, Dash, Input, Output, Patch, State, ctx, no_update

from tethership._version import __version__
from tethership.errors import TethershipError
from tethership.explorer.fields import extra_field, known_parameters
from tethership.explorer.page import VIEWS, page
from tethership.explorer.panel import field, panel
from tethership.explorer.queue import Desk
from tethership.explorer.refresh import TEXTS, Showing
from tethership.explorer.requests import Understanding, first_over
from tethership.explorer.views import verdict
from tethership.view.report import page_text

FIELDS = {"name": ALL, "part": "field"}
"""All fields of the panel, in the same order."""

THEME = "theme.js"
"""Read in the head of the page, before it is painted."""

TEXT = {"name": MATCH, "part": "text", "kind": "main"}

SLIDER = {"name": MATCH, "part": "slider", "kind": "main"}


def make_app(known: Understanding, desk: Desk, scenario: str) -> Dash:
    """Return the app.

    Parameters
    ----------
    known : Understanding
        Turns what the page says into requests.
    desk : Desk
        Computes them.
    scenario : str
        Chosen at first.
    """
    app = Dash(
        __name__,
        assets_folder=str(resources.files("tethership") / "data" / "explorer"),
        serve_locally=True,
        title="tethership explore",
        update_title="",
        suppress_callback_exceptions=True,
        add_log_handler=False,
        assets_ignore=THEME,
        enable_mcp=False,
    )
    palette = page_text("report", "palette.css")
    first = f'<script src="/assets/{THEME}"></script>\n<style>\n{palette}</style>\n'
    app.index_string = app.index_string.replace("{%css%}", f"{first}{{%css%}}")
    folder = known.folder
    app.layout = lambda: page(known.base(scenario), scenario, folder.scenarios(), str(folder.root), __version__)
    _panel_callbacks(app, known)
    _browser_callbacks(app)
    _save_callback(app, known, desk)
    Showing(known, desk).register(app)
    return app


def _panel_callbacks(app: Dash, known: Understanding) -> None:
    """Fill the panel for a scenario, its other numbers, and the ends of a locus."""

    @app.callback(
        Output("panel", "children"),
        Output("extra", "children"),
        Output("more", "options"),
        Output("more", "value"),
        Output("over", "options"),
        Output("over", "value"),
        Input("scenario", "value"),
        Input("reset", "n_clicks"),
        State("over", "value"),
    )
    def fill(name: str, clicks: int | None, over: str) -> Any:
        try:
            base = known.base(name)
        except TethershipError as error:
            return [verdict("bad", str(error))], [], [], None, [], None
        numbers = sorted(known_parameters(base.config))
        return panel(base), [], numbers, None, numbers, first_over(numbers, over)

    @app.callback(
        Output("extra", "children", allow_duplicate=True),
        Input("more", "value"),
        State("scenario", "value"),
        State(TEXTS, "id"),
        prevent_initial_call=True,
    )
    def add(name: str | None, scenario: str, present: list[dict[str, str]]) -> Any:
        if not name or name in [entry["name"] for entry in present]:
            return no_update
        try:
            parameter = known_parameters(known.base(scenario).config).get(name)
        except TethershipError:
            return no_update
        if parameter is None:
            return no_update
        shown = Patch()
        shown.append(field(extra_field(parameter)))
        return shown

    @app.callback(
        Output("low", "value"),
        Output("high", "value"),
        Output("points", "value"),
        Output("over-unit", "children"),
        Input("over", "value"),
        State("scenario", "value"),
    )
    def span(name: str | None, scenario: str) -> Any:
        if name is None:
            return no_update
        try:
            low, high, points, unit = known.usual_span(name, scenario)
        except TethershipError:
            return no_update
        return low, high, points, "" if unit == "1" else unit


def _browser_callbacks(app: Dash) -> None:
    """Let the page itself do what needs no answer: slider and text, marks, tabs, room for figures, downloads."""
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "follow"),
        Output(TEXT, "value"),
        Output(SLIDER, "value"),
        Input(TEXT, "value"),
        Input(SLIDER, "value"),
        prevent_initial_call=True,
    )
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "mark"),
        Output(FIELDS, "className"),
        Input(TEXTS, "value"),
        State(FIELDS, "data-own"),
    )
    for view in VIEWS:
        app.clientside_callback(
            dash.ClientsideFunction("explorer", "fit"),
            Output({"figure": view}, "figure"),
            Input({"plain": view}, "data"),
            Input("theme", "data"),
            prevent_initial_call=True,
        )
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "theme"), Output("theme", "data"), Input("dark", "n_clicks")
    )
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "pulse"), Input("pulse", "data"), State("tick", "n_intervals")
    )
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "shape"),
        Output({"section": "flight"}, "className"),
        Input("shape", "value"),
    )
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "show"),
        *[Output({"section": view}, "style") for view in VIEWS],
        Input("tab", "value"),
    )
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "download"),
        Output({"view": MATCH, "part": "download"}, "title"),
        Input({"view": MATCH, "part": "download"}, "n_clicks"),
        State({"view": MATCH, "part": "file"}, "data"),
        State({"view": MATCH, "part": "file-name"}, "value"),
        prevent_initial_call=True,
    )


def _save_callback(app: Dash, known: Understanding, desk: Desk) -> None:
    """Write a file into the folder."""

    @app.callback(
        Output({"view": MATCH, "part": "saved"}, "children"),
        Input({"view": MATCH, "part": "save"}, "n_clicks"),
        State({"view": MATCH, "part": "file-name"}, "value"),
        State("shown", "data"),
        prevent_initial_call=True,
    )
    def save(clicks: int | None, name: str, shown: dict[str, str] | None) -> Any:
        if not clicks or not shown or not ctx.triggered_id:
            return no_update
        view = ctx.triggered_id["view"]
        request = desk.find(lambda one: one.view == view and one.key == shown.get(view))
        if request is None:
            return "This is no longer kept; change something or compute again."
        try:
            return f"saved: {known.folder.save(str(name), known.file_text(request))}"
        except TethershipError as error:
            return str(error)
