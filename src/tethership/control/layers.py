"""Layers: several laws at once, their corrections added. Depends on: control.law."""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Asked, Correction, Measurement, added, switched


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
            correction, rate = law(time, measurement, own)
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
