"""What a scenario file may say: air, ground, cables, start, laws, stop and limits. Depends on: scenario.quantity."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from tethership.results import LIMITS
from tethership.scenario.control_schema import ControlConfig
from tethership.scenario.names import Word, check_apart
from tethership.scenario.own_schema import OwnLine, foreign
from tethership.scenario.quantity import Angle, Metres, Quantity, Seconds, Speed, Table, Vector
from tethership.scenario.vehicle_schema import VehicleConfig
from tethership.scenario.wind_schema import GustConfig, TurbulenceConfig, WindConfig

Point = Annotated[Vector, Quantity("m", depth=1)]
Newtons = Annotated[float, Quantity("N", positive=True)]


class StandardAir(Table):
    """ISA troposphere, its origin `origin_altitude` above the sea [m], warmer by `temperature_offset` [K]."""

    model: Literal["isa"] = "isa"
    origin_altitude: Annotated[float, Quantity("m", low=-1000.0, high=10_000.0)] = 0.0
    temperature_offset: Annotated[float, Quantity("K", low=-80.0, high=80.0)] = 0.0


class ConstantAir(Table):
    """The same density ρ everywhere [kg/m³]."""

    model: Literal["constant"]
    density: Annotated[float, Quantity("kg/m^3", low=0.0)]


AirConfig = Annotated[StandardAir | ConstantAir, Field(discriminator="model")]


class GroundConfig(Table):
    """The ground: `anchor_height` [m] below the origin (the first anchor); without it at the lowest anchor.

    `effect_coefficient` c [1/m] is that of the ground effect: upward air of c times ground speed times height [m/s].

    With `anchor_height` given (a mast), a hull that touches the ground ends the flight; without it the least clearance
    is only recorded and told. A trim whose hull lies below the ground is no equilibrium either way.
    """

    anchor_height: Annotated[float, Quantity("m", low=0.0)] | None = None
    effect_coefficient: Annotated[float, Quantity("1/m")] | None = None


class WinchConfig(Table):
    """The drive of a cable: its default rewind rate Ψ̄ [m/s], and the largest rate in either direction [m/s]."""

    rewind_rate: Speed
    fastest_rate: Speed

    @model_validator(mode="after")
    def _within(self) -> "WinchConfig":
        if self.rewind_rate > self.fastest_rate:
            raise ValueError(f"rewind_rate {self.rewind_rate:g} m/s is beyond fastest_rate {self.fastest_rate:g} m/s")
        return self


class SteadyMotionConfig(Table):
    """An anchor under way at constant velocity over the ground: a truck, a ship. It keeps its height.

    `velocity` is in ground axes: north, east, and 0 down [m/s].
    """

    model: Literal["steady"]
    velocity: Annotated[Vector, Quantity("m/s", depth=1)]

    @model_validator(mode="after")
    def _level(self) -> "SteadyMotionConfig":
        if self.velocity[2] != 0.0:
            raise ValueError(
                f"velocity has {self.velocity[2]:g} m/s down; an anchor under way keeps its height: give 0"
            )
        return self


class HarmonicMotionConfig(Table):
    """An anchor that swings about its place: amplitude · sin(2π t/period + phase). A ship is trimmed on its place.

    `amplitude` is along north, east, down [m], `period` in [s], `phase` in [rad].
    """

    model: Literal["harmonic"]
    amplitude: Point
    period: Seconds
    phase: Angle = 0.0


AnchorMotionConfig = Annotated[SteadyMotionConfig | HarmonicMotionConfig, Field(discriminator="model")]


class CatenaryLine(Table):
    """A line in equilibrium: the extensible catenary, one load per length from the chord."""

    model: Literal["catenary"]


class PublishedLine(Table):
    """The paper's line: catenary, joint and spring by its elongation e = |d|/L_t [-]."""

    model: Literal["published"]


def _line_kind(datum: Any) -> str:
    """Return which table a line is: by its model, one of one's own by the colon in it."""
    model = datum.get("model") if isinstance(datum, dict) else getattr(datum, "model", "")
    return "module:Class" if isinstance(model, str) and ":" in model else str(model)


LineConfig = Annotated[
    Annotated[CatenaryLine, Tag("catenary")]
    | Annotated[PublishedLine, Tag("published")]
    | Annotated[OwnLine, Tag("module:Class")],
    Discriminator(_line_kind),
]

LINES = {"consistent": "catenary", "published": "published"}
"""Line of each formulation, where a cable does not say its own."""


class CableConfig(Table):
    """One cable.

    Attributes
    ----------
    name : str
        Its name.
    tether_point : tuple of float
        TP from the origin of the vehicle's body axes, body axes [m].
    anchor : tuple of float
        x_AP, ground axes [m].
    length : float
        Unstretched length at the start L_t [m].
    diameter : float
        For drag [m].
    linear_density : float
        Mass per unstretched length [kg/m].
    stiffness : float
        EA, force per strain [N].
    breaking_force : float
        F_b [N].
    joint_start, joint_end : float
        e_c and e_e, elongations between which the paper's line has its joint [-].
    cross_flow_drag_coefficient, longitudinal_drag_coefficient : float
        C_dc, C_dl on the diameter [-].
    load_reference : float
        Where the airspeed of the cable's wind load is taken: a fraction of the span from the anchor [-].
    line : table, optional
        Model of its line; that of the formulation if left out.
    anchor_motion : table, optional
        How its anchor moves; it stands still if left out.
    winch : WinchConfig
        Its drive.
    """

    name: Word
    tether_point: Point
    anchor: Point
    length: Metres
    diameter: Annotated[float, Quantity("m", low=0.0)]
    linear_density: Annotated[float, Quantity("kg/m", low=0.0)]
    stiffness: Newtons
    breaking_force: Newtons
    joint_start: Annotated[float, Quantity("1", positive=True)]
    joint_end: Annotated[float, Quantity("1", positive=True)]
    cross_flow_drag_coefficient: Annotated[float, Quantity("1", low=0.0)]
    longitudinal_drag_coefficient: Annotated[float, Quantity("1", low=0.0)]
    load_reference: Annotated[float, Quantity("1", low=0.0, high=1.0)] = 0.5
    line: LineConfig | None = None
    anchor_motion: AnchorMotionConfig | None = None
    winch: WinchConfig

    def line_model(self, formulation: str) -> str:
        """Return the name of its line's model: its own, or that of the formulation."""
        return LINES[formulation] if self.line is None else self.line.model

    @model_validator(mode="after")
    def _joint(self) -> "CableConfig":
        if not self.joint_start < 1.0 <= self.joint_end:
            raise ValueError(
                f"joint_start {self.joint_start:g} and joint_end {self.joint_end:g} must be below and above 1"
            )
        return self


class TrimConfig(Table):
    """What is looked for and what is held when the flight's start is trimmed.

    `unknowns` are names of the motion's quantities (velocity_north, velocity_east, velocity_down, p, q, r, phi,
    theta, psi, north, east, down), of thrusters or fins, `throttle` (all thrusters) or `deflection` (all fins).
    `velocity` is that of P over the ground, with an anchor under way over that, in ground axes [m/s]; where `position`
    [m] or `attitude` [rad] are looked for, the search starts there. With `hold = "tether_point"` the first cable's
    tether point is put at `elongation` [-] times its length from the anchor, at `elevation` above the horizon and
    `bearing` clockwise from north [rad].

    A free ship in calm air may turn steadily: `turn_rate` is ψ̇ [rad/s], with φ, θ, speed and height constant.
    `pull_up_rate` is θ̇ [rad/s] of a pull-up, a balance of the instant. p, q, r follow from them.
    """

    hold: Literal["tether_point", "reference_point"] = "tether_point"
    unknowns: tuple[str, ...] = ("throttle",)
    elongation: Annotated[float, Quantity("1", positive=True)] | None = None
    elevation: Annotated[float, Quantity("rad", low=-1.5708, high=1.5708)] = 0.7853981633974483
    bearing: Angle = 3.141592653589793
    position: Point | None = None
    velocity: Annotated[Vector, Quantity("m/s", depth=1)] = (0.0, 0.0, 0.0)
    attitude: Annotated[Vector, Quantity("rad", depth=1)] = (0.0, 0.0, 0.0)
    turn_rate: Annotated[float, Quantity("rad/s", low=-1.0, high=1.0)] | None = None
    pull_up_rate: Annotated[float, Quantity("rad/s", low=-1.0, high=1.0)] | None = None


class StartConfig(Table):
    """How the flight's start differs from trim: by what is added to φ, θ, ψ [rad]; `hold` is the point that stays."""

    attitude_offset: Annotated[Vector, Quantity("rad", depth=1)] = (0.0, 0.0, 0.0)
    hold: Literal["tether_point", "reference_point"] = "tether_point"


class StopConfig(Table):
    """What ends a flight: unstretched cable length when docked [m], time limit [s], largest |θ| [rad]."""

    cable_length: Annotated[float, Quantity("m", positive=True)] = 1.5
    time_limit: Seconds = 200.0
    largest_pitch: Annotated[float, Quantity("rad", positive=True, high=1.55)] = 1.3962634015954636


class LimitsConfig(Table):
    """Tensions to be watched [N]; `cable_break` is that of the weakest cable, and needed only where there is none."""

    control_threshold: Newtons
    envelope_tear: Newtons
    envelope_tensile: Newtons
    cable_break: Newtons | None = None


class ScenarioConfig(Table):
    """A flight to be trimmed and flown."""

    title: Annotated[str, Field(max_length=200)]
    description: Annotated[str, Field(max_length=10_000)] = ""
    vehicle: VehicleConfig
    formulation: Literal["consistent", "published"] = "consistent"
    atmosphere: AirConfig = StandardAir()
    wind: WindConfig
    gusts: tuple[GustConfig, ...] = ()
    turbulence: TurbulenceConfig | None = None
    ground: GroundConfig = GroundConfig()
    cables: tuple[CableConfig, ...] = ()
    trim: TrimConfig = TrimConfig()
    start: StartConfig = StartConfig()
    control: ControlConfig = ControlConfig()
    stop: StopConfig = StopConfig()
    limits: LimitsConfig

    @model_validator(mode="after")
    def _whole(self) -> "ScenarioConfig":
        if self.trim.position is None and (not self.cables or self.trim.elongation is None):
            raise ValueError("trim needs a position, or a cable and an elongation")
        parts = (*self.vehicle.fins, *self.vehicle.thrusters, *self.cables)
        own = self.vehicle.parts
        kinds = "cables, fins, thrusters or parts" if own else "cables, fins or thrusters"
        check_apart((part.name for part in (*parts, *own)), kinds)
        weakest = min((cable.breaking_force for cable in self.cables), default=None)
        given = self.limits.cable_break
        if weakest is None and given is None:
            raise ValueError("limits.cable_break is missing, and there is no cable to take it from")
        if weakest is not None and given is not None and given != weakest:
            raise ValueError(
                f"limits.cable_break {given:g} N is not the breaking_force {weakest:g} N; leave it out of limits"
            )
        self.control.check_channels([part.name for part in (*self.vehicle.thrusters, *self.vehicle.fins)])
        rates = [name for name in ("turn_rate", "pull_up_rate") if getattr(self.trim, name) is not None]
        if rates and (self.cables or getattr(self.wind, "speed", 0.0) != 0.0):
            what = "without a cable" if self.cables else "in calm air (wind.speed 0)"
            raise ValueError(f"trim.{rates[0]}: only a free ship {what} turns steadily; leave it out")
        under_way = {
            cable.anchor_motion.velocity if isinstance(cable.anchor_motion, SteadyMotionConfig) else (0.0, 0.0, 0.0)
            for cable in self.cables
        }
        if len(under_way) > 1:
            raise ValueError("cables: anchors under way must all have the same velocity; give each the same")
        self.control.check_period(self.stop.time_limit)
        if not self.cables and set(self.control.layers) & {"rewind", "heading", "navigation"}:
            raise ValueError(f"layers {list(self.control.layers)} need a cable, and there is none")
        return self

    def turning(self) -> tuple[Any, Any, Any] | None:
        """Return the rates of φ, θ, ψ that the trim's manoeuvre has [rad/s]; None for none."""
        trim = self.trim
        if trim.turn_rate is None and trim.pull_up_rate is None:
            return None
        pitch, yaw = (0.0 if rate is None else rate for rate in (trim.pull_up_rate, trim.turn_rate))
        return (0.0, pitch, yaw)

    def watched_limits(self) -> dict[str, float]:
        """Return the four tensions that are watched [N] by the names of `results.limits`."""
        limits = self.limits
        weakest = min((cable.breaking_force for cable in self.cables), default=limits.cable_break)
        assert weakest is not None  # validated above
        watched = (limits.control_threshold, limits.envelope_tear, limits.envelope_tensile, weakest)
        return dict(zip(LIMITS, watched, strict=True))

    def watched_tensions(self) -> list[float]:
        """Return the four tensions that are watched [N]: control threshold, tear, envelope tensile, cable break."""
        return list(self.watched_limits().values())

    def line_models(self) -> dict[str, dict[str, str]]:
        """Return the model of each cable's line, by the cable's name."""
        return {cable.name: {"model": cable.line_model(self.formulation)} for cable in self.cables}

    def own_plant_code(self) -> list[str]:
        """Return the `module:Class` of all parts and lines that are not this package's own."""
        lines = [cable.line for cable in self.cables if isinstance(cable.line, OwnLine)]
        return foreign((*self.vehicle.parts, *lines))

    def own_code(self) -> list[str]:
        """Return the `module:Class` of all laws, parts and lines that are not this package's own."""
        return [*foreign(self.control.laws), *self.own_plant_code()]

    def has_ground(self) -> bool:
        """Return whether it is known where the ground is: at the height given, or below the lowest anchor."""
        return self.ground.anchor_height is not None or bool(self.cables)
