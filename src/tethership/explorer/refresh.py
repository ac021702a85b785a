"""The one callback that asks for what is to be seen and shows how it stands. Depends on: dash, explorer.

Whatever is shown carries the request that it answers; while another is asked for, it is greyed.
"""

import hashlib
import time
from collections.abc import Sequence
from typing import Any

from dash import ALL, Dash, Input, Output, State, ctx, html, no_update

from tethership.errors import TethershipError
from tethership.explorer.page import EMPTY, VIEWS
from tethership.explorer.queue import Desk, Request, Standing
from tethership.explorer.recipe_box import recipe
from tethership.explorer.requests import Understanding, form_of
from tethership.explorer.views import HEADS, RESTS

TEXTS = {"name": ALL, "part": "text", "kind": ALL}
"""All texts of the panel."""


def request_key(request: Request) -> str:
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
        Output("trouble", "className"),
        Output("shown", "data"),
        *[
            Output({part: view}, prop)
            for view in VIEWS
            for part, prop in (
                ("head", "children"),
                ("plain", "data"),
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
            return self._page(view, self._standing(str(client), request), shown)
        except TethershipError as error:
            return self._trouble(view, str(error), shown)

    def _standing(self, client: str, request: Request) -> Standing:
        """Ask for a request, anew or no more where that was clicked, and return how it stands."""
        if ctx.triggered_id == "again":
            self.desk.forget(request)
        standing = self.desk.ask(client, request)
        if ctx.triggered_id == "cancel":
            self.desk.cancel(client)
            standing = self.desk.ask(client, request)
        return standing

    def _trouble(self, view: str, words: str, shown: dict[str, str]) -> tuple[Any, ...]:
        """Return the page for wrong input: what is shown stays, marked as old."""
        head = (
            "wrong input",
            "state bad",
            {"width": "0"},
            "progress",
            True,
            True,
            True,
            f"Not computed: {words}",
            "trouble",
            no_update,
        )
        return (*head, *self._views(view, (*(no_update,) * 5, "view stale")))

    def _page(self, view: str, standing: Standing, shown: dict[str, str]) -> tuple[Any, ...]:
        """Return the page for a request."""
        key = request_key(standing.request)
        words, style = _state(standing)
        moving = "progress moving" if standing.busy and standing.share is None else "progress"
        bar = {"width": f"{100 * (standing.share or 0.0):.1f}%"} if standing.busy else {"width": "0"}
        troubles = {"failed": f"No result: {standing.text}", "cancelled": "Compute again, or change a number."}
        again = standing.status not in ("failed", "cancelled")
        trouble = troubles.get(standing.status, "")
        tone = "trouble soft" if standing.status == "cancelled" else "trouble"
        if standing.status == "done" and shown.get(view) != key:
            shown[view] = key
            parts = (*_result(view, standing), recipe(view, standing.request, self.known), "view")
        else:
            shown = no_update  # pyright: ignore[reportAssignmentType]
            parts = (*(no_update,) * 5, "view" if standing.status == "done" else "view stale")
        head = (words, style, bar, moving, not standing.busy, again, not standing.busy, trouble, tone, shown)
        return (*head, *self._views(view, parts))

    def _views(self, view: str, parts: Sequence[Any]) -> list[Any]:
        """Return the outputs of all views, of which only one is touched."""
        return [part for name in VIEWS for part in (parts if name == view else (no_update,) * len(parts))]


def _result(view: str, standing: Standing) -> tuple[Any, ...]:
    """Return head, figure, its style and the rest of a result."""
    result = standing.result
    figure = result.get("figure")
    style = {} if figure else {"display": "none"}
    return [_asked(standing.request), HEADS[view](result)], figure or EMPTY, style, RESTS[view](result)


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
    return standing.status, "state bad" if standing.status == "failed" else "state ended"
