"""The one folder that the explorer reads and writes; nothing outside it is touched. Depends on: scenario."""

import re
from pathlib import Path
from typing import Any

from tethership.errors import ConfigError
from tethership.results import write_atomically
from tethership.scenario import Scenario, list_packaged, load_scenario, read_document

FILE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,80}\.toml")
"""Names that may be read and written: no separators, nothing hidden."""


class Folder:
    """Scenario files of one folder, besides the packaged ones.

    Parameters
    ----------
    root : Path
        The folder.

    Raises
    ------
    ConfigError
        It is no folder.
    """

    def __init__(self, root: Path) -> None:
        if not root.is_dir():
            raise ConfigError(f"--folder {root} is no folder; name one that exists")
        self.root = root.resolve()

    def scenarios(self) -> list[str]:
        """Return the names that can be chosen: packaged, then the scenario files of the folder."""
        own = [path.name for path in sorted(self.root.glob("*.toml")) if self._is_scenario(path)]
        return [*list_packaged()["scenarios"], *own]

    def path(self, name: str) -> Path:
        """Return where a file of the folder is.

        Raises
        ------
        ConfigError
            The name is not that of a file directly inside the folder.
        """
        if not FILE_NAME.fullmatch(name):
            raise ConfigError(f"{name!r} is no name for a scenario file here; use letters, digits, _ or -, then .toml")
        path = (self.root / name).resolve()
        if path.parent != self.root:
            raise ConfigError(f"{name!r} lies outside {self.root}; only files of that folder are used")
        return path

    def located(self, name: str) -> str:
        """Return what `load_scenario` takes for a name: a packaged name, or a path inside the folder.

        Raises
        ------
        ConfigError
            It is neither.
        """
        if not isinstance(name, str) or (not name.endswith(".toml") and name not in list_packaged()["scenarios"]):
            raise ConfigError(f"no scenario {name!r}; packaged: {', '.join(list_packaged()['scenarios'])}")
        return name if not name.endswith(".toml") else str(self.path(name))

    def stamp(self, name: str) -> int:
        """Return what changes when a file is edited; 0 for a packaged scenario."""
        if not name.endswith(".toml"):
            return 0
        try:
            return self.path(name).stat().st_mtime_ns
        except OSError as error:
            raise ConfigError(f"cannot read {name}: {error.strerror}") from error

    def load(self, name: str) -> Scenario:
        """Return a scenario without changes; what it names in turn must be in the folder too.

        Raises
        ------
        ConfigError
            As `load_scenario`, or a vehicle or wind file outside.
        """
        return load_scenario(self.admitted(name))

    def admitted(self, name: str) -> str:
        """Return what `located` does, once it is sure that what the file names is in the folder too; errors as `load`.

        It is not loaded.
        """
        located = self.located(name)
        if name.endswith(".toml"):
            self._check_inside(Path(located))
        return located

    def save(self, name: str, text: str) -> Path:
        """Write a new file into the folder and return its path; nothing is overwritten.

        Raises
        ------
        ConfigError
            The name leads elsewhere, exists, or cannot be written.
        """
        return write_atomically(self.path(name), text, "make room, or choose another --folder", new=True)

    def _check_inside(self, path: Path) -> None:
        """Raise ConfigError where a scenario file names files outside the folder."""
        document = _document(path)
        wind = document.get("wind")
        named = [document.get("vehicle"), wind.get("file") if isinstance(wind, dict) else None]
        for other in named:
            outside = isinstance(other, str) and not (self.root / other).resolve().is_relative_to(self.root)
            if outside:
                raise ConfigError(f"{path.name} names {other}, outside {self.root}; put it into that folder")

    def _is_scenario(self, path: Path) -> bool:
        """Return whether a file looks like a scenario; campaigns, vehicles and solvers do not."""
        try:
            document = _document(self.path(path.name))
        except ConfigError:
            return False
        return "wind" in document and "vehicle" in document


def _document(path: Path) -> dict[str, Any]:
    """Return a TOML file as read; nothing of it where it cannot be read, which loading it then says."""
    try:
        return read_document("scenarios", str(path))
    except ConfigError:
        return {}
