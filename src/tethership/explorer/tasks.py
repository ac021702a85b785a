"""What the computing process does: trim, root locus, flight. Depends on: analysis, simulation, view.

Takes and returns plain data: numbers in SI, angles in degrees, figures as plotly's JSON.
"""

import gzip
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tethership.errors import ConfigError
from tethership.plant import STATE_NAMES
from tethership.scenario import Scenario, converted, load_scenario

Report = Callable[[str, float | None], None]
"""Called with what is being done and the share that is done, None where that is not known; raises where to stop."""

ANGLES = ("phi", "theta", "psi")

RATES = ("p", "q", "r")


def compute(view: str, path: str, changes: Mapping[str, Any], options: Mapping[str, Any], report: Report) -> Any:
    """Return the numbers and figures of a view.

    Parameters
    ----------
    view : str
        trim, locus or flight.
    path : str
        Scenario, as `load_scenario` takes it.
    changes : mapping
        As `load_scenario` takes them.
    options : mapping
        Of a locus: name, low, high (each a number and its unit), points, unit (SI, to which both are converted).
    report : callable
        See `Report`.

    Returns
    -------
    dict
        Numbers in SI, tensions [N], lengths [m], times [s], eigenvalues [1/s], but angles [deg] and rates of turn
        [deg/s]; figures as plotly's JSON, a replay as a page [gzip].

    Raises
    ------
    ConfigError
        Wrong input.
    SolveError
        There is no answer.
    """
    report("reading the scenario", None)
    scenario = load_scenario(path, changes)
    work: Callable[..., dict[str, Any]] = {"trim": _trim, "locus": _locus, "flight": _flight}[view]
    return work(scenario, options, report)


def _trim(scenario: Scenario, options: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """Return the equilibrium."""
    from tethership.analysis import TrimOutcome, trim

    report("looking for the equilibrium", None)
    point = trim(scenario)
    config = scenario.config
    report("drawing", None)
    from tethership.explorer.trim_figure import trim_figure

    values = np.asarray(point.state.as_vector())
    angular = (*ANGLES, *RATES)
    state = {
        name: float(np.degrees(v)) if name in angular else float(v) for name, v in zip(STATE_NAMES, values, strict=True)
    }
    return {
        "title": config.title,
        "outcome": point.outcome.name,
        "message": point.message,
        "warnings": list(point.warnings),
        "answer": point.outcome is TrimOutcome.converged,
        "saturated": list(point.saturated),
        "state": state,
        "throttle": {t.name: float(d) for t, d in zip(config.vehicle.thrusters, point.command.throttle, strict=True)},
        "nominal": {t.name: t.nominal_thrust for t in config.vehicle.thrusters},
        "tension": {c.name: float(t) for c, t in zip(config.cables, point.tension, strict=True)},
        "breaking": {c.name: c.breaking_force for c in config.cables},
        "residual": np.asarray(point.residual).tolist(),
        "wind": config.wind.speed,
        "figure": trim_figure(scenario, point) if point.outcome.is_balanced else None,
    }


def _locus(scenario: Scenario, options: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """Return the root locus along a parameter and the modes of the scenario itself."""
    from tethership.analysis import linearize, sweep, trim
    from tethership.analysis.loci import sweep_warnings

    name, points = options["name"], int(options["points"])
    low, high = (converted(value, unit, options["unit"]) for value, unit in (options["low"], options["high"]))
    report(f"trimming and linearising {points} points", None)
    found = sweep(scenario, {name: np.linspace(low, high, points)})
    report("modes of the chosen scenario", None)
    point = trim(scenario)
    own = linearize(scenario, point).modes() if point.outcome.is_balanced else None
    if not found.trimmed.any() and own is None:
        return {"title": scenario.config.title, "answer": False, "message": found.outcomes[0].value, "figure": None}
    report("drawing", None)
    from tethership.explorer.locus_figure import locus_figure

    factor = 180.0 / math.pi if found.units[name] == "rad" else 1.0
    return {
        "title": scenario.config.title,
        "answer": True,
        "trimmed": int(found.trimmed.sum()),
        "points": points,
        "message": "" if found.trimmed.all() else next(o.value for o in found.outcomes if o.name != "converged"),
        "figure": locus_figure(found, own),
        "modes": [] if own is None else [_mode(mode) for mode in own.modes],
        "own": point.message,
        "warnings": [*sweep_warnings(found), *point.warnings],
        "events": [
            {
                "kind": event.kind,
                "tracks": list(event.tracks),
                "at": event.at[name] * factor,
                "eigenvalue": [event.eigenvalue.real, event.eigenvalue.imag],
            }
            for event in found.events
        ],
        "unit": "deg" if found.units[name] == "rad" else found.units[name],
    }


def _mode(mode: Any) -> dict[str, Any]:
    """Return one mode."""
    return {
        "name": mode.name,
        "eigenvalue": [float(mode.eigenvalue.real), float(mode.eigenvalue.imag)],
        "frequency": mode.frequency,
        "damping": mode.damping,
        "period": mode.period,
        "half_or_double_time": mode.half_or_double_time,
        "stable": mode.stable,
        "null": mode.null,
    }


def _flight(scenario: Scenario, options: Mapping[str, Any], report: Report) -> dict[str, Any]:
    """Return a flight's metrics and histories, and the page that replays it in space, packed."""
    from tethership.analysis import trim
    from tethership.simulation import dock, verdict

    report("looking for the equilibrium", None)
    point = trim(scenario)
    if not point.outcome.is_start:
        return {"title": scenario.config.title, "answer": False, "message": point.message, "figure": None}
    limit = scenario.config.stop.time_limit
    report("preparing the flight", 0.0)
    flight = dock(
        scenario,
        point,
        progress=lambda time: report(f"flying: {time:.0f} s of at most {limit:g} s", time / limit),
    )
    if flight.data.sizes["time"] < 2:
        raise ConfigError(f"the flight ended at its start: {flight.outcome.value}")
    report("drawing", 1.0)
    from tethership.explorer.plain import plain_figure
    from tethership.view.flight import interactive_histories
    from tethership.view.replay import replay_text

    start = [f"The start is no equilibrium. {point.message}"] if point.saturated else []
    return {
        "title": scenario.config.title,
        "answer": flight.outcome.is_answer,
        "outcome": flight.outcome.name,
        "message": flight.outcome.value,
        "verdict": verdict(flight, digits=2),
        "reserved": bool(flight.reservations),
        "warnings": [*start, *flight.warnings],
        "time": float(flight.data["time"][-1]),
        "metrics": {
            key: value.tolist() if hasattr(value, "tolist") else value for key, value in flight.metrics.items()
        },
        "limits": list(flight.attributes["limits"]),
        "layers": list(flight.attributes["layers"]),
        "sas": flight.attributes["sas"],
        "steps": flight.attributes["steps"],
        "cables": len(scenario.config.cables),
        "figure": plain_figure(interactive_histories(flight, "").update_layout(margin_t=45)),
        "replay": gzip.compress(replay_text(flight).encode(), compresslevel=1),
    }
