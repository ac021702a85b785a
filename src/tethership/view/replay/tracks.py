"""The histories of a flight for a replay: samples chosen, numbers packed. Depends on: view.flight.thinning.

A track is a history of one or more numbers at the chosen times, in single precision: 7 digits, far below what an eye
sees, and half the size.
"""

import base64
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tethership.errors import ConfigError
from tethership.scenario import ScenarioConfig
from tethership.view.flight.thinning import evenly, with_peaks
from tethership.view.replay.derived import gusts, quaternions, rotations, thrusts

Array = NDArray[np.float64]

INTERVAL = 1.0 / 30.0
"""Time between samples [s]; doubled until a flight fits into `BUDGET`."""

PEAK_STRETCHES = 300
"""Stretches of the flight whose largest and smallest tension are always kept."""

BUDGET = 1.9e6
"""Bytes that the tracks of a flight may take in the page."""

NUMBER = 4.0 * 4.0 / 3.0
"""Bytes of a number in the page."""

DERIVED = 32
"""Numbers at an instant besides those copied: at most so many with ten thrusters; it only sets the budget."""

NEEDED = ("position", "attitude")
"""Outputs without which there is nothing to replay."""

COPIED = (
    "throttle",
    "tension",
    "cable_length",
    "rewind_rate",
    "distance",
    "clearance",
    "cable_curve",
    "wind",
    "air_velocity",
)
"""Outputs that are shown as they are."""


def tracks(data: xr.Dataset, config: ScenarioConfig) -> dict[str, Array]:
    """Return the histories to show, by name, first axis time, at the chosen samples.

    Names are those of `results.schema`, SI; `attitude` is in degrees. Besides: `quaternion` (body to ground, x y z w
    [-]), `centre` (B, ground axes [m]), `gust` [m/s] and `thrust` [N] of `view.replay.derived`. What a file lacks is
    left out.

    Parameters
    ----------
    data : xr.Dataset
        Of a flight, with at least one sample.
    config : ScenarioConfig
        Its scenario.

    Raises
    ------
    ConfigError
        The flight has no position or no attitude.
    """
    lacking = [name for name in NEEDED if name not in data]
    if lacking:
        raise ConfigError(f"the flight holds no {' and no '.join(lacking)}: it cannot be replayed; fly it again")
    data = data.isel(time=chosen(data))
    attitude, position = data["attitude"].to_numpy(), data["position"].to_numpy()
    turned = rotations(attitude)
    centre = position + turned.apply(config.vehicle.buoyancy.centre)
    found = {
        "time": data["time"].to_numpy(),
        "position": position,
        "quaternion": quaternions(turned),
        "attitude": np.degrees(np.unwrap(attitude, axis=0)),
        "centre": centre,
        **{name: data[name].to_numpy() for name in COPIED if name in data and data[name].size},
    }
    if "wind" in found:
        found["gust"] = gusts(found["wind"], centre, config)
    thrust = thrusts(data, config)
    return found if thrust is None else {**found, "thrust": thrust}


def chosen(data: xr.Dataset) -> NDArray[np.intp]:
    """Return the samples of a flight to keep: evenly in time [s], and the peaks of every cable's tension [N]."""
    time = data["time"].to_numpy()
    numbers = DERIVED + sum(data[name][0].size for name in COPIED if name in data)
    most = int(BUDGET / (NUMBER * numbers))
    if "tension" not in data or not data["tension"].size:
        return evenly(time, INTERVAL, most)
    stretches = min(PEAK_STRETCHES, most // 8)
    peaks = with_peaks(data["tension"].to_numpy(), stretches)
    if len(peaks) == len(time):  # a short flight is kept whole
        return peaks
    return np.union1d(evenly(time, INTERVAL, most - len(peaks)), peaks).astype(np.intp)


def packed(values: NDArray[Any], kind: str = "<f4") -> str:
    """Return numbers in base 64, little-endian: `<f4` single precision, `<u2` or `<u4` whole."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def packed_tracks(found: dict[str, Array]) -> dict[str, Any]:
    """Return tracks as JSON can hold them: width (numbers at an instant) and data of each."""
    return {
        name: {"width": int(values[0].size), "data": packed(values.reshape(len(values), -1))}
        for name, values in found.items()
    }
