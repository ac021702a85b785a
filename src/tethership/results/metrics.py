"""Metrics of a docking flight, with the definitions of Tables 3–6 of Riboldi et al. Depends on numpy only."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


REFINEMENT = 8
"""Points laid between two samples before a peak or a crossing is read off."""


def refined(time: Array, value: Array) -> tuple[Array, Array]:
    """Return a sampled signal with `REFINEMENT` times as many samples, by a cubic through four neighbours.

    Parameters
    ----------
    time : Array
        Times [s], rising, shape (n,).
    value : Array
        Samples, shape (n,), any unit.

    Notes
    -----
    Catmull–Rom: between two samples a cubic with the slopes of central differences. A snap of the cable lasts a few
    samples; straight lines would cut its peak by 1 % and its time over a threshold by 3 %.
    """
    if len(time) < 4:
        return time, value
    slope = np.gradient(value, time)
    step = np.diff(time)[:, None]
    share = np.arange(REFINEMENT) / REFINEMENT
    start, end = value[:-1, None], value[1:, None]
    between = (
        (1 + 2 * share) * (1 - share) ** 2 * start
        + share * (1 - share) ** 2 * step * slope[:-1, None]
        + share**2 * (3 - 2 * share) * end
        - share**2 * (1 - share) * step * slope[1:, None]
    )
    times = time[:-1, None] + share * step
    return np.append(times.ravel(), time[-1]), np.append(between.ravel(), value[-1])


def seconds_above(time: Array, value: Array, threshold: float) -> float:
    """Return for how long [s] a signal is above a threshold, straight lines between samples.

    Examples
    --------
    >>> import numpy as np
    >>> from tethership.results.metrics import seconds_above
    >>> seconds_above(np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 0.0]), 1.0)
    1.0
    """
    over = value - threshold
    start, end, step = over[:-1], over[1:], np.diff(time)
    change = np.where(end == start, 1.0, end - start)
    crossing = np.clip(-start / change, 0.0, 1.0)
    share = np.where(
        (start > 0) & (end > 0), 1.0, np.where(start > 0, crossing, np.where(end > 0, 1.0 - crossing, 0.0))
    )
    return float(np.sum(share * step))


def mean(time: Array, value: Array) -> float:
    """Return the time average of a signal, trapezoidal, in the signal's unit.

    Parameters
    ----------
    time : Array
        t [s], rising, shape (n,).
    value : Array
        Samples, shape (n,), any unit; where all times are one the first sample is the average.
    """
    span = time[-1] - time[0]
    return float(np.trapezoid(value, time) / span) if span > 0 else float(value[0])


def duty_cycle(time: Array, throttle: Array) -> float:
    """Return ADC = Σ_i 1/(t_f − t_0) ∫|dδ_i/dt| dt [1/s], as the total variation of the samples.

    Parameters
    ----------
    time : Array
        [s], shape (n,).
    throttle : Array
        δ [-], shape (n, thrusters).
    """
    span = time[-1] - time[0]
    return float(np.abs(np.diff(throttle, axis=0)).sum() / span) if span > 0 else 0.0


def control_energy(time: Array, throttle: Array) -> float:
    """Return E = Σ_i 1/(t_f − t_0) ∫|δ_i| dt [-]; arguments as in `duty_cycle`."""
    return sum(mean(time, np.abs(column)) for column in throttle.T)


def jumps(angle: Array) -> int:
    """Return how often the misalignment χ [rad], shape (n,), jumps by more than a right angle between samples.

    Notes
    -----
    By π when the tether point passes over the anchor, by 2π when the anchor is astern and passes from port to
    starboard: either way a law proportional to χ turns its thrust about.
    """
    return int(np.sum(np.abs(np.diff(angle)) > 0.5 * np.pi))


def saturated_seconds(flight: Any) -> float:
    """Return for how long [s] a thruster or a fin was asked for more than it has; `flight` has the outputs by name."""
    asked = [np.asarray(flight[name]) for name in ("saturated", "deflection_saturated") if name in flight]
    time = np.asarray(flight["time"])
    if not asked or not len(time):
        return 0.0
    return float(mean(time, np.concatenate(asked, axis=1).max(axis=1, initial=0.0)) * (time[-1] - time[0]))


def docking_metrics(flight: dict[str, Array], limits: list[float]) -> dict[str, Any]:
    """Return the metrics of Tables 3–6 of one flight.

    Parameters
    ----------
    flight : dict
        Outputs by the names of `results.schema`, `time` included.
    limits : list of float
        Tensions whose exceedance is timed [N].

    Notes
    -----
    Tension is that at the tether point of the cable that pulls hardest, refined before its peak and its time over a
    limit are read off; `tension_largest` is the peak anywhere along any cable, which is what breaks it. Jumps of the
    misalignment are those of the first cable. Saturated is a flight while a thruster or a fin is asked for more than it
    has. θ_rms is in degrees, all else in SI. Without a cable tensions are zero
    and `cable_clearance_min` is None.
    """
    time = flight["time"]
    tensions = flight["tension"]
    cables = tensions.shape[1]
    tension = tensions.max(axis=1) if cables else np.zeros_like(time)
    fine_time, fine_tension = refined(time, tension)
    pitch = flight["attitude"][:, 1]
    rates = flight["rewind_rate"]
    chi = flight["misalignment"]
    sag = flight["cable_clearance"]
    return {
        "tension_max": float(fine_tension.max()),
        "tension_mean": mean(time, tension),
        "tension_largest": float(flight["tension_largest"].max(initial=0.0)),
        "rewind_rate_min": float(rates.min()) if cables else 0.0,
        "seconds_above": [seconds_above(fine_time, fine_tension, limit) for limit in limits],
        "ADC": duty_cycle(time, flight["throttle"]),
        "E": float(control_energy(time, flight["throttle"])),
        "theta_rms": float(np.degrees(np.sqrt(mean(time, pitch**2)))),
        "clearance_min": float(flight["clearance"].min()),
        "cable_clearance_min": float(sag.min()) if cables else None,
        "saturated_seconds": saturated_seconds(flight),
        "misalignment_jumps": jumps(chi[:, 0]) if cables else 0,
    }
