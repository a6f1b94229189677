"""A Prediction in words: the lines that `microslip predict` and print() show."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from microslip.foundation.number_text import ROUNDING, interval_text, number_text
from microslip.si.motions import COMBINED, is_along_the_pull, unit_of_amplitude
from microslip.si.printed_lines import (
    EXCLUDED,
    FIRST_ORDER,
    LENGTHS,
    force_unit,
    in_unit,
    length_unit,
    line,
    not_converged,
    prefixed,
    probability_text,
    runs_away,
    unit_for,
)
from microslip.si.regimes import REGIMES

UNDERSTOOD = (
    *("motion", "body", "counterbody", "radius", "counter_radius", "radius_across"),
    *("contact_radius", "pressure", "load", "contacts", "mu", "speed"),
    *("force", "drive_stiffness", "mass", "damping"),
    *("amplitude", "forward_amplitude", "rotation_amplitude", "load_amplitude", "phase"),
    *("frequency", "rotation", "reduction"),
)
"""Arguments in the order in which they are shown."""
PROBABILITIES = {
    "probability_stays": "stays",
    "probability_moves": "moves",
    "probability_runs_away": "runs away",
}
"""Columns of the probability of each outcome, and the outcome."""
LARGEST_NUMBER = 1e4
"""Largest contact radius in the unit of the other lengths, four digits before the point."""
ADDED = {"bore": "spin", "continuous-bore": "spin", "transverse-bore": "vibration and spin"}
"""The added motion in words, where it is more than vibration."""
TIMES = (
    *(("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0)),
    *(("s", 1.0), ("ms", 1e-3), ("us", 1e-6)),
)
REFERENCE_LOADS = (
    "stiffness, mass and damping are over mu times the load without oscillation (the reference "
    "load); force and mu_macro are over mu times the mean load"
)
"""Sentence beside groups of a drive where the normal load oscillates."""
ALONG_THE_PULL = (
    "it is not the force threshold, because the vibration is along the pull: at a prescribed speed "
    "it reverses the force, which reduces the mean; under a constant force a body without mass "
    "moves along with the vibration, and all of friction holds it"
)
"""Explanation of a static friction below the force threshold."""
UNKNOWN_THRESHOLD = (
    "it is not the force threshold, because part of the vibration is along the pull; whether a "
    "constant force moves the contact is computed for a given force"
)
"""Explanation of a static friction without a force threshold."""
FROM_INPUTS = "from the uncertain inputs"
FROM_LINEAR_MODEL = (
    f"{FROM_INPUTS} to first order: static friction is taken to be linear in each of them"
)
"""Origin of an interval by quantiles, and to first order."""
NO_SPREAD_OF_SPEED = "none of the speed: the contact may run away"
"""Text where a speed within the uncertainties is infinite."""
STAYS_WITHIN_SPREADS = "none of the speed: the contact may move"
"""Text where the contact stays one standard deviation around the inputs, but may move further."""
OUTCOMES = {
    "moves": "it moves, cycle by cycle",
    "stays": "it stays: the force is below the threshold",
    "runs away": "{runs_away}",
    "undecided": "the error does not tell whether it moves: by {fastest} at most",
}
"""Sentences about the outcome of a force."""


def prediction_text(found: Any) -> str:
    """All lines of a prediction.Prediction."""
    show, forced = _Texts(found).show, found.force_N is not None
    lines = [
        line(name.replace("_", " "), found.understood[name])
        for name in UNDERSTOOD
        if name in found.understood
    ]
    pressure = "{largest_pressure_Pa}" + (" under {load_N}" if found.load_amplitude_N else "")
    lines += ["", *show("contact radius", "{contact_radius_m}")]
    lines += show("indentation", "{indentation_m}", not math.isnan(found.indentation_m))
    lines += show("u_lim", "{u_lim_m}") + show("largest pressure", pressure)
    lines += show("amplitude", "{size}, dimensionless {amplitude}", found.motion not in COMBINED)
    lines += show("amplitude", "the largest is dimensionless {amplitude}", found.motion in COMBINED)
    lines += show("velocity", "dimensionless {velocity}", not forced)
    sentence = "{sought} {sought_text}, {least} takes {understood[reduction]} away"
    lines += show("found", sentence + "; all other lines are for {sought_exact}")
    for name in ("force", "stiffness", "mass", "damping"):
        lines += show(name, f"dimensionless {{{name}}}")
    lines += show("groups", REFERENCE_LOADS, bool(found.load_amplitude_N and found.regime))
    lines += show("regime", "{regime_text}")
    lines += show(
        "natural frequency", "{natural_frequency_Hz}, of the mass on a contact that sticks"
    )
    lines += _outcome(found, show) if forced else _friction(found, show)
    lines += _spread(found, show)
    lines += show("torque", "{torque_N_m}")
    lines += show("power", "{vibration_power_W} for the {added}")
    lines += show("", "{drag_power_W} for the drag", found.power is not None)
    lines += show("energy", "{energy_per_cycle_J} a cycle turn into heat") + not_converged(found)
    lines += [f"warning: {text}" for text in found.warnings]
    return "\n".join(lines + [f"not checked: {text}" for text in found.not_checked])


def _friction(found: Any, show: Show) -> list[str]:
    """Lines of the friction at a speed: which number is a ratio, which a coefficient."""
    lines = show("mu_macro", "{mu_macro}: ratio of friction with {added} to friction without")
    coefficient = "coefficient of friction with {added}, instead of {understood[mu]}"
    lines += show("mu_apparent", f"{{mu_apparent}}: {coefficient}")
    force = "{friction_force_N} instead of {friction_force_still_N}: {reduction} less"
    lines += show("friction force", force)
    static = "{mu_static_apparent}: coefficient of friction at vanishing speed"
    lines += show("static friction", static) + show("", "{mu_static_apparent_interval}")
    if found.mu_static is not None:
        threshold, along = found.force_threshold_N, is_along_the_pull(found.motion)
        lines += show("", UNKNOWN_THRESHOLD, threshold is None and along)
        apart = threshold is not None and not _moves_at_static_friction(found)
        lines += show("", ALONG_THE_PULL, apart)
    return lines + _threshold(found, show)


def _threshold(found: Any, show: Show) -> list[str]:
    """Lines of the force that moves the contact, if it is known."""
    value, error = found.force_threshold_N, found.force_threshold_error_N
    if value is None or error is None:
        return []
    rounding = ROUNDING * found.load_N  # as for static friction, times the load
    if value > max(error, rounding):
        sentence = "{force_threshold_N}: no smaller constant force moves the contact"
    elif value <= error <= rounding:
        sentence = "{zero_N}: any constant force moves the contact"
    else:
        sentence = "{zero_threshold_N}: any constant force beyond that moves the contact"
    known = value > max(error, rounding) or bool(found.force_threshold_high_N)
    lines = show("force threshold", sentence)
    return lines + show("", "{force_threshold_interval_N}", known)


def _moves_at_static_friction(found: Any) -> bool:
    """Whether the force threshold is the static friction."""
    static, threshold = found.mu_static, found.force_threshold_N
    if static is None or threshold is None:
        return False
    return math.isclose(threshold, found.friction_force_still_N * static, abs_tol=0.0)


def _outcome(found: Any, show: Show) -> list[str]:
    """Lines of a contact under a force: its threshold, its outcome, and its way."""
    lines, factor, columns = _threshold(found, show), found.safety_factor, found.uncertainty
    safe = factor is not None and (factor > found.safety_factor_error or found.safety_factor_high)
    lines += show("safety factor", "{safety_factor}: threshold over force", bool(safe))
    lines += show("", "{safety_factor_interval}", bool(safe))
    if found.outcome is not None:
        central = "with the central values " if "probability_error" in columns else ""
        lines += show("outcome", central + OUTCOMES[found.outcome])
    shares = [
        f"{probability_text(columns[name], columns['probability_error'])} that it {words}"
        for name, words in PROBABILITIES.items()
        if name in columns
    ]
    if shares and "probability_stays" not in columns:
        shares.append("not computed: that it stays or moves")
    lines += show("probability", ", ".join(shares), bool(shares))
    if found.outcome == "moves":
        lines += show("speed", "{speed_m_s}")
        lines += show("displacement", "{displacement_per_cycle_m} a cycle")
        way = "{time_to_1_mm_s}, the contact radius of {contact_radius_m} in"
        lines += show("walks", f"1 mm in {way} {{time_to_contact_radius_s}}")
    if found.outcome == "stays":
        most = "the vibration adds nothing"
        if found.cycles_to_rest:
            cycles = f"about {found.cycles_to_rest:.2g} cycles"
            most = f"nine tenths of what the vibration adds within {cycles}"
        lines += show("displacement", f"{{displacement_m}} forward, then no further: {most}")
        unknown = found.displacement_m is None
        lines += show("displacement", "not known: {displacement_reason}", unknown)
    return lines


def _spread(found: Any, show: Show) -> list[str]:
    """The line of the standard uncertainties that follow from those of the inputs."""
    if not found.uncertainty:
        return []
    parts = ["{mu_apparent_spread} of mu_apparent", "{friction_force_spread_N} of the force"]
    if found.force_N is not None:
        spread, moves = found.speed_spread_m_s, found.probability_moves or 0.0
        if math.isinf(spread):
            return show("spread", NO_SPREAD_OF_SPEED)
        if spread == 0.0 and moves > EXCLUDED:
            return show("spread", STAYS_WITHIN_SPREADS)
        parts = ["{speed_spread_m_s} of the speed"]
    text = "standard uncertainties that follow from those of the inputs"
    if found.sought is not None:
        parts.insert(0, "{sought_spread_text} of the {sought}")
        text += ", as does the {sought}"
    if found.power is not None:
        text += "; none is computed for torque, power and energy"
    return show("spread", f"{', '.join(parts)}: {text}")


class _Texts(dict[str, Any]):
    """Texts of the columns of a Prediction: numbers with their errors, each in its unit."""

    def __init__(self, found: Any):
        length, force = length_unit(found.u_lim_m), force_unit(found.friction_force_still_N)
        powers = [found.drag_power_W or 0.0, found.vibration_power_W or 0.0]
        watts = prefixed(max(map(abs, powers)) or 1.0, "W")
        speed, self.found = (f"{length[0]}/s", length[1]), found
        self.units = {"_m_s": speed, "_m": length, "_N": force, "_W": watts, "_Pa": ("MPa", 1e6)}
        super().__init__(understood=found.understood, added=ADDED.get(found.motion, "vibration"))
        self["zero_N"] = in_unit(0.0, 0.0, force)
        less = 100.0 * found.force_reduction, 100.0 * found.mu_macro_error
        self["reduction"] = number_text(*less, "%")
        if math.isinf(found.largest_pressure_Pa):
            self["largest_pressure_Pa"] = "infinite, at the tip"
        if found.contact_radius_m >= LARGEST_NUMBER * length[1]:
            unit = unit_for(found.contact_radius_m, LENGTHS)
            self["contact_radius_m"] = in_unit(found.contact_radius_m, 0.0, unit)
        turned = ("rad", 1.0) if unit_of_amplitude(found.motion) == "rad" else length
        if found.amplitude_si is not None:
            self["size"] = in_unit(found.amplitude_si, 0.0, turned)
        if found.sought is not None:
            self._seek({"amplitude": turned, "speed": speed, "load": force_unit(found.load_N)})
        if found.force_threshold_N is not None:
            most = found.force_threshold_N + (found.force_threshold_error_N or 0.0)
            self["zero_threshold_N"] = in_unit(0.0, most, force)
        if found.force_N is not None:
            self["fastest"] = in_unit(found.speed_m_s + found.speed_error_m_s, 0.0, speed)
            if found.outcome == "runs away":
                self["runs_away"] = runs_away(found)
        if found.regime is not None:
            self["regime_text"] = REGIMES[found.regime]
        if found.natural_frequency is not None:
            frequency = found.natural_frequency * found.frequency_Hz
            self["natural_frequency_Hz"] = in_unit(frequency, 0.0, prefixed(frequency, "Hz"))

    def _seek(self, units: dict[str, tuple[str, float]]) -> None:
        """Add the texts of the sought quantity."""
        found, unit = self.found, units[self.found.sought]
        self["sought_text"] = in_unit(found.sought_value, found.sought_error, unit)
        self["sought_exact"] = in_unit(found.sought_value, 0.0, unit)
        least = "the least that" if found.sought == "amplitude" else None
        self["least"] = least or "the largest at which vibration"
        spread = found.sought_spread
        if spread is not None:
            self["sought_spread_text"] = number_text(spread / unit[1], 0.0, unit[0], digits=2)

    def show(self, title: str, template: str, when: bool = True) -> list[str]:
        """The line of a template, none where a column in it is unknown."""
        try:
            return [line(title, template.format_map(self))] if when else []
        except KeyError:
            return []

    def __missing__(self, name: str) -> str:
        """The text of a column, of an interval, or of a spread; KeyError where it is unknown."""
        end = next((end for end in ENDS if name.endswith(end)), "")
        stem = name.removesuffix(end)
        if stem.endswith("_interval"):
            return self._interval(stem.removesuffix("_interval"), end)
        value = getattr(self.found, name, None)
        if value is None:
            raise KeyError(name)
        if isinstance(value, str):
            return value
        unit = self.units.get(end, ("", 1.0))
        if end == "_s":
            unit = unit_for(value, TIMES)
        elif end in ("_J", "_N_m"):
            unit = prefixed(value, end[1:].replace("_", " "))
        if stem.endswith("_spread"):
            return number_text(value / unit[1], 0.0, unit[0], digits=2)
        error = getattr(self.found, f"{stem}_error{end}", None)
        return in_unit(value, error or 0.0, unit)

    def _interval(self, stem: str, end: str) -> str:
        """The text of a 95 % interval, and where it follows from."""
        columns, (name, size) = self.found.uncertainty, self.units.get(end, ("", 1.0))
        low, high = (columns[f"{stem}_{side}{end}"] / size for side in ("low", "high"))
        error = getattr(self.found, f"{stem}_error{end}") / size
        of_static = stem == "mu_static_apparent" or _moves_at_static_friction(self.found)
        first_order = of_static and columns.get("interval_method") == FIRST_ORDER
        origin = FROM_LINEAR_MODEL if first_order else FROM_INPUTS
        return f"95 % interval {interval_text(low, high, name, error=error)}, {origin}"


ENDS = ("_m_s", "_N_m", "_m", "_N", "_W", "_J", "_Pa", "_s")
"""Ends of columns that name their unit."""
Show = Callable[..., list[str]]
"""show(title, template, when) -> lines"""
