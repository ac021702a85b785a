"""Pages on disk: packaged templates and texts, and how a page is written. Depends on: jinja2, results.

Whatever a template is given is escaped unless it is packaged itself: titles and names of a scenario are anybody's.
"""

import functools
from importlib import resources
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from tethership._version import __version__
from tethership.results import write_atomically


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


@functools.cache
def templates() -> Environment:
    """Return the packaged templates of `data`; views add their own filters once."""
    found = Environment(
        loader=PackageLoader("tethership", "data"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    found.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    found.globals |= {"version": __version__, "packaged": _packaged}
    return found


def rendered(template: str, **given: Any) -> str:
    """Return a packaged template, e.g. `replay/replay.html`, filled in."""
    return templates().get_template(template).render(given)


def _packaged(path: str) -> Markup:
    """Return a packaged file of `data` as it is: the package's own words are no one's input."""
    folder, _, name = path.partition("/")
    return Markup(page_text(folder, name))
