"""The command `microslip fit`: fit a coefficient of friction and u_lim to measured friction."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

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
from microslip.si.motions import SINGLE
from microslip.si.printed_lines import force_unit, in_unit, line, prefixed

if TYPE_CHECKING:
    from microslip.si.fitting.fitted import Fit

OPTIONS = {
    "speed": ("V", "forward speed of all rows, such as '1 mm/s', in place of a column"),
    "amplitude": ("A", "half stroke of all rows, such as '1 um'; an angle for bore"),
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
    motions = ", ".join(SINGLE)
    text = f"the motion: {motions}"
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
    return Answer(result.to_dict(), _as_text(result), complete)


def _as_text(result: Fit) -> str:
    friction = result.quantity == "friction"
    name = "the friction force" if friction else "the coefficient of friction"
    load = in_unit(result.load_N, 0.0, force_unit(result.load_N))
    lines = [line(name.replace("_", " "), text) for name, text in result.understood.items()]
    lines += [line("rows", f"{len(result.measured)}, of {name}; mean load {load}"), ""]
    lines.append(line("mu", _interval(result.mu, result.mu_low, result.mu_high, "")))
    u_lim = result.u_lim_m, result.u_lim_low_m, result.u_lim_high_m
    modulus = result.shear_modulus_Pa, result.shear_modulus_low_Pa, result.shear_modulus_high_Pa
    for title, parts, unit in (("u_lim", u_lim, "m"), ("shear modulus", modulus, "Pa")):
        if parts[0] is not None:
            lines.append(line(title, _interval(*parts, unit)))
    shares = {result.told[-1]: result.scale_model_share, "mu": result.mu_model_share}
    model = ", ".join(
        f"of {name.replace('_', ' ')} {_digits(100.0 * shares[name], 2)} %" for name in result.told
    )
    share = f"{100.0 * result.confidence:g} %, plus the model error: {model}"
    lines.append(line("intervals", share))
    if result.standard_error is not None:
        scatter = _scaled(result.standard_error, "N" if friction else "")
        lines.append(line("scatter", f"{scatter} a row"))
    else:
        chance = "" if result.p_value is None else f", p = {result.p_value:.2g}"
        text = f"{result.chi_square:.3g} for {result.degrees_of_freedom} degrees of freedom{chance}"
        lines.append(line("chi square", text))
    if result.reason:
        lines.append(f"NOT DETERMINED: {result.reason}")
    return "\n".join(lines + [f"warning: {text}" for text in result.warnings])


def _interval(value: float | None, low: float | None, high: float | None, unit: str) -> str:
    return f"{_scaled(value, unit)}, from {_scaled(low, unit)} to {_scaled(high, unit)}"


def _scaled(value: float | None, unit: str) -> str:
    """Format a value with a suitable prefix of the unit."""
    name, size = prefixed(value, unit) if unit and value else (unit, 1.0)
    return f"{_digits((value or 0.0) / size, 4)} {name}".strip()


def _digits(value: float, count: int) -> str:
    """Format a number with `count` significant digits, including trailing zeros."""
    return f"{value:#.{count}g}".rstrip(".") if value else "0"
