"""What studies add to the library, by entry points: nothing here imports a study.

A package names its commands under `tethership.commands` and the functions that it offers under `tethership.studies`.
"""

from importlib.metadata import EntryPoint, entry_points
from typing import Any

from tethership.errors import ConfigError

COMMANDS, OFFERS = "tethership.commands", "tethership.studies"
"""Groups of entry points."""


def commands() -> list[EntryPoint]:
    """Return the commands that studies add, by name."""
    return sorted(entry_points(group=COMMANDS), key=lambda entry: entry.name)


def studied(name: str) -> Any:
    """Return what a study offers under a name; raises ConfigError where none does."""
    for entry in entry_points(group=OFFERS, name=name):
        return entry.load()
    raise ConfigError(f"no installed study offers {name!r}; install the package again (make dock)")
