"""What a control law is. Depends on nothing.

A law is a pure function of time, measurement and memory that returns a correction and the rate of its memory; the
integrator carries the memory with the plant's state. A law of one's own is a subclass of `AbstractLaw` with its
gains as fields and one method.
"""

import abc
from collections.abc import Mapping
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float


class Measurement(NamedTuple):
    """What the sensors of ship and winch tell a law.

    Attributes
    ----------
    velocity : Float[Array, "3"]
        Ground velocity of the centre of buoyancy B, (U, V, W), body axes [m/s]; at B, so that a law does not depend on
        the choice of P.
    rates : Float[Array, "3"]
        p, q, r, body axes [rad/s].
    attitude : Float[Array, "3"]
        φ, θ, ψ [rad].
    rate_of_climb : Float[Array, ""]
        Upward ground velocity of the centre of buoyancy, RoC [m/s].
    offset : Float[Array, "cables 3"]
        Tether point from anchor, ε = x_TP − x_AP, ground axes [m].
    tension : Float[Array, "cables"]
        Tension at the tether point |F| [N].
    length : Float[Array, "cables"]
        Unstretched length L_t [m].
    rewind_rate : Float[Array, "cables"]
        Default rewind rate of each winch Ψ̄ [m/s].
    readings : mapping of str to Float[Array, ""]
        What parts of one's own read, by the part's name, in its unit.
    """

    velocity: Float[Array, "3"]
    rates: Float[Array, "3"]
    attitude: Float[Array, "3"]
    rate_of_climb: Float[Array, ""]
    offset: Float[Array, "cables 3"]
    tension: Float[Array, "cables"]
    length: Float[Array, "cables"]
    rewind_rate: Float[Array, "cables"]
    readings: Mapping[str, Any] = {}


class Correction(NamedTuple):
    """What a law adds to the trimmed command; what it leaves out is zero.

    Attributes
    ----------
    throttle : Float[Array, "thrusters"] or float
        Δδ [-].
    deflection : Float[Array, "fins"] or float
        Δ deflection of the fins [rad].
    rewind_rate : Float[Array, "cables"] or float
        ΔΨ, added to the winch's default rate [m/s].
    """

    throttle: Float[Array, "thrusters"] | float = 0.0
    deflection: Float[Array, "fins"] | float = 0.0
    rewind_rate: Float[Array, "cables"] | float = 0.0


class Request(NamedTuple):
    """What a law asks by name; it may return this instead of a correction.

    Attributes
    ----------
    channels : mapping of str to Float[Array, ""]
        Δ of single channels: a thruster's throttle [-], a fin's deflection [rad].
    demands : mapping of str to Float[Array, ""]
        Demands [-], which the scenario's allocation shares out among the channels.
    correction : Correction
        What is asked besides, in the order of the parts.
    """

    channels: Mapping[str, Any] = {}
    demands: Mapping[str, Any] = {}
    correction: Correction = Correction()


Asked = Correction | Request


def added(first: Asked, second: Asked) -> Asked:
    """Return the sum of what two laws ask: changes of throttles [-], deflections [rad] and rewind rates [m/s].

    Named channels and demands are added name by name; where either is a `Request`, so is the sum.
    """
    if isinstance(first, Correction) and isinstance(second, Correction):
        return Correction(*(a + b for a, b in zip(first, second, strict=True)))
    one, other = (asked if isinstance(asked, Request) else Request({}, {}, asked) for asked in (first, second))
    return Request(
        _summed(one.channels, other.channels),
        _summed(one.demands, other.demands),
        Correction(*(a + b for a, b in zip(one.correction, other.correction, strict=True))),
    )


def switched(asked: Asked, switch: Float[Array, ""]) -> Asked:
    """Return what a law asks times a switch [-], 0 or 1."""
    return jax.tree.map(lambda part: part * switch, asked)


def _summed(first: Mapping[str, Any], second: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the sums by name."""
    return {**first, **{name: first.get(name, 0.0) + value for name, value in second.items()}}


class AbstractLaw(eqx.Module):
    """A control law: from time t [s], a `Measurement` and a memory to a `Correction` or a `Request`.

    It changes throttles [-], deflections [rad] and rewind rates [m/s]. Everything is in SI and radians; body axes are
    forward, starboard, down, ground axes north, east, down.
    """

    @abc.abstractmethod
    def __call__(self, time: Float[Array, ""], measurement: Measurement, memory: Any) -> tuple[Correction, Any]:
        """Return the correction, or a `Request` by name, and the time derivative of the memory.

        Parameters
        ----------
        time : Float[Array, ""]
            t [s].
        measurement : Measurement
            See there.
        memory : pytree of arrays
            What `initial_memory` returned, integrated up to now.
        """

    def initial_memory(self, measurement: Measurement) -> Any:
        """Return the memory at the start; nothing, unless a law says otherwise."""
        del measurement
        return ()


def deflected(shares: Mapping[str, Float[Array, "fins"]], **demands: Float[Array, ""]) -> Float[Array, "fins"] | float:
    """Return the deflections of all fins [rad] that share in demands, each by the name of its share; 0 for none."""
    parts = [shares[name] * demand for name, demand in demands.items() if name in shares]
    return sum(parts[1:], parts[0]) if parts else 0.0


def clip(value: Float[Array, ""], limit: Float[Array, ""]) -> Float[Array, ""]:
    """Return the value clipped to ±limit, same unit."""
    return jnp.clip(value, -limit, limit)
