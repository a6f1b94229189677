"""Canonical texts of numbers, and the imports of the workflow during planning."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from stubs.new_process import output

from microslip.foundation import canonical

TEXTS = [(1.0, "1"), (0.1 + 0.2, "0.3"), (-0.0, "0"), (1.5e-8, "1.5e-8"), (1000000, "1000000")]


@pytest.mark.parametrize(("value", "text"), TEXTS)
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


ALONE = """
import sys
from microslip.app import plan
from microslip.config import load
from microslip.foundation import source_digest
from microslip.sweeps import request

source_digest.of_solver()
sweep = {"motion": "bore", "velocity": 1, "amplitude": 1}
configuration = load.from_mapping({"sweeps": {"bore": sweep}})
planned = plan.Plan(configuration)
plan.Results(planned, "none").batches(certified=False)
print([m for m in ("numpy", "scipy", "numba", "xarray", "matplotlib") if m in sys.modules])
"""


@pytest.mark.slow
def test_plans_and_jobs_load_nothing_heavy_that_they_do_not_need():
    assert output(ALONE) == "[]\n"
