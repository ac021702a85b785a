"""Buoyancy: the lift of the air that the hull displaces. Depends on: spatial."""

import equinox as eqx
from jaxtyping import Array, Float

from tethership.spatial import Wrench


class Buoyancy(eqx.Module):
    """Displaced volume and where it acts.

    Attributes
    ----------
    volume : float
        Displaced volume 𝒱 [m³].
    centre : Float[Array, "3"]
        Centre of buoyancy B from P, body axes, q_B [m].
    """

    volume: Float[Array, ""]
    centre: Float[Array, "3"]

    def wrench(self, density: Float[Array, ""], gravity_b: Float[Array, "3"]) -> Wrench:
        """Return the wrench of the displaced air about P, body axes [N, N m].

        Parameters
        ----------
        density : Float[Array, ""]
            Density of the air at B, ρ [kg/m³].
        gravity_b : Float[Array, "3"]
            Acceleration of gravity g, body axes [m/s²].

        Notes
        -----
        f = −ρ𝒱g, m = q_B × f (Eqs. 8–9 of Riboldi et al.).
        """
        return Wrench.at(self.centre, -density * self.volume * gravity_b)
