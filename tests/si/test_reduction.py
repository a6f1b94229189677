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


@pytest.mark.parametrize("target", ["amplitude", "speed", "load"])
@pytest.mark.parametrize(
    ("motion", "change", "shape"),
    [
        ("transverse", {}, {}),
        # for a bore two loads have the same reduction; the search returns the larger one
        pytest.param("bore", {"amplitude": 0.01, "load": 200.0}, {}, marks=pytest.mark.long),
        pytest.param("transverse", {}, {"radius_across": "8 mm"}, marks=pytest.mark.long),
    ],
)
def test_a_search_is_the_inverse_of_a_prediction(motion, change, shape, target):
    settings, contact = GIVEN | change, LATERAL | shape
    there = microslip.predict(motion, **contact, **settings)
    rest = {name: value for name, value in settings.items() if name != target}
    result = microslip.predict(motion, reduction=there.force_reduction, **contact, **rest)
    off = abs(root(result).value - settings[target])
    assert result.search == target and target not in result.inputs
    assert off <= root(result).error < 0.05 * settings[target]
    assert result.force_reduction == pytest.approx(there.force_reduction, abs=1e-3)


def test_the_speed_of_a_rigid_slider_is_that_of_equation_6():
    """Friction is the mean of v / sqrt(v^2 + c^2 cos^2), c = omega y0, at any load.

    The stroke is thousands of u_lim.
    """
    rigid = LATERAL | {"amplitude": "1 mm", "load": "1 N", "frequency": "2 kHz"}
    result = microslip.predict("transverse", **rigid, reduction="50 %")

    def friction(x):
        return 2.0 / math.pi * x / math.hypot(1.0, x) * ellipk(1.0 / (1.0 + x**2))

    ratio = brentq(lambda x: friction(x) - 0.5, 1e-3, 1e3)
    speed = ratio * 2.0 * math.pi * 2000.0 * 1e-3
    assert result.speed_m_s == pytest.approx(speed, abs=root(result).error)
    assert root(result).error < 0.01 * result.speed_m_s
    slope = (friction(1.01 * ratio) - friction(ratio / 1.01)) / (2.0 * math.log(1.01))
    # the error of mu_macro is that of the solver plus that of the root
    assert root(result).error > 0.4 * result.mu_macro_error / slope * result.speed_m_s


def test_values_that_follow_from_a_root_have_its_error():
    request = LATERAL | GIVEN | {"load": None, "reduction": "40 %", "tolerance": 0.02}
    result = microslip.predict("transverse", **request)
    share = root(result).error / root(result).value
    for name, power in {"u_lim": 2.0 / 3.0, "contact_radius": 1.0 / 3.0}.items():
        one = result.values[name]
        assert one.error / one.value == pytest.approx(power * share, rel=0.15)


FAST, STUCK = {"speed": "100 m/s"}, {"speed": 0, "reduction": "10 %", "amplitude": "2.5 mm"}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (FAST | {"amplitude": None, "reduction": 0.9, "tolerance": 0.05}, "= 0.9: no amplitude"),
        # At vanishing speed and an amplitude of u_lim/100 more than 90 % of friction remains.
        ({"speed": None, "amplitude": "3 nm"}, "= '50 %': no speed of the search"),
        # The vibration has no effect on fast sliding.
        (FAST | {"load": None}, "= '50 %': no load of the search, down to"),
        # A contact sticks over a stroke of half the radius only if it is as large as the ball.
        (STUCK | {"load": None}, "it takes a load of .*Hertz"),
    ],
)
def test_a_reduction_out_of_range_is_refused(change, message):
    request = LATERAL | GIVEN | {"reduction": "50 %"} | change
    with pytest.raises(InputError, match=f"^reduction .*{message}"):
        microslip.predict("transverse", **request)


@pytest.mark.long
def test_the_largest_amplitude_of_the_search_is_tried():
    settings = LATERAL | {"load": "10 N", "speed": "1 m/s"}
    result = microslip.predict("transverse", **settings, reduction="98.75 %")
    assert result.force_reduction == pytest.approx(0.9875, abs=3e-3)
    assert 5e3 < result.amplitude < 1e4
