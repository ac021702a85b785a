"""The one callback that asks for what is to be seen and shows how it stands. Depends on: dash, explorer.

Whatever is shown carries the request that it answers; while another is asked for, it is greyed.
"""

import time
from collections.abc import Sequence
from typing import Any

from dash import ALL, Dash, Input, Output, State, ctx, no_update

from tethership.errors import TethershipError
from tethership.explorer.compare import Pins, drawn_over
from tethership.explorer.page import EMPTY, PIN, UNPIN, VIEWS
from tethership.explorer.queue import Desk
from tethership.explorer.recipe_box import recipe
from tethership.explorer.requests import Understanding, form_of
from tethership.explorer.standing import Request, Standing
from tethership.explorer.views import HEADS, RESTS, asked, compared, frame, pinned_line

PATIENCE = 0.5
"""How long the answer to a change waits for its result before it tells that it is being computed [s]."""

SOON = 2.0
"""How long after a change the page looks often whether its result is there [s]."""

OFTEN, LATER = 60, 250
"""Time between an answer and the next look at work that goes on [ms]."""

TEXTS = {"name": ALL, "part": "text", "kind": ALL}
"""All texts of the panel."""


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
        Output("pulse", "data"),
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
        *[Output({"view": view, "part": "pin"}, prop) for view in VIEWS for prop in ("children", "disabled")],
    )

    def __init__(self, known: Understanding, desk: Desk) -> None:
        self.known = known
        self.desk = desk
        self.pins = Pins()

    def register(self, app: Dash) -> None:
        """Add the callback to an app."""
        app.callback(
            *self.OUTPUTS,
            Input("tick", "n_intervals"),
            Input("cancel", "n_clicks"),
            Input("again", "n_clicks"),
            *[Input({"view": view, "part": "pin"}, "n_clicks") for view in VIEWS],
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
        view, texts, layers, sas, formulation, over, low, high, points, names, scenario, client, shown = said[
            len(VIEWS) + 3 :
        ]
        shown, client = dict(shown or {}), str(client)
        self._pin(client, shown)
        try:
            form = form_of(scenario, names, texts, layers, sas, formulation)
            request = self.known.request(view, form, (over or "", low or "", high or "", points or ""))
            page = self._page(client, view, self._standing(client, request), shown)
        except TethershipError as error:
            page = self._trouble(view, str(error))
        return (*page, *self._pin_buttons(client, shown))

    def _pin(self, client: str, shown: dict[str, str]) -> None:
        """Pin what a view shows, or let go of it, where that was clicked."""
        clicked = ctx.triggered_id
        if isinstance(clicked, dict) and clicked["part"] == "pin":
            view = clicked["view"]
            self.pins.toggle(client, view, self.desk.done(view, shown.get(view, "")))

    def _pin_buttons(self, client: str, shown: dict[str, str]) -> list[Any]:
        """Return the words of each view's button, and whether there is nothing to pin."""
        pinned = {view: self.pins.of(client, view) is not None for view in VIEWS}
        return [part for view in VIEWS for part in (UNPIN if pinned[view] else PIN, view not in shown)]

    def _standing(self, client: str, request: Request) -> Standing:
        """Ask for a request, anew or no more where that was clicked, and return how it stands."""
        if ctx.triggered_id == "again":
            self.desk.forget(request)
        if ctx.triggered_id == "cancel":
            self.desk.ask(client, request)
            self.desk.cancel(client)
        return self.desk.ask(client, request, 0.0 if ctx.triggered_id == "tick" else PATIENCE)

    def _trouble(self, view: str, words: str) -> tuple[Any, ...]:
        """Return the page for wrong input: what is shown stays, marked as old."""
        head = (
            "wrong input",
            "state bad",
            {"width": "0"},
            "progress",
            True,
            True,
            True,
            no_update,
            f"Not computed: {words}",
            "trouble",
            no_update,
        )
        return (*head, *self._views(view, (*(no_update,) * 5, "view stale")))

    def _page(self, client: str, view: str, standing: Standing, shown: dict[str, str]) -> tuple[Any, ...]:
        """Return the page for a request."""
        words, style = _state(standing)
        moving = "progress moving" if standing.busy and standing.share is None else "progress"
        bar = {"width": f"{100 * (standing.share or 0.0):.1f}%"} if standing.busy else {"width": "0"}
        troubles = {"failed": f"No result: {standing.text}", "cancelled": "Compute again, or change a number."}
        again = standing.status not in ("failed", "cancelled")
        trouble = troubles.get(standing.status, "")
        tone = "trouble soft" if standing.status == "cancelled" else "trouble"
        pinned = self.pins.of(client, view)
        keys = {view: standing.request.key, f"{view} pinned": pinned.request.key if pinned else ""}
        now, parts = no_update, (*(no_update,) * 5, _look(standing))
        if standing.status == "done" and not keys.items() <= shown.items():
            shown |= keys
            now, parts = shown, (*_result(view, standing, pinned), recipe(view, standing.request, self.known), "view")
        idle = not standing.busy
        head = (words, style, bar, moving, idle, again, idle, _pulse(standing), trouble, tone, now)
        return (*head, *self._views(view, parts))

    def _views(self, view: str, parts: Sequence[Any]) -> list[Any]:
        """Return the outputs of all views, of which only one is touched."""
        return [part for name in VIEWS for part in (parts if name == view else (no_update,) * len(parts))]


def _result(view: str, standing: Standing, pinned: Standing | None) -> tuple[Any, ...]:
    """Return head, figure, its style and the rest of a result, over a pinned one if there is one."""
    result = standing.result
    figure = result.get("figure")
    head, rest = [asked(standing.request), HEADS[view](result)], [RESTS[view](result)]
    if result.get("replay"):
        rest.insert(0, frame(standing.request))
    if pinned is not None:
        head.append(pinned_line(pinned.request))
        rest.insert(-1, compared(view, result, pinned.result))
        if figure and pinned.result.get("figure"):
            figure = drawn_over(figure, pinned.result["figure"])
    return head, figure or EMPTY, {} if figure else {"display": "none"}, rest


def _pulse(standing: Standing) -> Any:
    """Return when the page is to ask again [ms], after what asked now; never where nothing goes on."""
    now = time.monotonic()
    return [OFTEN if now < standing.asked + SOON else LATER, now] if standing.busy else no_update


def _look(standing: Standing) -> str:
    """Return the class of a view: whether it is of what is asked for, and else whether that is being computed."""
    return {"done": "view", "waiting": "view stale busy", "running": "view stale busy"}.get(
        standing.status, "view stale"
    )


def _state(standing: Standing) -> tuple[str, str]:
    """Return how a request stands in words, and their style."""
    if standing.busy:
        return f"{standing.text} · {time.monotonic() - standing.begun:.1f} s", "state busy"
    if standing.status == "done":
        return f"computed in {standing.seconds:.2f} s", "state good"
    return standing.status, "state bad" if standing.status == "failed" else "state ended"
