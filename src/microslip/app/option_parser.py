"""Parsing of command lines.  Bad input gives one line on standard error and exit code 2."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

from microslip.app.terminal import complain
from microslip.foundation.spec import near_miss

SYNONYMS = {"--speed": "--velocity", "--velocity": "--speed"}
"""Options that have another name in another command."""

NEGATIVE = re.compile(r"-\s*([0-9.,]|inf|nan)", re.IGNORECASE)
"""Pattern of the first characters of a negative number.  No option matches it."""


class OneLineParser(argparse.ArgumentParser):
    """Argument parser that reports bad input in one line on standard error, with exit code 2.

    Options cannot be abbreviated.  The arguments are those of `argparse.ArgumentParser`.
    """

    def __init__(self, **settings: Any):
        super().__init__(**settings, allow_abbrev=False)

    def error(self, message: str) -> NoReturn:
        if message.startswith("unrecognized arguments"):
            message += "; allowed: options, each with one value, in quotes if it has a space"
        complain(f"{self.prog}: {message} (see {self.prog} --help)")
        raise SystemExit(2)

    def parse_known_args(  # type: ignore[override]  # overloaded for every namespace
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple:
        args = sys.argv[1:] if args is None else args
        self._refuse_strange_words(args)
        return super().parse_known_args(args, namespace)

    def _refuse_strange_words(self, words: Sequence[str]) -> None:
        """Refuse unknown words before argparse does, because argparse would report a missing
        argument."""
        candidates = self._option_string_actions
        commands = [a for a in self._actions if a.nargs == argparse.PARSER]
        named: dict[str, list[str]] = {}
        for word in words:
            if commands and not word.startswith("-"):
                return self._refuse_command(word, commands[0])
            name = word.partition("=")[0]
            strange = word.startswith("-") and name.strip("-") and name not in candidates
            if strange and not NEGATIVE.match(word):
                self._refuse_option(name, [n for n in candidates if n.startswith("--")])
            if name in candidates:
                self._refuse_second(name, named.setdefault(candidates[name].dest, []))
        if commands and not {"-h", "--help", "--version"} & set(words):
            (command,) = commands
            self.error(f"{command.metavar} is missing; allowed: {', '.join(command.choices or ())}")

    def _refuse_second(self, name: str, names: list[str]) -> None:
        """Refuse a repeated option, unless it is a flag or collects several values.

        names: spellings of this option on the command line so far.
        """
        action = self._option_string_actions[name]
        names.append(name)
        if len(names) > 1 and action.nargs != 0 and not isinstance(action, argparse._AppendAction):
            same = "" if names[0] == name else f", as {names[0]} the first time"
            self.error(f"{name} is given twice{same}; allowed: once")

    def _refuse_command(self, word: str, command: argparse.Action) -> None:
        choices = list(command.choices or ())
        if word not in choices:
            allowed = f"allowed is one of {', '.join(choices)}"
            self.error(f"{command.metavar} = {word!r}: {_hint(word, choices)}{allowed}")

    def _refuse_option(self, name: str, candidates: list[str]) -> None:
        hint = _hint(f"--{name.lstrip('-')}", candidates)
        first = [action.metavar for action in self._actions if action.nargs == argparse.PARSER]
        allowed = ", ".join(
            [*candidates, *(f"{command} before other options" for command in first)]
        )
        self.error(f"unknown option {name}; {hint}allowed: {allowed}")


def _hint(name: str, candidates: Sequence[str]) -> str:
    """Return 'did you mean NAME? ', or '' if nothing is similar.

    NAME is the option with the same meaning, or else the most similar candidate.
    """
    synonym = SYNONYMS.get(name)
    return f"did you mean {synonym}? " if synonym in candidates else near_miss(name, candidates)


def option(argument: str) -> str:
    """Return the option for a Python argument, such as --contact-radius for contact_radius.  An
    environment variable, in capitals, is returned unchanged."""
    return argument if argument.isupper() else f"--{argument.replace('_', '-')}"


def format_as_options(text: str, arguments: Iterable[str] = ()) -> str:
    """Replace the Python arguments in a message by options.

    Of the names without an underscore, only `decimal` and `encoding` are replaced, because the
    others are also ordinary words.
    """
    text = re.sub(r"\b(decimal|encoding) = ", r"--\1 ", text)
    names = "|".join(name for name in arguments if "_" in name)
    if not names:
        return text
    return re.sub(rf"(?:\ba )?\b({names})\b", lambda match: option(match[1]), text)


class StoreSpelling(argparse.Action):
    """Action that stores a value, and the option as spelled on the command line.

    The spelling of a positional argument is its metavar.
    """

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        value: object,
        option_string: str | None = None,
    ) -> None:
        setattr(namespace, self.dest, value)
        spelling = option_string or self.metavar
        namespace.spellings = getattr(namespace, "spellings", {}) | {self.dest: spelling}


def joined(arguments: list[str]) -> list[str]:
    """Join each negative number to its option, as in --velocity=-1e-3.

    Otherwise argparse would read the number as an option.
    """
    out: list[str] = []
    for word in arguments:
        if NEGATIVE.match(word) and out and out[-1].startswith("--") and "=" not in out[-1]:
            out[-1] += f"={word}"
        else:
            out.append(word)
    return out
