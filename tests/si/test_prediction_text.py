"""A prediction in words: units, errors, and remarks."""

import math
import re
from dataclasses import replace

import pytest

import microslip
from microslip.app import cli
from microslip.si import solve

BALL = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3, "frequency": "20 kHz"}
SLOW = {"amplitude": "0.1 um", "speed": "1 mm/s", "tolerance": 0.01}


def text_of(motion="transverse", **settings):
    return str(microslip.predict(motion, **BALL | settings))


@pytest.fixture(scope="module")
def slow_text():
    """Text of a vibration with static friction."""
    return text_of(**SLOW)


def words(**settings):
    return [word for name, value in settings.items() for word in (f"--{name}", str(value))]


def test_the_command_line_prints_the_text(slow_text, capsys):
    assert cli.main(["predict", "transverse", *words(**BALL | SLOW)]) == 0
    assert capsys.readouterr().out == f"{slow_text}\n"


def test_every_computed_number_has_its_error(slow_text):
    number = r"\d[\d.]* \+- \d[\d.]*"
    for title in ("mu_macro", "mu_apparent", "friction force", "mu_static", "force threshold"):
        assert re.search(rf"^{title} +{number}( N)?[: ]", slow_text, re.MULTILINE), title
    text = text_of(amplitude="0.1 um", force="1 N", tolerance=0.1)
    assert re.search(rf"^safety factor +{number}: ", text, re.MULTILINE)


@pytest.mark.parametrize(("load", "unit", "size"), [(1.0, "MPa", 1e6), (50.0, "GPa", 1e9)])
def test_a_pressure_is_printed_in_one_readable_unit(load, unit, size):
    """Hertz: p0 = 1/pi (6 F E*^2/R^2)^(1/3), with E* = 210 GPa/0.91."""
    p0 = (6.0 * load * (210e9 / 0.91) ** 2 / 5e-3**2) ** (1 / 3) / math.pi
    text = text_of(**SLOW | {"load": load, "hardness": p0, "tolerance": 0.1})
    printed = float(re.search(rf"^largest pressure +(\S+) {unit}$", text, re.M)[1])
    assert printed == pytest.approx(p0 / size, rel=1e-3)
    warning = re.search(rf"the largest pressure, (\S+) {unit}, is .* (\S+) {unit}: the", text)
    assert [float(number) for number in warning.groups()] == pytest.approx(
        [p0 / size] * 2, rel=0.05
    )


def test_an_exact_number_has_no_error():
    """A steady spin has a closed form."""
    text = text_of("continuous-bore", frequency=None, speed="1 mm/s", rotation="10 rad/s")
    assert "e-17" not in text and re.search(r"^mu_macro +0\.\d+: ratio", text, re.MULTILINE)


def test_a_threshold_that_differs_from_static_friction_is_explained(slow_text):
    along = SLOW | {"amplitude": "1 um"}
    text = text_of("longitudinal", **along)
    assert re.search(r"^mu_static_apparent +0 \+- ", text, re.MULTILINE)
    assert re.search(r"^force threshold +3 N: ", text, re.MULTILINE)
    assert "is not the force threshold, because the vibration is along the drive" in text
    text = text_of("elliptic", **along | {"forward_amplitude": "0.1 um", "tolerance": 0.1})
    assert "mu_static_apparent" in text and "force threshold  " not in text
    assert "is not the force threshold, because part of the vibration is along the drive" in text
    assert "not the force threshold" not in slow_text


def failed(motion, velocity, *changes, **settings):
    result = microslip.solve(motion, velocity, *changes, **settings)
    if velocity > 0.0:
        return result
    friction = replace(result.friction, by_source={"resolution": 0.26})
    return result.changed(friction=friction, reason="lost on the way")


def test_the_exit_code_follows_the_requested_quantity(monkeypatch, capsys):
    """An unconverged static limit does not matter for friction at a speed."""
    monkeypatch.setattr(solve, "solve", failed)
    assert cli.main(["predict", "transverse", *words(**BALL | SLOW)]) == 0
    text = capsys.readouterr().out
    assert "NOT CONVERGED: static friction: lost on the way" in text
    assert "NOT CONVERGED: mu_macro" not in text
    result = microslip.predict("transverse", **BALL | SLOW)
    assert result.converged and result.mu_static_reason == "lost on the way"


def test_rounding_errors_of_a_threshold_are_zero():
    """At 5 degrees (dimensionless 31) the whole contact slides."""
    text = text_of("bore", **SLOW | {"amplitude": "5 deg"})
    assert re.search(r"^mu_static_apparent +0: ", text, re.MULTILINE)
    assert re.search(r"^force threshold +0( \+- \S+)? \w*N: ", text, re.MULTILINE)
