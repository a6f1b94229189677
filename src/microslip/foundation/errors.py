"""Errors that callers handle: bad input, a failure of the solver, an unusable results folder."""

from __future__ import annotations

import errno

NO_WRITING = (errno.ENOSPC, errno.EDQUOT, errno.EROFS)
"""Errors of the system that say by themselves what the user is to mend."""

LONGEST = 400
"""Characters of a value that a message shows; of a longer one its beginning and its end."""


class InputError(ValueError):
    """An argument that cannot be used.

    Its text is one line, "argument = value: what is allowed".  Layers above read the attributes,
    never the text: the command line names its option, predict the quantity as it was given.

    Attributes
    ----------
    argument : str
        Name of the argument, as the Python function spells it.
    value : object
        What was given for it, as it was given.
    allowed : str
        What is allowed instead, and why this is not.
    """

    def __init__(self, argument: str, value: object, allowed: str):
        self.argument, self.value, self.allowed = argument, value, allowed
        super().__init__(argument, value, allowed)  # what copying and pickling hand on

    def __str__(self) -> str:
        return " ".join(f"{self.argument} = {shown(self.value)}: {self.allowed}".split())

    def renamed(self, argument: str, value: object = None) -> InputError:
        """A copy about another argument, and with another value unless that is None."""
        return InputError(argument, self.value if value is None else value, self.allowed)


class SolverError(RuntimeError):
    """The solver failed at a point: a step stays unsolved, or tractions are not finite.

    Only this error becomes a gap in a dataset.  Its message is the reason that the point gives.
    """


class CacheError(RuntimeError):
    """The results folder cannot be used. The message is one line that says what to do."""


def shown(value: object) -> str:
    """A value as messages show it: its repr, shortened, or its type where Python writes none."""
    try:
        text = repr(value)
    except Exception as error:  # of a whole number with thousands of digits, or anybody's own
        text = f"<{type(value).__name__} that cannot be written: {type(error).__name__}>"
    half = LONGEST // 2
    return text if len(text) <= LONGEST else f"{text[:half]}...{text[-half:]}"
