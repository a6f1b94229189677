"""The command `microslip predict`: friction of a contact in SI units."""

from __future__ import annotations

import argparse

from microslip.app import predicted_table
from microslip.app.option_parser import StoreSpelling
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    add_answer,
    add_options,
    typed_options,
)
from microslip.app.terminal import complain
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import speaks_of_file
from microslip.si.grid import is_range
from microslip.si.materials import MATERIALS
from microslip.si.motions import MOTIONS
from microslip.si.strokes import read_stroke

GROUPS: dict[str, dict[str, tuple[str, str]]] = {
    "bodies": {
        "young": ("E", "Young's modulus of the body, such as '210 GPa'"),
        "nu": ("NU", "Poisson's ratio of the body"),
        "material": ("NAME", f"in place of E and NU: one of {', '.join(MATERIALS)}"),
        "counterbody": ("BODY", "rigid (default), a material, or E and nu as in '70 GPa, 0.22'"),
        "radius": ("R", "radius of the sphere, such as '5 mm'"),
        "counter-radius": ("R2", "radius of the counterbody, negative if hollow (default: flat)"),
        "radius-across": ("R", "second radius, across the forward direction; gives an ellipse"),
        "contact-radius": ("A", "in place of all radii: half the longer side of the contact"),
        "pressure": (
            "NAME",
            "with --contact-radius: hertz, ring:inner=0.5, file:FILE... (hertz)",
        ),
        "mu": ("MU", "coefficient of friction without vibration"),
        "hardness": (
            "H",
            "hardness of the body, for a warning of yielding, such as '7 GPa', '700 HV', '60 HRC'",
        ),
        "density": ("RHO", "density of the body, for a warning of inertia, such as '7850 kg/m^3'"),
        "counter-hardness": ("H2", "hardness of the counterbody"),
        "counter-density": ("RHO2", "density of the counterbody"),
        "wear-coefficient": (
            "K",
            "wear coefficient of Archard's law, for the wear in a cycle, such as '1e-5 mm^3/N/m'",
        ),
    },
    "load": {
        "load": ("F", "normal load, such as '10 N'"),
    },
    "motion": {
        "amplitude": (
            "A",
            "half stroke, such as '1 um'; for bore an angle, such as '0.5 deg'; for file:FILE a "
            "factor (1)",
        ),
        "forward-amplitude": ("A", "forward half stroke, for elliptic and normal"),
        "rotation-amplitude": ("A", "half stroke in spin, for transverse-bore and normal"),
        "load-amplitude": ("A", "half stroke of the normal load, for normal, such as '5 N'"),
        "phase": ("P", "phase between the oscillations, such as '90 deg' (0)"),
        "frequency": ("F", "frequency, such as '20 kHz', '1200 rpm' or '125664 rad/s'"),
        "rotation": ("W", "angular speed of continuous-bore, such as '60 rpm' or '6 rad/s'"),
        "reduction": (
            "SHARE",
            "in place of the amplitude, the speed or the load: the reduction of friction, such as "
            "'50 %%'.  The answer is the least amplitude, the largest speed or the largest load",
        ),
    },
    "drive": {
        "speed": ("V", "forward speed, such as '1 mm/s'"),
        "force": ("P", "in place of the speed: a constant forward force, such as '1 N'"),
        "drive-stiffness": ("K", "stiffness of a spring between drive and body, such as '10 N/um'"),
        "mass": ("M", "mass of a body on a spring or under a force, such as '20 g'"),
        "damping": ("C", "damping of a dashpot parallel to the spring, such as '5 N*s/m'"),
    },
    "output": {
        "tolerance": (
            "T",
            "largest accepted absolute error of mu_macro (1e-3); with "
            "--force, largest accepted relative error of the speed (1e-2)",
        ),
        "map": (
            "NAME",
            "certified map (a name, or a .nc file) of this motion, pressure and Poisson's ratio, "
            "in place of the solver",
        ),
        **{name: (word, f"with --table: {text}") for name, (word, text) in FILE_FORMAT.items()},
        "table": (
            "CSV",
            "predict one contact for each line of a file.  Its heading names options, as in "
            "load [N],speed [mm/s],material; options on the command line apply to all lines",
        ),
        "output": ("FILE", "with --table or ranges: write all columns to a .csv or .nc file"),
        "figure": ("FILE", "with one or two ranges: draw friction, .png or .pdf"),
    },
}
"""Options by heading in the help text.  Each option has a metavar and a help text."""
WITH = {"output": "--table or a range", "figure": "a range"} | dict.fromkeys(FILE_FORMAT, "--table")
"""Options that require another option."""
ABOUT_GROUPS = {
    "drive": "For an oscillating normal load there are two reference loads.  Stiffness, mass and "
    "damping are made dimensionless by mu times the load without oscillation, force and mu_macro "
    "by mu times the mean load.",
}
"""Descriptions of option groups."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `predict` to its parser."""
    parser.description = (
        "Friction of a vibrated contact in SI units, with its error estimate and with warnings "
        "where the theory does not apply.  Every quantity has a unit.  mu_macro is a ratio: "
        "friction with vibration divided by friction without.  mu_apparent is the coefficient of "
        "friction with vibration.  For a quantity with a standard uncertainty, such as "
        "'0.15 +- 0.05' or '10 N +- 5 %', the answer has intervals and the probability of each "
        "outcome.  A quantity can be a range: '0..2 um' has 11 values, '0..2 um, 21' has 21, and "
        "'0.1..10 mm/s, 21, log' has equal ratios.  The answer is then a table."
    )
    motions = "; ".join(f"{name}: it {kind.description}" for name, kind in MOTIONS.items())
    parser.add_argument(
        "motion",
        action=StoreSpelling,
        metavar="MOTION",
        help=f"motion of the sphere. {motions}; file:FILE: it follows one period of samples with "
        "units; or another motion of `microslip point`",
    )
    for title, options in GROUPS.items():
        group = parser.add_argument_group(title, ABOUT_GROUPS.get(title))
        add_options(group, options)
    add_answer(parser, _answer, group)


def _answer(options: argparse.Namespace) -> Answer:
    from microslip import predict
    from microslip.app.progress import elapsed_time

    if speaks_of_file(options.motion) and (hint := read_stroke(options.motion).hint):
        complain(f"microslip predict: MOTION = {options.motion!r}: {hint}")
    arguments = typed_options(options)
    ranges = {name: value for name, value in arguments.items() if is_range(name, value)}
    many = ranges if options.table is None else {"table": options.table}
    if options.table is not None and ranges:
        raise InputError(*next(iter(ranges.items())), "a range; allowed without --table")
    source = "--table" if options.table is not None else "range" if ranges else "nothing"
    for name, allowed in WITH.items():
        if getattr(options, name) is not None and source not in allowed:
            raise InputError(name, getattr(options, name), f"allowed only with {allowed}")
    if many:
        return predicted_table.answer(options, arguments)
    with elapsed_time("microslip predict"):
        prediction = predict(options.motion, **{"mu": None} | arguments)
    return Answer(prediction.to_dict(), str(prediction), prediction.converged)
