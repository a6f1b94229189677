"""Keys: what changes them and what does not."""

import ast
import math
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import microslip
from microslip import keys

PACKAGE = Path(microslip.__file__).parent
REQUEST = {"kind": "point", "scene": "bore", "velocity": "0.1", "amplitude": "1", "cells": None}
MODULE = '''
"""Docstring."""
import numpy as np

LIMIT = 3  # a comment


def double(x, *, factor=2.0):
    """Docstring."""
    return factor * x


class Thing:
    """Docstring."""

    name: str = "thing"
'''


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1, "1"),
        (1.0, "1"),
        (0.1, "0.1"),
        (0.1 + 0.2, "0.3"),
        (0, "0"),
        (-0.0, "0"),
        (-2.5, "-2.5"),
        (1e-8, "1e-8"),
        (1.5e-8, "1.5e-8"),
        (1e22, "1e22"),
        (2.15443, "2.15443"),
        (1000000, "1000000"),
    ],
)
def test_numbers_have_one_canonical_text(value, text):
    assert keys.number(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_canonical_numbers_keep_twelve_digits_and_stay_what_they_are(value):
    text = keys.number(value)
    assert math.isclose(float(text), value, rel_tol=1e-11)
    assert keys.number(float(text)) == text


@pytest.mark.parametrize("value", [math.nan, math.inf, True, "1"])
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(ValueError, match="not a finite number"):
        keys.number(value)


@pytest.mark.parametrize(
    ("name", "value"),
    [("scene", "transverse"), ("velocity", "0.11"), ("amplitude", "0"), ("cells", 8), ("new", 1)],
)
def test_everything_in_a_request_counts(name, value):
    assert keys.result_key({**REQUEST, name: value}, "d") != keys.result_key(REQUEST, "d")


def test_swapped_values_the_solver_and_the_format_count(monkeypatch):
    key = keys.result_key(REQUEST, "d")
    swapped = {**REQUEST, "velocity": "1", "amplitude": "0.1"}
    assert keys.result_key(swapped, "d") != key
    assert keys.result_key(REQUEST, "e") != key
    assert keys.result_key(dict(reversed(REQUEST.items())), "d") == key
    monkeypatch.setattr(keys, "RECORD_FORMAT", 99)
    assert keys.result_key(REQUEST, "d") != key


def test_batches_are_named_by_their_keys_in_order():
    names = {keys.batch_name(k) for k in (["a", "b"], ["b", "a"], ["a"], ["ab"], ["a", "b", "c"])}
    assert len(names) == 5
    assert keys.batch_name(["a", "b"]) == keys.batch_name(["a", "b"])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("  # a comment", ""),
        ('"""Docstring."""', '"""Another one."""'),
        ('    """Docstring."""\n    return', "    return"),
        ("\n\n\n", "\n"),
        ("factor * x", "(factor*x)"),
    ],
)
def test_layout_comments_and_docstrings_do_not_change_the_digest(old, new):
    assert old in MODULE
    assert keys.digest_of_source(MODULE.replace(old, new)) == keys.digest_of_source(MODULE)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("LIMIT = 3", "LIMIT = 4"),
        ("LIMIT = 3", "LIMIT = 3.0"),
        ("factor=2.0", "factor=2.5"),
        ("factor * x", "x * factor"),
        ("factor * x", "factor + x"),
        ("double", "triple"),
        ('"thing"', "'thong'"),
        ("name: str", "name: int"),
        ("import numpy as np", "import scipy as np"),
    ],
)
def test_code_changes_the_digest(old, new):
    assert old in MODULE
    assert keys.digest_of_source(MODULE.replace(old, new)) != keys.digest_of_source(MODULE)


def test_a_new_or_renamed_solver_file_changes_the_digest(tmp_path):
    def digest():
        return keys.digest_of_files(keys.solver_files(tmp_path))

    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "rigid.py").write_text("A = 1\n")
    (tmp_path / "hertz.py").write_text("B = 1\n")
    first = digest()
    (tmp_path / "plot").mkdir()
    for name in ("cli.py", "config.py", "plot/maps.py", "dataset.py", "__init__.py"):
        (tmp_path / name).write_text("C = 1\n")
    assert digest() == first
    (tmp_path / "models" / "rigid.py").rename(tmp_path / "models" / "stiff.py")
    renamed = digest()
    (tmp_path / "models" / "__init__.py").write_text("")
    assert len({first, renamed, digest()}) == 3


def test_the_solver_uses_no_module_that_its_digest_leaves_out():
    for name, path in keys.solver_files():
        for module in _imports_from_the_package(path):
            if module == "methods":
                continue  # their files are loaded by name, and counted where one is named
            assert module not in keys.NOT_SOLVER, f"{name} imports microslip.{module}"


@pytest.fixture
def package(tmp_path):
    """A made-up package with a solver, what runs trials, and methods of which two share code."""
    files = {
        "solver.py": "A = 1",
        "trial.py": "B = 1",
        "patches.py": "B = 2",
        "methods/__init__.py": "C = 1",
        "methods/_shared.py": "D = 1",
        "methods/_deeper.py": "E = 1",
        "methods/one.py": "from package.methods._shared import D",
        "methods/other_one.py": "from . import _shared",
        "methods/alone.py": "import numpy",
    }
    files["methods/_shared.py"] = "from package.methods import _deeper"
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.mark.parametrize(
    ("kind", "method", "names"),
    [
        ("point", "", []),
        ("choice", "", []),
        ("probe", "shipped", []),
        ("trial", "shipped", ["trial.py"]),
        ("scaling", "", ["trial.py"]),
        ("run", "alone", ["methods/alone.py", "trial.py"]),
        ("patches", "", ["patches.py"]),
        ("probe", "alone:step=2", ["methods/alone.py"]),
        ("trial", "alone", ["methods/alone.py", "trial.py"]),
        ("probe", "one", ["methods/_deeper.py", "methods/_shared.py", "methods/one.py"]),
        (
            "probe",
            "other-one",
            ["methods/_deeper.py", "methods/_shared.py", "methods/other_one.py"],
        ),
    ],
)
def test_a_request_depends_on_the_method_that_it_names_and_on_no_other(
    kind, method, names, package
):
    found = keys.further_files(kind, method, package=package)
    assert [name for name, _ in found] == names
    assert all(path == package / name for name, path in found)


def test_no_method_counts_for_an_ordinary_point(package):
    assert [name for name, _ in keys.solver_files(package)] == ["solver.py"]


def test_another_motion_or_pressure_makes_no_result_stale(package):
    files = {
        "motions/__init__.py": "",
        "motions/to_and_fro.py": "from package.motions import shared",
        "motions/shared.py": "F = 1",
        "motions/round.py": "G = 1",
        "pressures/__init__.py": "",
        "pressures/hertz.py": "",
        "pressures/from_file.py": "from package.pressures import measured",
        "pressures/measured.py": "",
        "pressures/power.py": "from package.pressures.record import Pressure",
        "pressures/record.py": "",
    }
    for name, text in files.items():
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text(text)

    def further(**named):
        return [name for name, _ in keys.further_files("point", package=package, **named)]

    assert further(scene="to-and-fro:x=1") == [
        "motions/shared.py",
        "motions/to_and_fro.py",
        "pressures/hertz.py",
    ]
    assert further(scene="round", pressure="power:exponent=1") == [
        "motions/round.py",
        "pressures/power.py",
        "pressures/record.py",
    ]
    of_file = further(scene="round", pressure="file:sha256=0123456789abcdef")
    assert of_file[1:] == ["pressures/from_file.py", "pressures/measured.py"]
    motions = [name for name in files if name.startswith("motions/") and "__" not in name]
    assert further()[:-1] == sorted(motions)  # who names none may mean any
    counted = [name for name, _ in keys.solver_files(package)]
    assert counted == ["motions/__init__.py", "pressures/__init__.py", "solver.py"]


def test_requests_differ_by_the_method_and_by_its_file(monkeypatch):
    shipped = {"kind": "probe", "method": "shipped"}
    probe = {"kind": "probe", "method": "euler"}
    monkeypatch.setattr(keys, "_further_digest", lambda kind, *named: "")
    assert keys.result_key(shipped, "d") != keys.result_key(probe, "d")
    before = keys.result_key(probe, "d")
    monkeypatch.setattr(keys, "_further_digest", lambda kind, *named: "of another file")
    assert keys.result_key(probe, "d") != before


def _imports_from_the_package(path):
    """First part of every module of the package that a file imports, at any depth."""
    top_level = path.parent == PACKAGE
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            parts = [alias.name.split(".") for alias in node.names]
            yield from (part[1] for part in parts if part[0] == "microslip" and part[1:])
        elif isinstance(node, ast.ImportFrom):
            module = (node.module or "").split(".")
            if module[0] == "microslip":
                module = module[1:]
            elif not node.level:
                continue
            elif node.level == 1 and not top_level:
                continue  # within a solver subpackage
            yield from module[:1] if module and module[0] else (a.name for a in node.names)


def test_the_workflow_reads_this_without_loading_anything_heavy():
    heavy = ("numpy", "scipy", "numba", "xarray", "matplotlib")
    program = (
        "import sys; from microslip import config, keys, plot, studies, sweep;"
        "keys.source_digest();"
        f"print([m for m in {heavy} if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        env={"PYTHONPATH": str(PACKAGE.parent)},
    )
    assert done.stdout.strip() == "[]"
