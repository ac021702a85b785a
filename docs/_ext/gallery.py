"""The gallery: a page for every file of examples/, with the figure that it made (`make gallery`)."""

import ast
from pathlib import Path
from typing import Any, NamedTuple

from sphinx.application import Sphinx
from sphinx.errors import SphinxError

ROOT = Path(__file__).parents[2]

RUNGS = {
    "a": "First steps",
    "b": "One thing at a time",
    "c": "Your own",
}
"""What the first letter of an example's name means."""


class Example(NamedTuple):
    """One example."""

    name: str
    title: str
    text: str


def examples() -> list[Example]:
    """Return all examples in the order of the ladder."""
    found = []
    for path in sorted((ROOT / "examples").glob("*.py")):
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        title = path.stem.split("_", 1)[1].replace("_", " ").capitalize()
        found.append(Example(path.stem, f"{path.stem.split('_')[0].upper()} – {title}", text))
    return found


def index() -> list[str]:
    """Return the cards of the gallery, rung by rung."""
    lines: list[str] = []
    for letter, words in RUNGS.items():
        lines += [f"## {words}", "", ":::::{grid} 1 2 2 3", ":gutter: 3", ":class-container: gallery", ""]
        for entry in (one for one in examples() if one.name.startswith(letter)):
            lines += [
                f"::::{{grid-item-card}} {entry.title}",
                f":img-top: {entry.name}.png",
                f":link: {entry.name}",
                ":link-type: doc",
                entry.text,
                "::::",
            ]
        lines += [":::::", ""]
    names = [entry.name for entry in examples()]
    return [*lines, "```{toctree}", ":hidden:", *names, "```"]


def page(entry: Example) -> list[str]:
    """Return the page of one example."""
    return [
        f"# {entry.title}",
        "",
        entry.text,
        "",
        f"![What the example draws]({entry.name}.png)",
        "",
        f"```{{literalinclude}} ../../examples/{entry.name}.py",
        ":language: python",
        "```",
        "",
        f"Run it: `python examples/{entry.name}.py`; the figure is written to `out/{entry.name}.png`.",
        "",
    ]


def write_pages(app: Sphinx) -> None:
    """Lay the pages of the examples beside the gallery's index; they are not kept in the repository."""
    folder = Path(app.srcdir) / "gallery"
    wanted = {f"{entry.name}.md": "\n".join(page(entry)) for entry in examples()}
    for entry in examples():
        if not (folder / f"{entry.name}.png").exists():
            raise SphinxError(
                f"docs/gallery/{entry.name}.png is missing; `make gallery` runs the examples and keeps it"
            )
    for old in folder.glob("[abc][0-9]_*.md"):
        if old.name not in wanted:
            old.unlink()
    for name, text in wanted.items():
        place = folder / name
        if not place.exists() or place.read_text(encoding="utf-8") != text:
            place.write_text(text, encoding="utf-8")


def fill(app: Sphinx, docname: str, source: list[str]) -> None:
    """Put the cards into the gallery's index."""
    if docname == "gallery/index":
        source[0] = source[0].replace("{{gallery}}", "\n".join(index()))


def outdated(app: Sphinx, env: Any, added: set[str], changed: set[str], removed: set[str]) -> list[str]:
    """Return the index where an example came or went: it is made from their files."""
    return ["gallery/index"] if any(name.startswith("gallery/") for name in added | removed | changed) else []


def setup(app: Sphinx) -> dict[str, Any]:
    """Write the pages before sources are looked for."""
    app.connect("builder-inited", write_pages)
    app.connect("source-read", fill)
    app.connect("env-get-outdated", outdated)
    return {"parallel_read_safe": True}
