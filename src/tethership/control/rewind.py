"""Rewind control: slow the winch down while the cable pulls hard. Depends on: control.law.

References
----------
Eq. 41 of Riboldi et al. Table A.2 prints F′ = 144.3 N, which is 0.3 of the tear force; the text says ⅓ of it, 160.3 N.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement


class RewindLaw(AbstractLaw):
    """Rewind rate falls linearly with the tension above a threshold.

    Attributes
    ----------
    gain : float
        κ_Ψ [m/(s N)].
    threshold : float
        F′ [N].
    slowest_rate : float
        Ψ_min [m/s].
    """

    gain: Float[Array, ""]
    threshold: Float[Array, ""]
    slowest_rate: Float[Array, ""]

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[()]
    ) -> tuple[Correction, tuple[()]]:
        """Return the change of rewind rate; arguments as in `AbstractLaw`.

        Notes
        -----
        Ψ = max(Ψ̄ − κ_Ψ (|F| − F′), Ψ_min) where |F| > F′, else Ψ̄; returned is Ψ − Ψ̄. A winch set slower than Ψ_min
        is left at its rate.
        """
        excess = jnp.maximum(measurement.tension - self.threshold, 0.0)
        slowed = jnp.maximum(measurement.rewind_rate - self.gain * excess, self.slowest_rate)
        rate = jnp.minimum(slowed, measurement.rewind_rate)
        return Correction(rewind_rate=rate - measurement.rewind_rate), memory
