"""Navigation: bring the tether point to the anchor, near hover. Depends on: control.law, spatial.

References
----------
Eq. 43 of Riboldi et al., with the index sets of the text and the sign of the speed term that damps (the printed
plus is anti-damping).
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement, clip, deflected
from tethership.spatial import horizontal_unit, rotation_matrix, safe_norm


class NavigationLaw(AbstractLaw):
    """Position and speed feedback ahead and up, towards the first cable's anchor.

    The error ahead is that along the nose (the text's "along the projection of b₁ on the horizontal plane");
    `LineOfSightNavigationLaw` takes the whole horizontal distance instead.

    Attributes
    ----------
    position_gain, vertical_gain : float
        κ_hor, κ_ver [1/m].
    speed_gain, climb_gain : float
        κ_U, κ_RoC [s/m].
    speed_slope : float
        Set-point of speed per metre of error, 0.1 [1/s].
    largest_speed, largest_climb : float
        Bounds of the set-points max|Ū|, max|RoC̄| [m/s].
    forward_share, vertical_share : Float[Array, "thrusters"]
        Throttle of each thruster per unit of forward and downward demand [-].
    fin_shares : dict of str to Float[Array, "fins"]
        Deflection of each fin per unit of demand [rad], by the name of the share, for those in which fins have a part.
    """

    position_gain: Float[Array, ""]
    vertical_gain: Float[Array, ""]
    speed_gain: Float[Array, ""]
    climb_gain: Float[Array, ""]
    speed_slope: Float[Array, ""]
    largest_speed: Float[Array, ""]
    largest_climb: Float[Array, ""]
    forward_share: Float[Array, "thrusters"]
    vertical_share: Float[Array, "thrusters"]
    fin_shares: dict[str, Float[Array, "fins"]] = eqx.field(default_factory=dict)

    def ahead(self, offset: Float[Array, "3"], nose: Float[Array, "2"]) -> Float[Array, ""]:
        """Return ε_hor [m] from the tether point's offset [m] and the nose's horizontal unit vector, ground axes."""
        return jnp.dot(offset[:2], nose)

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[()]
    ) -> tuple[Correction, tuple[()]]:
        """Return the throttle corrections; arguments as in `AbstractLaw`.

        Notes
        -----
        ε_hor = ε·(horizontal unit of b₁), ε_ver = ε·i₃ (negative above the anchor), Ū = clip(−0.1 ε_hor),
        RoC̄ = clip(+0.1 ε_ver); forward demand −κ_hor ε_hor − κ_U (U − Ū), downward demand
        −κ_ver ε_ver + κ_RoC (RoC − RoC̄).
        """
        offset = measurement.offset[0]
        nose = horizontal_unit(rotation_matrix(measurement.attitude))
        ahead = self.ahead(offset, nose)
        below = offset[2]
        speed = clip(-self.speed_slope * ahead, self.largest_speed)
        climb = clip(self.speed_slope * below, self.largest_climb)
        forward = -self.position_gain * ahead - self.speed_gain * (measurement.velocity[0] - speed)
        downward = -self.vertical_gain * below + self.climb_gain * (measurement.rate_of_climb - climb)
        turned = deflected(self.fin_shares, forward_share=forward, vertical_share=downward)
        throttle = self.forward_share * forward + self.vertical_share * downward
        return Correction(throttle=throttle, deflection=turned), memory


class LineOfSightNavigationLaw(NavigationLaw):
    """Navigation with the whole horizontal distance to the anchor as the error ahead [m], with the sign of that ahead.

    Attributes are those of `NavigationLaw`.
    """

    def ahead(self, offset: Float[Array, "3"], nose: Float[Array, "2"]) -> Float[Array, ""]:
        """Return ±|ε_hor| [m], negative with the anchor ahead; arguments as in `NavigationLaw.ahead`."""
        return jnp.where(jnp.dot(offset[:2], nose) >= 0, 1.0, -1.0) * safe_norm(offset[:2])
