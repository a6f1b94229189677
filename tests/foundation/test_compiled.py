"""Compiled code on disk: it matches the running sources, wherever its folder is."""

import shutil
import tempfile
from pathlib import Path

import pytest
from stubs.new_process import PACKAGE, output, run

from microslip.foundation import kernel_cache, source_digest
from microslip.foundation.source_digest import LOADED, Sources

KERNELS = sorted(name for name, source in LOADED.contents.items() if b"import kernel" in source)
FOLDER = "from microslip.foundation import compiled; print(compiled.folder())"


def copied(folder):
    """Copy the package to a folder."""
    place = folder / "source" / "microslip"
    shutil.copytree(PACKAGE, place, ignore=shutil.ignore_patterns("__pycache__"))
    return place


@pytest.fixture
def copy(tmp_path):
    """A copy of the package for edits."""
    return copied(tmp_path)


def of_kernels(package):
    """Digest in the name of the folder of compiled code, for a package."""
    return Sources(package).kernels_digest


@pytest.fixture(scope="module")
def unedited(tmp_path_factory):
    """An unedited copy of the package, and its digest of kernels."""
    package = copied(tmp_path_factory.mktemp("unedited"))
    return package, of_kernels(package)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*KERNELS, "theory/hertz.py"])  # a kernel imports its numbers
def test_an_edit_of_the_sources_of_kernels_leaves_the_old_machine_code_alone(name, unedited):
    package, before = unedited
    file = package / name
    text = file.read_text()
    file.write_text(text + "\nEDITED = True\n")
    edited = of_kernels(package)
    file.write_text(text)
    assert edited != before


@pytest.mark.long
def test_an_edited_law_of_friction_is_the_one_that_runs(copy):
    """After an edit of an inlined function, the compiled code of its caller is not used."""
    (copy / "caller.py").write_text(
        "from microslip.foundation.compiled import kernel\n"
        "from microslip.contacts.coulomb import shrink\n\n\n"
        "@kernel\ndef called(x):\n    return x * shrink(x, 0.0, 1.0)\n"
    )
    program = "from microslip.caller import called; print(called(4.0))"
    assert float(output(program, package=copy)) == pytest.approx(1.0)
    law = copy / "contacts" / "coulomb.py"
    text = law.read_text()
    law.write_text(text.replace("return min(1.0, bound /", "return min(1.0, 0.5 * bound /", 1))
    assert law.read_text() != text
    assert float(output(program, package=copy)) == pytest.approx(0.5)
    law.write_text(text)
    assert float(output(program, package=copy)) == pytest.approx(1.0)


# A file with the name of the folder makes writing fail, even for root.


def test_the_first_usable_folder_is_that_of_the_user_the_package_the_home_or_a_temporary_one(
    tmp_path, monkeypatch, capsys
):
    chosen = kernel_cache.folder.__wrapped__  # without the cache
    monkeypatch.setattr(source_digest, "PACKAGE", tmp_path / "microslip")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "mine"))
    assert chosen().parent == tmp_path / "mine"
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    package = tmp_path / "microslip" / "__pycache__"
    assert chosen().parent == package
    shutil.rmtree(package)
    package.write_text("in the way")
    assert chosen().is_relative_to(tmp_path / "caches" / "microslip")
    assert capsys.readouterr().err == ""
    (tmp_path / "temporary").mkdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(package))
    monkeypatch.setenv("MICROSLIP_SAID_COMPILED", "")  # so that it is undone
    monkeypatch.delenv("MICROSLIP_SAID_COMPILED")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    fallback = chosen()
    assert fallback.is_relative_to(tmp_path / "temporary")
    (line,) = capsys.readouterr().err.splitlines()
    assert str(fallback) in line and "NUMBA_CACHE_DIR" in line


@pytest.mark.long
def test_where_neither_package_nor_home_can_be_written_it_runs_all_the_same_and_says_so(
    copy, tmp_path
):
    (copy / "__pycache__").write_text("in the way")
    (tmp_path / "home").write_text("in the way")
    (tmp_path / "temporary").mkdir()
    environment = {"HOME": str(tmp_path / "home"), "TMPDIR": str(tmp_path / "temporary")}
    environment |= {"XDG_CACHE_HOME": "", "PYTHONDONTWRITEBYTECODE": "1"}
    program = (
        f"{FOLDER}; from microslip.contacts.coulomb import shrink; print(shrink(4.0, 0.0, 1.0))"
    )
    process = run(program, package=copy, **environment)
    folder, number = process.stdout.split()
    assert Path(folder).is_relative_to(tmp_path / "temporary")
    assert float(number) == 0.25
    assert list(Path(folder).rglob("*.nbi"))  # the compiled code is on disk
    (line,) = process.stderr.splitlines()
    assert folder in line and "NUMBA_CACHE_DIR" in line
    again = run(program, package=copy, **environment)
    assert again.stdout == process.stdout


BESIDE_LINEAR_ALGEBRA = """
import sys
from microslip.contacts.coulomb import shrink
assert shrink(4.0, 0.0, 1.0) == 0.25
print("scipy.linalg" in sys.modules)
import numba, numpy as np
print(numba.njit(lambda a: a @ a)(np.full((2, 2), 3.0))[0, 0])
print(numba.njit(lambda a: np.linalg.det(a))(np.diag([2.0, 3.0])))
import scipy.linalg.cython_blas
print(scipy.linalg.cython_blas.__name__, scipy.linalg.inv(np.diag([2.0, 4.0]))[1, 1])
"""


@pytest.mark.long
def test_kernels_load_no_linear_algebra_and_leave_it_to_others():
    message = output(BESIDE_LINEAR_ALGEBRA).split()
    assert message == ["False", "18.0", "6.0", "scipy.linalg.cython_blas", "0.25"]


ANSWERS = """
import sys, microslip
QUESTIONS = [
    ("transverse", 3.0, 0.2, {"stiffness": 1e-5, "tolerance": 2e-4}),
    ("transverse", 0.1, 1.0, {"stiffness": 0.1}),
    ("transverse", 0.1, 0.7, {"poisson": 0.3}),
    ("bore", 0.1, 1.0, {}),
    ("normal:lateral=0.5", 0.2, 0.4, {}),
    ("transverse", 0.1, 0.8, {"model": "cartesian", "tolerance": 1e-2}),
]
found = [
    (question[:3], microslip.solve(*question[:3], **question[3], most_work=1e8))
    for question in QUESTIONS[:: int(sys.argv[1])]
]
for question, one in found[:: int(sys.argv[1])]:
    print(question, one.mu_macro.hex(), one.effort.iterations)
"""


@pytest.mark.long
def test_equal_inputs_give_equal_bits_whatever_was_compiled_before(tmp_path):
    """Kernels are compiled on demand, then read from disk, then compiled in another order."""

    def answers(place, order):
        return output(ANSWERS, order, NUMBA_CACHE_DIR=str(tmp_path / place))

    compiled = answers("one", 1)
    assert compiled.count("\n") == 6
    assert answers("one", 1) == compiled
    assert answers("other", -1) == compiled
