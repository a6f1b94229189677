"""Methods for comparison with the shipped method, and the names of all methods.

The methods named in `OWN` replace at most the integrator; see periodic.method.  Each of the other
methods is a file in this folder.  For example, the file `some_name.py` defines a `method.Method`
with the name METHOD. In `microslip.solve` and in configurations, this method is called `some-name`.
Files whose names start with an underscore contain shared code.  The name of a method can be
followed by parameters, for example "projected-gradient:step=0.5".  A method can require a package
that microslip does not depend on.  Studies omit a method if its package is not installed.

The functions that list and check names import neither the solver nor NumPy.
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
"""Names of the methods that have no file in this folder."""
METHODS = Path(__file__).parent


@cache
def names() -> tuple[str, ...]:
    """Return the names of all methods, "shipped" first.  Files that cannot be parsed are left
    out."""
    stems = (file.stem for file in METHODS.glob("[!_]*.py"))
    # copies and checkpoints of files are not methods
    files = {stem.replace("_", "-") for stem in stems if stem.isidentifier()}
    others = sorted({*OWN, *files} - {SHIPPED})
    return (SHIPPED, *(name for name in others if not isinstance(_parsed(name), str)))


@cache
def _parsed(name: str) -> ast.Module | str | None:
    """Return the syntax tree of a method's file.

    Return the error message if the file cannot be parsed. Return None if there is no file.
    """
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
    """Split a string into the name and the parameters of a method, without importing the solver.

    Raises InputError if the string does not name a method.
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
    """Return an error message if a method requires a package that is not installed. Otherwise,
    return "".

    The function imports neither the solver nor the package.  Raises InputError if the string does
    not name a method.
    """
    package = declared(split(text)[0], "requires")
    if package and find_spec(package) is None:
        return f"needs the package {package}, which is not installed"
    return ""


def method_named(text: str) -> Method:
    """Return the `Method` with the given name, or raise InputError with the allowed names."""
    if text in OWN:
        return import_module("microslip.periodic.method").OWN[text]
    name, numbers = split(text)
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
