"""A numerical method: integrator, step solver and search for the periodic state.

The shipped method is the default of `microslip.solve`.  Each other method, for comparison, replaces
the integrator, the step solver, the search, or the search's initial state.

Every method that is not in OWN is one file.  The file `some_name.py` in the folder `methods`
defines METHOD, a Method.  The method's name is `some-name` in `microslip.solve` and in
configurations.  Files whose names start with an underscore contain shared code.  The name of a
method can be followed by parameters, for example "projected-gradient:step=0.5".  A method can
require a package that microslip does not depend on.  Studies omit the method if that package is
not installed.

Listing and checking names does not import the solver.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from microslip.contact.contact import Contact
from microslip.contact.path import EULER, SDIRK2, Integrator, theta_method
from microslip.foundation import spec
from microslip.foundation.errors import InputError, described
from microslip.periodic import methods


@dataclass(frozen=True)
class Method:
    """The parts of a method. By default, each part is the part of the shipped method.

    In the file of a method, `requires`, `resolution`, `turns`, `model` and `parameters` must be
    literals, since `declared` reads them without running the file.

    Attributes
    ----------
    summary : str
        Description in one line, for tables and figures.
    integrator : path.Integrator
        Time integrator of a step.
    dress : callable or None
        `dress(contact, **parameters)` returns the contact with another step solver.
    parameters : mapping of str to float
        Keyword arguments of `dress`, with their defaults.
    search : callable or None
        Function that replaces search.find_periodic_state.
    prepared : bool
        Whether the search starts near the static limit.  Otherwise it starts from full slip.
    run : callable or None
        Function that replaces the whole simulation, as in methods/paper.py.
    model : str
        The only model that `run` supports.
    resolution : tuple of int or None
        Fixed resolution of `run`: number of cells, of angles and of steps in a period.
    requires : str
        Package that the method needs in addition to the dependencies of microslip.
    turns : bool
        Whether the method supports rotations.
    """

    summary: str
    integrator: Integrator = SDIRK2
    dress: Callable | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    search: Callable | None = None
    prepared: bool = True
    run: Callable | None = None
    model: str = ""
    resolution: tuple[int, int, int] | None = None
    requires: str = ""
    turns: bool = True

    def dressed(self, contact: Contact) -> Contact:
        """The contact with the step solver of this method."""
        return contact if self.dress is None else self.dress(contact, **self.parameters)


SHIPPED = "shipped"
OWN = {
    SHIPPED: Method("what microslip.solve does unless told otherwise"),
    # robust and first order; tractions never exceed the friction bound
    "euler": Method("backward Euler, first order", integrator=EULER),
    # Coulomb's law is satisfied in the middle of a step.  The tractions at the end are extrapolated
    # and can exceed the friction bound.  The error of a step recurs with the opposite sign.
    "midpoint": Method("implicit midpoint rule, undamped", integrator=theta_method(0.5)),
}
"""Methods that replace at most the integrator, by name."""
METHODS = Path(methods.__file__).parent


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
    spec.refuse_unknown(text, "method", numbers, tuple(declared(name, "parameters") or ()))
    return name, numbers


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
        return OWN[name]
    file = name.replace("-", "_")
    try:
        result = import_module(f"{methods.__name__}.{file}").METHOD
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
