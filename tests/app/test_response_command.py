"""`microslip response`: files in, columns out, with units and without."""

import csv
import io
import json
import shlex

import numpy as np
import pytest
import xarray as xr

import microslip
from microslip.app import cli

CONTACT = "--mu 0.3 --load '10 N' --radius '5 mm' --material steel"


def run(capsys, path, text, options=""):
    path.write_text(text)
    code = cli.main(["response", str(path), *shlex.split(options)])
    out, error = capsys.readouterr()
    return code, out, error


def columns_of(text):
    rows = list(csv.reader(io.StringIO(text)))
    values = [[float(cell) if cell else np.nan for cell in row] for row in rows[1:]]
    return dict(zip(rows[0], np.array(values).T, strict=True))


def test_a_path_without_units_is_dimensionless(tmp_path, capsys):
    code, out, _ = run(capsys, tmp_path / "a.csv", "forward,lateral\n0,0\n0.5,0.1\n", "--nu 0.3")
    answer = microslip.response([0, 0.5], [0, 0.1], poisson=0.3)
    assert code == 0
    assert columns_of(out)["force_forward"] == pytest.approx(answer.force_forward, abs=1e-5)


def test_a_path_with_units_needs_a_contact_and_gets_newtons(tmp_path, capsys):
    text = "forward [um];load [N]\n0;10\n0,2;11,5\n"
    code, out, _ = run(capsys, tmp_path / "a.csv", text, f"{CONTACT} --decimal ,")
    assert code == 0
    columns = columns_of(out)
    assert columns["load [N]"] == pytest.approx([10.0, 11.5])
    assert 0.0 < columns["force_forward [N]"][-1] <= 0.3 * 11.5 + 1e-2
    code, _, error = run(capsys, tmp_path / "a.csv", text, "--decimal ,")
    assert code == 2 and "um" in error and len(error.splitlines()) == 1


def test_json_and_files_have_the_same_columns(tmp_path, capsys):
    text = "forward [um]\n0\n0.1\n"
    paths = [tmp_path / name for name in ("a.nc", "b.csv")]
    for path in paths:
        code, out, _ = run(capsys, tmp_path / "a.csv", text, f"{CONTACT} --json --output {path}")
        assert code == 0
    answer = json.loads(out)
    assert run(capsys, tmp_path / "a.csv", text, f"{CONTACT} --output {path}")[:2] == (0, "")
    assert answer["converged"] is True and answer["stick_fraction"][0] is None
    with xr.open_dataset(paths[0]) as dataset:
        assert dataset.force_forward.values == pytest.approx(answer["force_forward"])
    assert columns_of(paths[1].read_text())["force_forward [N]"] == pytest.approx(
        answer["force_forward"]
    )


@pytest.mark.parametrize(
    ("text", "options", "parts"),
    [
        ("forward\n0\nabc\n", "", ("line 3", "abc")),
        ("forward\n0\n\n1,2\n", "", ("line 4",)),
        ("forward [um],load [N]\n0,1\n1,\n", CONTACT, ("line 3", "load")),
        ("forward [N]\n0\n1\n", CONTACT, ("line 2", "forward")),
        ("speed\n0\n1\n", "", ("'speed'", "as in forward [um]")),
        ("forward [um],load [N]\n0,1\n1,-2\n", CONTACT, ("load = -2 N (-0.2 times 10 N)", ">= 0")),
        ("forward,load\n0,1\n1,-2\n", "", ("load = -2.0:", ">= 0")),
        ("forward\n0\n", "", ("2 rows",)),
        ("forward\n0\n1\n", "--output a.txt", ("--output", ".nc")),
        ("forward\n0\n1\n", "--output nowhere/a.csv", ("--output", "folder")),
        ("forward\n0\n1\n", CONTACT, ("unit",)),
    ],
)
def test_bad_input_is_one_line_with_code_2(tmp_path, capsys, text, options, parts):
    code, out, error = run(capsys, tmp_path / "a.csv", text, options)
    assert code == 2 and not out
    (line,) = error.splitlines()
    assert all(part in line for part in parts)
