"""Every block of Python and every command in the documentation works, as a reader would run it.

One test per page: its blocks run in order, in one namespace and one temporary folder. Commands go through the command
line in this process and must exit with 0. A block is left out by `<!-- skip: next "why" -->` before it; there are few.
If one failed, the documentation would teach something that does not work.
"""

import contextlib
import importlib
import re
import shlex
import subprocess
import sys
import tomllib
import unittest
from pathlib import Path

import pytest
from sybil import Example, Sybil
from sybil.evaluators.python import PythonEvaluator
from sybil.parsers.myst import CodeBlockParser, SkipParser
from sybil.parsers.rest import DocTestParser

import tethership as ts
from tethership import cli

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src"
PAGES = sorted(path for path in (ROOT / "docs").rglob("*.md") if not path.name.endswith(".in.md"))
WRITTEN = [ROOT / "README.md", *(path for path in PAGES if path.parent.name not in ("gallery", "decisions"))]

LONG = {"reproduce", "identify", "tune", "campaign", "sweep", "explore"}
"""Commands that the README shows as they are used, or that serve until they are
ended; the pages of the guide run small ones."""


def run_commands(example: Example) -> None:
    """Run a block of shell: commands of tethership by the command line's own entry, what sets up by its name alone."""
    for line in commands(example.parsed):
        words = shlex.split(line, comments=True)
        if not words or words[0] in ("make", "pip", "git", "cd", "open", "xdg-open", "python"):
            continue
        assert words[0] == "tethership", f"a block of shell has {line!r}; what is that?"
        assert not words[1].startswith("--install"), "a test must not change the shell of who runs it"
        if Path(example.path).name == "README.md" and words[1] in LONG:
            continue
        assert tethership(words) == 0, f"`{line}` failed"


def commands(text: str) -> list[str]:
    """Return the commands of a block, joined at `&&` and continued lines."""
    joined = re.sub(r"\\\n\s*", " ", text)
    return [part.strip() for line in joined.splitlines() for part in line.split("&&")]


def tethership(words: list[str]) -> int:
    """Return the exit code of a command."""
    former, sys.argv = sys.argv, words
    try:
        cli.main()
    except SystemExit as end:
        return int(end.code or 0)
    finally:
        sys.argv = former
    return 0


def run_python(example: Example) -> None:
    """Run a block of Python, or write one whose first line names a file, `# mine.py`, for what comes after it."""
    named = re.match(r"# (\w+\.py)$", example.parsed.splitlines()[0])
    if named:
        Path(named[1]).write_text(example.parsed, encoding="utf-8")
    else:
        PYTHON(example)


def lay_file(example: Example) -> None:
    """Write a block of TOML whose first line names a file, `# mine.toml`, for the commands after it."""
    named = re.match(r"# (\w+\.toml)$", example.parsed.splitlines()[0])
    if named:
        Path(named[1]).write_text(example.parsed, encoding="utf-8")
    else:
        tomllib.loads(example.parsed)


PYTHON = PythonEvaluator()

MARKDOWN = Sybil(
    parsers=[
        CodeBlockParser("python", run_python),
        CodeBlockParser("sh", run_commands),
        CodeBlockParser("toml", lay_file),
        SkipParser(),
    ]
)
DOCSTRINGS = Sybil(parsers=[DocTestParser()])


def blocks(page: Path) -> int:
    """Return how many blocks of a page are run."""
    return len(re.findall(r"^```(?:python|sh|toml)$", page.read_text(encoding="utf-8"), re.MULTILINE))


@pytest.mark.slow
@pytest.mark.parametrize("page", [p for p in WRITTEN if blocks(p)], ids=lambda p: str(p.relative_to(ROOT)))
def test_page(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for example in MARKDOWN.parse(page):
        with contextlib.suppress(unittest.SkipTest):  # one block is left out, not the page
            example.evaluate()


WITH_EXAMPLES = [path for path in SOURCE.rglob("*.py") if ">>> " in path.read_text(encoding="utf-8")]


@pytest.mark.slow
@pytest.mark.parametrize("path", WITH_EXAMPLES, ids=lambda p: p.stem)
def test_docstrings(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    document = DOCSTRINGS.parse(path)
    document.namespace.update(vars(importlib.import_module(".".join(path.relative_to(SOURCE).with_suffix("").parts))))
    for example in document:
        example.evaluate()


SETTINGS = """
import runpy, sys
main = runpy.run_path({conf!r})
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "docstrings", "generated"]
globals().update({{key: value for key, value in main.items() if key.startswith(("autodoc_", "napoleon_"))}})
"""


@pytest.mark.slow
def test_reference_has_every_name_and_its_types(tmp_path):
    """Public names and their methods, also those that a user writes in a class of one's own, with their types."""
    pytest.importorskip("sphinx")
    assert (SOURCE / "tethership" / "py.typed").exists()  # the wheel holds all of the package's folder
    (tmp_path / "index.md").write_text((ROOT / "docs" / "reference" / "api.md").read_text(encoding="utf-8"))
    (tmp_path / "conf.py").write_text(SETTINGS.format(conf=str(ROOT / "docs" / "conf.py")))
    build = [sys.executable, "-m", "sphinx", "-q", "-b", "text", str(tmp_path), str(tmp_path / "out")]
    subprocess.run(build, check=True, capture_output=True, timeout=300)
    page = (tmp_path / "out" / "index.txt").read_text(encoding="utf-8")
    missing = [name for name in ts.__all__ if name != "__version__" and f"tethership.{name}" not in page]
    assert missing == []
    assert "__call__(time: Float[Array, ''], measurement: Measurement, memory: Any) -> tuple[Correction, Any]" in page
    assert "select(states: Sequence[str] | None = None, inputs: Sequence[str] | None = None) -> LinearModel" in page
    signatures = re.findall(r"^(?:   )?(?:abstractmethod |classmethod )?[\w.]+\(.*\)(.*)$", page, re.MULTILINE)
    assert len(signatures) > 40
    assert all(returned.startswith(" -> ") for returned in signatures), signatures
    assert "jaxlib" not in page
    for name in ("AbstractLaw", "Flight", "LinearModel", "Scenario", "Modes"):
        methods = [key for key, value in vars(getattr(ts, name)).items() if callable(value) and not key.startswith("_")]
        assert [method for method in methods if f"{method}(" not in page] == []


def test_what_is_not_run_is_long():
    """Blocks are left out for their length alone, and few of them."""
    reasons = [
        reason
        for page in WRITTEN
        for reason in re.findall(r"^<!-- skip: next(.*?)-->", page.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    assert all("minutes" in reason or "cluster" in reason for reason in reasons), reasons
    assert len(reasons) <= 12


def test_links_lead_somewhere():
    """Relative links and pictures of every page exist; anchors are checked when the documentation is built."""
    lost = []
    for page in (*WRITTEN, *PAGES):
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
        for target in re.findall(r"\]\((?!https?:|mailto:|#)([^)#\s]+)", text):
            if not (page.parent / target).exists():
                lost.append(f"{page.relative_to(ROOT)}: {target}")
    assert lost == []
