"""From a validated vehicle to the modules of the ship. Depends on: plant, physics, scenario.vehicle_schema.

Everything is written with jax.numpy, so that a ship can be differentiated with respect to its numbers.
"""

from collections.abc import Sequence
from functools import partial

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics import (
    QUICK,
    AbstractApparentMass,
    AbstractEnvelope,
    Actuators,
    BodyOfRevolution,
    Buoyancy,
    ConsistentEnvelope,
    Fins,
    Gravity,
    KirchhoffApparentMass,
    LambFactors,
    PublishedApparentMass,
    PublishedEnvelope,
    RigidBody,
    SliceIntegrals,
    Strips,
    Thrusters,
    ellipsoid,
    gertler,
    gertler_from_shape,
    lamb1932,
)
from tethership.plant import Airship
from tethership.scenario.vehicle_schema import (
    EllipsoidHull,
    FinConfig,
    GertlerHull,
    HullConfig,
    LambConfig,
    ThrusterConfig,
    VehicleConfig,
)

STRIPS = 16
"""Strips of the cross-flow drag, nose to l_h: 5e-12 of ∫2r, 3e-5 of ∫2r|x|³ with its kink at B."""

OUTLINE = 41
"""Stations at which the hull's outline is kept for clearance and drawing."""


def build_hull(config: HullConfig) -> BodyOfRevolution:
    """Return the hull's shape: a body of revolution of length L and largest diameter D [m], by any profile."""
    length, diameter = jnp.asarray(config.length), jnp.asarray(config.diameter)
    match config:
        case GertlerHull():
            return gertler(length, diameter, jnp.array(config.coefficients))
        case EllipsoidHull():
            return ellipsoid(length, diameter)
        case _:
            return gertler_from_shape(
                length,
                diameter,
                jnp.asarray(config.largest_section),
                jnp.asarray(config.nose_radius),
                jnp.asarray(config.tail_radius),
                jnp.asarray(config.prismatic_coefficient),
            )


def _factors(config: VehicleConfig) -> tuple[LambFactors, Array]:
    """Return Lamb's factors [-] and the squared radii of gyration about pitch and yaw [m²]."""
    apparent = config.apparent_mass
    if isinstance(apparent, LambConfig):
        fineness = config.hull.length / config.hull.diameter if apparent.fineness is None else apparent.fineness
        gyration = (config.hull.length**2 + config.hull.diameter**2) / 20.0
        return lamb1932(jnp.asarray(fineness)), jnp.stack([jnp.asarray(gyration)] * 2)
    factors = LambFactors(*map(jnp.asarray, (apparent.k1, apparent.k2, apparent.k_rotational)))
    return factors, jnp.asarray(apparent.gyration_radius_squared)


def _apparent_mass(config: VehicleConfig, formulation: str, centre: Float[Array, "3"]) -> AbstractApparentMass:
    factors, gyration = _factors(config)
    volume = jnp.asarray(config.buoyancy.volume)
    kind = KirchhoffApparentMass if formulation == "consistent" else PublishedApparentMass
    return kind(
        volume=volume,
        centre=centre,
        translational=volume * jnp.stack([factors.axial, factors.lateral, factors.lateral]),
        rotational=volume
        * jnp.stack([jnp.zeros(()), factors.rotational * gyration[0], factors.rotational * gyration[1]]),
    )


def slice_integrals(
    hull: BodyOfRevolution, centre: Float[Array, ""], start: Float[Array, ""], end: Float[Array, ""]
) -> SliceIntegrals:
    """Return the integrals of the hull between two stations [m] about the station `centre` [m].

    Notes
    -----
    ∫A_x xⁿ dx over the part, by parts: −[A xⁿ] from nose side to tail side … − n∫A xⁿ⁻¹ dx.
    """
    area = jnp.stack([hull.area_moment(n, centre, start, end) for n in range(3)])
    section_start = jnp.pi * hull.radius_squared(start)
    section_end = jnp.pi * hull.radius_squared(end)
    forward, aft = centre - start, centre - end
    slope = jnp.stack(
        [section_start * forward**n - section_end * aft**n - (n * area[n - 1] if n else 0.0) for n in range(3)]
    )
    return SliceIntegrals(area, slope)


def _envelope(
    config: VehicleConfig, hull: BodyOfRevolution, formulation: str, centre: Float[Array, "3"]
) -> AbstractEnvelope:
    factors, _ = _factors(config)
    station = hull.centre()
    nose, cut, tail = jnp.zeros(()), jnp.asarray(config.envelope.potential_length), hull.length
    strips = hull.strips(nose, cut, STRIPS)
    reference_area = jnp.asarray(config.buoyancy.volume) ** (2.0 / 3.0)
    kind = ConsistentEnvelope if formulation == "consistent" else PublishedEnvelope
    drag = config.envelope
    isotropic = None if drag.drag_coefficient is None else 0.25 * jnp.pi * hull.diameter**2 * drag.drag_coefficient
    axial, cross_flow = (
        0.0 if c is None else c for c in (drag.axial_drag_coefficient, drag.cross_flow_drag_coefficient)
    )
    return kind(
        centre=centre,
        munk_factor=factors.lateral - factors.axial,
        front=slice_integrals(hull, station, nose, cut),
        tail=slice_integrals(hull, station, cut, tail),
        slice_efficiency=jnp.asarray(config.envelope.slice_efficiency),
        strip_position=station - strips.station,
        strip_area=2.0 * strips.radius * strips.width,
        cross_flow_drag_coefficient=jnp.asarray(cross_flow),
        axial_drag_area=reference_area * axial,
        isotropic_drag_area=isotropic,
    )


def _fins(config: VehicleConfig, shift: Float[Array, "3"]) -> Fins:
    """Return the fins, positions from P."""
    fins = config.fins
    column = partial(_column, fins)
    roll = column("roll")
    span = jnp.stack([jnp.zeros_like(roll), jnp.cos(roll), jnp.sin(roll)], axis=1)
    normal = jnp.stack([jnp.zeros_like(roll), -jnp.sin(roll), jnp.cos(roll)], axis=1)
    axis = jnp.array([1.0, 0.0, 0.0])
    centre_line = jnp.asarray(config.buoyancy.centre) * jnp.array([0.0, 1.0, 1.0])
    base = centre_line + column("distance_from_axis")[:, None] * span - shift
    area = column("area")
    return Fins(
        aerodynamic_centre=base + column("aerodynamic_station")[:, None] * axis,
        cross_flow_centre=base + column("cross_flow_station")[:, None] * axis,
        normal=normal,
        lift_area=area * column("lift_slope") * column("efficiency"),
        cross_flow_area=area * column("cross_flow_drag_coefficient"),
        friction_area=area * column("axial_drag_coefficient"),
        largest_deflection=column("largest_deflection"),
    )


def _column(rows: tuple, key: str) -> Float[Array, "n"]:
    """Return one number of every row as an array."""
    return jnp.asarray([getattr(row, key) for row in rows], dtype=float)


def build_thrusters(config: VehicleConfig, shift: Float[Array, "3"]) -> Thrusters:
    """Return all thrusters of a vehicle, placed from a reference point that is `shift` [m] from the file's origin."""
    rows = config.thrusters
    lapse = [0.0 if row.speed_of_no_thrust is None else 1.0 / row.speed_of_no_thrust for row in rows]
    return Thrusters(
        position=jnp.asarray([row.position for row in rows], dtype=float).reshape(-1, 3) - shift,
        direction=jnp.asarray([row.direction for row in rows], dtype=float).reshape(-1, 3),
        nominal=_column(rows, "nominal_thrust"),
        lowest_throttle=jnp.asarray([-1.0 if row.reversible else 0.0 for row in rows], dtype=float),
        lapse=jnp.asarray(lapse, dtype=float),
    )


def build_actuators(rows: Sequence[ThrusterConfig] | Sequence[FinConfig]) -> Actuators:
    """Return what the channels of a vehicle do with what they are asked; one without lag and limit has no state.

    Parameters
    ----------
    rows : sequence of ThrusterConfig or of FinConfig
        With lag τ [s], rate limit [1/s for a throttle, rad/s for a deflection] and a thruster's dead band [-]. One with
        a rate limit alone follows with the lag `QUICK` [s].
    """
    slow = [i for i, row in enumerate(rows) if row.lag is not None or row.rate_limit is not None]
    bands = {i: band for i, row in enumerate(rows) if (band := getattr(row, "dead_band", None)) is not None}
    return Actuators(
        lag=jnp.asarray([QUICK if (lag := rows[i].lag) is None else lag for i in slow], dtype=float),
        rate_limit=jnp.asarray([jnp.inf if (most := rows[i].rate_limit) is None else most for i in slow], dtype=float),
        dead_band=jnp.asarray(list(bands.values()), dtype=float),
        slow=tuple(slow),
        banded=tuple(bands),
    )


def _body(config: VehicleConfig, shift: Float[Array, "3"]) -> RigidBody:
    """Return mass and inertia about P, by the parallel-axis theorem."""
    mass = jnp.asarray(config.body.mass)
    given = jnp.asarray(config.body.centre_of_gravity)
    centre = given - shift
    inertia = jnp.asarray(config.body.inertia) + mass * (_square(centre) - _square(given))
    return RigidBody(mass, centre, inertia)


def _square(point: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """Return |q|²I − q qᵀ [m²]."""
    return jnp.dot(point, point) * jnp.eye(3) - jnp.outer(point, point)


def build_ship(config: VehicleConfig, formulation: str, reference_point: Float[Array, "3"] | None = None) -> Airship:
    """Return the ship.

    Parameters
    ----------
    config : VehicleConfig
        A validated vehicle.
    formulation : str
        `consistent` or `published`.
    reference_point : Float[Array, "3"], optional
        P from the origin of the file's body axes [m]; the origin itself if not given.
    """
    shift = jnp.zeros(3) if reference_point is None else jnp.asarray(reference_point)
    hull = build_hull(config.hull)
    centre = jnp.asarray(config.buoyancy.centre) - shift
    body = _body(config, shift)
    outline = jnp.linspace(0.0, 1.0, OUTLINE) * hull.length
    radius = hull.radius(outline)
    width = jnp.full(OUTLINE, hull.length / (OUTLINE - 1))
    return Airship(
        body=body,
        gravity=Gravity(body.mass, body.centre),
        buoyancy=Buoyancy(jnp.asarray(config.buoyancy.volume), centre),
        apparent_mass=_apparent_mass(config, formulation, centre),
        envelope=_envelope(config, hull, formulation, centre),
        fins=_fins(config, shift),
        thrusters=build_thrusters(config, shift),
        outline=Strips(outline, radius, width),
        nose=centre + jnp.stack([hull.centre(), jnp.zeros(()), jnp.zeros(())]),
    )
