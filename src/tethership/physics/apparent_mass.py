"""Apparent mass: the inertia of the air that a closed hull sets in motion. Depends on: spatial.

Two formulations, by name (docs/theory/formulations.md tells why):

- `PublishedApparentMass`: Mᵃ multiplies the derivative of the *ground* velocity and has no part in the quadratic
  terms, as Eq. 1 of Riboldi et al. is printed. Not invariant in wind; kept to reproduce the paper.
- `KirchhoffApparentMass`: Kirchhoff's equations in the *air-relative* velocity, and the pressure gradient of
  accelerating air. The default.

References
----------
Lamb, *Hydrodynamics*, 6th ed. (1932), art. 114–115, 124 (prolate spheroid); Munk, NACA TR-184 (1924).
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
    """Return the factors of a prolate spheroid from its fineness ratio.

    Parameters
    ----------
    fineness : Float[Array, ""]
        Length over diameter a/b [-], above 1.

    Notes
    -----
    With e² = 1 − (b/a)², L = ln((1+e)/(1−e)): α₀ = 2(1−e²)/e³ (½L − e), β₀ = 1/e² − (1−e²)/(2e³) L,
    k₁ = α₀/(2−α₀), k₂ = β₀/(2−β₀), k′ = e⁴(β₀−α₀) / {(2−e²)[2e² − (2−e²)(β₀−α₀)]}.
    At 4.02 they are 0.0810, 0.8606, 0.6102: the first two are Table 2's, whose k′ = 0.69 belongs to 4.87.

    Examples
    --------
    >>> import jax.numpy as jnp
    >>> from tethership.physics.apparent_mass import lamb1932
    >>> factors = lamb1932(jnp.asarray(4.02))
    >>> [round(float(factor), 4) for factor in (factors.axial, factors.lateral, factors.rotational)]
    [0.081, 0.8606, 0.6102]
    """
    squared = 1.0 - 1.0 / fineness**2
    eccentricity = jnp.sqrt(squared)
    logarithm = 2.0 * jnp.arctanh(eccentricity)
    alpha = 2.0 * (1.0 - squared) / eccentricity**3 * (0.5 * logarithm - eccentricity)
    beta = 1.0 / squared - (1.0 - squared) / (2.0 * eccentricity**3) * logarithm
    difference = beta - alpha
    rotational = squared**2 * difference / ((2.0 - squared) * (2.0 * squared - (2.0 - squared) * difference))
    return LambFactors(alpha / (2.0 - alpha), beta / (2.0 - beta), rotational)


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
    """As Eq. 1 is printed: nothing besides Mᵃ ẇ with the ground velocity (so no part of the air's motion)."""

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
        """Return zero; arguments as in `AbstractApparentMass.wrench`."""
        return Wrench(jnp.zeros(3), jnp.zeros(3))


class KirchhoffApparentMass(AbstractApparentMass):
    """Kirchhoff's equations for a closed body in air that itself moves and accelerates."""

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
        """Return the wrench about P; arguments as in `AbstractApparentMass.wrench`.

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
