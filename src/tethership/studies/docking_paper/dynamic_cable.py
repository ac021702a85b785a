"""A recorded flight's cable flown again as a dynamic line. Depends on: simulation, scenario, plant, spatial, MoorDyn.

The line's upper end follows the tether point of the flight, its lower end stays at the anchor, its unstretched length
follows the winch, its air is the wind at the cable's mid-point, gusts included. The motion is *prescribed*: a ship that
felt the dynamic line's tension would have moved otherwise. So this shows what tension the recorded motion needs, and
whether inertia, air drag of the sagging rope and waves along it add to the statics; not how a flight with a
dynamic cable would have gone on after its first snap.

The winch is at the anchor; MoorDyn shortens all segments alike. The momentum of the rope that runs into the winch is
left out: m Ψ², 0.02 N at the fastest rate.
"""

import math
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import xarray as xr
from scipy.interpolate import CubicHermiteSpline

from tethership.errors import ConfigError, SolveError
from tethership.plant import Cable
from tethership.scenario import from_document
from tethership.simulation import Flight
from tethership.spatial import rotation_matrix
from tethership.studies.docking_paper.moordyn_line import LineProperties, MoorDynLine, Vector

SEGMENTS = 20
"""Segments of the line."""

FRACTION = 0.5
"""Time step as a fraction of the longest stable one [-]."""

LOSS_FACTOR = 0.05
"""Loss of a stretched braided polyester rope at its first axial mode [-]; see `rope_damping`."""

MOST_STRAIN = 0.1
"""Strain beyond which the solution is called wrong [-]; the paper's rope breaks at 0.044."""

COUPLING = 1e-3
"""Longest step between two positions of the end [s]: a twentieth of an axial wave's way along 20 m of the rope."""

SETTLE = 20.0
"""Time for which the line hangs at the flight's first instant before it is moved [s]."""


class CableMotion(NamedTuple):
    """What is prescribed, at the flight's instants.

    Attributes
    ----------
    time : Float[Array, "n"]
        [s].
    span : CubicHermiteSpline
        Tether point from anchor over time, ground axes [m].
    length : Float[Array, "n"]
        Unstretched length [m].
    wind : Float[Array, "n 3"]
        At the mid-point, ground axes [m/s].
    density : float
        Of the air there, mean over the flight [kg/m³].
    """

    time: Vector
    span: CubicHermiteSpline
    length: Vector
    wind: Vector
    density: float


def flown_cable(flight: Flight, cable: int = 0) -> tuple[Cable, CableMotion]:
    """Return a flight's cable, rebuilt from its scenario, and its motion.

    Parameters
    ----------
    flight : Flight
        Recorded.
    cable : int
        Which of its cables, from 0.

    Returns
    -------
    tuple of Cable and CableMotion
        At the flight's instants [s]: tether point from anchor, ground axes [m], length [m], wind at the middle of the
        two, ground axes [m/s]; density, mean over the flight [kg/m³].

    Raises
    ------
    ConfigError
        The flight has no such cable.
    """
    if not 0 <= cable < flight.data.sizes["cable"]:
        raise ConfigError(f"the flight has {flight.data.sizes['cable']} cable(s); there is no cable {cable}")
    stored = flight.attributes
    plant = from_document(stored["scenario"], stored["scenario_name"]).system
    parts, air, data = plant.cables[cable], plant.environment, flight.data
    time, span = data["time"].to_numpy(), data["tether_offset"].to_numpy()[:, cable]
    middle = jnp.asarray(parts.anchor + 0.5 * span)
    spline = CubicHermiteSpline(time, span, _end_velocity(flight, parts.tether_point))
    wind = jax.vmap(air.wind_at)(middle, jnp.asarray(time))
    density = float(jnp.mean(jax.vmap(air.density_at)(middle)))
    return parts, CableMotion(time, spline, data["cable_length"].to_numpy()[:, cable], np.asarray(wind), density)


def _end_velocity(flight: Flight, tether_point: jax.Array) -> Vector:
    """Return the velocity of the tether point, ground axes [m/s]."""

    def at(attitude: jax.Array, velocity: jax.Array, rates: jax.Array) -> jax.Array:
        return rotation_matrix(attitude) @ (velocity + jnp.cross(rates, tether_point))

    states = (jnp.asarray(flight.data[name].to_numpy()) for name in ("attitude", "velocity", "rates"))
    return np.asarray(jax.vmap(at)(*states))


def rope_damping(stiffness: float, mass: float, length: float, loss_factor: float = LOSS_FACTOR) -> float:
    """Return the damping within a rope, BA [N s]: force per strain rate.

    Parameters
    ----------
    stiffness, mass, length : float
        EA [N], m [kg/m], L [m].
    loss_factor : float
        η [-], energy lost in a cycle over 2π times the energy stored.

    Notes
    -----
    A Kelvin–Voigt rope loses η = ω BA/EA; taken at its first axial mode, fixed at both ends, ω = π√(EA/m)/L. The
    paper says nothing of damping. Dry polyester ropes under tension lose a few per cent; 0.05 is taken, and it hardly
    matters: waves are short against a snap, so the damping acts on what rings after it.
    """
    return loss_factor * stiffness * length / (math.pi * math.sqrt(stiffness / mass))


def line_properties(cable: Cable, density: float, loss_factor: float = LOSS_FACTOR) -> LineProperties:
    """Return a cable of the plant as MoorDyn takes it; conversions in `moordyn_line`.

    Parameters
    ----------
    cable : Cable
        Of the plant.
    density : float
        ρ of the air [kg/m³].
    loss_factor : float
        η of `rope_damping` [-].
    """
    load = cable.load
    diameter, stiffness = float(load.diameter), float(cable.law.stiffness)
    mass = float(load.linear_density) + density * math.pi / 4.0 * diameter**2
    along, across = float(load.longitudinal_drag_coefficient), float(load.cross_flow_drag_coefficient)
    damping = rope_damping(stiffness, mass, float(cable.length), loss_factor)
    return LineProperties(diameter, mass, stiffness, damping, across + along, along / math.pi, density)


def dynamic_line(
    flight: Flight,
    cable: int = 0,
    segments: int = SEGMENTS,
    fraction: float = FRACTION,
    loss_factor: float = LOSS_FACTOR,
    until: float = math.inf,
) -> xr.Dataset:
    """Return the tension of a dynamic line moved as a flight moved its cable.

    Parameters
    ----------
    flight : Flight
        Recorded.
    cable : int
        Which of its cables.
    segments : int
        Segments of the line.
    fraction : float
        Time step as a fraction of the longest stable one [-], which shrinks with the cable.
    loss_factor : float
        η of `rope_damping` [-].
    until : float
        Last instant [s].

    Returns
    -------
    xarray.Dataset
        At the flight's instants: `force` and `anchor_force` (of the line on ship and anchor, ground axes [N]),
        `tension` and `anchor_tension` [N], `tension_highest` [N], the highest tension since the last instant, and
        `time_step` [s].

    Raises
    ------
    ConfigError
        MoorDyn is not installed, or the flight has no such cable.
    SolveError
        MoorDyn met numbers that are not finite, or a line that is not where its ends are.
    """
    parts, motion = flown_cable(flight, cable)
    properties = line_properties(parts, motion.density, loss_factor)
    count = int(np.searchsorted(motion.time, until, side="right"))
    rows = _follow(properties, motion, count, segments, fraction)
    axes = ("time", "ground_axis")
    return xr.Dataset(
        {
            "force": (axes, rows["force"], {"units": "N"}),
            "anchor_force": (axes, rows["anchor_force"], {"units": "N"}),
            "tension": ("time", np.linalg.norm(rows["force"], axis=1), {"units": "N"}),
            "anchor_tension": ("time", np.linalg.norm(rows["anchor_force"], axis=1), {"units": "N"}),
            "tension_highest": ("time", rows["highest"], {"units": "N"}),
            "time_step": ("time", rows["time_step"], {"units": "s"}),
        },
        {"time": ("time", motion.time[:count], {"units": "s"}), "ground_axis": ["north", "east", "down"]},
        {**properties._asdict(), "segments": segments, "fraction": fraction},
    )


def _settled(line: MoorDynLine, motion: CableMotion, step: float) -> None:
    """Let the line hang in the first wind with its ends at rest; raise SolveError if it still moves."""
    start = motion.span(motion.time[0])
    line.wind(motion.wind[0])
    steps = max(int(SETTLE / max(20.0 * COUPLING, step)), 1)
    pulls = [np.linalg.norm(line.step(start, start, SETTLE / steps)) for _ in range(steps)]
    last = np.asarray(pulls[-steps // 20 :])
    if not np.ptp(last) < 0.05 * last.mean():
        raise SolveError(f"the line does not come to rest: its tension still moves by {np.ptp(last):.3g} N")


def _follow(
    properties: LineProperties, motion: CableMotion, count: int, segments: int, fraction: float
) -> dict[str, Vector]:
    """Return force, anchor force, highest tension and time step at the first instants of a motion."""
    time, length = motion.time, motion.length
    rows = {"force": np.zeros((count, 3)), "anchor_force": np.zeros((count, 3))}
    rows |= {"highest": np.zeros(count), "time_step": np.zeros(count)}
    step = fraction * properties.stable_time_step(length[0] / segments)
    with MoorDynLine(properties, motion.span(time[0]), float(length[0]), segments, step) as line:
        _settled(line, motion, step)
        for i in range(count):
            step = fraction * properties.stable_time_step(length[min(i + 1, count - 1)] / segments)
            forces = _interval(line, motion, i, step)
            _check(line, forces, float(time[i]))
            rows["force"][i], rows["anchor_force"][i] = forces[-1], line.anchor_force
            rows["highest"][i] = np.linalg.norm(forces, axis=1).max()
            rows["time_step"][i] = step
        if not abs(line.length - length[count - 1]) < 1e-6 * length[0]:
            raise SolveError(f"MoorDyn's winch left {line.length:.6f} m of cable, not {length[count - 1]:.6f} m")
    return rows


def _interval(line: MoorDynLine, motion: CableMotion, i: int, step: float) -> Vector:
    """Move the line from instant i − 1 to i; return the forces on the way [N]."""
    time = motion.time
    if i == 0:
        start = motion.span(time[0])
        return line.step(start, start, COUPLING)[None]
    duration = float(time[i] - time[i - 1])
    line.time_step(step)
    line.rewind(float(motion.length[i - 1] - motion.length[i]) / duration)
    line.wind(0.5 * (motion.wind[i - 1] + motion.wind[i]))
    parts = max(math.ceil(duration / max(COUPLING, step) - 1e-9), 1)
    places = motion.span(np.linspace(time[i - 1], time[i], parts + 1))
    return np.stack([line.step(places[k], places[k + 1], duration / parts) for k in range(parts)])


def _check(line: MoorDynLine, forces: Vector, time: float) -> None:
    """Raise SolveError for what cannot be: forces that are not finite, a node out of reach of its rope."""
    nodes = line.nodes()
    reach = (1.0 + MOST_STRAIN) * np.linspace(0.0, line.length, len(nodes))
    if not (np.isfinite(forces).all() and np.all(np.linalg.norm(nodes, axis=1) <= reach)):
        raise SolveError(f"MoorDyn's rope is torn or stretched past reason at {time:.3f} s; lower `fraction`")


__all__ = ["CableMotion", "dynamic_line", "flown_cable", "line_properties", "rope_damping"]
