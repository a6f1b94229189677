"""Keys: what changes them and what does not."""

import math
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import microslip
from microslip.foundation import canonical
from microslip.sweeps import keys

PACKAGE = Path(microslip.__file__).parent
REQUEST = {"kind": "point", "motion": "bore", "velocity": "0.1", "amplitude": "1", "cells": None}


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


@pytest.mark.parametrize(
    ("name", "value"),
    [("motion", "transverse"), ("velocity", "0.11"), ("amplitude", "0"), ("cells", 8), ("new", 1)],
)
def test_everything_in_a_request_counts(name, value):
    assert keys.result_key({**REQUEST, name: value}, "d") != keys.result_key(REQUEST, "d")


def test_swapped_values_the_solver_and_the_format_count(monkeypatch):
    key = keys.result_key(REQUEST, "d")
    swapped = {**REQUEST, "velocity": "1", "amplitude": "0.1"}
    assert keys.result_key(swapped, "d") != key
    assert keys.result_key(REQUEST, "e") != key
    assert keys.result_key(dict(reversed(REQUEST.items())), "d") == key
    monkeypatch.setattr(keys, "RECORD_FORMAT", 99)
    assert keys.result_key(REQUEST, "d") != key


def test_batches_are_named_by_their_keys_in_order():
    names = {keys.batch_name(k) for k in (["a", "b"], ["b", "a"], ["a"], ["ab"], ["a", "b", "c"])}
    assert len(names) == 5
    assert keys.batch_name(["a", "b"]) == keys.batch_name(["a", "b"])


@pytest.mark.slow
def test_the_workflow_reads_this_without_loading_anything_heavy():
    heavy = ("numpy", "scipy", "numba", "xarray", "matplotlib")
    program = (
        "import sys; from microslip.app import plan; from microslip.config import load;"
        "from microslip.foundation import source_digest;"
        "source_digest.of_solver();"
        f"print([m for m in {heavy} if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(PACKAGE.parent)},
    )
    assert done.stdout.strip() == "[]"
