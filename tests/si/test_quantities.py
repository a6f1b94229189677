"""Quantities with units: one number and one unit, or a refusal that shows where reading ended."""

import math

import pytest
from bad_input_tables.odd_quantities import ROWS, Q

from microslip.foundation.errors import InputError
from microslip.si.quantities import read

HALF_A_DIGIT = 3e-16
"""Relative: what the last bit of a float and of pi leave open."""


@pytest.mark.slow
@pytest.mark.parametrize(("value", "unit", "expected"), ROWS, ids=repr)
def test_an_odd_quantity_is_its_value_or_is_refused(value, unit, expected):
    if not isinstance(expected, str):
        found = read("size", value, unit, low=-math.inf).si
        assert type(found) is float
        assert found == pytest.approx(expected, rel=HALF_A_DIGIT, abs=0.0)
        return
    with pytest.raises(InputError) as caught:
        read("size", value, unit, low=-math.inf).si
    assert (caught.value.argument, caught.value.value is value) == ("size", True)
    line = str(caught.value)
    assert line.startswith("size = ") and "allowed is" in line and "\n" not in line
    assert expected in caught.value.allowed


@pytest.mark.parametrize(
    ("texts", "unit"),
    [
        (["1 um", "1e-3 mm", "0.000001 m", "1000 nm", "10000 angstrom"], "m"),
        (["0.3 um", "300 nm", "3e-4 mm"], "m"),
        (["210 GPa", "2.1e11 Pa", "210000 N/mm^2", "2.1e5 MPa"], "Pa"),
        (["10 N", "0.01 kN", "1 daN", "1e6 dyne", "10 kg*m/s^2"], "N"),
        (["0.7 mm/s", "42 mm/min", "2.52 m/hour", "7e-4 m/s"], "m/s"),
        (["600 rpm", "10 Hz", "10 turn/s", "3600 deg/s", "36000 rev/hour"], "rad/s"),
        (["600 rpm", "10 Hz", "10 turn/s", "3600 deg/s", "36000 rev/hour"], "Hz"),
    ],
)
def test_equal_quantities_are_equal_to_the_last_bit(texts, unit):
    """The values are computed in decimals and rounded once."""
    assert len({si_value("size", text, unit) for text in texts}) == 1


@pytest.mark.parametrize("value", ["0.3 um", "7 mm", "1.1 in"])
def test_a_pint_quantity_is_what_its_text_is(value):
    number, unit = value.split()
    assert read("size", Q(float(number), unit), "m") == si_value("size", value, "m").si


def test_limits_are_said_with_the_value_as_it_was_given():
    with pytest.raises(InputError, match=r"^size = '-5 mm': allowed is a finite value above 0 m$"):
        read("size", "-5 mm", "m").si
    with pytest.raises(InputError, match="'150 %': .* at least 0 and at most 1$"):
        read("share", "150 %", "", low_open=False, high=1.0).si
