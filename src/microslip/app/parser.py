"""Parsing of command lines.  Bad input is reported in one line on standard error, with exit code
2."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any, NamedTuple, NoReturn

from microslip.app.terminal import complain
from microslip.foundation.errors import shown
from microslip.foundation.spec import near_miss

SYNONYMS = {"--speed": "--velocity", "--velocity": "--speed"}
"""Options that have a different name in another command."""
SECOND_NAMES = {"nu": ["--poisson"], "poisson": ["--nu"]}
"""Second names of options, keyed by argument."""
NEGATIVE = re.compile(r"-\s*([0-9.,]|inf|nan)", re.IGNORECASE)
"""Pattern of the first characters of a negative number.  No option matches it."""


class Option(NamedTuple):
    """An option that takes a value, or a positional argument.

    Attributes
    ----------
    metavar, help : str
        Placeholder of the value in the help text, and the help text.
    read : callable
        read(argument, text) converts a string to a value, or raises InputError about the argument.
    is_place : bool
        True for a positional argument.
    """

    metavar: str
    help: str
    read: Callable[[str, str], Any] = lambda argument, text: text
    is_place: bool = False


class Parser(argparse.ArgumentParser):
    """Argument parser that reports bad input in one line.  Options cannot be abbreviated.

    Attributes
    ----------
    readers : dict of Option
        All options and positional arguments, keyed by Python argument.
    """

    def __init__(self, **settings: Any):
        super().__init__(**settings, allow_abbrev=False)
        self.set_defaults(spellings={})
        self.readers: dict[str, Option] = {}

    def error(self, message: str) -> NoReturn:
        complain(f"{self.prog}: {message} (see {self.prog} --help)")
        raise SystemExit(2)

    def add(self, name: str, one: Option, group: Any = None) -> None:
        """Add the option or the positional argument for a Python argument."""
        self.readers[name] = one
        names = [name] if one.is_place else [option(name), *SECOND_NAMES.get(name, ())]
        words: dict[str, Any] = {} if one.is_place else {"dest": name}
        words |= {"metavar": one.metavar, "help": one.help.replace("%", "%%")}
        (group or self).add_argument(*names, **words, action=_Store)

    def print_help_with(self, title: str, texts: Mapping[str, str]) -> None:
        """Print the help text with a list of names and their descriptions."""
        self.usage = self.usage or self.format_usage().removeprefix("usage: ")
        group = self.add_argument_group(title)
        for name, text in texts.items():
            group.add_argument(name, nargs="?", help=text.replace("%", "%%"))
        self.print_help()

    def parse(self, words: list[str]) -> argparse.Namespace:
        """Parse the words of a command line.  The attribute `spellings` of the result maps each
        argument to its option as written on the command line."""
        options, others = self.parse_known_args(_joined(words))
        for word in others:
            if word.startswith("-"):
                known = [one for one in self._option_string_actions if one.startswith("--")]
                name = word.partition("=")[0]
                self.refuse(f"unknown option {name}", name, known)
        if others:
            allowed = "allowed: options, each with one value, in quotes if it has a space"
            self.error(f"unrecognized arguments: {' '.join(others)}; {allowed}")
        return options

    def refuse(self, problem: str, word: str, allowed: Collection[str]) -> NoReturn:
        """End the process with an error message about a word of the command line.  The message
        suggests the most similar allowed word."""
        synonym = SYNONYMS.get(word, "")
        hint = f"did you mean {synonym}? " if synonym in allowed else near_miss(word, allowed)
        self.error(f"{problem}; {hint}allowed: {', '.join(allowed)}")


class _Store(argparse.Action):
    """Action that stores a value and the spelling of its option, and refuses a second value."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        spelling = option_string or self.metavar
        if first := namespace.spellings.get(self.dest):
            same = "" if first == spelling else f", as {first} the first time"
            parser.error(f"{spelling} is given twice{same}; allowed: once")
        namespace.spellings[self.dest] = spelling
        setattr(namespace, self.dest, values)


def option(argument: str) -> str:
    """Return the option of a Python argument, such as --contact-radius for contact_radius.  A name
    in capitals, which is an environment variable, is returned unchanged."""
    return argument if argument.isupper() else f"--{argument.replace('_', '-')}"


def message(argument: str, value: object, allowed: str, names: Iterable[str]) -> str:
    """Return a one-line error message about an argument.  A value of None is omitted.  Python
    arguments that are in `names` are replaced by options."""
    text = "" if value is None else f" = {shown(value)}"
    return " ".join(f"{argument}{text}: {with_options(allowed, names)}".split())


def with_options(text: str, arguments: Iterable[str] = ()) -> str:
    """Replace the Python arguments in a message by options.

    Among the names without an underscore, only `decimal` and `encoding` are replaced, because the
    other names are also ordinary words.
    """
    text = re.sub(r"\b(decimal|encoding) = ", r"--\1 ", text)
    names = "|".join(name for name in arguments if "_" in name) or "(?!)"
    return re.sub(rf"(?:\ba )?\b({names})\b", lambda match: option(match[1]), text)


def _joined(words: list[str]) -> list[str]:
    """Join each negative number to its option, as in --velocity=-1e-3.

    Otherwise argparse would read the number as an option.
    """
    joined: list[str] = []
    for word in words:
        if joined and re.fullmatch("--[^=]*", joined[-1]) and NEGATIVE.match(word):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined
