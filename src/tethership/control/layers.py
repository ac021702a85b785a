"""Layers: several laws at once, their corrections added. Depends on: control.law."""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement


class LayeredLaw(AbstractLaw):
    """The sum of any laws, each with its own memory.

    Attributes
    ----------
    laws : tuple of AbstractLaw
        What acts.
    names : tuple of str
        Their names, in the same order.
    """

    laws: tuple[AbstractLaw, ...]
    names: tuple[str, ...] = eqx.field(static=True)

    def __call__(
        self, time: Float[Array, ""], measurement: Measurement, memory: tuple[Any, ...]
    ) -> tuple[Correction, tuple[Any, ...]]:
        """Return the sum of all corrections and every law's memory rate; arguments as in `AbstractLaw`."""
        total, rates = Correction(), []
        for law, own in zip(self.laws, memory, strict=True):
            correction, rate = law(time, measurement, own)
            total = Correction(*(a + b for a, b in zip(total, correction, strict=True)))
            rates.append(rate)
        return total, tuple(rates)

    def joined(self, others: Mapping[str, AbstractLaw]) -> "LayeredLaw":
        """Return these laws with more of them, by name."""
        return LayeredLaw((*self.laws, *others.values()), (*self.names, *others))

    def initial_memory(self, measurement: Measurement) -> tuple[Any, ...]:
        """Return the memories of all laws."""
        return tuple(law.initial_memory(measurement) for law in self.laws)
