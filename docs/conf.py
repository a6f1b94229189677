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

extensions = ["myst_nb", "sphinx.ext.autodoc", "offline_math", "plain_docstrings"]
extensions += ["sphinx.ext.napoleon"]  # after plain_docstrings, which does not process sections
root_doc = "index"
exclude_patterns = ["_ext"]
nitpicky = True

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
myst_update_mathjax = False
html_math_renderer = "mathml"

# The tutorials are notebooks. The build runs them in a temporary folder and stops at an error.
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True

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


# Titles of tables that benchmarks write.
TITLES = {
    "angles": "Error against the number of angles",
    "calibration": "Calibration of the error estimates",
    "certified": "Errors of certified maps at random points",
    "elliptic_contacts": "Validation of the error estimates at elliptic contacts",
    "error_estimates": "Validation of the error estimates at 6,000 points",
    "explorer": "Loading time of the explorer",
    "faults": "Recovery of sweeps from faults",
    "first_run": "Time of the first run",
    "growth": "Time and memory of large sweeps",
    "interpolation": "Errors of interpolation between the points of a map",
    "paper_method": "Cost of the paper's method",
    "published_numbers": "Published numbers, case by case",
    "slurm": "Sweep on Slurm",
    "static_approach": "Approach to the static limit",
    "sweep_cost": "Cost of the points of a map",
}


def _adapt(app, name, source):
    if name.startswith("measured/") and not source[0].startswith("# "):
        source[0] = f"# {TITLES[Path(name).name]}\n\n{source[0]}"
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
