"""The parts that commands share which answer one question: options, refusals and output."""

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
"""Second names of options."""


class Answer(NamedTuple):
    """The answer to a question: for JSON, in words, and whether it is exit code 0."""

    plain: Any
    text: str
    complete: bool


def add_options(
    parser: Any, options: Mapping[str, tuple[str, str]], required: Iterable[str] = ()
) -> None:
    """Add options with a value to a parser or a group: metavar and help by name."""
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
    """Add the option of JSON output."""
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object and nothing else"
    )


def typed_options(options: argparse.Namespace) -> dict[str, Any]:
    """Values of the options that were typed, by their arguments."""
    return {name: getattr(options, name) for name in getattr(options, "said", {})}


def respond(
    command: str,
    options: argparse.Namespace,
    answer: Callable[[argparse.Namespace], Answer],
    titles: Mapping[str, str],
    arguments: Iterable[str] = (),
) -> int:
    """Print the answer to the options.

    titles: names of positional arguments in messages; arguments: those of Python that messages
    show as options.  Returns the exit code: 0 complete, 1 not complete, 2 bad input.
    """
    from microslip.sweeps.evaluate import plain

    try:
        found = answer(options)
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
    text = json.dumps(plain(found.plain)) if options.json else found.text
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"  # units may be no letters of it
    print(text.encode(encoding, "backslashreplace").decode(encoding))
    return 0 if found.complete else 1
