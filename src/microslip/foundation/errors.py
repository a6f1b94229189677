"""Errors that callers can handle: invalid input, a failure of the solver, or an unusable results
folder."""

from __future__ import annotations

import errno
import os

NO_WRITING = (errno.ENOSPC, errno.EDQUOT, errno.EROFS)
"""Error numbers of the operating system.  For these errors, the message of the system makes the
remedy clear."""

LONGEST = 400
"""Largest length of a value in a message, in characters.  The middle of a longer value is
omitted."""


class InputError(ValueError):
    """An invalid argument.

    The message is one line, "argument = value: what is allowed".  Functions that catch the error
    can adapt the message.  Such a function replaces the argument by the name of an option, or the
    value by the quantity as the user wrote it.

    Attributes
    ----------
    argument : str
        Name of the argument, as the Python function spells it.
    value : object
        Value of the argument, unchanged.
    allowed : str
        The allowed values, and the reason why this value is not allowed.
    """

    def __init__(self, argument: str, value: object, allowed: str):
        self.argument, self.value, self.allowed = argument, value, allowed
        super().__init__(argument, value, allowed)  # for copy and pickle

    def __str__(self) -> str:
        return " ".join(f"{self.argument} = {shown(self.value)}: {self.allowed}".split())

    def renamed(self, argument: str, value: object = None) -> InputError:
        """Return a copy of the error that refers to another argument.  If `value` is not None, it
        replaces the value of the error in the copy."""
        return InputError(argument, self.value if value is None else value, self.allowed)


class SolverError(RuntimeError):
    """The solver failed at a point.  Either a step could not be solved, or tractions are not
    finite.

    This is the only error that leaves a gap in a dataset.  The error message becomes the `reason`
    of the point.
    """


class CacheError(RuntimeError):
    """The results folder cannot be used.  The message is one line with the remedy."""


def shown(value: object) -> str:
    """Return a string that represents a value in messages: the shortened repr, or the type if repr
    fails."""
    try:
        text = repr(value)
    except Exception as error:  # an integer of thousands of digits, or a user's class
        text = f"<{type(value).__name__} that cannot be written: {type(error).__name__}>"
    half = LONGEST // 2
    return text if len(text) <= LONGEST else f"{text[:half]}...{text[-half:]}"


def described(error: BaseException, path: str | os.PathLike) -> str:
    """Describe an error in one line: its type, the function and the line number in the file at
    `path`, and the message."""
    places, message = places_in(error, path), str(error)
    if isinstance(error, SyntaxError) and error.filename == str(path):
        places, message = [f"line {error.lineno}"], error.msg
    where = f" in {places[-1]}" if places else ""
    return " ".join(f"{type(error).__name__}{where}: {message}".split())


def places_in(error: BaseException, path: str | os.PathLike) -> list[str]:
    """Return the entries of an error's traceback that are in the file at `path`, such as
    "displacement, line 9"."""
    from traceback import extract_tb  # late, since its import takes a while

    frames = (one for one in extract_tb(error.__traceback__) if one.filename == str(path))
    return [f"{one.name}, line {one.lineno}".removeprefix("<module>, ") for one in frames]
