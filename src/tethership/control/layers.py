"""Layers: several laws at once, their corrections added. Depends on: control.law."""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Asked, Correction, Measurement, Request, added, switched
from tethership.errors import ConfigError, failure


class LayeredLaw(AbstractLaw):
    """The sum of any laws, each with its own memory.

    Attributes
    ----------
    laws : tuple of AbstractLaw
        What acts.
    names : tuple of str
        Their names, in the same order.
    switches : Float[Array, "laws"], optional
        1 for each law that acts, 0 for one that does not [-]: one compiled program then flies every set of layers. All
        act where none are given.
    """

    laws: tuple[AbstractLaw, ...]
    names: tuple[str, ...] = eqx.field(static=True)
    switches: Float[Array, "laws"] | None = None

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[Any, ...]
    ) -> tuple[Any, tuple[Any, ...]]:
        """Return the sum of all corrections and every law's memory rate; arguments as in `AbstractLaw`."""
        total: Asked = Correction()
        rates = []
        for i, (law, own) in enumerate(zip(self.laws, memory, strict=True)):
            correction, rate = _called(self.names[i], law, time, measurement, own)
            total = added(total, correction if self.switches is None else switched(correction, self.switches[i]))
            rates.append(rate)
        return total, tuple(rates)

    def joined(self, others: Mapping[str, AbstractLaw]) -> "LayeredLaw":
        """Return these laws with more of them, by name."""
        switches = self.switches
        if switches is not None:
            switches = jnp.concatenate([switches, jnp.ones(len(others))])
        return LayeredLaw((*self.laws, *others.values()), (*self.names, *others), switches)

    def initial_memory(self, measurement: Measurement) -> tuple[Any, ...]:
        """Return the memories of all laws."""
        return tuple(law.initial_memory(measurement) for law in self.laws)


def _called(name: str, law: AbstractLaw, *given: Any) -> tuple[Asked, Any]:
    """Return what a law returns; raises ConfigError with its name where it fails, or returns something else."""
    try:
        returned = law(*given)
    except ConfigError:
        raise
    except Exception as error:  # whatever code of one's own does
        raise ConfigError(f"law {name!r} fails: {failure(error)}") from error
    if isinstance(returned, tuple) and len(returned) == 2 and isinstance(returned[0], Correction | Request):
        return returned
    raise ConfigError(
        f"law {name!r} returns a {type(returned).__name__}; let it return a Correction or Request and the memory's rate"
    )
