"""What a tension law is: from span, length and load to the forces at both ends and the shape between them.

Depends on: nothing else.
"""

import abc
from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

LOAD_FLOOR = 1e-10
"""Regularisation [N/m]: this much weight is added to every cable, so that one without weight and wind still has
a direction of load, a finite tension when slack (zero, to 1e-9 N) and finite gradients."""

SPAN_FLOOR = 1e-12
"""Regularisation [-]: this fraction of the length is added, in squares, to the distance across the load, so that
a cable hanging plumb, or with both ends in one point, has a finite root and finite gradients."""


class CableForce(NamedTuple):
    """Forces of one cable, ground axes.

    Attributes
    ----------
    ship : Float[Array, "3"]
        Force of the cable on the ship F_TP [N].
    anchor : Float[Array, "3"]
        Force of the cable on the anchor F_AP [N]. At rest F_TP + F_AP = L l, which `ElasticCatenary` always holds and
        `PublishedTension` only below e_c.
    """

    ship: Float[Array, "3"]
    anchor: Float[Array, "3"]


class AbstractTensionLaw(eqx.Module):
    """A cable's statics under a uniform load.

    Attributes
    ----------
    stiffness : float
        EA, force per strain [N].
    """

    stiffness: eqx.AbstractVar[Float[Array, ""]]

    @abc.abstractmethod
    def force(self, span: Float[Array, "3"], length: Float[Array, ""], load: Float[Array, "3"]) -> CableForce:
        """Return the forces at both ends [N], ground axes.

        Parameters
        ----------
        span : Float[Array, "3"]
            d = x_TP − x_AP, ground axes [m].
        length : Float[Array, ""]
            Unstretched length L_t [m].
        load : Float[Array, "3"]
            Uniform load per unstretched length l, ground axes [N/m].
        """

    @abc.abstractmethod
    def shape(
        self,
        span: Float[Array, "3"],
        length: Float[Array, ""],
        load: Float[Array, "3"],
        arc: Float[Array, "n"],
    ) -> Float[Array, "n 3"]:
        """Return points of the cable from the anchor, ground axes [m].

        Parameters
        ----------
        span, length, load
            As in `force`.
        arc : Float[Array, "n"]
            Unstretched distance from the anchor s, 0 … L_t [m].
        """

    @abc.abstractmethod
    def regime(self, elongation: Float[Array, ""]) -> Float[Array, ""]:
        """Return 0 slack, 1 joint, 2 taut for the elongation e = |d|/L_t [-]."""


def regularised(load: Float[Array, "3"]) -> Float[Array, "3"]:
    """Return the load l [N/m] with `LOAD_FLOOR` of weight added, ground axes."""
    return load + jnp.array([0.0, 0.0, LOAD_FLOOR])
