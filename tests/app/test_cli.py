"""The command line: output and exit codes, mostly without a process of its own."""

import json

import pytest
from stubs.in_process import run
from stubs.new_process import output
from stubs.point_contract import CONTRACT

import microslip
from microslip.app import cli
from microslip.motions.by_name import MOTIONS

TRANSVERSE = ("point", "transverse", "--velocity", "0.5", "--amplitude", "0.5")
SPIN = "spin: rotation about the contact normal"


@pytest.mark.parametrize(
    ("motion", "arguments"),
    [
        ("transverse", {"velocity": 0.5, "amplitude": 0.5}),
        ("bore", {"velocity": 0.5, "amplitude": 1.0, "poisson": 0.3, "tolerance": 5e-3}),
        ("continuous-bore", {"velocity": 0.5}),
        ("transverse", {"velocity": 0, "amplitude": 0.5}),
        (
            "transverse",
            {"velocity": 0.5, "amplitude": 0.5, "model": "slider", "steps": 32, "tolerance": 0.1},
        ),
        ("bore", {"velocity": 2, "amplitude": 1, "cells": 6, "steps": 8, "tolerance": 0.1}),
    ],
)
def test_json_is_the_answer_of_solve_and_nothing_else(motion, arguments):
    options = [word for name, value in arguments.items() for word in (f"--{name}", value)]
    process = run("point", motion, *options, "--json")
    assert (process.returncode, process.stderr) == (0, "")
    assert process.stdout.count("\n") == 1
    fields = json.loads(process.stdout)
    assert fields.keys() >= CONTRACT | {"amplitude"}
    steady = motion == "continuous-bore"
    assert (fields["amplitude"] is None) == ("mu_torque" in fields) == steady
    assert fields["converged"] is True
    velocity, amplitude = arguments.pop("velocity"), arguments.pop("amplitude", None)
    expected = microslip.solve(motion, velocity, amplitude, **arguments).to_dict()
    expected = {"amplitude": None} | expected
    for answer in (fields, expected):  # equal to the last bit, except the time
        answer.pop("solve_time_s")
    assert fields == expected


def test_text_says_what_was_found():
    process = run("point", "continuous-bore", "--velocity", "0.5", "--tolerance", "1e-2")
    assert (process.returncode, process.stderr) == (0, "")
    result = microslip.solve("continuous-bore", 0.5, tolerance=1e-2)
    assert f"mu_macro = {result.mu_macro:.6g}\n" in process.stdout
    assert f"mu_torque = {result.mu_torque:.6g}\n" in process.stdout
    assert process.stdout.count("ratio") == process.stdout.count("mu times mu_macro") == 1
    assert "closed-form" in process.stdout and "NOT CONVERGED" not in process.stdout


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("", ["point", "sweep", "predict", SPIN]),
        ("point", [*MOTIONS, "mu F_z", "mu_apparent", SPIN]),
        ("sweep", ["--configfile", "--cores"]),
        ("point transverse", ["--velocity", "v0 / (omega u_lim)", "--amplitude", "y0 / u_lim"]),
        ("point continuous-bore", ["v0 / (omega a)", "--cells", "--json", SPIN]),
    ],
)
def test_help_explains_the_terms(command, words):
    process = run(*command.split(), "--help")
    assert (process.returncode, process.stderr) == (0, "")
    text = " ".join(process.stdout.split())
    assert [word for word in words if word not in text] == []
    assert max(map(len, process.stdout.splitlines())) <= 100
    if command == "point continuous-bore":
        assert "--amplitude" not in text


def test_version_is_that_of_the_package():
    process = run("--version")
    assert (process.returncode, process.stdout) == (0, f"microslip {microslip.__version__}\n")


@pytest.mark.slow
def test_help_does_not_load_the_solver():
    output(
        "import sys, microslip.app.cli as cli\n"
        "try: cli.main(['point', 'bore', '--help'])\n"
        "except SystemExit: pass\n"
        "sys.exit('numba' in sys.modules)\n"
    )


HEAVY = {"xarray", "pandas", "pint", "matplotlib", "dask", "jsonschema", "netCDF4", "tqdm"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "model", "others"),
    [
        ("transverse --velocity 0.1 --amplitude 1", "radial", {"scipy.linalg"}),
        ("continuous-bore --velocity 0.1", "closed-form", {"numba"}),
    ],
)
def test_a_point_loads_only_what_answers_it(words, model, others):
    """A point does not import slow libraries that it does not need."""
    lines = output(
        "import json, sys, microslip.app.cli as cli\n"
        "cli.main(['point', *sys.argv[1:], '--json'])\n"
        "print(json.dumps(list(sys.modules)))\n",
        *words.split(),
    ).splitlines()
    answer, modules = map(json.loads, lines)
    assert answer["model"] == model
    assert not (HEAVY | others) & set(modules)


def test_a_negative_velocity_is_allowed_for_a_self_propelled_motion(capsys):
    words = ["elliptic:forward_cycles=2,phase=0", "--velocity", "-0.5", "--amplitude", "-1"]
    assert cli.main(["point", *words]) == 2
    line = capsys.readouterr().err
    assert "--amplitude = '-1'" in line and "twice" not in line


def test_a_flag_may_be_repeated(capsys):
    """A repeated flag is allowed."""
    words = ["continuous-bore", "--velocity", "2", "--json", "--json"]
    assert cli.main(["point", *words]) == 0
    assert json.loads(capsys.readouterr().out)["velocity"] == 2.0


@pytest.mark.parametrize("words", [["--poisson", " 0.3 "], ["--nu", "+.3"]])
def test_poissons_ratio_has_two_names(words, capsys):
    still = ["point", "transverse", "--velocity", "0", "--amplitude", "0", "--json"]
    assert cli.main([*still, *words]) == 0
    assert json.loads(capsys.readouterr().out)["poisson"] == 0.3


def test_public_names_are_listed_before_they_are_used():
    """Each public name is an attribute after its first use, so a new process is needed."""
    output(
        "import sys, microslip\n"
        "assert {*microslip.__all__, '__version__'} <= {*dir(microslip)}\n"
        "sys.exit('numpy' in sys.modules)\n"
    )


def test_exit_0_means_within_the_tolerance_at_an_imposed_resolution_too(capsys):
    place = ["point", "transverse", "--velocity", "0.1", "--amplitude", "1"]
    coarse = [*place, "--cells", "16", "--steps", "8"]
    assert cli.main([*coarse, "--json"]) == 1
    message = json.loads(capsys.readouterr().out)
    assert message["converged"] is False and message["mu_macro_error"] > message["tolerance"]
    assert message["reason"].startswith("at the imposed resolution the error is ")
    assert cli.main(coarse) == 1
    assert f"NOT CONVERGED: mu_macro: {message['reason']}\n" in capsys.readouterr().out
    assert cli.main([*coarse, "--json", "--tolerance", "none"]) == 0
    free = json.loads(capsys.readouterr().out)
    assert free["converged"] is True and free["tolerance"] is None
    assert free["mu_macro_error"] == message["mu_macro_error"]
    assert cli.main([*place, "--tolerance", "none"]) == 2
    assert "tolerance" in capsys.readouterr().err


def test_a_time_limit_ends_a_point_as_not_converged(capsys):
    slow = ["point", "transverse", "--velocity", "1e-9", "--amplitude", "0.5", "--json"]
    assert cli.main([*slow, "--tolerance", "1e-6", "--time-limit", "1e-9"]) == 1
    message = json.loads(capsys.readouterr().out)
    assert message["exhausted"] == "time" and "time limit" in message["reason"]
