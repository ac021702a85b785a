"""A flight: flown segment by segment, kept as labelled data with its outcome. Depends on: simulation, results."""

import dataclasses
import functools
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
import xarray as xr
from jaxtyping import Array, Float

from tethership.results import docking_metrics, netcdf, store
from tethership.results.columns import to_frame
from tethership.results.schema import FLIGHT, VARIABLES
from tethership.results.seal import run_id
from tethership.scenario import ScenarioConfig
from tethership.scenario.load import validated
from tethership.scenario.solver import SolverConfig
from tethership.simulation import trust
from tethership.simulation.closed_loop import ClosedLoop
from tethership.simulation.events import MARGINS, StopConditions
from tethership.simulation.header import check_header
from tethership.simulation.integrate import SAMPLES, Segment, Stepping, fly_segment
from tethership.simulation.interrupt import Interruption
from tethership.simulation.outcome import Outcome

if TYPE_CHECKING:
    import pandas as pd

Progress = Callable[[float], None]
"""Called with the time reached [s] after each segment."""


@dataclasses.dataclass(frozen=True)
class Flight:
    """One flight; it stores no solver and nothing of it changes.

    Attributes
    ----------
    data : xarray.Dataset
        Outputs with units, and the full input in the attributes.
    outcome : Outcome
        Why it ended.
    """

    data: xr.Dataset
    outcome: Outcome

    @functools.cached_property
    def attributes(self) -> dict[str, Any]:
        """Input and versions, decoded."""
        return store.attributes_of(self.data)

    @property
    def metrics(self) -> dict[str, Any]:
        """Metrics of Tables 3–6, SI, θ_rms in degrees."""
        return self._metrics

    @functools.cached_property
    def _metrics(self) -> dict[str, Any]:
        arrays = {name: self.data[name].to_numpy() for name in VARIABLES if name in self.data}
        arrays["time"] = self.data["time"].to_numpy()
        return docking_metrics(arrays, self.attributes["limits"])

    @property
    def config(self) -> ScenarioConfig:
        """The scenario that was flown, validated; raises ConfigError where this version cannot read it."""
        return self._config

    @functools.cached_property
    def _config(self) -> ScenarioConfig:
        return validated(ScenarioConfig, self.attributes["scenario"], self.attributes["scenario_name"])

    @functools.cached_property
    def limits_passed(self) -> dict[str, float]:
        """For how long [s] each watched limit was passed, only those that were; names as `results.limits`."""
        return trust.seconds_passed(self)

    @functools.cached_property
    def reservations(self) -> tuple[str, ...]:
        """What the bare outcome would hide, a clause each: limits passed, hull below the ground, saturation."""
        return tuple(trust.reservations(self))

    @functools.cached_property
    def verdict(self) -> str:
        """How it ended and what must be said with it: "docked after 61.7 s, but …"."""
        return trust.verdict(self)

    @functools.cached_property
    def warnings(self) -> tuple[str, ...]:
        """What must be known before its numbers are used, besides the verdict: the ranges of its models."""
        return tuple(trust.warnings(self))

    @property
    def docking_time(self) -> float | None:
        """Time at which the ship was docked [s], None if it was not."""
        return float(self.data["time"][-1]) if self.outcome is Outcome.docked else None

    def to_frame(self) -> "pd.DataFrame":
        """Return all outputs as a pandas table: a row an instant, index `time [s]`, columns like `tension_nose [N]`.

        Notes
        -----
        SI and radians; the names are made as `results.columns` says.
        """
        return to_frame(self.data)

    @functools.cached_property
    def run(self) -> str:
        """Id of this flight in its file, picture and replay: a digest of its input and numbers."""
        return run_id(self.data, FLIGHT.own)

    def content(self) -> bytes:
        """Return the bytes of the flight's netCDF file."""
        return netcdf.content(self.data, FLIGHT)

    def save(self, path: str | Path) -> None:
        """Write the flight to netCDF; raises ConfigError where it cannot be written."""
        netcdf.write(self.data, Path(path), FLIGHT)

    @classmethod
    def load(cls, path: str | Path) -> "Flight":
        """Return the flight of a netCDF file.

        Raises
        ------
        ConfigError
            It is none, it is damaged, or its numbers were changed; what others added to the file is left alone.
        """
        data = netcdf.read(Path(path), FLIGHT)
        store.check_flight(data, str(path))
        attributes = store.attributes_of(data)
        check_header(attributes, str(path))
        return cls(data, Outcome[attributes["outcome"]])


@dataclasses.dataclass(frozen=True)
class Flown:
    """Raw samples of a flight.

    Attributes
    ----------
    arrays : dict
        Outputs by name, first axis time, `time` included.
    outcome : Outcome
    steps : int
        Steps of the integrator.
    """

    arrays: dict[str, np.ndarray]
    outcome: Outcome
    steps: int


def fly(
    loop: ClosedLoop,
    vector: Float[Array, "n"],
    stop: StopConditions,
    solver: SolverConfig,
    time_limit: float,
    progress: Progress | None = None,
) -> Flown:
    """Fly until something ends the flight; never raises for what nature or the solver does.

    Parameters
    ----------
    loop : ClosedLoop
        Plant, law and trimmed command.
    vector : Float[Array, "n"]
        Start, from `ClosedLoop.initial`.
    stop : StopConditions
        What ends it.
    solver : SolverConfig
        Settings.
    time_limit : float
        Longest flight [s].
    progress : callable, optional
        Called with the time reached.
    """
    stepping = Stepping.from_config(solver)
    interval = solver.output_interval
    pieces: list[dict[str, np.ndarray]] = []
    time, steps, outcome = 0.0, 0, None
    done = -1
    if progress is not None:  # compile first, so that the time of flying can be shown apart
        nowhere = jnp.asarray(1e-6), jnp.zeros(SAMPLES)
        jax.block_until_ready(fly_segment(loop, stop, stepping, jnp.asarray(0.0), vector, *nowhere))
        progress(0.0)
    with Interruption() as interruption:
        while outcome is None:
            times = (done + 1 + np.arange(SAMPLES)) * interval
            end = min(float(times[-1]), time_limit)
            segment = fly_segment(loop, stop, stepping, jnp.asarray(time), vector, jnp.asarray(end), jnp.asarray(times))
            segment = jax.device_get(segment)
            kept = _kept(segment)
            pieces.append(kept)
            done += len(kept["time"])
            time, vector = float(segment.time), jnp.asarray(segment.vector)
            steps += int(segment.steps)
            outcome = _outcome(segment, time, time_limit, steps, solver.most_steps, interruption.raised)
            if progress is not None:
                progress(time)
            if outcome is not None and outcome is not Outcome.diverged:
                pieces.append(_end(segment, pieces))
    arrays = {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}
    return Flown(arrays, outcome, steps)


def _kept(segment: Segment) -> dict[str, np.ndarray]:
    """Return the samples up to the time reached, and up to the last finite one."""
    times = np.asarray(segment.sample_times)
    within = times <= float(segment.time) + 1e-12
    finite = np.ones(len(times), dtype=bool)
    for name, value in segment.samples.items():
        if name != "cable_curve":
            finite &= np.isfinite(np.asarray(value).reshape(len(times), -1)).all(axis=1)
    count = int(np.argmin(within & finite)) if not (within & finite).all() else len(times)
    return {"time": times[:count], **{k: np.asarray(v)[:count] for k, v in segment.samples.items()}}


def _end(segment: Segment, pieces: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the sample at the very end, empty if a regular sample stands there already."""
    last_time = next((piece["time"][-1] for piece in reversed(pieces) if len(piece["time"])), -1.0)
    count = int(float(segment.time) > last_time + 1e-9)
    single = {"time": np.asarray(segment.time), **segment.last}
    return {name: np.asarray(value)[None][:count] for name, value in single.items()}


def _outcome(
    segment: Segment, time: float, time_limit: float, steps: int, most_steps: int, interrupted: bool
) -> Outcome | None:
    """Return why the flight ends here, or None."""
    if not bool(segment.finite):
        return Outcome.diverged
    if bool(segment.stopped):
        return MARGINS[int(np.argmin(np.asarray(segment.margins)))]
    if time >= time_limit - 1e-9:
        return Outcome.time_limit
    if interrupted:
        return Outcome.interrupted
    if steps >= most_steps:
        return Outcome.step_limit
    return None
