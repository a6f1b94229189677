"""Compiled code on disk: it matches the running sources, wherever its folder is."""

import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

with suppress(ImportError):
    import pty

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
        "from microslip.contact.coulomb import shrink\n\n\n"
        "@kernel\ndef called(x):\n    return x * shrink(x, 0.0, 1.0)\n"
    )
    program = "from microslip.caller import called; print(called(4.0))"
    assert float(output(program, package=copy)) == pytest.approx(1.0)
    law = copy / "contact" / "coulomb.py"
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
        f"{FOLDER}; from microslip.contact.coulomb import shrink; print(shrink(4.0, 0.0, 1.0))"
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


# Storage of compiled code

TWO_TYPES = """
import sys, numpy as np
from microslip.contact.coulomb import shrink
for kind in sys.argv[1:]:
    number = np.dtype(kind).type(4.0)
    print(shrink(number, number * 0, number / number))
"""
BOTH = ("float64", "float32")


def said(folder, *kinds, program=TWO_TYPES, **environment):
    """Error messages of a new process that calls a kernel for some types, with compiled code in a
    folder."""
    environment |= {"NUMBA_CACHE_DIR": str(folder), "MICROSLIP_SAID_UNSTORED": ""}
    process = run(program, *kinds, **environment)
    assert process.returncode == 0, process.stderr
    assert process.stdout.split() == ["0.25"] * len(kinds)
    return process.stderr


def stored(folder, ending="*"):
    """Files of compiled code."""
    return sorted(path for path in folder.rglob(f"*.nb{ending}"))


@pytest.fixture(scope="module")
def with_code(tmp_path_factory):
    """A folder with compiled code of one kernel for two types."""
    folder = tmp_path_factory.mktemp("code")
    assert said(folder, *BOTH) == ""
    assert (len(stored(folder, "i")), len(stored(folder, "c"))) == (1, 2)
    return folder


def flipped(whole):
    changed = bytearray(whole)
    changed[len(whole) // 2] ^= 16
    return bytes(changed)


DAMAGE = {
    "emptied": lambda whole: b"",
    "cut": lambda whole: whole[: len(whole) * 2 // 3],
    "a bit flipped": flipped,
    "overwritten": lambda whole: b"no pickle" * 1000,
}


@pytest.mark.long
@pytest.mark.parametrize("kind", DAMAGE)
@pytest.mark.parametrize("ending", ["i", "c"], ids=["index", "code"])
def test_damaged_code_is_compiled_again_and_overwritten(ending, kind, with_code, tmp_path):
    folder = shutil.copytree(with_code, tmp_path / "code")
    damaged = {}
    for path in stored(folder, ending):
        damaged[path] = DAMAGE[kind](path.read_bytes())
        path.write_bytes(damaged[path])
    assert said(folder, *BOTH) == ""
    assert [path for path, content in damaged.items() if path.read_bytes() == content] == []
    written = {path: path.stat().st_mtime_ns for path in stored(folder)}
    assert said(folder, *BOTH) == ""
    assert {path: path.stat().st_mtime_ns for path in stored(folder)} == written


@pytest.mark.long
def test_code_of_another_signature_is_not_used(with_code, tmp_path):
    """Two processes that compile one kernel at the same time can exchange their files."""
    folder = shutil.copytree(with_code, tmp_path / "code")
    one, other = stored(folder, "c")
    first, second = one.read_bytes(), other.read_bytes()
    one.write_bytes(second)
    other.write_bytes(first)
    assert said(folder, *BOTH) == ""


FULL = """
import resource, signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
"""


@pytest.mark.long
@pytest.mark.skipif(find_spec("resource") is None, reason="needs limits of file sizes")
def test_without_room_for_code_one_line_names_its_folder(tmp_path):
    """Files are limited to 1000 bytes, which Python reports like a full disk, as OSError."""
    (line,) = said(tmp_path, "float64", program=FULL + TWO_TYPES).splitlines()
    assert str(tmp_path) in line and "NUMBA_CACHE_DIR" in line
    assert stored(tmp_path, "c") == []
    assert said(tmp_path, "float64") == ""  # with room again
    assert len(stored(tmp_path, "c")) == 1


@pytest.mark.long
def test_processes_that_compile_at_the_same_time_do_not_disturb_each_other(tmp_path):
    with ThreadPoolExecutor(4) as pool:
        assert [*pool.map(lambda kind: said(tmp_path, kind), BOTH * 2)] == [""] * 4
    assert said(tmp_path, *BOTH) == ""


@pytest.mark.long
def test_code_that_numba_does_not_optimise_gives_the_same_numbers(tmp_path):
    said(tmp_path, "float64", NUMBA_OPT="0")


def shown(folder, *kinds):
    """What a terminal shows while a kernel is called for some types."""
    terminal, end = pty.openpty()
    environment = os.environ | {"PYTHONPATH": str(PACKAGE.parent), "NUMBA_CACHE_DIR": str(folder)}
    command = [sys.executable, "-c", TWO_TYPES, *kinds]
    subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, stderr=end, check=True)
    os.write(end, b"(end)")
    os.close(end)
    return os.read(terminal, 10_000).decode().removesuffix("(end)").splitlines()


@pytest.mark.long
@pytest.mark.skipif(find_spec("termios") is None, reason="needs a terminal of Unix")
def test_a_terminal_says_that_the_solver_is_compiled_for_each_new_kind(tmp_path):
    for kinds in (BOTH[:1], BOTH):
        (line,) = shown(tmp_path, *kinds)
        assert "compiling the solver, once" in line
    assert shown(tmp_path, *BOTH) == []


@pytest.mark.slow
@pytest.mark.parametrize("command", ["point transverse --velocity 1 --amplitude 1", "sweep -n"])
def test_without_a_compiler_one_line_refuses(command, tmp_path):
    process = subprocess.run(
        [sys.executable, "-m", "microslip", *command.split()],
        cwd=tmp_path,
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
    )
    assert (process.returncode, process.stdout) == (2, "")
    (line,) = process.stderr.splitlines()
    assert ": NUMBA_DISABLE_JIT = 1: " in line


BESIDE_LINEAR_ALGEBRA = """
import sys
from microslip.contact.coulomb import shrink
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
