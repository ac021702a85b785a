"""Where in a flight the quasi-static cable may be trusted. Depends on: scenario.

A cable follows its ends quasi-statically while they are slow against its own motion, of which the first transverse mode
is the slowest: ω₁ = (π/L)√(T/m), a taut string's. The pace of the tension against it is

    κ = |dT/dt| / (T ω₁)

The statics are held against a dynamic line moved as recorded flights moved their cables (MoorDyn, elastic catenary,
four flights at 6 and 12 m/s, 19 607 instants; difference over the larger). At a peak dT/dt = 0 and κ says nothing,
and a hurried cable swings on: a cable is outside for `MEMORY` seconds after κ was above `TRUSTED`. Inside, the median
difference is then 3 %, 95 % are below 20 %, none is above 28 N; outside the median is 14 %, a tenth above 58 %. Without
the memory the peaks themselves, off by up to 216 N, would count as trusted, even with κ < 0.1.

A cable that comes taut at a closing speed v rings: its peak may be above the statics by v√(EA m), the tension of the
axial wave; in 40 snaps of eight flights by 0.6 of it in the middle, 1.0 at nine tenths. The first axial mode, 23 Hz at
20 m, is out of reach of a ship that moves at 1 Hz. The paper's law changes its tension on its own account (its
joint), so under it κ tells of the law as much as of the motion.
"""

from typing import Protocol

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from tethership.scenario import ScenarioConfig
from tethership.simulation.cable_pace import LEAST_MASS, LEAST_TENSION, MEMORY, SLACK, TRUSTED, first_mode

TOLD = 0.01
"""Share of a flight outside the trusted range from which it is told [-]."""


class Recorded(Protocol):
    """What is needed of a flight."""

    @property
    def data(self) -> xr.Dataset:
        """Its outputs."""
        ...

    @property
    def config(self) -> ScenarioConfig:
        """Its scenario."""
        ...


def tension_pace(flight: Recorded) -> NDArray[np.float64]:
    """Return κ [-] of each cable at the flight's instants, shape (time, cables)."""
    data = flight.data
    time, tension = data["time"].to_numpy(), data["tension"].to_numpy()
    mass = np.array([cable.linear_density for cable in flight.config.cables])
    if len(time) < 2 or not len(mass):
        return np.zeros(tension.shape)
    floor = np.maximum(tension, LEAST_TENSION)
    mode = first_mode(floor, data["cable_length"].to_numpy(), np.maximum(mass, LEAST_MASS))
    return np.abs(np.gradient(tension, time, axis=0)) / floor / mode


def outside(flight: Recorded) -> NDArray[np.bool_]:
    """Return at which of the flight's instants a cable is outside the trusted range, shape (time,).

    It is so where κ [-] of any cable is above `TRUSTED`, and for `MEMORY` [s] from there on.
    """
    pace, time = tension_pace(flight), flight.data["time"].to_numpy()
    hurried = np.where(np.any(pace > TRUSTED, axis=1), time, -np.inf)
    return time - np.maximum.accumulate(hurried) <= MEMORY


def share_outside(flight: Recorded) -> float:
    """Return the share of the flight's samples in which a cable is outside the trusted range [-]."""
    return float(np.mean(outside(flight))) if flight.data["tension"].size else 0.0


def largest_impulse(flight: Recorded) -> tuple[float, float]:
    """Return the largest v√(EA m) [N] of a snap, e rising through 1 after it was slack, and its time [s]; 0 if none."""
    data = flight.data
    time, largest = data["time"].to_numpy(), (0.0, 0.0)
    for i, cable in enumerate(flight.config.cables):
        elongation, distance = data["elongation"].to_numpy()[:, i], data["distance"].to_numpy()[:, i]
        closing = np.gradient(distance, time) + data["rewind_rate"].to_numpy()[:, i] * elongation
        slack = False
        for k in range(1, len(time)):
            slack = slack or elongation[k] < SLACK
            if slack and elongation[k] >= 1.0:
                slack = False
                wave = float(closing[k] * np.sqrt(cable.stiffness * cable.linear_density))
                largest = max(largest, (wave, float(time[k])))
    return largest


def quasi_static_warning(flight: Recorded) -> str | None:
    """Return one line where a flight leaves the range in which the quasi-static cable may be trusted, else None.

    It is told from a share of `TOLD` [-] of its samples on, with the largest tension of an axial wave [N].
    """
    share = share_outside(flight)
    if share < TOLD:
        return None
    impulse, moment = largest_impulse(flight)
    advice = ""
    if any(line["model"] == "published" for line in flight.config.line_models().values()):
        advice = "; the paper's cable pulls from e = 0.99 on and overstates snaps: take the line catenary"
    elif impulse > 0.0:
        advice = f"; a dynamic line may peak up to {impulse:.0f} N higher at the snap at {moment:.1f} s"
    return (
        f"the quasi-static cable is not to be trusted in {100.0 * share:.0f} % of the flight (first at "
        f"{float(flight.data['time'][int(np.argmax(outside(flight)))]):.1f} s): the tension changes faster than "
        f"{TRUSTED:g} of the cable's first transverse mode, or did {MEMORY:g} s before{advice}"
    )
