"""Canonical texts of numbers, and the imports of the workflow during planning."""

import math
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import microslip
from microslip.foundation import canonical

PACKAGE = Path(microslip.__file__).parent


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1, "1"),
        (1.0, "1"),
        (0.1, "0.1"),
        (0.1 + 0.2, "0.3"),
        (0, "0"),
        (-0.0, "0"),
        (-2.5, "-2.5"),
        (1e-8, "1e-8"),
        (1.5e-8, "1.5e-8"),
        (1e22, "1e22"),
        (2.15443, "2.15443"),
        (1000000, "1000000"),
    ],
)
def test_numbers_have_one_canonical_text(value, text):
    assert canonical.number(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_canonical_numbers_keep_twelve_digits_and_stay_what_they_are(value):
    text = canonical.number(value)
    assert math.isclose(float(text), value, rel_tol=1e-11)
    assert canonical.number(float(text)) == text


@pytest.mark.parametrize("value", [math.nan, math.inf, True, "1"])
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(ValueError, match="not a finite number"):
        canonical.number(value)


@pytest.mark.slow
def test_the_workflow_reads_this_without_loading_anything_heavy():
    heavy = ("numpy", "scipy", "numba", "xarray", "matplotlib")
    program = (
        "import sys; from microslip.app import plan; from microslip.config import load;"
        "from microslip.foundation import source_digest;"
        "source_digest.of_solver();"
        f"print([m for m in {heavy} if m in sys.modules])"
    )
    process = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(PACKAGE.parent)},
    )
    assert process.stdout.strip() == "[]"
