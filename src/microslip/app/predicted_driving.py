"""What `microslip predict --driving` asks and says: a motion that drives, in units."""

from __future__ import annotations

import math

from microslip.app.predicted_text import length, line
from microslip.app.printed_error import error_text
from microslip.foundation.errors import InputError
from microslip.foundation.spec import read

REFUSED = ("speed", "force", "rotation", "reduction", "drive_stiffness", "mass", "damping")
REFUSED += ("radius_across", "contact_radius", "pressure", "forward_amplitude")
REFUSED += ("rotation_amplitude", "load_amplitude", "phase")
"""Of predict, what has no meaning where the motion itself pulls."""
COLUMNS = ("speed mm/s", "force N", "power out W", "power in W", "efficiency")
WIDTH = 13


def ask(scene: str, given: dict) -> object:
    """The si.driving.RealDrivingLine; given: options by name.  Raises InputError."""
    from microslip.si.driving import predict_driving

    for name in REFUSED:
        if name in given:
            allowed = "allowed is none with --driving: the motion pulls by itself"
            raise InputError(name, given[name], allowed)
    if "points" in given:
        given = given | {"points": read("points", given["points"], whole=True)}
    missing = dict.fromkeys(("radius", "load", "amplitude", "frequency"))
    return predict_driving(scene, **missing | given)


def as_text(found: object) -> str:
    """The answer in lines."""
    lines = [line(name.replace("_", " "), text) for name, text in found.understood.items()]
    lines += ["", line("contact radius", length(found.contact_radius_m))]
    lines.append(line("u_lim", length(found.u_lim_m)))
    lines.append(line("amplitude", f"dimensionless {found.amplitude:.4g}"))
    stall, speed = found.stall_force_N, 1e3 * found.no_load_speed_m_s
    lines.append(line("stall force", f"{stall:.4g} +- {error_text(found.stall_force_error_N)} N"))
    if math.isfinite(speed):
        error = 1e3 * found.no_load_speed_error_m_s
        lines.append(line("no-load speed", f"{speed:.4g} +- {error_text(error)} mm/s"))
    if len(found.speed_m_s):
        lines.append("".join(f"{name:>{WIDTH}}" for name in COLUMNS))
        rows = zip(
            1e3 * found.speed_m_s,
            found.force_N,
            found.power_out_W,
            found.power_in_W,
            found.efficiency,
            strict=True,
        )
        lines += ["".join(f"{value:>{WIDTH}.4g}" for value in row) for row in rows]
    if found.reason:
        lines.append(found.reason if found.converged else f"NOT CONVERGED: {found.reason}")
    lines += [f"warning: {text}" for text in found.warnings]
    lines += [f"not checked: {text}" for text in found.not_checked]
    return "\n".join(lines)
