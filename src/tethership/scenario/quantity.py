"""Quantities in files: `{ value = 16.0, unit = "m", source = "Table 2" }`, turned to SI on reading.

Depends on: pint for the units, pydantic for where they stand, JAX for tables as pytrees.
"""

import difflib
import functools
import math
from collections.abc import Callable, Iterable
from typing import Annotated, Any

import jax
import pint
from pydantic import AfterValidator, BeforeValidator, ConfigDict, model_validator
from pydantic import BaseModel as PydanticModel

SI_UNIT = "SI"
"""Unit name for a number that is already in the field's SI unit, as an override gives it."""


class Table(PydanticModel):
    """A table of a file: no unknown key, nothing changed after reading.

    Every table is also a JAX pytree whose leaves are its numbers, so that a plant can be built inside a compiled
    function and differentiated with respect to any number of its files.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, arbitrary_types_allowed=True)

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        jax.tree_util.register_pytree_with_keys(cls, cls._flatten, cls._unflatten)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, datum: Any) -> Any:
        for key in datum if isinstance(datum, dict) else ():
            if key not in cls.model_fields:
                near = difflib.get_close_matches(str(key), cls.model_fields, n=1)
                hint = f"; did you mean {near[0]!r}?" if near else ""
                raise ValueError(f"unknown key {key!r}{hint} Allowed: {', '.join(cls.model_fields)}")
        return datum

    def _flatten(self) -> tuple[list[tuple[Any, Any]], tuple[str, ...]]:
        names = tuple(type(self).model_fields)
        return [(jax.tree_util.GetAttrKey(name), getattr(self, name)) for name in names], names

    @classmethod
    def _unflatten(cls, names: tuple[str, ...], values: Iterable[Any]) -> "Table":
        return cls.model_construct(**dict(zip(names, values, strict=True)))


@functools.cache
def unit_registry() -> pint.UnitRegistry:
    """Return the one registry of units; building it takes a third of a second."""
    return pint.UnitRegistry()


def _converted(value: float, unit: str, si_unit: str) -> float:
    """Return a number in the SI unit, or say why it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"the value is {value!r}, not a number")
    if not math.isfinite(value):
        raise ValueError(f"the value is {value}, not a finite number")
    if unit in (si_unit, SI_UNIT):
        return float(value)
    pint_name = {"1": "dimensionless", "-": "dimensionless"}
    try:
        return float(
            unit_registry().Quantity(value, pint_name.get(unit, unit)).m_as(pint_name.get(si_unit, si_unit))
        )
    except pint.DimensionalityError as error:
        raise ValueError(f"the unit is {unit!r}, which is no {si_unit!r}; give one that converts to it") from error
    except Exception as error:
        raise ValueError(f"the unit is {unit!r}, which is not known; give {si_unit!r}") from error


def _reader(si_unit: str, depth: int, sourced: bool) -> Callable[[Any], Any]:
    """Return the function that reads one quantity of a given nesting (0 number, 1 vector, 2 matrix)."""
    form = f'{{ value = {"[" * depth}…{"]" * depth}, unit = "{si_unit}"{", source = …" if sourced else ""} }}'

    def nested(value: Any, unit: str, level: int) -> Any:
        if level == 0:
            return _converted(value, unit, si_unit)
        if not isinstance(value, list | tuple):
            raise ValueError(f"the value is {value!r}, not a list; write {form}")
        return tuple(nested(item, unit, level - 1) for item in value)

    def read(datum: Any) -> Any:
        if not isinstance(datum, dict):
            raise ValueError(f"a number needs its unit: write {form}")
        unknown = set(datum) - {"value", "unit", "source"}
        missing = {"value", "unit"} - set(datum)
        if sourced and datum.get("unit") != SI_UNIT and "source" not in datum:
            missing.add("source")
        if unknown or missing:
            what = f"unknown {sorted(unknown)}" if unknown else f"missing {sorted(missing)}"
            raise ValueError(f"{what}; write {form}")
        return nested(datum["value"], str(datum["unit"]), depth)

    return read


def _bounded(low: float | None, high: float | None, open_low: bool) -> Callable[[Any], Any]:
    """Return a check of a number (or of every number of a list) against bounds in SI."""

    def check(value: Any) -> Any:
        items = value if isinstance(value, tuple) else (value,)
        for item in items:
            if low is not None and (item <= low if open_low else item < low):
                raise ValueError(f"it is {item:g}; it must be {'above' if open_low else 'at least'} {low:g}")
            if high is not None and item > high:
                raise ValueError(f"it is {item:g}; it must be at most {high:g}")
        return value

    return check


def quantity(
    unit: str,
    *,
    low: float | None = None,
    high: float | None = None,
    positive: bool = False,
    sourced: bool = False,
    kind: Any = float,
    depth: int = 0,
) -> Any:
    """Return the pydantic type of a quantity.

    Parameters
    ----------
    unit : str
        SI unit in which it arrives inside.
    low, high : float, optional
        Bounds in SI, included.
    positive : bool
        It must be above zero.
    sourced : bool
        `source` must be given too (vehicles).
    kind : type
        Python type after reading.
    depth : int
        0 for a number, 1 for a vector, 2 for a matrix.
    """
    check = _bounded(0.0 if positive else low, high, open_low=positive)
    return Annotated[kind, BeforeValidator(_reader(unit, depth, sourced)), AfterValidator(check)]


Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]
