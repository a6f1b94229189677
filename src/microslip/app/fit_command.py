"""The command `microslip fit`: fit a coefficient of friction and u_lim to measured friction."""

from __future__ import annotations

import argparse

from microslip.app.option_parser import StoreSpelling, format_as_options
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    add_answer,
    add_options,
    refuse_figure,
    refuse_output,
    typed_options,
    write_files,
)
from microslip.app.terminal import complain

OPTIONS = {
    "speed": ("V", "forward speed of all rows, such as '1 mm/s', in place of a column"),
    "amplitude": ("A", "half stroke of all rows, such as '1 um'"),
    "frequency": ("F", "frequency of all rows, such as '20 kHz'"),
    "load": ("L", "normal load of all rows, such as '10 N'"),
    "nu": ("NU", "Poisson's ratio of the elastic body (0, or that of the map)"),
    "radius": ("R", "radius of relative curvature, such as '5 mm', to fit the shear modulus"),
    "counterbody": ("BODY", "with a radius: rigid (default) or same"),
    "map": ("FILE", "dataset of a sweep of this motion, in place of the solver"),
    "confidence": ("P", "confidence level of the intervals (0.95)"),
    "tolerance": ("T", "largest accepted error of mu_macro of the solver (1e-3)"),
    **FILE_FORMAT,
    "figure": ("FILE", "figure of measured and fitted friction, .png or .pdf"),
    "output": ("FILE", "dataset of rows, fitted friction and residuals, .nc"),
}


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `fit` to its parser."""
    parser.description = (
        "The coefficient of friction without vibration, and the displacement u_lim at "
        "which the whole contact slides, or the shear modulus, from friction measured "
        "under vibration.  Each row of the CSV file is a measurement.  The heading names the "
        "columns and their units: friction [N] or mu; some of speed [mm/s], amplitude [um], "
        "frequency [kHz], load [N]; and friction_error [N] or mu_error."
    )
    parser.epilog = (
        "Exit codes: 0 both numbers determined; 1 only mu determined, or unreadable lines left "
        "out; 2 bad input, or neither number determined."
    )
    text = "the motion: transverse, longitudinal or zigzag"
    parser.add_argument("motion", action=StoreSpelling, metavar="MOTION", help=text)
    parser.add_argument("measured", action=StoreSpelling, metavar="CSV", help="the table")
    add_options(parser, OPTIONS)
    add_answer(parser, _answer)


def _answer(options: argparse.Namespace) -> Answer:
    from microslip import fit

    refuse_figure(options.figure)
    refuse_output(options.output, options.measured, (".nc",))
    result = fit(options.motion, options.measured, **typed_options(options))
    if options.output or options.figure:
        write_files(options, "fit", result.to_xarray())
    for text in result.left_out:
        complain(f"microslip fit: {format_as_options(text)}; left out")
    complete = len(result.told) == 2 and not result.left_out
    return Answer(result.to_dict(), str(result), complete)
