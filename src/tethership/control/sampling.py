"""Sampled laws: a period, a zero-order hold, a computing delay. Depends on: control.law.

At t = kT the law looks at a measurement and works out its correction, at t = kT + d that takes effect and is held until
the next one does. These are the only instants at which a state of the plant jumps.
"""

from typing import NamedTuple

import equinox as eqx
from jaxtyping import Array, Float

from tethership.control.law import Correction


class Sampling(eqx.Module):
    """When a law looks and when it acts.

    Attributes
    ----------
    period : float
        T [s].
    delay : float
        Computing delay d, at most T [s]; none is a structure of its own, without a correction that waits.
    """

    period: Float[Array, ""]
    delay: Float[Array, ""] | None = None


class Held(NamedTuple):
    """What a sampled law holds: changes of throttles [-], deflections [rad] and rewind rates [m/s].

    Attributes
    ----------
    now : Correction
        In effect.
    waiting : Correction or ()
        Worked out, and in effect from the delay on; empty where there is no delay.
    """

    now: Correction
    waiting: Correction | tuple[()]
