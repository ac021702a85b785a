"""What is packaged: names, texts and a line on each. Depends on: scenario.reading, errors.

Nothing else is imported: the command line offers these names when Tab is pressed.
"""

from typing import Any

from tethership.errors import ConfigError, shown, suggestion
from tethership.scenario.reading import parse_toml

KINDS = ("scenarios", "vehicles", "solvers", "campaigns")
"""What is packaged, by folder."""


def _packaged(folder: str) -> dict[str, Any]:
    """Return the packaged files of a folder of `data`, by name."""
    from importlib import resources

    root = resources.files("tethership") / "data" / folder
    return {item.name[:-5]: item for item in root.iterdir() if item.name.endswith(".toml")}


def list_packaged() -> dict[str, list[str]]:
    """Return the names of the packaged scenarios, vehicles, solvers and campaigns.

    Examples
    --------
    >>> import tethership as ts
    >>> ts.list_packaged()["solvers"]
    ['adaptive', 'fixed', 'tight']
    """
    return {kind: sorted(_packaged(kind)) for kind in KINDS}


def packaged_text(folder: str, name: str) -> str:
    """Return the text of a packaged file, or raise ConfigError that offers the nearest name."""
    files = _packaged(folder)
    if name in files:
        return files[name].read_text(encoding="utf-8")
    raise ConfigError(
        f"no {folder[:-1]} {shown(name)}{suggestion(name, files)} Packaged: {', '.join(sorted(files))}; "
        "a file of your own ends in .toml"
    )


def describe_packaged() -> dict[str, dict[str, str]]:
    """Return what is packaged: kind → name → one line."""
    found: dict[str, dict[str, str]] = {}
    for kind in KINDS:
        documents = {name: parse_toml(packaged_text(kind, name), name) for name in sorted(_packaged(kind))}
        found[kind] = {name: d.get("description") or d.get("title", "") for name, d in documents.items()}
    return found
