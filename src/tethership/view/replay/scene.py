"""A flight as plain data that a page can hold: ship, cables, ground, limits, words, tracks.

Depends on: view.flight.hull_mesh, view.flight.ship (the shape), view.replay.tracks, scenario, simulation.
"""

from typing import Any

import numpy as np

from tethership.errors import SolveError
from tethership.scenario import ScenarioConfig, ground_level
from tethership.simulation import Flight
from tethership.view.flight.captions import compass, flown_words
from tethership.view.flight.hull_mesh import ship_mesh
from tethership.view.flight.ship import ship_shape
from tethership.view.replay.tracks import COPIED, packed, packed_tracks, tracks

RINGS, SECTORS = 46, 40
"""Sections of the hull between nose and tail, and corners of each."""

SHOWN = (*COPIED, "gust", "thrust")
"""Tracks that a page shows if it has them."""


def scene(flight: Flight, name: str) -> dict[str, Any]:
    """Return what a replay needs to know of a flight, as JSON can hold it.

    Lengths [m], body axes from P for parts of the ship, ground axes (north, east, down) for the rest; forces [N], times
    [s]. `ground` is the ground's position down [m].

    Parameters
    ----------
    flight : Flight
        Flown or loaded.
    name : str
        How it is called beside another flight.

    Raises
    ------
    ConfigError
        The scenario that it carries cannot be read by this version, or it holds no position.
    SolveError
        It diverged before its first sample.
    """
    if flight.data.sizes.get("time", 0) == 0:
        raise SolveError("the flight has no sample to show: it diverged at its start")
    attributes = flight.attributes
    config = flight.config
    found = tracks(flight.data, config)
    expected = [
        track
        for track in SHOWN
        if not (track in ("throttle", "thrust") and not config.vehicle.thrusters)
        and not (track in ("tension", "cable_length", "rewind_rate", "distance", "cable_curve") and not config.cables)
    ]
    return {
        "name": name,
        "title": config.title,
        "words": flown_words(config, attributes),
        "verdict": flight.verdict,
        "message": flight.outcome.value,
        "duration": float(found["time"][-1]),
        "ship": _ship(config),
        "cables": [
            {"name": cable.name, "anchor": list(cable.anchor), "tether_point": list(cable.tether_point)}
            for cable in config.cables
        ],
        "ground": float(ground_level(config)),
        "ground_modelled": config.ground.anchor_height is not None,
        "wind_from": compass(config.wind.from_direction),
        "gusts": [[gust.start, gust.start + gust.period] for gust in config.gusts],
        "limits": [
            {"name": limit.replace("_", " "), "value": float(value)}
            for (limit, _), value in zip(config.limits, attributes["limits"], strict=True)
        ],
        "warnings": list(flight.warnings),
        "missing": [track.replace("_", " ") for track in expected if track not in found],
        "tracks": packed_tracks(found),
    }


def _ship(config: ScenarioConfig) -> dict[str, Any]:
    """Return the ship's mesh and its thrusters."""
    vehicle = config.vehicle
    shape = ship_shape(vehicle)
    mesh = ship_mesh(shape, RINGS, SECTORS)
    return {
        "name": vehicle.name,
        "vertices": packed(mesh.vertices),
        "faces": packed(mesh.faces, "<u2"),
        "rings": RINGS,
        "sectors": SECTORS,
        "fins": len(shape.fins),
        "axis": np.round(shape.axis, 4).tolist(),
        "nose": np.round(shape.axis + np.array([shape.station[0], 0.0, 0.0]), 4).tolist(),
        "length": float(vehicle.hull.length),
        "diameter": float(vehicle.hull.diameter),
        "thrusters": [
            {
                "name": thruster.name.replace("_", " "),
                "position": list(thruster.position),
                "direction": list(thruster.direction),
                "nominal": float(thruster.nominal_thrust),
            }
            for thruster in vehicle.thrusters
        ],
    }
