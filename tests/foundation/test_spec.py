"""Numbers in texts: the nearest float, or an error."""

import math

import pytest

from microslip.foundation import spec
from microslip.foundation.errors import InputError

NUMBERS = [("0", 0.0), ("-0", 0.0), ("0e-400", 0.0), ("+.0E5", 0.0), ("5e-324", math.ulp(0.0))]
NUMBERS += [("1.7e308", 1.7e308), ("-Infinity", -math.inf), (" \N{MINUS SIGN}2 ", -2.0)]


@pytest.mark.parametrize(("text", "number"), NUMBERS)
def test_a_number_is_the_nearest_float(text, number):
    assert spec.read("size", text) == number


ARABIC_THREE, WIDE_ONE = "\N{ARABIC-INDIC DIGIT THREE}", "\uff11"
NO_NUMBERS = ["", "fast", "1,000.5", "1_000", ARABIC_THREE, WIDE_ONE, "1 2", ".", "30deg", "1\n2"]
OUT_OF_RANGE = ["2e-324", "-1e-400", f"0.{'0' * 400}1", "1.8e308"]


@pytest.mark.parametrize("text", NO_NUMBERS + OUT_OF_RANGE)
def test_other_texts_are_refused(text):
    with pytest.raises(InputError, match="^size = .*allowed is (0 or )?a number"):
        spec.read("size", text)


@pytest.mark.parametrize("text", ["8.5", "1e3", "1_0", f"{ARABIC_THREE}2", "9" * 5000])
def test_other_texts_than_whole_numbers_are_refused(text):
    with pytest.raises(InputError, match="allowed is a whole number$"):
        spec.read("cells", text, whole=True)
