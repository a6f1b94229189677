"""Compute how far friction falls when a frictional contact is vibrated.

An elastic sphere on a flat (Hertz contact, Coulomb friction at every point) slides forward while it
also oscillates or rotates.  The commands point and sweep take dimensionless quantities; predict
takes quantities with units.  Bore means spin: rotation about the contact normal.

Exit codes: 0 done, 1 not converged, 2 bad input, 74 the output cannot be written, 130 interrupted,
141 broken pipe.  sweep returns Snakemake's code.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

from microslip import __version__
from microslip.app.commands import COMMANDS
from microslip.app.parser import Option, Parser, message, option
from microslip.app.terminal import complain
from microslip.foundation.errors import CacheError, InputError
from microslip.foundation.named_files import problem_in_code

SOURCES = ("measured", "path", "record", "table")
"""Arguments that are paths of input files."""


def main(words: list[str]) -> int:
    """Run a command line.

    Parameters
    ----------
    words : list of str
        Words after the program name.

    Returns
    -------
    int
        Exit code: 0 if the answer is complete, 1 if it is incomplete, 2 for bad input.  `sweep`
        returns the exit code of Snakemake.
    """
    if words[:1] == ["sweep"]:
        from microslip.app import sweep  # late, as it imports what other commands do not need

        return sweep.main(words[1:])
    name = next((one for one in COMMANDS if words[: one.count(" ") + 1] == one.split()), None)
    if name is None:
        return _without_command(words)
    parser, words = parser_of(name), words[name.count(" ") + 1 :]
    if {"-h", "--help"} & set(words):
        parser.print_help_with("motions", COMMANDS[name].motions())
        return 0
    return _respond(name, parser.parse(words), parser.readers)


def _without_command(words: list[str]) -> int:
    """Print the list of commands, or an error message if the command is missing or unknown."""
    from microslip.app import sweep

    functions = {name: one.answer for name, one in COMMANDS.items()} | {"sweep": sweep.main}
    commands = {name: str(one.__doc__).partition("\n")[0] for name, one in functions.items()}
    usage = "%(prog)s [-h] [--version] COMMAND ..."
    parser = Parser(prog="microslip", usage=usage, description=__doc__)
    parser.add_argument("--version", action="version", version=f"microslip {__version__}")
    if {"-h", "--help"} & set(words):
        parser.print_help_with("commands, each with a --help of its own", commands)
        return 0
    if words and not words[0].startswith("-"):
        parser.refuse(f"COMMAND = {words[0]!r}", words[0], commands)
    parser.parse(words)  # prints the version
    parser.error(f"COMMAND is missing; allowed: {', '.join(commands)}")


def parser_of(name: str) -> Parser:
    """Return the parser of a command in COMMANDS."""
    command = COMMANDS[name]
    parser = Parser(prog=f"microslip {name}", description=command.answer.__doc__)
    for title, options in command.groups().items():
        group = parser.add_argument_group(title)
        for argument, one in options.items():
            parser.add(argument, one, None if one.is_place else group)
    text = "print one JSON object and nothing else"
    parser.add_argument("--json", action="store_true", help=text)
    return parser


def _respond(name: str, options: argparse.Namespace, readers: Mapping[str, Option]) -> int:
    """Print the answer to a parsed command line, or an error message.

    Returns the exit code: 0 if the answer is complete, 1 if it is incomplete, 2 for bad input.
    """
    spellings = options.spellings
    try:
        arguments = {n: readers[n].read(n, getattr(options, n)) for n in spellings}
        output, figure = arguments.get("output"), arguments.get("figure")
        sources = [Path(arguments[n]).resolve() for n in SOURCES if n in arguments]
        if output is not None and Path(output).resolve() in sources:
            allowed = "allowed is another file than the table that is read"
            raise InputError("output", output, allowed)
        answer = COMMANDS[name].answer(**arguments).write(output, figure)
    except Exception as error:
        problem = str(error) if isinstance(error, CacheError) else problem_in_code(error)
        if isinstance(error, InputError):
            argument = spellings.get(error.argument, option(error.argument))
            value = getattr(options, error.argument) if error.argument in spellings else error.value
            names = () if error.argument == "table" else readers
            problem = message(argument, value, error.allowed, names)
        if not problem:
            raise
        complain(f"microslip {name}: {problem}")
        return 2
    answer.print(options.json)
    return 0 if answer.complete else 1
