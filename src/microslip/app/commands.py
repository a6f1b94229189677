"""Table of the commands that compute one answer: names, help texts, options and functions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

from microslip.app import answers
from microslip.app.answer import Answer, opened_map, output_file
from microslip.app.parser import Option
from microslip.foundation import spec


class Command(NamedTuple):
    """A command that computes one answer.

    Attributes
    ----------
    answer : callable
        Function that computes the answer.  Its arguments are those of the command line, and its
        docstring is the help text.
    options : dict of Option
        Positional arguments and options, keyed by Python argument.
    inputs : str
        Groups and names of INPUTS that are additional options.  A name after a minus sign is
        excluded.
    motions : callable
        motions() returns the description of each motion, for the help text.
    """

    answer: Callable[..., Answer]
    options: Mapping[str, Option]
    inputs: str = ""
    motions: Callable[[], dict[str, str]] = dict

    def groups(self) -> dict[str, dict[str, Option]]:
        """Return all options, keyed by Python argument and grouped by heading in the help text."""
        groups: dict[str, dict[str, Option]] = {}
        if words := self.inputs.split():
            from microslip.si.inputs import INPUTS  # late, since it imports NumPy

            for name, one in INPUTS.items():
                if (name in words or one.group in words) and f"-{name}" not in words:
                    option = Option(name.upper(), one.help)
                    option = option._replace(read=opened_map) if name == "map" else option
                    groups.setdefault(one.group, {})[name] = option
        return groups | {"options of this command": dict(self.options)}


def real_or_none(argument: str, text: str) -> float | None:
    """Read a number, or None for the string "none"."""
    return None if text == "none" else spec.read(argument, text)


real, whole = partial(Option, read=spec.read), partial(Option, read=partial(spec.read, whole=True))
place = partial(Option, is_place=True)
MOTION = place("MOTION", "the motion")
FILE_FORMAT = {
    "decimal": Option("MARK", "decimal mark of the file, a point or a comma (.)"),
    "encoding": Option("NAME", "encoding of the file, such as cp1252 (utf-8)"),
}
FIGURE = Option("FILE", "figure of friction, .png or .pdf", output_file(".png", ".pdf"))
CSV_FILE = Option("FILE", "write a .csv file", output_file(".csv"))
EXACT = Option("FILE", "write all columns to a .csv or .nc file", output_file(".csv", ".nc"))

COMMANDS = {
    "point": Command(
        answers.point,
        {
            "motion": MOTION,
            "velocity": real("V", "velocity; 0 means v -> 0; omit it with --force"),
            "amplitude": real("A", "amplitude, for a motion that oscillates"),
            "force": real("P", "in place of a velocity, over mu times the mean normal load"),
            "stiffness": real("K", "stiffness of a spring that pulls, over mu F_z / u_lim"),
            "mass": real("M", "mass on a spring or under a force, over mu F_z / (u_lim omega^2)"),
            "damping": real("C", "damping parallel to the spring, over mu F_z / (u_lim omega)"),
            "pressure": Option(
                "NAME",
                "hertz, power:exponent=1 (a cone), punch:flat=0.8, "
                "ring:inner=0.5, ellipse:ratio=0.5 (across=1: long axis across), or file:FILE, a "
                "grid of forward,lateral,pressure, CSV or netCDF (hertz)",
            ),
            "poisson": real("NU", "Poisson's ratio, 0 to 0.5 (0)"),
            "model": Option("NAME", "auto, rigid, slider, dahl, mdr, radial, polar or cartesian"),
            "tolerance": Option(
                "T",
                "largest accepted error of mu_macro, or of the velocity under a force (1e-3); "
                "none: accept any error, with imposed cells and steps",
                real_or_none,
            ),
            "cells": whole("N", "impose N rings, or N x N squares (even, at least 4)"),
            "steps": whole("N", "impose N steps per period (even)"),
            "time_limit": real("SECONDS", "stop after this time, checked between two runs"),
            "method": Option("NAME", "another numerical method, for comparison"),
        },
        motions=answers.point_motions,
    ),
    "predict": Command(
        answers.predict,
        {
            "motion": MOTION,
            "table": Option(
                "CSV",
                "predict one contact for each line of a file.  Its heading names "
                "options, as in load [N],speed [mm/s],material; other options apply to all lines",
            ),
            **FILE_FORMAT,
            "output": EXACT,
            "figure": FIGURE,
        },
        inputs="bodies load motion drive output",
        motions=answers.real_motions,
    ),
    "fit": Command(
        answers.fit,
        {
            "motion": place("MOTION", "transverse, longitudinal or zigzag"),
            "measured": place("CSV", "the table"),
            "confidence": Option("P", "confidence level of the intervals (0.95)"),
            **FILE_FORMAT,
            "figure": FIGURE,
            "output": Option("FILE", "dataset of rows and residuals, .nc", output_file(".nc")),
        },
        inputs="speed amplitude frequency load nu radius counterbody map tolerance",
    ),
    "response": Command(
        answers.response,
        {
            "path": place("CSV", "the path"),
            "tolerance": real("T", "largest error of a force over mu times the load (1e-3)"),
            **FILE_FORMAT,
            "output": EXACT,
        },
        inputs="bodies load",
    ),
    "fold": Command(
        answers.fold,
        {
            "record": place("CSV", "the record"),
            "output": CSV_FILE,
            "frequency": Option("F", "approximate frequency (that of the strongest component)"),
            "rows": whole("N", "number of samples of the period, an even number (32)"),
            **FILE_FORMAT,
        },
    ),
    "export iwan": Command(
        answers.iwan,
        {
            "elements": whole("N", "number of elements"),
            "tolerance": real("T", "in place of it: largest error over mu times the load (1e-3)"),
            "output": CSV_FILE,
        },
        inputs="bodies load",
    ),
    "export table": Command(
        answers.table,
        {"motion": MOTION, "output": CSV_FILE},
        inputs="bodies load motion drive output -force",
        motions=answers.real_motions,
    ),
}
"""All commands except `sweep`, keyed by name."""
