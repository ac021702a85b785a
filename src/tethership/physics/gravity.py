"""Weight. Depends on: spatial."""

import equinox as eqx
from jaxtyping import Array, Float

from tethership.spatial import Wrench


class Gravity(eqx.Module):
    """The weight of the ship, acting at its centre of gravity.

    Attributes
    ----------
    mass : float
        Mass m [kg], lifting gas included.
    centre : Float[Array, "3"]
        Centre of gravity G from P, body axes, q_G [m].
    """

    mass: Float[Array, ""]
    centre: Float[Array, "3"]

    def wrench(self, gravity_b: Float[Array, "3"]) -> Wrench:
        """Return the wrench of the weight about P, body axes [N, N m].

        Parameters
        ----------
        gravity_b : Float[Array, "3"]
            Acceleration of gravity g, body axes [m/s²].

        Notes
        -----
        f = m g, m = q_G × f (Eqs. 8–9 of Riboldi et al.).
        """
        return Wrench.at(self.centre, self.mass * gravity_b)
