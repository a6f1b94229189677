"""`microslip fit`: a coefficient of friction and u_lim from measured friction."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from microslip.app.option_parser import Said, format_as_options
from microslip.app.terminal import complain
from microslip.foundation.errors import InputError, shown
from microslip.si.motions import UNIT_OF_AMPLITUDE
from microslip.si.printed_lines import force_unit, in_unit, line

if TYPE_CHECKING:
    import xarray as xr

    from microslip.si.fitting.fitted import Fit

OPTIONS = {
    "speed": ("V", "forward speed of all rows, such as '1 mm/s', if it is no column"),
    "amplitude": ("A", "half stroke of all rows, such as '1 um', or an angle for bore, likewise"),
    "frequency": ("F", "frequency of all rows, such as '20 kHz', likewise"),
    "load": ("L", "normal load of all rows, such as '10 N', likewise"),
    "nu": ("NU", "Poisson's ratio of what gives way (0, or that of the map)"),
    "radius": ("R", "of relative curvature, such as '5 mm': finds the shear modulus, too"),
    "counterbody": ("BODY", "beside a radius: rigid (if not given) or same"),
    "map": ("FILE", "dataset of a sweep of this motion, which answers in place of the solver"),
    "confidence": ("P", "of the intervals (0.95)"),
    "tolerance": ("T", "largest accepted error of mu_macro where the solver answers (1e-3)"),
    "decimal": ("MARK", "the decimal mark of the table, a point or a comma (.)"),
    "encoding": ("NAME", "the encoding of the table, such as cp1252 (utf-8)"),
    "figure": ("FILE", "draws measured and fitted friction into this .png or .pdf"),
    "output": ("FILE", "writes rows, fitted friction and residuals into this .nc"),
}
FILES = ("map", "figure", "output")
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"))


def fill(parser: argparse.ArgumentParser) -> None:
    """Add the description and the arguments of `fit` to its parser."""
    parser.description = (
        "The coefficient of friction without vibration, and the displacement u_lim "
        "that lets the whole contact slide, or the shear modulus, from friction that was measured "
        "under vibration.  A row of the CSV file is a measurement; its heading names columns with "
        "their units: some of speed [mm/s], amplitude [um], frequency [kHz], load [N]; friction "
        "[N] or mu; friction_error [N] or mu_error."
    )
    parser.epilog = (
        "Exit codes: 0 both numbers are told, 1 mu alone is, or lines that cannot be read "
        "were left out, 2 bad input, or rows that tell neither."
    )
    motions = ", ".join(UNIT_OF_AMPLITUDE)
    parser.add_argument("motion", metavar="MOTION", help=f"the motion: {motions}")
    parser.add_argument("measured", metavar="CSV", help="the table")
    for name, (metavar, text) in OPTIONS.items():
        names = (f"--{name}", "--poisson") if name == "nu" else (f"--{name}",)
        parser.add_argument(*names, dest=name, action=Said, metavar=metavar, help=text)
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object and nothing else"
    )


def run(options: argparse.Namespace) -> int:
    """Answer; returns the exit code: 0 both numbers, 1 one of them, 2 bad input."""
    from microslip import fit
    from microslip.foundation.errors import CacheError, InputError
    from microslip.sweeps.evaluate import plain

    typed = getattr(options, "said", {})
    given = {name: getattr(options, name) for name in typed if name not in FILES}
    try:
        _refuse_endings(options)
        if options.map is not None:
            given["map"] = _opened(options.map)
        found = fit(options.motion, options.measured, **given)
        _write(found, options)
    except InputError as error:
        complain(f"microslip fit: {_complaint(error, typed, options)}")
        return 2
    except CacheError as error:
        complain(f"microslip fit: {error}")
        return 2
    print(json.dumps(plain(found.to_dict())) if options.json else _as_text(found))
    for text in found.left_out:
        complain(f"microslip fit: {format_as_options(text)}; left out")
    return 0 if len(found.told) == 2 and not found.left_out else 1


def _opened(path: str) -> xr.Dataset:
    from microslip.datasets.query.open_map import open_map
    from microslip.foundation.errors import CacheError, InputError

    try:
        return open_map(Path(path)) if path.endswith(".nc") else open_map(path)
    except InputError as error:
        raise error.renamed("map") from None
    except CacheError as error:
        raise CacheError(f"--map: {error}") from None


def _refuse_endings(options: argparse.Namespace) -> None:
    """Before the answer is computed, and not after."""
    from microslip.foundation.errors import InputError

    for name, endings in (("figure", (".png", ".pdf")), ("output", (".nc",))):
        path = getattr(options, name)
        if path is not None and Path(path).suffix.lower() not in endings:
            allowed = f"allowed is a name that ends in {' or '.join(endings)}"
            raise InputError(name, path, allowed)


def _write(found: Fit, options: argparse.Namespace) -> None:
    if not (options.figure or options.output):
        return
    dataset = found.to_xarray()
    if options.output:
        from microslip.foundation.files import writing_beside

        with writing_beside(Path(options.output)) as beside:
            dataset.to_netcdf(beside, engine="netcdf4")
    if options.figure:
        from microslip.report.figures.drawing import draw, save

        save(draw("fit", {"fit": dataset}), options.figure)


def _complaint(error: InputError, typed: dict[str, str], options: argparse.Namespace) -> str:
    """The option, its value as it was given, and what is allowed, in one line."""
    words = {"motion": ("MOTION", options.motion), "measured": ("CSV", options.measured)}
    option, value = words.get(error.argument, (typed.get(error.argument), error.value))
    option = option or f"--{error.argument.replace('_', '-')}"
    given = "" if value is None else f" = {shown(value)}"
    return " ".join(f"{option}{given}: {format_as_options(error.allowed)}".split())


def _as_text(found: Fit) -> str:
    rows = len(found.measured)
    lines = [line(name.replace("_", " "), text) for name, text in found.understood.items()]
    lines += [
        line("rows", f"{rows}, of {_of_what(found)}"),
        "",
        line("mu", _interval(found.mu, found.mu_low, found.mu_high, "")),
    ]
    for name, field, unit in (("u_lim", "u_lim", "m"), ("shear modulus", "shear_modulus", "Pa")):
        parts = (getattr(found, f"{field}{part}_{unit}") for part in ("", "_low", "_high"))
        value, low, high = parts
        if value is not None:
            lines.append(line(name, _interval(value, low, high, unit)))
    share = 100.0 * found.confidence
    of_model = f"of mu {_per_cent(found.mu_model_share)}"
    if len(found.told) == 2:
        of_model += f", of {found.told[1].replace('_', ' ')} {_per_cent(found.scale_model_share)}"
    lines.append(line("intervals", f"{share:g} %, and what the model may be off: {of_model}"))
    if found.standard_error is not None:
        unit = "N" if found.quantity == "friction" else ""
        lines.append(line("scatter", f"{_scaled(found.standard_error, unit)} a row"))
    else:
        chance = "" if found.p_value is None else f", p = {found.p_value:.2g}"
        text = f"{found.chi_square:.3g} for {found.degrees_of_freedom} degrees of freedom{chance}"
        lines.append(line("chi square", text))
    if found.reason:
        lines.append(f"NOT TOLD: {found.reason}")
    return "\n".join(lines + [f"warning: {text}" for text in found.warnings])


def _of_what(found: Fit) -> str:
    name = "the friction force" if found.quantity == "friction" else "the coefficient of friction"
    load = in_unit(found.load_N, 0.0, force_unit(found.load_N))
    return f"{name}; mean load {load}"


def _interval(value: float, low: float | None, high: float | None, unit: str) -> str:
    return f"{_scaled(value, unit)}, from {_scaled(low, unit)} to {_scaled(high, unit)}"


def _scaled(value: float | None, unit: str) -> str:
    """A value in the unit that suits it."""
    if not unit or not value:
        return f"{_digits(value, 4)} {unit}".strip()
    factor, prefix = next((one for one in PREFIXES if abs(value) >= one[0]), PREFIXES[-1])
    return f"{_digits(value / factor, 4)} {prefix}{unit}"


def _per_cent(share: float) -> str:
    return f"{_digits(100.0 * share, 2)} %"


def _digits(value: float | None, count: int) -> str:
    """A number with so many significant digits, zeros at its end included."""
    return f"{value:#.{count}g}".rstrip(".") if value else "0"
