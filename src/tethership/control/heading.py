"""Heading control: turn the nose towards the anchor. Depends on: control.law, spatial.

References
----------
Eq. 42 of Riboldi et al.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement, deflected
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

    Examples
    --------
    The nose points north, the anchor lies north-west, so to port:

    >>> import jax.numpy as jnp
    >>> from tethership.control import misalignment
    >>> chi = misalignment(jnp.zeros(3), jnp.array([-10.0, 10.0, -5.0]))
    >>> round(float(jnp.degrees(chi)), 6)
    45.0
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
    measured_behind : float
        How far behind the tether point, along the hull's axis, the point sits from which χ is measured [m]; 0 for the
        tether point itself.
    fade_radius : float
        Horizontal distance to the anchor below which the law fades out linearly [m]; 0 for never.
    fin_shares : dict of str to Float[Array, "fins"]
        Deflection of each fin per unit of demand [rad], by the name of the share, for those in which fins have a part.
    """

    gain: Float[Array, ""]
    share: Float[Array, "thrusters"]
    fade_radius: Float[Array, ""]
    measured_behind: Float[Array, ""]
    fin_shares: dict[str, Float[Array, "fins"]] = eqx.field(default_factory=dict)

    def angle(self, misaligned: Float[Array, ""]) -> Float[Array, ""]:
        """Return the angle the law acts on [rad] from χ [rad]: χ itself, −π … π."""
        return misaligned

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[()]
    ) -> tuple[Correction, tuple[()]]:
        """Return the throttle corrections; arguments as in `AbstractLaw`.

        Notes
        -----
        Δδ = share κ_χ χ; the paper's shares make it Δδ₅ = −κ_χ χ, Δδ₆ = +κ_χ χ.
        """
        offset = measurement.offset[0]
        behind = self.measured_behind * rotation_matrix(measurement.attitude)[:, 0]
        angle = self.angle(misalignment(measurement.attitude, offset - behind))
        fading = self.fade_radius > 0
        distance = safe_norm(offset[:2])
        weight = jnp.where(fading, jnp.minimum(distance / jnp.where(fading, self.fade_radius, 1.0), 1.0), 1.0)
        turned = deflected(self.fin_shares, share=self.gain * weight * angle)
        return Correction(throttle=self.share * self.gain * weight * angle, deflection=turned), memory


class SineHeadingLaw(HeadingLaw):
    """Heading control on arcsin(sin χ) [rad]: the angle as the cross product of two unit vectors gives it.

    Attributes are those of `HeadingLaw`. With the anchor astern the angle is small, and does not jump from π to −π
    there; with the tether point passing over the anchor it still changes sign.
    """

    def angle(self, misaligned: Float[Array, ""]) -> Float[Array, ""]:
        """Return the angle between −½π and ½π [rad] with the sine of χ [rad]."""
        return jnp.where(jnp.abs(misaligned) > 0.5 * jnp.pi, jnp.sign(misaligned) * jnp.pi - misaligned, misaligned)


class LineHeadingLaw(HeadingLaw):
    """Heading control on the angle [rad] between the hull's axis and the line to the anchor, whichever way it points.

    Attributes are those of `HeadingLaw`; the angle is arctan(tan χ). It does not jump when the tether point passes over
    the anchor, but where the line stands across the hull.
    """

    def angle(self, misaligned: Float[Array, ""]) -> Float[Array, ""]:
        """Return the angle between −½π and ½π [rad] with the tangent of χ [rad]."""
        return jnp.where(jnp.abs(misaligned) > 0.5 * jnp.pi, misaligned - jnp.sign(misaligned) * jnp.pi, misaligned)
