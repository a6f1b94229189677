"""Error estimates where three levels agree by chance, or are too coarse for their order."""

import pytest
from stubs.agreement import assert_agree

import microslip

RESONANT = [
    (
        "zigzag",
        {"amplitude": 0.8335540860888512, "velocity": 0.05269922431311603},
        {"stiffness": 0.6255943290507798, "mass": 0.11887771759720511, "tolerance": 1e-2},
    ),
    (
        "zigzag",
        {"amplitude": 0.8494797908233459, "velocity": 0.049347862288547706},
        {"stiffness": 0.47432836528122474, "mass": 0.11102744792147391, "tolerance": 5e-3},
    ),
    pytest.param(
        "bore",
        {"amplitude": 1.2216737335490946, "velocity": 0.2902400037559751},
        {"stiffness": 2.384749979698767, "mass": 0.7538689129814118, "tolerance": 1e-2},
        marks=pytest.mark.slow,
    ),
]
"""A body that resonates with the second harmonic of the vibration: sqrt(k / m) is 2.3, 2.1 or 1.8.
Coarse time steps miss the resonance in either direction."""


@pytest.mark.parametrize(("motion", "place", "body"), RESONANT)
def test_a_resonance_is_within_the_error_estimate(motion, place, body):
    result = microslip.solve(motion, **place, **body)
    assert result.converged
    assert_agree(result, microslip.solve(motion, **place, **body | {"tolerance": 1e-3}))


ENERGIES = [(0.0112889, 0.586235), (0.0466, 0.514), (0.0519, 0.595)]


@pytest.mark.slow
@pytest.mark.parametrize(("velocity", "amplitude"), ENERGIES)
def test_the_energy_of_a_small_rotation_is_within_its_error_estimate(velocity, amplitude):
    """Only a thin ring slips, which the runs that suffice for the friction hardly resolve."""
    coarse = microslip.solve("bore", velocity, amplitude, tolerance=1e-2).dissipation
    fine = microslip.solve("bore", velocity, amplitude, tolerance=1e-4).dissipation
    assert abs(coarse.value - fine.value) <= coarse.error + fine.error
    assert fine.error < 0.2 * coarse.error


IMPOSED = [
    ("transverse", 0.0355778, 0.475276, 8, 96),
    ("transverse", 0.04590274, 0.42030309, 8, 32),
    ("transverse", 0.027757217, 1.4266345, 32, 16),
    pytest.param("bore", 0.021113275, 0.3990749, 4, 8, marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("motion", "velocity", "amplitude", "cells", "steps"), IMPOSED)
def test_a_coarse_imposed_resolution_is_within_its_error_estimate(
    motion, velocity, amplitude, cells, steps
):
    sizes = {"cells": cells, "steps": steps, "tolerance": None}
    coarse = microslip.solve(motion, velocity, amplitude, **sizes)
    assert_agree(coarse, microslip.solve(motion, velocity, amplitude, tolerance=1e-4))


def test_an_imposed_resolution_has_the_error_estimate_of_the_same_chosen_one():
    """Their values differ: the finest run, and the extrapolated value."""
    chosen = microslip.solve("transverse", 0.3, 1.0, tolerance=1e-3)
    sizes = {"cells": chosen.cells, "steps": chosen.steps_per_period}
    imposed = microslip.solve("transverse", 0.3, 1.0, **sizes, tolerance=None)
    apart = abs(imposed.mu_macro - chosen.mu_macro)
    assert imposed.mu_macro_error == pytest.approx(chosen.mu_macro_error + apart, rel=0.1)
