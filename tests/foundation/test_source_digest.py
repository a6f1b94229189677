"""Digests of sources: the files that influence a result, as they were when loaded."""

import ast
import json
import os
import re
import shutil
from pathlib import Path

import pytest
from stubs.new_process import PACKAGE, output

from microslip.foundation import source_digest
from microslip.foundation.source_digest import Sources

MODULE = '''
"""Docstring."""
import numpy as np

LIMIT = 3  # a comment
"""What it limits."""


def double(x, *, factor=2.0):
    """Docstring."""
    return factor * x


class Thing:
    """Docstring."""

    name: str = "thing"
'''


@pytest.fixture
def digest_of(tmp_path):
    """Function from the text of a module to the digest of a package of this module alone."""

    def digest_of(text):
        (tmp_path / "module.py").write_text(text)
        return Sources(tmp_path).digest(["module.py"])

    return digest_of


@pytest.mark.parametrize(
    ("old", "new", "is_code"),
    [
        ("  # a comment", "", False),
        ('"""Docstring."""', '"""Another one."""', False),
        ('    """Docstring."""\n    return', "    return", False),
        ('"""What it limits."""\n', "", False),
        ("\n\n\n", "\n", False),
        ("factor * x", "(factor*x)", False),
        ("LIMIT = 3", "LIMIT = 4", True),
        ("LIMIT = 3", "LIMIT = 3.0", True),
        ("factor * x", "x * factor", True),
        ('"thing"', '"thong"', True),
        ("name: str", "name: int", True),
        ("import numpy as np", "import scipy as np", True),
    ],
)
def test_code_and_no_layout_comment_or_docstring_changes_the_digest(old, new, is_code, digest_of):
    assert old in MODULE
    assert (digest_of(MODULE.replace(old, new)) != digest_of(MODULE)) == is_code


def test_a_message_counts_for_products_and_not_for_results(tmp_path):
    digests = set()
    for message in ("too long", "much too long"):
        for file in ("solver/run.py", "report/table.py"):
            (tmp_path / file).parent.mkdir(exist_ok=True)
            (tmp_path / file).write_text(f"def stop(x):\n    raise ValueError(f'{message}: {{x}}')")
        sources = Sources(tmp_path)
        digests |= {sources.digest(["solver/run.py"]), sources.digest(["report/table.py"])}
    assert len(digests) == 3


FILES = {
    "__init__.py": "A = 1",
    "foundation/errors.py": "",
    "foundation/source_digest.py": "",
    "sweeps/evaluate.py": "import toy.config.axes\ndef ask():\n    from toy.adaptive import point",
    "sweeps/period_codec.py": "",
    "sweeps/batch.py": "",
    "config/axes.py": "",
    "adaptive/point.py": "def solve():\n    from toy.motions.motion import Motion",
    "solver/run.py": "",
    "solver/methods/__init__.py": "",
    "solver/methods/_shared.py": "from toy.solver.methods import _deeper",
    "solver/methods/_deeper.py": "",
    "solver/methods/one.py": "from toy.solver.methods._shared import D",
    "motions/motion.py": "",
    "motions/sideways.py": "from toy.motions.turns import angle",
    "motions/turns.py": "",
    "pressures/hertz.py": "",
    "pressures/from_file.py": "",
    "motions/from_file.py": "",
    "report/figures/maps.py": "from toy.solver import run\nfrom toy.datasets import query",
    "report/page.html": "",
    "datasets/query.py": "from toy.foundation import errors",
}
SOLVER = {"sweeps/evaluate.py", "sweeps/period_codec.py"}
SOLVER |= {"adaptive/point.py", "solver/run.py", "motions/motion.py"}
NONE = {"motion": "none"}


@pytest.fixture
def package(tmp_path):
    """A small package for tests."""
    for name, text in FILES.items():
        (tmp_path / "toy" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "toy" / name).write_text(text)
    return tmp_path / "toy"


@pytest.mark.parametrize(
    ("request_", "more"),
    [
        (NONE, set()),
        ({"motion": "turns"}, {"motions/turns.py"}),
        ({"motion": "sideways:angle=3"}, {"motions/sideways.py", "motions/turns.py"}),
        (NONE | {"pressure": "hertz"}, {"pressures/hertz.py"}),
        (NONE | {"pressure": "file:sha256=0123"}, {"pressures/from_file.py"}),
        ({"motion": "file:sha256=0123"}, {"motions/from_file.py"}),
        (
            NONE | {"method": "one"},
            {f"solver/methods/{name}.py" for name in ("one", "_shared", "_deeper")},
        ),
        ({}, {f"motions/{name}.py" for name in ("motion", "sideways", "turns", "from_file")}),
    ],
)
def test_a_result_depends_on_the_physics_rooms_and_the_files_that_its_request_names(
    request_, more, package
):
    packages = {"solver/methods/__init__.py"}
    result = Sources(package).of_request(request_)
    assert result - packages == SOLVER | more


def test_a_product_depends_on_what_it_imports(package):
    """Of the physics it depends by the names of its records."""
    sources = Sources(package)
    assert sources.of_builder("report") == {"report/figures/maps.py", "report/page.html"} | {
        "datasets/query.py"
    }
    assert sources.of_builder("datasets/query.py") == {"datasets/query.py"}
    (package / "report/page.html").write_text("<p>")
    assert Sources(package).digest(sources.of_builder("report")) != sources.digest(
        sources.of_builder("report")
    )


def test_scratch_and_hidden_files_neither_count_nor_disturb(package):
    names = Sources(package).contents.keys()
    (package / ".#point.py").symlink_to("nobody@nowhere.1:2")  # lock file of an editor
    (package / ".ipynb_checkpoints").mkdir()
    (package / ".ipynb_checkpoints" / "point-checkpoint.py").write_text("not Python at all (")
    (package / "point copy.py").write_text("neither (")
    (package / "#point.py#").write_text("(")
    (package / "motions" / "turns-checkpoint.py").write_text("(")
    (package / "folder.py").mkdir()
    after = Sources(package)
    assert after.contents.keys() == names
    assert after.of_request(NONE) == Sources(package).of_request(NONE)


@pytest.mark.slow
def test_a_scratch_file_is_no_motion(tmp_path):
    """The real package, with temporary files of editors in its folders."""
    copy = tmp_path / "microslip"
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, copy, ignore=ignored)
    for folder in ("motions", "pressures", "solver/methods"):
        (copy / folder / ".#bore.py").symlink_to("nobody@nowhere.1:2")
        (copy / folder / "bore-checkpoint.py").write_text("raise SystemExit('run')\n")
        (copy / folder / "bore copy.py").write_text("raise SystemExit('run')\n")
    program = (
        "from microslip.motions import by_name; from microslip.solver import method_names\n"
        "print(*by_name.MOTIONS, *method_names.names())"
    )
    names = output(program, package=copy)
    assert "copy" not in names and "checkpoint" not in names


REQUESTS = [
    {"kind": "point", "motion": "zigzag", "poisson": "0.3", "model": "auto", "tolerance": "0.1"},
    {"kind": "point", "motion": "bore", "poisson": "0", "model": "auto", "tolerance": "0.1"},
    {"kind": "point", "motion": "transverse", "poisson": "0", "model": "auto", "tolerance": "0.1"}
    | {"pressure": "power:exponent=1"},
    {"kind": "history", "motion": "transverse", "periods": 1, "cells": 4, "steps": 16},
    {"kind": "field", "motion": "continuous-bore", "cells": 4},
    {"kind": "period", "motion": "bore", "poisson": "0", "cells": 4, "angles": 4, "steps": 8},
    {"kind": "patches", "motion": "bore", "poisson": "0", "cells": 4, "angles": 4, "steps": 8},
    {"kind": "probe", "motion": "transverse", "poisson": "0", "model": "auto", "tolerance": "0.1"}
    | {"method": "admm"},
    {"kind": "run", "motion": "transverse", "poisson": "0", "model": "radial", "tolerance": "0.01"}
    | {"method": "euler", "cells": 8, "angles": 1, "steps": 16},
]
LOADED_BY = """
import json, os, sys
import numba, scipy.linalg, scipy.special  # which take long and belong to others
from numba.core.registry import cpu_target
cpu_target.typing_context.refresh(), cpu_target.target_context.refresh()  # so does this
for request in json.loads(sys.argv[1]):
    if os.fork() == 0:  # a process for each, which has loaded nothing of the package
        from microslip.sweeps import evaluate as answers
        answers.computed(request)
        files = [m.__file__ for n, m in sys.modules.items() if n.startswith("microslip.")]
        print(json.dumps(files), flush=True)
        os._exit(0)
    if os.wait()[1]:
        sys.exit(f"no answer to {request}")
"""
NAMES = ("solver/methods/", "motions/", "pressures/")


@pytest.mark.long
def test_all_that_answering_a_request_loads_counts_for_it():
    """The modules that Python loads are compared with those of the digest."""
    requests = [{"velocity": "0.5", "amplitude": "0.5"} | request for request in REQUESTS]
    for request in requests:
        if request["kind"] == "field":
            del request["amplitude"]
    lines = output(LOADED_BY, json.dumps(requests)).splitlines()
    outer = "(foundation|config|sweeps)/"  # where requests and records are read and written
    for request, line in zip(requests, lines, strict=True):
        files = {Path(file).relative_to(PACKAGE).as_posix() for file in json.loads(line)}
        listed = {f for f in files if f.startswith(NAMES) and "__init__" not in f}
        assert "sweeps/evaluate.py" in files
        others = {f for f in files - listed if not re.match(outer, f)}
        assert others <= source_digest.LOADED.of_request(request) | {"__init__.py"}, request


# Results of parsing are kept in __pycache__


def test_a_second_process_parses_only_what_was_edited(package, monkeypatch):
    before = Sources(package).digest(SOLVER)
    (package / "solver/run.py").write_text("A = 2")
    parsed = []
    monkeypatch.setattr(
        "ast.parse", lambda content, parse=ast.parse: parsed.append(content) or parse(content)
    )
    after = Sources(package).digest(SOLVER)
    assert after != before and parsed == [b"A = 2"]
    assert Sources(package).digest(SOLVER) == after and len(parsed) == 1


@pytest.mark.parametrize("damage", [lambda b: b[:-9], lambda b: b"", lambda b: b"\xff" + b])
def test_a_damaged_file_counts_as_empty_and_is_replaced(damage, package):
    first = Sources(package).digest(SOLVER)
    (cache,) = (package / "__pycache__").glob("sources.*.json")
    whole = cache.read_bytes()
    cache.write_bytes(damage(whole))
    assert Sources(package).digest(SOLVER) == first
    assert cache.read_bytes() == whole


def test_other_code_that_reads_sources_parses_them_again(package, monkeypatch):
    first = Sources(package).digest(SOLVER)
    monkeypatch.setattr(source_digest, "_parse", lambda content, messages: ("", []))
    assert Sources(package).digest(SOLVER) == first
    monkeypatch.setattr(source_digest, "_READER", "other code")
    assert Sources(package).digest(SOLVER) != first


def test_where_nothing_can_be_written_nothing_is_kept(package):
    (package / "__pycache__").write_text("in the way")
    assert Sources(package).digest(SOLVER) == Sources(package).digest(SOLVER)


# Edits of the sources of a running process


def test_a_digest_is_of_the_sources_as_they_were_read(package):
    sources = Sources(package)
    before = sources.digest(SOLVER)
    (package / "solver/run.py").write_text("edited = True")
    assert sources.digest(SOLVER) == before == sources.digest(SOLVER)
    assert sources.edited() == "solver/run.py"
    assert Sources(package).digest(SOLVER) != before


@pytest.mark.parametrize(
    ("name", "text", "edited"),
    [
        ("solver/run.py", "# why", False),
        ("solver/run.py", "'a docstring'", False),
        ("report/figures/maps.py", "A = 2", False),
        ("solver/run.py", "def load(", True),
        ("solver/run.py", None, True),
    ],
)
def test_code_of_the_physics_rooms_alone_is_an_edit(name, text, edited, package):
    sources = Sources(package)
    (package / name).unlink()
    if text is not None:
        (package / name).write_text(text)
        os.utime(package / name, (1, 1))
    assert sources.edited() == (name if edited else None)


def test_a_file_that_is_no_python_counts_by_its_bytes_and_imports_nothing(package):
    digests = []
    for text in ("def load(", "def load(x", "\0"):
        (package / "solver/run.py").write_text(text)
        sources = Sources(package)
        assert sources.closure(["solver/run.py"], bool) == {"solver/run.py"}
        digests.append(sources.digest(["solver/run.py"]))
    assert len(set(digests)) == 3
