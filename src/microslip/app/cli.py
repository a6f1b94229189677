"""The command line.  `microslip point MOTION ...` solves one point, and `microslip sweep` solves
many points."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from microslip import __version__
from microslip.app import option_parser
from microslip.app.question import SPIN, respond

COMMANDS = {
    "point": "macroscopic friction at one (velocity, amplitude)",
    "sweep": "the workflow: maps, datasets and figures, by Snakemake",
    "predict": "friction of a real contact, in SI units",
    "fit": "coefficient of friction and u_lim from measured friction",
    "response": "forces of a contact that follows the path of a file",
    "fold": "one period of a motion from a long record, such as that of a vibrometer",
    "export": "an Iwan model or a friction table of a contact, for other programs",
}
"""Commands, each with a help text.  The module NAME_command adds the options of a command."""
OWN_PARSERS = {"sweep": "sweep_command"}
"""Commands that parse their words themselves, each with its module."""


def build_parser(words: Sequence[str] = ()) -> option_parser.OneLineParser:
    """Return the parser of the command line `words`.  Only the first command gets its options."""
    parser = option_parser.OneLineParser(
        prog="microslip",
        description="How far friction falls when a frictional contact is vibrated: an elastic "
        "sphere on a flat (Hertz contact, Coulomb friction at every point) slides forward while "
        "it also oscillates or rotates.  point and sweep take dimensionless quantities, predict "
        f"takes units.  {SPIN}",
        epilog="Exit codes: 0 done, 1 not converged, 2 bad input, 74 the output cannot be written, "
        "130 interrupted, 141 broken pipe.  sweep returns Snakemake's code.",
    )
    parser.add_argument("--version", action="version", version=f"microslip {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, summary in COMMANDS.items():
        command = commands.add_parser(name, help=summary)
        if name in words[:1]:
            module = import_module(f"microslip.app.{name}_command")
            module.fill(command, *(words[1:2] if name == "point" else ()))
    return parser


def main(words: list[str]) -> int:
    """Run a command line.

    Parameters
    ----------
    words : list of str
        Words after the program name.

    Returns
    -------
    int
        0 if converged, 1 if not converged, 2 for bad input.  `sweep` returns the exit code of
        Snakemake.
    """
    command = next(iter(words), None)
    if command in OWN_PARSERS:
        return import_module(f"microslip.app.{OWN_PARSERS[command]}").main(words[1:])
    return respond(build_parser(words).parse_args(option_parser.joined(words)))
