"""Apparent mass: the inertia of the air that a closed hull sets in motion. Depends on: spatial.

Two formulations, by name (docs/theory/formulations.md tells why):

- `PublishedApparentMass`: Mᵃ multiplies the derivative of the *ground* velocity and has no part in the quadratic
  terms, as Eq. 1 of Riboldi et al. is printed. Not invariant in wind; kept to reproduce the paper.
- `KirchhoffApparentMass`: Kirchhoff's equations in the *air-relative* velocity, and the pressure gradient of
  accelerating air. The default.

References
----------
Lamb, *Hydrodynamics*, 6th ed. (1932), art. 114–115, 124 (spheroids); Munk, NACA TR-184 (1924).
"""

import abc

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import Wrench, skew


class LambFactors(eqx.Module):
    """Dimensionless inertia factors of a body of revolution in ideal flow.

    Attributes
    ----------
    axial : float
        k₁ [-], along the axis.
    lateral : float
        k₂ = k₃ [-], across it.
    rotational : float
        k′ [-], about a transverse axis.
    """

    axial: Float[Array, ""]
    lateral: Float[Array, ""]
    rotational: Float[Array, ""]


def lamb1932(fineness: Float[Array, ""]) -> LambFactors:
    """Return the factors of a spheroid from its fineness ratio.

    Parameters
    ----------
    fineness : Float[Array, ""]
        Length over diameter a/b [-]: above 1 prolate, 1 a sphere, below 1 oblate (flat across its axis).

    Notes
    -----
    Lamb's α₀ and β₀ add up to 2 = α₀ + 2β₀, so one number g tells both. With s = 1 − (b/a)²: β₀ − α₀ = s g,
    α₀ = ⅔ (1 − s g), β₀ = ⅔ (1 + ½ s g), k₁ = α₀/(2−α₀), k₂ = β₀/(2−β₀), k′ = s² g / {(2−s)[2 − (2−s) g]}.
    At 4.02 they are 0.0810, 0.8606, 0.6102: the first two are Table 2's, whose k′ = 0.69 belongs to 4.87. A sphere has
    ½, ½, 0.
    """
    s = 1.0 - 1.0 / fineness**2
    g = _lamb_difference(s)
    alpha, beta = 2.0 / 3.0 * (1.0 - s * g), 2.0 / 3.0 * (1.0 + 0.5 * s * g)
    rotational = s**2 * g / ((2.0 - s) * (2.0 - (2.0 - s) * g))
    return LambFactors(alpha / (2.0 - alpha), beta / (2.0 - beta), rotational)


def _lamb_difference(s: Float[Array, ""]) -> Float[Array, ""]:
    """Return g = (β₀ − α₀)/s [-] of a spheroid with s = 1 − (b/a)².

    Notes
    -----
    With e = √|s| and T = artanh(e)/e (s > 0) or arctan(e)/e (s < 0): g = 1/s − 3 (1−s)(T − 1)/s². Near the sphere both
    terms grow without bound and the series Σ 6 sᵏ/((2k+3)(2k+5)) is taken, of which 24 terms leave 1e-16 at |s| = 0.2.
    """
    near = jnp.abs(s) < 0.2
    powers = jnp.arange(24)
    series = jnp.sum(6.0 * jnp.where(near, s, 0.0) ** powers / ((2 * powers + 3) * (2 * powers + 5)))
    prolate, oblate = jnp.where(s >= 0.2, s, 0.5), jnp.where(s <= -0.2, -s, 0.5)
    inverse = jnp.where(
        s > 0, jnp.arctanh(jnp.sqrt(prolate)) / jnp.sqrt(prolate), jnp.arctan(jnp.sqrt(oblate)) / jnp.sqrt(oblate)
    )
    far = jnp.where(near, 1.0, s)
    return jnp.where(near, series, 1.0 / far - 3.0 * (1.0 - far) * (inverse - 1.0) / far**2)


class AbstractApparentMass(eqx.Module):
    """Apparent mass per unit density, and what it adds to the right-hand side.

    Attributes
    ----------
    volume : float
        Displaced volume 𝒱 [m³].
    centre : Float[Array, "3"]
        Centre of buoyancy B from P, body axes, q_B [m].
    translational : Float[Array, "3"]
        (k₁, k₂, k₃) 𝒱, times ρ the apparent masses M₁₁ along the body axes [m³].
    rotational : Float[Array, "3"]
        (0, k′J₂, k′J₃) 𝒱, times ρ the apparent inertias Jᵃ about B [m⁵], J the squared radius of gyration.
    """

    volume: eqx.AbstractVar[Float[Array, ""]]
    centre: eqx.AbstractVar[Float[Array, "3"]]
    translational: eqx.AbstractVar[Float[Array, "3"]]
    rotational: eqx.AbstractVar[Float[Array, "3"]]

    def matrix(self) -> Float[Array, "6 6"]:
        """Return Mᵃ/ρ about P, body axes [m³, m⁴, m⁵].

        Notes
        -----
        M_P = Tᵀ M_B T with T = [[I, −q_B×], [0, I]]: the velocity of B is v + ω × q_B.
        """
        transfer = jnp.block([[jnp.eye(3), -skew(self.centre)], [jnp.zeros((3, 3)), jnp.eye(3)]])
        diagonal = jnp.concatenate([self.translational, self.rotational])
        return transfer.T @ (diagonal[:, None] * transfer)

    @abc.abstractmethod
    def wrench(
        self,
        density: Float[Array, ""],
        air_velocity: Float[Array, "3"],
        rates: Float[Array, "3"],
        wind_b: Float[Array, "3"],
        wind_rate_ship: Float[Array, "3"],
        wind_rate_fluid: Float[Array, "3"],
    ) -> Wrench:
        """Return what is left of the apparent-mass reaction besides −Mᵃ ẇ, about P, body axes [N, N m].

        Parameters
        ----------
        density : Float[Array, ""]
            ρ at B [kg/m³].
        air_velocity : Float[Array, "3"]
            Velocity of B relative to the air, v_a, body axes [m/s].
        rates : Float[Array, "3"]
            ω, body axes [rad/s].
        wind_b : Float[Array, "3"]
            Wind at B, Rᵀ v_w, body axes [m/s].
        wind_rate_ship : Float[Array, "3"]
            Rate of the wind met along the ship's path, Rᵀ(∂t + v·∇)v_w, body axes [m/s²].
        wind_rate_fluid : Float[Array, "3"]
            Acceleration of the air itself, Rᵀ(∂t + v_w·∇)v_w, body axes [m/s²].
        """


class PublishedApparentMass(AbstractApparentMass):
    """As Eq. 1 is printed: nothing besides Mᵃ ẇ [N, N m] with the ground velocity (so no part of the air's motion).

    Attributes are those of `AbstractApparentMass`.
    """

    volume: Float[Array, ""]
    centre: Float[Array, "3"]
    translational: Float[Array, "3"]
    rotational: Float[Array, "3"]

    def wrench(
        self,
        density: Float[Array, ""],
        air_velocity: Float[Array, "3"],
        rates: Float[Array, "3"],
        wind_b: Float[Array, "3"],
        wind_rate_ship: Float[Array, "3"],
        wind_rate_fluid: Float[Array, "3"],
    ) -> Wrench:
        """Return zero [N, N m]; arguments as in `AbstractApparentMass.wrench`."""
        return Wrench(jnp.zeros(3), jnp.zeros(3))


class KirchhoffApparentMass(AbstractApparentMass):
    """Kirchhoff's equations for a closed body in air that itself moves and accelerates: forces and moments [N, N m].

    Attributes are those of `AbstractApparentMass`.
    """

    volume: Float[Array, ""]
    centre: Float[Array, "3"]
    translational: Float[Array, "3"]
    rotational: Float[Array, "3"]

    def wrench(
        self,
        density: Float[Array, ""],
        air_velocity: Float[Array, "3"],
        rates: Float[Array, "3"],
        wind_b: Float[Array, "3"],
        wind_rate_ship: Float[Array, "3"],
        wind_rate_fluid: Float[Array, "3"],
    ) -> Wrench:
        """Return the wrench about P, body axes [N, N m]; arguments as in `AbstractApparentMass.wrench`.

        Notes
        -----
        About B, with M₁₁ = ρ·translational and Jᵃ = ρ·rotational:

            f = −M₁₁ (ω × Rᵀv_w − Rᵀ dv_w/dt) − ω × (M₁₁ v_a) + ρ𝒱 Rᵀ Dv_w/Dt
            m = −v_a × (M₁₁ v_a) − ω × (Jᵃ ω)
        """
        impulse = self.translational * air_velocity
        force = (
            -self.translational * (jnp.cross(rates, wind_b) - wind_rate_ship)
            - jnp.cross(rates, impulse)
            + self.volume * wind_rate_fluid
        )
        moment = -jnp.cross(air_velocity, impulse) - jnp.cross(rates, self.rotational * rates)
        return Wrench(density * force, density * moment).moved(self.centre)
