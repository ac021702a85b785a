"""Names of modes beside their roots in a plotly figure, apart from each other. Depends on: view.style."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from tethership.analysis.modes import Complex
from tethership.view import style

SHIFTS = (14, -15, 28, -29, 42, -43)
"""Where a name may stand above its root [px]; the first that is free."""

NEAR = (0.22, 0.04)
"""Shares of the panel's width and height within which two names would meet."""

PANEL_HEIGHT = 450.0
"""About that of a panel [px]."""

ANNOTATION = "mode"
"""Name of these annotations in the figure."""


def mode_names(modes: Iterable[tuple[str, complex]], drawn: Complex, axis: str) -> list[dict[str, Any]]:
    """Return annotations that name modes, as plotly takes them.

    Parameters
    ----------
    modes : iterable of (str, complex)
        Name and eigenvalue [1/s] of each.
    drawn : NDArray of complex
        All roots of the panel [1/s], which tell how far it reaches.
    axis : str
        Suffix of the panel's axes: "" or "2", "3", …
    """
    width, height = (max(float(np.ptp(part)), 1e-9) if len(drawn) else 1.0 for part in (drawn.real, drawn.imag))
    placed: list[tuple[float, float]] = []

    def is_free(x: float, y: float) -> bool:
        return not any(abs(u - x) < NEAR[0] * width and abs(v - y) < NEAR[1] * height for u, v in placed)

    names = []
    for name, root in sorted(modes, key=lambda mode: mode[1].real):
        x, y = float(root.real), float(root.imag)
        shift = next((shift for shift in SHIFTS if is_free(x, y + shift / PANEL_HEIGHT * height)), SHIFTS[0])
        placed.append((x, y + shift / PANEL_HEIGHT * height))
        place = {"x": x, "y": y, "xref": f"x{axis}", "yref": f"y{axis}", "yshift": shift, "showarrow": False}
        look = {"font": {"size": 11, "color": style.INK}}
        names.append({"name": ANNOTATION, "text": name, **look, **place})
    return names
