"""The Dash app: what is typed becomes requests, how they stand becomes the page. Depends on: dash, explorer."""

import hashlib
import time
from collections.abc import Sequence
from importlib import resources
from typing import Any

import dash
from dash import ALL, MATCH, Dash, Input, Output, State, ctx, html, no_update

from tethership._version import __version__
from tethership.errors import ConfigError, TethershipError
from tethership.explorer.desk import Desk, Request, Standing
from tethership.explorer.fields import extra_field, known_parameters
from tethership.explorer.page import VIEWS, page
from tethership.explorer.panel import field, panel
from tethership.explorer.repeating import recipe
from tethership.explorer.understanding import Understanding, form_of
from tethership.explorer.views import HEADS, RESTS, verdict

EMPTY_FIGURE = {"data": [], "layout": {"height": 40, "xaxis": {"visible": False}, "yaxis": {"visible": False}}}

TEXTS = {"name": ALL, "part": "text", "kind": ALL}
"""All texts of the panel."""

TEXT = {"name": MATCH, "part": "text", "kind": "main"}

SLIDER = {"name": MATCH, "part": "slider", "kind": "main"}

FIRST_OVER = ("wind.speed", "trim.elongation", "vehicle.body.mass")
"""What a locus runs over at first: the first of these that the scenario has."""


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
        enable_mcp=False,
    )
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
        chosen = next(n for n in (over, *FIRST_OVER, *numbers) if n in numbers)
        return panel(base), [], numbers, None, numbers, chosen

    @app.callback(
        Output("extra", "children", allow_duplicate=True),
        Input("more", "value"),
        State("scenario", "value"),
        State("extra", "children"),
        State(TEXTS, "id"),
        prevent_initial_call=True,
    )
    def add(name: str | None, scenario: str, shown: list[Any], present: list[dict[str, str]]) -> Any:
        if not name or name in [entry["name"] for entry in present]:
            return no_update
        parameter = known_parameters(known.base(scenario).config).get(name)
        return no_update if parameter is None else [*shown, field(extra_field(parameter))]

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
    """What happens in the page alone: slider and text follow each other, tabs change, a file is downloaded."""
    app.clientside_callback(
        dash.ClientsideFunction("explorer", "follow"),
        Output(TEXT, "value"),
        Output(SLIDER, "value"),
        Input(TEXT, "value"),
        Input(SLIDER, "value"),
        prevent_initial_call=True,
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
    def save(clicks: int | None, name: str, shown: dict[str, str]) -> Any:
        if not clicks:
            return no_update
        view = ctx.triggered_id["view"]
        request = desk.find(lambda one: one.view == view and _key(one) == shown.get(view))
        if request is None:
            return "This is no longer kept; change something or compute again."
        try:
            return f"saved: {known.folder.save(str(name), known.file_text(request))}"
        except TethershipError as error:
            return str(error)


def _key(request: Request) -> str:
    """Return a short name of a request."""
    return hashlib.sha256(repr(request).encode()).hexdigest()[:16]


class Showing:
    """The one callback that asks for what is to be seen and shows how it stands."""

    OUTPUTS = (
        Output("state", "children"),
        Output("state", "className"),
        Output("bar", "style"),
        Output("line", "className"),
        Output("cancel", "disabled"),
        Output("again", "disabled"),
        Output("tick", "disabled"),
        Output("trouble", "children"),
        Output("shown", "data"),
        *[
            Output({part: view}, prop)
            for view in VIEWS
            for part, prop in (
                ("head", "children"),
                ("figure", "figure"),
                ("figure", "style"),
                ("rest", "children"),
                ("recipe", "children"),
                ("view", "className"),
            )
        ],
    )

    def __init__(self, known: Understanding, desk: Desk) -> None:
        self.known = known
        self.desk = desk

    def register(self, app: Dash) -> None:
        """Add the callback to an app."""
        app.callback(
            *self.OUTPUTS,
            Input("tick", "n_intervals"),
            Input("cancel", "n_clicks"),
            Input("again", "n_clicks"),
            Input("tab", "value"),
            Input(TEXTS, "value"),
            Input("layers", "value"),
            Input("sas", "value"),
            Input("formulation", "value"),
            Input("over", "value"),
            Input("low", "value"),
            Input("high", "value"),
            Input("points", "value"),
            State(TEXTS, "id"),
            State("scenario", "value"),
            State("client", "data"),
            State("shown", "data"),
        )(self.show)

    def show(self, *said: Any) -> tuple[Any, ...]:
        """Return the page's outputs for what it says."""
        _, _, _, view, texts, layers, sas, formulation, over, low, high, points, names, scenario, client, shown = said
        shown = dict(shown or {})
        try:
            form = form_of(scenario, names, texts, layers, sas, formulation)
            request = self.known.request(view, form, (over or "", low or "", high or "", points or ""))
        except TethershipError as error:
            return self._trouble(view, str(error), shown)
        if ctx.triggered_id == "again":
            self.desk.forget(request)
        standing = self.desk.ask(str(client), request)
        if ctx.triggered_id == "cancel":
            self.desk.cancel(str(client))
            standing = self.desk.ask(str(client), request)
        return self._page(view, standing, shown)

    def _trouble(self, view: str, words: str, shown: dict[str, str]) -> tuple[Any, ...]:
        """Return the page for wrong input: what is shown stays, marked as old."""
        head = ("wrong input", "state bad", {"width": "0"}, "progress", True, True, True, f"Not computed: {words}", no_update)
        return (*head, *self._views(view, (*(no_update,) * 5, "view stale")))

    def _page(self, view: str, standing: Standing, shown: dict[str, str]) -> tuple[Any, ...]:
        """Return the page for a request."""
        key = _key(standing.request)
        words, style = _state(standing)
        moving = "progress moving" if standing.busy and standing.share is None else "progress"
        bar = {"width": f"{100 * (standing.share or 0.0):.1f}%"} if standing.busy else {"width": "0"}
        troubles = {"failed": f"No result: {standing.text}", "cancelled": "Cancelled. Compute again, or change a number."}
        again = standing.status not in ("failed", "cancelled")
        trouble = troubles.get(standing.status, "")
        if standing.status == "done" and shown.get(view) != key:
            shown[view] = key
            parts = (*_result(view, standing), recipe(view, standing.request, self.known), "view")
        else:
            shown = no_update  # pyright: ignore[reportAssignmentType]
            parts = (*(no_update,) * 5, "view" if standing.status == "done" else "view stale")
        head = (words, style, bar, moving, not standing.busy, again, not standing.busy, trouble, shown)
        return (*head, *self._views(view, parts))

    def _views(self, view: str, parts: Sequence[Any]) -> list[Any]:
        """Return the outputs of all views, of which only one is touched."""
        return [part for name in VIEWS for part in (parts if name == view else (no_update,) * len(parts))]


def _result(view: str, standing: Standing) -> tuple[Any, ...]:
    """Return head, figure, its style and the rest of a result."""
    result = standing.result
    figure = result.get("figure")
    style = {} if figure else {"display": "none"}
    return [_asked(standing.request), HEADS[view](result)], figure or EMPTY_FIGURE, style, RESTS[view](result)


def _asked(request: Request) -> html.P:
    """Return what a result is of."""
    words = request.choice.words
    return html.P([html.B(request.choice.scenario), " · ", "; ".join(words) or "unchanged"], className="asked")


def _state(standing: Standing) -> tuple[str, str]:
    """Return how a request stands in words, and their style."""
    if standing.busy:
        return f"{standing.text} · {time.monotonic() - standing.begun:.1f} s", "state busy"
    if standing.status == "done":
        return f"computed in {standing.seconds:.2f} s", "state good"
    return standing.status, "state bad"


__all__ = ["ConfigError", "make_app"]
