"""Remarks in the output of `microslip point`."""

import math

import pytest

from microslip.answer.answer import OWN_EQUATIONS
from microslip.app.cli import main

POINT = ["point", "transverse", "--velocity", "0.1", "--amplitude", "1"]
STEADY = ["point", "continuous-bore", "--velocity", "0.8"]


@pytest.mark.parametrize("model", ["rigid", "slider", "dahl", "mdr"])
def test_an_approximation_that_was_asked_for_says_so(model, capsys):
    assert main([*POINT, "--model", model]) == 0
    assert OWN_EQUATIONS in capsys.readouterr().out.splitlines()


@pytest.mark.parametrize("words", [POINT, [*POINT, "--model", "radial"], STEADY])
def test_what_is_right_does_not(words, capsys):
    assert main(words) == 0
    assert OWN_EQUATIONS not in capsys.readouterr().out


def test_under_a_force_the_velocity_is_printed(capsys):
    """A rigid slider drifts at (2/pi) A P / sqrt(1 - P^2), here for P = 0.6."""
    assert main([*POINT[:2], "--force", "0.6", "--amplitude", "100", "--tolerance", "0.1"]) == 0
    velocity = capsys.readouterr().out.splitlines()[0].removeprefix("velocity = ")
    rigid = 2.0 / math.pi * 100.0 * 0.6 / 0.8
    assert 0.97 * rigid < float(velocity.split()[0]) < rigid
