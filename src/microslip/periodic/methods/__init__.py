"""Methods for comparison with the shipped one, and the names of all methods.

The methods in OWN replace at most the integrator, see periodic.method.  Every other method is one
file of this folder.  The file `some_name.py` defines METHOD, a `method.Method`.  The method's name
is `some-name` in `microslip.solve` and in configurations.  Files whose names start with an
underscore contain shared code.  The name of a method can be followed by parameters, for example
"projected-gradient:step=0.5".  A method can require a package that microslip does not depend on.
Studies omit the method if that package is not installed.

Listing and checking names imports neither the solver nor NumPy.
"""

from __future__ import annotations

import ast
from dataclasses import replace
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from microslip.foundation import spec
from microslip.foundation.errors import InputError, described

if TYPE_CHECKING:
    from microslip.periodic.method import Method

SHIPPED = "shipped"
OWN = (SHIPPED, "euler", "midpoint")
"""Names of the methods without a file."""
METHODS = Path(__file__).parent


@cache
def names() -> tuple[str, ...]:
    """Names of all methods, the shipped one first.  Files that cannot be parsed are omitted."""
    stems = (file.stem for file in METHODS.glob("[!_]*.py"))
    # copies and checkpoints of files are not methods
    files = {stem.replace("_", "-") for stem in stems if stem.isidentifier()}
    others = sorted({*OWN, *files} - {SHIPPED})
    return (SHIPPED, *(name for name in others if not isinstance(_parsed(name), str)))


@cache
def _parsed(name: str) -> ast.Module | str | None:
    """Syntax tree of a method's file, the error message if parsing fails, or None if there is no
    file."""
    file = METHODS / f"{name.replace('-', '_')}.py"
    if not file.stem.isidentifier():
        return None
    try:
        return ast.parse(file.read_text(encoding="utf-8"), file)
    except FileNotFoundError:
        return None
    except (OSError, SyntaxError, ValueError) as error:
        return f"{file} cannot be imported: {described(error, file)}"


def split(text: str) -> tuple[str, dict[str, float]]:
    """Name and parameters of a method; raises InputError if the text does not name a method.

    Does not import the solver.
    """
    if not isinstance(text, str):
        raise InputError("method", text, f"allowed is one of {', '.join(names())}")
    reason = _parsed(text.partition(":")[0])
    if isinstance(reason, str):
        raise InputError("method", text, reason)
    name, numbers = spec.split(text, "method", names())
    allowed = tuple(declared(name, "parameters") or ())
    return name, spec.numbers_in(numbers, text, "method", name, allowed)


def missing(text: str) -> str:
    """Error message if a package required by a method is not installed; empty if the method can
    run.

    Neither the solver nor the package is imported.  Raises InputError as `split` does.
    """
    package = declared(split(text)[0], "requires")
    if package and find_spec(package) is None:
        return f"needs the package {package}, which is not installed"
    return ""


def method_named(text: str) -> Method:
    """Return the Method with a name, or raise an InputError that lists the allowed names."""
    name, numbers = split(text)
    if name in OWN:
        return import_module("microslip.periodic.method").OWN[name]
    file = name.replace("-", "_")
    try:
        result = import_module(f"{__name__}.{file}").METHOD
    except (Exception, SystemExit) as error:  # code written by users can raise any exception
        path = METHODS / f"{file}.py"
        reason = f"{path} cannot be imported: {described(error, path)}"
        raise InputError("method", text, reason) from error
    return replace(result, parameters={**result.parameters, **numbers})


@cache
def declared(name: str, field: str) -> Any:
    """Read the value of a METHOD field from a method's file, without running the file.

    Returns None if the field is not set, or if the method has no file.  `name` must not contain
    parameters.  The value must be a literal.
    """
    tree = _parsed(name)
    nodes = ast.walk(tree) if isinstance(tree, ast.Module) else ()
    keywords = (node for node in nodes if isinstance(node, ast.keyword) and node.arg == field)
    return next((ast.literal_eval(one.value) for one in keywords), None)
