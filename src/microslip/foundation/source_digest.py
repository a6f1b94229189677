"""Digests of the modules that a result depends on, as they were when this process loaded them.

A result depends on the module that answers its request and on all modules that this one imports.
The digest of these modules is part of the name of every result, dataset and figure, so no result is
older than the code that it is named by.  Comments, docstrings, layout and the hints of functions do
not count.

All modules are read once, when the package is imported, so a digest belongs to the code that is
running.  `Sources.edited` lists modules that have changed on disk since then.

Imports only the standard library, since the package and the workflow import it first.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import importlib.util
import json
import os
import sys
from collections.abc import Iterable, Iterator
from functools import cache, cached_property
from pathlib import Path
from typing import NamedTuple

PACKAGE = Path(__file__).parents[1]

ANSWERED_BY = {
    "point": ("adaptive/point",),
    "history": ("adaptive/history",),
    "field": ("adaptive/history",),
    "period": ("adaptive/period", "sweeps/period_codec"),
    "trial": ("adaptive/single_run",),
    "choice": ("adaptive/point",),
    "probe": ("adaptive/point", "adaptive/single_run"),
    "scaling": ("adaptive/single_run",),
    "run": ("adaptive/single_run",),
    "patches": ("adaptive/stick_area",),
    "propulsion": ("adaptive/propulsion",),
}
"""Kinds of requests (see sweeps.batches) and the modules that answer them."""

ASKS = {"sweeps/__init__.py", "sweeps/evaluate.py"}
"""They import the modules that answer requests inside functions; only their other imports count."""

NAMED_IN_REQUESTS = {"solver/methods": "method", "motions": "motion", "pressures": "pressure"}
"""Folders of modules that requests name, and the key of the request."""

NAMES_ONLY = {f"foundation/{name}.py" for name in ("accessor", "kernel_cache", "source_digest")}
"""Modules on which the values of results do not depend."""

HINTS = {"annotation": ast.arg, "returns": ast.FunctionDef | ast.AsyncFunctionDef}
"""Fields of the syntax tree that hold the hints of functions, and the nodes that have them.

Hints of the fields of classes count, since dataclasses and schemas are made of them."""


class Parsed(NamedTuple):
    """Digest of a module's syntax tree, and names of what it imports: at the top, and anywhere."""

    digest: str
    top: list[str]
    anywhere: list[str]


class Sources:
    """The modules of a package, read when this object is made.

    Attributes
    ----------
    package : Path
        Folder of the package.
    contents : dict of str to bytes
        Sources by their paths inside the package.  Files that Python cannot import are left out:
        hidden files, those of editors, copies with other names.
    """

    def __init__(self, package: str | Path = PACKAGE):
        self.package = Path(package)
        self.contents = {name: _read(path) for name, path in _modules(self.package)}

    def closure(self, names: Iterable[str], deep: bool = True) -> set[str]:
        """Paths of modules and of all modules that they import, directly or not.

        names: paths inside the package.  deep: whether imports inside functions of these modules
        count; those of the modules that they import always do.
        """
        closure = set(names) - NAMES_ONLY
        waiting = [target for name in names for target in self._targets(name, deep)]
        while waiting:
            name = waiting.pop()
            if name not in closure:
                closure.add(name)
                waiting += self._targets(name, True)
        self._keep_parsed()
        return closure

    def digest(self, names: Iterable[str]) -> str:
        """SHA-256 of the names and syntax trees of modules, in hexadecimal.

        names: paths inside the package, or in one of the folders that requests name.
        """
        content = [(name, self._parsed(name).digest) for name in sorted(names)]
        self._keep_parsed()
        return _sha256(json.dumps(content).encode())

    def raw_digest(self, names: Iterable[str]) -> str:
        """SHA-256 of the names and bytes of modules, in hexadecimal."""
        content = [(name, _sha256(self._content(name))) for name in sorted(names)]
        return _sha256(json.dumps(content).encode())

    def of_request(self, kind: str, named: Iterable[tuple[str, str]]) -> set[str]:
        """Modules that a request depends on; named: (folder, name of a module in it) pairs."""
        roots = {f"{module}.py" for module in ANSWERED_BY[kind]} & self.contents.keys()
        paths = [f"{folder}/{module}.py" for folder, module in named]
        roots |= {path for path in paths if path in self.contents or _in_a_users_folder(path)}
        return self.closure(roots) | self.closure(ASKS & self.contents.keys(), deep=False)

    def edited(self, names: Iterable[str]) -> list[str]:
        """Modules whose code on disk is no longer the one that was read."""
        return [name for name in sorted(names) if self._is_edited(name)]

    def _is_edited(self, name: str) -> bool:
        try:
            now = _read(self.package / name)
        except OSError:
            return name in self.contents
        then = self.contents.get(name, now)
        return now != then and _parse(now).digest != _parse(then).digest

    def _content(self, name: str) -> bytes:
        if name not in self.contents:
            path = _in_a_users_folder(name)
            self.contents[name] = path.read_bytes() if path else b""
        return self.contents[name]

    def _targets(self, name: str, deep: bool) -> Iterator[str]:
        """Paths of the modules that one imports, and of the packages that contain them."""
        place = [self.package.name, *name.split("/")[:-1]]
        parsed = self._parsed(name)
        for module in parsed.anywhere if deep else parsed.top:
            with contextlib.suppress(ImportError):  # relative, and above the package
                top, *parts = importlib.util.resolve_name(module, ".".join(place)).split(".")
                paths = ["/".join(parts[:end]) for end in range(1, len(parts) + 1)]
                files = [file for path in paths for file in (f"{path}.py", f"{path}/__init__.py")]
                if top == self.package.name:
                    yield from (f for f in files if f in self.contents and f not in NAMES_ONLY)

    # Parsing takes a second, so what it gives is kept beside the code that Python itself compiles.

    def _parsed(self, name: str) -> Parsed:
        content = self._content(name)
        key = _sha256(content)
        if key not in self._kept:
            self._kept[key] = _parse(content)
            self._is_kept = False
        return Parsed(*self._kept[key])

    @cached_property
    def _kept(self) -> dict[str, Parsed]:
        self._is_kept = True
        try:
            by, kept = json.loads(self._file.read_bytes())
        except (OSError, ValueError):
            return {}
        return kept if by == _READER else {}

    def _keep_parsed(self) -> None:
        """Write what was parsed; where that is refused, the next process parses again."""
        if "_kept" not in self.__dict__ or self._is_kept:
            return
        self._is_kept = True
        now = {_sha256(content) for content in self.contents.values()}
        kept = {key: parsed for key, parsed in self._kept.items() if key in now}
        beside = self._file.with_name(f"{self._file.name}.{os.urandom(8).hex()}")
        try:
            self._file.parent.mkdir(exist_ok=True)
            beside.write_text(json.dumps([_READER, kept], separators=(",", ":")))
            os.replace(beside, self._file)
        except OSError:
            with contextlib.suppress(OSError):
                beside.unlink()

    @property
    def _file(self) -> Path:
        return self.package / "__pycache__" / f"sources.{sys.implementation.cache_tag}.json"


def _modules(folder: str | Path, prefix: str = "") -> Iterator[tuple[str, str]]:
    """Path inside the package and path of each module in a folder and those below it."""
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        stem, _, ending = entry.name.partition(".")
        if not stem.isidentifier() or stem == "__pycache__":
            continue
        if ending == "py" and entry.is_file():
            yield prefix + entry.name, entry.path
        elif not ending and entry.is_dir():
            yield from _modules(entry.path, f"{prefix}{entry.name}/")


def _read(path: str | Path) -> bytes:
    with open(path, "rb") as file:
        return file.read()


def _in_a_users_folder(name: str) -> Path | None:
    """Path of a motion or a pressure in a folder of the user's own; None if it is not there."""
    folder, _, file = name.rpartition("/")
    package = sys.modules.get(f"{PACKAGE.name}.{folder.replace('/', '.')}")
    places = (Path(place, file) for place in getattr(package, "__path__", ()))
    return next((place for place in places if place.is_file()), None)


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


_READER = _sha256(Path(__file__).read_bytes())
"""Digest of this file, whose code reads imports and digests off the syntax trees."""


def _parse(content: bytes) -> Parsed:
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):  # a broken file counts by its bytes and imports nothing
        return Parsed(_sha256(content), [], [])
    out: list[str] = []
    _dump(tree, out)
    digest = _sha256("".join(out).encode())
    return Parsed(digest, _imported(tree.body), _imported(ast.walk(tree)))


def _imported(nodes: Iterable[ast.AST]) -> list[str]:
    """Names of the modules that these statements may import, with leading dots where relative."""
    names = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
            dot = "" if module.endswith(".") else "."
            names |= {module, *(f"{module}{dot}{alias.name}" for alias in node.names)}
    return sorted(names)


def _dump(node: object, out: list[str]) -> None:
    """Append the text of a syntax tree without what changes no result, and without line numbers.

    Empty fields are skipped, where ast.dump differs between versions of Python, so that all of them
    share a folder of results.
    """
    if isinstance(node, ast.AST):
        out.append(f"{type(node).__name__}(")
        for field, value in ast.iter_fields(node):
            if isinstance(value, list):
                value = [item for item in value if not _is_text(item)]
            if field in HINTS and isinstance(node, HINTS[field]):
                continue
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


def _is_text(node: object) -> bool:
    """Whether a statement is a docstring, also one below a constant or a field."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


# The package that is running

LOADED = Sources()


def files_of_request(request: dict) -> frozenset[str]:
    """Modules that the result of a request depends on; request: see sweeps.batches."""
    return _files_of_request(request["kind"], *_named(request))


def of_request(request: dict) -> str:
    """Digest of the modules that the result of a request depends on."""
    return _of_request(request["kind"], *_named(request))


def of_modules(*names: str) -> str:
    """Digest of modules of the running package, files or folders, and of all that they import."""
    return LOADED.digest(LOADED.closure(_files_in(names)))


@cache
def of_solver() -> str:
    """Digest of the modules that solve a point, without those of a motion or a pressure."""
    return LOADED.digest(LOADED.of_request("point", ()))


@cache
def of_kernels() -> str:
    """Digest of the modules with compiled functions and of all that they import.

    Layout counts here, since Numba finds the code of a function by its line.
    """
    compiled = {n for n, c in LOADED.contents.items() if b"microslip.foundation.compiled" in c}
    return LOADED.raw_digest(LOADED.closure(compiled))


def _named(request: dict) -> tuple[tuple[str, str], ...]:
    """(folder, name) of the modules that a request names; without a motion all motions count."""
    texts = {folder: request.get(key) or "" for folder, key in NAMED_IN_REQUESTS.items()}
    files = {folder: text.partition(":")[0].replace("-", "_") for folder, text in texts.items()}
    if files["pressures"] == "file":
        files["pressures"] = "from_file"
    motions = () if files["motions"] else sorted(_files_in(["motions"]))
    named = [(folder, file) for folder, file in files.items() if file]
    return (*named, *(("motions", Path(file).stem) for file in motions))


@cache
def _files_of_request(kind: str, *named: tuple[str, str]) -> frozenset[str]:
    return frozenset(LOADED.of_request(kind, named))


@cache
def _of_request(kind: str, *named: tuple[str, str]) -> str:
    return LOADED.digest(_files_of_request(kind, *named))


def _files_in(names: Iterable[str]) -> set[str]:
    """Modules by their paths, or all modules in folders."""
    return {
        file
        for file in LOADED.contents
        for name in names
        if file == name or file.startswith(f"{name}/")
    }
