"""What a scenario file may say about control laws; the paper's gains are the defaults.

Depends on: scenario.quantity.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, Literal

from pydantic import Field, field_validator, model_validator

from tethership.errors import suggestion
from tethership.scenario.names import check_apart
from tethership.scenario.own_schema import OwnLawConfig
from tethership.scenario.quantity import Quantity, Table

LAYERS = ("rewind", "heading", "navigation")
"""Names that `layers` may hold; SAS/attitude is always on unless switched off."""

Share = dict[str, float]
"""Throttle per unit of demand, by the name of the thruster."""


def check_layers(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names of the layers, or raise ValueError that offers the nearest known one."""
    chosen = tuple(names)
    for name in chosen:
        if name not in LAYERS:
            raise ValueError(f"unknown layer {name!r}{suggestion(name, LAYERS)} Allowed: {', '.join(LAYERS)}")
        if chosen.count(name) > 1:
            raise ValueError(f"layer {name!r} is named twice; name each layer once")
    return chosen


class AttitudeConfig(Table):
    """Gains of SAS/attitude, Table A.1 of the paper; shares as Eq. 40, the ratio of arms by its modulus, ½·9.07/2.0.

    Attributes
    ----------
    roll_rate_gain, pitch_rate_gain, yaw_rate_gain : float
        κ_p, κ_q, κ_r [s/rad].
    roll_gain, pitch_gain : float
        κ_φ, κ_θ [1/rad].
    roll_target, pitch_target : float
        φ̄, θ̄ [rad].
    roll_share, pitch_share, yaw_share : dict of str to float
        Throttle [-] of each thruster, or deflection of each fin [rad], per unit of demand, by its name.
    """

    roll_rate_gain: Annotated[float, Quantity("s/rad")] = 2.0
    pitch_rate_gain: Annotated[float, Quantity("s/rad")] = 1.0
    yaw_rate_gain: Annotated[float, Quantity("s/rad")] = 5.0
    roll_gain: Annotated[float, Quantity("1/rad")] = 0.5
    pitch_gain: Annotated[float, Quantity("1/rad")] = 0.5
    roll_target: Annotated[float, Quantity("rad")] = 0.0
    pitch_target: Annotated[float, Quantity("rad")] = 0.0
    roll_share: Share = Field(default_factory=dict)
    pitch_share: Share = Field(default_factory=dict)
    yaw_share: Share = Field(default_factory=dict)


class RewindConfig(Table):
    """Gains of the rewind law, Table A.2 of the paper.

    Attributes
    ----------
    gain : float
        κ_Ψ, loss of rewind rate per tension above the threshold [m/(s N)].
    threshold : float
        F′, tension at the tether point above which the winch slows down [N].
    slowest_rate : float
        Ψ_min, below which the law does not slow it [m/s].
    """

    gain: Annotated[float, Quantity("m/(s N)")] = 0.005
    threshold: Annotated[float, Quantity("N", low=0.0)] = 144.3
    slowest_rate: Annotated[float, Quantity("m/s")] = 0.01


class HeadingConfig(Table):
    """Gains of the heading law, Table A.3 of the paper.

    Attributes
    ----------
    gain : float
        κ_χ [1/rad].
    fade_radius : float
        Horizontal distance from anchor to tether point within which the law fades out linearly [m]; 0 never fades.
    measured_behind : float
        How far aft of the tether point, along the hull's axis, χ is measured [m].
    angle : str
        The law acts on χ itself (`full`), on arcsin sin χ (`sine`) or on the angle to the line, either way round
        (`line`).
    share : dict of str to float
        Throttle [-] of each thruster, or deflection of each fin [rad], per unit of demand, by its name.
    """

    gain: Annotated[float, Quantity("1/rad")] = 5.0
    fade_radius: Annotated[float, Quantity("m", low=0.0)] = 0.0
    measured_behind: Annotated[float, Quantity("m")] = 0.0
    angle: Literal["full", "sine", "line"] = "full"
    share: Share = Field(default_factory=dict)


class NavigationConfig(Table):
    """Gains of the navigation law, Table A.4 of the paper.

    Attributes
    ----------
    position_gain, vertical_gain : float
        κ_hor, κ_ver [1/m].
    speed_gain, climb_gain : float
        κ_U, κ_RoC [s/m].
    speed_slope : float
        Set-points of speed and climb per metre of error [1/s].
    largest_speed, largest_climb : float
        Bounds of these set-points [m/s].
    range : str
        The error ahead: along the nose, or the whole horizontal distance.
    forward_share, vertical_share : dict of str to float
        Throttle [-] of each thruster, or deflection of each fin [rad], per unit of forward and downward demand.
    """

    position_gain: Annotated[float, Quantity("1/m")] = 0.0033
    vertical_gain: Annotated[float, Quantity("1/m")] = 0.0033
    speed_gain: Annotated[float, Quantity("s/m")] = 0.033
    climb_gain: Annotated[float, Quantity("s/m")] = 0.033
    speed_slope: Annotated[float, Quantity("1/s", low=0.0)] = 0.1
    largest_speed: Annotated[float, Quantity("m/s", low=0.0)] = 0.5
    largest_climb: Annotated[float, Quantity("m/s", low=0.0)] = 0.5
    range: Literal["along_nose", "line_of_sight"] = "along_nose"
    forward_share: Share = Field(default_factory=dict)
    vertical_share: Share = Field(default_factory=dict)


class ControlConfig(Table):
    """Which laws act and with what gains.

    With `gain_thrust` given, gains command thrust in multiples of it, not throttle: each thruster's throttle is then
    its share times gain_thrust over its own nominal thrust.

    With `period` given, the laws look once a period and what they ask is held until the next time (zero-order hold);
    with `delay` it takes effect so much later (computing time, at most a period). Without, they are continuous.
    `allocation` shares demands of one's own laws out among thrusters [-] and fins [rad], by name.
    """

    layers: tuple[str, ...] = ()
    sas: bool = True
    gain_thrust: Annotated[float, Quantity("N", positive=True)] | None = None
    period: Annotated[float, Quantity("s", positive=True, low=1e-4)] | None = None
    delay: Annotated[float, Quantity("s", low=0.0)] | None = None
    allocation: dict[str, Share] = Field(default_factory=dict)
    laws: tuple[OwnLawConfig, ...] = ()
    attitude: AttitudeConfig = AttitudeConfig()
    rewind: RewindConfig = RewindConfig()
    heading: HeadingConfig = HeadingConfig()
    navigation: NavigationConfig = NavigationConfig()

    @field_validator("layers")
    @classmethod
    def _known_layers(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        return check_layers(names)

    @field_validator("laws")
    @classmethod
    def _named_apart(cls, laws: tuple[OwnLawConfig, ...]) -> tuple[OwnLawConfig, ...]:
        check_apart((*LAYERS, "attitude", *(law.name for law in laws)), "laws")
        return laws

    @field_validator("delay")
    @classmethod
    def _none(cls, value: float | None) -> float | None:
        return value or None  # zero is what is left out

    @model_validator(mode="after")
    def _in_time(self) -> "ControlConfig":
        if self.delay is not None and (self.period is None or self.delay > self.period):
            within = "needs a period" if self.period is None else f"is beyond control.period {self.period:g} s"
            raise ValueError(f"delay {self.delay:g} s {within}; give a period at least as long")
        return self

    def check_period(self, time_limit: float, what: str = "stop.time_limit ") -> None:
        """Raise ValueError if the laws' period is longer than a flight of `time_limit` [s]: they look once then."""
        if self.period is not None and self.period > time_limit:
            raise ValueError(
                f"control.period {self.period:g} s is longer than the flight, {what}{time_limit:g} s; "
                "give a shorter period"
            )

    def shares(self) -> Iterator[tuple[str, Share]]:
        """Return all shares by their dotted names under `control`: throttles [-], deflections [rad] per unit."""
        for law in ("attitude", "heading", "navigation"):
            yield from ((f"{law}.{key}", share) for key, share in getattr(self, law) if isinstance(share, dict))
        yield from ((f"allocation.{demand}", share) for demand, share in self.allocation.items())

    def check_channels(self, known: Sequence[str]) -> None:
        """Raise ValueError if a share names a thruster or fin that the vehicle does not have."""
        for key, share in self.shares():
            for name in share:
                if name not in known:
                    raise ValueError(
                        f"control.{key} names the thruster {name!r}, which the vehicle does not have"
                        f"{suggestion(name, known)} It has: {', '.join(known) or 'none; remove the shares'}"
                    )
