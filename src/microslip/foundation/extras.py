"""Optional packages, which the extras of pyproject.toml install."""

from __future__ import annotations

from importlib.util import find_spec

EXTRAS = {"matplotlib": "plot", "snakemake": "workflow"}
"""Extra that installs a package."""


def missing(package: str) -> str:
    """How to install a package of EXTRAS that is not installed; "" if it is."""
    if find_spec(package) is not None:
        return ""
    return f"needs {package}; allowed after: pip install 'microslip[{EXTRAS[package]}]'"
