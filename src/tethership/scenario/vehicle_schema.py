"""What a vehicle file may say. Every number has a value, a unit and a source. Depends on: scenario.quantity."""

from typing import Annotated, Literal

import jax.numpy as jnp
import numpy as np
from pydantic import Field, field_validator, model_validator

from tethership.physics import USUAL_DEFLECTION, gertler_from_shape
from tethership.scenario.names import Part, check_apart
from tethership.scenario.own_schema import OwnPartConfig
from tethership.scenario.quantity import Matrix, Quantity, Table, Vector

Length = Annotated[float, Quantity("m", positive=True, sourced=True)]
Position = Annotated[Vector, Quantity("m", depth=1, sourced=True)]
Number = Annotated[float, Quantity("1", sourced=True)]
Positive = Annotated[float, Quantity("1", positive=True, sourced=True)]
Lag = Annotated[float, Quantity("s", low=0.0, high=60.0, sourced=True)]
NotNegative = Annotated[float, Quantity("1", low=0.0, sourced=True)]


class BodyConfig(Table):
    """Mass, centre of gravity and inertia.

    Attributes
    ----------
    mass : float
        m, lifting gas included [kg].
    centre_of_gravity : tuple of float
        G from the origin of the body axes, body axes [m].
    inertia : tuple of tuple of float
        J about the origin of the body axes, not about G, off-diagonal entries as in the matrix [kg m²].
    """

    mass: Annotated[float, Quantity("kg", positive=True, sourced=True)]
    centre_of_gravity: Position
    inertia: Annotated[Matrix, Quantity("kg m^2", depth=2, sourced=True)]

    @model_validator(mode="after")
    def _positive_definite(self) -> "BodyConfig":
        matrix = np.array(self.inertia)
        centre = np.array(self.centre_of_gravity)
        if not np.allclose(matrix, matrix.T):
            raise ValueError("inertia is not symmetric; give the matrix itself, entry J13 twice")
        about_g = matrix - self.mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        lowest = np.linalg.eigvalsh(about_g).min()
        if lowest <= 0:
            raise ValueError(
                f"inertia is not positive definite: about the centre of gravity its least principal moment is "
                f"{lowest:.4g} kg m²; check its entries (about the origin, in kg m²) and centre_of_gravity"
            )
        return self


class GertlerHull(Table):
    """Gertler hull by its length L and largest diameter D [m] and its six coefficients a₁ … a₆ [-].

    (r/D)² = Σ a_i Xⁱ with X = ξ/L from the nose; they add up to 0.
    """

    profile: Literal["gertler"]
    length: Length
    diameter: Length
    coefficients: Annotated[tuple[float, float, float, float, float, float], Quantity("1", depth=1, sourced=True)]


class GertlerShapeHull(Table):
    """Gertler hull by its shape parameters.

    Attributes
    ----------
    length, diameter : float
        L and largest diameter D [m].
    largest_section : float
        Station of the largest section over the length, m [-].
    nose_radius, tail_radius : float
        Radii of curvature at nose and tail times L/D², r₀ and r₁ [-].
    prismatic_coefficient : float
        Volume over that of the cylinder around the hull, C_p [-].
    """

    profile: Literal["gertler_shape"]
    length: Length
    diameter: Length
    largest_section: Positive
    nose_radius: NotNegative
    tail_radius: NotNegative
    prismatic_coefficient: Positive


class EllipsoidHull(Table):
    """Ellipsoid of revolution of a length L and a largest diameter D [m]."""

    profile: Literal["ellipsoid"]
    length: Length
    diameter: Length


HullConfig = Annotated[GertlerHull | GertlerShapeHull | EllipsoidHull, Field(discriminator="profile")]


class BuoyancyConfig(Table):
    """Displaced volume 𝒱 [m³] and its centre B, from the origin of the body axes, body axes [m]."""

    volume: Annotated[float, Quantity("m^3", positive=True, sourced=True)]
    centre: Position


class FactorsConfig(Table):
    """Apparent mass by published factors.

    Attributes
    ----------
    k1 : float
        Along the axis, over the displaced mass [-].
    k2, k3 : float
        Across it, over the displaced mass, both the same [-].
    k_rotational : float
        k′, apparent inertia over that of the displaced air as a rigid body [-].
    gyration_radius_squared : tuple of float
        Squared radii of gyration of the displaced air about the pitch and yaw axes at B, J₂ and J₃ [m²].
    """

    model: Literal["factors"]
    k1: NotNegative
    k2: NotNegative
    k3: NotNegative
    k_rotational: NotNegative
    gyration_radius_squared: Annotated[tuple[float, float], Quantity("m^2", depth=1, sourced=True)]

    @model_validator(mode="after")
    def _revolution(self) -> "FactorsConfig":
        if self.k2 != self.k3:
            raise ValueError(f"k2 = {self.k2} and k3 = {self.k3} differ; a body of revolution has k2 = k3")
        return self


class LambConfig(Table):
    """Apparent mass by Lamb's formulas from the hull's length over diameter [-], or a given fineness ratio [-]."""

    model: Literal["lamb"]
    fineness: Annotated[float, Quantity("1", positive=True, sourced=True)] | None = None


ApparentMassConfig = Annotated[FactorsConfig | LambConfig, Field(discriminator="model")]


SLENDER = 1.5
"""Length over diameter [-] from which the drag of a hull may be split into axial and cross-flow drag."""


class EnvelopeConfig(Table):
    """Hull loads besides apparent mass.

    Attributes
    ----------
    axial_drag_coefficient : float, optional
        C_Dh0 on the displaced volume to the power 2/3 [-].
    cross_flow_drag_coefficient : float, optional
        C_Dc on the local diameter [-].
    drag_coefficient : float, optional
        C_D on the frontal area, in place of these two, for a hull that is nearly a sphere [-].
    slice_efficiency : float
        η_k, factor on the potential flow ahead of l_h [-].
    potential_length : float
        l_h, from the nose to where the potential flow ends [m].
    """

    axial_drag_coefficient: NotNegative | None = None
    cross_flow_drag_coefficient: NotNegative | None = None
    drag_coefficient: NotNegative | None = None
    slice_efficiency: NotNegative
    potential_length: Length

    @model_validator(mode="after")
    def _one_drag(self) -> "EnvelopeConfig":
        split = [self.axial_drag_coefficient is not None, self.cross_flow_drag_coefficient is not None]
        if not (all(split) if self.drag_coefficient is None else not any(split)):
            raise ValueError(
                "give axial_drag_coefficient and cross_flow_drag_coefficient, or for a hull that is nearly a sphere "
                "drag_coefficient alone"
            )
        return self


class FinConfig(Table):
    """One fin.

    Its deflection follows what it is asked within `largest_deflection`, at most at `rate_limit`, with a first-order lag
    of time constant `lag`; what is left out is ideal.

    Attributes
    ----------
    name : str
        Its name.
    roll : float
        Roll angle of its span about the hull's axis: 0 starboard, ½π down [rad].
    area : float
        S [m²].
    lift_slope : float
        C_Nα, slope of the normal force [1/rad].
    efficiency : float
        η_f [-].
    cross_flow_drag_coefficient, axial_drag_coefficient : float
        C_Dc, C_D0 on its area [-].
    aerodynamic_station, cross_flow_station : float
        Where the attached normal force and the cross-flow drag act, forward of the origin of the body axes [m].
    distance_from_axis : float
        Of both points from the hull's axis [m].
    largest_deflection : float
        To either side [rad].
    lag : float, optional
        τ [s].
    rate_limit : float, optional
        Fastest change of the deflection [rad/s].
    """

    name: Part
    roll: Annotated[float, Quantity("rad", sourced=True)]
    area: Annotated[float, Quantity("m^2", positive=True, sourced=True)]
    lift_slope: Annotated[float, Quantity("1/rad", low=0.0, sourced=True)]
    efficiency: NotNegative
    cross_flow_drag_coefficient: NotNegative
    axial_drag_coefficient: NotNegative
    aerodynamic_station: Annotated[float, Quantity("m", sourced=True)]
    cross_flow_station: Annotated[float, Quantity("m", sourced=True)]
    distance_from_axis: Annotated[float, Quantity("m", low=0.0, sourced=True)]
    largest_deflection: Annotated[float, Quantity("rad", low=0.0, high=1.5708, sourced=True)] = USUAL_DEFLECTION
    lag: Lag | None = None
    rate_limit: Annotated[float, Quantity("rad/s", positive=True, sourced=True)] | None = None

    @field_validator("lag")
    @classmethod
    def _none(cls, value: float | None) -> float | None:
        return value or None  # zero is what is left out: an ideal actuator has no state


class ThrusterConfig(Table):
    """One thruster.

    Its throttle is what it is asked, clipped, zero below `dead_band`, followed at most at `rate_limit` with a
    first-order lag of time constant `lag`; what is left out is ideal.

    Attributes
    ----------
    name : str
        Its name.
    position : tuple of float
        Where it acts, from the origin of the body axes, body axes [m].
    direction : tuple of float
        Unit vector of positive thrust, body axes [-].
    nominal_thrust : float
        T_nom at full throttle, at rest, at sea level [N].
    reversible : bool
        Whether its throttle goes down to −1, else to 0.
    speed_of_no_thrust : float, optional
        Axial airspeed at which its thrust has vanished [m/s].
    lag : float, optional
        τ [s].
    rate_limit : float, optional
        Fastest change of the throttle, full throttle per second [1/s].
    dead_band : float, optional
        Throttle below which nothing is done [-].
    """

    name: Part
    position: Position
    direction: Annotated[Vector, Quantity("1", depth=1, sourced=True)]
    nominal_thrust: Annotated[float, Quantity("N", positive=True, sourced=True)]
    reversible: bool
    speed_of_no_thrust: Annotated[float, Quantity("m/s", positive=True, sourced=True)] | None = None
    lag: Lag | None = None
    rate_limit: Annotated[float, Quantity("1/s", positive=True, sourced=True)] | None = None
    dead_band: Annotated[float, Quantity("1", low=0.0, high=0.99, sourced=True)] | None = None

    @field_validator("lag", "dead_band")
    @classmethod
    def _none(cls, value: float | None) -> float | None:
        return value or None  # zero is what is left out: an ideal actuator has no state

    @model_validator(mode="after")
    def _unit_direction(self) -> "ThrusterConfig":
        length = float(np.linalg.norm(self.direction))
        if abs(length - 1.0) > 1e-6:
            raise ValueError(f"direction has length {length:.6g}; give a unit vector")
        return self


def _profile(hull: GertlerHull | GertlerShapeHull | EllipsoidHull) -> np.ndarray:
    """Return a₁ … a₆ of a hull's profile [-]."""
    if isinstance(hull, GertlerHull):
        return np.array(hull.coefficients)
    if isinstance(hull, EllipsoidHull):
        return np.array([1.0, -1.0, 0.0, 0.0, 0.0, 0.0])
    shape = gertler_from_shape(
        *(
            jnp.asarray(number)
            for number in (
                hull.length,
                hull.diameter,
                hull.largest_section,
                hull.nose_radius,
                hull.tail_radius,
                hull.prismatic_coefficient,
            )
        )
    )
    return np.asarray(shape.coefficients)


class VehicleConfig(Table):
    """An airship; `parts` are parts of one's own, in its own axes."""

    name: str
    description: str
    body: BodyConfig
    hull: HullConfig
    buoyancy: BuoyancyConfig
    apparent_mass: ApparentMassConfig
    envelope: EnvelopeConfig
    fins: tuple[FinConfig, ...] = ()
    thrusters: tuple[ThrusterConfig, ...] = ()
    parts: tuple[OwnPartConfig, ...] = ()

    @property
    def fineness(self) -> float:
        """Length over largest diameter of the hull [-]."""
        return self.hull.length / self.hull.diameter

    def drag_warning(self) -> str | None:
        """Return what is wrong with axial and cross-flow drag on a hull that is nearly a sphere, or None."""
        if self.envelope.drag_coefficient is not None or self.fineness >= SLENDER:
            return None
        return (
            f"{self.name}: the hull is only {self.fineness:.3g} times as long as wide, and its drag is split into "
            f"axial and cross-flow drag, which holds from {SLENDER} on: a sphere so has lift; give "
            "envelope.drag_coefficient, on the frontal area, instead of the two"
        )

    @model_validator(mode="after")
    def _hull_is_one(self) -> "VehicleConfig":
        coefficients = _profile(self.hull)
        station = np.linspace(0.0, 1.0, 401)
        squared = (coefficients * station[:, None] ** np.arange(1, 7)).sum(axis=1)
        if squared[1:-1].min() <= 0:
            at = float(station[1 + int(np.argmin(squared[1:-1]))] * self.hull.length)
            raise ValueError(f"hull: the profile goes negative (r² ≤ 0) at {at:.2f} m from the nose; check them")
        if abs(squared[-1]) > 1e-3:
            raise ValueError(f"hull: (r/D)² is {squared[-1]:.4g} at the tail; the coefficients must add up to 0")
        volume = np.pi * self.hull.diameter**2 * self.hull.length * (coefficients / np.arange(2, 8)).sum()
        if abs(volume / self.buoyancy.volume - 1.0) > 0.25:
            raise ValueError(
                f"buoyancy.volume {self.buoyancy.volume:.4g} m³ is more than 25 % from the hull's own {volume:.4g} m³"
            )
        return self

    @model_validator(mode="after")
    def _parts_fit(self) -> "VehicleConfig":
        if self.envelope.potential_length > self.hull.length:
            raise ValueError(
                f"envelope.potential_length {self.envelope.potential_length:g} m is beyond the hull's length "
                f"{self.hull.length:g} m"
            )
        if self.envelope.drag_coefficient is not None and self.fineness >= SLENDER:
            raise ValueError(
                f"envelope.drag_coefficient is for a hull that is nearly a sphere, and this one is {self.fineness:.3g} "
                f"times as long as wide (below {SLENDER}); give axial_drag_coefficient and cross_flow_drag_coefficient"
            )
        parts = (*self.fins, *self.thrusters, *self.parts)
        check_apart((part.name for part in parts), "fins, thrusters or parts" if self.parts else "fins or thrusters")
        return self
