"""Files that hold a record each, or a family of records for numbers that follow a name.

A family is a module with DEFAULTS, the numbers and their values if they are not given, and a
function that makes a record of a name and these numbers.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from traceback import extract_tb
from types import ModuleType

from microslip.foundation import spec
from microslip.foundation.errors import InputError, shown


def modules_in(
    folder: str | os.PathLike, package: ModuleType, broken: dict[str, str]
) -> Iterator[tuple[str, ModuleType]]:
    """Name and module of each file in a folder, which is one of the package's from now on.

    A file that cannot be imported is left out, so that it ends only the commands that name it.  So
    is one whose name a file in another folder has: which of them was meant is not known.

    Parameters
    ----------
    folder : str or path
        Folder of the package or of the user.
    package : module
        The package whose modules the files become.
    broken : dict of str to str
        Receives the path and the error of each file that is left out, by its name.
    """
    if str(folder) not in package.__path__:
        package.__path__.append(str(folder))
    for file in iter_modules([str(folder)]):
        if file.ispkg or not file.name.isidentifier():  # a copy or a checkpoint of a module
            continue
        path = Path(os.path.abspath(folder), f"{file.name}.py")
        try:
            module = import_module(f"{package.__name__}.{file.name}")
        except (Exception, SystemExit) as error:  # the code of a user may raise anything
            broken[file.name] = f"{path} cannot be imported: {described(error, path)}"
            continue
        if not os.path.samefile(os.path.dirname(str(module.__file__)), folder):
            taken = f"{path}: {module.__file__} has the same name; allowed is another name"
            broken[file.name] = taken
            continue
        broken.pop(file.name, None)
        yield file.name, module


def described(error: BaseException, path: str | os.PathLike) -> str:
    """Type, line in the file at `path`, and message of an error, in one line."""
    lines = [
        frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path)
    ]
    message = str(error)
    if isinstance(error, SyntaxError) and error.filename == str(path):
        lines, message = [error.lineno], error.msg
    where = f" in line {lines[-1]}" if lines else ""
    return " ".join(f"{type(error).__name__}{where}: {message}".split())


def missing_parts(module: ModuleType, constant: str, kind: type, make: str) -> str:
    """What keeps a module from being a record or a family; "" if nothing does.

    Parameters
    ----------
    module : module
        With the constant, or with DEFAULTS for a family.
    constant, kind : str and type
        Name and type of the record.
    make : str
        Name of the function of a family.
    """
    if hasattr(module, constant):
        record = getattr(module, constant)
        if not isinstance(record, kind):
            return f"{module.__file__}: {constant} is no {kind.__name__}: {shown(record)}"
    elif hasattr(module, "DEFAULTS"):
        if not isinstance(module.DEFAULTS, dict):
            return f"{module.__file__}: DEFAULTS is no dict: {shown(module.DEFAULTS)}"
        if not callable(getattr(module, make, None)):
            return f"{module.__file__}: there is no function {make} beside DEFAULTS"
    return ""


def record_named(
    text: str,
    what: str,
    families: Mapping[str, ModuleType],
    known: Iterable[str],
    make: str,
    broken: Mapping[str, str],
) -> object:
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
    broken : dict of str to str
        Path and error of each file that cannot be used, see `modules_in`.

    Raises
    ------
    InputError
        For a text that names none or a broken file, for numbers that the family does not take, and
        for an error in the function of a family.
    """
    reason = broken.get(text.partition(":")[0].strip().replace("-", "_"))
    if reason:
        raise InputError(what, text, reason)
    family, numbers = spec.split(text, what, known)
    if family not in families:  # a record, which takes no numbers
        spec.refuse_unknown(text, what, numbers, ())
    module = families[family]
    spec.refuse_unknown(text, what, numbers, list(module.DEFAULTS))
    try:
        return _made(module, family, make, tuple(sorted(numbers.items())))
    except InputError as error:  # about the name as it is kept
        raise InputError(what, text, error.allowed) from None
    except Exception as error:  # in a file of the user
        path = str(module.__file__)
        raise InputError(what, text, f"{path}: {described(error, path)}") from error


@lru_cache(maxsize=128)
def _made(
    module: ModuleType, family: str, make: str, numbers: tuple[tuple[str, float], ...]
) -> object:
    """One record for a name: what is prepared for it is found again by it."""
    given = {key: value for key, value in numbers if value != module.DEFAULTS[key]}
    words = ",".join(f"{key}={value:.12g}" for key, value in given.items())
    name = f"{family}:{words}" if words else family
    return getattr(module, make)(name, **(module.DEFAULTS | dict(numbers)))
