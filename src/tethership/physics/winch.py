"""Winch: takes in cable at the commanded rate, within its own limits. Depends on: nothing.

References
----------
Section 4 of Riboldi et al.: South Pacific 900E, 30 m/min, 3 139 N, 1.1 kW; default rate 0.3 m/s.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class Winch(eqx.Module):
    """An ideal rate-controlled winch.

    Attributes
    ----------
    default_rate : float
        Rewind rate when no law changes it Ψ̄ [m/s].
    fastest_rate : float
        Largest rate in either direction [m/s].
    """

    default_rate: Float[Array, ""]
    fastest_rate: Float[Array, ""]

    def rate(self, correction: Float[Array, ""]) -> Float[Array, ""]:
        """Return the rewind rate Ψ [m/s], default plus the laws' correction, clipped; dL/dt = −Ψ."""
        return jnp.clip(self.default_rate + correction, -self.fastest_rate, self.fastest_rate)
