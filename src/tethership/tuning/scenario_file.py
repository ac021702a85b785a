"""A scenario file with tuned gains: the packaged file with other numbers, all else kept. Depends on: tomlkit."""

from collections.abc import Mapping
from typing import Any

import tomlkit

from tethership.errors import ConfigError


def retuned_text(template: str, gains: Mapping[str, float], wind: float, words: Mapping[str, str], source: str) -> str:
    """Return a scenario file's text with other gains, wind and words; its comments and order stay.

    Parameters
    ----------
    template : str
        Text of the scenario whose other numbers stay.
    gains : mapping
        Dotted name → value [SI]; the file's own unit must be SI.
    wind : float
        [m/s].
    words : mapping
        Values of top-level keys that are words: title, description, formulation.
    source : str
        Of the gains.

    Raises
    ------
    ConfigError
        The template has no line for one of the gains.
    """
    document = tomlkit.parse(template)
    document.update({key: word for key, word in words.items() if key in document})
    missing = [name for name, value in gains.items() if not _set(document, name, value, source)]
    missing += [] if _set(document, "wind.speed", wind, "") else ["wind.speed"]
    if missing:
        raise ConfigError(f"the scenario template has no line for {', '.join(missing)}; start from docking_paper")
    return tomlkit.dumps(document)


def _set(document: Any, name: str, value: float, source: str) -> bool:
    """Set a quantity by its dotted name; returns whether the document has it."""
    *tables, key = name.split(".")
    for table in tables:
        document = document.get(table, {})
    if "unit" not in document.get(key, {}):
        return False
    set_quantity(document[key], value, source)
    return True


def set_quantity(entry: Any, value: float, source: str) -> None:
    """Give a quantity of a document another value, to six digits, and another source, none if it is empty.

    The value is in the unit that the document's entry names.
    """
    entry["value"] = float(f"{value:.6g}")
    if source:
        entry["source"] = source
    else:
        entry.pop("source", None)
