"""Where in a flight the quasi-static cable may be trusted. Depends on: simulation.flight, scenario.

A cable follows its ends quasi-statically while they are slow against its own motion, of which the first transverse mode
is the slowest: ω₁ = (π/L)√(T/m), a taut string's. The pace of the tension against it is

    κ = |dT/dt| / (T ω₁)

Held against a dynamic line moved as recorded flights moved their cables (`reproduction.line_comparison`, elastic
catenary, 6 and 12 m/s), the tension differs by a median of 1 to 7 % where κ < 0.1, and by 20 to 60 % where κ > 0.3. The
axial modes are out of reach: EA/m gives 23 Hz at 20 m, against 1 Hz of the ship on its cable.
"""

import numpy as np
from numpy.typing import NDArray

from tethership.scenario import ScenarioConfig
from tethership.scenario.load import validated
from tethership.simulation.flight import Flight

TRUSTED = 0.1
"""Largest pace κ at which the quasi-static tension may be trusted [-]."""

LEAST_TENSION = 5.0
"""Tension below which a change counts as if it were of this [N]: a slack cable's newtons move nothing."""

TOLD = 0.01
"""Share of a flight outside the trusted range from which it is told [-]."""


def tension_pace(flight: Flight) -> NDArray[np.float64]:
    """Return κ [-] of each cable at the flight's instants, shape (time, cables)."""
    data = flight.data
    time, tension = data["time"].to_numpy(), data["tension"].to_numpy()
    stored = flight.attributes
    config = validated(ScenarioConfig, stored["scenario"], stored["scenario_name"])
    mass = np.array([cable.linear_density for cable in config.cables])
    if len(time) < 2 or not len(mass):
        return np.zeros(tension.shape)
    floor = np.maximum(tension, LEAST_TENSION)
    mode = np.pi / data["cable_length"].to_numpy() * np.sqrt(floor / np.maximum(mass, 1e-6))
    return np.abs(np.gradient(tension, time, axis=0)) / floor / mode


def share_outside(flight: Flight) -> float:
    """Return the share of the flight's samples in which a cable is outside the trusted range [-]."""
    pace = tension_pace(flight)
    return float(np.mean(np.any(pace > TRUSTED, axis=1))) if pace.size else 0.0


def quasi_static_warning(flight: Flight) -> str | None:
    """Return one line where a flight leaves the range in which the quasi-static cable may be trusted, else None."""
    share = share_outside(flight)
    if share < TOLD:
        return None
    first = int(np.argmax(np.any(tension_pace(flight) > TRUSTED, axis=1)))
    advice = (
        "the paper's cable pulls from e = 0.99 on and overstates snaps: see formulation consistent"
        if flight.attributes["formulation"] == "published"
        else "a dynamic line peaked up to a fifth higher in the flights that were compared"
    )
    return (
        f"the quasi-static cable is not to be trusted in {100.0 * share:.0f} % of the flight (first at "
        f"{float(flight.data['time'][first]):.1f} s): the tension changes faster than {TRUSTED:g} of the cable's first "
        f"transverse mode; {advice}"
    )
