"""Printed errors: at least as large as the exact ones."""

import math
import re
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from microslip.foundation.number_text import interval_text, number_text

LARGEST_PRINTED = 1.7e308
"""The rounded error may exceed the largest float."""


SHORT = st.builds(
    lambda count, power: float(f"{count}e{power}"), st.integers(1, 99), st.integers(-30, 3)
)
ERRORS = (
    st.floats(math.ulp(0.0), LARGEST_PRINTED)
    | SHORT
    | st.builds(math.nextafter, SHORT, st.sampled_from([0.0, math.inf]))
)
"""Floats of all sizes, floats of at most two digits, and their neighbours."""


@given(ERRORS)
def test_the_printed_error_is_at_least_the_error_and_at_most_a_tenth_more(error):
    """The error is rounded up from the shortest decimal form of the float: 0.01 stays 0.01."""
    text = number_text(0.0, error).removeprefix("0 +- ")
    if error > 1e-12:  # below, a zero is printed without its error
        assert len(re.sub(r"e.*|^[0.]+|\.", "", text).rstrip("0")) <= 2
        assert Fraction(repr(error)) <= Fraction(text) <= Fraction(repr(error)) * Fraction(11, 10)


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.22633, 0.00072, "0.22633 +- 0.00072"),
        (91.39337, 0.13034, "91.39 +- 0.14"),
        (0.5, 1e-5, "0.500000 +- 0.000010"),
        (1e-4, 8.3e-6, "0.0001000 +- 0.0000083"),
        (3e-7, 1e-9, "(3.000 +- 0.010)e-07"),
        (0.6, 4.4e-17, "0.6000"),
        (1.0 / 3.0, 0.0, "0.3333"),
        (-2e-6, 1e-5, "0 +- 1.2e-05"),
        (9.7e-13, 0.0, "9.7e-13"),
        (4.0, 99.9, "0 +- 110"),
        (math.nan, 1.0, "nan"),
        (2.0, math.inf, "2 +- inf"),
    ],
)
def test_a_number_has_the_digits_that_its_error_allows(value, error, text):
    """A number that is 0 within its error is printed as 0, with an error that covers both."""
    assert number_text(value, error) == text


@pytest.mark.parametrize(
    ("low", "high", "error", "text"),
    [
        (41.234, 133.3, 0.0, "41 to 134"),
        (-0.314, -0.061, 0.0, "-0.32 to -0.06"),
        (3.6e-10, 8.3e-10, 5.1e-5, "0 to 5.2e-05"),
        (0.19187, 0.19187, 0.0, "0.1918 to 0.1919"),
        (0.52, math.inf, 0.0, "0.52 to inf"),
        (1.0, 2.0, math.inf, "0 to inf"),
    ],
)
def test_an_interval_is_rounded_outwards_to_two_digits_of_its_width(low, high, error, text):
    """The printed digits are not smaller than the error of the interval."""
    assert interval_text(low, high, error=error) == text
    assert interval_text(low, high, "N", error=error) == f"{text} N"
