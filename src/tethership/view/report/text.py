"""Text and numbers of a report as HTML: all escaped, minus signs and powers as in print. Depends on: markupsafe."""

import math
import numbers
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from markupsafe import Markup

from tethership.errors import ConfigError, suggestion

DIGITS = 4
"""Significant digits of numbers."""

THIN = "\N{NARROW NO-BREAK SPACE}"
"""Between thousands, from 10 000 on."""

_MARK = re.compile(
    r"`(?P<code>[^`]+)`|\*\*(?P<bold>[^`]+?)\*\*|\[\[(?P<label>[^\[\]`]+)\]\]"
    r"|(?P<address>https?://[^\s<>\"'`]*[^\s<>\"'`.,;:!?)\]])"
)
"""No Markdown: its single stars and underscores would eat those of names such as `vehicle.fins.*.area`."""

_NUMBER = re.compile(r"[<>≤≥≈±]?\s*[+−-]?\d[\d\s.,]*(e[+-]?\d+)?\s*%?", re.IGNORECASE)


class Place(NamedTuple):
    """What a label stands for.

    Attributes
    ----------
    name : str
        As it is called: Table 3.
    anchor : str
        Identifier of its element.
    """

    name: str
    anchor: str


Places = Mapping[str, Place]
"""Places by label."""


def marked(text: str, places: Places | None = None) -> Markup:
    """Return a text as HTML, with its code, bold words, addresses and, where there are places, its labels.

    Parameters
    ----------
    text : str
        Plain text with the marks that `Section` allows.
    places : mapping, optional
        Places by label; without them labels stay as they are.

    Raises
    ------
    ConfigError
        A label is not that of a table, figure or section.
    """
    done, end = Markup(), 0
    for found in _MARK.finditer(text):
        done += text[end : found.start()]
        done += _element(found, places)
        end = found.end()
    return done + text[end:]


def _element(found: re.Match[str], places: Places | None) -> Markup | str:
    """Return what a mark stands for; a string is still to be escaped."""
    match found.lastgroup, found[found.lastgroup or 0]:
        case "code", words:
            return Markup("<code>{}</code>").format(words)
        case "bold", words:
            return Markup("<strong>{}</strong>").format(marked(words, places))
        case "address", words:
            return Markup('<a href="{0}">{0}</a>').format(words)
        case _, label if places is not None:
            if label not in places:
                known = suggestion(label, places)
                raise ConfigError(f"the report has no table, figure or section labelled {label!r}{known}")
            return Markup('<a href="#{}">{}</a>').format(places[label].anchor, places[label].name)
    return found[0]


def plain(text: str) -> str:
    """Return a text without its marks: for titles and alternatives of pictures."""
    return _MARK.sub(lambda found: found["code"] or found["bold"] or found[0], text)


def number(value: float) -> Markup:
    """Return a number as HTML: four significant digits, whole ones in full, a power of ten where it is far from 1."""
    if math.isnan(value):
        return Markup("not a number")
    if math.isinf(value):
        return Markup("∞" if value > 0 else "−∞")
    size = abs(value)
    if isinstance(value, numbers.Integral):
        text = f"{size:,}"
    elif size == 0.0:
        text = "0"
    elif 1e-3 <= size < 1e6:
        decimals = max(0, DIGITS - 1 - math.floor(math.log10(size)))
        text = f"{size:,.{decimals}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
    else:
        mantissa, power = f"{size:.{DIGITS - 2}e}".split("e")
        text = f"{mantissa} × 10<sup>{str(int(power)).replace('-', '−')}</sup>"
    text = text.replace(",", "" if size < 9999.5 else THIN)
    return Markup(f"−{text}" if value < 0 else text)


def is_number(value: Any) -> bool:
    """Return whether a cell is a number or text that reads as one."""
    if isinstance(value, str):
        return _NUMBER.fullmatch(value.strip()) is not None
    return isinstance(value, numbers.Real) and not isinstance(value, bool)
