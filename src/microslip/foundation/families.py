"""Files that hold a record each, or a family of records for numbers that follow a name.

A family is a module with DEFAULTS, the numbers and their values if they are not given, and a
function that makes a record of a name and these numbers.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import lru_cache
from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType

from microslip.foundation import spec
from microslip.foundation.errors import InputError


def modules_in(folder: str | os.PathLike, package: ModuleType) -> Iterator[tuple[str, ModuleType]]:
    """Name and module of each file in a folder, which is one of the package's from now on."""
    if str(folder) not in package.__path__:
        package.__path__.append(str(folder))
    for file in iter_modules([str(folder)]):
        if file.name.isidentifier():  # else a copy or a checkpoint of one, which nobody means
            yield file.name, import_module(f"{package.__name__}.{file.name}")


def record_named(text: str, what: str, families: dict, known: Iterable[str], make: str) -> object:
    """The record of a family for the numbers in a text, such as "power:exponent=1".

    Parameters
    ----------
    text, what : str
        The text, and the argument that it was given for.
    families : dict of str to module
        Families by name.
    known : iterable of str
        All names that are allowed, for messages.
    make : str
        Name of the function of a family.

    Raises
    ------
    InputError
        For a text that names none, or numbers that the family does not take.
    """
    family, numbers = spec.split(text, what, known)
    module = families.get(family)
    spec.refuse_unknown(text, what, numbers, list(module.DEFAULTS if module else ()))
    try:
        return _made(module, family, make, tuple(sorted(numbers.items())))
    except InputError as error:  # about the name as it is kept
        raise InputError(what, text, error.allowed) from None


@lru_cache(maxsize=128)
def _made(module, family, make, numbers):
    """One record for a name: what is prepared for it is found again by it."""
    given = {key: value for key, value in numbers if value != module.DEFAULTS[key]}
    words = ",".join(f"{key}={value:.12g}" for key, value in given.items())
    name = f"{family}:{words}" if words else family
    return getattr(module, make)(name, **(module.DEFAULTS | dict(numbers)))
