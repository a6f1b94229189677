"""The commands that give one answer: names, help texts, options and functions in one table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

from microslip.app import answers
from microslip.app.answer import Answer, opened_map, output_file
from microslip.app.parser import Option
from microslip.foundation import spec

SPIN = "Bore means spin: rotation about the contact normal."
"""Remark in help texts."""


class Command(NamedTuple):
    """A command that gives one answer.

    Attributes
    ----------
    summary, text : str
        Its line in the list of commands, and its description.
    answer : callable
        Function that computes the answer.  Its arguments are those of the command line.
    places, options : dict of Option
        Positional arguments and options, by Python argument.
    inputs : str
        Groups or names of INPUTS that are options, too.
    without : str
        Names of INPUTS that are no options.
    motions : callable
        motions(): description of each motion, for the help text.
    """

    summary: str
    text: str
    answer: Callable[..., Answer]
    places: Mapping[str, Option]
    options: Mapping[str, Option]
    inputs: str = ""
    without: str = ""
    motions: Callable[[], dict[str, str]] = dict

    def groups(self) -> dict[str, dict[str, Option]]:
        """All options by Python argument, in groups by their heading in the help text."""
        groups: dict[str, dict[str, Option]] = {}
        if self.inputs:
            from microslip.si.inputs import INPUTS  # late, since it imports NumPy

            for name, one in INPUTS.items():
                if {name, one.group} & set(
                    self.inputs.split()
                ) and name not in self.without.split():
                    read = {"read": opened_map} if name == "map" else {}
                    option = Option(name.upper(), one.help, **read)
                    groups.setdefault(one.group, {})[name] = option
        return groups | {"options of this command": dict(self.options)}


def real_or_none(argument: str, text: str) -> float | None:
    """A number, or None for the text "none"."""
    return None if text == "none" else spec.read(argument, text)


real, whole = partial(Option, read=spec.read), partial(Option, read=partial(spec.read, whole=True))
DECIMAL = Option("MARK", "decimal mark of the file, a point or a comma (.)")
ENCODING = Option("NAME", "encoding of the file, such as cp1252 (utf-8)")
FIGURE = Option("FILE", "figure of friction, .png or .pdf", output_file(".png", ".pdf"))
CSV_FILE = Option("FILE", "write a .csv file", output_file(".csv"))
EXACT = Option("FILE", "write all columns to a .csv or .nc file", output_file(".csv", ".nc"))

COMMANDS = {
    "point": Command(
        "macroscopic friction at one (velocity, amplitude)",
        "Mean forward friction force divided by mu F_z at one point, with an error estimate.  "
        "mu_macro is a ratio: 1 if the vibration has no effect, 0 if no friction remains.  The "
        "apparent coefficient of friction is mu_apparent = mu mu_macro.  F_z is the load without "
        f"oscillation (the reference load), and u_lim the displacement of full slip.  {SPIN}",
        answers.point,
        {"motion": Option("MOTION", "the motion")},
        {
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
        "friction of a real contact, in SI units",
        "Friction of a vibrated contact, with its error estimate and with warnings where the "
        "theory does not apply.  Every quantity has a unit.  mu_macro is a ratio: friction with "
        "vibration divided by friction without.  A quantity can have a standard uncertainty, such "
        "as '0.15 +- 0.05' or '10 N +- 5 %', or be a range: '0..2 um' has 11 values, '0..2 um, 21' "
        "has 21, and '0.1..10 mm/s, 21, log' has equal ratios.",
        answers.predict,
        {"motion": Option("MOTION", "the motion")},
        {
            "table": Option(
                "CSV",
                "predict one contact for each line of a file.  Its heading names "
                "options, as in load [N],speed [mm/s],material; other options apply to all lines",
            ),
            "decimal": DECIMAL,
            "encoding": ENCODING,
            "output": EXACT,
            "figure": FIGURE,
        },
        inputs="bodies load motion drive output",
        motions=answers.real_motions,
    ),
    "fit": Command(
        "coefficient of friction and u_lim from measured friction",
        "The coefficient of friction without vibration, and the displacement u_lim at which the "
        "whole contact slides, or the shear modulus, from friction measured under vibration.  The "
        "heading of the CSV file names the columns: friction [N] or mu; some of speed [mm/s], "
        "amplitude [um], frequency [kHz], load [N]; and friction_error [N] or mu_error.  An option "
        "in place of a column applies to all rows.  Exit code 1: only mu is determined, or lines "
        "are unreadable.",
        answers.fit,
        {
            "motion": Option("MOTION", "transverse, longitudinal or zigzag"),
            "measured": Option("CSV", "the table"),
        },
        {
            "confidence": Option("P", "confidence level of the intervals (0.95)"),
            "decimal": DECIMAL,
            "encoding": ENCODING,
            "figure": FIGURE,
            "output": Option("FILE", "dataset of rows and residuals, .nc", output_file(".nc")),
        },
        inputs="speed amplitude frequency load nu radius counterbody map tolerance",
    ),
    "response": Command(
        "forces of a contact that follows the path of a file",
        "Forces, torque, dissipated energy and stick fraction of a contact that follows a path, "
        "with error estimates.  The columns of the file are forward, lateral, angle, and load or "
        "indentation, with units as in forward [um].  The load is that of the reference state.",
        answers.response,
        {"path": Option("CSV", "the path")},
        {
            "tolerance": real("T", "largest error of a force over mu times the load (1e-3)"),
            "decimal": DECIMAL,
            "encoding": ENCODING,
            "output": EXACT,
        },
        inputs="bodies load",
    ),
    "fold": Command(
        "one period of a motion from a long record, such as that of a vibrometer",
        "One period of a motion from a record of many periods.  The slow drift is removed, and the "
        "periods are averaged.  The columns are time and one or more of forward, lateral, angle, "
        "and load or indentation, each with its unit, as in time [s],lateral [um].",
        answers.fold,
        {"record": Option("CSV", "the record")},
        {
            "output": CSV_FILE,
            "frequency": Option("F", "approximate frequency (that of the strongest component)"),
            "rows": whole("N", "number of samples of the period, an even number (32)"),
            "decimal": DECIMAL,
            "encoding": ENCODING,
        },
    ),
    "export iwan": Command(
        "an Iwan model of a contact: parallel springs with sliders",
        "An Iwan model of a contact that moves along a line: the stiffness and the limit force of "
        "parallel Jenkins elements, each a spring in series with a slider, with their error.",
        answers.iwan,
        {},
        {
            "elements": whole("N", "number of elements"),
            "tolerance": real("T", "in place of it: largest error over mu times the load (1e-3)"),
            "output": CSV_FILE,
        },
        inputs="bodies load",
    ),
    "export table": Command(
        "a table of friction over speed, amplitude, load or other quantities",
        "Friction over the ranges of one or more quantities, such as --speed '0.1..10 mm/s, 21, "
        "log': 21 values in equal ratios.  '0..2 um' has 11 values in equal steps.",
        answers.table,
        {"motion": Option("MOTION", "the motion")},
        {"output": CSV_FILE},
        inputs="bodies load motion drive output",
        without="force reduction",
        motions=answers.real_motions,
    ),
}
"""Every command but `sweep`, by name."""
