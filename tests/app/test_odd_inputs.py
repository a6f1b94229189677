"""Odd inputs: the right answer, or a one-line error message."""

import numpy as np
import pytest
from bad_input_tables.odd_inputs import AT, CALLS, NUMBERS
from stubs.eq6_map import map_of

import microslip
from microslip.foundation.errors import InputError
from microslip.foundation.files import CacheError
from microslip.si.materials import Material
from microslip.theory import paper

LONGEST_LINE = 1500
"""Largest number of characters of an error message; longer values are shortened."""


def short(value):
    try:
        return repr(value)[:40]
    except ValueError:
        return "huge"


def one_line(error, part):
    line = str(error)
    assert "\n" not in line and len(line) < LONGEST_LINE
    assert part in line


# Python

GOOD = {
    "solve": {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5},
    "history": {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5, "cells": 4, "steps": 8},
    "period": {"motion": "transverse", "velocity": 0.5, "amplitude": 0.5, "cells": 4, "steps": 8},
    "traction_field": {"motion": "continuous-bore", "velocity": 0.5},
    "propulsion": {"motion": "normal:forward=1,phase=90", "amplitude": 0.5},
    "shakedown": {"motion": "transverse", "amplitude": 0.5, "force": 0.1},
    "open_map": {"name": "transverse"},
    "to_xarray": {},
    "Material": {"young": "210 GPa", "poisson": 0.3},
}


@pytest.mark.parametrize(("function", "changed", "part"), CALLS, ids=short)
def test_a_call_is_refused_in_one_line(function, changed, part, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    called = Material if function == "Material" else getattr(microslip, function)
    with pytest.raises((InputError, CacheError)) as caught:
        called(**GOOD[function] | changed)
    one_line(caught.value, part)
    assert list(tmp_path.iterdir()) == []


def test_a_travel_as_long_as_allowed_ends_in_the_steady_state():
    """The friction of the steady state is that of Eq 21 for any length of the steps."""
    ends = [
        microslip.history("continuous-bore", 0.5, cells=8, steps=16, travel=travel).force_forward
        for travel in (10.0, 1e6)
    ]
    assert ends[1][-1] == pytest.approx(paper.bore_forward(0.5), abs=1e-3)
    assert ends[1][-1] == pytest.approx(ends[0][-1], abs=1e-3)


# A map


@pytest.fixture(scope="module")
def friction():
    velocity, amplitude = np.array([0.01, 0.1, 0.3, 1.0]), np.array([0.0, 0.5, 1.0])
    mu = velocity / (amplitude[:, None] + velocity)
    return map_of(mu, velocity, amplitude, 1e-3, tolerance=1e-2).microslip


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("changed", "part"), AT, ids=short)
def test_a_question_to_a_map_is_refused_in_one_line(changed, part, friction):
    with pytest.raises(InputError) as caught:
        friction.at(**{"velocity": 0.1, "amplitude": 0.5} | changed)
    one_line(caught.value, part)


@pytest.mark.parametrize("velocity", NUMBERS, ids=short)
def test_numbers_of_other_types_are_numbers(velocity, friction):
    """The value at a node of the map is 0.3 / (0.5 + 0.3)."""
    result = friction.at(velocity, 0.5).mu_macro
    assert float(result.squeeze()) == pytest.approx(0.375, abs=1e-6)
