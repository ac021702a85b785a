"""Docstrings as they are written here, made digestible for reStructuredText.

Equations stand as plain text, with |…| for norms; indented lines are set as they are.
"""

import re
from typing import Any

from sphinx.application import Sphinx

INDENT = "    "


def digest(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Escape bars, and set equations that stand indented by themselves as literal blocks; in place."""
    done: list[str] = []
    literal = False
    for number, line in enumerate(lines):
        indented = line.startswith(INDENT)
        opens = indented and number > 0 and not lines[number - 1].strip()
        if line.strip() and not indented:
            literal = False
        elif opens and not literal and _after_text(done):
            literal = True
            done += ["::", ""]
        done.append(line if literal else _escaped(line))
    lines[:] = done


def _after_text(done: list[str]) -> bool:
    """Whether the last line that is not empty is ordinary text: no `name : type`, and not opening a block itself."""
    last = next((line for line in reversed(done) if line.strip()), "")
    return not last.startswith(" ") and not last.rstrip().endswith("::") and not re.match(r"^\S+( , \S+)* : ", last)


def _escaped(line: str) -> str:
    """Return a line whose bars and lone asterisks outside of code are plain characters."""
    parts = re.split(r"(``[^`]*``|`[^`]*`)", line)
    return "".join(part if part.startswith("`") else part.replace("|", r"\|") for part in parts)


def shorten(
    app: Sphinx, what: str, name: str, thing: Any, options: Any, signature: str | None, returns: str | None
) -> tuple[str | None, str | None]:
    """Write a signature's arrays as its source does."""
    short = [
        part and part.replace("jaxlib._jax.Array", "Array").replace("~numpy.", "") for part in (signature, returns)
    ]
    return short[0], short[1]


def skip_fields(app: Sphinx, what: str, name: str, thing: Any, skip: bool, options: Any) -> bool | None:
    """Leave out the fields of named tuples: the class's own text says what they are."""
    return True if type(thing).__name__ in ("_tuplegetter", "tuplegetter") else None


def setup(app: Sphinx) -> dict[str, Any]:
    """Come before napoleon, which reads the sections."""
    app.connect("autodoc-process-docstring", digest, priority=400)
    app.connect("autodoc-process-signature", shorten)
    app.connect("autodoc-skip-member", skip_fields)
    return {"parallel_read_safe": True}
