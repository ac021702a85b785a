"""Text and numbers of a report as HTML: everything escaped, minus signs and powers as in print. Depends on nothing."""

import html
import math
import numbers
import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from tethership.errors import ConfigError, suggestion

NONE = "–"
"""Shown where there is no value."""

DIGITS = 4
"""Significant digits of numbers."""

THIN = "\N{NARROW NO-BREAK SPACE}"
"""Between thousands, from 10 000 on."""

_CODE = re.compile(r"`([^`]+)`")
_BOLD = re.compile(r"\*\*(.+?)\*\*")
_LABEL = re.compile(r"\[\[([^\[\]]+)\]\]")
_ADDRESS = re.compile(r"https?://[^\s<>\"'`]*[^\s<>\"'`.,;:!?)\]]")
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


def escaped(text: Any) -> str:
    """Return text in which nothing is HTML."""
    return html.escape(str(text), quote=True)


def marked(text: str, places: Places | None = None) -> str:
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
    parts = _CODE.split(text)
    return "".join(
        f"<code>{escaped(part)}</code>" if index % 2 else _prose(part, places) for index, part in enumerate(parts)
    )


def plain(text: str) -> str:
    """Return a text without its marks, escaped: for titles and alternatives of pictures."""
    return escaped(_BOLD.sub(r"\1", _CODE.sub(r"\1", text)))


def _prose(text: str, places: Places | None) -> str:
    """Return a text without code as HTML."""
    pieces, end = [], 0
    for found in _ADDRESS.finditer(text):
        pieces += [escaped(text[end : found.start()]), f'<a href="{escaped(found[0])}">{escaped(found[0])}</a>']
        end = found.end()
    done = _BOLD.sub(r"<strong>\1</strong>", "".join([*pieces, escaped(text[end:])]))
    return done if places is None else _LABEL.sub(lambda found: _link(html.unescape(found[1]), places), done)


def _link(label: str, places: Places) -> str:
    """Return a link to what a label stands for."""
    if label not in places:
        raise ConfigError(f"the report has no table, figure or section labelled {label!r}{suggestion(label, places)}")
    return f'<a href="#{places[label].anchor}">{places[label].name}</a>'


def number(value: float) -> str:
    """Return a number as HTML: four significant digits, whole ones in full, a power of ten where it is far from 1."""
    if math.isnan(value):
        return "not a number"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
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
    return f"−{text}" if value < 0 else text


def is_number(value: Any) -> bool:
    """Return whether a cell is a number or text that reads as one."""
    if isinstance(value, str):
        return _NUMBER.fullmatch(value.strip()) is not None
    return isinstance(value, numbers.Real) and not isinstance(value, bool)
