"""Digests of the code that computes results and makes products.

The name of a result contains the digest of the physics: the code of all rooms that make numbers.
In the folders of motions, pressures and methods, a file counts only if the physics imports it or
the request names it, so that a new file in these folders does not change other results.  The name
of a dataset, page or figure contains the digest of its builder: its module, and what it imports
from the outer rooms.  Comments, docstrings, layout and messages do not count.

All modules are read once, when the package is imported, so that a digest belongs to the running
code.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import cache, cached_property
from pathlib import Path

from microslip.foundation.errors import CacheError
from microslip.foundation.files import write_atomically

PACKAGE = Path(__file__).parents[1]
OUTER = {"app", "bundle", "config", "datasets", "foundation", "report", "si", "studies", "sweeps"}
"""Rooms that do not make numbers, except for the files in NUMBERS."""
NUMBERS = {"foundation/compiled.py", "sweeps/evaluate.py", "sweeps/period_codec.py"}
"""Files in OUTER on which results depend: compilation, and conversion of the solver's output."""
ENDINGS = {"py", "html", "css", "js"}
"""File name extensions of modules and of parts of pages."""
FAMILIES = {"solver/methods": "method", "motions": "motion", "pressures": "pressure"}
"""Folder -> key of a request.  The value at this key contains the name of a file in the folder."""


class Sources:
    """The modules of a package, and the templates and scripts for its pages, at the time of
    construction.

    contents: dict from the path of each file inside the package to its bytes.
    """

    def __init__(self, package: str | Path = PACKAGE):
        self.package = Path(package)
        files = dict(_modules(self.package))
        self._dates = {name: os.stat(path).st_mtime_ns for name, path in files.items()}
        self.contents = {name: Path(path).read_bytes() for name, path in files.items()}
        self._parsed = cache(self._read_parsed)

    def digest(self, names: Iterable[str]) -> str:
        """SHA-256 of the paths and the code of files, in hexadecimal."""
        code = [(name, self._parsed(name)[0]) for name in sorted(names)]
        self._write_parsed()
        return _sha256(json.dumps(code).encode())

    def closure(self, names: Iterable[str], inside: Callable[[str], bool]) -> frozenset[str]:
        """Paths of modules, and of all modules that they import directly or indirectly.

        inside: function that returns False for the path of an imported module to be omitted.
        """
        closure: set[str] = set()
        queue = [*names]
        while queue:
            name = queue.pop()
            if name not in closure:
                closure.add(name)
                queue += filter(inside, self._imports(self._parsed(name)[1]))
        return frozenset(closure)

    def of_request(self, request: dict) -> frozenset[str]:
        """Paths of the modules that influence the result of a request."""
        texts = {folder: request.get(key) or "" for folder, key in FAMILIES.items()}
        names = {folder: text.partition(":")[0].replace("-", "_") for folder, text in texts.items()}
        files = {f"{f}/{'from_file' if n == 'file' else n}.py" for f, n in names.items() if n}
        if not names["motions"]:  # the result may depend on any motion
            files |= {name for name in self.contents if name.startswith("motions/")}
        files = {name for name in files if name in self.contents or _in_a_users_folder(name)}
        files |= {n for n in self.contents if is_physics(n) and os.path.dirname(n) not in FAMILIES}
        return self.closure(files, is_physics)

    def of_builder(self, *files: str) -> frozenset[str]:
        """Paths of the modules that make a product, besides the physics and the foundation.

        files: modules and folders of the package.
        """
        starts = {n for n in self.contents for f in files if n == f or n.startswith(f"{f}/")}
        return self.closure(starts, lambda n: not is_physics(n) and not n.startswith("foundation/"))

    @cached_property
    def kernels_digest(self) -> str:
        """Digest of the modules with compiled functions, including all modules imported by them.

        The layout counts, because Numba identifies a function's code by its line number.
        """
        compiled = {n for n, c in self.contents.items() if b"microslip.foundation.compiled" in c}
        files = self.closure(compiled, lambda n: is_physics(n) and n != "sweeps/evaluate.py")
        return _sha256(json.dumps([(n, _sha256(self.contents[n])) for n in sorted(files)]).encode())

    def edited(self) -> str | None:
        """Path of a physics file whose code on disk has changed since it was read; None if no file
        has changed."""
        for name in filter(is_physics, self._dates):
            path, then = self.package / name, self.contents[name]
            try:
                same_date = os.stat(path).st_mtime_ns == self._dates[name]
                now = then if same_date else path.read_bytes()
            except OSError:
                return name
            if now != then and _parse(now, False)[0] != _parse(then, False)[0]:
                return name
        return None

    def _imports(self, modules: Iterable[str]) -> list[str]:
        """Paths of the modules with these names, and of the packages that contain them."""
        inside = f"{self.package.name}."
        parts = [name.split(".")[1:] for name in modules if name.startswith(inside)]
        paths = {"/".join(one[:end]) for one in parts for end in range(1, len(one) + 1)}
        files = (file for path in paths for file in (f"{path}.py", f"{path}/__init__.py"))
        return [file for file in files if file in self.contents]

    # Parsing takes a second, so the results are stored in __pycache__.

    def _read_parsed(self, name: str) -> tuple[str, list[str]]:
        if name not in self.contents:
            path = _in_a_users_folder(name)
            self.contents[name] = path.read_bytes() if path else b""
        key = _sha256(self.contents[name])
        if not name.endswith(".py"):
            return key, []
        physics = is_physics(name)
        key = f"{key}{'' if physics else ' with messages'}"
        if key not in self._results:
            self._results[key] = _parse(self.contents[name], not physics)
            self._is_new = True
        return self._results[key]

    _is_new = False

    @cached_property
    def _results(self) -> dict[str, tuple[str, list[str]]]:
        with contextlib.suppress(OSError, ValueError):
            reader, results = json.loads(self._file.read_bytes())
            return results if reader == _READER else {}
        return {}

    def _write_parsed(self) -> None:
        if self._is_new:
            self._is_new = False
            with contextlib.suppress(CacheError):  # the next process parses the modules again
                write_atomically(self._file, json.dumps([_READER, self._results]).encode())

    @property
    def _file(self) -> Path:
        return self.package / "__pycache__" / f"sources.{sys.implementation.cache_tag}.json"


def is_physics(name: str) -> bool:
    """True for files that influence results.  name: path inside the package."""
    room, slash, _ = name.partition("/")
    return name in NUMBERS or bool(slash) and room not in OUTER


def _modules(folder: str | Path, prefix: str = "") -> Iterator[tuple[str, str]]:
    """Path inside the package, and full path, of each file in a folder and its subfolders."""
    for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
        stem, _, ending = entry.name.partition(".")
        if not stem.isidentifier() or stem == "__pycache__":
            continue
        if ending in ENDINGS and entry.is_file():
            yield prefix + entry.name, entry.path
        elif not ending and entry.is_dir():
            yield from _modules(entry.path, f"{prefix}{entry.name}/")


def _in_a_users_folder(name: str) -> Path | None:
    """Path of a motion or pressure file in a user's folder; None if it does not exist."""
    folder, _, file = name.rpartition("/")
    package = sys.modules.get(f"{PACKAGE.name}.{folder.replace('/', '.')}")
    places = (Path(place, file) for place in getattr(package, "__path__", ()))
    return next((place for place in places if place.is_file()), None)


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


_READER = _sha256(Path(__file__).read_bytes())
"""Digest of this file.  Stored parse results are ignored if they come from another version of this
file."""


def _parse(content: bytes, messages: bool) -> tuple[str, list[str]]:
    """Digest of the code of a module, and the names of all modules that it imports.

    messages: True if messages count, see `_text`.
    """
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):  # in a broken file only the bytes count
        return _sha256(content), []
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return _sha256(_text(tree, messages).encode()), sorted(names)


def _text(node: object, messages: bool) -> str:
    """Text of a syntax tree, without docstrings, line numbers and empty fields.

    messages: False to leave out messages as well.  A string with a blank is a message, unless an
    attribute of it is used, as in "a b".split().  All versions of Python give the same text.  The
    output of ast.dump for empty fields differs between versions.
    """
    if isinstance(node, list):
        items = (item for item in node if not _is_docstring(item))
        return (
            f"[{''.join('-' if _is_message(i, messages) else _text(i, messages) for i in items)}]"
        )
    if not isinstance(node, ast.AST):
        return f"{node!r},"
    fields = []
    for name, value in ast.iter_fields(node):
        if _is_message(value, messages) and not isinstance(node, ast.Attribute):
            fields.append(f"{name}=-")
        elif value is not None and (text := _text(value, messages)) != "[]":
            fields.append(f"{name}={text}")
    return f"{type(node).__name__}({''.join(fields)})"


def _is_message(node: object, messages: bool) -> bool:
    if messages:
        return False
    if isinstance(node, ast.JoinedStr):
        return any(_is_message(part, messages) for part in node.values)
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value


def _is_docstring(node: object) -> bool:
    """True for a statement that is a string.  It can document a module, a function, a constant or a
    field."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


# The package that is running

LOADED = Sources()


def of_request(request: dict) -> str:
    """Digest of the code that influences the result of a request."""
    return _of_request(*(request.get(key) for key in FAMILIES.values()))


@cache
def _of_request(*names: str | None) -> str:
    return LOADED.digest(LOADED.of_request(dict(zip(FAMILIES.values(), names, strict=True))))


def of_solver() -> str:
    """Digest of the physics, except motions, pressures and methods that are named only by
    requests."""
    return of_request({"motion": "none"})


@cache
def of_builder(*files: str) -> str:
    """Digest of the modules and folders that make a product, see Sources.of_builder."""
    return LOADED.digest(LOADED.of_builder(*files))


def of_script(path: Path) -> str:
    """Digest of a script outside of the package."""
    return _parse(path.read_bytes(), messages=True)[0]
