"""Tables of what a file may say, from its pydantic models and docs/reference/meanings.toml."""

import inspect
import tomllib
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from tethership.scenario.quantity import Quantity, Table

MEANINGS = tomllib.loads((Path(__file__).parents[1] / "reference" / "meanings.toml").read_text(encoding="utf-8"))
"""One line for every key, by the name of its model."""

SHAPES = {0: "number", 1: "list of numbers", 2: "matrix"}


def sections(model: type[Table], title: str, path: str = "", level: int = 2) -> list[str]:
    """Return the Markdown of a table of a file and of all tables in it."""
    lines = [f"{'#' * level} {title}", "", first_sentences(model), "", *rows(model), ""]
    for name, field in model.model_fields.items():
        for inner, many in tables_of(field):
            here = f"{path}{name}" if not path else f"{path}.{name}"
            kind = discriminator(inner)
            which = f', `{kind[0]} = "{kind[1]}"`' if kind else ""
            heading = f"`[[{here}]]`" if many else f"`[{here}]`"
            lines += sections(inner, f"{heading}{which}", here, min(level + 1, 4))
    return lines


def first_sentences(model: type[Table]) -> str:
    """Return a model's docstring as one paragraph, without its list of attributes."""
    text = inspect.cleandoc(model.__doc__ or "").split("\nAttributes\n")[0]
    return text.strip()


def rows(model: type[Table]) -> list[str]:
    """Return the table of a model's keys."""
    lines = ["| key | type | unit | default | meaning |", "|---|---|---|---|---|"]
    known = MEANINGS.get(model.__name__, {})
    if set(known) != set(model.model_fields):
        odd = sorted(set(known) ^ set(model.model_fields))
        raise ValueError(f"docs/reference/meanings.toml: [{model.__name__}] does not fit the model: {', '.join(odd)}")
    for name, field in model.model_fields.items():
        shape, unit = described(field)
        lines.append(f"| `{name}` | {shape} | {unit} | {default_of(field)} | {known[name]} |")
    return lines


def default_of(field: FieldInfo) -> str:
    """Return a field's default as text."""
    if field.is_required():
        return "**required**"
    value = field.default if field.default is not PydanticUndefined else (field.default_factory or (lambda: None))()
    if value is None or value in ((), {}, ""):
        return "–"
    if isinstance(value, Table):
        return "its own defaults"
    if isinstance(value, tuple):
        return "`[" + ", ".join(f"{item:g}" if isinstance(item, float) else f'"{item}"' for item in value) + "]`"
    return (
        f"`{value:g}`" if isinstance(value, float) else f"`{str(value).lower() if isinstance(value, bool) else value}`"
    )


def quantity_of(field: FieldInfo) -> Quantity | None:
    """Return what sort of number a field is, if it is one with a unit."""
    return next((part for part in parts(field) if isinstance(part, Quantity)), None)


def parts(field: FieldInfo) -> list[Any]:
    """Return everything that a field's annotation is made of."""
    pending, found = [*field.metadata, field.annotation], []
    while pending:
        entry = pending.pop(0)
        found.append(entry)
        if get_origin(entry) is Literal:
            continue
        pending += [*getattr(entry, "__metadata__", ()), *get_args(entry)]
    return found


def described(field: FieldInfo) -> tuple[str, str]:
    """Return a field's type and unit as text."""
    quantity = quantity_of(field)
    if quantity:
        bounds = ["above 0"] if quantity.positive else []
        bounds += [f"≥ {quantity.low:g}"] if quantity.low is not None else []
        bounds += [f"≤ {quantity.high:g}"] if quantity.high is not None else []
        return f"{SHAPES[quantity.depth]}{', ' if bounds else ''}{', '.join(bounds)}", f"{quantity.unit}"
    if tables_of(field):
        return ("tables" if tables_of(field)[0][1] else "table"), ""
    literals = [part for part in parts(field) if get_origin(part) is Literal]
    if literals:
        return " or ".join(f'`"{value}"`' for value in get_args(literals[0])), ""
    names = {str: "text", float: "number", int: "whole number", bool: "`true` or `false`"}
    origin = get_origin(field.annotation)
    if origin is dict:
        value = get_args(field.annotation)[1]
        return f"table of {'numbers' if value is float else 'values'} by name", ""
    if origin is tuple:
        kinds = [part for part in parts(field) if part in names]
        return f"list of {'names' if kinds[0] is str else 'numbers'}", ""
    return next((names[part] for part in parts(field) if part in names), "value"), ""


def tables_of(field: FieldInfo) -> list[tuple[type[Table], bool]]:
    """Return the tables that a field holds, and whether it holds a list of them."""
    many = get_origin(field.annotation) is tuple
    return [(part, many) for part in parts(field) if isinstance(part, type) and issubclass(part, Table)]


def discriminator(model: type[Table]) -> tuple[str, str] | None:
    """Return the key and value that choose a model among several."""
    for name in ("model", "profile", "distribution"):
        field = model.model_fields.get(name)
        if field is not None and get_origin(field.annotation) is Literal:
            return name, get_args(field.annotation)[0]
    return None
