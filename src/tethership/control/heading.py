"""Heading control: turn the nose towards the anchor. Depends on: control.law, spatial.

References
----------
Eq. 42 of Riboldi et al.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement
from tethership.spatial import horizontal_unit, rotation_matrix, safe_norm


def misalignment(attitude: Float[Array, "3"], offset: Float[Array, "3"]) -> Float[Array, ""]:
    """Return χ [rad], the horizontal angle from the nose to the anchor, positive with the anchor to port.

    Parameters
    ----------
    attitude : Float[Array, "3"]
        φ, θ, ψ [rad].
    offset : Float[Array, "3"]
        x_TP − x_AP, ground axes [m]. With the tether point plumb over the anchor χ is undefined; 0 is returned.

    Notes
    -----
    χ jumps by π when the tether point passes over the anchor.
    """
    nose = horizontal_unit(rotation_matrix(attitude))
    to_anchor = -offset[:2]
    to_starboard = nose[0] * to_anchor[1] - nose[1] * to_anchor[0]
    ahead = jnp.dot(nose, to_anchor)
    apart = (to_starboard != 0) | (ahead != 0)
    return -jnp.arctan2(jnp.where(apart, to_starboard, 0.0), jnp.where(apart, ahead, 1.0))


class HeadingLaw(AbstractLaw):
    """Differential thrust proportional to the misalignment with the first cable's anchor.

    Attributes
    ----------
    gain : float
        κ_χ [1/rad].
    share : Float[Array, "thrusters"]
        Throttle of each thruster per unit of demand [-].
    fade_radius : float
        Horizontal distance to the anchor below which the law fades out linearly [m]; 0 for never.
    """

    gain: Float[Array, ""]
    share: Float[Array, "thrusters"]
    fade_radius: Float[Array, ""]

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[()]
    ) -> tuple[Correction, tuple[()]]:
        """Return the throttle corrections; arguments as in `AbstractLaw`.

        Notes
        -----
        Δδ = share κ_χ χ; the paper's shares make it Δδ₅ = −κ_χ χ, Δδ₆ = +κ_χ χ.
        """
        offset = measurement.offset[0]
        angle = misalignment(measurement.attitude, offset)
        fading = self.fade_radius > 0
        distance = safe_norm(offset[:2])
        weight = jnp.where(fading, jnp.minimum(distance / jnp.where(fading, self.fade_radius, 1.0), 1.0), 1.0)
        return Correction(throttle=self.share * self.gain * weight * angle), memory
