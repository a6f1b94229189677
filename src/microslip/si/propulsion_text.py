"""A RealPropulsionLine in words, as `microslip predict --propulsion` and print() show it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from microslip.foundation.number_text import aligned, number_text
from microslip.si.printed_lines import (
    REFERENCE_LOADS_OF_DRIVING,
    force_unit,
    in_unit,
    length_unit,
    line,
    prefixed,
)


def propulsion_text(found: Any) -> str:
    """All lines of a propulsion.RealPropulsionLine."""
    unit = length_unit(found.u_lim_m)
    force = force_unit(found.stall_force_N)
    lines = [line(name.replace("_", " "), text) for name, text in found.understood.items()]
    lines += ["", line("contact radius", in_unit(found.contact_radius_m, 0.0, unit))]
    lines.append(line("u_lim", in_unit(found.u_lim_m, 0.0, unit)))
    lines.append(line("amplitude", f"dimensionless {number_text(found.amplitude)}"))
    if found.motion.startswith("normal"):
        lines.append(line("groups", REFERENCE_LOADS_OF_DRIVING))
    stall = in_unit(found.stall_force_N, found.stall_force_error_N, force)
    lines.append(line("stall force", stall))
    speed = ("mm/s", 1e-3)
    if math.isfinite(found.no_load_speed_m_s):
        text = in_unit(found.no_load_speed_m_s, found.no_load_speed_error_m_s, speed)
        lines.append(line("no-load speed", text))
    if len(found.speed_m_s):
        power = prefixed(float(np.max(np.abs(found.power_in_W))), "W")
        columns = {
            "speed mm/s": (found.speed_m_s / speed[1], None),
            f"force {force[0]}": (found.force_N / force[1], found.force_error_N / force[1]),
            f"power out {power[0]}": (
                found.power_out_W / power[1],
                found.power_out_error_W / power[1],
            ),
            f"power in {power[0]}": (
                found.power_in_W / power[1],
                found.power_in_error_W / power[1],
            ),
            "efficiency": (found.efficiency, found.efficiency_error),
        }
        lines += aligned(columns)
    if found.reason:
        failed = f"NOT CONVERGED: force or power: {found.reason}"
        lines.append(found.reason if found.converged else failed)
    lines += [f"warning: {text}" for text in found.warnings]
    lines += [f"not checked: {text}" for text in found.not_checked]
    return "\n".join(lines)
