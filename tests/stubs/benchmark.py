"""Modules of the folder of benchmarks, for tests."""

import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@cache
def module(name):
    """Import a module of the folder of benchmarks."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks")
        __import__(name)
    return sys.modules[name]
