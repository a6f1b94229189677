"""predict: units of a motion, the request in words, the command line and the records."""

import io
import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from bad_input_tables.odd_quantities import Q

import microslip
from microslip.answer.answer import Estimate
from microslip.app import cli
from microslip.si import inputs, output
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
    assert result.inputs == {
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
        assert result.inputs["counterbody"] == result.counterbody
    assert result.inputs["rotation"] == "10 Hz = 62.8319 rad/s"
    assert result.inputs["counter_radius"] == "flat (default)"


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
    monkeypatch.setattr("microslip.si.solve.solve", lambda *_, **__: rigid.changed(**lost))
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


# One table of inputs and one of outputs


def reads(text, capsys, *words):
    """The output of the command predict."""
    assert cli.main(["predict", "continuous-bore", *options(**SPUN), *words]) == 0
    out = capsys.readouterr().out
    assert text in out
    return out


SPUN = BALL | {"material": "steel", "rotation": "10 Hz"}


def test_a_new_input_takes_one_line_in_the_table(monkeypatch, capsys, tmp_path):
    entry = inputs.Input("bodies", "K", "temperature of the room, such as '293 K'")
    monkeypatch.setitem(inputs.INPUTS, "temperature", entry)
    result = microslip.predict("continuous-bore", **SPUN, temperature="293 K")
    assert result.temperature_K == 293.0 and result.to_dict()["temperature_K"] == 293.0
    assert re.search(r"^temperature +293 K$", str(result), re.M)
    assert "| `temperature` | K | above 0 K | temperature of the room" in output.reference_page()
    (tmp_path / "rooms.csv").write_text("temperature [K],load [N]\n280,10\n300,20\n")
    shared = {name: one for name, one in SPUN.items() if name != "load"}
    table = microslip.predict_table("continuous-bore", tmp_path / "rooms.csv", **shared)
    assert table.temperature_K.values.tolist() == [280.0, 300.0]
    assert table.temperature_K.attrs["units"] == "K"
    assert json.loads(reads("", capsys, "--temperature", "293 K", "--json"))["temperature_K"] == 293
    assert cli.main(["predict", "--help"]) == 0
    assert "temperature of the room" in " ".join(capsys.readouterr().out.split())


def test_a_new_output_takes_one_line_in_the_table(monkeypatch, capsys, tmp_path):
    """The area of Hertz's contact is pi a^2."""
    entry = output.Output("m^2", "area of the contact", lambda contact: contact.area)
    monkeypatch.setitem(output.OUTPUTS, "contact_area", entry)
    result = microslip.predict("continuous-bore", **SPUN | {"load": "10 N +- 1 N"})
    area = math.pi * result.contact_radius_m**2
    assert result.contact_area_m2 == pytest.approx(area) and result.contact_area_error_m2 == 0.0
    # the area is proportional to the load to the power 2/3
    assert result.contact_area_spread_m2 == pytest.approx(2.0 / 3.0 * 0.1 * area, rel=0.02)
    assert re.search(r"^contact area +\S+ m\^2: area of the contact$", str(result), re.M)
    assert "| `contact_area_m2` | m^2 | area of the contact |" in output.reference_page()
    assert result.to_xarray().contact_area_m2.attrs["units"] == "m^2"
    assert json.loads(reads("", capsys, "--json"))["contact_area_m2"] == pytest.approx(area)
    words = options(**SPUN | {"load": "10..20 N, 2"})
    path = tmp_path / "areas.csv"
    assert cli.main(["predict", "continuous-bore", *words, "--output", str(path)]) == 0
    assert pd.read_csv(path).contact_area_m2.iloc[0] == pytest.approx(area)


def test_the_reference_page_is_that_of_the_tables():
    page = Path(microslip.__file__).parents[2] / "docs" / "reference" / "contacts.md"
    assert page.read_text(encoding="utf-8") == output.reference_page()


# Combinations of inputs


SOME = {
    **{"material": ["steel", "rigid", 5, ""], "young": ["210 GPa", "0 Pa", 1e9, "1e300 Pa"]},
    **{"nu": ["0.3", "0.5", 0.7, "0.49 +- 0.02"], "counterbody": ["glass", "70 GPa, 0.2", "x"]},
    **{"radius": ["5 mm", 1e-320, "5 mm +- 5 mm"], "counter_radius": ["-8 mm", "0 m", "-1 mm"]},
    **{"radius_across": ["5 mm", "1 nm"], "contact_radius": ["0.1 mm", "1 km"]},
    **{"pressure": ["hertz", "ring:inner=0.5", "file:no.csv"], "load": ["10 N", 0, "1e300 N", [1]]},
    **{"mu": [0.3, "0.1 +- 0.1", "11", True], "speed": ["1 mm/s", "0 m/s", "1e300 m/s", None]},
    **{"force": ["1 N", "1e-300 N", "10 N +- 9 N"], "drive_stiffness": ["10 N/um", "1e300 N/m"]},
    **{"mass": ["1 g", 0], "damping": ["5 N*s/m"], "amplitude": ["0 m", "1 um", "1 km", "1 deg"]},
    **{"rotation": ["10 Hz", "0 Hz", "10 rad/s +- 5 %"], "frequency": ["20 kHz", "1/s"]},
    **{"load_amplitude": ["5 N"], "phase": ["90 deg", "1e9 rad"], "reduction": ["50 %", 1, "0"]},
    **{"wear_coefficient": ["1e-5 mm^3/N/m", 0], "hardness": ["700 HV", "5 Mohs"]},
    **{"tolerance": [0.1, 1e-9], "map": ["no map"], "diameter": ["5 mm"]},
}
USUAL = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s"}
USUAL |= {"rotation": "10 Hz", "tolerance": 0.1}


def test_random_combinations_are_answered_or_refused_in_one_line():
    """The motion has a closed form, so that all answers are cheap."""
    random = np.random.default_rng(5)
    answered = 0
    for _ in range(500):
        changed = random.choice(list(SOME), size=random.integers(1, 4), replace=False)
        given = dict(USUAL)
        for name in changed:
            given[name] = SOME[name][random.integers(len(SOME[name]))]
        given = {n: x for n, x in given.items() if random.random() < 0.95}
        try:
            result = microslip.predict("continuous-bore", **given)
        except microslip.InputError as error:
            assert error.argument in {*given, *inputs.INPUTS} and "\n" not in str(error)
        else:
            assert str(result) and result.to_dict()
            answered += 1
    assert answered > 20
