"""Lines of what `microslip predict` says of a contact that something pulls."""

from __future__ import annotations

import math

from microslip.app.printed_error import error_text
from microslip.si.motions import unit_of_amplitude
from microslip.si.prediction import Prediction
from microslip.si.regimes import REGIMES

WIDTH = 18
TIMES = (
    *(("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0)),
    *(("s", 1.0), ("ms", 1e-3), ("us", 1e-6)),
)
LENGTHS = (("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9))
FREQUENCIES = (("MHz", 1e6), ("kHz", 1e3), ("Hz", 1.0))


def line(title: str, text: str) -> str:
    """A line of the answer."""
    return f"{title:<{WIDTH - 1}} {text}"


def length(metres: float) -> str:
    """A length in the unit that suits it."""
    return _in_units(metres, LENGTHS)


def largest_pressure(found: Prediction) -> str:
    """The largest pressure with its unit."""
    pressure = found.largest_pressure_Pa
    return "infinite, at the tip" if math.isinf(pressure) else f"{pressure / 1e6:.4g} MPa"


def _in_units(value, units):
    name, size = next((one for one in units if value >= one[1]), units[-1])
    return f"{value / size:.4g} {name}"


def _pair(value, error):
    """A length and its error, in one unit."""
    name, size = next((one for one in LENGTHS if value >= one[1]), LENGTHS[-1])
    return f"{value / size:.4g} +- {error_text(error / size)} {name}"


def _speed(value, error):
    """A speed and its error, in one unit."""
    return f"{_pair(value, error)}/s"


def unit_of_sought(found: Prediction) -> str:
    """Unit of what was looked for."""
    if found.sought == "amplitude" and unit_of_amplitude(found.scene) == "rad":
        return "rad"
    return {"amplitude": "m", "speed": "m/s", "load": "N"}[found.sought]


def looked_for(found: Prediction) -> list[str]:
    """The line of what was found for a wanted reduction, and its error."""
    if found.sought is None:
        return []
    share = f"takes {found.understood['reduction']} away"
    error = error_text(found.sought_error)
    if found.sought == "speed":
        text = f"{_speed(found.speed_m_s, found.sought_error)}, the largest at which vibration"
    elif found.sought == "load":
        text = f"{found.load_N:.4g} +- {error} N, the largest at which vibration"
    elif unit_of_sought(found) == "rad":
        text = f"{found.amplitude_si:.4g} +- {error} rad, the least that"
    else:
        text = f"{_pair(found.amplitude_si, found.sought_error)}, the least that"
    return [line("found", f"{found.sought} {text} {share}")]


def threshold(found: Prediction) -> list[str]:
    """The line of the force that moves the contact, if it is known."""
    if found.force_threshold_N is None:
        return []
    if not _holds(found):
        return [line("force threshold", "0 N: any constant force moves the contact")]
    text = f"{found.force_threshold_N:.4g} N: no smaller constant force moves the contact"
    return [line("force threshold", text)]


def _holds(found):
    """Whether the contact resists at all at vanishing speed, as far as can be told."""
    return found.force_threshold_N > found.force_threshold_error_N


def groups_of_drive(found: Prediction) -> list[str]:
    """Lines of the groups of what pulls, and of its regime."""
    lines = [
        line(name, f"dimensionless {getattr(found, name):.4g}")
        for name in ("force", "stiffness", "mass", "damping")
        if getattr(found, name) is not None
    ]
    if found.regime is not None:
        lines.append(line("regime", REGIMES[found.regime]))
    if found.natural_frequency is not None:
        text = _in_units(found.natural_frequency * found.frequency_Hz, FREQUENCIES)
        lines.append(line("natural frequency", f"{text}, of the mass on a contact that sticks"))
    return lines


def walk(found: Prediction) -> list[str]:
    """Lines of what a force makes of the contact."""
    lines = threshold(found)
    if lines and _holds(found):
        lines.append(line("safety factor", f"{found.safety_factor:.3g}: threshold over force"))
    return lines + _OUTCOMES[found.outcome](found)


def _moves(found):
    lines = [line("speed", _speed(found.speed_m_s, found.speed_error_m_s))]
    if found.displacement_per_cycle_m is not None:
        text = f"{length(found.displacement_per_cycle_m)} a cycle"
        lines.append(line("displacement", text))
    radius = length(found.contact_radius_m)
    lines.append(
        line(
            "walks",
            f"1 mm in {_in_units(found.time_to_1_mm_s, TIMES)}, the contact radius of {radius} in "
            f"{_in_units(found.time_to_contact_radius_s, TIMES)}",
        )
    )
    return [line("outcome", "it moves, cycle by cycle"), *lines]


def _stays(found):
    lines = [line("outcome", "it stays: the force is below the threshold")]
    if found.displacement_m is not None:
        way = f"{_pair(found.displacement_m, found.displacement_error_m)} forward, then no further"
        cycles = f"{found.cycles_to_rest:.3g} cycles"
        most = f"nine tenths of what the vibration adds within {cycles}"
        lines.append(line("displacement", f"{way}: {most}"))
    return lines


def runs_away(found: Prediction) -> str:
    """What is said of a contact that does."""
    still = f"{found.friction_force_still_N:.4g} N"
    return f"it runs away: friction holds no more than {still}, mu times the load"


def _undecided(found):
    most = found.speed_m_s + found.speed_error_m_s
    text = f"the error does not tell whether it moves: by {_in_units(most, LENGTHS)}/s at most"
    return [line("outcome", text)]


_OUTCOMES = {
    "moves": _moves,
    "stays": _stays,
    "runs away": lambda found: [line("outcome", runs_away(found))],
    "undecided": _undecided,
    None: lambda found: [],
}
