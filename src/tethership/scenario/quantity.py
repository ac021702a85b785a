"""Quantities in files: `{ value = 16.0, unit = "m", source = "Table 2" }`, turned to SI on reading.

Depends on: pint for the units, pydantic for where they stand, JAX for tables as pytrees.
"""

import dataclasses
import functools
import math
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Any, Self

import jax
import numpy as np
from pydantic import BaseModel as PydanticModel
from pydantic import ConfigDict, GetCoreSchemaHandler, model_validator
from pydantic_core import core_schema

from tethership.errors import shown, suggestion
from tethership.scenario.units import factor, to_base

if TYPE_CHECKING:
    import pint

NUMBER_WITH_UNIT = re.compile(
    r"(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(?P<unit>(?![eE][-+]?\d)[A-Za-z].*)"
)
"""A number with a unit as it is typed, `270deg` or `12 m/s`; 1e5 has none."""

MOST_TYPED = 100
"""Letters of a number with its unit."""

UNIT = re.compile(r"(?:(?:[A-Za-zµμ°Ω%_]+[²³]?|1(?!\d)|\))(?:(?:\*\*|\^)[-+]?\d(?![\d.]))?|[ */·(-])*")
"""A unit: words, 1, brackets, exponents of one digit. Checked first, for to pint a unit is a sum to be worked out."""

LONGEST_UNIT = 40

LARGEST = 1e18
"""Nothing of an airship is larger [SI], and no product of a few such numbers overflows."""

SMALLEST = 1e-18
"""The least of a number that must be above zero [SI]: one may divide by it."""

SI_UNIT = "SI"
"""Unit name for a number that is already in the field's SI unit, as an override gives it."""


ANGLE_UNITS = ("rad", "radian", "radians", "mrad", "deg", "degree", "degrees", "arcmin", "turn")
"""Units of plane angles: to pint they are plain numbers, so they are told apart here."""


class Table(PydanticModel):
    """A table of a file: no unknown key, no text or bool for a number, nothing that is not finite or changes later.

    Every table is also a JAX pytree whose leaves are its numbers, so that a plant can be built inside a compiled
    function and differentiated with respect to any number of its files.
    """

    model_config = ConfigDict(
        extra="forbid", frozen=True, arbitrary_types_allowed=True, strict=True, allow_inf_nan=False
    )

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        jax.tree_util.register_pytree_with_keys(cls, cls._flatten, cls._unflatten)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, datum: Any) -> Any:
        for key in datum if isinstance(datum, dict) else ():
            if key not in cls.model_fields:
                hint = suggestion(str(key), cls.model_fields)
                raise ValueError(f"unknown key {shown(key)}{hint} Allowed: {', '.join(cls.model_fields)}")
        return {key: _tuples(value) for key, value in datum.items()} if isinstance(datum, dict) else datum

    def as_arrays(self) -> Self:
        """Return the table with its numbers as arrays: a compiled function then serves every value of them."""
        return jax.tree.map(lambda leaf: np.asarray(leaf) if isinstance(leaf, float) else leaf, self)

    def _flatten(self) -> tuple[list[tuple[Any, Any]], tuple[str, ...]]:
        names = tuple(type(self).model_fields)
        return [(jax.tree_util.GetAttrKey(name), getattr(self, name)) for name in names], names

    @classmethod
    def _unflatten(cls, names: tuple[str, ...], values: Iterable[Any]) -> Self:
        return cls.model_construct(**dict(zip(names, values, strict=True)))


def _tuples(value: Any) -> Any:
    """Return a list, and lists in it, as tuples, which strict types ask for."""
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


@functools.cache
def unit_registry() -> "pint.UnitRegistry":
    """Return the one registry of units; building it takes a third of a second."""
    import pint

    return pint.UnitRegistry()


def number_with_unit(text: str) -> tuple[float, str] | None:
    """Return number and unit of a text such as `270deg`, or None where it is no such text."""
    found = NUMBER_WITH_UNIT.fullmatch(text.strip()) if len(text) <= MOST_TYPED else None
    return None if found is None else (float(found["number"]), found["unit"])


def converted(value: float, unit: str, si_unit: str) -> float:
    """Return a number in the SI unit, or raise ValueError that says why it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"the value is {shown(value)}, not a number")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError(f"the value is {value}, not a finite number")
    if abs(value) > LARGEST:
        raise ValueError(f"the value is {shown(value)}; numbers go up to {LARGEST:g}")
    found = float(value) if unit in (si_unit, SI_UNIT) else _by_unit(value, unit, si_unit)
    if not abs(found) <= LARGEST:
        raise ValueError(f"the value is {found:g} {si_unit}; numbers go up to {LARGEST:g}")
    return found


def in_unit(value: float, unit: str, wanted: str) -> float:
    """Return a number in another unit, or raise ValueError that says why it is none; `SI_UNIT` is that of `wanted`."""
    if unit == wanted:
        return converted(value, SI_UNIT, "1")
    if unit == SI_UNIT:
        base = to_base(wanted)
        if base is None:
            base = float(unit_registry().Quantity(1.0, wanted).to_base_units().magnitude)
        return converted(value, SI_UNIT, "1") / base
    return converted(value, unit, wanted)


def _by_unit(value: float, unit: str, si_unit: str) -> float:
    """Return a number in the SI unit, by way of pint where the unit is no usual one."""
    if len(unit) > LONGEST_UNIT or not UNIT.fullmatch(unit):
        raise ValueError(f"the unit is {shown(unit)}, which is no unit: letters, * / ^, exponents up to 9")
    if (si_unit == "rad" and unit not in ANGLE_UNITS) or (si_unit == "1" and unit in ANGLE_UNITS):
        wanted = "deg or rad" if si_unit == "rad" else "1"
        raise ValueError(f"the unit is {unit!r}, which is no {si_unit!r}; give {wanted}")
    times = factor(unit, si_unit)
    if times is not None:
        return value * times
    import pint

    pint_name = {"1": "dimensionless", "-": "dimensionless"}
    try:
        return float(unit_registry().Quantity(value, pint_name.get(unit, unit)).m_as(pint_name.get(si_unit, si_unit)))
    except pint.DimensionalityError as error:
        raise ValueError(f"the unit is {unit!r}, which is no {si_unit!r}; give one that converts to it") from error
    except Exception as error:
        raise ValueError(f"the unit is {unit!r}, which is not known; give {si_unit!r}") from error


@dataclasses.dataclass(frozen=True)
class Quantity:
    """What a number of a file is: stands in the `Annotated` type of a field.

    Attributes
    ----------
    unit : str
        SI unit in which it arrives inside.
    depth : int
        0 for a number, 1 for a vector, 2 for a matrix.
    low, high : float, optional
        Bounds in SI, included.
    positive : bool
        It must be above zero.
    sourced : bool
        `source` must be given too (vehicles).
    array : bool
        It becomes one array: samples, not parameters of their own.
    """

    unit: str
    depth: int = 0
    low: float | None = None
    high: float | None = None
    positive: bool = False
    sourced: bool = False
    array: bool = False

    def __get_pydantic_core_schema__(self, kind: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        checked = core_schema.no_info_after_validator_function(self._check, handler(kind))
        return core_schema.no_info_before_validator_function(self._read, checked)

    @property
    def form(self) -> str:
        """How it is written in a file."""
        value = "[" * self.depth + "…" + "]" * self.depth
        source = ', source = "…"' if self.sourced else ""
        return f'{{ value = {value}, unit = "{self.unit}"{source} }}'

    def _read(self, datum: Any) -> Any:
        """Return the value in SI, or raise ValueError that shows how to write it."""
        if not isinstance(datum, dict):
            raise ValueError(f"it is {shown(datum)}; a number needs its unit: write {self.form}")
        unknown = set(datum) - {"value", "unit", "source"}
        missing = {"value", "unit"} - set(datum)
        if self.sourced and datum.get("unit") != SI_UNIT and "source" not in datum:
            missing.add("source")
        if unknown or missing:
            what = f"unknown {shown(sorted(unknown))}" if unknown else f"missing {sorted(missing)}"
            raise ValueError(f"{what}; write {self.form}")
        for key in ("unit", "source"):
            if not isinstance(datum.get(key, ""), str):
                raise ValueError(f"{key} is {shown(datum[key])}, not a text; write {self.form}")
        value = self._nested(datum["value"], datum["unit"], self.depth)
        return np.asarray(value, dtype=float) if self.array else value

    def _nested(self, value: Any, unit: str, level: int) -> Any:
        if level == 0:
            return converted(value, unit, self.unit)
        if not isinstance(value, list | tuple):
            raise ValueError(f"the value is {shown(value)}, not a list; write {self.form}")
        return tuple(self._nested(item, unit, level - 1) for item in value)

    def _check(self, value: Any) -> Any:
        """Return the value, or raise ValueError where it is out of bounds."""
        for item in value if isinstance(value, tuple) else (value,):
            if self.positive and item <= 0:
                raise ValueError(f"it is {item:g} {self.unit}; it must be above 0")
            if self.positive and item < SMALLEST:
                raise ValueError(f"it is {item:g} {self.unit}; it must be at least {SMALLEST:g}")
            if self.low is not None and item < self.low:
                raise ValueError(f"it is {item:g} {self.unit}; it must be at least {self.low:g}")
            if self.high is not None and item > self.high:
                raise ValueError(f"it is {item:g} {self.unit}; it must be at most {self.high:g}")
        return value


Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

Angle = Annotated[float, Quantity("rad")]
Speed = Annotated[float, Quantity("m/s", low=0.0)]
Metres = Annotated[float, Quantity("m", positive=True)]
Seconds = Annotated[float, Quantity("s", positive=True)]
