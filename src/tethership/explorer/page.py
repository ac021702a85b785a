"""The page: header with the state, panel of numbers, three views. Depends on: dash, explorer.panel."""

import uuid
from collections.abc import Sequence
from typing import Any

from dash import dcc, html

from tethership.explorer.panel import LONGEST, grouped, panel
from tethership.scenario import Scenario

VIEWS = {"trim": "Trim", "locus": "Root locus", "flight": "Flight"}

POLL = 3000
"""Time after which the page looks again at work that goes on although no answer came [ms]."""

GRAPH: Any = {"displaylogo": False, "responsive": True, "displayModeBar": "hover", "showTips": False}
"""How plotly shows a figure."""

FIRST = "The first result of each view takes seconds, the first time on a machine longer; then it is tenths of one."
"""What stands where no result is yet."""

PIN, UNPIN = "Pin this result", "Unpin"
"""Words of the button that keeps a result to compare later ones with."""

PIN_WORDS = "Later results are drawn over this one, and a table tells what has changed"

SHAPES = {"histories": "histories", "space": "in space (3-D)"}
"""How a flight is shown."""

EMPTY = {"data": [], "layout": {"xaxis": {"visible": False}, "yaxis": {"visible": False}, "height": 120}}
"""A figure before there is one."""


def page(scenario: Scenario, name: str, names: Sequence[str], folder: str, version: str) -> html.Div:
    """Return the page as it is first served.

    Parameters
    ----------
    scenario : Scenario
        Chosen at first.
    name : str
        Its name.
    names : sequence of str
        Scenarios that can be chosen.
    folder : str
        Where files are read and saved.
    version : str
        Of the package.
    """
    return html.Div(
        [
            dcc.Store(id="client", data=uuid.uuid4().hex),
            dcc.Store(id="shown", data={}),
            dcc.Store(id="theme"),
            dcc.Store(id="pulse"),
            dcc.Interval(id="tick", interval=POLL, disabled=False),
            _header(name, names),
            html.Div(
                [
                    html.Aside(
                        [
                            html.A("Results ↑", href="#results", className="jump"),
                            html.Div(panel(scenario), id="panel"),
                            html.Details(
                                [
                                    html.Summary("Any other number"),
                                    html.Label("its name", htmlFor="more", className="name"),
                                    dcc.Dropdown(
                                        id="more",
                                        options=[],
                                        placeholder="dotted name, e.g. vehicle.fins.*.area",
                                        searchable=True,
                                        clearable=True,
                                        value=None,
                                    ),
                                    html.Div([], id="extra"),
                                ],
                                className="group",
                            ),
                        ],
                        className="panel",
                        id="numbers",
                    ),
                    html.Main(
                        [
                            grouped(
                                "what is shown",
                                dcc.RadioItems(
                                    id="tab",
                                    value="trim",
                                    options=[{"label": words, "value": view} for view, words in VIEWS.items()],
                                    className="tabs",
                                ),
                            ),
                            html.Div("", id="trouble", className="trouble", role="alert"),
                            *(_view(view) for view in VIEWS),
                        ],
                        id="results",
                    ),
                ],
                className="body",
            ),
            html.Footer(f"tethership {version} · files are read from and saved in {folder}"),
        ]
    )


def _header(name: str, names: Sequence[str]) -> html.Header:
    return html.Header(
        [
            html.H1("tethership"),
            html.Label("Scenario", htmlFor="scenario", className="scenario-label"),
            dcc.Dropdown(
                id="scenario", options=list(names), value=name, clearable=False, searchable=False, className="scenario"
            ),
            html.Button("Reset", id="reset", title="Back to the scenario's own numbers"),
            html.Div(
                [
                    html.Span("", id="state", role="status"),
                    html.Div(html.Div(id="bar"), className="progress", id="line"),
                ],
                className="state",
            ),
            html.A("Numbers ↓", href="#numbers", className="jump"),
            html.Button("Cancel", id="cancel", disabled=True),
            html.Button("Compute again", id="again", disabled=True),
            html.Button("◐", id="dark", title="dark or light", **{"aria-label": "dark or light"}),  # pyright: ignore[reportArgumentType]
        ]
    )


def _view(view: str) -> html.Section:
    """Return the place of a view: options, what the result says, its figure, the rest, and how to repeat it."""
    return html.Section(
        [
            _options(view),
            html.Div(
                [
                    html.Div(html.P(FIRST, className="asked"), id={"head": view}),
                    dcc.Store(id={"plain": view}),
                    dcc.Graph(id={"figure": view}, figure=EMPTY, config=GRAPH, className="figure"),
                    html.Div([], id={"rest": view}),
                ],
                id={"view": view},
                className="view",
            ),
            html.Div([], id={"recipe": view}),
        ],
        id={"section": view},
        style={} if view == "trim" else {"display": "none"},
    )


def _options(view: str) -> html.Div:
    """Return what may be chosen of a view: what a locus runs over, how a flight is shown, what is pinned."""
    chosen = {"locus": _span, "flight": _shapes}.get(view, list)()
    pin = html.Button(PIN, id={"view": view, "part": "pin"}, disabled=True, title=PIN_WORDS, className="pin")
    return html.Div([*chosen, pin], className="options")


def _shapes() -> list[Any]:
    """Return how a flight may be shown."""
    options = [{"label": words, "value": shape} for shape, words in SHAPES.items()]
    return [
        grouped("how the flight is shown", dcc.RadioItems(id="shape", value="histories", options=options, inline=True))
    ]


def _span() -> list[Any]:
    """Return what the root locus runs over."""
    entries: list[Any] = [html.Label("over", htmlFor="over")]
    entries.append(dcc.Dropdown(id="over", options=[], value="wind.speed", clearable=False, className="over"))
    for name, words in (("low", "from"), ("high", "to"), ("points", "points")):
        box = dcc.Input(id=name, value="", type="text", debounce=True, className="number", maxLength=LONGEST)
        entries += [html.Label(words, htmlFor=name), box]
    entries.append(html.Span("", id="over-unit", className="unit"))
    return entries
