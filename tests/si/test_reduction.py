"""Searches for the amplitude, the speed or the load with a prescribed reduction of friction."""

import math

import pytest
from scipy.optimize import brentq
from scipy.special import ellipk

import microslip
from microslip.foundation.errors import InputError

BALL = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "mu": 0.3}
LATERAL = BALL | {"frequency": "20 kHz", "tolerance": 3e-3}
GIVEN = {"amplitude": 4e-7, "speed": 0.01, "load": 8.0}


def root(result):
    """The result of a search."""
    return result.input_values[result.search]


RIGID = {"amplitude": "1 mm", "load": "1 N", "frequency": "2 kHz"}
"""A stroke of thousands of u_lim: the contact is a rigid slider."""


@pytest.mark.parametrize("target", ["amplitude", "speed", "load"])
@pytest.mark.parametrize("motion", ["transverse", pytest.param("bore", marks=pytest.mark.long)])
def test_whichever_is_left_out_is_found_again(motion, target):
    # For a bore two loads have the same reduction; the search returns the larger one.
    settings = GIVEN | ({"amplitude": 0.01, "load": 200.0} if motion == "bore" else {})
    there = microslip.predict(motion, **LATERAL, **settings)
    rest = {name: value for name, value in settings.items() if name != target}
    result = microslip.predict(motion, reduction=there.force_reduction, **LATERAL, **rest)
    off = abs(root(result).value - settings[target])
    assert result.search == target
    assert off <= root(result).error < 0.05 * settings[target]
    assert result.force_reduction == pytest.approx(there.force_reduction, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    "shape",
    [pytest.param({"radius_across": "8 mm"}, marks=pytest.mark.long), {"contact_radius": "60 um"}],
)
def test_a_load_is_found_of_other_contacts(shape):
    """Hertz's ellipse grows with the load; a contact with a prescribed size does not."""
    settings = LATERAL | GIVEN | shape
    if "contact_radius" in shape:
        del settings["radius"]
    share = microslip.predict("transverse", **settings).force_reduction
    result = microslip.predict("transverse", **settings | {"load": None, "reduction": share})
    assert abs(result.load_N - GIVEN["load"]) <= root(result).error
    assert "load" not in result.inputs


def test_of_a_rigid_slider_the_speed_is_that_of_equation_6():
    """Friction is the mean of v / sqrt(v^2 + c^2 cos^2), c = omega y0, at any load."""
    result = microslip.predict("transverse", **LATERAL | RIGID, reduction="50 %")
    swing = 2.0 * math.pi * 2000.0 * 1e-3

    def felt(x):
        return 2.0 / math.pi * x / math.hypot(1.0, x) * ellipk(1.0 / (1.0 + x**2))

    ratio = brentq(lambda x: felt(x) - 0.5, 1e-3, 1e3)
    assert result.speed_m_s == pytest.approx(ratio * swing, abs=root(result).error)
    assert root(result).error < 0.01 * result.speed_m_s


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"amplitude": None, "speed": "100 m/s", "reduction": 0.9, "tolerance": 0.05},
            "^reduction = 0.9: no amplitude",
        ),
        # At vanishing speed and an amplitude of u_lim/100 more than 90 % of friction remains.
        ({"speed": None, "amplitude": "3 nm"}, "^reduction = '50 %': no speed reduces"),
        # The vibration has no effect on fast sliding.
        ({"load": None, "speed": "100 m/s"}, "^reduction = '50 %': no load of the search, down to"),
    ],
)
def test_what_cannot_be_looked_for_is_refused(changed, message):
    request = LATERAL | GIVEN | {"reduction": "50 %"} | changed
    with pytest.raises(InputError, match=message):
        microslip.predict("transverse", **request)


def test_a_load_that_hertz_theory_does_not_know_is_refused():
    """A contact sticks over a stroke of half the radius only if it is as large as the ball."""
    ball = {"young": "210 GPa", "nu": 0, "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}
    request = ball | {"amplitude": "2.5 mm", "speed": "0 m/s", "reduction": "10 %"}
    with pytest.raises(InputError, match="^reduction = '10 %': it takes a load of .*Hertz"):
        microslip.predict("transverse", **request)


@pytest.mark.long
def test_the_largest_amplitude_is_tried():
    settings = LATERAL | {"load": "10 N", "speed": "1 m/s"}
    result = microslip.predict("transverse", **settings, reduction="98.75 %")
    assert result.force_reduction == pytest.approx(0.9875, abs=3e-3)
    assert 5e3 < result.amplitude < 1e4
