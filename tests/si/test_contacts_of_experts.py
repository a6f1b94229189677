"""Contacts with closed-form answers, and the warnings that an expert would give."""

import pytest

import microslip
from microslip.theory import paper

SONOTRODE = {"material": "steel", "counterbody": "aluminium", "radius": "50 mm", "mu": 0.4}
SONOTRODE |= {"frequency": "20 kHz", "amplitude": "10 um", "speed": "0.1 m/s", "load": "100 N"}
WATCH = {"material": "steel", "counterbody": "400 GPa, 0.25", "radius": "0.1 mm", "mu": 0.15}
WATCH |= {"frequency": "4 Hz", "amplitude": "270 deg", "speed": "1 um/s", "load": "2 mN"}
RUBBER = {"young": "2 MPa", "nu": 0.49, "counterbody": "glass", "radius": "50 mm", "mu": 1.2}
RUBBER |= {"frequency": "50 Hz", "amplitude": "1 mm", "speed": "10 mm/s", "load": "5 N"}


def answer(motion, settings):
    return microslip.predict(motion, tolerance=5e-3, **settings)


def test_a_sonotrode_is_a_rigid_slider_but_for_its_small_elastic_stroke():
    result = answer("transverse", SONOTRODE)
    rigid = paper.large_amplitude_transverse(result.velocity, result.amplitude)
    assert rigid < result.mu_macro < 1.15 * rigid
    assert "elastically dissimilar" in "\n".join(result.warnings)
    soft = answer("transverse", SONOTRODE | {"counter_hardness": "0.4 GPa"})
    assert "the contact yields" in "\n".join(soft.warnings)


def test_a_pivot_of_a_watch_turns_as_a_rigid_one():
    result = answer("bore", WATCH)
    rigid = paper.large_amplitude_bore(result.velocity)
    assert result.mu_macro == pytest.approx(rigid, abs=result.mu_macro_error)
    assert result.warnings == ()
    hard = answer("bore", WATCH | {"load": "200 mN", "hardness": "700 HV"})
    assert "the contact yields" in "\n".join(hard.warnings)


def test_rubber_on_glass_comes_with_what_the_theory_leaves_out():
    result = answer("transverse", RUBBER)
    rigid = paper.large_amplitude_transverse(result.velocity, result.amplitude)
    assert rigid < result.mu_macro < 1.2 * rigid
    message = "\n".join(result.warnings)
    for words in (
        "times the contact radius",
        "above 1 it is rare except for rubber",
        "internal losses",
    ):
        assert words in message
    assert "losses" not in "\n".join(answer("transverse", RUBBER | {"nu": 0.3}).warnings)
