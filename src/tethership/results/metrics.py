"""Metrics of a docking flight, with the definitions of Tables 3–6 of Riboldi et al. Depends on numpy only."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def peak(time: Array, value: Array) -> float:
    """Return the largest value of a sampled signal, a parabola laid through the samples around it.

    Parameters
    ----------
    time : Array
        Times [s], rising, shape (n,).
    value : Array
        Samples, shape (n,); the peak has their unit.
    """
    top = int(np.argmax(value))
    if not 0 < top < len(value) - 1:
        return float(value[top])
    before, after = time[top] - time[top - 1], time[top + 1] - time[top]
    if before <= 0 or after <= 0:
        return float(value[top])
    rise = (value[top] - value[top - 1]) / before
    fall = (value[top + 1] - value[top]) / after
    curvature = (fall - rise) / (before + after)
    slope = (rise * after + fall * before) / (before + after)
    if curvature >= 0:
        return float(value[top])
    gain = -(slope**2) / (4.0 * curvature)
    return float(value[top] + min(gain, abs(value[top]) * 0.05))


def mean(time: Array, value: Array) -> float:
    """Return the time average of a signal, trapezoidal; unit of the value."""
    span = time[-1] - time[0]
    return float(np.trapezoid(value, time) / span) if span > 0 else float(value[0])


def seconds_above(time: Array, value: Array, threshold: float) -> float:
    """Return for how long [s] a signal is above a threshold, straight lines between samples."""
    over = value - threshold
    start, end, step = over[:-1], over[1:], np.diff(time)
    change = np.where(end == start, 1.0, end - start)
    crossing = np.clip(-start / change, 0.0, 1.0)
    share = np.where(
        (start > 0) & (end > 0), 1.0, np.where(start > 0, crossing, np.where(end > 0, 1.0 - crossing, 0.0))
    )
    return float(np.sum(share * step))


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
    """Return how often the misalignment χ jumps by more than a right angle between samples."""
    return int(np.sum(np.abs(np.diff(angle)) > 0.5 * np.pi))


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
    Tension is that at the tether point of the cable that pulls hardest. θ_rms is returned in degrees, all else in
    SI. Without a cable the tension metrics are NaN-free zeros.
    """
    time = flight["time"]
    tensions = flight["tension"]
    cables = tensions.shape[1]
    tension = tensions.max(axis=1) if cables else np.zeros_like(time)
    pitch = flight["attitude"][:, 1]
    rates = flight["rewind_rate"]
    chi = flight["misalignment"]
    sag = flight["cable_clearance"]
    return {
        "tension_max": max((peak(time, tensions[:, i]) for i in range(cables)), default=0.0),
        "tension_mean": mean(time, tension),
        "rewind_rate_min": float(rates.min()) if cables else 0.0,
        "seconds_above": [seconds_above(time, tension, limit) for limit in limits],
        "ADC": duty_cycle(time, flight["throttle"]),
        "E": float(control_energy(time, flight["throttle"])),
        "theta_rms": float(np.degrees(np.sqrt(mean(time, pitch**2)))),
        "clearance_min": float(flight["clearance"].min()),
        "cable_clearance_min": float(sag.min()) if cables else None,
        "saturated_seconds": float(mean(time, flight["saturated"].max(axis=1, initial=0.0)) * (time[-1] - time[0])),
        "misalignment_jumps": jumps(chi[:, 0]) if cables else 0,
    }
