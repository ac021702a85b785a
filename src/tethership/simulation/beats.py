"""The fixed steps of a batch, one after the other. Depends on: nothing."""

import math
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int


class Beat(NamedTuple):
    """One step, or the steps of a period of a sampled law, one after the other.

    Attributes
    ----------
    step : Float[Array, "..."]
        h [s].
    looks, acts : Bool[Array, "..."]
        What a sampled law does at its start; where it does both, it acts first.
    """

    step: Float[Array, "..."]
    looks: Bool[Array, "..."]
    acts: Bool[Array, "..."]


def beats_of(step: float, period: float | None = None, delay: float | None = None) -> Beat:
    """Return the steps of a batch: all alike, or such that a sampled law's ticks fall between two of them.

    Parameters
    ----------
    step : float
        Longest step h [s].
    period, delay : float, optional
        T and d of a sampled law [s].
    """
    if period is None:
        no = jnp.zeros(1, dtype=bool)
        return Beat(jnp.full(1, step), no, no)
    cut = delay if delay is not None and delay < period else 0.0
    counts = [math.ceil(part / step - 1e-9) for part in (cut, period - cut)]
    steps = [part / count for part, count in zip((cut, period - cut), counts, strict=True) for _ in range(count)]
    place = jnp.arange(sum(counts))
    acts = (place == counts[0]) if delay is not None else jnp.zeros(sum(counts), dtype=bool)
    return Beat(jnp.asarray(steps), place == 0, acts)


class Clock(NamedTuple):
    """The steps of a batch, over and over again.

    Attributes
    ----------
    beats : Beat
        Shape (beats,).
    starts : Float[Array, "beats"]
        When each begins within a round [s].
    whole : Float[Array, ""]
        Length of a round [s].
    """

    beats: Beat
    starts: Float[Array, "beats"]
    whole: Float[Array, ""]

    @classmethod
    def of(cls, beats: Beat) -> "Clock":
        """Return the clock of some steps."""
        return cls(beats, jnp.cumsum(beats.step) - beats.step, jnp.sum(beats.step))

    def time(self, count: Int[Array, ""]) -> Float[Array, ""]:
        """Return t [s] after so many steps."""
        size = len(self.starts)
        if size == 1:
            return count * self.beats.step[0]
        return (count // size) * self.whole + self.starts[count % size]

    def beat(self, count: Int[Array, ""]) -> Beat:
        """Return the step that follows so many."""
        size = len(self.starts)
        return jax.tree.map(lambda part: part[0] if size == 1 else part[count % size], self.beats)
