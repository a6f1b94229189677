"""The amplitude, the speed or the load at which vibration takes a share of friction away."""

import math

import pytest

import microslip
from microslip.foundation.errors import InputError

BALL = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "mu": 0.3}
LATERAL = BALL | {"frequency": "20 kHz", "tolerance": 3e-3}
GIVEN = {"amplitude": 4e-7, "speed": 0.01, "load": 8.0}
FIELDS = {"amplitude": "amplitude_si", "speed": "speed_m_s", "load": "load_N"}
RIGID = {"amplitude": "1 mm", "speed": "20 m/s", "load": "1 N", "frequency": "2 kHz"}
"""Strokes of thousands of u_lim: the contact is a rigid slider."""


@pytest.mark.slow
@pytest.mark.parametrize("sought", ["speed", "load"])
@pytest.mark.parametrize("motion", ["transverse", pytest.param("bore", marks=pytest.mark.long)])
def test_whichever_is_left_out_is_found_again(motion, sought):
    # Of a bore two loads feel the same, and the larger one is looked for.
    given = GIVEN | ({"amplitude": 0.01, "load": 200.0} if motion == "bore" else {})
    there = microslip.predict(motion, **LATERAL, **given)
    rest = {name: value for name, value in given.items() if name != sought}
    found = microslip.predict(motion, reduction=there.force_reduction, **LATERAL, **rest)
    off = abs(getattr(found, FIELDS[sought]) - given[sought])
    assert found.sought == sought
    assert off <= found.sought_error < 0.05 * given[sought]
    assert found.force_reduction == pytest.approx(there.force_reduction, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    "shape",
    [pytest.param({"radius_across": "8 mm"}, marks=pytest.mark.long), {"contact_radius": "60 um"}],
)
def test_a_load_is_found_of_other_contacts(shape):
    """Hertz's ellipse grows with the load, a contact whose size is given does not."""
    given = LATERAL | GIVEN | shape
    if "contact_radius" in shape:
        del given["radius"]
    share = microslip.predict("transverse", **given).force_reduction
    found = microslip.predict("transverse", **given | {"load": None, "reduction": share})
    assert abs(found.load_N - GIVEN["load"]) <= found.sought_error
    assert "load" not in found.understood


def test_of_a_rigid_slider_the_speed_is_that_of_equation_6():
    """The mean of v / sqrt(v^2 + c^2 cos^2) with c = omega y0: the load does not count."""
    from scipy.optimize import brentq
    from scipy.special import ellipk

    found = microslip.predict("transverse", **BALL | RIGID | {"speed": None}, reduction="50 %")
    swing = 2.0 * math.pi * 2000.0 * 1e-3

    def felt(x):
        return 2.0 / math.pi * x / math.hypot(1.0, x) * ellipk(1.0 / (1.0 + x**2))

    ratio = brentq(lambda x: felt(x) - 0.5, 1e-3, 1e3)
    assert found.speed_m_s == pytest.approx(ratio * swing, abs=found.sought_error)
    assert found.sought_error < 0.01 * found.speed_m_s


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (
            {"amplitude": None, "speed": "1 m/s", "reduction": 0.99},
            "^reduction = 0.99: no amplitude",
        ),
        # At vanishing speed an amplitude of u_lim/100 leaves more than nine tenths.
        ({"speed": None, "amplitude": "3 nm"}, "^reduction = '50 %': no speed takes"),
        # Fast sliding feels nothing of any vibration.
        ({"load": None, "speed": "100 m/s"}, "^reduction = '50 %': no load of the search, down to"),
    ],
)
def test_what_cannot_be_looked_for_is_refused(changed, said):
    asked = LATERAL | GIVEN | {"reduction": "50 %"} | changed
    with pytest.raises(InputError, match=said):
        microslip.predict("transverse", **asked)


def test_a_load_that_hertz_theory_does_not_know_is_refused():
    """A stroke of half of the ball needs a contact of its size to stick."""
    ball = {"young": "210 GPa", "nu": 0, "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}
    asked = ball | {"amplitude": "2.5 mm", "speed": "0 m/s", "reduction": "10 %"}
    with pytest.raises(InputError, match="^reduction = '10 %': it takes a load of .*Hertz"):
        microslip.predict("transverse", **asked)


def test_the_largest_amplitude_is_tried():
    given = BALL | {"load": "10 N", "speed": "1 m/s", "frequency": "20 kHz"}
    found = microslip.predict("transverse", **given, reduction="98.75 %")
    assert found.force_reduction == pytest.approx(0.9875, abs=1e-3)
    assert 5e3 < found.amplitude < 1e4
