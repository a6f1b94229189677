"""`microslip export`: the files, read back and compared with the contact itself."""

import json
import re
import shlex

import numpy as np
import pandas as pd
import pytest
from stubs import certified_stub

import microslip
from microslip.app import cli

BODY = "--young '210 GPa' --nu 0 --mu 0.3 --radius '5 mm'"
SAME = {"young": "210 GPa", "nu": 0, "mu": 0.3, "radius": "5 mm"}
VIBRATED = f"{BODY} --frequency '20 kHz' --tolerance 0.01"


def run(capsys, command):
    code = cli.main(["export", *shlex.split(command)])
    out, error = capsys.readouterr()
    return code, out, error


def jenkins(stiffness, limit, path):
    """Force of springs in series with sliders along a path."""
    slid, forces = np.zeros(len(stiffness)), []
    for x in path:
        force = stiffness * (x - slid)
        excess = np.maximum(np.abs(force) - limit, 0.0) * np.sign(force)
        slid += excess / stiffness
        forces.append(np.sum(force - excess))
    return np.array(forces)


def errors_of(text):
    """The errors in the comments: on loops, and on any path."""
    return [float(x) for x in re.findall(r"^# error of the force.*: ([\d.e+-]+)", text, re.M)]


def test_an_iwan_model_follows_the_response_of_the_contact(tmp_path, capsys):
    file = tmp_path / "iwan.csv"
    code, out, _ = run(capsys, f"iwan {BODY} --load '10 N' --elements 15 --output {file}")
    assert code == 0 and "displacements" in out
    on_loops, on_any_path = errors_of(file.read_text())
    frame = pd.read_csv(file, comment="#")
    columns = ["stiffness [N/m]", "limit_force [N]", "force_error [N]"]
    assert list(frame.columns) == columns and len(frame) == 15
    stiffness, limit = (frame[name].values for name in columns[:2])
    loop = 1e-6 * np.array([0, 0.1, 0.2, 0.25, 0.1, -0.1, -0.2, -0.1, 0.1, 0.25])
    wild = 1e-6 * np.array([0, 0.2, 0.05, 0.15, 0.1, 0.12, -0.3, -0.1, -0.2, 0.1])
    for path, bound in ((loop, on_loops), (wild, on_any_path)):
        real = microslip.predict_response({"forward": path}, **SAME, load="10 N", tolerance=1e-4)
        miss = np.abs(jenkins(stiffness, limit, path) - real.force_forward_N)
        assert np.all(miss <= bound + real.force_error_N)
    # Mindlin's stiffness 8 G a / (2 - nu) and full slip at mu times the load
    assert stiffness.sum() == pytest.approx(4.0 * 105e9 * real.contact_radius_m)
    assert limit.sum() == pytest.approx(3.0)


def test_an_iwan_model_without_a_contact_is_dimensionless(capsys):
    code, out, _ = run(capsys, "iwan --pressure power:exponent=1 --tolerance 1e-2")
    lines = [line for line in out.splitlines() if not line.startswith("#")]
    assert code == 0 and lines[0] == "stiffness,limit_force,force_error"
    stiffness, limit, _ = np.array([line.split(",") for line in lines[1:]], float).T
    assert errors_of(out)[0] <= 1e-2
    path = np.linspace(0.0, 1.2, 200)
    cone = 1.0 - np.maximum(1.0 - path, 0.0) ** 2
    assert jenkins(stiffness, limit, path) == pytest.approx(cone, abs=errors_of(out)[0])
    code, out, _ = run(capsys, "iwan --pressure power:exponent=1 --tolerance 1e-2 --json")
    assert json.loads(out)["stiffness"] == pytest.approx(stiffness, rel=1e-5)


GRID = "--load '10..20 N, 2' --speed '5..20 mm/s, 3' --amplitude '0.1..0.4 um, 3'"


@pytest.fixture(scope="module")
def frame(tmp_path_factory):
    """A table of three axes."""
    file = tmp_path_factory.mktemp("table") / "friction.csv"
    command = f"table transverse {VIBRATED} {GRID} --output {file}"
    assert cli.main(["export", *shlex.split(command)]) == 0
    return pd.read_csv(file, comment="#")


def test_a_table_has_the_predictions_with_their_errors(frame):
    axes, force = ["load [N]", "speed [m/s]", "amplitude [m]"], "friction_force [N]"
    columns = ["mu_apparent", "mu_apparent_error", force, "friction_force_error [N]"]
    assert list(frame.columns) == axes + columns and len(frame) == 18
    row = frame.iloc[16]
    assert row[axes].tolist() == pytest.approx([20.0, 0.02, 2.5e-7])
    quantities = {"load": "20 N", "speed": "20 mm/s", "amplitude": "0.25 um"}
    alone = microslip.predict("transverse", **SAME, **quantities, frequency=2e4, tolerance=0.01)
    assert row[force] == pytest.approx(alone.friction_force_N, rel=1e-12)
    assert row["mu_apparent_error"] == pytest.approx(alone.mu_apparent_error, rel=1e-9)


def test_interpolated_friction_is_within_the_stated_difference(capsys):
    axis = "--load '10 N' --speed '10 mm/s' --amplitude '0..0.6 um, 7'"
    _, out, _ = run(capsys, f"table transverse {VIBRATED} {axis} --json")
    rows = json.loads(out)
    _, out, _ = run(capsys, f"table transverse {VIBRATED} {axis}")
    (stated,) = re.findall(r"values: up to ([\d.e-]+) along amplitude", out)
    amplitude, friction = (
        np.array([row[name] for row in rows]) for name in ("amplitude", "mu_apparent")
    )
    middle = 0.5 * (amplitude[1:] + amplitude[:-1])
    contact = SAME | {"load": 10, "frequency": 2e4, "tolerance": 0.01}
    fine = microslip.predict_grid("transverse", **contact, speed=0.01, amplitude=middle)
    miss = fine.mu_apparent.values - np.interp(middle, amplitude, friction)
    assert np.abs(miss).max() <= float(stated)


STEEL = "--material steel --mu 0.3 --radius '5 mm'"
STILL = f"{VIBRATED} --load '10 N' --speed '1 mm/s'"


@pytest.mark.parametrize(
    ("command", "parts"),
    [
        ("iwan --pressure ring", ("--pressure = 'ring'", "axisymmetric")),
        ("iwan --elements 2.5", ("--elements = '2.5'", "whole number")),
        ("iwan --elements 2 --tolerance 1e-2", ("--elements", "without")),
        ("iwan --material steel", ("--mu", "needed")),
        ("iwan --nu 0.7", ("--poisson", "0.5")),
        (f"iwan {STEEL} --load '1 N' --radius-across '8 mm'", ("--radius-across", "nu = 0")),
        ("iwan --output a.txt", ("--output = 'a.txt'", ".csv")),
        (f"table transverse {STILL}", ("--amplitude", "range")),
        (f"table transverse {VIBRATED} {GRID} --output a.nc", ("--output = 'a.nc'", ".csv")),
        (f"table sideways {VIBRATED} {GRID}", ("MOTION = 'sideways'",)),
        (f"table transverse {VIBRATED} {GRID} --map nowhere.nc", ("--map", "not there")),
        (
            f"table transverse {STILL} --amplitude '-1..1 um, 3'",
            ("-amplitude = '-1..1 um, 3': at amplitude -1 um",),
        ),
        (
            f"table transverse {STILL} --amplitude '1e-7..1 m, 2'",
            ("-amplitude = '1e-7..1 m, 2': at amplitude 1 m",),
        ),
        (
            f"table normal {STILL} --load-amplitude '0..9 N, 3'",
            ("--load-amplitude = '0..9 N, 3': at ",),
        ),
        (
            f"table transverse {STILL} --amplitude '0..1 um' --mass '1 g'",
            ("with --drive-stiffness",),
        ),
    ],
)
def test_bad_input_is_one_line_with_code_2_before_any_work(capsys, monkeypatch, command, parts):
    monkeypatch.setattr("microslip.si.table.predict_inputs", None)
    code, out, error = run(capsys, command)
    assert code == 2 and not out
    (line,) = error.splitlines()
    assert line.startswith("microslip export") and all(part in line for part in parts)


def test_a_table_with_a_point_outside_a_map_is_not_written(tmp_path, capsys, monkeypatch):
    certified_stub.open_without_points(monkeypatch)
    file = tmp_path / "a.csv"
    axis = "--load '10 N' --speed '10 mm/s' --amplitude '0.1..0.2 um, 2' --map certified.nc"
    code, out, error = run(capsys, f"table transverse {VIBRATED} {axis} --output {file}")
    assert code == 1 and not file.exists() and not out
    assert "amplitude_m = 1e-07: --map = 'certified.nc': at velocity" in error
    assert "outside the map" in error and "no table" in error


def test_a_table_suggests_its_own_options_only(capsys):
    code, _, error = run(capsys, f"table transverse {VIBRATED} --load '10 N' --amplitude '0..1 um'")
    assert code == 2 and error == "microslip export table: --speed: needed\n"
    with pytest.raises(SystemExit):
        run(capsys, "table --help")
    text = capsys.readouterr().out
    assert "--speed" in text and "--force" not in text


def test_two_values_have_no_difference_from_interpolation(capsys):
    axes = "--load '10..20 N, 2' --speed '10 mm/s' --amplitude '0..0.2 um, 2'"
    code, out, _ = run(capsys, f"table transverse {VIBRATED} {axes}")
    assert code == 0 and "cannot be computed along load, amplitude" in out and "up to" not in out
