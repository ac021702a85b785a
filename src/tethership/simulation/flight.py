"""A flight: labelled data with its outcome. Depends on: simulation, results."""

import dataclasses
import functools
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from tethership.results import FLIGHT, VARIABLES, docking_metrics, netcdf, run_id, store, to_frame
from tethership.scenario import ScenarioConfig, validated
from tethership.simulation import trust
from tethership.simulation.header import check_header
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

    def __repr__(self) -> str:
        """Return what it is in a line; `data` shows the rest."""
        return f"<Flight: {self.outcome.name} after {float(self.data['time'][-1]):.4g} s>"

    @functools.cached_property
    def attributes(self) -> dict[str, Any]:
        """Input and versions, decoded."""
        return store.attributes_of(self.data)

    @property
    def metrics(self) -> dict[str, Any]:
        """Metrics of Tables 3–6 by the names of `results.docking_metrics`.

        Tensions [N], times [s], rewind rate [m/s], clearances [m], ADC [1/s], E [-]; θ_rms in degrees [°].
        """
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
