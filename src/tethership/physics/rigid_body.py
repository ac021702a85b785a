"""Inertia of a rigid body about any point P of it. Depends on: spatial.

Notes
-----
Left side of Eq. 1 of Riboldi et al., Mⁱ ẇ + w × Mⁱ w, with w = (v_P, ω) in body axes and

    Mⁱ = [[m I, Sᵀ], [S, J_P]],  S = m (q_G)×,      w × = [[ω×, 0], [v×, ω×]]      (Eqs. 2 and 4).
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import Wrench, skew


class RigidBody(eqx.Module):
    """Mass, centre of gravity and inertia.

    Attributes
    ----------
    mass : float
        Mass m [kg].
    centre : Float[Array, "3"]
        Centre of gravity G from P, body axes, q_G [m].
    inertia : Float[Array, "3 3"]
        Inertia matrix J_P about P, body axes [kg m²]; off-diagonal entries as in the matrix, not products of
        inertia with the sign turned.
    """

    mass: Float[Array, ""]
    centre: Float[Array, "3"]
    inertia: Float[Array, "3 3"]

    def mass_matrix(self) -> Float[Array, "6 6"]:
        """Return Mⁱ about P, body axes [kg, kg m, kg m²] (Eq. 2)."""
        static_moment = self.mass * skew(self.centre)
        return jnp.block([[self.mass * jnp.eye(3), static_moment.T], [static_moment, self.inertia]])

    def gyroscopic(self, velocity: Float[Array, "3"], rates: Float[Array, "3"]) -> Wrench:
        """Return w × Mⁱ w, the quadratic part of the left side of Eq. 1, body axes [N, N m].

        Parameters
        ----------
        velocity : Float[Array, "3"]
            Ground velocity of P, v = (U, V, W), body axes [m/s].
        rates : Float[Array, "3"]
            ω = (p, q, r), body axes [rad/s].
        """
        linear = self.mass * (velocity + jnp.cross(rates, self.centre))
        angular = self.mass * jnp.cross(self.centre, velocity) + self.inertia @ rates
        return Wrench(
            jnp.cross(rates, linear),
            jnp.cross(velocity, linear) + jnp.cross(rates, angular),
        )
