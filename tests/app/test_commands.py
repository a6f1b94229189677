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
from stubs.in_process import answer, options
from stubs.new_process import output

import microslip
from microslip.answer.answer import OWN_EQUATIONS
from microslip.app import progress
from microslip.app.commands import COMMANDS
from microslip.scene.by_name import MOTIONS

POINT = "point transverse --velocity 0.1 --amplitude 1"
CONTACT = {"mu": 0.3, "load": "10 N", "radius": "5 mm", "material": "steel"}
BODY = {"young": "210 GPa", "nu": 0, "mu": 0.3, "radius": "5 mm"}
SHAKEN = CONTACT | {"amplitude": "0.1 um", "frequency": "20 kHz", "tolerance": 0.01}


def rows_of(text):
    """Columns of CSV text with comments, by heading."""
    return pd.read_csv(io.StringIO(text), comment="#")


@pytest.mark.parametrize(
    ("command", "settings"),
    [
        ("point transverse", {"velocity": 0.5, "amplitude": 0.5}),
        ("point bore", {"velocity": 0.5, "amplitude": 1.0, "poisson": 0.3, "tolerance": 5e-3}),
        ("point continuous-bore", {"velocity": 0.5}),
        ("point transverse", {"velocity": 0, "amplitude": 0.5}),
        ("point bore", {"velocity": 2, "amplitude": 1, "cells": 6, "steps": 8, "tolerance": 0.1}),
        ("predict transverse", SHAKEN | {"speed": "1 mm/s"}),
    ],
)
def test_the_text_and_the_json_are_those_of_the_python_function(command, settings):
    name, motion = command.split()
    result = {"point": microslip.solve, "predict": microslip.predict}[name](motion, **settings)
    line = f"{command} {options(**settings)}"
    assert answer(line) == f"{result}\n"
    text = answer(f"{line} --json")
    fields, expected = json.loads(text), {"amplitude": None} | result.to_dict()
    for one in (fields, expected):  # equal to the last bit, except the time
        one.pop("solve_time_s", None)
    assert (fields, text.count("\n")) == (expected, 1)


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
    assert answer(f"{POINT} --tolerance none", 2, ["tolerance"]) == ""


def test_numbers_and_options_have_several_forms():
    still = "point transverse --velocity 0 --amplitude 0 --json --json"
    for words in ("--poisson ' 0.3 '", "--nu +.3"):
        assert json.loads(answer(f"{still} {words}"))["poisson"] == 0.3
    twice = "point elliptic:forward_cycles=2,phase=0 --velocity -0.5 --amplitude -1"
    # a negative velocity is allowed for a self-propelled motion
    answer(twice, 2, ["--amplitude = '-1'"])


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
BAD = options(**SHAKEN | {"speed": "1 mm/s", "frequency": "0 Hz"})


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "code", "unused"),
    [
        ("sweep --help", 0, SOLVER | {"numpy"}),
        ("predict --help", 0, SOLVER),
        (f"point bore --velocity {math.pi} --amplitude -1", 2, SOLVER),
        (f"predict transverse {BAD}", 2, SOLVER),
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


@pytest.mark.parametrize("is_terminal", [True, False])
def test_a_terminal_shows_the_progress_in_a_line_that_goes(is_terminal, monkeypatch):
    for name in ("FIRST", "BETWEEN"):
        monkeypatch.setattr(progress, name, 0.02)
    stream = io.StringIO()
    stream.isatty = lambda: is_terminal
    monkeypatch.setattr(sys, "stderr", stream)
    with progress.progress("microslip predict") as step:
        step("8 cells")
        time.sleep(0.3)
    *shown, blank, rest = ["", *stream.getvalue().split("\r")]
    assert ("microslip predict 8 cells 00:00" in "\r".join(shown)) == is_terminal
    assert blank.strip() == rest == ""


# Response and export


def test_the_response_is_printed_or_written(tmp_path):
    path = tmp_path / "path.csv"
    path.write_text("forward [um];load [N]\n0;10\n0,2;11,5\n")
    line = f"response {path} {options(**CONTACT)} --decimal , --tolerance 1e-2"
    result = microslip.predict_response(path, decimal=",", **CONTACT, tolerance=1e-2)
    assert answer(line) == f"{result}\n"
    values = json.loads(answer(f"{line} --json"))
    assert values["converged"] is True and values["stick_fraction"][0] is None
    assert 0.0 < values["force_forward"][1] <= 0.3 * 11.5 + 0.03
    for name in ("a.nc", "b.csv"):
        assert answer(f"{line} --output {tmp_path / name}") == ""
    written = rows_of((tmp_path / "b.csv").read_text())
    assert written["load [N]"].tolist() == [10.0, 11.5]
    with xr.open_dataset(tmp_path / "a.nc") as dataset:
        for own in (dataset.force_forward.values, written["force_forward [N]"]):
            assert list(own) == values["force_forward"]


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
    line = f"export iwan {options(**BODY)} --load '10 N' --elements 15"
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
        real = microslip.predict_response({"forward": path}, **BODY, load="10 N", tolerance=1e-4)
        miss = np.abs(jenkins(stiffness, limit, path) - real.force_forward_N)
        assert np.all(miss <= bound + real.force_error_N)
    # Mindlin's stiffness 8 G a / (2 - nu) and full slip at mu times the load
    assert stiffness.sum() == pytest.approx(4.0 * 105e9 * real.contact_radius_m)
    assert limit.sum() == pytest.approx(3.0)


VIBRATED = BODY | {"frequency": "20 kHz", "tolerance": 0.01}


def test_a_friction_table_has_the_predictions_with_their_errors(tmp_path):
    grid = {"load": "10..20 N, 2", "speed": "5..20 mm/s, 3", "amplitude": "0.1..0.4 um, 3"}
    words, path = options(**VIBRATED, **grid), tmp_path / "a.csv"
    comments = answer(f"export table transverse {words} --output {path}")
    assert "unknown along load," in comments
    frame = rows_of(path.read_text())
    numbers = ["mu_apparent", "mu_apparent_error", "friction_force_N", "friction_force_error_N"]
    expected = microslip.predict_grid("transverse", **VIBRATED, **grid)[numbers].to_dataframe()
    pd.testing.assert_frame_equal(frame, expected.reset_index(), rtol=1e-9)


def test_a_table_with_a_point_outside_a_map_is_not_written(tmp_path, monkeypatch):
    certified_stub.open_without_points(monkeypatch)
    axis = {"load": "10 N", "speed": "10 mm/s", "amplitude": "0.1..0.2 um, 2"}
    words, file = options(**VIBRATED, **axis, map="certified.nc"), tmp_path / "a.csv"
    part = r"amplitude 0.1 um: --map = 'certified.nc': at velocity"
    assert answer(f"export table transverse {words} --output {file}", 1, [part]) == ""
    assert not file.exists()
