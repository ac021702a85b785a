"""What a flight's figures draw, as plain arrays: snapshots, poses, cables, ground. Depends on: simulation, scenario."""

import dataclasses

import jax
import numpy as np
from numpy.typing import NDArray

from tethership.errors import SolveError
from tethership.scenario import ScenarioConfig, ground_level
from tethership.simulation import Flight
from tethership.spatial import rotation_matrix
from tethership.view.flight.ship import ShipShape, ship_shape

Array = NDArray[np.float64]

SNAPSHOT_INTERVAL = 4.0
"""Time between snapshots [s], as in Fig. 12 of Riboldi et al."""

MOST_SNAPSHOTS = 30
"""Longer flights have the interval doubled until they fit."""


@dataclasses.dataclass(frozen=True)
class Snapshots:
    """A flight's data for drawing, SI, ground axes unless said otherwise.

    Attributes
    ----------
    flight : Flight
        Where all of it comes from.
    config : ScenarioConfig
        Its scenario, SI and radians.
    shape : ShipShape
        The ship.
    interval : float
        Time between snapshots [s].
    indices : NDArray
        Indices of the samples drawn, start and end included.
    rotations : Array
        Body to ground at the snapshots [-], shape (snapshots, 3, 3).
    path : Array
        Centre of buoyancy B at all samples [m], shape (n, 3).
    curves : Array
        Cables at all samples, anchor first [m], shape (n, cables, points, 3).
    ground : float
        Altitude of the ground [m].
    """

    flight: Flight
    config: ScenarioConfig
    shape: ShipShape
    interval: float
    indices: NDArray[np.intp]
    rotations: Array
    path: Array
    curves: Array
    ground: float

    def values(self, name: str) -> Array:
        """Return an output of the flight by its name, in its unit of `results.schema`, e.g. a tension [N]."""
        return self.flight.data[name].to_numpy()

    @property
    def time(self) -> Array:
        """Times of the samples [s]."""
        return self.values("time")

    @property
    def cables(self) -> list[str]:
        """Names of the cables."""
        return [cable.name for cable in self.config.cables]


def snapshot_interval(duration: float) -> float:
    """Return the time between snapshots [s] for a flight of some duration [s]."""
    interval = SNAPSHOT_INTERVAL
    while duration / interval > MOST_SNAPSHOTS:
        interval *= 2.0
    return interval


def snapshot_indices(time: Array, interval: float) -> NDArray[np.intp]:
    """Return the samples nearest to every multiple of an interval [s], and the last; `time` rises [s]."""
    wanted = np.arange(time[0], time[-1] + 1e-9, interval)
    nearest = np.abs(time[:, None] - wanted).argmin(axis=0)
    return np.unique(np.append(nearest, len(time) - 1)).astype(np.intp)


def take_snapshots(flight: Flight) -> Snapshots:
    """Return what is drawn of a flight.

    Parameters
    ----------
    flight : Flight
        Flown or loaded.

    Returns
    -------
    Snapshots
        Samples nearest to every multiple of the interval [s], and the last; places in ground axes [m].

    Raises
    ------
    ConfigError
        The scenario that it carries cannot be read by this version.
    SolveError
        It diverged before its first sample: there is nothing to draw.
    """
    if flight.data.sizes["time"] == 0:
        raise SolveError("the flight has no sample to draw: it diverged at its start")
    config = flight.config
    shape = ship_shape(config.vehicle)
    time = flight.data["time"].to_numpy()
    interval = snapshot_interval(float(time[-1] - time[0]))
    indices = snapshot_indices(time, interval)
    rotations = np.asarray(_rotations(flight.data["attitude"].to_numpy()))
    return Snapshots(
        flight,
        config,
        shape,
        interval,
        indices,
        rotations[indices],
        flight.data["position"].to_numpy() + rotations @ shape.axis,
        flight.data["cable_curve"].to_numpy(),
        -float(ground_level(config)),
    )


_rotations = jax.jit(jax.vmap(rotation_matrix))
