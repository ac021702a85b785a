"""One clear line out of pydantic's list of problems. Depends on: pydantic, errors."""

import re
from typing import Any

from pydantic import ValidationError

from tethership.errors import MOST_LETTERS, shown, suggestion
from tethership.scenario.quantity import SI_UNIT


def first_problem(error: ValidationError, origin: str, document: Any) -> str:
    """Return one line: file, key, what came, what is allowed; and how many more problems there are.

    Parameters
    ----------
    error : ValidationError
        What pydantic raised.
    origin : str
        File or packaged name.
    document : Any
        What was validated; list items are named by their `name` where they have one.
    """
    problems = error.errors(include_url=False)
    key = _dotted(document, problems[0]["loc"], problems[0]["type"] == "missing") or "the file"
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return f"{origin}: {key}: {_said(problems[0])}{more}"


def _dotted(document: Any, location: tuple[int | str, ...], missing: bool) -> str:
    """Return the path of a key as the file has it, without the tags pydantic adds for unions.

    Parameters
    ----------
    document : Any
        What was validated.
    location : tuple
        Where, as pydantic says it.
    missing : bool
        Whether the last step is a key that is not there.
    """
    keys: list[str] = []
    here: Any = document
    for index, step in enumerate(location):
        inside_list = isinstance(here, list) and isinstance(step, int) and step < len(here)
        inside_table = isinstance(here, dict) and step in here
        if not inside_list and not inside_table:
            if missing and index == len(location) - 1:
                keys.append(str(step))
            continue
        here = here[step]  # pyright: ignore[reportCallIssue, reportArgumentType]
        name = here.get("name") if inside_list and isinstance(here, dict) else None
        keys.append(str(name or step))
    return ".".join(key if len(key) <= MOST_LETTERS else shown(key) for key in keys)


def _said(problem: Any) -> str:
    """Return what is wrong with one value."""
    kind = problem["type"]
    if kind == "missing" and isinstance(problem["loc"][-1], int):
        return "there are too few numbers in the list"
    if kind == "tuple_type":
        example = 'e.g. ["rewind"]' if isinstance(problem["input"], str) else "or leave it out"
        return f"it is {_came(problem['input'])}; give a list, {example}"
    if kind == "missing":
        return "it is missing; add it (`tethership new` writes a complete file to start from)"
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        context = problem["ctx"]
        allowed = context.get("expected_tags", "the known kinds")
        near = suggestion(str(context.get("tag", "")), re.findall(r"'([^']*)'", allowed)).rstrip(".")
        key = "'model'" if context["discriminator"].endswith("()") else context["discriminator"]
        return f"give {key} as one of {allowed}{near}"
    if kind == "value_error":
        return str(problem["ctx"]["error"])
    return f"it is {_came(problem['input'])}; {problem['msg'][0].lower()}{problem['msg'][1:]}"


def _came(value: Any) -> str:
    """Return a value as it was given: a bare number of a change has been given a unit on its way."""
    bare = isinstance(value, dict) and value.keys() == {"value", "unit"} and value["unit"] == SI_UNIT
    return shown(value["value"] if bare else value)
