"""The one kind of error for bad input: it carries what was given and what is allowed."""

from __future__ import annotations


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

    def __str__(self):
        return " ".join(f"{self.argument} = {self.value!r}: {self.allowed}".split())

    def renamed(self, argument: str, value: object = None) -> InputError:
        """The same about another argument, and another value unless that is None."""
        return InputError(argument, self.value if value is None else value, self.allowed)
