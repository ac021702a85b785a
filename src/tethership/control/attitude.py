"""Stability augmentation and levelling of roll and pitch (SAS/attitude). Depends on: control.law.

References
----------
Eq. 40 of Riboldi et al. As printed, the ratio of forward positions of #2 and #3 is negative and makes #3, #4 cancel
the moment of #2; the text asks for two equal contributions, so its modulus is in the allocation.
"""

import equinox as eqx
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement, deflected


class AttitudeLaw(AbstractLaw):
    """Proportional in rate and angle about roll and pitch, in rate about yaw.

    Attributes
    ----------
    roll_rate_gain, pitch_rate_gain, yaw_rate_gain : float
        κ_p, κ_q, κ_r [s/rad].
    roll_gain, pitch_gain : float
        κ_φ, κ_θ [1/rad].
    roll_target, pitch_target : float
        φ̄, θ̄ [rad].
    roll_share, pitch_share, yaw_share : Float[Array, "thrusters"]
        Throttle of each thruster per unit of roll, pitch, yaw demand [-].
    fin_shares : dict of str to Float[Array, "fins"]
        Deflection of each fin per unit of demand [rad], by the name of the share, for those in which fins have a part.
    """

    roll_rate_gain: Float[Array, ""]
    pitch_rate_gain: Float[Array, ""]
    yaw_rate_gain: Float[Array, ""]
    roll_gain: Float[Array, ""]
    pitch_gain: Float[Array, ""]
    roll_target: Float[Array, ""]
    pitch_target: Float[Array, ""]
    roll_share: Float[Array, "thrusters"]
    pitch_share: Float[Array, "thrusters"]
    yaw_share: Float[Array, "thrusters"]
    fin_shares: dict[str, Float[Array, "fins"]] = eqx.field(default_factory=dict)

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[()]
    ) -> tuple[Correction, tuple[()]]:
        """Return the throttle corrections; arguments as in `AbstractLaw`.

        Notes
        -----
        a = κ_q q + κ_θ(θ − θ̄), b = κ_p p + κ_φ(φ − φ̄); the paper's shares make it
        Δδ₂ = −a, Δδ₃ = −b − ½ρ₂₃a, Δδ₄ = +b − ½ρ₂₃a, Δδ₅ = −κ_r r, Δδ₆ = +κ_r r, ρ₂₃ = |q_T2x/q_T3x|.
        """
        roll_rate, pitch_rate, yaw_rate = measurement.rates
        roll, pitch, _ = measurement.attitude
        pitching = self.pitch_rate_gain * pitch_rate + self.pitch_gain * (pitch - self.pitch_target)
        rolling = self.roll_rate_gain * roll_rate + self.roll_gain * (roll - self.roll_target)
        yawing = self.yaw_rate_gain * yaw_rate
        throttle = self.pitch_share * pitching + self.roll_share * rolling + self.yaw_share * yawing
        turned = deflected(self.fin_shares, pitch_share=pitching, roll_share=rolling, yaw_share=yawing)
        return Correction(throttle=throttle, deflection=turned), memory
