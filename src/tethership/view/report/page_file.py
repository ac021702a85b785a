"""Pages on disk: what every page shares, its colours and how it is written. Depends on: results."""

from importlib import resources
from pathlib import Path

from tethership.results.files import write_atomically


def page_text(folder: str, name: str) -> str:
    """Return the text of a packaged style, script or page of `data/FOLDER`."""
    return (resources.files("tethership") / "data" / folder / name).read_text(encoding="utf-8")


def write_page_text(path: str | Path, page: str) -> Path:
    """Write a page and return where; its folder is made.

    Raises
    ------
    ConfigError
        It cannot be written.
    """
    return write_atomically(path, page)
