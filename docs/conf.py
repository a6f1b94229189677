"""Configuration of the documentation: sphinx-build -W -n docs build/docs. Needs no network."""

import os
import sys
from pathlib import Path

import microslip

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

project = "microslip"
author = "the developers of microslip"
version = release = microslip.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "offline_math", "plain_docstrings"]
extensions += ["sphinx.ext.napoleon"]  # after plain_docstrings, which does not process sections
root_doc = "index"
exclude_patterns = ["_ext"]
nitpicky = True

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
myst_update_mathjax = False
html_math_renderer = "mathml"

napoleon_google_docstring = False
napoleon_use_param = napoleon_use_rtype = False
napoleon_use_ivar = True
# Types are also words, such as "callable or None".
nitpick_ignore_regex = [("py:class", r"(?!microslip).*")]
autodoc_typehints = "none"
autodoc_member_order = "bysource"

html_theme = "furo"
html_title = f"microslip {release}"
html_show_copyright = False
html_copy_source = False
html_show_sourcelink = False
html_static_path = ["_static"]
html_css_files = ["microslip.css"]

# Linked files outside this folder, and the pages that include them. The links in the sources are
# correct for readers of the plain files.
INCLUDED = {
    "../README.md": "index.md",
    "../CONTRIBUTING.md": "how-to/contributing.md",
    "../config/README.md": "reference/configuration.md",
}


def _adapt(app, name, source):
    if name.startswith("measured/"):  # the output of benchmarks has no title
        source[0] = f"# Measured: {name.split('/')[1].replace('_', ' ')}\n\n" + source[0]
    folder = Path(name).parent
    for file, page in INCLUDED.items():
        away, here = os.path.relpath(file, folder), os.path.relpath(page, folder)
        source[0] = source[0].replace(f"]({away}", f"]({here}")


def setup(app):
    app.connect("source-read", _adapt)


def _lexers():
    """Register lexers: Snakefiles as Python, tables as plain text."""
    from pygments.lexers.python import PythonLexer
    from pygments.lexers.special import TextLexer
    from sphinx.highlighting import lexers

    lexers["snakemake"] = PythonLexer()
    lexers["csv"] = TextLexer()


_lexers()
