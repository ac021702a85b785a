"""What a scenario file may say of the wind: mean, gusts, turbulence. Depends on: scenario.quantity."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from tethership.scenario.quantity import Angle, Metres, Quantity, Seconds, Speed, Table, Vector


class UniformWindConfig(Table):
    """The same wind everywhere; `from_direction` [rad] is where it comes from, clockwise from north, `speed` [m/s]."""

    model: Literal["uniform"] = "uniform"
    speed: Speed
    from_direction: Angle = 0.0


class PowerLawWindConfig(Table):
    """Wind growing with height, V(h) = V_ref (h/h_ref)^α.

    Attributes
    ----------
    speed : float
        V_ref, at `reference_height` [m/s].
    from_direction : float
        Where it comes from, clockwise from north [rad].
    reference_height : float
        h_ref above ground [m].
    exponent : float
        α [-].
    lowest_height : float
        Height above ground below which the profile is constant [m].
    """

    model: Literal["power_law"]
    speed: Speed
    from_direction: Angle = 0.0
    reference_height: Metres
    exponent: Annotated[float, Quantity("1", low=0.0, high=1.0)]
    lowest_height: Metres = 0.5


class LogarithmicWindConfig(Table):
    """Wind of the neutral surface layer, V(h) = V_ref ln(h/z₀)/ln(h_ref/z₀).

    `speed` is V_ref [m/s], at `reference_height` h_ref above ground [m], `roughness` the length z₀ [m];
    `from_direction` is where it comes from, clockwise from north [rad].
    """

    model: Literal["logarithmic"]
    speed: Speed
    from_direction: Angle = 0.0
    reference_height: Metres
    roughness: Metres

    @model_validator(mode="after")
    def _above(self) -> "LogarithmicWindConfig":
        if self.reference_height <= self.roughness:
            raise ValueError(
                f"reference_height {self.reference_height:g} m must be above the roughness length {self.roughness:g} m"
            )
        return self


class MeasuredWindConfig(Table):
    """A measured history, the same everywhere; in a file it is given as `file`, a CSV or netCDF.

    `times` [s], shape (n,), and `velocities` of the air (north, east, down) [m/s], shape (n, 3), are what was read;
    `speed` [m/s] and `from_direction` [rad] are those of its mean over time and are not to be given by hand. `height`
    [m] stands beside `file` where that has several heights; `remarks` are what reading it left out, bridged or guessed.
    """

    model: Literal["measured"]
    speed: Speed
    from_direction: Angle
    height: Metres | None = None
    times: Annotated[np.ndarray, Quantity("s", depth=1, array=True)]
    velocities: Annotated[np.ndarray, Quantity("m/s", depth=2, array=True)]
    remarks: tuple[str, ...] = ()

    @model_validator(mode="after")
    def _samples(self) -> "MeasuredWindConfig":
        if self.velocities.shape != (len(self.times), 3) or len(self.times) < 4:
            raise ValueError(
                f"times {self.times.shape} and velocities {self.velocities.shape} must be (n,) and (n, 3), n at least 4"
            )
        if np.any(np.diff(self.times) <= 0):
            raise ValueError(f"times must rise; sample {int(np.argmax(np.diff(self.times) <= 0)) + 1} does not")
        return self

    @model_validator(mode="after")
    def _own_mean(self) -> "MeasuredWindConfig":
        level, duration = self.velocities[:, :2], self.times[-1] - self.times[0]
        mean = np.trapezoid(level, self.times, axis=0) / duration
        given = -self.speed * np.array([np.cos(self.from_direction), np.sin(self.from_direction)])
        older = level.mean(axis=0)  # flights stored by 0.1
        if not any(np.allclose(given, known, rtol=0.0, atol=1e-6) for known in (mean, older)):
            come, measured = (
                f"{np.hypot(*v):g} m/s from {np.degrees(np.arctan2(*-v[::-1])) % 360:.4g} deg" for v in (given, mean)
            )
            raise ValueError(f"{come} is not the measured mean, {measured}; leave it out, or take a uniform wind")
        return self


AnyWindConfig = UniformWindConfig | PowerLawWindConfig | LogarithmicWindConfig | MeasuredWindConfig
"""Every model of the mean wind."""

WindConfig = Annotated[AnyWindConfig, Field(discriminator="model")]


class GustConfig(Table):
    """A gust whose peak is a `fraction` of the mean wind's speed [-], or a `speed` [m/s].

    It comes from `from_direction`, clockwise from north, rises at `upward_angle` [rad], begins at `start` and lasts
    `period` [s]. `shape` is one pulse ½A(1 − cos), those pulses `repeated` to the end, or one period of a bare
    `cosine`, which begins and ends with a jump. One pulse may `turn` about the vertical while it lasts, clockwise seen
    from above [rad].
    """

    fraction: Annotated[float, Quantity("1", low=0.0)] | None = None
    speed: Speed | None = None
    from_direction: Angle
    upward_angle: Angle = 0.0
    start: Annotated[float, Quantity("s", low=0.0)]
    period: Seconds
    shape: Literal["one_minus_cosine", "repeated", "cosine"] = "one_minus_cosine"
    turn: Angle = 0.0

    @model_validator(mode="after")
    def _one_amplitude(self) -> "GustConfig":
        if (self.fraction is None) == (self.speed is None):
            raise ValueError("give either fraction (of the wind) or speed, not both and not neither")
        return self

    @model_validator(mode="after")
    def _turning(self) -> "GustConfig":
        if self.turn != 0.0 and self.shape != "one_minus_cosine":
            raise ValueError(f"a gust of shape {self.shape!r} cannot turn; take out turn or use one_minus_cosine")
        return self


class TurbulenceConfig(Table):
    """Continuous turbulence about the mean wind, as a record made from `seed`.

    Scales and intensities are those of MIL-F-8785C below 1000 ft at `height` above ground [m], the intensities times
    `intensity` [-]; `lengths` L [m] and `deviations` σ [m/s] (along the wind, across, vertical) replace them.
    `averaged` takes the mean over the hull's length, with `gradients` the hull feels the difference from nose to tail
    too.
    """

    spectrum: Literal["dryden", "von_karman"] = "dryden"
    seed: Annotated[float, Quantity("1", low=0.0, high=2.0**31 - 1)] = 1.0
    height: Metres = 6.096
    intensity: Annotated[float, Quantity("1", low=0.0)] = 1.0
    lengths: Annotated[Vector, Quantity("m", depth=1, positive=True)] | None = None
    deviations: Annotated[Vector, Quantity("m/s", depth=1, low=0.0)] | None = None
    averaged: bool = True
    gradients: bool = False

    @model_validator(mode="after")
    def _waves_longer_than_the_hull(self) -> "TurbulenceConfig":
        if self.gradients and not self.averaged:
            raise ValueError("gradients are those of the air averaged over the hull; leave averaged = true")
        return self

    @model_validator(mode="after")
    def _whole_seed(self) -> "TurbulenceConfig":
        if self.seed != int(self.seed):
            raise ValueError(f"seed {self.seed:g} must be a whole number")
        if (self.lengths is None) != (self.deviations is None):
            raise ValueError("give lengths and deviations together, or neither for those of MIL-F-8785C")
        return self
