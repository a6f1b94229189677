"""Digests of the code that computes results and makes products.

The name of a result contains the digest of the solver.  This digest covers the code of all
subpackages that compute results, and the file of a comparison method.  The name of a dataset, page
or figure contains the digest of its builder.  The builder of a product consists of the modules that
make the product.  The builder also contains the modules that these modules import from the
subpackages in `OUTER`.  An exception is the subpackage foundation, whose modules are not included.
The name of a motion or a pressure in a user's file also contains a digest.  This digest covers the
user's file, and the files that this file imports from its folder.  Comments, docstrings and layout
do not change a digest.  If the text of a message changes, only the digests of builders change.

Files are read when a digest is first needed.
"""

from __future__ import annotations

import ast
import contextlib
import hashlib
import json
import sys
from collections.abc import Callable, Iterable
from functools import cache, cached_property
from pathlib import Path

from microslip.foundation.errors import CacheError
from microslip.foundation.files import write_atomically

PACKAGE = Path(__file__).parents[1]
OUTER = {"app", "bundle", "config", "datasets", "foundation", "report", "si", "studies", "sweeps"}
"""Subpackages that do not compute results.  The files listed in NUMBERS are exceptions."""
NUMBERS = {"foundation/compiled.py", "sweeps/evaluate.py", "sweeps/period_codec.py"}
"""Files that influence results, although they are in the subpackages of `OUTER`.  These files
compile functions, or convert the output of the solver."""
METHODS = "periodic/methods/"
"""Folder of comparison methods.  The code of a method influences only the results that were
requested with this method."""
ENDINGS = {".py", ".csv", ".html", ".css", ".js"}
"""Extensions of the files that are read: modules, tables of modules, and parts of web pages."""


class Sources:
    """Files of the package, or of a folder with users' files.  Each file is read once.

    Parameters
    ----------
    folder : path
        Folder of the files.
    prefix : str or None
        Beginning of the names of the modules; the default is the name of the folder and a point.
    """

    def __init__(self, folder: str | Path = PACKAGE, prefix: str | None = None):
        self.folder = Path(folder)
        self.prefix = f"{self.folder.name}." if prefix is None else prefix
        self.content = cache(lambda name: (self.folder / name).read_bytes())
        self._parsed = cache(self._read_parsed)
        self._store = self.folder / f"__pycache__/sources.{sys.implementation.cache_tag}.json"

    @cached_property
    def names(self) -> list[str]:
        """Paths of all files inside the folder, except copies and scratch files."""
        paths = (p.relative_to(self.folder) for p in self.folder.rglob("*") if p.suffix in ENDINGS)
        parts = {path.as_posix(): path.with_suffix("").parts for path in paths}
        return sorted(name for name, words in parts.items() if all(map(str.isidentifier, words)))

    def digest(self, names: Iterable[str]) -> str:
        """Return the hexadecimal SHA-256 of the paths `names` and of the code in these files."""
        code = [(name, self._parsed(name)[0]) for name in sorted(names)]
        if self.prefix and self._is_new:
            self._is_new = False
            with contextlib.suppress(CacheError):  # the next process parses the modules again
                write_atomically(self._store, json.dumps(self._results).encode())
        return _sha256(json.dumps(code).encode())

    def closure(self, names: Iterable[str], inside: Callable[[str], bool] = bool) -> set[str]:
        """Return the paths of the given files, and of all modules that these files import directly
        or indirectly.

        A table such as variables.csv belongs to the module variables.py.

        inside: function that returns False for the path of an imported module to be omitted.
        """
        closure: set[str] = set()
        queue = [*names]
        while queue:
            if (name := queue.pop()) not in closure:
                closure.add(name)
                queue += filter(inside, self._imports(name, self._parsed(name)[1]))
        tables = (f"{name[:-3]}.csv" for name in closure if name.endswith(".py"))
        return closure | {name for name in tables if (self.folder / name).is_file()}

    @property
    def solver(self) -> set[str]:
        """Paths of the files that influence results, except comparison methods."""
        return {n for n in self.names if is_physics(n) and not n.startswith(METHODS)}

    @property
    def kernels(self) -> set[str]:
        """Paths of the files that contain compiled functions, and of all modules that these files
        import."""
        physics = filter(is_physics, self.names)
        kernels = (name for name in physics if b"compiled import kernel" in self.content(name))
        return self.closure(kernels, is_physics)

    def builder(self, *files: str) -> set[str]:
        """Return the paths of the modules that produce the files of a product.  Modules of the
        physics and of the foundation are not included.

        A table that has the name of a module, such as variables.csv, belongs to the module.

        files: modules and folders of the package.
        """
        starts = {n for n in self.names for f in files if n == f or n.startswith(f"{f}/")}
        return self.closure(starts, lambda n: not (is_physics(n) or n.startswith("foundation/")))

    def _imports(self, file: str, modules: Iterable[str]) -> list[str]:
        """Return the paths of the modules that a file imports, and the paths of the packages that
        contain these modules.  A dot at the beginning of a name is the folder of the file, and each
        further dot is the folder above."""
        inside = (n.removeprefix(self.prefix) for n in modules if n.startswith(self.prefix))
        parts = [name.split(".") for name in inside if name[:1] != "."]
        for name in (name for name in modules if name.startswith(".")):
            own = name.lstrip(".")
            parts.append([*file.split("/")[: len(own) - len(name)], *own.split(".")])
        paths = {"/".join(one[:end]) for one in parts for end in range(1, len(one) + 1)}
        files = (file for path in paths for file in (f"{path}.py", f"{path}/__init__.py"))
        return [file for file in files if (self.folder / file).is_file()]

    # Parsing takes a second for the package, so the results are stored in __pycache__.

    def _read_parsed(self, name: str) -> tuple[str, list[str]]:
        """Return the digest of the code of a file, and the names of the modules that this file
        imports."""
        if not name.endswith(".py"):
            return _sha256(self.content(name)), []
        messages = bool(self.prefix) and not is_physics(name)
        key = _sha256(self.content(name) + _READER + bytes(messages))
        if key not in self._results:
            self._results[key], self._is_new = parse(self.content(name), messages), True
        return self._results[key]

    _is_new = False

    @cached_property
    def _results(self) -> dict[str, tuple[str, list[str]]]:
        with contextlib.suppress(OSError, TypeError, ValueError):
            return dict(json.loads(self._store.read_bytes()))  # another version may store a list
        return {}


_READER = Path(__file__).read_bytes()
"""Content of this file.  Parsed data that another version of this file has stored is not used."""


def is_physics(name: str) -> bool:
    """Return True for files that influence results.  `name` is the path inside the package."""
    room, slash, _ = name.partition("/")
    return name in NUMBERS or bool(slash) and room not in OUTER


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def parse(content: bytes, messages: bool) -> tuple[str, list[str]]:
    """Return the digest of the code of a module, and the names of all modules that this module
    imports.

    messages: if True, messages change the digest; see `_text`.
    """
    try:
        tree = ast.parse(content)
    except (SyntaxError, ValueError):  # in a broken file only the bytes count
        return _sha256(content), []
    nodes = [*ast.walk(tree)]
    names = {one.name for node in nodes if isinstance(node, ast.Import) for one in node.names}
    parts = [node for node in nodes if isinstance(node, ast.ImportFrom)]
    names |= {
        "." * node.level + ".".join(filter(None, [node.module, one.name]))
        for node in parts
        for one in node.names
    }
    return _sha256(_text(tree, messages).encode()), sorted(names)


def _text(node: object, messages: bool) -> str:
    """Return the text of a syntax tree, without docstrings, line numbers and empty fields.

    messages: if False, messages are omitted.  A string with a blank counts as a message, unless an
    attribute of the string is used, as in "a b".split().  Unlike ast.dump, this function returns
    the same text in all versions of Python.
    """
    if isinstance(node, list):
        return f"[{''.join(_text(item, messages) for item in node)}]"
    if isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str):
        return ""  # documents a module, a function or a constant
    if not messages and _is_message(node):
        return "-"
    if not isinstance(node, ast.AST):
        return f"{node!r},"
    whole = messages or isinstance(node, ast.Attribute) and isinstance(node.value, ast.Constant)
    fields = ((name, _text(v, whole)) for name, v in ast.iter_fields(node) if v is not None)
    return f"{type(node).__name__}({''.join(f'{n}={text}' for n, text in fields if text != '[]')})"


def _is_message(node: object) -> bool:
    if isinstance(node, ast.JoinedStr):
        return any(map(_is_message, node.values))
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value


# The package that is running

LOADED = Sources()


def of_request(request: dict) -> str:
    """Return the digest of the code that influences the result of a request."""
    return of_solver((request.get("method") or "").partition(":")[0].replace("-", "_"))


@cache
def of_solver(method: str = "") -> str:
    """Return the digest of the code that computes results.  The digest covers the code of the
    physics and the file of a comparison method."""
    files = {f"{METHODS}{method}.py"}.intersection(LOADED.names)
    return LOADED.digest(LOADED.solver | LOADED.closure(files, is_physics))


def is_edited() -> bool:
    """Return True if the code of the physics on disk has changed since it was read."""
    now = Sources()
    return now.digest(now.solver) != of_solver()


@cache
def of_builder(*files: str) -> str:
    """Return the digest of the modules and folders that make a product; see Sources.builder."""
    return LOADED.digest(LOADED.builder(*files))


def workflow_file(name: str) -> Path:
    """Return the path of a file of the workflow.  In an installed package, the file is in the
    folder `bundle`.  In a source tree, the file is in the top folder.  The function does not check
    that the file exists in the source tree."""
    bundled = PACKAGE / "bundle" / name
    return bundled if bundled.is_file() else PACKAGE.parents[1] / name


def of_script(name: str) -> str:
    """Return the digest of a script of the workflow.  If the script does not exist, the digest is
    empty."""
    path = workflow_file(name)
    return parse(path.read_bytes(), messages=True)[0] if path.is_file() else ""
