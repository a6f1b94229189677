"""predict: answers against the solver, texts and JSON, one table of inputs and one of outputs."""

import json
import math
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bad_input_tables.odd_quantities import Q

import microslip
from microslip.answer.answer import Estimate, about
from microslip.app import cli
from microslip.si import inputs, output
from microslip.si import solve as module

BALL = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s"}
SHAKEN = BALL | {"young": "210 GPa", "nu": 0.3, "amplitude": "1 um", "frequency": "20 kHz"}
SPUN = BALL | {"material": "steel", "rotation": "10 Hz"}
SLOW = SHAKEN | {"amplitude": "0.1 um", "tolerance": 0.01}


def options(**settings):
    pairs = ((name.replace("_", "-"), value) for name, value in settings.items())
    return [f"--{name}={value}" for name, value in pairs if value is not None]


# Answers


LENS = {"radius": None, "contact_radius": "0.1 mm", "pressure": "power:exponent=4"}


@pytest.mark.parametrize("shape", [{}, LENS])
def test_a_prediction_is_the_answer_of_the_solver_in_si_units(shape):
    result = microslip.predict("transverse", **SHAKEN | shape, tolerance=0.01)
    point, pressure = (result.velocity, result.amplitude), shape.get("pressure", "hertz")
    answer = microslip.solve("transverse", *point, poisson=0.3, pressure=pressure, tolerance=0.01)
    assert (result.mu_macro, result.mu_macro_error) == (answer.mu_macro, answer.mu_macro_error)
    assert (result.pressure, result.amplitude) == (pressure, 1e-6 / result.u_lim_m)
    assert result.mu_apparent == pytest.approx(0.3 * answer.mu_macro)
    assert result.friction_force_N == pytest.approx(3.0 * answer.mu_macro)
    assert result.force_reduction == pytest.approx(1 - answer.mu_macro)
    # the whole contact slides in each stroke
    assert result.mu_static == pytest.approx(0.0, abs=result.mu_static_error)


@pytest.mark.parametrize(
    ("motion", "other"),
    [
        ("elliptic", {"forward_amplitude": 0.0}),
        ("transverse-bore", {"rotation_amplitude": "0 deg"}),
        ("elliptic:forward=0,phase=0", {}),
    ],
)
def test_a_motion_with_a_second_oscillation_of_0_is_the_transverse_one(motion, other):
    plain = microslip.predict("transverse", **SLOW)
    result = microslip.predict(motion, **SLOW | other)
    error = plain.mu_macro_error + result.mu_macro_error
    assert result.mu_macro == pytest.approx(plain.mu_macro, abs=error)
    assert (result.velocity, result.amplitude) == (plain.velocity, plain.amplitude)


def test_a_bore_of_no_amplitude_has_no_velocity():
    still = microslip.predict("bore", **SHAKEN | {"amplitude": "0 deg"})
    assert (still.velocity, still.mu_macro, still.force_reduction) == (None, 1.0, 0.0)


@pytest.mark.long
def test_a_load_amplitude_above_the_load_separates_the_bodies():
    """The mean load is the integral of 10 N + 15 N sin t over its positive part."""
    settings = SHAKEN | {"amplitude": None, "load_amplitude": "15 N", "tolerance": 0.01}
    result = microslip.predict("normal", **settings)
    gone = math.acos(10.0 / 15.0)  # half the phases without contact, around 3 pi/2
    mean = 10.0 * (1.0 - gone / math.pi) + 15.0 * math.sin(gone) / math.pi
    answer = microslip.solve("normal", result.velocity, 1.5, poisson=0.3, tolerance=0.01)
    assert result.mu_macro == answer.mu_macro
    assert result.friction_force_N == pytest.approx(0.3 * mean * result.mu_macro, rel=1e-9)
    assert result.force_reduction == pytest.approx(1.0 - result.friction_force_N / 3.0)
    assert any(f"{mean:.4g} N" in text for text in result.warnings)


OWN_BORE = """from microslip.scene.named import Bore

class OwnBore(Bore):
    summary = "turning as it likes"
"""


def test_a_motion_of_the_users_own_file_has_the_units_of_its_kind(tmp_path):
    """A copy of the bore has the units and the answer of the bore."""
    path = tmp_path / "own_bore.py"
    path.write_text(OWN_BORE)
    spin = SLOW | {"amplitude": "0.2 deg"}
    result, bore = (microslip.predict(motion, **spin) for motion in (str(path), "bore"))
    assert (result.velocity, result.amplitude) == (bore.velocity, bore.amplitude)
    assert result.inputs["motion"].endswith(": the sphere is turning as it likes")
    with pytest.raises(microslip.InputError, match="units of rad"):
        microslip.predict(str(path), **spin | {"amplitude": "1 um"})


# Texts and JSON


def test_a_prediction_repeats_the_inputs_as_the_user_wrote_them():
    request = SPUN | {"rotation": "600 rpm", "radius": 0.005, "load": Q(10, "N")}
    request |= {"counterbody": "70 GPa, 0.22", "counter_radius": "-20 mm", "hardness": "7 GPa"}
    result = microslip.predict("continuous-bore", **request)
    assert result.counterbody == "E = 70 GPa, nu = 0.22"
    expected = {
        "counterbody": "E = 70 GPa, nu = 0.22",
        "radius": "0.005 m",
        "counter_radius": "-20 mm, hollow",
        "load": "10 N",
        "mu": "0.3",
        "speed": "1 mm/s",
        "rotation": "600 rpm = 62.8319 rad/s",
    }
    assert list(result.inputs) == ["motion", "body", *expected]
    plain = result.to_dict()
    assert plain["force_threshold_error_N"] == 0.0
    assert (plain["mu_static"], plain["mu_static_error"]) == (None, None)
    assert result.inputs.items() >= expected.items()
    assert result.inputs["body"].endswith("hardness 7 GPa")


def test_the_command_line_prints_the_text_and_the_json_of_the_prediction(capsys):
    result, words = microslip.predict("transverse", **SLOW), options(**SLOW)
    assert cli.main(["predict", "transverse", *words]) == 0
    assert capsys.readouterr().out == f"{result}\n"
    radius = re.search(r"^contact radius +(\S+) um$", str(result), re.MULTILINE)[1]
    assert float(radius) * 1e-6 == pytest.approx(result.contact_radius_m, rel=1e-3)
    assert cli.main(["predict", "transverse", *words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == result.to_dict()


def test_a_threshold_that_differs_from_static_friction_is_explained():
    text = str(microslip.predict("longitudinal", **SLOW | {"amplitude": "1 um"}))
    assert re.search(r"^mu_static_apparent +0 \+- ", text, re.MULTILINE)
    assert re.search(r"^force threshold +3 N: ", text, re.MULTILINE)
    assert "is not the force threshold, because the vibration is along the drive" in text
    parts = {"amplitude": "1 um", "forward_amplitude": "0.1 um", "tolerance": 0.1}
    result = microslip.predict("elliptic", **SLOW | parts)
    assert result.force_threshold_N is None
    assert any("part of the vibration is along the drive" in text for text in result.remarks)


LOST = {"converged": False, "reason": "lost on the way"}


@pytest.mark.parametrize(
    ("changes", "unknown"),
    [
        ({}, "mu_macro"),
        ({"reduction": "50 %", "amplitude": None}, "amplitude"),
        ({"speed": None, "force": "2.9 N"}, "speed"),
    ],
)
def test_a_failure_of_the_solver_has_its_reason(changes, unknown, monkeypatch):
    rigid = microslip.solve("transverse", 0.5, 0.5, model="rigid", tolerance=0.1)
    nothing = {"friction": Estimate(math.nan), "mean_velocity": Estimate(math.nan)}
    monkeypatch.setattr(module, "solve", lambda *_, **__: rigid.changed(**nothing, **LOST))
    result = microslip.predict("transverse", **SHAKEN | changes)
    assert result.outcome is None and math.isnan(result.mu_macro)
    assert result.reason == "lost on the way"
    assert f"NOT CONVERGED: {unknown}: lost on the way" in str(result)
    assert "nan" not in str(result) and re.search(r" unknown(: lost|$)", str(result), re.MULTILINE)


def test_an_unconverged_static_limit_does_not_matter_for_friction_at_a_speed(monkeypatch, capsys):
    def failed(problem, **settings):
        result = microslip.solve(problem, **settings)
        if problem.velocity > 0.0:
            return result
        friction = replace(result.friction, by_source={"resolution": 0.26})
        return result.changed(friction=friction, **LOST)

    monkeypatch.setattr(module, "solve", failed)
    assert cli.main(["predict", "transverse", *options(**SLOW)]) == 0
    text = capsys.readouterr().out
    assert "NOT CONVERGED: static friction: lost on the way" in text
    assert "NOT CONVERGED: mu_macro" not in text


# One table of inputs and one of outputs


def test_a_new_input_takes_one_line_in_the_table(monkeypatch, capsys):
    entry = inputs.Input("bodies", "K", "temperature of the room, such as '293 K'")
    monkeypatch.setitem(inputs.INPUTS, "temperature", entry)
    table = microslip.predict_table("continuous-bore", {"temperature [K]": [280, 300]}, **SPUN)
    assert table.temperature_K.values.tolist() == [280.0, 300.0]
    words = options(**SPUN, temperature="293 K")
    assert cli.main(["predict", "continuous-bore", *words, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["temperature_K"] == 293
    assert cli.main(["predict", "--help"]) == 0
    assert "temperature of the room" in " ".join(capsys.readouterr().out.split())


def test_a_new_output_takes_one_line_in_the_table(monkeypatch):
    """The area of Hertz's contact is pi a^2, proportional to the load to the power 2/3."""
    entry = output.Output("m^2", "area of the contact", "area")
    monkeypatch.setitem(output.OUTPUTS, "contact_area", entry)
    result = microslip.predict("continuous-bore", **SPUN | {"load": "10 N +- 1 N"})
    area = math.pi * result.contact_radius_m**2
    assert result.contact_area_m2 == pytest.approx(area) and result.contact_area_error_m2 == 0.0
    assert result.contact_area_spread_m2 == pytest.approx(2.0 / 3.0 * 0.1 * area, rel=0.02)
    assert re.search(r"^contact area +\S+ m\^2: area of the contact$", str(result), re.M)
    assert result.to_xarray().contact_area_m2.attrs["units"] == "m^2"


def test_the_reference_page_is_that_of_the_tables(tmp_path):
    docs = Path(microslip.__file__).parents[2] / "docs"
    script, copy = docs / "make_contact_tables.py", tmp_path / "contacts.md"
    subprocess.run([sys.executable, script, copy], check=True)
    assert copy.read_text() == (docs / "reference" / "contacts.md").read_text(encoding="utf-8")


# Combinations of inputs

KEPT = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3, "tolerance": 0.1}
NEEDS = {"amplitude": "1 um", "frequency": "20 kHz", "forward_amplitude": "1 um"}
NEEDS |= {"rotation_amplitude": "1 mrad", "load_amplitude": "3 N", "rotation": "10 Hz"}
SHAPES = [{}, {}, {"radius": None, "contact_radius": "0.1 mm", "pressure": "power:exponent=1"}]
SHAPES += [{"radius": 1e-320}, {"counter_radius": "-8 mm"}, {"radius_across": "1 nm"}]
DRIVES = [{"speed": "1 mm/s"}, {"speed": 0}, {"force": "1 N"}, {"force": "10 N", "mass": "1 g"}]
DRIVES += [{}, {"speed": 1, "drive_stiffness": "1e300 N/m"}, {"speed": 1, "reduction": "50 %"}]
WORDS = ["", "rigid", "70 GPa, 0.2", "punch:flat=0.5", "file:no.csv", "1 deg", 5, True, [1], None]
SIZES = [0, 1e-300, 1e-6, 0.5, -8e-3, 1e3, 1e10, 1e300]


def test_random_combinations_are_answered_or_refused_in_one_line(monkeypatch):
    """The solver is replaced by a rigid slider, so that all answers are cheap.

    Up to two inputs have a size in their own unit or a word that is none.
    """
    rigid = microslip.solve("transverse", 0.5, 0.5, model="rigid", tolerance=0.1)

    def solve(problem, **_):
        drift = problem.velocity if problem.force is None else random.choice([0.0, 0.5, math.nan])
        seed = hash((problem.velocity, problem.size)) % 2**32  # equal points, equal friction
        share = Estimate(np.random.default_rng(seed).random(), {"resolution": 0.01})
        return rigid.changed(**about(problem), mean_velocity=Estimate(drift), friction=share)

    monkeypatch.setattr(module, "solve", solve)
    random, answers = np.random.default_rng(5), 0
    for _ in range(600):
        motion = random.choice([*inputs.MOTIONS, "triangle", "no such motion"])
        kind = inputs.MOTIONS.get(motion, inputs.MOTIONS["transverse"])
        given = KEPT | {name: NEEDS[name] for name in kind.needed}
        given |= {"amplitude": "1 mrad"} if motion == "bore" else {}
        given |= SHAPES[random.integers(len(SHAPES))] | DRIVES[random.integers(len(DRIVES))]
        for name in random.choice([*inputs.INPUTS], size=random.integers(3), replace=False):
            sizes = [f"{size} {inputs.INPUTS[name].unit}" for size in SIZES]
            given[name] = (sizes + WORDS)[random.integers(len(SIZES + WORDS))]
        given = {name: one for name, one in given.items() if random.random() < 0.97}
        try:
            result = microslip.predict(motion, **given)
        except microslip.InputError as error:
            assert error.argument in {*given, *inputs.INPUTS, "motion"} and "\n" not in str(error)
        else:
            assert str(result) and result.to_dict()
            answers += 1
    assert answers > 50, answers
