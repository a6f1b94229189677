"""Optional packages, which are installed by the extras in pyproject.toml."""

from __future__ import annotations

from importlib.util import find_spec

EXTRAS = {"matplotlib": "plot", "snakemake": "workflow"}
"""Extras in pyproject.toml, keyed by the package that the extra installs."""


def missing(package: str) -> str:
    """Return an instruction to install a package of EXTRAS, or "" if it is already installed."""
    if find_spec(package) is not None:
        return ""
    return f"needs {package}; allowed after: pip install 'microslip[{EXTRAS[package]}]'"
