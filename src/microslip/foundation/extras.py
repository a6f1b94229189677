"""Optional packages, which the extras of pyproject.toml install."""

from __future__ import annotations

from importlib.util import find_spec

EXTRAS = {"matplotlib": "plot", "snakemake": "workflow"}
"""Extra of pyproject.toml that installs each package."""


def missing(package: str) -> str:
    """Instruction to install a package of EXTRAS, or "" if it is already installed."""
    if find_spec(package) is not None:
        return ""
    return f"needs {package}; allowed after: pip install 'microslip[{EXTRAS[package]}]'"
