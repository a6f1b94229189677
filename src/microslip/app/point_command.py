"""The command `microslip point`: friction at one point, in dimensionless quantities."""

from __future__ import annotations

import argparse
import contextlib
import sys
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from microslip.app.question import SPIN, Answer, add_answer, add_options, typed_options

if TYPE_CHECKING:
    from microslip.motions.motion import Motion
    from microslip.solver.discretise import Resolution

FILE = (
    "  The path of a CSV file follows the name after a colon, as in file:stroke.csv.  The file has "
    "one or more of the columns forward, lateral, angle, and load or indentation.  Its rows are "
    "equally spaced in time and cover one period, without the end point.  The path of a Python "
    "file with a class of your own stands alone, as in mine/soft_square.py:share=0.5."
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
        "stop after this time, checked between two runs",
    ),
    "method": (
        "NAME",
        "another numerical method, for comparison: a file name in microslip/solver/methods",
    ),
}
"""Options for all motions, each with a metavar and a help text."""
REALS = ("velocity", "amplitude", "force", "stiffness", "mass", "damping", "poisson", "time_limit")
WHOLES = ("cells", "steps")


def fill(parser: argparse.ArgumentParser, text: str = "") -> None:
    """Add the description of `point` to its parser, and a parser for each motion.

    text: the motion on the command line, as in elliptic:forward=0.5.
    """
    from microslip.foundation.named_files import speaks_of_module
    from microslip.motions.by_name import MOTIONS
    from microslip.motions.samples import Sampled

    parser.description = (
        "Mean forward friction force divided by mu F_z at one point, with an error estimate.  "
        "mu_macro is a ratio: 1 if the vibration has no effect, 0 if no friction remains.  The "
        f"apparent coefficient of friction is mu_apparent = mu mu_macro.  {SPIN}"
    )
    requested = "file" if speaks_of_module(text) else text.partition(":")[0]
    motions = parser.add_subparsers(dest="motion", required=True, metavar="MOTION")
    records: dict[str, type[Motion]] = {**MOTIONS, "file": Sampled}
    for name, record in records.items():
        numbers, spin = "", f"  {SPIN}" if "bore" in name else ""
        if name == "file":
            numbers = FILE
        elif fields(record):
            numbers = record.numbers or f"of {', '.join(field.name for field in fields(record))}"
            numbers = f"  Numbers follow the name after a colon: {numbers}."
        motion = motions.add_parser(
            name,
            aliases=[text] if name == requested != text else [],
            help=record.summary,
            description=f"The indenter is {record.summary}. u_lim: the tangential displacement at "
            "which the whole contact slides; a: contact radius; phi_lk(a/2): the angle at which "
            f"the stick radius is a/2.{numbers}{spin}",
        )
        place = {
            "velocity": (
                "V",
                f"{record.velocity_label}; 0 means v -> 0; below 0 only if self-propelled; omit "
                "it with --force",
            )
        }
        if record.periodic:
            place["amplitude"] = ("A", record.amplitude_label)
        add_options(motion, place | OPTIONS, required=("amplitude",))
        add_answer(motion, _answer)
        motion.set_defaults(spellings={"motion": "MOTION"})


def _answer(options: argparse.Namespace) -> Answer:
    free = options.tolerance == "none"
    arguments = typed_options(options, (*REALS, *["tolerance"] * (not free)), WHOLES)
    if free:
        arguments["tolerance"] = None
    import microslip  # late: --help and bad options need no solver

    with _bar() as bar:
        progress = None if bar is None else lambda resolution: _show(bar, resolution)
        result = microslip.solve(options.motion, **arguments, progress=progress)
    return Answer({"amplitude": None} | result.to_dict(), str(result), result.converged)


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
