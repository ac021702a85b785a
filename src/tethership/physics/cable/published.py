"""The paper's tension law: inextensible catenary, linear joint, Hookean line. For reproduction.

Depends on: physics.cable.catenary.

    e < e_c          catenary (Eqs. 19–24, misprints mended)
    e_c ≤ e ≤ e_e    F_c + (e − e_c)(F_e − F_c)/(e_e − e_c), F_c the catenary at e_c along the same direction (13)
    e > e_e          F = K₀ (e − e_c) j                                                                     (12)

The joint is only C⁰, so eigenvalues jump at e_c; and K₀(e_e − e_c) = 4186 N is beyond the breaking force, so an
unbroken cable of the paper never leaves it.

Beyond e_c the law loses weight and wind: F_TP + F_AP = (1 − (e − e_c)/(e_e − e_c)) L l. The paper's cable, 15.7 N,
weighs 7.8 N at e = 1.02 and 4.3 N when it breaks. For a heavy or long cable that comes taut take `ElasticCatenary`.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.cable.catenary import end_forces, points
from tethership.physics.cable.law import AbstractTensionLaw, CableForce, regularised


class PublishedTension(AbstractTensionLaw):
    """Tension law of the `published` formulation; beyond e_c both ends together carry less than the cable's load.

    Attributes
    ----------
    stiffness : float
        K₀ = EA [N].
    joint_start : float
        e_c [-], below 1.
    joint_end : float
        e_e [-], above e_c.
    """

    stiffness: Float[Array, ""]
    joint_start: Float[Array, ""]
    joint_end: Float[Array, ""]

    def _sagging_span(
        self, span: Float[Array, "3"], length: Float[Array, ""]
    ) -> tuple[Float[Array, ""], Float[Array, "3"], Float[Array, "3"]]:
        """Return e [-], the unit vector −j from anchor to ship [-], and d drawn back to e_c at most [m]."""
        square = jnp.dot(span, span)
        apart = square > 0
        distance = jnp.where(apart, jnp.sqrt(jnp.where(apart, square, 1.0)), 0.0)
        elongation = distance / length
        scale = self.joint_start / jnp.maximum(elongation, self.joint_start)
        outward = jnp.where(apart, span / jnp.where(apart, distance, 1.0), 0.0)
        return elongation, outward, span * scale

    def force(self, span: Float[Array, "3"], length: Float[Array, ""], load: Float[Array, "3"]) -> CableForce:
        """Return the forces at both ends [N], ground axes; arguments as in `AbstractTensionLaw.force`."""
        elongation, outward, sagging = self._sagging_span(span, length)
        slack = end_forces(sagging, length, regularised(load), jnp.zeros_like(length))
        width = self.joint_end - self.joint_start
        share = jnp.clip((elongation - self.joint_start) / width, 0.0, 1.0)
        pull = -self.stiffness * (jnp.maximum(elongation, self.joint_end) - self.joint_start) * outward
        return CableForce(
            slack.ship + share * (pull - slack.ship),
            slack.anchor + share * (-pull - slack.anchor),
        )

    def shape(
        self,
        span: Float[Array, "3"],
        length: Float[Array, ""],
        load: Float[Array, "3"],
        arc: Float[Array, "n"],
    ) -> Float[Array, "n 3"]:
        """Return points of the cable from the anchor, ground axes [m]; arguments as in `AbstractTensionLaw.shape`.

        Notes
        -----
        The law gives no shape beyond e_c: the catenary at e_c is drawn out along the chord, its sag fading
        linearly to a straight line at e_e.
        """
        elongation, _, sagging = self._sagging_span(span, length)
        load = regularised(load)
        none = jnp.zeros_like(length)
        curve = points(end_forces(sagging, length, load, none).anchor, load, none, arc)
        fraction = (arc / length)[:, None]
        width = self.joint_end - self.joint_start
        share = jnp.clip((elongation - self.joint_start) / width, 0.0, 1.0)
        return fraction * span + (1.0 - share) * (curve - fraction * sagging)

    def regime(self, elongation: Float[Array, ""]) -> Float[Array, ""]:
        """Return 0 [-] below e_c (slack), 1 up to e_e (joint), 2 above (taut)."""
        return jnp.where(elongation < self.joint_start, 0, jnp.where(elongation <= self.joint_end, 1, 2))
