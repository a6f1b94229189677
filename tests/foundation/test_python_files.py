"""Motions and pressures in Python files, by path."""

import json
import sys

import numpy as np
import pytest
from stubs.new_process import output

import microslip
from microslip.app.cli import main
from microslip.config import load
from microslip.foundation import named_files
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import base_name
from microslip.scene.by_name import motion_named, pressure_named
from microslip.sweeps import request

HELPER = "from parts import FACTOR\n"
PARTS = {"__init__": "from .value import FACTOR\n", "value": "FACTOR = 1.0\n"}
MOTION = """
from dataclasses import dataclass
from helper import FACTOR
from microslip.scene.motion import Motion, Wave

class _Base(Motion):
    pass

@dataclass(frozen=True)
class Sideways(_Base):
    share: float = 1.0
    summary = "going sideways"

    @property
    def waves(self):
        return {"lateral": Wave(FACTOR * self.share)}
"""
PRESSURE = """
from dataclasses import dataclass
from microslip.scene.indenters import Power

@dataclass(frozen=True)
class Cone(Power):
    exponent: float = 1.0
"""
NAME = "mine/side_ways.py"


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A folder with a motion, a pressure and a file that the motion imports."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "mine"
    folder.mkdir()
    for name, text in (("helper", HELPER), ("side_ways", MOTION), ("cone", PRESSURE)):
        (folder / f"{name}.py").write_text(text)
    (folder / "parts").mkdir()
    for name, text in PARTS.items():
        (folder / f"parts/{name}.py").write_text(text)
    return folder


def test_a_class_in_a_file_is_used_like_one_of_the_package(mine):
    own = microslip.solve(NAME, 0.3, 0.5, pressure="mine/cone.py", tolerance=1e-2)
    other = microslip.solve("transverse", 0.3, 0.5, pressure="power:exponent=1", tolerance=1e-2)
    assert own.mu_macro == other.mu_macro
    assert motion_named(f"{NAME}:share=0.5").waves["lateral"].share == 0.5
    assert pressure_named("mine/cone.py:exponent=2").depth(0.5) == 0.25
    assert motion_named(NAME) is motion_named(str(mine / "side_ways.py"))


def test_the_name_in_results_has_a_digest_in_place_of_the_folder(mine):
    name = motion_named(f"{NAME}:share=0.5").name
    assert name.startswith("side_ways.py:sha256=") and name.endswith(",share=0.5")
    assert (
        motion_named(f"{NAME}:share=1").name == motion_named(NAME).name == str(motion_named(NAME))
    )
    assert motion_named(name) is motion_named(f"{NAME}:share=0.50")
    assert base_name(name) == "side_ways.py"


EDITS = [
    ("side_ways", lambda text: text + "# a comment\n", False),
    ("side_ways", lambda text: text.replace("lateral", "angle"), True),
    ("helper", lambda text: "FACTOR = 0.5\n", True),
    ("new", lambda text: "OTHER = 1\n", False),
    ("parts/value", lambda text: "FACTOR = 0.5\n", True),
]


@pytest.mark.parametrize(("name", "edit", "counts"), EDITS)
def test_the_code_of_the_file_and_of_its_imports_counts(mine, name, edit, counts):
    before, file = motion_named(NAME), mine / f"{name}.py"
    keys = [request.key_of({"kind": "point", "motion": before.name, "velocity": "1"})]
    file.write_text(edit(file.read_text() if file.exists() else ""))
    after = motion_named(NAME)
    keys.append(request.key_of({"kind": "point", "motion": after.name, "velocity": "1"}))
    assert (keys[0] != keys[1]) == (after is not before) == counts
    wave = after.waves.get("lateral")
    assert wave is None or wave.share == (0.5 if counts and name != "side_ways" else 1.0)


def test_files_of_the_same_name_in_two_folders_do_not_disturb_each_other(mine, tmp_path):
    (tmp_path / "other").mkdir()
    for name, text in (("helper", "FACTOR = 0.25\n"), ("side_ways", MOTION)):
        (tmp_path / "other" / f"{name}.py").write_text(text)
    shares = [motion_named(f"{n}/side_ways.py").waves["lateral"].share for n in ("mine", "other")]
    assert shares == [1.0, 0.25] and "helper" not in sys.modules
    assert not (mine / "__pycache__").exists()


JOB = """
import json, sys
from microslip.foundation import named_files
from microslip.sweeps import evaluate
named_files.remember(json.loads(sys.argv[1]))
print(evaluate.computed(json.loads(sys.argv[2]))["mu_macro"])
"""


def test_a_configuration_finds_the_file_and_a_job_uses_it(mine, monkeypatch):
    axes = {"velocity": [0.5], "amplitude": [1.0], "tolerance": 0.1}
    sweep = {"motion": "side_ways.py:share=0.5", "pressure": "cone.py", **axes}
    (mine / "own.yaml").write_text(json.dumps({"sweeps": {"own": sweep}}))
    batch = request.points_of(load.load(mine / "own.yaml").sweeps["own"])
    assert batch.folder == "side_ways"
    assert batch.requests[0]["motion"] == motion_named("mine/side_ways.py:share=0.5").name
    placed = load.with_paths({"sweeps": {"own": sweep}}, [mine])["sweeps"]["own"]
    monkeypatch.chdir("/")
    names = json.dumps([placed["motion"], placed["pressure"]])
    assert np.isfinite(float(output(JOB, names, json.dumps(batch.requests[0]))))


def test_a_file_that_has_changed_or_is_elsewhere_is_refused_by_its_old_name(mine, monkeypatch):
    name = motion_named(NAME).name
    (mine / "helper.py").write_text("FACTOR = 0.1\n")
    with pytest.raises(InputError, match="has changed: its sha256 begins with"):
        motion_named(name)
    monkeypatch.setattr(named_files, "PLACES", {})
    with pytest.raises(InputError, match="cannot be read: No such file; looked for "):
        motion_named(name)


TWO = MOTION + "\nclass Other(Motion):\n    summary = 'another'\n"
BAD = [
    ("mine/none.py", None, "mine/none.py cannot be read: No such file; looked for "),
    ("mine/x.py", "A = 1", "it has 0 subclasses of microslip.Motion; allowed is one in a file"),
    ("mine/x.py", TWO, "it has 2 subclasses of microslip.Motion: Sideways, Other; allowed"),
    ("mine/x.py", "def x(", "cannot be imported: SyntaxError in line 1: "),
    ("mine/x.py", "\n1 / 0", "cannot be imported: ZeroDivisionError in line 2: "),
    ("mine/x.py:shar=2", MOTION, "unknown number shar; allowed: share"),
    ("mine/x.py:share", MOTION, "in it 'share': allowed are numbers as in x.py:key=0.5"),
    ("mine/x.py:share=2", MOTION, "= 2: allowed is a share in 0..1"),
    ("mine/x.py", MOTION.replace("self.share)", "1 / 0)"), "DivisionError in waves, line 16: "),
]


@pytest.mark.parametrize(("name", "content", "problem"), BAD)
def test_a_file_without_a_clear_motion_is_refused_in_one_line(mine, name, content, problem):
    if content is not None:
        (mine / "x.py").write_text(content)
    with pytest.raises(InputError) as refused:
        motion_named(name)
    assert refused.value.argument == "motion"
    assert problem in str(refused.value) and "\n" not in str(refused.value)


LATER = (
    MOTION
    + """
    def displacement(self, phase, velocity, amplitude, poisson):
        1 / (velocity in (0.0, 1.0))
        return super().displacement(phase, velocity, amplitude, poisson)
"""
)


def test_a_file_that_fails_later_is_one_line_and_the_package_a_traceback(mine, monkeypatch, capsys):
    (mine / "x.py").write_text(LATER)
    words = ["point", "mine/x.py", "--velocity", "0.3", "--amplitude", "1"]
    assert main(words) == 2
    error = capsys.readouterr().err
    assert "x.py: ZeroDivisionError in displacement, line 19: " in error and error.count("\n") == 1
    monkeypatch.setattr("microslip.answer.point.request_of", None)
    with pytest.raises(TypeError):
        main(words)
