"""The ship's outline in a view: silhouette of its hull and its fins. Depends on: scenario (the shape), projection."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float
from numpy.typing import NDArray

from tethership.physics import BodyOfRevolution
from tethership.scenario import FinConfig, VehicleConfig, build_hull
from tethership.view.flight.projection import View

Array = NDArray[np.float64]

FRACTIONS = 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 161)))
"""Stations of the hull over its length [-], dense at nose and tail."""

EDGE = np.cos(np.linspace(0.0, np.pi, 49))
"""Points of a silhouette along its length [-], from the front 1 to the back −1."""


class ShipShape(NamedTuple):
    """What is drawn of a ship, body axes from P.

    Attributes
    ----------
    axis : Array
        A point of the hull's axis, at the centre of buoyancy [m], shape (3,).
    station : Array
        Forward positions of the hull's sections from that point, falling from nose to tail [m], shape (n,).
    radius : Array
        Their radii [m], shape (n,).
    fins : Array
        Corners of the fins [m], shape (fins, 4, 3).
    """

    axis: Array
    station: Array
    radius: Array
    fins: Array


@jax.jit
def _sections(hull: BodyOfRevolution) -> tuple[Float[jax.Array, "n"], Float[jax.Array, "n"]]:
    """Return forward positions from the centre of volume [m] and radii [m] of the hull's sections."""
    station = jnp.asarray(FRACTIONS) * hull.length
    return hull.centre() - station, hull.radius(station)


def ship_shape(vehicle: VehicleConfig) -> ShipShape:
    """Return the shape of a vehicle.

    Parameters
    ----------
    vehicle : VehicleConfig
        A validated vehicle, P at the origin of its body axes.

    Returns
    -------
    ShipShape
        Body axes from P [m]; 161 sections, dense at nose and tail.
    """
    axis = np.asarray(vehicle.buoyancy.centre)
    station, radius = jax.device_get(_sections(build_hull(vehicle.hull)))
    fins = np.array([_fin(fin, axis) for fin in vehicle.fins]).reshape(-1, 4, 3)
    return ShipShape(axis, station, radius, fins)


def _fin(fin: FinConfig, axis: Array) -> Array:
    """Return the corners of a fin from P, body axes [m], shape (4, 3): root ahead, tip ahead, tip aft, root aft.

    Notes
    -----
    A file gives a fin's area, quarter chord and centroid, not its corners: the chord is four times the distance of
    the two, and the leading edge is swept for the eye.
    """
    chord = 4.0 * (fin.aerodynamic_station - fin.cross_flow_station)
    if not 0.3 < chord**2 / fin.area < 3.0:
        chord = np.sqrt(fin.area)
    reach = 0.5 * fin.area / chord
    outward = np.array([0.0, np.cos(fin.roll), np.sin(fin.roll)])
    forward = fin.cross_flow_station + chord * np.array([0.7, 0.3, -0.5, -0.5])
    away = fin.distance_from_axis + reach * np.array([-1.0, 1.0, 1.0, -1.0])
    centre_line = axis * np.array([0.0, 1.0, 1.0])
    return centre_line + forward[:, None] * np.array([1.0, 0.0, 0.0]) + away[:, None] * outward


def silhouette(shape: ShipShape, position: Array, rotation: Array, view: View) -> Array:
    """Return the outline of the hull in a view [m], shape (points, 2).

    Parameters
    ----------
    shape : ShipShape
        From `ship_shape`.
    position : Array
        P, ground axes [m], shape (3,).
    rotation : Array
        Body to ground [-], shape (3, 3).
    view : View
        Where it is seen from.

    Notes
    -----
    A section of radius r at x is seen as an ellipse about x cos γ with half axes r sin γ along the hull's axis and r
    across, γ the angle of the axis to the paper. The silhouette is the envelope of all of them, and holds the profile
    (x cos γ, r) itself, which alone is left in a pure side view.
    """
    seen = view.project(rotation[:, 0])
    cosine, sine = float(np.linalg.norm(seen)), abs(float(view.toward @ rotation[:, 0]))
    along = seen / cosine if cosine > 1e-9 else np.array([1.0, 0.0])
    across = np.array([-along[1], along[0]])
    centre, reach = shape.station * cosine, shape.radius * sine
    low, high = np.min(centre - reach), np.max(centre + reach)
    place = 0.5 * (high + low) + 0.5 * (high - low) * EDGE
    offset = (place[:, None] - centre) / np.where(reach > 1e-12, reach, 1e-12)
    ellipses = np.max(shape.radius * np.sqrt(np.clip(1.0 - offset**2, 0.0, None)), axis=1)
    half = np.maximum(ellipses, np.interp(place, centre[::-1], shape.radius[::-1]))
    middle = view.project(position + rotation @ shape.axis) + place[:, None] * along
    edge = half[:, None] * across
    return np.concatenate([middle + edge, (middle - edge)[::-1]])


def ship_outlines(shape: ShipShape, position: Array, rotation: Array, view: View) -> list[Array]:
    """Return the ship's polygons in a view [m], from the farthest to the nearest: fins behind, hull, fins ahead.

    Parameters are those of `silhouette`. A fin is ahead if it is on the viewer's side of the hull's axis, or, seen
    along the axis, at the viewer's end.
    """
    corners = position + shape.fins @ rotation.T
    depth = (shape.fins.mean(axis=1) - shape.axis) * np.array([0.02, 1.0, 1.0]) @ rotation.T @ view.toward
    flat = view.project(corners)
    behind = [flat[i] for i in np.argsort(depth) if depth[i] <= 0.0]
    ahead = [flat[i] for i in np.argsort(depth) if depth[i] > 0.0]
    return [*behind, silhouette(shape, position, rotation, view), *ahead]
