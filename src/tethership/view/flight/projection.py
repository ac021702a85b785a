"""Views of a flight: parallel projections of ground axes onto paper. Depends on: numpy.

Paper coordinates stay what the axes' labels say (east, north, altitude); where east runs to the left, the axis is
inverted, never the data.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class View(NamedTuple):
    """A direction from which a flight is seen.

    Attributes
    ----------
    title : str
        What it is called.
    labels : tuple of str
        Labels of the horizontal and the vertical axis, with their unit [m].
    plane : Array
        Rows are the unit vectors of the horizontal and the vertical axis, ground axes [-], shape (2, 3).
    toward : Array
        Unit vector from the scene to the viewer, ground axes [-], shape (3,).
    leftward : bool
        Whether the horizontal axis grows to the left.
    """

    title: str
    labels: tuple[str, str]
    plane: Array
    toward: Array
    leftward: bool = False

    @property
    def shows_altitude(self) -> bool:
        """Whether the vertical axis is altitude."""
        return bool(self.plane[1, 2] != 0.0)

    def project(self, points: Array) -> Array:
        """Return paper coordinates [m], shape (…, 2), of points in ground axes [m], shape (…, 3)."""
        return points @ self.plane.T


_NORTH, _EAST, _DOWN = np.eye(3)

FROM_NORTH = View(
    "View from north (looking south)",
    ("← east [m]", "altitude [m]"),
    np.stack([_EAST, -_DOWN]),
    _NORTH,
    leftward=True,
)
"""Looking south: east is on the left."""

FROM_EAST = View("View from east (looking west)", ("north [m] →", "altitude [m]"), np.stack([_NORTH, -_DOWN]), _EAST)
"""Looking west: north is on the right."""

FROM_TOP = View("View from top (looking down)", ("east [m] →", "north [m]"), np.stack([_EAST, _NORTH]), -_DOWN)
"""Looking down: north is up."""
