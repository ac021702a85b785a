"""Hull shape: a body of revolution whose squared radius is a polynomial. Depends on: nothing.

    (r/D)² = a₁X + a₂X² + … + a₆X⁶,    X = ξ/L, ξ from the nose

A Gertler (Series 58) hull is given by its six coefficients or by the location m of the largest section, the nose
and tail radii r₀, r₁ (in D²/L), the prismatic coefficient C_p, D and L; an ellipsoid is a₁ = 1, a₂ = −1.

References
----------
Gertler, "Resistance experiments on a systematic series of streamlined bodies of revolution", DTMB C-297 (1950).
"""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

POWERS = np.arange(1, 7)
"""Exponents of X in the profile."""


class Strips(NamedTuple):
    """Stations and weights for integrals over a part of the hull; ∫f dξ ≈ Σ width · f.

    Attributes
    ----------
    station : Float[Array, "strips"]
        Distance from the nose ξ [m].
    radius : Float[Array, "strips"]
        Radius r there [m].
    width : Float[Array, "strips"]
        Quadrature weight dξ [m].
    """

    station: Float[Array, "strips"]
    radius: Float[Array, "strips"]
    width: Float[Array, "strips"]


class BodyOfRevolution(eqx.Module):
    """The hull's shape.

    Attributes
    ----------
    length : float
        L [m].
    diameter : float
        Largest diameter D [m].
    coefficients : Float[Array, "6"]
        a₁ … a₆ [-].
    """

    length: Float[Array, ""]
    diameter: Float[Array, ""]
    coefficients: Float[Array, "6"]

    def radius_squared(self, station: Float[Array, "n"]) -> Float[Array, "n"]:
        """Return r² [m²] at stations ξ [m] from the nose."""
        fraction = jnp.asarray(station) / self.length
        return self.diameter**2 * jnp.sum(self.coefficients * fraction[..., None] ** POWERS, axis=-1)

    def radius(self, station: Float[Array, "n"]) -> Float[Array, "n"]:
        """Return r [m] at stations ξ [m]; zero, with zero gradient, where r² is not positive (nose, tail)."""
        return _safe_root(self.radius_squared(station))

    def area_moment(
        self, power: int, origin: Float[Array, ""], start: Float[Array, ""], end: Float[Array, ""]
    ) -> Float[Array, ""]:
        """Return ∫ A (origin − ξ)ⁿ dξ from start to end [m^(3+n)], exact.

        Parameters
        ----------
        power : int
            n.
        origin, start, end : Float[Array, ""]
            Stations from the nose [m]; origin − ξ is the forward coordinate x from there.
        """
        strips = self.strips(start, end, 12)
        return jnp.sum(jnp.pi * strips.radius**2 * (origin - strips.station) ** power * strips.width)

    def volume(self) -> Float[Array, ""]:
        """Return the enclosed volume 𝒱 = π∫r² dξ [m³]."""
        return jnp.pi * self.diameter**2 * self.length * jnp.sum(self.coefficients / (POWERS + 1))

    def centre(self) -> Float[Array, ""]:
        """Return the distance of the centre of volume from the nose [m]."""
        first = jnp.pi * self.diameter**2 * self.length**2 * jnp.sum(self.coefficients / (POWERS + 2))
        return first / self.volume()

    def strips(self, start: Float[Array, ""], end: Float[Array, ""], count: int) -> Strips:
        """Return a Gauss–Legendre quadrature over start ≤ ξ ≤ end.

        Parameters
        ----------
        start, end : Float[Array, ""]
            Stations from the nose [m].
        count : int
            Number of strips.

        Notes
        -----
        The nodes are laid in s with ξ = L s²: r(ξ) ∼ √ξ at the nose becomes smooth in s and the rule converges
        geometrically, where nodes in ξ leave 1e-4 with 16 strips.
        """
        nodes, weights = np.polynomial.legendre.leggauss(count)
        low, high = _safe_root(start / self.length), _safe_root(end / self.length)
        position = 0.5 * (high + low) + 0.5 * (high - low) * nodes
        width = 0.5 * (high - low) * weights * 2.0 * position * self.length
        station = self.length * position**2
        return Strips(station, self.radius(station), width)


def _safe_root(square: Float[Array, "n"]) -> Float[Array, "n"]:
    """Return √ [unit of the root]; zero, with zero gradient, where the argument is not positive."""
    positive = square > 0
    return jnp.where(positive, jnp.sqrt(jnp.where(positive, square, 1.0)), 0.0)


def gertler(length: Float[Array, ""], diameter: Float[Array, ""], coefficients: Float[Array, "6"]) -> BodyOfRevolution:
    """Return a Gertler hull from length L [m], diameter D [m] and coefficients a₁ … a₆ [-]."""
    return BodyOfRevolution(jnp.asarray(length), jnp.asarray(diameter), jnp.asarray(coefficients))


def gertler_from_shape(
    length: Float[Array, ""],
    diameter: Float[Array, ""],
    largest_section: Float[Array, ""],
    nose_radius: Float[Array, ""],
    tail_radius: Float[Array, ""],
    prismatic_coefficient: Float[Array, ""],
) -> BodyOfRevolution:
    """Return a Gertler hull from its shape parameters.

    Parameters
    ----------
    length, diameter : Float[Array, ""]
        L, D [m].
    largest_section : Float[Array, ""]
        Station of the largest section m = ξ_max/L [-].
    nose_radius, tail_radius : Float[Array, ""]
        r₀, r₁: radii of curvature at nose and tail times L/D² [-].
    prismatic_coefficient : Float[Array, ""]
        C_p = 𝒱 / (¼πD²L) [-].

    Notes
    -----
    Six linear conditions: Σa = 0; Σaᵢmⁱ = ¼; Σi aᵢ mⁱ⁻¹ = 0; a₁ = 2r₀; Σi aᵢ = −2r₁; Σaᵢ/(i+1) = ¼C_p.
    """
    m = jnp.asarray(largest_section)
    one = jnp.ones(6)
    conditions = jnp.stack(
        [
            one,
            m**POWERS,
            POWERS * m ** (POWERS - 1),
            jnp.eye(6)[0],
            POWERS * one,
            1.0 / (POWERS + one),
        ]
    )
    zero = jnp.zeros_like(m)
    values = jnp.stack(
        [
            zero,
            zero + 0.25,
            zero,
            2.0 * jnp.asarray(nose_radius),
            -2.0 * jnp.asarray(tail_radius),
            0.25 * jnp.asarray(prismatic_coefficient),
        ]
    )
    return gertler(length, diameter, jnp.linalg.solve(conditions, values))


def ellipsoid(length: Float[Array, ""], diameter: Float[Array, ""]) -> BodyOfRevolution:
    """Return an ellipsoid of revolution of length L and diameter D [m]: (r/D)² = X − X²."""
    return gertler(length, diameter, jnp.array([1.0, -1.0, 0.0, 0.0, 0.0, 0.0]))
