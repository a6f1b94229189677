"""Options, error messages and output of the commands that print one answer."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from microslip.app.option_parser import Said, format_as_options, option
from microslip.app.terminal import complain
from microslip.foundation.errors import CacheError, InputError, shown

OTHER_NAMES = {"nu": ("--poisson",), "poisson": ("--nu",)}
"""Alternative names of options."""


class Answer(NamedTuple):
    """The answer of a command.

    Attributes
    ----------
    plain : object
        The answer as JSON values.
    text : str
        The answer in words.
    complete : bool
        True for exit code 0.
    """

    plain: Any
    text: str
    complete: bool


def add_options(
    parser: Any, options: Mapping[str, tuple[str, str]], required: Iterable[str] = ()
) -> None:
    """Add options with a value to a parser or a group; options: metavar and help text by name."""
    for name, (metavar, text) in options.items():
        parser.add_argument(
            *(f"--{name}", *OTHER_NAMES.get(name, ())),
            dest=name.replace("-", "_"),
            action=Said,
            metavar=metavar,
            help=text,
            required=name in required,
        )


def add_json(parser: Any) -> None:
    """Add the option `--json`."""
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object and nothing else"
    )


def typed_options(options: argparse.Namespace) -> dict[str, Any]:
    """Values of the options on the command line, by the name of the argument."""
    return {name: getattr(options, name) for name in getattr(options, "said", {})}


def respond(
    command: str,
    options: argparse.Namespace,
    answer: Callable[[argparse.Namespace], Answer],
    titles: Mapping[str, str],
    arguments: Iterable[str] = (),
) -> int:
    """Print the answer to a command line, or an error message.

    Parameters
    ----------
    command : str
        Name of the command, for messages.
    options : argparse.Namespace
        The command line.
    answer : callable
        answer(options) -> Answer.
    titles : mapping of str
        Names of positional arguments in messages.
    arguments : iterable of str
        Python arguments that messages show as options.

    Returns
    -------
    int
        Exit code: 0 if the answer is complete, 1 if not, 2 for bad input.
    """
    from microslip.sweeps.evaluate import plain

    try:
        result = answer(options)
    except InputError as error:
        said, value = getattr(options, "said", {}), error.value
        if error.argument in said or error.argument in titles:
            value = getattr(options, error.argument)
        name = titles.get(error.argument) or said.get(error.argument) or option(error.argument)
        text = "" if error.value is None or error.value is True else f" = {shown(value)}"
        allowed = format_as_options(error.allowed, [] if error.argument == "table" else arguments)
        complain(" ".join(f"{command}: {name}{text}: {allowed}".split()))
        return 2
    except CacheError as error:
        complain(f"{command}: {error}")
        return 2
    text = json.dumps(plain(result.plain)) if options.json else result.text
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    # The encoding may lack letters of units.
    print(text.encode(encoding, "backslashreplace").decode(encoding))
    return 0 if result.complete else 1
