"""Errors behind +-: what is read back is never less than what is claimed."""

import math
import random
import re
import sys
from fractions import Fraction

import pytest
from stubs.in_process import run

import microslip
from microslip.app.printed_error import error_text

LARGEST_PRINTED = 1.7e308
"""Two digits of a larger error may be more than any float."""


def some_errors():
    """Of all sizes, of two digits at most among them, and their neighbours."""
    draw = random.Random(1)
    for _ in range(3000):
        yield 10.0 ** draw.uniform(-300.0, 300.0)
        short = float(f"{draw.randint(1, 99)}e{draw.randint(-30, 3)}")
        yield from (math.nextafter(short, 0.0), short, math.nextafter(short, math.inf))
    yield from (math.ulp(0.0), sys.float_info.min, LARGEST_PRINTED)


def test_the_text_is_at_least_the_error_and_at_most_a_tenth_more():
    for error in some_errors():
        text = error_text(error)
        assert len(re.sub(r"e.*|^[0.]+|\.", "", text)) <= 2, text
        if error > 1e-320:  # below, floats are further apart than a tenth of them
            assert Fraction(error) <= Fraction(float(text)) <= Fraction(error) * Fraction(11, 10)
        assert float(text) >= error


@pytest.mark.parametrize("error", [0.01, 7e-4, 1e-12, 0.25, 3.0, 0.0, math.inf, math.nan])
def test_what_two_digits_say_stays_as_it_is(error):
    assert error_text(error) == f"{error:g}"


@pytest.mark.parametrize(
    ("error", "text"), [(0.0064, "0.0064"), (0.0143, "0.015"), (0.00999, "0.01"), (99.1, "1e+02")]
)
def test_an_error_is_rounded_up_and_keeps_its_second_digit(error, text):
    assert error_text(error) == text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "name", "asked"),
    [
        ("--velocity 0.1 --amplitude 1", "mu_macro", {"velocity": 0.1, "amplitude": 1.0}),
        ("--force 0.6 --amplitude 1", "velocity", {"force": 0.6, "amplitude": 1.0}),
    ],
)
def test_a_point_claims_no_less_than_its_error(words, name, asked):
    done = run("point", "transverse", *words.split(), "--tolerance", "0.01")
    error = getattr(microslip.solve("transverse", tolerance=0.01, **asked), f"{name}_error")
    said = re.match(rf"{name} = \S+ \+- (\S+)\n", done.stdout)
    assert error <= float(said[1]) <= 1.1 * error


@pytest.mark.slow
def test_a_prediction_claims_no_less_than_its_errors():
    ball = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": "0.3"}
    ball |= {"speed": "10 mm/s", "amplitude": "0.3 um", "frequency": "20 kHz", "tolerance": "0.01"}
    words = [f"--{name}={text}" for name, text in ball.items()]
    text = run("predict", "transverse", *words, "--power").stdout
    found = microslip.predict("transverse", **ball, power=True)
    for name, error in (
        ("mu_macro", found.mu_macro_error),
        ("mu_apparent", found.mu_apparent_error),
        ("power", found.vibration_power_error_W),
    ):
        said = re.search(rf"^{name} +\S+ \+- ([\d.e+-]+)", text, re.MULTILINE)
        assert error <= float(said[1]) <= 1.1 * error
