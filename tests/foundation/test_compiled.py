"""Compiled code on disk: it matches the running sources, and its storage cannot fail a call."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from importlib.util import find_spec

with suppress(ImportError):
    import pty

import pytest
from stubs.in_process import run_apart
from stubs.new_process import PACKAGE, output, run

TWO_TYPES = """
import sys, numpy as np
from microslip.contact.operators import shrink
for kind in sys.argv[1:]:
    number = np.dtype(kind).type(4.0)
    print(shrink(number, number * 0, number / number))
"""
BOTH = ("float64", "float32")
pytestmark = pytest.mark.long


@pytest.fixture
def package(tmp_path):
    """A copy of the package for edits."""
    ignored = shutil.ignore_patterns("__pycache__")
    return shutil.copytree(PACKAGE, tmp_path / "source" / "microslip", ignore=ignored)


def call(folder, *kinds, program=TWO_TYPES, package=PACKAGE, **environment):
    """Error messages of a new process that calls a kernel for some types, with compiled code in a
    folder."""
    environment = {"NUMBA_CACHE_DIR": str(folder), "MICROSLIP_SAID_UNSTORED": ""} | environment
    process = run(program, *kinds, package=package, **environment)
    assert process.returncode == 0, process.stderr
    assert process.stdout.split() == ["0.25"] * len(kinds)
    return process.stderr


def stored(folder, ending="?"):
    """Files of compiled code, with the time of their last change."""
    return {path: path.stat().st_mtime_ns for path in folder.rglob(f"*.nb{ending}")}


@pytest.fixture(scope="module")
def with_code(tmp_path_factory):
    """A folder with compiled code of one kernel for two types."""
    folder = tmp_path_factory.mktemp("code")
    assert call(folder, *BOTH) == ""
    assert (len(stored(folder, "i")), len(stored(folder, "c"))) == (1, 2)
    return folder


# Edits


def test_the_edited_law_of_friction_is_used(package):
    """After an edit of an inlined function, the compiled code of its caller is not used."""
    (package / "contact/caller.py").write_text(
        "from microslip.foundation.compiled import kernel\n"
        "from microslip.contact.operators import shrink\n\n\n"
        "@kernel\ndef called(x):\n    return x * shrink(x, 0.0, 1.0)\n"
    )
    program = "from microslip.contact.caller import called; print(called(4.0))"
    assert float(output(program, package=package)) == pytest.approx(1.0)
    law = package / "contact" / "operators.py"
    text = law.read_text()
    law.write_text(text.replace("return min(1.0, bound /", "return min(1.0, 0.5 * bound /", 1))
    assert float(output(program, package=package)) == pytest.approx(0.5)


def test_a_copy_of_the_package_uses_the_same_code(with_code, package):
    before = stored(with_code)
    assert call(with_code, *BOTH, package=package) == ""
    assert stored(with_code) == before


# Damage


def flipped(content):
    changed = bytearray(content)
    changed[len(content) // 2] ^= 16
    return bytes(changed)


DAMAGE = {"cut": lambda content: content[: len(content) * 2 // 3], "a bit flipped": flipped}


@pytest.mark.parametrize("kind", DAMAGE)
@pytest.mark.parametrize("ending", ["nbi", "nbc", "json"], ids=["index", "code", "checksums"])
def test_damaged_code_is_compiled_again_and_overwritten(ending, kind, with_code, tmp_path):
    folder = shutil.copytree(with_code, tmp_path / "code")
    damaged = {path: DAMAGE[kind](path.read_bytes()) for path in folder.rglob(f"*.{ending}")}
    for path, content in damaged.items():
        path.write_bytes(content)
    assert call(folder, *BOTH) == ""
    assert [path for path, content in damaged.items() if path.read_bytes() == content] == []
    written = stored(folder)
    assert call(folder, *BOTH) == ""
    assert stored(folder) == written


# Folders that cannot be used.  A file with the name of the folder makes writing fail for root, too.

FULL = """
import resource, signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
"""
FULL_LATER = f"from microslip.foundation import compiled\n{FULL}"


@pytest.mark.skipif(find_spec("resource") is None, reason="needs limits of file sizes")
@pytest.mark.parametrize("full", [FULL, FULL_LATER], ids=["at the start", "later"])
def test_without_room_nothing_is_stored_and_one_line_names_the_folder(full, tmp_path):
    """Files are limited to 1000 bytes, which Python reports like a full disk, as OSError."""
    (line,) = call(tmp_path, *BOTH, program="\n".join([full, TWO_TYPES])).splitlines()
    assert str(tmp_path) in line and "NUMBA_CACHE_DIR" in line
    assert not stored(tmp_path, "c")
    assert call(tmp_path, *BOTH) == "" and len(stored(tmp_path, "c")) == 2


def test_the_next_folder_is_used_if_one_is_not_usable(package, tmp_path):
    """NUMBA_CACHE_DIR, the package, the user's cache folder; then code is not stored."""
    block = tmp_path / "block"
    block.write_text("in the way")
    caches = {"XDG_CACHE_HOME": str(tmp_path / "caches"), "PYTHONDONTWRITEBYTECODE": "1"}
    (line,) = call(block, "float64", package=package, **caches).splitlines()
    assert str(block) in line and str(package / "__pycache__") in line
    assert stored(package)
    shutil.rmtree(package / "__pycache__")
    (package / "__pycache__").write_text("in the way")
    assert call("", "float64", package=package, **caches) == ""
    assert stored(tmp_path / "caches")
    caches["XDG_CACHE_HOME"] = str(block)
    (line,) = call("", "float64", package=package, **caches).splitlines()
    assert str(package / "__pycache__") in line and str(block) in line


# Processes, terminals and settings


def test_processes_that_compile_at_the_same_time_do_not_disturb_each_other(tmp_path):
    with ThreadPoolExecutor(4) as pool:
        assert [*pool.map(lambda kind: call(tmp_path, kind), BOTH * 2)] == [""] * 4
    written = stored(tmp_path)
    assert call(tmp_path, *BOTH) == "" and stored(tmp_path) == written


def shown(folder, *kinds):
    """Text in a terminal while a kernel is called for some types."""
    terminal, end = pty.openpty()
    environment = os.environ | {"PYTHONPATH": str(PACKAGE.parent), "NUMBA_CACHE_DIR": str(folder)}
    command = [sys.executable, "-c", TWO_TYPES, *kinds]
    subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, stderr=end, check=True)
    os.write(end, b"(end)")
    os.close(end)
    return os.read(terminal, 10_000).decode().removesuffix("(end)").splitlines()


@pytest.mark.skipif(find_spec("termios") is None, reason="needs a terminal of Unix")
def test_a_terminal_shows_that_the_solver_is_compiled(tmp_path):
    for kinds in (BOTH[:1], BOTH):
        (line,) = shown(tmp_path, *kinds)
        assert "compiling the solver, once" in line
    assert shown(tmp_path, *BOTH) == []


@pytest.mark.parametrize("command", ["point transverse --velocity 1 --amplitude 1", "sweep -n"])
def test_without_a_compiler_one_line_refuses(command, tmp_path):
    process = run_apart(*command.split(), folder=tmp_path, NUMBA_DISABLE_JIT="1")
    assert (process.returncode, process.stdout) == (2, "")
    (line,) = process.stderr.splitlines()
    assert ": NUMBA_DISABLE_JIT = 1: " in line


BESIDE_LINEAR_ALGEBRA = """
import sys
from microslip.contact.operators import shrink
print(shrink(4.0, 0.0, 1.0), "scipy.linalg" in sys.modules)
import numba, numpy as np, scipy.linalg
print(numba.njit(lambda a: np.linalg.det(a @ a))(np.diag([2.0, 3.0])))
print(scipy.linalg.inv(np.diag([2.0, 4.0]))[1, 1], scipy.linalg.cython_blas.__name__)
"""


def test_kernels_do_not_import_linear_algebra():
    message = output(BESIDE_LINEAR_ALGEBRA).split()
    assert message == ["0.25", "False", "36.0", "0.25", "scipy.linalg.cython_blas"]


ANSWERS = """
import sys, microslip
ASKED = [("transverse", 0.1, 1.0, {"stiffness": 0.1}), ("bore", 0.1, 1.0, {})]
ASKED += [("transverse", 0.1, 0.8, {"model": "cartesian", "tolerance": 1e-2})]
order = int(sys.argv[1])
found = [microslip.solve(*q[:3], **q[3], most_work=1e8) for q in ASKED[::order]][::order]
print([(one.mu_macro.hex(), one.effort.iterations) for one in found])
"""


def test_equal_inputs_give_equal_bits_whatever_was_compiled_before(tmp_path):
    """Kernels are compiled on demand, then read from disk, then compiled in another order."""
    places = ("one", 1), ("one", 1), ("other", -1)
    answers = {output(ANSWERS, o, NUMBA_CACHE_DIR=str(tmp_path / place)) for place, o in places}
    assert len(answers) == 1
