"""A force and a moment about a named point, in named axes. Depends on nothing."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class Wrench(eqx.Module):
    """Force and moment; everywhere in this package about P and in body axes unless said.

    Attributes
    ----------
    force : Float[Array, "3"]
        Force f [N].
    moment : Float[Array, "3"]
        Moment m about the reference point [N m].
    """

    force: Float[Array, "3"]
    moment: Float[Array, "3"]

    @classmethod
    def at(cls, point: Float[Array, "3"], force: Float[Array, "3"]) -> "Wrench":
        """Return the wrench of a force [N] at a point [m], about the origin: m = q × f.

        Raises
        ------
        ValueError
            One of them has not three components; `jnp.cross` would take two.
        """
        if jnp.shape(point) != (3,) or jnp.shape(force) != (3,):
            raise ValueError(f"point and force have shapes {jnp.shape(point)} and {jnp.shape(force)}; give three each")
        return cls(force, jnp.cross(point, force))

    def moved(self, offset: Float[Array, "3"]) -> "Wrench":
        """Return the same wrench about another point.

        Parameters
        ----------
        offset : Float[Array, "3"]
            Vector from the new reference point to the old one [m], same axes.
        """
        return Wrench(self.force, self.moment + jnp.cross(offset, self.force))

    def __add__(self, other: "Wrench") -> "Wrench":
        return Wrench(self.force + other.force, self.moment + other.moment)

    def as_vector(self) -> Float[Array, "6"]:
        """Return (f, m) as one vector of six [N, N m]."""
        return jnp.concatenate([self.force, self.moment])
