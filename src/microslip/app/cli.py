"""The command line.  `microslip point MOTION ...` solves one point, and `microslip sweep` solves
many points."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from collections.abc import Callable
from dataclasses import fields
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from microslip import __version__
from microslip.app import option_parser, terminal
from microslip.app.question import add_json, add_options
from microslip.foundation import spec
from microslip.foundation.errors import CacheError, InputError

if TYPE_CHECKING:
    from microslip.adaptive.result import Result
    from microslip.motions.motion import Motion
    from microslip.solver.discretise import Resolution

COMMANDS = {
    "predict": "friction of a real contact, in SI units",
    "fit": "coefficient of friction and u_lim from measured friction",
    "propulsion": "a self-propelled motion: stall force, no-load velocity, efficiency",
    "response": "forces of a contact that follows the path of a file",
    "fold": "one period of a motion from a long record, such as that of a vibrometer",
    "export": "an Iwan model or a friction table of a contact, for other programs",
}
"""Commands that have their own module in this package, each with a help text."""
BORE = "Bore means spin: rotation about the contact normal."


def build_parser(selected: str | None = None) -> option_parser.OneLineParser:
    """Return the parser of the command line.  Only the command `selected` gets its options."""
    parser = option_parser.OneLineParser(
        prog="microslip",
        description="How far friction falls when a frictional contact is vibrated: an elastic "
        "sphere on a flat (Hertz contact, Coulomb friction at every point) slides forward while "
        "it also oscillates or rotates.  point and sweep take dimensionless quantities, predict "
        f"takes units.  {BORE}",
        epilog="Exit codes: 0 done, 1 not converged, 2 bad input, 74 the output cannot be written, "
        "130 interrupted, 141 broken pipe.  sweep returns Snakemake's code.",
    )
    parser.add_argument("--version", action="version", version=f"microslip {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    point = commands.add_parser(
        "point",
        help="macroscopic friction at one (velocity, amplitude)",
        description="Mean forward friction force divided by mu F_z at one point, with an error "
        "estimate.  mu_macro is a ratio: 1 if the vibration has no effect, 0 if no friction "
        "remains.  The apparent coefficient of friction is mu_apparent = mu mu_macro.  "
        f"{BORE}",
    )
    commands.add_parser("sweep", help="the workflow: maps, datasets and figures, by Snakemake")
    commands.add_parser("gc", help="list or remove results that no configuration requests")
    if selected == "point":
        _add_motions(point)
    else:
        point.add_argument("motion", metavar="MOTION")
    for name, summary in COMMANDS.items():
        command = commands.add_parser(name, help=summary)
        if name == selected:
            _module_of(name).fill(command)
    return parser


def _module_of(command: str) -> ModuleType:
    return import_module(f"microslip.app.{command}_command")


def _add_motions(parser: argparse.ArgumentParser) -> None:
    """Add a parser for each motion.  This imports the motions."""
    from microslip.motions.by_name import MOTIONS
    from microslip.motions.samples import Sampled

    motions = parser.add_subparsers(dest="motion", required=True, metavar="MOTION")
    records: dict[str, type[Motion]] = {**MOTIONS, "file": Sampled}
    for name, record in records.items():
        numbers, spin = "", f"  {BORE}" if "bore" in name else ""
        if name == "file":
            numbers = FILE
        elif fields(record):
            numbers = record.numbers or f"of {', '.join(field.name for field in fields(record))}"
            numbers = f"  Numbers follow the name after a colon: {numbers}."
        motion = motions.add_parser(
            name,
            help=record.summary,
            description=f"The indenter is {record.summary}. u_lim: the tangential displacement at "
            "which the whole contact slides; a: contact radius; phi_lk(a/2): the angle at which "
            f"the stick radius is a/2.{numbers}{spin}",
        )
        motion.add_argument(
            "--velocity",
            metavar="V",
            help=f"{record.velocity_label}; 0 means v -> 0; below 0 only if self-propelled; omit "
            "it with --force",
        )
        if record.periodic:
            motion.add_argument(
                "--amplitude", required=True, metavar="A", help=record.amplitude_label
            )
        _add_options(motion)


FILE = (
    "  The path of a CSV file follows the name after a colon, as in file:stroke.csv.  The file has "
    "one or more of the columns forward, lateral, angle, and load or indentation.  Its rows are "
    "equally spaced in time and cover one period, without the end point."
)
"""Help text about motion files."""
F_Z = "; F_z is the load without oscillation (the reference load)"
OPTIONS = {
    "force": (
        "P",
        "prescribed force in place of a velocity, divided by mu times the mean normal load; the "
        "result is the velocity",
    ),
    "stiffness": (
        "K",
        f"stiffness of a spring whose far end has the velocity, divided by mu F_z / u_lim{F_Z}",
    ),
    "mass": (
        "M",
        f"mass of a body on a spring or under a force, divided by mu F_z / (u_lim omega^2){F_Z} "
        "(0)",
    ),
    "damping": ("C", f"damping parallel to the spring, divided by mu F_z / (u_lim omega){F_Z} (0)"),
    "contacts": (
        "TEXT",
        "several contacts of one body, such as 'phase=0;phase=180'.  Each contact has a load "
        "relative to the others (1), a phase in degrees (0) and an amplitude divided by A (1)",
    ),
    "pressure": (
        "NAME",
        "hertz (a sphere), power:exponent=1 (a cone; any power), punch:flat=0.8 (rounded edge), "
        "ring:inner=0.5, ellipse:ratio=0.5 (across=1: long axis across), or file:FILE, a grid of "
        "forward,lateral,pressure, CSV or netCDF: means over cells, or with "
        "file:FILE,grid=samples values at points (hertz)",
    ),
    "poisson": ("NU", "Poisson's ratio, 0 to 0.5 (0)"),
    "model": (
        "NAME",
        "auto (the cheapest valid model), rigid, slider, dahl, mdr, radial, polar or cartesian",
    ),
    "tolerance": (
        "T",
        "largest accepted absolute error of mu_macro, or under a force of the velocity, relative "
        "above 1 (1e-3); none: accept any error, with imposed cells and steps",
    ),
    "cells": ("N", "impose N rings, or N x N squares (even, at least 4)"),
    "steps": ("N", "impose N steps per period (even)"),
    "time-limit": (
        "SECONDS",
        "stop after this time, checked between two runs; the result is then not stored",
    ),
    "method": (
        "NAME",
        "another numerical method, for comparison: a file name in microslip/solver/methods",
    ),
    "results": (
        "FOLDER",
        "look the result up in a folder of results, such as that of a sweep, and store it there",
    ),
}
DEFAULTS = {"pressure": "hertz", "poisson": "0", "model": "auto", "tolerance": "1e-3"}
DEFAULTS["method"] = "shipped"
DRIVE = ("force", "stiffness", "mass", "damping")
REALS = ("velocity", "amplitude", "poisson", "tolerance", *DRIVE)


def _add_options(parser: argparse.ArgumentParser) -> None:
    add_options(parser, OPTIONS)
    parser.set_defaults(**DEFAULTS)
    add_json(parser)


def main(arguments: list[str] | None = None) -> int:
    """Entry point.

    Parameters
    ----------
    arguments : list of str, optional
        Words after the program name.  By default, the words from the command line of this process
        are used, and signals end the process (see microslip.app.terminal).

    Returns
    -------
    int
        0 if converged, 1 if not converged, 2 for bad input.  `sweep` returns the exit code of
        Snakemake.
    """
    if arguments is None:
        words = sys.argv[1:]
        return terminal.run(lambda: main(words), stoppable=words[:1] != ["sweep"])
    if arguments[:1] == ["gc"]:
        from microslip.app import leftovers

        return leftovers.main(arguments[1:])
    if arguments[:1] == ["sweep"]:  # all further words are for Snakemake
        from microslip.app import sweep_command

        return sweep_command.main(arguments[1:])
    if arguments[:1] == ["point"]:
        problem = _problem_of_motion(arguments[1:2])
        if problem:
            terminal.complain(f"microslip point: {problem}")
            return 2
    words, motion = _split_motion(arguments)
    options = build_parser(next(iter(words), None)).parse_args(option_parser.joined(words))
    if options.command in COMMANDS:
        return _module_of(options.command).run(options)
    command = f"microslip point {options.motion}"
    options.motion = motion
    try:
        with _bar() as bar:
            progress = None if bar is None else lambda resolution: _show(bar, resolution)
            result = _answer(options, progress)
    except InputError as error:
        problem = error.renamed(*_option_of(options, error.argument))
        missing = f"{problem.argument}: needed; {problem.allowed}"
        terminal.complain(f"{command}: {missing if problem.value is None else problem}")
        return 2
    except CacheError as error:
        terminal.complain(f"{command}: --results: {error}")
        return 2
    except ValueError as error:
        terminal.complain(f"{command}: {error}")
        return 2
    if options.json:
        from microslip.sweeps.evaluate import plain

        print(json.dumps({"amplitude": None} | plain(result.to_dict())))
    else:
        from microslip.app.point_text import as_text  # late, since it imports the models

        print(as_text(result))
    return 0 if result.converged else 1


def _problem_of_motion(words: list[str]) -> InputError | None:
    """Return an InputError if the file of the named motion cannot be used, and None otherwise."""
    from microslip.motions.by_name import BROKEN

    name = words[0].partition(":")[0] if words else ""
    reason = BROKEN.get(name.replace("-", "_"))
    return None if reason is None else InputError("MOTION", words[0], reason)


def _split_motion(words: list[str]) -> tuple[list[str], str]:
    """Reduce the motion in a command line to its bare name.  Return the new words and the original
    motion.

    The parser accepts only bare names, such as elliptic for elliptic:forward=0.5.  Words of other
    commands are unchanged.
    """
    if words[:1] != ["point"] or len(words) < 2:
        return words, ""
    from microslip.motions.by_name import MOTIONS

    name = words[1].partition(":")[0]
    return ["point", name if name in (*MOTIONS, "file") else words[1], *words[2:]], words[1]


def _option_of(options: argparse.Namespace, argument: str) -> tuple[str, object]:
    """Return the option for an argument of `solve`, and its text on the command line."""
    if argument == "motion":
        return "MOTION", options.motion
    spelling = getattr(options, "spellings", {}).get(argument, option_parser.option(argument))
    return spelling, getattr(options, argument, None)


def _answer(options: argparse.Namespace, progress: Callable[[Resolution], None] | None) -> Result:
    """Compute the result for the options.  Raises InputError and CacheError, like
    microslip.solve_stored."""
    texts = {name: getattr(options, name, None) for name in REALS}
    numbers: dict[str, Any] = {
        name: spec.read(name, text) for name, text in texts.items() if text not in (None, "none")
    }
    numbers.setdefault("tolerance", None)
    if options.time_limit is not None:
        numbers["time_limit"] = spec.read("time_limit", options.time_limit)
    for name in ("cells", "steps"):
        text = getattr(options, name)
        numbers[name] = None if text is None else spec.read(name, text, whole=True)
    if options.results is not None and options.method != "shipped":
        allowed = "allowed is shipped with --results, which stores points of sweeps"
        raise InputError("method", options.method, allowed)
    numbers.setdefault("velocity", None)
    import microslip  # late: --help and bad options need no solver

    settings = {"motion": options.motion, "pressure": options.pressure, "model": options.model}
    settings |= numbers
    if options.contacts is not None:
        settings["contacts"] = options.contacts
    if options.results is None:
        return microslip.solve(**settings, method=options.method, progress=progress)
    return microslip.solve_stored(**settings, results=options.results)


def _bar() -> contextlib.AbstractContextManager[Any]:
    """Context manager that shows a progress line with the number of runs.  It yields None if
    standard error is not a terminal."""
    if not sys.stderr.isatty():
        return contextlib.nullcontext()
    from tqdm import tqdm

    return tqdm(unit=" runs", leave=False, delay=0.1)


def _show(bar: Any, resolution: Resolution) -> None:
    cells, angles, steps = resolution.cells, resolution.angles, resolution.steps
    bar.set_description(f"{cells} cells, {angles} angles, {steps} steps")
    bar.update()


if __name__ == "__main__":
    raise SystemExit(main())
