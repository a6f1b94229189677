"""Names that follow from content: canonical numbers, the digest of the solver, result keys.

A result is stored under a hash of everything that determines it: the physics, the tolerance, the
model and resolution asked for, and the sources of the solver. So it can be neither stale nor
computed twice. The versions of NumPy, SciPy and Numba are not part of a key: they change results
by rounding errors, far below any tolerance, and an upgrade should not discard days of computing.
Each result records them instead.

Imports nothing but the standard library, since the workflow reads it whenever it is parsed.
"""

import ast
import hashlib
import json
import math
from functools import cache
from pathlib import Path

# What a result does not depend on. Every other module of the package is part of the digest, so
# that a new solver file is counted without anybody thinking of it.
NOT_SOLVER = {"__init__", "__main__", "cli", "cli_predict"}
NOT_SOLVER |= {"config", "schemas", "keys", "cache", "answers", "sweep", "stored", "jobs", "watch"}
NOT_SOLVER |= {
    "settings",
    "grids",
    "extended",
    "limits",
    "limits_of_pressures",
    "columns",
    "dataset",
    "netcdf",
    "summary",
}
NOT_SOLVER |= {"studies", "plot", "explorer", "si", "query"}
# The command that starts the workflow, and the copy of the workflow in an installed package.
NOT_SOLVER |= {"launch", "bundle"}
# These count for the requests that name them, see further_files.
NOT_SOLVER |= {"trial", "patches", "periods", "methods"}
NAMED = ("motions", "pressures")
"""Folders whose files count for the requests that name them, too; but what is in all of them."""

PACKAGE = Path(__file__).parent

# What answers requests of a kind besides the solver.
BESIDE_SOLVER = {"trial": "trial.py", "scaling": "trial.py", "run": "trial.py"}
BESIDE_SOLVER |= {"period": "periods.py", "patches": "patches.py"}

# Names of files in requests, and what stands for one that is left out.
NAMES_IN_REQUESTS = {"method": "", "scene": "", "pressure": "hertz"}

# Raise it when the content of a record changes without any change in the solver.
RECORD_FORMAT = 1


def number(value):
    """Canonical decimal string of a finite number: 1 for 1.0, 0.001, 1e-8.

    Rounded to 12 significant digits, so that 0.1 + 0.2 and 0.3 are the same coordinate.
    Raises ValueError for what is not a finite number.
    """
    if isinstance(value, bool | str) or not math.isfinite(value):
        raise ValueError(f"{value!r} is not a finite number")
    rounded = float(f"{value:.12g}")
    if rounded == 0:
        return "0"  # also for -0.0
    text = repr(rounded)
    if "e" in text:
        mantissa, _, exponent = text.partition("e")
        return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
    return text.removesuffix(".0")


def canonical_json(value):
    """JSON with sorted keys and no white space. Raises ValueError for NaN and infinities."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def sha256(text):
    """SHA-256 of a string, in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def result_key(request, digest):
    """Name of the result that answers `request` when the solver has this source digest.

    request: dict of canonical strings, integers and None, see microslip.sweep.
    """
    content = {"request": request, "source": digest, "format": RECORD_FORMAT}
    named = (request.get(key, default) for key, default in NAMES_IN_REQUESTS.items())
    content["further"] = _further_digest(request["kind"], *named)
    return sha256(canonical_json(content))


def batch_name(keys):
    """Name of a batch that holds the results with these keys, in this order."""
    return sha256("\n".join(keys))[:16]


@cache
def source_digest():
    """Digest of the solver's sources in the package that is running."""
    return digest_of_files(solver_files())


def solver_files(package=None):
    """List the solver's modules as (name, Path), sorted.

    package: folder of the package, by default the one that is running.
    """
    package = Path(package or PACKAGE)
    files = ((path.relative_to(package), path) for path in package.rglob("*.py"))
    return sorted(
        (name.as_posix(), path)
        for name, path in files
        if name.parts[0].removesuffix(".py") not in NOT_SOLVER
        and (name.parts[0] not in NAMED or name.stem == "__init__")
    )


def further_files(kind, method="", scene="", pressure="hertz", package=None):
    """List the modules that a request depends on besides the solver, as (name, Path), sorted.

    kind, method, scene, pressure: of the request, see microslip.sweep and studies.requests; names
    such as "admm:penalty=1", "" for none; without a scene all motions count. What BESIDE_SOLVER
    names counts for a kind, and the file of a method, a motion or a pressure with all that it
    imports from its folder, so that another one makes no result stale.
    """
    package = Path(package or PACKAGE)
    names = {BESIDE_SOLVER[kind]} if kind in BESIDE_SOLVER else set()
    motions = [scene] if scene else [file.stem for file in (package / "motions").glob("[!_]*.py")]
    of_file = "measured" if pressure.startswith("file:") else pressure
    for folder, named in (("methods", [method]), ("motions", motions), ("pressures", [of_file])):
        waiting = [name.partition(":")[0].replace("-", "_") for name in named]
        while waiting:
            name = f"{folder}/{waiting.pop()}.py"
            if name not in names and (package / name).is_file():
                names.add(name)
                waiting += _imported_beside(package / name)
    return sorted((name, package / name) for name in names)


@cache
def _imported_beside(path):
    """Names of the modules that a file of a subpackage may import from its own folder, a tuple."""
    return tuple(_imported(path))


def _imported(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name.rpartition(".")[2]
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").rpartition(".")[2]
            yield from (alias.name for alias in node.names)


@cache
def _further_digest(kind, *named):
    return digest_of_files(further_files(kind, *named))


@cache
def digest_of_modules(*names):
    """Digest of modules of the package that is running: files, or folders with all their modules.

    The same in every place that the package can be in.
    """
    paths = [PACKAGE / name for name in names]
    files = [file for path in paths for file in (path.rglob("*.py") if path.is_dir() else [path])]
    return digest_of_files(sorted((file.relative_to(PACKAGE).as_posix(), file) for file in files))


def digest_of_files(files):
    """Digest of modules given as (name, Path) pairs; comments and docstrings do not count."""
    return sha256(canonical_json([(name, _digest_of_file(path)) for name, path in files]))


@cache
def _digest_of_file(path):
    """That of its source; most files count for many requests."""
    return digest_of_source(path.read_text(encoding="utf-8"))


def digest_of_source(text):
    """Digest of a module's syntax tree without comments, docstrings, layout and line numbers."""
    out = []
    _dump(ast.parse(text), out)
    return sha256("".join(out))


def _dump(node, out):
    # ast.dump changes its output between Python versions. This one skips empty fields, which is
    # where they differ, so one results folder serves all of them.
    if isinstance(node, ast.AST):
        out.append(f"{type(node).__name__}(")
        for field, value in ast.iter_fields(node):
            if field == "body" and _has_docstring(node):
                value = value[1:]
            if value is not None and value != []:
                out.append(f"{field}=")
                _dump(value, out)
        out.append(")")
    elif isinstance(node, list):
        out.append("[")
        for item in node:
            _dump(item, out)
        out.append("]")
    else:
        out.append(f"{node!r},")


def _has_docstring(node):
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    if not isinstance(node, kinds) or not node.body:
        return False
    first = node.body[0]
    return (
        isinstance(first, ast.Expr)
        and isinstance(first.value, ast.Constant)
        and isinstance(first.value.value, str)
    )
