"""Which source files a result depends on, as they were when this process loaded them.

What counts for a result follows from imports: the file that answers it, all that this one imports,
and so on.  The digest of these files is part of the name of every result, dataset and figure, so
none can be older than the code that stands for it.  Comments, docstrings, layout and hints of
functions do not count.

The sources are read once, when the package is imported.  So a digest is that of the code that is
running, however the files are edited meanwhile; `edited` says whether they were.

Imports nothing but the standard library, since the package and the workflow read it first of all.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from microslip.foundation import parsed_sources

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
    "drive": ("adaptive/driving",),
}
"""Kinds of requests (see sweeps.batches) and the modules that `answers` asks for them."""

ASKS = {"sweeps/__init__.py", "sweeps/evaluate.py"}
"""They import what answers a request where that is asked; only what they always import counts."""

NAMED_IN_REQUESTS = {"solver/methods": "method", "motions": "scene", "pressures": "pressure"}
"""Folders of files that requests name, and the key that names them."""

NAMES_ONLY = {
    f"foundation/{name}.py"
    for name in ("kernel_cache", "parsed_sources", "source_digest", "syntax_digest")
}
"""They say what results are called and where code is kept, and change no number in results."""


class Sources:
    """The modules of a package, read when this object is made.

    Attributes
    ----------
    package : Path
        Folder of the package.
    contents : dict of str to bytes
        Sources by their paths inside the package.  What Python cannot import is left out: hidden
        files, those of editors, copies with other names.
    """

    def __init__(self, package: str | Path = PACKAGE):
        self.package = Path(package)
        self.contents, self._stamps, self._imports, self._digests = {}, {}, {}, {}
        self._parsed = parsed_sources.Answers(self.package / "__pycache__")
        for name, path in _importable(self.package):
            self._stamps[name] = _stamp(path)
            self.contents[name] = path.read_bytes()

    def closure(self, names: Iterable[str], deep: bool = True) -> set[str]:
        """Paths of the modules that these lead to by their imports, themselves included.

        names: paths inside the package.  deep: whether imports inside functions of the named
        modules count, too; those of the modules that they lead to always do.
        """
        found = set(names) - NAMES_ONLY
        waiting = [target for name in names for target in self._targets(name, deep)]
        while waiting:
            name = waiting.pop()
            if name not in found:
                found.add(name)
                waiting += self._targets(name, True)
        return found

    def digest(self, names: Iterable[str]) -> str:
        """SHA-256 of modules and their names, in hexadecimal, by what they say to Python.

        names: paths inside the package, or in one of the folders that requests name.
        """
        content = [(name, self._digest(name)) for name in sorted(names)]
        self._parsed.keep()
        return hashlib.sha256(json.dumps(content).encode()).hexdigest()

    def raw_digest(self, names: Iterable[str]) -> str:
        """SHA-256 of modules as they are written, in hexadecimal; quick."""
        found = hashlib.sha256()
        for name in sorted(names):
            found.update(f"{name} {len(self._content(name))} ".encode() + self._content(name))
        return found.hexdigest()

    def of_request(self, kind: str, named: Iterable) -> set[str]:
        """Modules that a request depends on; named: (folder, name of a file in it) pairs."""
        roots = {f"{module}.py" for module in ANSWERED_BY[kind]} & self.contents.keys()
        roots |= {f"{folder}/{file}.py" for folder, file in named if self._has(folder, file)}
        asks = self.closure(ASKS & self.contents.keys(), deep=False)
        return self.closure(roots) | asks

    def edited(self, names: Iterable[str]) -> list[str]:
        """Those of the modules whose code on disk is no longer what was read."""
        return [name for name in sorted(names) if self._is_edited(name)]

    def _is_edited(self, name):
        path = self.package / name
        try:
            if name in self._stamps and _stamp(path) == self._stamps[name]:
                return False
            now = path.read_bytes()
        except OSError:
            return name in self.contents
        then = self.contents.get(name, now)
        return now != then and _digest_of(now) != _digest_of(then)

    def _has(self, folder, file):
        return f"{folder}/{file}.py" in self.contents or _of_ones_own(folder, file) is not None

    def _content(self, name):
        if name not in self.contents:
            folder, _, file = name.rpartition("/")
            path = _of_ones_own(folder, file.removesuffix(".py"))
            self.contents[name] = path.read_bytes() if path else b""
        return self.contents[name]

    def _digest(self, name):
        if name not in self._digests:
            content = self._content(name)
            self._digests[name] = self._parsed.of("code", content, lambda: _digest_of(content))
        return self._digests[name]

    def _targets(self, name, deep):
        """Paths of the modules that one imports."""
        if (name, deep) not in self._imports:
            self._imports[name, deep] = list(self._imported(name, deep))
        return self._imports[name, deep]

    def _imported(self, name, deep):
        parts, content = name.removesuffix(".py").split("/"), self._content(name)
        place = [self.package.name, *parts[:-1]]
        question = f"imports of {'.'.join(place)}{' deep' if deep else ''}"
        found = self._parsed.of(question, content, lambda: [*_imports_of(content, place, deep)])
        for dotted in found:
            path = "/".join(dotted)
            for target in (f"{path}.py", f"{path}/__init__.py"):
                if target in self.contents and target not in NAMES_ONLY:
                    yield target


def _stamp(path):
    about = path.stat()
    return about.st_mtime_ns, about.st_size, about.st_ino


def _importable(package):
    """(path inside the package, Path) of the modules in a folder and those below it."""
    for folder, folders, files in os.walk(package):
        folders[:] = sorted(n for n in folders if n.isidentifier() and n != "__pycache__")
        for file in sorted(files):
            path = Path(folder, file)
            if file.endswith(".py") and file[:-3].isidentifier() and path.is_file():
                yield path.relative_to(package).as_posix(), path


def _of_ones_own(folder, file):
    """Path of a motion, a pressure or a method in a folder of the user's own; None if not there."""
    package = sys.modules.get(f"{PACKAGE.name}.{folder.replace('/', '.')}")
    places = (Path(place, f"{file}.py") for place in getattr(package, "__path__", ()))
    return next((place for place in places if place.is_file()), None)


def _imports_of(content, place, deep):
    """Names of modules, as lists of parts inside the package, that a source may import.

    content: bytes; place: parts of the package that the module lies in, from the top one on.
    """
    import ast

    package = place[0]
    try:
        statements = [ast.parse(content)]
    except (SyntaxError, ValueError):  # a broken file, which no result can depend on
        return
    while statements:
        node = statements.pop()
        if isinstance(node, ast.Import):
            named = [alias.name.split(".") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = place[: len(place) - node.level + 1] if node.level else []
            module = above + (node.module.split(".") if node.module else [])
            named = [module, *([*module, alias.name] for alias in node.names)]
        else:
            named = []
            if deep or not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                statements += [n for n in ast.iter_child_nodes(node) if _may_import(n)]
        for parts in named:
            if parts[0] == package:
                # what lies above a module is imported with it
                yield from (parts[1:end] for end in range(2, len(parts) + 1))


def _may_import(node):
    import ast

    return isinstance(node, ast.stmt | ast.ExceptHandler | ast.match_case)


def _digest_of(content):
    from microslip.foundation.syntax_digest import digest_of_source

    try:
        return digest_of_source(content.decode("utf-8"))
    except (SyntaxError, ValueError):  # a broken file: by its bytes
        return hashlib.sha256(content).hexdigest()


# Of the package that is running

LOADED = Sources()


def files_of_request(request: dict) -> set[str]:
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
    """Digest of what solves a point, whatever its motion and pressure."""
    return LOADED.digest(LOADED.of_request("point", ()))


@cache
def of_kernels() -> str:
    """Digest of the modules with compiled functions, and of all that these import: quick."""
    with_kernels = {
        n for n, content in LOADED.contents.items() if b"microslip.foundation.compiled" in content
    }
    return LOADED.raw_digest(LOADED.closure(with_kernels))


def _named(request):
    """(folder, file) of what a request names; without a motion all of them count."""
    named = {folder: request.get(key) or "" for folder, key in NAMED_IN_REQUESTS.items()}
    files = {folder: text.partition(":")[0].replace("-", "_") for folder, text in named.items()}
    if files["pressures"] == "file":
        files["pressures"] = "from_file"
    every = () if files["motions"] else _files_in(["motions"])
    of_all = [("motions", Path(file).stem) for file in sorted(every)]
    return (*(item for item in files.items() if item[1]), *of_all)


@cache
def _files_of_request(kind, *named):
    return frozenset(LOADED.of_request(kind, named))


@cache
def _of_request(kind, *named):
    return LOADED.digest(_files_of_request(kind, *named))


def _files_in(names):
    """The modules that names stand for: a file, or all in a folder."""
    return {
        file
        for file in LOADED.contents
        for name in names
        if file == name or file.startswith(f"{name}/")
    }
