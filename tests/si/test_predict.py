"""predict: units of a motion, the request in words, the command line and the records."""

import io
import json
import math
import sys
from dataclasses import fields, replace

import pytest
from bad_input_tables.odd_quantities import Q

import microslip
from microslip.app import cli
from microslip.estimate.estimate import Estimate
from microslip.si import prediction
from microslip.si.materials import Material

BALL = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s"}
EXAMPLE = BALL | {"young": "210 GPa", "nu": 0.3, "amplitude": "1 um", "frequency": "20 kHz"}
EXAMPLE |= {"tolerance": 0.05}


# One motion in many units

TURN = 2.0 * math.pi
SPIN = BALL | {"material": "steel", "mu": 0.3}


@pytest.mark.parametrize("rotation", ["10 turn/s", "600 rpm", TURN * 10.0, Q(10, "Hz")], ids=str)
def test_a_spin_is_the_same_in_any_unit(rotation):
    result = microslip.predict("continuous-bore", rotation=rotation, **SPIN)
    assert result.rotation_rad_s == pytest.approx(TURN * 10.0, rel=1e-15)
    # v0 / (omega a) by hand, with Hertz's a of this ball on a rigid flat
    radius = (0.75 * 10.0 * 0.005 * (1.0 - 0.09) / 210e9) ** (1.0 / 3.0)
    assert result.velocity == pytest.approx(1e-3 / (TURN * 10.0 * radius), rel=1e-12)


# What was understood


def test_a_prediction_repeats_what_it_was_asked_in_the_units_that_were_given():
    request = EXAMPLE | {"counterbody": "70 GPa, 0.22", "radius": 0.005, "frequency": "1.2e6 rpm"}
    request |= {"counter_radius": "-20 mm", "load": Q(10, "N"), "hardness": "7 GPa"}
    result = microslip.predict("transverse", **request)
    assert result.counterbody == "E = 70 GPa, nu = 0.22"
    assert result.understood == {
        "motion": "transverse: the sphere slides forward and oscillates sideways",
        "body": "E = 210 GPa, nu = 0.3, hardness 7 GPa",
        "counterbody": "E = 70 GPa, nu = 0.22",
        "radius": "0.005 m",
        "counter_radius": "-20 mm, hollow",
        "load": "10 N",
        "mu": "0.3",
        "speed": "1 mm/s",
        "amplitude": "1 um",
        "frequency": "1.2e6 rpm = 20000 Hz",
    }


def test_the_counterbody_is_rigid_unless_told_otherwise_and_so_it_is_said():
    request = BALL | {"material": "steel", "rotation": "10 Hz"}
    for settings, message in (
        ({}, "rigid (default)"),
        ({"counterbody": "rigid"}, "rigid"),
        ({"counterbody": "glass"}, "glass (E = 70 GPa, nu = 0.2, hardness 6 GPa"),
        ({"counterbody": Material(70e9, 0.22)}, "E = 70 GPa, nu = 0.22"),
    ):
        result = microslip.predict("continuous-bore", **request | settings)
        assert result.counterbody.startswith(message)
        assert result.understood["counterbody"] == result.counterbody
    assert result.understood["rotation"] == "10 Hz = 62.8319 rad/s"
    assert result.understood["counter_radius"] == "flat (default)"


# Command line


def options(**settings):
    words = [(f"--{name.replace('_', '-')}", str(value)) for name, value in settings.items()]
    return [word for pair in words for word in pair]


def test_the_command_line_answers_in_json(capsys):
    request = EXAMPLE | {"counterbody": "rigid"}
    assert cli.main(["predict", "transverse", *options(**request), "--json"]) == 0
    message = json.loads(capsys.readouterr().out)
    expected = "contact_radius_m indentation_m u_lim_m velocity amplitude mu_macro mu_macro_error"
    assert message.keys() >= {*expected.split(), "mu_apparent", "warnings"}
    assert message == microslip.predict("transverse", **request).to_dict()


def test_an_answer_that_is_no_number_says_why(monkeypatch, capsys):
    """The solver fails at the requested amplitude, and in the search for an amplitude."""

    rigid = microslip.solve("transverse", 0.5, 0.5, model="rigid", tolerance=0.1)
    lost = {"friction": Estimate(math.nan), "converged": False, "reason": "lost on the way"}
    monkeypatch.setattr("microslip.si.request.solve", lambda *_, **__: replace(rigid, **lost))
    for motion, name in (({"amplitude": "1 um"}, "mu_macro"), ({"reduction": "50 %"}, "amplitude")):
        words = options(**BALL, **motion, material="steel", frequency="20 kHz")
        assert cli.main(["predict", "transverse", *words, "--json"]) == 1
        message = json.loads(capsys.readouterr().out)
        assert (message["mu_macro"], message["reason"]) == (None, "lost on the way")
        assert cli.main(["predict", "transverse", *words]) == 1
        assert f"NOT CONVERGED: {name}: lost on the way" in capsys.readouterr().out


def test_an_answer_can_be_written_in_any_alphabet(monkeypatch):
    words = options(material="steel", rotation="3600 \u00b0/s", **BALL | {"radius": "5000 \u03bcm"})
    message = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(message, encoding="latin-1"))
    assert cli.main(["predict", "continuous-bore", *words]) == 0
    sys.stdout.flush()
    assert b"5000 \\u03bcm" in message.getvalue() and b"3600 \xb0/s = 62.8319" in message.getvalue()


# Records


@pytest.mark.parametrize(
    ("motion", "drive", "record"),
    [
        ("transverse", {"speed": "1 mm/s"}, prediction.Sliding),
        ("transverse", {"force": "1 N"}, prediction.Rest),
        ("transverse", {"force": "4 N"}, prediction.Drift),
        ("continuous-bore", {"speed": "1 mm/s"}, prediction.SteadySpin),
        ("continuous-bore", {"force": "1 N"}, prediction.SpinDrift),
    ],
)
def test_each_question_has_a_record_of_its_own_and_all_have_the_same_columns(motion, drive, record):
    oscillation = {"amplitude": "0.1 um", "frequency": "20 kHz"}
    oscillation = {"rotation": "10 Hz"} if motion == "continuous-bore" else oscillation
    ball = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "material": "steel", "tolerance": 0.05}
    result = microslip.predict(motion, **ball, **oscillation, **drive)
    assert type(result) is record
    assert tuple(result.to_dict()) == prediction.COLUMNS
    own = {field.name for field in fields(result)}
    assert ("outcome" in own) == ("force" in drive)
    assert ("mu_static" in own) == ("amplitude" in oscillation) != ("torque_N_m" in own)
    assert (result.outcome is None) == ("force" not in drive)
    with pytest.raises(AttributeError, match="no column 'mu_marco'"):
        _ = result.mu_marco
