"""Motions from files: samples, identity by content, formats and bad input."""

import numpy as np
import pytest

import microslip
from microslip.app.cli import main
from microslip.foundation.errors import InputError
from microslip.scene.by_name import motion_named
from microslip.scene.hertz import HERTZ

PHASE = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
SINE = np.sin(PHASE)


def file_of(path, **columns):
    rows = zip(*columns.values(), strict=True)
    lines = [",".join(columns), *(",".join(f"{x:.15g}" for x in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n")
    return f"file:{path}"


@pytest.mark.parametrize(
    "columns",
    [
        {"forward": np.cos(2.0 * PHASE), "lateral": SINE},
        {"angle": SINE, "load": 1.0 + SINE},
        {"indentation": 1.0 + SINE},
    ],
    ids=" ".join,
)
def test_a_file_is_the_motion_of_the_samples_in_its_columns(columns, tmp_path):
    read = motion_named(file_of(tmp_path / "stroke.csv", **columns))
    samples = microslip.Sampled.of_columns(columns)
    assert read.rows == pytest.approx(samples.rows, abs=1e-14)
    assert (read.loads, read.rotates) == (samples.loads, samples.rotates)
    assert read.depth(0.3, 0.7, HERTZ) == pytest.approx(samples.depth(0.3, 0.7, HERTZ))


@pytest.mark.parametrize(
    "content",
    ["Lateral;Time\n0,0;0\n1,000;0,25\n0;0,5\n-1;0,75\n", "Lateral\n0,0\n1,0\n0,0\n-1,0\n"],
)
def test_files_may_come_from_spreadsheets(tmp_path, content):
    (tmp_path / "s.csv").write_text(content)
    motion = motion_named(f"file:{tmp_path / 's.csv'},decimal=comma")
    assert motion.rows[:, 1] == pytest.approx([0.0, 1.0, 0.0, -1.0])


ROWS = "0\n1\n0\n-1\n"


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("sideways\n" + ROWS, "sideways"),
        ("lateral [um]\n" + ROWS, "lateral has the unit um, which microslip predict accepts"),
        ("lateral\n0\n1\n0\n", "lateral = 3: the number of rows; allowed are at least 4"),
        ("lateral\n0\n1\nx\n-1\n", "line 4: lateral is 'x'; allowed: a number"),
        ("lateral\n0\n\n1\n0\n-1\n", "line 3: no number"),
        ("time\n" + ROWS, "no displacement and n"),
        ("lateral\n", "no line follows the heading"),
        ("time,lateral\n0,0\n1,1\n2,0\n4,-1\n", "time is not equally spaced"),
        (f"lateral\n{ROWS}0\n", "lateral = 0.0: the last row repeats the first; leave it out"),
        (f"lateral\n{ROWS}-999\n0.5\n", "line 6: lateral is -999, far outside"),
        (f"lateral\n{ROWS}-0.5\n-500.2\n0.5\n", "line 7: lateral is -500.2, far outside"),
    ],
)
def test_bad_files_are_refused_in_one_line(tmp_path, capsys, content, problem):
    (tmp_path / "stroke.csv").write_text(content)
    name = f"file:{tmp_path / 'stroke.csv'}"
    assert main(["point", name, "--velocity", "0.1", "--amplitude", "1"]) == 2
    error = capsys.readouterr().err
    assert problem in error and "MOTION" in error and error.count("\n") == 1


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("file", "file:NAME"),
        ("file:none.csv", "none.csv cannot be read: No such file"),
        ("file:sha256=0123456789abcdef", "no file with this content is known here"),
    ],
)
def test_names_without_a_file_are_refused(name, problem):
    with pytest.raises(InputError, match=f"^motion = .*{problem}"):
        motion_named(name)
