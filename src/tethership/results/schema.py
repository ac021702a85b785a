"""Every output of a flight: name, unit, dimensions, frame and meaning. Depends on nothing."""

from typing import NamedTuple

BODY = ("forward", "starboard", "down")
"""Labels of body axes."""

GROUND = ("north", "east", "down")
"""Labels of ground axes."""

ANGLES = ("roll", "pitch", "yaw")
"""Labels of Euler angles."""

REGIMES = ("slack", "joint", "taut")
"""Meanings of the values of `regime`."""

FORMAT = 2
"""Version of the layout of netCDF files; a file of a later layout is refused."""

UNSEALED = 1
"""Layout of tethership 0.1: the same without checksums; it is read with a warning."""

HEAD = ("kind", "format", "tethership_version")
"""Attributes of every netCDF file of this package."""

ATTRIBUTES: dict[str, str] = {
    "outcome": "why the flight ended",
    "steps": "steps of the integrator",
    "layers": "layers of control that acted",
    "own_laws": "names of laws of one's own",
    "sas": "whether SAS/attitude acted",
    "formulation": "consistent or published",
    "line": "model of each cable's line, by the cable's name",
    "limits": "tensions that are watched [N]: control threshold, envelope's tear and tensile force, weakest cable",
    "scenario_name": "packaged name or file",
    "scenario": "the scenario as read, vehicle and changes included",
    "solver": "settings of the integrator",
    "stop": "what was to end it: time limit [s], docking length [m] or none, pitch [rad], ground; winches on or off",
    "trim": "trimmed state, throttles and deflections",
    "versions": "of this package and those it computes with",
}
"""Attributes of a flight, each as JSON: its whole input, and how it ended."""


class Variable(NamedTuple):
    """One output.

    Attributes
    ----------
    unit : str
        SI unit.
    dims : tuple of str
        Dimensions after `time`.
    meaning : str
        What it is.
    frame : str
        Axes of its components, or nothing.
    """

    unit: str
    dims: tuple[str, ...]
    meaning: str
    frame: str = ""


class Kind(NamedTuple):
    """A kind of netCDF file.

    Attributes
    ----------
    name : str
        What such a file says it is.
    attributes : tuple of str
        Its own attributes besides `HEAD`.
    verb : str
        What one does to have such a file again.
    """

    name: str
    attributes: tuple[str, ...]
    verb: str = "make"

    @property
    def own(self) -> tuple[str, ...]:
        """All attributes that are this package's, and have a checksum."""
        return (*HEAD, *self.attributes)


FLIGHT = Kind("tethership flight", tuple(ATTRIBUTES), "fly")
LINEAR_MODEL = Kind("tethership linear model", ("attributes",))

VARIABLES: dict[str, Variable] = {
    "velocity": Variable("m/s", ("body_axis",), "ground velocity of P", "body"),
    "rates": Variable("rad/s", ("body_axis",), "angular velocity", "body"),
    "attitude": Variable("rad", ("angle",), "Euler angles, 3-2-1"),
    "position": Variable("m", ("ground_axis",), "position of P from the origin (first anchor)", "ground"),
    "air_velocity": Variable("m/s", ("body_axis",), "velocity of B relative to that air", "body"),
    "wind": Variable("m/s", ("ground_axis",), "wind, gusts and ground effect at B", "ground"),
    "density": Variable("kg/m3", (), "density of the air at B"),
    "rate_of_climb": Variable("m/s", (), "upward ground velocity of B"),
    "throttle": Variable("1", ("thruster",), "throttle reached: after clipping, dead band, rate limit and lag"),
    "throttle_asked": Variable("1", ("thruster",), "throttle asked of it, after clipping"),
    "saturated": Variable("1", ("thruster",), "1 where a thruster is asked for more than it has"),
    "deflection": Variable("rad", ("fin",), "deflection reached: after clipping, rate limit and lag"),
    "deflection_asked": Variable("rad", ("fin",), "deflection asked of it, after clipping"),
    "deflection_saturated": Variable("1", ("fin",), "1 where a fin is asked for more than its limit"),
    "load_force": Variable("N", ("load", "body_axis"), "force of each named load", "body"),
    "load_moment": Variable("N m", ("load", "body_axis"), "moment of each named load about P", "body"),
    "cable_force": Variable("N", ("cable", "ground_axis"), "force of the cable on the ship", "ground"),
    "anchor_force": Variable("N", ("cable", "ground_axis"), "force of the cable on the anchor", "ground"),
    "tension": Variable("N", ("cable",), "tension at the tether point"),
    "tension_largest": Variable("N", ("cable",), "largest tension along the cable"),
    "cable_curve": Variable("m", ("cable", "cable_point", "ground_axis"), "points of the cable", "ground"),
    "cable_clearance": Variable("m", ("cable",), "height of the cable's lowest point above ground"),
    "tether_offset": Variable("m", ("cable", "ground_axis"), "tether point from anchor", "ground"),
    "distance": Variable("m", ("cable",), "distance from anchor to tether point"),
    "elongation": Variable("1", ("cable",), "distance over unstretched length"),
    "regime": Variable("1", ("cable",), "0 slack, 1 joint, 2 taut"),
    "cable_length": Variable("m", ("cable",), "unstretched length"),
    "rewind_rate": Variable("m/s", ("cable",), "rate at which the winch takes cable in"),
    "misalignment": Variable("rad", ("cable",), "horizontal angle from nose to anchor, positive to port"),
    "clearance": Variable("m", (), "height of the hull's lowest point above ground"),
}
"""Outputs of every flight by name; every one has `time` [s] as its first dimension."""

OWN_VARIABLES: dict[str, Variable] = {
    "part_states": Variable("its own unit", ("part_state",), "states of parts of one's own"),
    "readings": Variable("its own unit", ("reading",), "what parts of one's own tell the laws"),
}
"""Outputs of flights whose ship has parts of one's own."""

SINCE_LAYOUT_2 = ("deflection_saturated", "throttle_asked", "deflection_asked")
"""Outputs that files of layout 1 lack."""
