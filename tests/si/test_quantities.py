"""Quantities with units, and error messages with the place where reading stopped."""

import math

import pint
import pytest
from bad_input_tables.odd_quantities import ROWS, Q

from microslip.foundation.errors import InputError
from microslip.si.quantities import read
from microslip.si.units import registry

HALF_A_DIGIT = 1e-15
"""Relative rounding error of a few floats and of pi."""
LONGEST_LINE = 1500
"""Largest number of characters of an error message; longer values are shortened."""


def name_of(value):
    try:
        return repr(value)[:40]
    except ValueError:  # a whole number with thousands of digits
        return "huge"


@pytest.mark.parametrize(("value", "unit", "expected"), ROWS, ids=name_of)
def test_an_odd_quantity_is_its_value_or_is_refused(value, unit, expected):
    if not isinstance(expected, str):
        result = read("size", value, unit, low=-math.inf).si
        assert type(result) is float
        assert result == pytest.approx(expected, rel=HALF_A_DIGIT, abs=0.0)
        return
    with pytest.raises(InputError) as caught:
        read("size", value, unit, low=-math.inf)
    assert (caught.value.argument, caught.value.value is value) == ("size", True)
    line = str(caught.value)
    assert line.startswith("size = ") and "allowed is" in line and "\n" not in line
    assert expected in caught.value.allowed and len(line) < LONGEST_LINE


def test_every_unit_is_what_pint_defines_by_the_same_name():
    known, usual = registry(), pint.UnitRegistry()
    turning = {"hertz", "counts_per_second"}  # pint leaves out the turn
    for name in known.get_group("root").members - turning:
        (own, dimension), (factor, expected) = (one.get_root_units(name) for one in (known, usual))
        assert float(own) == pytest.approx(factor, rel=HALF_A_DIGIT), name
        assert str(dimension) == str(expected), name


@pytest.mark.parametrize(
    ("texts", "unit"),
    [
        (["1 um", "1e-3 mm", "0.000001 m", "1000 nm", "10000 angstrom", Q(1.0, "um")], "m"),
        (["210 GPa", "2.1e11 Pa", "210000 N/mm^2", "2.1e5 MPa"], "Pa"),
        (["1 ksi", "1000 psi"], "Pa"),
        (["600 rpm", "10 Hz", "10 turn/s", "3600 deg/s", "36000 rev/hour"], "Hz"),
    ],
)
def test_equal_quantities_are_equal_to_the_last_bit(texts, unit):
    """Values are computed in decimals and rounded once, to a float."""
    assert len({read("size", text, unit).si for text in texts}) == 1


@pytest.mark.parametrize(
    ("value", "unit", "limits", "allowed"),
    [
        ("-5 mm", "m", {}, "a finite value above 0 m"),
        ("150 %", "", {"low_open": False, "high": 1.0}, "a finite value at least 0 and at most 1"),
    ],
)
def test_a_value_out_of_its_range_is_refused(value, unit, limits, allowed):
    with pytest.raises(InputError, match=f"^size = '{value}': allowed is {allowed}$"):
        read("size", value, unit, **limits)
