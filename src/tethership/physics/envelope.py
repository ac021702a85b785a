"""Hull loads besides apparent mass: slices of the potential flow, cross-flow drag and axial drag.

Depends on: spatial. Given the integrals of the hull's shape as numbers.

Per unit length, with μ(x) = ρ(k₂−k₁)A(x), x forward from B, u the axial airspeed, v_y(x) = v + r x and
v_z(x) = w − q x, ideal flow past a slender slice gives

    f_x = μ (r v_y − q v_z),  f_y = u μ_x v_y + u μ r + μ p v_z,  f_z = u μ_x v_z − u μ q − μ p v_y

which hold from the nose to l_h; behind it the flow is separated or ruled by the fins.

- `PublishedEnvelope` has the paper's slices: only u μ_x v_⊥ over 0 ≤ ξ ≤ l_h, times η_k.
- `ConsistentEnvelope` corrects Kirchhoff's whole-hull loads (`KirchhoffApparentMass`): minus the slices behind l_h,
  plus (η_k − 1) times those ahead of it. With η_k = 1 and l_h = L nothing is left.

The drag of a slender hull is split into axial and cross-flow drag, each with its own part of the airspeed. A sphere has
no axis to split about: one coefficient on the frontal area and the whole airspeed, f = −½ρ ¼πD² C_D |v| v.

References
----------
Munk, NACA TR-184 (1924); Jones & DeLaurier, J. Aircraft 20 (1983); Riboldi et al. section 2.1; for spheres
Coulombe-Pontbriand, Modeling and Experimental Characterization of a Tethered Spherical Aerostat, McGill (2005).
"""

import abc

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import Wrench, safe_norm


class SliceIntegrals(eqx.Module):
    """Integrals of a part of the hull, about B with x forward.

    Attributes
    ----------
    area : Float[Array, "3"]
        ∫A dx, ∫A x dx, ∫A x² dx [m³, m⁴, m⁵].
    slope : Float[Array, "3"]
        ∫A_x dx, ∫A_x x dx, ∫A_x x² dx, A_x = dA/dx [m², m³, m⁴].
    """

    area: Float[Array, "3"]
    slope: Float[Array, "3"]

    def __add__(self, other: "SliceIntegrals") -> "SliceIntegrals":
        return SliceIntegrals(self.area + other.area, self.slope + other.slope)

    def scaled(self, factor: Float[Array, ""]) -> "SliceIntegrals":
        """Return all integrals times a factor [-]."""
        return SliceIntegrals(factor * self.area, factor * self.slope)

    def wrench(self, air_velocity: Float[Array, "3"], rates: Float[Array, "3"], slope_only: bool) -> Wrench:
        """Return the slices' wrench about B per ρ(k₂−k₁), body axes [m³·m/s², …].

        Parameters
        ----------
        air_velocity : Float[Array, "3"]
            Velocity of B relative to the air, body axes [m/s].
        rates : Float[Array, "3"]
            ω, body axes [rad/s].
        slope_only : bool
            Keep only u μ_x v_⊥ (the paper's slices).
        """
        u, v, w = air_velocity
        p, q, r = rates
        a0, a1, a2 = self.area
        d0, d1, d2 = self.slope
        lateral, lateral_x = u * (d0 * v + d1 * r), u * (d1 * v + d2 * r)
        vertical, vertical_x = u * (d0 * w - d1 * q), u * (d1 * w - d2 * q)
        axial = jnp.zeros_like(u)
        if not slope_only:
            axial = r * (a0 * v + a1 * r) - q * (a0 * w - a1 * q)
            lateral += u * a0 * r + p * (a0 * w - a1 * q)
            lateral_x += u * a1 * r + p * (a1 * w - a2 * q)
            vertical += -u * a0 * q - p * (a0 * v + a1 * r)
            vertical_x += -u * a1 * q - p * (a1 * v + a2 * r)
        return Wrench(
            jnp.stack([axial, lateral, vertical]),
            jnp.stack([jnp.zeros_like(u), -vertical_x, lateral_x]),
        )


class AbstractEnvelope(eqx.Module):
    """What the hull's surface feels besides apparent mass and buoyancy.

    Attributes
    ----------
    centre : Float[Array, "3"]
        Centre of buoyancy B from P, body axes, q_B [m].
    munk_factor : float
        k₂ − k₁ [-].
    front : SliceIntegrals
        Integrals from the nose to l_h.
    tail : SliceIntegrals
        Integrals from l_h to the tail.
    slice_efficiency : float
        η_k [-].
    strip_position : Float[Array, "strips"]
        Stations of the cross-flow drag x, forward from B [m], nose to l_h.
    strip_area : Float[Array, "strips"]
        Their projected area 2r dξ [m²].
    cross_flow_drag_coefficient : float
        C_Dc [-], on 2r.
    axial_drag_area : float
        S_h C_Dh0 [m²].
    isotropic_drag_area : float or None
        ¼πD² C_D [m²] of a hull that is nearly a sphere, in place of axial and cross-flow drag; None for a slender one.
    """

    centre: eqx.AbstractVar[Float[Array, "3"]]
    munk_factor: eqx.AbstractVar[Float[Array, ""]]
    front: eqx.AbstractVar[SliceIntegrals]
    tail: eqx.AbstractVar[SliceIntegrals]
    slice_efficiency: eqx.AbstractVar[Float[Array, ""]]
    strip_position: eqx.AbstractVar[Float[Array, "strips"]]
    strip_area: eqx.AbstractVar[Float[Array, "strips"]]
    cross_flow_drag_coefficient: eqx.AbstractVar[Float[Array, ""]]
    axial_drag_area: eqx.AbstractVar[Float[Array, ""]]
    isotropic_drag_area: eqx.AbstractVar[Float[Array, ""] | None]

    @abc.abstractmethod
    def potential(self, air_velocity: Float[Array, "3"], rates: Float[Array, "3"]) -> Wrench:
        """Return the slices' wrench about B per ρ(k₂−k₁), body axes [N m³/kg, N m⁴/kg]; arguments as in `viscous`."""

    def viscous(self, air_velocity: Float[Array, "3"], rates: Float[Array, "3"]) -> Wrench:
        """Return the drag per ρ about B, body axes [N m³/kg, N m⁴/kg].

        Parameters
        ----------
        air_velocity : Float[Array, "3"]
            Velocity of B relative to the air, body axes [m/s].
        rates : Float[Array, "3"]
            ω, body axes [rad/s].

        Notes
        -----
        df_⊥ = −½ C_Dc 2r |v_⊥(x)| v_⊥(x) dξ, f_x = −½ S_h C_Dh0 |u| u. |v_⊥| is guarded at zero by one part in
        1e-16 of (1 m/s)², so that gradients are finite. Of a hull that is nearly a sphere f = −½ ¼πD² C_D |v| v, at B.
        """
        if self.isotropic_drag_area is not None:
            drag = -0.5 * self.isotropic_drag_area * safe_norm(air_velocity) * air_velocity
            return Wrench(drag, jnp.zeros(3))
        u, v, w = air_velocity
        _, q, r = rates
        lateral = v + r * self.strip_position
        vertical = w - q * self.strip_position
        speed = jnp.sqrt(lateral**2 + vertical**2 + 1e-32)
        weight = -0.5 * self.cross_flow_drag_coefficient * self.strip_area * speed
        force_y, force_z = weight * lateral, weight * vertical
        force = jnp.stack([-0.5 * self.axial_drag_area * jnp.abs(u) * u, jnp.sum(force_y), jnp.sum(force_z)])
        moment = jnp.stack(
            [
                jnp.zeros_like(u),
                -jnp.sum(self.strip_position * force_z),
                jnp.sum(self.strip_position * force_y),
            ]
        )
        return Wrench(force, moment)

    def wrench(self, density: Float[Array, ""], air_velocity: Float[Array, "3"], rates: Float[Array, "3"]) -> Wrench:
        """Return the hull's wrench about P, body axes [N, N m].

        Parameters
        ----------
        density : Float[Array, ""]
            ρ at B [kg/m³].
        air_velocity : Float[Array, "3"]
            Velocity of B relative to the air, body axes [m/s].
        rates : Float[Array, "3"]
            ω, body axes [rad/s].
        """
        potential = self.potential(air_velocity, rates)
        viscous = self.viscous(air_velocity, rates)
        ideal = density * self.munk_factor
        return Wrench(
            ideal * potential.force + density * viscous.force,
            ideal * potential.moment + density * viscous.moment,
        ).moved(self.centre)


class PublishedEnvelope(AbstractEnvelope):
    """The paper's slices (Munk; Jones & DeLaurier), with local velocities and valid in reversed flow: loads [N, N m].

    Attributes are those of `AbstractEnvelope`.
    """

    centre: Float[Array, "3"]
    munk_factor: Float[Array, ""]
    front: SliceIntegrals
    tail: SliceIntegrals
    slice_efficiency: Float[Array, ""]
    strip_position: Float[Array, "strips"]
    strip_area: Float[Array, "strips"]
    cross_flow_drag_coefficient: Float[Array, ""]
    axial_drag_area: Float[Array, ""]
    isotropic_drag_area: Float[Array, ""] | None = None

    def potential(self, air_velocity: Float[Array, "3"], rates: Float[Array, "3"]) -> Wrench:
        """Return η_k u μ_x v_⊥ over 0 ≤ ξ ≤ l_h per ρ(k₂−k₁), about B, body axes [N m³/kg, N m⁴/kg].

        The arguments are those of `AbstractEnvelope.viscous`: v_a of B [m/s] and ω [rad/s], body axes.
        """
        return self.front.scaled(self.slice_efficiency).wrench(air_velocity, rates, slope_only=True)


class ConsistentEnvelope(AbstractEnvelope):
    """What the slices change in Kirchhoff's loads of the whole closed hull [N, N m].

    Attributes are those of `AbstractEnvelope`.
    """

    centre: Float[Array, "3"]
    munk_factor: Float[Array, ""]
    front: SliceIntegrals
    tail: SliceIntegrals
    slice_efficiency: Float[Array, ""]
    strip_position: Float[Array, "strips"]
    strip_area: Float[Array, "strips"]
    cross_flow_drag_coefficient: Float[Array, ""]
    axial_drag_area: Float[Array, ""]
    isotropic_drag_area: Float[Array, ""] | None = None

    def potential(self, air_velocity: Float[Array, "3"], rates: Float[Array, "3"]) -> Wrench:
        """Return (η_k − 1) · slices ahead of l_h − slices behind, per ρ(k₂−k₁), about B, body axes [N m³/kg, N m⁴/kg].

        The arguments are those of `AbstractEnvelope.viscous`: v_a of B [m/s] and ω [rad/s], body axes.
        """
        change = self.front.scaled(self.slice_efficiency - 1.0) + self.tail.scaled(jnp.asarray(-1.0))
        return change.wrench(air_velocity, rates, slope_only=False)
