"""A RealPropulsionLine in words: the output of `microslip predict --propulsion`."""

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
    speed_unit,
)


def propulsion_text(real: Any) -> str:
    """The printed text of a propulsion.RealPropulsionLine."""
    unit = length_unit(real.u_lim_m)
    force = force_unit(real.stall_force_N)
    lines = [line(name.replace("_", " "), text) for name, text in real.understood.items()]
    lines += ["", line("contact radius", in_unit(real.contact_radius_m, 0.0, unit))]
    lines.append(line("u_lim", in_unit(real.u_lim_m, 0.0, unit)))
    lines.append(line("amplitude", f"dimensionless {number_text(real.amplitude)}"))
    if real.motion.startswith("normal"):
        lines.append(line("groups", REFERENCE_LOADS_OF_DRIVING))
    stall = in_unit(real.stall_force_N, real.stall_force_error_N, force)
    lines.append(line("stall force", stall))
    speeds = np.abs(np.nan_to_num([*real.speed_m_s, real.no_load_speed_m_s]))
    speed = speed_unit(float(speeds.max()), real.u_lim_m)
    if math.isfinite(real.no_load_speed_m_s):
        text = in_unit(real.no_load_speed_m_s, real.no_load_speed_error_m_s, speed)
        lines.append(line("no-load speed", text))
    if len(real.speed_m_s):
        power = prefixed(float(np.max(np.abs(real.power_in_W))), "W")
        watts = power[1]
        columns = {
            f"speed {speed[0]}": (real.speed_m_s / speed[1], None),
            f"force {force[0]}": (real.force_N / force[1], real.force_error_N / force[1]),
            f"power out {power[0]}": (real.power_out_W / watts, real.power_out_error_W / watts),
            f"power in {power[0]}": (real.power_in_W / watts, real.power_in_error_W / watts),
            "efficiency": (real.efficiency, real.efficiency_error),
        }
        lines += aligned(columns)
    if real.reason:
        failed = f"NOT CONVERGED: force or power: {real.reason}"
        lines.append(real.reason if real.converged else failed)
    lines += [f"warning: {text}" for text in real.warnings]
    lines += [f"not checked: {text}" for text in real.not_checked]
    return "\n".join(lines)
