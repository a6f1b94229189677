"""``microslip predict``: a contact in SI units."""

from __future__ import annotations

import json
import sys

OPTIONS = {
    "young": ("E", "Young's modulus of the body, such as '210 GPa'"),
    "nu": ("NU", "Poisson's ratio of the body"),
    "material": ("NAME", "instead of both: steel, stainless-steel, aluminium or glass"),
    "counterbody": ("BODY", "rigid (the default), a material, or E and nu as in '70 GPa, 0.22'"),
    "radius": ("R", "radius of the sphere, such as '5 mm'"),
    "counter-radius": ("R2", "radius of the counterbody, negative if hollow; flat if not given"),
    "load": ("F", "normal load, such as '10 N'"),
    "mu": ("MU", "coefficient of friction without vibration"),
    "speed": ("V", "forward speed, such as '1 mm/s'"),
    "amplitude": ("A", "half stroke, such as '1 um', or '0.5 deg' for bore"),
    "frequency": ("F", "frequency of the oscillation, such as '20 kHz'"),
    "rotation": ("W", "angular speed of continuous-bore, such as '60 rpm'"),
    "reduction": ("SHARE", "instead of an amplitude: find the one that takes '50 %%' away"),
    "hardness": ("H", "of the body, to warn of yielding, such as '7 GPa'"),
    "density": ("RHO", "of the body, to warn of inertia, such as '7850 kg/m^3'"),
    "counter-hardness": ("H2", "of the counterbody"),
    "counter-density": ("RHO2", "of the counterbody"),
}
NEEDED = ("radius", "load", "mu", "speed")


def add_parser(commands):
    """Add the parser of ``predict`` to those of the other commands."""
    parser = commands.add_parser(
        "predict",
        allow_abbrev=False,
        help="friction of a real contact, in SI units",
        description="How much friction falls in a contact given in SI units, and how far to trust "
        "that.  All quantities take units.",
    )
    parser.add_argument(
        "scene", metavar="SCENE", help="transverse, longitudinal, zigzag, bore or continuous-bore"
    )
    for name, (metavar, text) in OPTIONS.items():
        parser.add_argument(f"--{name}", metavar=metavar, help=text, required=name in NEEDED)
    parser.add_argument(
        "--tolerance", type=float, default=1e-3, metavar="T", help="accepted error of mu_macro"
    )
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object and nothing else"
    )


def run(options):
    """Answer; returns the exit code: 0 converged, 1 not converged, 2 bad input."""
    from microslip import predict
    from microslip.answers import plain

    names = [name.replace("-", "_") for name in OPTIONS]
    given = {name: getattr(options, name) for name in names}
    if given["counterbody"] is None:
        given["counterbody"] = "rigid"
    try:
        found = predict(options.scene, **given, tolerance=options.tolerance)
    except ValueError as error:
        name, equals, rest = str(error).partition(" = ")
        named = "SCENE" if name == "scene" else f"--{name.replace('_', '-')}"
        print(f"microslip predict: {named}{equals}{rest}", file=sys.stderr)
        return 2
    if options.json:
        print(json.dumps(plain(found.to_dict())))
    else:
        print(_as_text(found))
    return 0 if found.converged else 1


def _as_text(found):
    lines = [
        f"contact radius    {_length(found.contact_radius_m)}",
        f"indentation       {_length(found.indentation_m)}",
        f"u_lim             {_length(found.u_lim_m)}",
        f"largest pressure  {found.largest_pressure_Pa / 1e6:.4g} MPa",
    ]
    if found.amplitude is not None:
        size = found.amplitude_si
        real = f"{size:.4g} rad" if found.scene == "bore" else _length(size)
        lines.append(f"amplitude         {real}, dimensionless {found.amplitude:.4g}")
    lines += [
        f"velocity          dimensionless {found.velocity:.4g}",
        f"mu_macro          {found.mu_macro:.4f} +- {found.mu_macro_error:.1g}",
        f"friction          mu {found.mu_apparent:.4f} +- {found.mu_apparent_error:.1g}, "
        f"force {found.friction_force_N:.4g} N instead of {found.friction_force_still_N:.4g} N: "
        f"{100.0 * found.force_reduction:.1f} % less",
    ]
    if found.mu_static is not None:
        lines.append(f"static friction   mu {found.mu_static_apparent:.4f}")
    if not found.converged:
        lines.append(f"NOT CONVERGED: {found.reason}")
    lines += [f"warning: {text}" for text in found.warnings]
    lines += [f"not checked: {text}" for text in found.not_checked]
    return "\n".join(lines)


def _length(metres):
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("um", 1e-6)):
        if metres >= size:
            return f"{metres / size:.4g} {unit}"
    return f"{metres / 1e-9:.4g} nm"
