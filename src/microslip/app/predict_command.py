"""`microslip predict`: a contact in SI units."""

from __future__ import annotations

import argparse

from microslip.app import predicted_propulsion, predicted_table
from microslip.app.question import Answer, add_json, add_options, respond, typed_options
from microslip.foundation.errors import InputError
from microslip.si.materials import MATERIALS
from microslip.si.motions import MOTIONS

GROUPS: dict[str, dict[str, tuple[str, str]]] = {
    "bodies": {
        "young": ("E", "Young's modulus of the body, such as '210 GPa'"),
        "nu": ("NU", "Poisson's ratio of the body"),
        "material": ("NAME", f"instead of both: one of {', '.join(MATERIALS)}"),
        "counterbody": (
            "BODY",
            "rigid (if not given), a material, or E and nu as in '70 GPa, 0.22'",
        ),
        "radius": ("R", "radius of the sphere, such as '5 mm'"),
        "counter-radius": (
            "R2",
            "radius of the counterbody, negative if hollow; flat if not given",
        ),
        "radius-across": (
            "R",
            "another radius across the forward direction: an ellipse is touched",
        ),
        "contact-radius": (
            "A",
            "in place of radii: half the longer side of a contact that is known",
        ),
        "pressure": ("NAME", "over that contact, such as ring:inner=0.5 or file:FILE (hertz)"),
        "mu": ("MU", "coefficient of friction without vibration"),
        "hardness": (
            "H",
            "of the body, to warn of yielding, such as '7 GPa', '700 HV' or '60 HRC'",
        ),
        "density": ("RHO", "of the body, to warn of inertia, such as '7850 kg/m^3'"),
        "counter-hardness": ("H2", "of the counterbody"),
        "counter-density": ("RHO2", "of the counterbody"),
    },
    "load": {
        "load": ("F", "normal load, such as '10 N'"),
        "contacts": (
            "TEXT",
            "that carry the body together, such as 'phase=0;phase=180': the load is that of "
            "all, which share it by load=..., and so is what pulls",
        ),
    },
    "motion": {
        "amplitude": ("A", "half stroke, such as '1 um', or an angle for bore, such as '0.5 deg'"),
        "forward-amplitude": (
            "A",
            "half stroke along the forward direction, of elliptic and normal",
        ),
        "rotation-amplitude": ("A", "half stroke in spin, an angle, of transverse-bore and normal"),
        "load-amplitude": ("A", "half stroke of the load, of normal, such as '5 N'"),
        "phase": ("P", "of these against the rest, an angle, such as '90 deg' (0)"),
        "frequency": (
            "F",
            "of the oscillation: cyclic, such as '20 kHz', or angular, such as '1200 rpm' or "
            "'125664 rad/s'",
        ),
        "rotation": (
            "W",
            "speed of the spin of continuous-bore, such as '60 rpm', '1 Hz' or '6 rad/s'",
        ),
        "reduction": (
            "SHARE",
            "instead of the amplitude, the speed or the load: find the least amplitude, the "
            "largest speed or the largest load at which vibration takes '50 %%' away",
        ),
    },
    "drive": {
        "speed": ("V", "forward speed, such as '1 mm/s'"),
        "force": ("P", "instead of a speed: a constant force that pulls, such as '1 N'"),
        "drive-stiffness": ("K", "of a spring that pulls with the speed, such as '10 N/um'"),
        "mass": ("M", "of the body that a spring or a force pulls, such as '20 g'"),
        "damping": ("C", "of a dashpot on a body on a spring, such as '5 N*s/m'"),
    },
    "output": {
        "tolerance": (
            "T",
            "largest accepted error: of the ratio mu_macro, absolute (1e-3; 1e-2 with "
            "--propulsion); with --force, of the speed, relative (1e-2)",
        ),
        "points": ("N", "with --propulsion: on the line, its ends included (9)"),
        "decimal": ("MARK", "with --table: the decimal mark of the file, a point or a comma (.)"),
        "encoding": ("NAME", "with --table: the encoding of the file, such as cp1252 (utf-8)"),
    },
}
"""Options by the headings of the help: metavar and help."""
ABOUT_GROUPS = {
    "drive": "Where the normal load oscillates there are two reference loads: stiffness, mass and "
    "damping are made dimensionless by mu times the load without oscillation, force and mu_macro "
    "by mu times the mean load.",
}
"""Sentences below headings of the help."""


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `predict` to its parser."""
    parser.description = (
        "How much friction falls in a contact given in SI units, and how far to trust "
        "that.  All quantities take units.  The answer has two kinds of numbers: mu_macro is a "
        "ratio, the friction with vibration over that without; mu_apparent is the coefficient of "
        "friction that is felt.  A number with a standard uncertainty, such as '0.15 +- 0.05' or "
        "'10 N +- 5 %', gives intervals and the probability of each outcome."
    )
    motions = "; ".join(f"{name}: it {what}" for name, what in MOTIONS.items())
    parser.add_argument(
        "motion",
        metavar="MOTION",
        help=f"what the sphere does. {motions}; or another motion of point",
    )
    for title, options in GROUPS.items():
        group = parser.add_argument_group(title, ABOUT_GROUPS.get(title))
        add_options(group, options)
        if title == "drive":
            group.add_argument(
                "--propulsion",
                action="store_true",
                help="ask what a self-propelled motion pulls with, such as "
                "elliptic:forward_cycles=2,phase=0: stall force, no-load speed, power and "
                "efficiency",
            )
    group.add_argument(
        "--power", action="store_true", help="also compute the power that vibrates the contact"
    )
    group.add_argument(
        "--table",
        metavar="CSV",
        help="a contact for every line of a file, whose heading names some of the options, as in "
        "load [N],speed [mm/s],material; the others are shared",
    )
    group.add_argument(
        "--output", metavar="FILE", help="with --table: writes all that is found into a .csv or .nc"
    )
    add_json(group)


def run(options: argparse.Namespace) -> int:
    """Answer; returns the exit code: 0 converged, 1 not converged, 2 bad input."""
    names = [name.replace("-", "_") for group in GROUPS.values() for name in group]
    return respond("microslip predict", options, _answer, {"motion": "MOTION"}, names)


def _answer(options: argparse.Namespace) -> Answer:
    from microslip import predict
    from microslip.app.progress import elapsed_time

    arguments = typed_options(options)
    if options.table is not None:
        return predicted_table.answer(options, arguments)
    for name in ("output", "decimal", "encoding"):
        if getattr(options, name) is not None:
            raise InputError(name, getattr(options, name), "allowed with --table alone")
    with elapsed_time("microslip predict"):
        if options.propulsion:
            found = predicted_propulsion.ask(options.motion, arguments)
            return Answer(found.to_dict(), str(found), found.converged)
        if "points" in arguments:
            raise InputError("points", arguments["points"], "allowed with --propulsion alone")
        found = predict(options.motion, **{"mu": None} | arguments, power=options.power)
    return Answer(found.to_dict(), str(found), found.converged)
