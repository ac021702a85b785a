"""The exact extensible catenary: one law from slack to taut, smooth but where it hangs exactly plumb. The default.

Depends on: physics.cable.catenary. The theory is in that file's docstring.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.cable.catenary import end_forces, points
from tethership.physics.cable.law import AbstractTensionLaw, CableForce, regularised


class ElasticCatenary(AbstractTensionLaw):
    """Tension law of the `consistent` formulation.

    Attributes
    ----------
    stiffness : float
        EA [N].
    """

    stiffness: Float[Array, ""]

    def force(self, span: Float[Array, "3"], length: Float[Array, ""], load: Float[Array, "3"]) -> CableForce:
        """Return the forces at both ends [N], ground axes; arguments as in `AbstractTensionLaw.force`."""
        return end_forces(span, length, regularised(load), 1.0 / self.stiffness)

    def shape(
        self,
        span: Float[Array, "3"],
        length: Float[Array, ""],
        load: Float[Array, "3"],
        arc: Float[Array, "n"],
    ) -> Float[Array, "n 3"]:
        """Return points of the cable from the anchor, ground axes [m]; arguments as in `AbstractTensionLaw.shape`."""
        anchor = self.force(span, length, load).anchor
        return points(anchor, regularised(load), 1.0 / self.stiffness, arc)

    def regime(self, elongation: Float[Array, ""]) -> Float[Array, ""]:
        """Return 0 [-] where e < 1 (slack), 2 where the chord is longer than the unstretched cable (taut)."""
        return jnp.where(elongation < 1.0, 0, 2)
