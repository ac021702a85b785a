"""The ship as a mesh of few facets: a hull of revolution and its fins. Depends on: view.flight.ship."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tethership.view.flight.ship import ShipShape

Array = NDArray[np.float64]

RINGS, SECTORS = 9, 12
"""Sections of the hull between nose and tail, and corners of each."""


class Mesh(NamedTuple):
    """Triangles.

    Attributes
    ----------
    vertices : Array
        Corners, body axes from P [m], shape (n, 3).
    faces : NDArray
        Indices of the corners of each triangle, shape (m, 3).
    """

    vertices: Array
    faces: NDArray[np.intp]

    def placed(self, position: Array, rotation: Array) -> Array:
        """Return the corners in ground axes [m].

        Parameters: position of P, ground axes [m], shape (3,); rotation, body to ground, shape (3, 3).
        """
        return position + self.vertices @ rotation.T


def ship_mesh(shape: ShipShape, rings: int = RINGS, sectors: int = SECTORS) -> Mesh:
    """Return the hull and the fins as triangles.

    Parameters
    ----------
    shape : ShipShape
        From `ship_shape` [m].
    rings : int
        Sections between nose and tail.
    sectors : int
        Corners of a section.

    Returns
    -------
    Mesh
        Corners in body axes from P [m]: the hull's sections from nose to tail, its two poles, then four of each fin.
    """
    chosen = np.linspace(0, len(shape.station) - 1, rings + 2).round().astype(int)
    station, radius = shape.station[chosen], shape.radius[chosen]
    angle = np.linspace(0.0, 2.0 * np.pi, sectors, endpoint=False)
    around = np.stack([np.zeros(sectors), np.cos(angle), np.sin(angle)], axis=1)
    forward = np.array([1.0, 0.0, 0.0])
    sections = station[1:-1, None, None] * forward + radius[1:-1, None, None] * around
    poles = station[[0, -1], None] * forward
    hull = shape.axis + np.concatenate([sections.reshape(-1, 3), poles])
    nose, tail = rings * sectors, rings * sectors + 1
    first = np.arange(sectors)
    second = (first + 1) % sectors
    faces = [np.stack([np.full(sectors, nose), first, second], axis=1)]
    for ring in range(rings - 1):
        a, b = ring * sectors + first, ring * sectors + second
        faces += [np.stack([a, a + sectors, b], axis=1), np.stack([b, a + sectors, b + sectors], axis=1)]
    last = (rings - 1) * sectors
    faces.append(np.stack([np.full(sectors, tail), last + second, last + first], axis=1))
    corners = len(hull) + 4 * np.arange(len(shape.fins))[:, None]
    faces += [corners + np.array([0, 1, 2]), corners + np.array([0, 2, 3])]
    vertices = np.concatenate([hull, shape.fins.reshape(-1, 3)])
    return Mesh(vertices, np.concatenate(faces).astype(np.intp))
