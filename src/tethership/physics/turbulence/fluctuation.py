"""What the wind does about its mean: turbulence, or a measured history. Depends on: nothing.

Unlike a gust it is there from the start: a ship is trimmed in the mean wind, and the flight begins in the other.
"""

import abc

import equinox as eqx
from jaxtyping import Array, Float


class AbstractFluctuation(eqx.Module):
    """A velocity added to the mean wind, ground axes [m/s], and the air's apparent rotation along the hull [rad/s]."""

    @abc.abstractmethod
    def velocity(self, time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the velocity added to the wind [m/s], ground axes, at time t [s]."""

    @abc.abstractmethod
    def rotation(self, time: Float[Array, ""], axis: Float[Array, "3"]) -> Float[Array, "3"] | None:
        """Return the apparent rotation of the air [rad/s], ground axes, None where it is the same all over the hull.

        Parameters
        ----------
        time : Float[Array, ""]
            t [s].
        axis : Float[Array, "3"]
            Unit vector i along the hull, ground axes.
        """
