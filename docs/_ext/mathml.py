"""Mathematics as MathML, written at build time: no script, no network, and a font that comes along.

math-core (PyPI) turns LaTeX into MathML Core, which every current browser draws; STIX Two Math, whose tables stretch
brackets and roots, is taken from ziamath's wheel.
"""

import html
import importlib.resources
import re
import shutil
from pathlib import Path
from typing import Any

import math_core
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import SphinxError

FONT = "STIXTwoMath-Regular.ttf"

MACROS = {
    "vol": r"\mathcal{V}",
    "dd": r"\mathrm{d}",
    "DD": r"\mathrm{D}",
    "half": r"\tfrac{1}{2}",
    "transposed": r"^{\mathsf{T}}",
}
"""Short forms that pages may use."""

CONVERTER = math_core.LatexToMathML(macros=MACROS, fancy_error=False)


def converted(latex: str, display: bool, where: str) -> str:
    """Return MathML, or stop the build with the place of the mistake."""
    try:
        return CONVERTER.convert_with_local_state(latex, displaystyle=display)
    except math_core.LatexError as error:
        raise SphinxError(f"{where}: cannot read the mathematics {latex!r}: {error}") from error


def inline(translator: Any, node: nodes.Element) -> None:
    """Write mathematics within a line."""
    translator.body.append(converted(node.astext(), False, str(node.source)))
    raise nodes.SkipNode


def block(translator: Any, node: nodes.Element) -> None:
    r"""Write displayed mathematics, with the number of the paper where `\tag{…}` gives one."""
    latex = node.astext().strip()
    tag = re.search(r"\\tag\{([^}]*)\}", latex)
    body = converted(re.sub(r"\\tag\{[^}]*\}", "", latex), True, str(node.source))
    number = f'<span class="eqno">({html.escape(tag[1])})</span>' if tag else ""
    translator.body.append(f'<div class="math">{number}<div class="formula">{body}</div></div>\n')
    raise nodes.SkipNode


def carry_font(app: Sphinx, _: Any) -> None:
    """Put the font beside the pages."""
    if app.builder.format == "html":
        folder = Path(app.outdir) / "_static"
        folder.mkdir(parents=True, exist_ok=True)
        with importlib.resources.as_file(importlib.resources.files("ziamath.fonts") / FONT) as found:
            shutil.copy(found, folder / FONT)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the renderer; Sphinx chooses it as the one that is not built in."""
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(block, None))
    app.config.html_math_renderer = "mathml"
    app.connect("build-finished", carry_font)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
