"""Methods to compare with the one that ships: one file a method.

A method is the file `name_of_it.py` in the folder `methods`, which holds METHOD, a
`method.Method`; it is then known as `name-of-it`, to `microslip.solve` as well as in a
configuration.  Files whose name starts with an underscore are shared by methods.  Numbers that a
method takes may follow its name: "admm:penalty=0.1,relaxation=1.5".  A method may require a package
that is not one of microslip's: where that is not installed, nothing asks for it.

Listing and checking names imports no solver.
"""

from __future__ import annotations

import ast
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.foundation.families import described
from microslip.solver import methods

if TYPE_CHECKING:
    from microslip.solver.method import Method

SHIPPED = "shipped"
METHODS = Path(methods.__file__).parent


@cache
def names() -> tuple[str, ...]:
    """Names of all methods, the one that ships first; without those whose file is no Python."""
    stems = (file.stem for file in METHODS.glob("[!_]*.py"))
    # not a copy or a checkpoint of one, which nobody means
    every = sorted(stem.replace("_", "-") for stem in stems if stem.isidentifier())
    return (SHIPPED, *(name for name in every if not isinstance(_parsed(name), str)))


@cache
def _parsed(name: str) -> ast.Module | str | None:
    """The syntax tree of a method's file; a text that says what is wrong with it; None if it is
    not there."""
    file = METHODS / f"{name.replace('-', '_')}.py"
    try:
        return ast.parse(file.read_text(encoding="utf-8"), file)
    except FileNotFoundError:
        return None
    except (OSError, SyntaxError, ValueError) as error:
        return f"{file} cannot be imported: {described(error, file)}"


def split(text: str) -> tuple[str, dict[str, float]]:
    """Name and numbers (dict) of a method; raises InputError if the text cannot be read."""
    if not isinstance(text, str):
        raise InputError("method", text, f"allowed is one of {', '.join(names())}")
    name = text.partition(":")[0]
    reason = _parsed(name) if name.replace("-", "_").isidentifier() else None
    if isinstance(reason, str):
        raise InputError("method", text, reason)
    return spec.split(text, "method", names())


def check(text: str) -> None:
    """Raise InputError where a text names no method.  Imports no solver."""
    name, numbers = split(text)
    spec.refuse_unknown(text, "method", numbers, tuple(declared(name, "parameters") or ()))


def missing(text: str) -> str:
    """Why a method cannot run here: the package that it requires is not installed; "" if it can.

    Imports neither the solver nor the package.  Raises InputError as `split` does.
    """
    package = declared(split(text)[0], "requires")
    if package and find_spec(package) is None:
        return f"needs the package {package}, which is not installed"
    return ""


def method_named(text: str) -> Method:
    """The method.Method that a text names; raises InputError, with what is allowed, if none."""
    check(text)
    from dataclasses import replace

    name, numbers = split(text)
    if name == SHIPPED:
        return import_module("microslip.solver.method").SHIPPED
    file = name.replace("-", "_")
    try:
        method = import_module(f"{methods.__name__}.{file}").METHOD
    except (Exception, SystemExit) as error:  # the code of a user may raise anything
        path = METHODS / f"{file}.py"
        reason = f"{path} cannot be imported: {described(error, path)}"
        raise InputError("method", text, reason) from error
    return replace(method, parameters={**method.parameters, **numbers})


@cache
def declared(name: str, field: str) -> Any:
    """Value of a field of METHOD in a method's file, read without running it; None: not set.

    name: without numbers; the value has to be a literal.
    """
    if name == SHIPPED:
        return None
    tree = _parsed(name)
    if not isinstance(tree, ast.Module):
        return None
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword) and node.arg == field:
            return ast.literal_eval(node.value)
    return None
