"""A prediction in words: units, errors, and remarks."""

import math
import re
from dataclasses import replace

import pytest

import microslip
from microslip.app import cli
from microslip.si import request

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
    for title in ("mu_macro", "mu_apparent", "friction force", "static friction"):
        assert re.search(rf"^{title} +{number}( N)?[: ]", slow_text, re.MULTILINE), title
    assert re.search(rf"^force threshold +{number} N: no smaller", slow_text, re.MULTILINE)
    text = text_of(amplitude="0.1 um", force="1 N", tolerance=0.1)
    assert re.search(rf"^safety factor +{number}: ", text, re.MULTILINE)


def test_lengths_of_one_answer_have_one_unit(slow_text):
    answer = slow_text.split("\n\n")[1]
    lengths = re.findall(
        r"^(?:contact radius|indentation|u_lim|amplitude) +\S+ (\S+?),?$",
        re.sub(r" dimensionless.*", "", answer),
        re.MULTILINE,
    )
    assert lengths == ["um"] * 4


@pytest.mark.parametrize(("amplitude", "force"), [("20 um", "2 N"), ("0.1 um", "2.6 N")])
def test_the_unit_of_a_speed_follows_from_its_size(amplitude, force):
    settings = {"amplitude": amplitude, "force": force, "tolerance": 0.1}
    prediction = microslip.predict("transverse", **BALL | settings)
    number, unit = re.search(r"^speed +(\S+) \+- \S+ (\S+)/s$", str(prediction), re.M).groups()
    size = {"m": 1.0, "mm": 1e-3, "um": 1e-6}[unit]
    assert float(number) * size == pytest.approx(prediction.speed_m_s, rel=0.1)
    assert 0.1 <= float(number) < 100.0


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
    assert re.search(r"^static friction +0 \+- ", text, re.MULTILINE)
    assert re.search(r"^force threshold +3 N: ", text, re.MULTILINE)
    assert "it is not the force threshold, because the vibration is along the drive" in text
    text = text_of("elliptic", **along | {"forward_amplitude": "0.1 um", "tolerance": 0.1})
    assert "static friction" in text and "force threshold  " not in text
    assert "it is not the force threshold, because part of the vibration is along the drive" in text
    assert "not the force threshold" not in slow_text


def failed(motion, velocity, *changes, **settings):
    result = microslip.solve(motion, velocity, *changes, **settings)
    if velocity > 0.0:
        return result
    friction = replace(result.friction, by_source={"resolution": 0.26})
    return replace(result, friction=friction, converged=False, reason="lost on the way")


def test_the_exit_code_follows_the_requested_quantity(monkeypatch, capsys):
    """An unconverged static limit does not matter for friction at a speed."""
    monkeypatch.setattr(request, "solve", failed)
    assert cli.main(["predict", "transverse", *words(**BALL | SLOW)]) == 0
    text = capsys.readouterr().out
    assert "NOT CONVERGED: static friction: lost on the way" in text
    assert "NOT CONVERGED: mu_macro" not in text
    result = microslip.predict("transverse", **BALL | SLOW)
    assert result.converged and result.mu_static_reason == "lost on the way"


def test_a_vibration_that_adds_no_displacement_has_no_number_of_cycles():
    """Along the force a contact without mass moves along with the vibration."""
    text = text_of("longitudinal", amplitude="0.1 um", force="1 N", tolerance=0.1)
    assert "forward, then no further: the vibration adds nothing\n" in text


def test_a_contact_much_larger_than_the_other_lengths_has_a_unit_of_its_own():
    """Hertz: (3 F R / (4 E*))^(1/3) with F = 10 N, R = 5 km and 1/E* = (1 - 0.3^2) / 210 GPa."""
    text = text_of(**SLOW | {"radius": "5 km", "tolerance": 0.1})
    size = (0.75 * 10.0 * 5e3 * (1.0 - 0.3**2) / 210e9) ** (1.0 / 3.0)
    assert f"contact radius    {1e3 * size:.3f} mm\n" in text
    assert re.search(r"^u_lim +\S+ nm$", text, re.MULTILINE)


def test_rounding_errors_of_a_threshold_are_zero():
    """At 5 degrees (dimensionless 31) the whole contact slides.

    At 0.0412 rad (dimensionless 14.6) the static limit is 6e-13, a rounding error of 1.
    """
    text = text_of("bore", **SLOW | {"amplitude": "5 deg"})
    assert "static friction   0: " in text and "force threshold   0 N: " in text
    text = text_of("bore", **SLOW | {"amplitude": "0.0412 rad"})
    assert re.search(r"^static friction +0 \+- \S+e-1[23]: ", text, re.MULTILINE)
    zero = r"^force threshold +0 \+- \S+ N: any larger constant force moves"
    assert re.search(zero, text, re.MULTILINE)
