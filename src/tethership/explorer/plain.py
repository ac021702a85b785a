"""A plotly figure as plain data, which any process can take. Depends on: plotly."""

import json
from typing import Any

import plotly.graph_objects as go


def plain_figure(figure: go.Figure) -> dict[str, Any]:
    """Return a figure as lists, numbers and words."""
    return json.loads(str(figure.to_json()))
