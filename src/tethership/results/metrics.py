"""Metrics of a docking flight, with the definitions of Tables 3–6 of Riboldi et al. Depends on numpy only.

Each is defined once, for arrays of NumPy and of JAX: a single flight reads them off its samples, a batch
(`simulation.tally`) sums them up step by step while it flies.
"""

from typing import Any, NamedTuple

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


def share_above(start: Any, end: Any, limit: Any) -> Any:
    """Return the share of a step [-], 0 … 1, for which a straight line from `start` to `end` is above a limit.

    Parameters
    ----------
    start, end, limit : Array
        Of NumPy or JAX, the same unit each; shapes that broadcast.
    """
    over, later = start - limit, end - limit
    xp = over.__array_namespace__()
    crossing = xp.clip(-over / xp.where(later == over, 1.0, later - over), 0.0, 1.0)
    one_sided = xp.where(over > 0, crossing, xp.where(later > 0, 1.0 - crossing, 0.0))
    return xp.where((over > 0) & (later > 0), 1.0, one_sided)


def jumped(before: Any, after: Any) -> Any:
    """Return whether the misalignment χ [rad] jumps by more than a right angle between two samples.

    Notes
    -----
    By π when the tether point passes over the anchor, by 2π when the anchor is astern and passes from port to
    starboard: either way a law proportional to χ turns its thrust about.
    """
    return abs(after - before) > 0.5 * np.pi


class Sums(NamedTuple):
    """Integrals over a flight, or what is integrated at one time: the same four everywhere.

    Attributes
    ----------
    tension : Array
        ∫|F| dt of the cable that pulls hardest [N s], or |F| [N].
    effort : Array
        Σ_i ∫|δ_i| dt [s], or Σ_i |δ_i| [-].
    pitch : Array
        ∫θ² dt [rad² s], or θ² [rad²].
    saturated : Array
        Time for which a thruster or fin is asked for more than it has [s], or 1 where it is.
    """

    tension: Any
    effort: Any
    pitch: Any
    saturated: Any


def integrands(tension: Any, throttle: Any, pitch: Any, saturated: Any) -> Sums:
    """Return what is integrated, from |F| [N], δ [-] with the thrusters last, θ [rad] and saturation (0 or 1)."""
    return Sums(tension, abs(throttle).sum(axis=-1), pitch**2, saturated)


def travelled(before: Any, after: Any) -> Any:
    """Return Σ_i |Δδ_i| [-] between two samples of the throttles, thrusters last."""
    return abs(after - before).sum(axis=-1)


def averages(sums: Sums, travel: Any, span: Any) -> dict[str, Any]:
    """Return the metrics that are averages over a flight.

    Parameters
    ----------
    sums : Sums
        Its integrals.
    travel : Array
        Σ_i ∫|dδ_i/dt| dt [-].
    span : Array
        t_f − t_0 above zero [s].

    Returns
    -------
    dict
        Mean tension [N]; ADC = Σ_i 1/(t_f − t_0) ∫|dδ_i/dt| dt [1/s], the total variation of the samples;
        E = Σ_i 1/(t_f − t_0) ∫|δ_i| dt [-]; θ_rms [deg]; time saturated [s].
    """
    return {
        "tension_mean": sums.tension / span,
        "ADC": travel / span,
        "E": sums.effort / span,
        "theta_rms": np.degrees(np.sqrt(sums.pitch / span)),
        "saturated_seconds": sums.saturated,
    }


def seconds_above(time: Array, value: Array, threshold: float) -> float:
    """Return for how long [s] a signal is above a threshold, straight lines between samples.

    Examples
    --------
    >>> import numpy as np
    >>> from tethership.results.metrics import seconds_above
    >>> seconds_above(np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 0.0]), 1.0)
    1.0
    """
    return float(np.sum(np.diff(time) * share_above(value[:-1], value[1:], threshold)))


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


def _saturated(flight: Any) -> Array:
    """Return 1 where a thruster or a fin is asked for more than it has, else 0, shape (time,)."""
    asked = [np.asarray(flight[name]) for name in ("saturated", "deflection_saturated") if name in flight]
    if not asked:
        return np.zeros(len(flight["time"]))
    return np.concatenate(asked, axis=1).max(axis=1, initial=0.0)


def saturated_seconds(flight: Any) -> float:
    """Return for how long [s] a thruster or a fin was asked for more than it has; `flight` has the outputs by name."""
    time = np.asarray(flight["time"])
    return float(np.trapezoid(_saturated(flight), time)) if len(time) else 0.0


def _averages(time: Array, tension: Array, flight: dict[str, Array]) -> dict[str, float]:
    """Return the averages of a flight's samples; those of one sample are its values."""
    values = integrands(tension, flight["throttle"], flight["attitude"][:, 1], _saturated(flight))
    span = float(time[-1] - time[0])
    if span <= 0:
        return {**averages(Sums(*(value[0] for value in values)), 0.0, 1.0), "saturated_seconds": 0.0}
    travel = travelled(flight["throttle"][:-1], flight["throttle"][1:]).sum()
    found = averages(Sums(*(np.trapezoid(value, time) for value in values)), travel, span)
    return {name: float(value) for name, value in found.items()}


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
    chi, sag = flight["misalignment"], flight["cable_clearance"]
    found = _averages(time, tension, flight)
    return {
        "tension_max": float(fine_tension.max()),
        "tension_mean": found["tension_mean"],
        "tension_largest": float(flight["tension_largest"].max(initial=0.0)),
        "rewind_rate_min": float(flight["rewind_rate"].min()) if cables else 0.0,
        "seconds_above": [seconds_above(fine_time, fine_tension, limit) for limit in limits],
        "ADC": found["ADC"],
        "E": found["E"],
        "theta_rms": found["theta_rms"],
        "clearance_min": float(flight["clearance"].min()),
        "cable_clearance_min": float(sag.min()) if cables else None,
        "saturated_seconds": found["saturated_seconds"],
        "misalignment_jumps": int(np.sum(jumped(chi[:-1, 0], chi[1:, 0]))) if cables else 0,
    }
