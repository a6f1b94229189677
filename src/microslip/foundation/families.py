"""Families of classes.  Each class has its own file, and each object has a text form.

Each class is a frozen dataclass whose fields are numbers with defaults.  The text of an object is
the name of its class, followed by the numbers that differ from their defaults, as in
"power:exponent=1".
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from traceback import extract_tb
from types import ModuleType
from typing import Any, Generic, TypeVar

from microslip.foundation import named_files, spec
from microslip.foundation.errors import InputError

T = TypeVar("T")


def modules_in(
    folder: str | os.PathLike, package: ModuleType, broken: dict[str, str]
) -> Iterator[tuple[str, ModuleType]]:
    """Name and module of each file in a folder.  The files become modules of the package.

    A file that cannot be imported is skipped, so that only commands with its name fail.  A file
    with the same name as a file in another folder is also skipped, because the name is ambiguous.

    Parameters
    ----------
    folder : str or path
        Folder of the package, or a user's folder.
    package : module
        Package to which the files are added as modules.
    broken : dict of str to str
        Dict to which the path and the error of each skipped file are added; the keys are the file
        names.
    """
    if str(folder) not in package.__path__:
        package.__path__.append(str(folder))
    for file in iter_modules([str(folder)]):
        if file.ispkg or not file.name.isidentifier():  # a copy or a checkpoint of a module
            continue
        path = Path(os.path.abspath(folder), f"{file.name}.py")
        try:
            module = import_module(f"{package.__name__}.{file.name}")
        except (Exception, SystemExit) as error:  # a user's code may raise anything
            broken[file.name] = f"{path} cannot be imported: {described(error, path)}"
            continue
        if not os.path.samefile(os.path.dirname(str(module.__file__)), folder):
            problem = f"{path}: {module.__file__} has the same name; allowed is another name"
            broken[file.name] = problem
            continue
        broken.pop(file.name, None)
        yield file.name, module


def described(error: BaseException, path: str | os.PathLike) -> str:
    """One line with the type of an error, the line number in the file at `path`, and the
    message."""
    lines = [
        frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path)
    ]
    message = str(error)
    if isinstance(error, SyntaxError) and error.filename == str(path):
        lines, message = [error.lineno], error.msg
    where = f" in line {lines[-1]}" if lines else ""
    return " ".join(f"{type(error).__name__}{where}: {message}".split())


class Registry(Generic[T]):
    """Classes by name, from the folders of a package and from users' folders.

    Parameters
    ----------
    package : module
        Package to which the files are added as modules.
    base : type
        Base class.
    argument : str
        Name of the argument in messages.
    first : sequence of str
        Names that are listed before all others.
    from_file : callable
        from_file(text) -> object, for names of data files such as "file:measured.csv".

    Attributes
    ----------
    classes : dict of str to type
        Classes by name.
    broken : dict of str to str
        Path and error of each file that cannot be used.
    """

    def __init__(
        self,
        package: ModuleType,
        base: type[T],
        argument: str,
        first: Sequence[str],
        from_file: Callable[[str], T],
    ):
        self.package, self.base, self.argument = package, base, argument
        self.first, self.from_file = first, from_file
        self.classes: dict[str, type[T]] = {}
        self.broken: dict[str, str] = {}
        self._own = list(package.__path__)
        for folder in self._own:
            self.find(folder)

    def find(self, folder: str | os.PathLike) -> None:
        """Register the classes in a folder.

        A file that cannot be used raises an InputError only when its name is requested.
        """
        modules = dict(modules_in(folder, self.package, self.broken))
        for file, module in modules.items():
            name = file.replace("_", "-")
            mine = [one for one in vars(module).values() if self._is_class_of(one, module)]
            named = [one for one in mine if spec.name_of(one) == name]
            if named:
                self.classes[name] = named[0]
            elif str(folder) not in self._own:
                title = file.title().replace("_", "")
                self.broken[file] = (
                    f"{module.__file__}: no {self.base.__name__} named {title} in it"
                )
        for file in self.broken:
            self.classes.pop(file.replace("_", "-"), None)
        listed = [name for name in self.first if name in self.classes]
        order = dict.fromkeys([*listed, *self.classes])
        self.classes.update({name: self.classes.pop(name) for name in order})

    def _is_class_of(self, one: object, module: ModuleType) -> bool:
        """True for a class of this family that the module defines."""
        return (
            isinstance(one, type)
            and issubclass(one, self.base)
            and one is not self.base
            and one.__module__ == module.__name__
        )

    def parse(self, text: str) -> T:
        """Return the object for a text such as "power:exponent=1" or "file:measured.csv".

        Raises
        ------
        InputError
            If the name is unknown, if its file cannot be used, or if the class lacks a parameter or
            refuses its value.
        """
        if named_files.speaks_of_file(text):
            return self.from_file(text)
        names = [*self.classes, "file"]
        if not isinstance(text, str):
            raise InputError(self.argument, text, f"allowed is one of {', '.join(names)}")
        reason = self.broken.get(text.partition(":")[0].strip().replace("-", "_"))
        if reason:
            raise InputError(self.argument, text, reason)
        if text == "file":
            raise InputError(
                self.argument, text, f"allowed after it is a colon and a name: {text}:NAME"
            )
        name, numbers = spec.split(text, self.argument, names)
        cls: Any = self.classes[name]
        spec.refuse_unknown(text, self.argument, numbers, [field.name for field in fields(cls)])
        try:
            return _shared_object(cls, tuple(sorted(numbers.items())))
        except InputError as error:  # its text omits default values
            raise InputError(self.argument, text, error.allowed) from None
        except Exception as error:  # in a user's file
            path = str(import_module(cls.__module__).__file__)
            raise InputError(self.argument, text, f"{path}: {described(error, path)}") from error


@lru_cache(maxsize=128)
def _shared_object(cls: type[T], numbers: tuple[tuple[str, float], ...]) -> T:
    """Return the object for these numbers.  Equal numbers share one object, including its cached
    properties."""
    return cls(**dict(numbers))
