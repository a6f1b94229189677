"""The command line: answers, files, help and exit codes, mostly without a process of its own."""

import io
import json
import math
import re
import shlex
import sys
import time

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from stubs import certified_stub
from stubs.eq6_map import eq6_map
from stubs.in_process import run
from stubs.new_process import output

import microslip
from microslip.answer.answer import OWN_EQUATIONS
from microslip.app import progress
from microslip.app.commands import COMMANDS
from microslip.scene.by_name import MOTIONS

POINT = "point transverse --velocity 0.1 --amplitude 1"
CONTACT = "--mu 0.3 --load '10 N' --radius '5 mm' --material steel"


def answer(line, code=0):
    """Standard output of a command line with this exit code and without messages."""
    process = run(*shlex.split(line))
    assert (process.returncode, process.stderr) == (code, "")
    return process.stdout


def refusal(line, code=2):
    """The one line of a command line that is refused."""
    process = run(*shlex.split(line))
    assert (process.returncode, process.stdout) == (code, "")
    assert process.stderr.startswith("microslip ") and process.stderr.count("\n") == 1
    return process.stderr


def rows_of(text):
    """Columns of CSV text with comments, by heading."""
    return pd.read_csv(io.StringIO(text), comment="#")


# Point

CONTRACT = {"motion", "velocity", "amplitude", "poisson", "model", "mu_macro", "mu_macro_error"}
CONTRACT |= {"converged", "cells", "steps_per_period", "periods", "solve_time_s"}
"""Fields of every result of a point."""


@pytest.mark.parametrize(
    ("motion", "arguments"),
    [
        ("transverse", {"velocity": 0.5, "amplitude": 0.5}),
        ("bore", {"velocity": 0.5, "amplitude": 1.0, "poisson": 0.3, "tolerance": 5e-3}),
        ("continuous-bore", {"velocity": 0.5}),
        ("transverse", {"velocity": 0, "amplitude": 0.5}),
        ("bore", {"velocity": 2, "amplitude": 1, "cells": 6, "steps": 8, "tolerance": 0.1}),
    ],
)
def test_json_and_text_are_the_answer_of_solve(motion, arguments):
    options = " ".join(f"--{name} {value}" for name, value in arguments.items())
    text = answer(f"point {motion} {options} --json")
    assert text.count("\n") == 1
    fields = json.loads(text)
    assert fields.keys() >= CONTRACT
    steady = motion == "continuous-bore"
    assert (fields["amplitude"] is None) == ("mu_torque" in fields) == steady
    result = microslip.solve(motion, **arguments)
    expected = {"amplitude": None} | result.to_dict()
    for one in (fields, expected):  # equal to the last bit, except the time
        one.pop("solve_time_s")
    assert fields == expected
    assert answer(f"point {motion} {options}") == f"{result}\n"


@pytest.mark.parametrize("model", ["slider", "radial"])
def test_an_approximate_model_is_named_in_the_answer(model):
    assert (OWN_EQUATIONS in answer(f"{POINT} --model {model}")) == (model != "radial")


def test_under_a_force_the_velocity_is_printed():
    """A rigid slider drifts at (2/pi) A P / sqrt(1 - P^2), here for P = 0.6."""
    text = answer("point transverse --force 0.6 --amplitude 100 --tolerance 0.1")
    rigid = 2.0 / math.pi * 100.0 * 0.6 / 0.8
    assert 0.97 * rigid < float(text.removeprefix("velocity = ").split()[0]) < rigid


def test_exit_code_1_means_not_converged_at_an_imposed_resolution_too():
    coarse = f"{POINT} --cells 16 --steps 8"
    message = json.loads(answer(f"{coarse} --json", 1))
    assert message["converged"] is False and message["mu_macro_error"] > message["tolerance"]
    assert f"NOT CONVERGED: mu_macro: {message['reason']}\n" in answer(coarse, 1)
    free = json.loads(answer(f"{coarse} --json --tolerance none"))
    assert free["converged"] is True and free["tolerance"] is None
    assert "tolerance" in refusal(f"{POINT} --tolerance none")


def test_numbers_and_options_have_several_forms():
    still = "point transverse --velocity 0 --amplitude 0 --json --json"
    for words in ("--poisson ' 0.3 '", "--nu +.3"):
        assert json.loads(answer(f"{still} {words}"))["poisson"] == 0.3
    twice = "point elliptic:forward_cycles=2,phase=0 --velocity -0.5 --amplitude -1"
    line = refusal(twice)  # a negative velocity is allowed for a self-propelled motion
    assert "--amplitude = '-1'" in line


# Help and start-up


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("", [*COMMANDS, "sweep", "spin: rotation about the contact normal"]),
        ("point", [*MOTIONS, "mu F_z", "V = v0 / (omega u_lim), A = y0 / u_lim", "--json"]),
        ("predict", ["+-", "'0..2 um, 21'", "--counter-radius", "it slides forward", "--table"]),
        ("export table", ["--speed", "--map"]),
        ("sweep", ["--configfile", "--cores", "extended", "claims"]),
    ],
)
@pytest.mark.parametrize("columns", ["1", "x"])
def test_help_explains_the_terms_in_lines_of_any_width(command, words, columns, monkeypatch):
    monkeypatch.setenv("COLUMNS", columns)
    text = answer(f"{command} --help")
    assert [word for word in words if word not in " ".join(text.split())] == []
    assert max(map(len, text.splitlines())) <= 100
    assert not (command == "export table" and "--force" in text)


def test_the_version_and_the_public_names_need_no_library():
    assert answer("--version") == f"microslip {microslip.__version__}\n"
    output(
        "import sys, microslip\n"
        "assert {*microslip.__all__, '__version__'} <= {*dir(microslip)}\n"
        "sys.exit('numpy' in sys.modules)\n"
    )


HEAVY = {"xarray", "pandas", "pint", "matplotlib", "dask", "netCDF4", "tqdm", "snakemake"}
SOLVER = HEAVY | {"numba", "scipy.linalg", "pydantic"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "code", "unused"),
    [
        ("sweep --help", 0, SOLVER | {"numpy"}),
        ("predict --help", 0, SOLVER),
        (f"point bore --velocity {math.pi} --amplitude -1", 2, SOLVER),
        (f"predict transverse {CONTACT} --speed '1 mm/s' --frequency '0 Hz'", 2, SOLVER),
        ("fit transverse none.csv", 2, SOLVER),
        ("point continuous-bore --velocity 0.1", 0, HEAVY | {"numba"}),
        (POINT, 0, HEAVY | {"scipy.linalg"}),
    ],
)
def test_a_command_loads_only_what_it_needs(line, code, unused):
    modules = output(
        "import sys, microslip.app.cli as cli\n"
        "code = cli.main(sys.argv[1:])\n"
        "print()\n"
        "print(code, *sys.modules)\n",
        *shlex.split(line),
    ).splitlines()[-1]
    assert modules.split()[0] == str(code) and not unused & set(modules.split())


class Terminal(io.StringIO):
    """A stream that acts as the standard error of a terminal."""

    def isatty(self):
        return True


def test_a_terminal_shows_the_progress_in_a_line_that_goes(monkeypatch):
    for name in ("FIRST", "BETWEEN"):
        monkeypatch.setattr(progress, name, 0.02)
    texts = []
    for stream in (Terminal(), io.StringIO()):
        monkeypatch.setattr(sys, "stderr", stream)
        with progress.progress("microslip predict") as step:
            step("8 cells")
            time.sleep(0.3)
        texts.append(stream.getvalue())
    assert "microslip predict 8 cells 00:00" in texts[0] and texts[1] == ""
    assert texts[0].split("\r")[-1] == "" and texts[0].split("\r")[-2].isspace()


# Response


def test_the_response_is_printed_or_written(tmp_path):
    path = tmp_path / "path.csv"
    path.write_text("forward [um];load [N]\n0;10\n0,2;11,5\n")
    line = f"response {path} {CONTACT} --decimal , --tolerance 1e-2"
    columns = rows_of(answer(line))
    assert columns["load [N]"].tolist() == [10.0, 11.5]
    assert 0.0 < columns["force_forward [N]"][1] <= 0.3 * 11.5 + 0.03
    arguments = {"mu": 0.3, "load": 10, "radius": "5 mm", "material": "steel", "tolerance": 1e-2}
    result = microslip.predict_response(path, decimal=",", **arguments)
    assert answer(line) == f"{result}\n"
    values = json.loads(answer(f"{line} --json"))
    assert values["converged"] is True and values["stick_fraction"][0] is None
    for name in ("a.nc", "b.csv"):
        assert answer(f"{line} --output {tmp_path / name}") == ""
    written = rows_of((tmp_path / "b.csv").read_text())
    with xr.open_dataset(tmp_path / "a.nc") as dataset:
        for own in (dataset.force_forward.values, written["force_forward [N]"]):
            assert list(own) == values["force_forward"]


# Export

BODY = "--young '210 GPa' --nu 0 --mu 0.3 --radius '5 mm'"
SAME = {"young": "210 GPa", "nu": 0, "mu": 0.3, "radius": "5 mm"}
VIBRATED = f"{BODY} --frequency '20 kHz' --tolerance 0.01"


def jenkins(stiffness, limit, path):
    """Force of springs in series with sliders along a path."""
    slid, forces = np.zeros(len(stiffness)), []
    for x in path:
        force = stiffness * (x - slid)
        excess = np.maximum(np.abs(force) - limit, 0.0) * np.sign(force)
        slid += excess / stiffness
        forces.append(np.sum(force - excess))
    return np.array(forces)


def test_an_iwan_model_follows_the_response_of_the_contact(tmp_path):
    line = f"export iwan {BODY} --load '10 N' --elements 15"
    comments = answer(f"{line} --output {tmp_path / 'iwan.csv'}")
    text = (tmp_path / "iwan.csv").read_text()
    assert text.startswith(comments)
    errors = re.findall(r"^# error of the force.*: ([\d.e+-]+) N", text, re.M)
    frame = rows_of(text)
    assert list(frame.columns) == ["stiffness [N/m]", "limit_force [N]", "force_error [N]"]
    stiffness, limit, _ = frame.values.T
    plain = json.loads(answer(f"{line} --json"))
    assert plain["stiffness"] == pytest.approx(stiffness.tolist(), rel=1e-14)
    loop = 1e-6 * np.array([0, 0.1, 0.2, 0.25, 0.1, -0.1, -0.2, -0.1, 0.1, 0.25])
    wild = 1e-6 * np.array([0, 0.2, 0.05, 0.15, 0.1, 0.12, -0.3, -0.1, -0.2, 0.1])
    for path, bound in zip((loop, wild), map(float, errors), strict=True):
        real = microslip.predict_response({"forward": path}, **SAME, load="10 N", tolerance=1e-4)
        miss = np.abs(jenkins(stiffness, limit, path) - real.force_forward_N)
        assert np.all(miss <= bound + real.force_error_N)
    # Mindlin's stiffness 8 G a / (2 - nu) and full slip at mu times the load
    assert stiffness.sum() == pytest.approx(4.0 * 105e9 * real.contact_radius_m)
    assert limit.sum() == pytest.approx(3.0)


def test_a_friction_table_has_the_predictions_with_their_errors(tmp_path):
    grid = "--load '10..20 N, 2' --speed '5..20 mm/s, 3' --amplitude '0.1..0.4 um, 3'"
    comments = answer(f"export table transverse {VIBRATED} {grid} --output {tmp_path / 'a.csv'}")
    assert "unknown along load," in comments
    frame = rows_of((tmp_path / "a.csv").read_text())
    axes = ["load_N", "speed_m_s", "amplitude_m"]
    numbers = ["mu_apparent", "mu_apparent_error", "friction_force_N", "friction_force_error_N"]
    assert list(frame.columns) == axes + numbers and len(frame) == 18
    assert frame.iloc[16][axes].tolist() == pytest.approx([20.0, 0.02, 2.5e-7])
    quantities = {"load": "20 N", "speed": "20 mm/s", "amplitude": "0.25 um"}
    alone = microslip.predict("transverse", **SAME, **quantities, frequency=2e4, tolerance=0.01)
    expected = [getattr(alone, name) for name in numbers]
    assert frame.iloc[16][numbers].tolist() == pytest.approx(expected, rel=1e-9)


def test_a_table_with_a_point_outside_a_map_is_not_written(tmp_path, monkeypatch):
    certified_stub.open_without_points(monkeypatch)
    axis = "--load '10 N' --speed '10 mm/s' --amplitude '0.1..0.2 um, 2' --map certified.nc"
    file = tmp_path / "a.csv"
    line = refusal(f"export table transverse {VIBRATED} {axis} --output {file}", 1)
    assert "amplitude 0.1 um: --map = 'certified.nc': at velocity" in line
    assert "outside the map" in line and "no table" in line and not file.exists()


# Fit

MU, U_LIM, FREQUENCY = 0.3, 2e-7, 1e3
FITTED = "fit transverse measured.csv --load '10 N' --frequency '1 kHz' --map map.nc"


@pytest.fixture
def measured(tmp_path, monkeypatch):
    """A map with errors of at most 1e-3.  Returns a function that writes a table of friction."""
    monkeypatch.chdir(tmp_path)
    eq6_map(1e-3).to_netcdf("map.nc")

    def write(velocity, amplitude, force):
        speed = 2.0 * np.pi * FREQUENCY * U_LIM * velocity
        frame = {"speed [m/s]": speed, "amplitude [m]": amplitude * U_LIM, "friction [N]": force}
        pd.DataFrame(frame).to_csv("measured.csv", index=False)

    return write


@pytest.mark.slow
def test_a_table_gives_both_numbers_a_figure_and_a_dataset(measured, tmp_path):
    velocity, amplitude = np.tile(np.geomspace(0.05, 3.0, 6), 2), np.repeat([0.7, 1.8], 6)
    place = (xr.DataArray(part, dims="row") for part in (velocity, amplitude))
    dataset = eq6_map(1e-3)
    measured(velocity, amplitude, 3.0 * dataset.microslip.at(*place).mu_macro.values)
    message = json.loads(answer(f"{FITTED} --figure fit.png --output fit.nc --json"))
    assert message["reason"] == ""
    # The rows are exact values of the map, and its error estimates are bounds.
    assert message["mu"] == pytest.approx(MU, rel=1e-5)
    assert message["u_lim_m"] == pytest.approx(U_LIM, rel=1e-5)
    assert message["u_lim_low_m"] < U_LIM < message["u_lim_high_m"]
    assert (tmp_path / "fit.png").read_bytes().startswith(b"\x89PNG")
    rows = xr.load_dataset("fit.nc")
    assert float(rows.mu) == message["mu"] and rows.sizes["row"] == 12
    assert re.search(r"^u_lim +200\.0\ nm,\ from", answer(FITTED), re.M)
    assert "--nu = '0.3': allowed is 0" in refusal(f"{FITTED} --nu 0.3")
    assert "--speed = '1 mm/s': it is both" in refusal(f"{FITTED} --speed '1 mm/s'")


def test_rows_that_determine_mu_alone_are_exit_code_1(measured):
    force = 3.0 * (1.0 + 1e-3 * np.cos(3.0 * np.arange(6)))
    measured(np.geomspace(0.03, 0.3, 6), np.full(6, 0.06), force)
    text = answer(FITTED, 1)
    assert "NOT DETERMINED: the rows determine mu alone: any u_lim above" in text
    assert re.search(r"^mu +0\.3", text, re.M) and "\nu_lim" not in text
