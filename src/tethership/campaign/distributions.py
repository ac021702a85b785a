"""Distributions of a varied quantity, as a campaign file gives them. Depends on: scipy, scenario.quantity.

Each is read in its own unit and returns the quantile of a probability in SI, so that every way of sampling (random,
Sobol, Latin hypercube, correlated) goes through one function.
"""

import abc
import math
from typing import Annotated, Literal

import numpy as np
import scipy.stats
from pydantic import Field, model_validator

from tethership.scenario import Table, converted

MOST_LEVELS = 100_000
"""Levels of one quantity on a grid."""


class _Spread(Table, abc.ABC):
    """What all have in common: `unit` of the numbers, or `relative`, numbers being multiples of the scenario's."""

    unit: str | None = None
    relative: bool = False

    @model_validator(mode="after")
    def _unit_or_relative(self) -> "_Spread":
        if self.relative and self.unit is not None:
            raise ValueError("relative numbers are multiples of the scenario's own and have no unit; take unit out")
        if not self.relative and self.unit is None:
            raise ValueError('it needs a unit ("1" for a plain number), or relative = true')
        return self

    @abc.abstractmethod
    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return values in the file's unit at probabilities between 0 and 1."""

    def levels(self) -> np.ndarray:
        """Return the values of a full-factorial grid in the file's unit."""
        raise ValueError("a grid takes `discrete` values, or `uniform` with its number of levels")

    def in_si(self, values: np.ndarray, own: float, si_unit: str) -> np.ndarray:
        """Return values of the file in SI for the scenario's own value and unit of the quantity."""
        if self.relative:
            return values * own
        zero = converted(0.0, str(self.unit), si_unit)  # degrees Celsius and the like have another zero
        return zero + values * (converted(1.0, str(self.unit), si_unit) - zero)


class Uniform(_Spread):
    """Evenly between `low` and `high`; on a grid `number` levels, ends included.

    Attributes
    ----------
    low, high : float
        Ends, in `unit` or relative to the scenario's own value [-].
    number : int, optional
        How many levels a grid has.
    """

    distribution: Literal["uniform"]
    low: float
    high: float
    number: Annotated[int, Field(ge=2, le=MOST_LEVELS)] | None = None

    @model_validator(mode="after")
    def _ordered(self) -> "Uniform":
        if not self.low < self.high:
            raise ValueError(f"low {self.low:g} must be below high {self.high:g}")
        return self

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return low + p (high − low), in the file's unit, at probabilities p [-]."""
        return self.low + probability * (self.high - self.low)

    def levels(self) -> np.ndarray:
        """Return the levels of a grid, in the file's unit or relative [-], shape (number,)."""
        if self.number is None:
            raise ValueError("a grid needs the number of levels: number = 5")
        return np.linspace(self.low, self.high, self.number)


class Normal(_Spread):
    """Normal about `mean`; with `low` or `high` cut off there (truncated).

    Attributes
    ----------
    mean, deviation, low, high : float
        In `unit` or relative to the scenario's own value [-].
    """

    distribution: Literal["normal"]
    mean: float
    deviation: Annotated[float, Field(gt=0)]
    low: float = -math.inf
    high: float = math.inf

    @model_validator(mode="after")
    def _some_left(self) -> "Normal":
        left = np.diff(scipy.stats.norm.cdf([self.low, self.high], self.mean, self.deviation))[0]
        if not left > 1e-9:
            raise ValueError(f"between low {self.low:g} and high {self.high:g} nothing of the distribution is left")
        return self

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return the quantile at probabilities [-], in the file's unit, truncated where bounds are given."""
        low, high = (self.low - self.mean) / self.deviation, (self.high - self.mean) / self.deviation
        return scipy.stats.truncnorm.ppf(probability, low, high, self.mean, self.deviation)


class Lognormal(_Spread):
    """The logarithm is normal: `median`, and `deviation` of the logarithm.

    Attributes
    ----------
    median : float
        In `unit` or relative to the scenario's own value [-].
    deviation : float
        Of the natural logarithm [-].
    """

    distribution: Literal["lognormal"]
    median: Annotated[float, Field(gt=0)]
    deviation: Annotated[float, Field(gt=0)]

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return median · exp(deviation · Φ⁻¹(p)), in the median's unit, at probabilities p [-]."""
        return scipy.stats.lognorm.ppf(probability, self.deviation, scale=self.median)


class Weibull(_Spread):
    """As winds are distributed: `scale` and `shape`, from `low` to `high` where they are given.

    Attributes
    ----------
    scale, low, high : float
        In `unit` or relative to the scenario's own value [-].
    shape : float
        k [-].
    """

    distribution: Literal["weibull"]
    scale: Annotated[float, Field(gt=0)]
    shape: Annotated[float, Field(gt=0)]
    low: Annotated[float, Field(ge=0)] = 0.0
    high: float = math.inf

    @model_validator(mode="after")
    def _some_left(self) -> "Weibull":
        if not np.diff(self._cumulative())[0] > 1e-9:
            raise ValueError(f"between low {self.low:g} and high {self.high:g} nothing of the distribution is left")
        return self

    def _cumulative(self) -> np.ndarray:
        return scipy.stats.weibull_min.cdf([self.low, self.high], self.shape, scale=self.scale)

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return the quantile at probabilities [-], in the scale's unit, truncated where bounds are given."""
        below, above = self._cumulative()
        return scipy.stats.weibull_min.ppf(below + probability * (above - below), self.shape, scale=self.scale)


class Discrete(_Spread):
    """One of `values`, with `weights` where they are not equally likely.

    Attributes
    ----------
    values : tuple of float
        In `unit` or relative to the scenario's own value [-].
    weights : tuple of float, optional
        Of each value [-]; they need not add up to 1.
    """

    distribution: Literal["discrete"]
    values: Annotated[tuple[float, ...], Field(min_length=1)]
    weights: tuple[Annotated[float, Field(ge=0)], ...] | None = None

    @model_validator(mode="after")
    def _weighed(self) -> "Discrete":
        if self.weights is not None and (len(self.weights) != len(self.values) or not 0 < sum(self.weights) < math.inf):
            raise ValueError(f"{len(self.values)} values need as many weights, not all zero")
        return self

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return the value whose share of the weights a probability [-] falls into, in the file's unit."""
        weights = np.ones(len(self.values)) if self.weights is None else np.array(self.weights)
        edges = np.cumsum(weights) / np.sum(weights)
        return np.array(self.values)[np.minimum(np.searchsorted(edges, probability, side="right"), len(edges) - 1)]

    def levels(self) -> np.ndarray:
        """Return the values."""
        return np.array(self.values)


class Whole(_Spread):
    """A whole number from `low` to `high`, both included: the seed of turbulence.

    Attributes
    ----------
    low, high : int
        Ends [-].
    """

    distribution: Literal["whole"]
    low: int = 1
    high: int = 2**31 - 2
    unit: str | None = "1"

    @model_validator(mode="after")
    def _ordered(self) -> "Whole":
        if not self.low < self.high:
            raise ValueError(f"low {self.low} must be below high {self.high}")
        return self

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Return low + ⌊p (high − low + 1)⌋ [-] at probabilities p [-]."""
        count = self.high - self.low + 1
        return self.low + np.minimum(np.floor(probability * count), count - 1)


Distribution = Annotated[Uniform | Normal | Lognormal | Weibull | Discrete | Whole, Field(discriminator="distribution")]
"""Every distribution that a file may name."""
