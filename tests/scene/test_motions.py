"""Motions: symmetry of the displacement, the zigzag against closed forms, and user-defined
files."""

import json
import math
import sys
from dataclasses import fields

import numpy as np
import pytest
from stubs import in_process

import microslip
from microslip import scene
from microslip.app.cli import main
from microslip.foundation.errors import InputError
from microslip.scene import by_name
from microslip.scene.by_name import MOTIONS
from microslip.scene.drive import Force, Spring
from microslip.scene.named import Elliptic, Transverse
from microslip.scene.problem import Problem
from microslip.theory import paper

PERIODIC = [one() for one in MOTIONS.values() if one.periodic and not fields(one)]
MIRRORED = [motion for motion in PERIODIC if motion.half_period_mirror]
PHASE = np.linspace(-3.0, 3.0, 101)


@pytest.mark.parametrize("name", MIRRORED, ids=lambda name: name.name)
def test_half_a_period_later_a_motion_is_its_own_mirror_image(name):
    """The search for the periodic state relies on this symmetry, up to the drift."""
    motion = Problem(name, 0.3, 0.7, 0.2)
    now, later = motion.displacement(PHASE), motion.displacement(PHASE + np.pi)
    displacement = np.pi * motion.drift
    for one, other, sign, way in zip(
        now, later, (1, -1, -1), (displacement, 0.0, 0.0), strict=True
    ):
        assert other == pytest.approx(sign * one + way, abs=1e-12)


@pytest.mark.parametrize("motion", PERIODIC, ids=lambda motion: motion.name)
def test_a_drift_slower_than_the_rounding_of_the_oscillation_is_told_exactly(motion):
    drift = motion.drift(1.0, 0.7, 0.2)
    assert motion.drift(1e-99, 0.7, 0.2) == pytest.approx(1e-99 * drift, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("motion", PERIODIC, ids=lambda motion: motion.name)
def test_the_oscillation_turns_at_both_ends_of_half_a_period(motion):
    ends = np.array([-0.5, 0.5]) * np.pi
    both = (motion.displacement(at, 0.0, 0.7, 0.0) for at in (PHASE, ends))
    for part, end in zip(*both, strict=True):
        assert np.abs(part).max() <= abs(end[1]) + 1e-12


CUBE = '''"""To and fro across the motion like the cube of a sine: slow in the middle."""

from dataclasses import dataclass

import numpy as np

from microslip.scene.named import Transverse


@dataclass(frozen=True)
class SineCubed(Transverse):
    """Forward v~ t, lateral y~ sin^3 t."""

    summary = "sliding forward while oscillating sideways, slowly in the middle"

    def displacement(self, phase, velocity, amplitude, poisson):
        return velocity * phase, amplitude * np.sin(phase) ** 3, np.zeros_like(phase)
'''


@pytest.fixture
def cube(tmp_path):
    """A user-defined motion in a file; the registry is restored afterwards."""
    registry, path = dict(by_name.MOTIONS), list(scene.__path__)
    (tmp_path / "sine_cubed.py").write_text(CUBE)
    by_name.find(tmp_path)
    yield "sine-cubed"
    by_name.MOTIONS.clear()
    by_name.MOTIONS.update(registry)
    scene.__path__[:] = path
    del sys.modules["microslip.scene.sine_cubed"]


def test_a_motion_is_one_file(cube, capsys):
    """The motion of a file is solved like others, and has the static limit of the transverse
    motion."""
    arguments = ["point", cube, "--velocity", "0.1", "--amplitude", "0.5", "--json"]
    assert main(arguments) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["motion"] == cube
    assert answer["model"] == "radial"
    assert 0.0 < answer["mu_macro_error"] <= answer["tolerance"]
    squares = microslip.solve(cube, 0.1, 0.5, model="cartesian", tolerance=3e-3)
    assert abs(squares.mu_macro - answer["mu_macro"]) <= squares.mu_macro_error + 1e-3
    result = microslip.solve(cube, 0.0, 0.5)
    assert result.mu_macro == pytest.approx(
        paper.static_limit_transverse(0.5), abs=result.mu_macro_error
    )
    with pytest.raises(ValueError, match="allowed is one of transverse, .*, sine-cubed"):
        microslip.solve("cubed", 0.1, 0.5)


BROKEN = {
    "unfinished.py": ("class Unfinished(", "SyntaxError in line 1"),
    "no_package.py": ("\nimport no_such_package", "ModuleNotFoundError in line 2"),
    "number.py": ("NUMBER = 3", "no Motion named Number"),
    "fails.py": (
        "from microslip.scene.named import Transverse\nclass Fails(Transverse):\n"
        "    def __init__(self):\n        1 / 0",
        "ZeroDivisionError in line 4",
    ),
}


@pytest.fixture
def broken(tmp_path):
    """A folder of motions with files that cannot be used; the registry is restored afterwards."""
    registries = (by_name.MOTIONS, by_name.BROKEN)
    before, path = [dict(registry) for registry in registries], list(scene.__path__)
    for name, (text, _) in BROKEN.items():
        (tmp_path / name).write_text(text)
    by_name.find(tmp_path)
    yield tmp_path
    for registry, old in zip(registries, before, strict=True):
        registry.clear()
        registry.update(old)
    scene.__path__[:] = path
    for name in BROKEN:
        sys.modules.pop(f"{scene.__name__}.{name.removesuffix('.py')}", None)


@pytest.mark.parametrize("file", BROKEN)
def test_a_broken_file_is_an_error_of_its_motion_alone(broken, file):
    name, cause = file.removesuffix(".py").replace("_", "-"), BROKEN[file][1]
    with pytest.raises(microslip.InputError) as caught:
        microslip.solve(name, 0.1, 0.5)
    assert caught.value.argument == "motion"
    assert str(broken / file) in str(caught.value) and cause in str(caught.value)
    arguments = ["--velocity", "0.1", "--amplitude", "0.5", "--json"]
    refused = in_process.run("point", name, *arguments)
    (line,) = refused.stderr.splitlines()
    assert refused.returncode == 2 and str(broken / file) in line and cause in line
    assert in_process.run("point", "longitudinal", *arguments).returncode == 0


@pytest.mark.parametrize(
    ("drive", "numbers", "argument"),
    [
        (Force, {"force": math.nan}, "force"),
        (Force, {"force": 0.5, "mass": -1.0}, "mass"),
        (Spring, {"stiffness": -1.0}, "stiffness"),
    ],
)
def test_a_drive_refuses_impossible_numbers(drive, numbers, argument):
    with pytest.raises(microslip.InputError) as caught:
        drive(**numbers)
    assert caught.value.argument == argument


@pytest.mark.parametrize("value", [math.nan, math.inf, "1", None])
def test_numbers_of_a_motion_have_to_be_finite(value):
    with pytest.raises(InputError, match="phase"):
        Elliptic(phase=value)


def test_what_follows_a_prescribed_contact_refuses_a_drive():
    problem = Problem(Transverse(), 0.1, 1.0, drive=Spring(1.0))
    for question in (microslip.history, microslip.period):
        with pytest.raises(InputError) as raised:
            question(problem)
        assert raised.value.argument == "drive"
