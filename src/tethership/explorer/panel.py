"""The panel of numbers: fields in groups, texts with units and, for the main ones, sliders. Depends on: dash."""

import json
from typing import Any

from dash import dcc, html

from tethership.explorer.choice import FORMULATIONS
from tethership.explorer.fields import Field, groups
from tethership.scenario import LAYERS, Scenario

OPEN = ("Air", "Trim", "Cable")
"""Groups that are open at first."""

LONGEST = 100
"""Characters of a number, its unit, or a name of a file at most."""


def panel(scenario: Scenario) -> list[Any]:
    """Return the groups of a scenario's fields, the laws between."""
    found = groups(scenario.config)
    sections = [_group(title, rows) for title, rows in found.items() if title in ("Air", "Trim")]
    sections += [_group(title, rows) for title, rows in found.items() if title.startswith("Cable")]
    sections.append(_laws(scenario))
    sections += [_group(t, rows) for t, rows in found.items() if t not in ("Air", "Trim") and not t.startswith("Cable")]
    return sections


def _group(title: str, rows: list[Field]) -> html.Details:
    return html.Details(
        [html.Summary(title), *map(field, rows)], open=title in OPEN or title.startswith("Cable"), className="group"
    )


def dom_id(place: dict[str, str]) -> str:
    """Return an id of several parts as it stands in the page, for labels to point to."""
    return json.dumps(place, sort_keys=True, separators=(",", ":"))


def grouped(words: str, switches: Any) -> html.Div:
    """Return switches that belong together, with words for those who do not see that they do."""
    return html.Div(switches, role="group", **{"aria-label": words})  # pyright: ignore[reportArgumentType]


def field(entry: Field) -> html.Div:
    """Return one number: label, text, unit, slider."""
    place = {"name": entry.name, "part": "text", "kind": "plain" if entry.span is None else "main"}
    text = dcc.Input(
        id=place,
        value=entry.text,
        type="text",
        debounce=True,
        autoComplete="off",
        spellCheck="false",
        className="number",
        maxLength=LONGEST,
    )
    row = html.Div(
        [
            html.Label(entry.label, title=entry.name, className="name", htmlFor=dom_id(place)),
            text,
            html.Span("" if entry.unit == "1" else entry.unit, className="unit"),
        ],
        className="row",
    )
    whole: Any = {"id": {"name": entry.name, "part": "field"}, "data-own": entry.text, "className": "field"}
    if entry.span is None:
        return html.Div(row, **whole)
    low, high = entry.span
    slider = dcc.Slider(
        id={"name": entry.name, "part": "slider", "kind": "main"},
        min=low,
        max=high,
        step=_step(high - low),
        value=float(entry.text),
        updatemode="drag",
        marks=None,
        allow_direct_input=False,
        included=False,
        className="slider",
    )
    return html.Div([row, slider], **whole)


def _step(width: float) -> float:
    """Return a step of one, two or five times a power of ten, some 200 of which make the width."""
    for step in (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0):
        if width / step <= 200:
            return step
    return width / 200


def _laws(scenario: Scenario) -> html.Details:
    """Return the switches of the control laws and of the formulation."""
    control = scenario.config.control
    has_cable = bool(scenario.config.cables)
    return html.Details(
        [
            html.Summary("Control and model"),
            grouped(
                "control layers",
                dcc.Checklist(
                    id="layers",
                    options=[{"label": name, "value": name, "disabled": not has_cable} for name in LAYERS],
                    value=[name for name in LAYERS if name in control.layers],
                    inline=True,
                    className="switches",
                ),
            ),
            dcc.Checklist(
                id="sas",
                options=[{"label": "SAS / attitude", "value": "sas"}],
                value=["sas"] if control.sas else [],
                className="switches",
            ),
            grouped(
                "formulation",
                dcc.RadioItems(
                    id="formulation",
                    options=[{"label": f"{name} hull and cable", "value": name} for name in FORMULATIONS],
                    value=scenario.formulation,
                    className="switches",
                ),
            ),
        ],
        open=True,
        className="group",
    )
