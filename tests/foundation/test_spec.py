"""Numbers in texts: the nearest float, or an error."""

import math

import pytest

from microslip.foundation import spec
from microslip.foundation.errors import InputError


@pytest.mark.parametrize("text", ["0", "-0", "0e-400", "+.0E5"])
def test_what_is_written_as_0_is_0(text):
    assert spec.read("size", text) == 0.0


@pytest.mark.parametrize(
    ("text", "number"), [("5e-324", math.ulp(0.0)), ("1.7e308", 1.7e308), ("-Infinity", -math.inf)]
)
def test_the_ends_of_the_range_are_read(text, number):
    assert spec.read("size", text) == number


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("2e-324", "nearer 0"),
        ("-1e-400", "nearer 0"),
        (f"0.{'0' * 400}1", "nearer 0"),
        ("1.8e308", "beyond the range"),
    ],
)
def test_a_number_that_would_be_0_or_infinite_is_refused(text, problem):
    with pytest.raises(InputError, match=f"^size = .*: {problem}.*; allowed is "):
        spec.read("size", text)


ARABIC_THREE, WIDE_ONE = "\N{ARABIC-INDIC DIGIT THREE}", "\uff11"
NO_NUMBERS = ["", "fast", "1,000.5", "1_000", ARABIC_THREE, WIDE_ONE, "1 2", ".", "30deg", "1\n2"]


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_other_texts_are_refused(text):
    with pytest.raises(InputError, match="allowed is a number$"):
        spec.read("size", text)


@pytest.mark.parametrize("text", ["8.5", "1e3", "1_0", f"{ARABIC_THREE}2", "9" * 5000])
def test_other_texts_than_whole_numbers_are_refused(text):
    with pytest.raises(InputError, match="allowed is a whole number$"):
        spec.read("cells", text, whole=True)


@pytest.mark.parametrize("value", ["1e-400", "1e400"])
def test_so_it_is_beside_a_name(value):
    text = f"admm:penalty={value}"
    with pytest.raises(InputError, match=f"in it 'penalty={value}': .* floating-point numbers"):
        spec.split(text, "method", ["admm"])
