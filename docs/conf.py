"""Sphinx's settings. `make docs` builds with warnings as errors; nothing is fetched while building or reading."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent / "src")]

import tethership

project = "tethership"
author = "The tethership developers"
copyright = "The tethership developers, MIT licence"
version = release = tethership.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_design",
    "sphinx_copybutton",
    "matplotlib.sphinxext.plot_directive",
    "mathml",
    "docstrings",
    "generated",
    "gallery",
]
exclude_patterns = ["validation/*.in.md", "_ext", "_static", "figures"]

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist", "attrs_inline", "html_image"]
myst_heading_anchors = 4
myst_links_external_new_tab = False

default_role = "literal"
smartquotes_action = "qe"  # `--out` keeps its two hyphens
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
toc_object_entries_show_parents = "hide"

plot_basedir = str(HERE)
plot_formats = ["svg"]
plot_html_show_formats = False
plot_html_show_source_link = True
plot_rcparams = {"figure.constrained_layout.use": True, "svg.fonttype": "none", "savefig.facecolor": "white"}
plot_apply_rcparams = True

html_theme = "furo"
html_title = f"tethership {release}"
html_static_path = ["_static"]
html_css_files = ["tethership.css"]
html_copy_source = False
html_show_sphinx = False
copybutton_exclude = ".linenos, .gp, .go"
