"""A Prediction in words, as printed by `microslip predict` and print()."""

from __future__ import annotations

import math
from typing import Any

from microslip.foundation.number_text import ROUNDING, interval_text, number_text
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
    speed_unit,
    unit_for,
)

UNDERSTOOD = (
    *("motion", "body", "counterbody", "radius", "counter_radius", "radius_across"),
    *("contact_radius", "pressure", "load", "mu", "speed"),
    *("force", "drive_stiffness", "mass", "damping"),
    *("amplitude", "forward_amplitude", "rotation_amplitude", "load_amplitude", "phase"),
    *("frequency", "rotation", "reduction", "map"),
)
"""Arguments of `predict`, in the order in which they are printed."""
PROBABILITIES = {
    "probability_stays": "stays",
    "probability_moves": "moves",
    "probability_runs_away": "runs away",
}
"""Names of the outcomes, keyed by their probability columns."""
LARGEST_NUMBER = 1e4
"""Largest value of the contact radius that is printed in the unit of the other lengths.  A larger
radius is printed in another unit."""
ADDED = {"bore": "spin", "continuous-bore": "spin", "transverse-bore": "vibration and spin"}
"""Names of the oscillation or spin, for motions other than a single vibration."""
TIMES = (
    *(("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0)),
    *(("s", 1.0), ("ms", 1e-3), ("us", 1e-6)),
)
REFERENCE_LOADS = (
    "stiffness, mass and damping are divided by mu times the load without oscillation (the "
    "reference load), force and mu_macro by mu times the mean load"
)
"""Remark on a drive's dimensionless groups under an oscillating normal load."""
ALONG_THE_DRIVE = (
    "it is not the force threshold, because the vibration is along the drive: at a prescribed "
    "speed it reverses the force, which reduces the mean; under a constant force a body without "
    "mass follows the vibration, and all of friction holds it"
)
"""Explanation of why the static friction is below the force threshold."""
UNKNOWN_THRESHOLD = (
    "it is not the force threshold, because part of the vibration is along the drive; with --force "
    "the prediction says whether the contact moves"
)
"""Explanation printed with the static friction if the force threshold is unknown."""
FROM_INPUTS = "from the uncertain inputs"
FROM_LINEAR_MODEL = (
    f"{FROM_INPUTS} to first order: static friction is assumed to be linear in each of them"
)
"""Texts for the two methods of computing an interval: quantiles, and first order."""
NO_SPREAD_OF_SPEED = "none of the speed: the contact can run away"
"""Text for a contact that can run away if the inputs vary within their uncertainty."""
STAYS_WITHIN_SPREADS = "none of the speed: the contact can move"
"""Text for a contact that stays at rest if every input is within one standard deviation, but can
move otherwise."""
OUTCOMES = {
    "moves": "it moves, cycle by cycle",
    "stays": "it stays: the force is below the threshold",
    "undecided": "undecided within the error: it moves by at most {fastest}",
}
"""Sentences that describe the outcomes, except for a contact that runs away."""
POWERS: dict[str, dict[str, float]] = {
    "amplitude": {"amplitude": 1.0},
    "speed": {"velocity": 1.0},
    "load": {
        **{"contact_radius_m": 1.0 / 3.0, "indentation_m": 2.0 / 3.0, "u_lim_m": 2.0 / 3.0},
        **{"largest_pressure_Pa": 1.0 / 3.0, "amplitude": -2.0 / 3.0, "velocity": -2.0 / 3.0},
        "friction_force_still_N": 1.0,
    },
    "load of a size": {
        **{"indentation_m": 1.0, "u_lim_m": 1.0, "largest_pressure_Pa": 1.0, "amplitude": -1.0},
        **{"velocity": -1.0, "friction_force_still_N": 1.0},
    },
}
"""Exponents of values that are powers of the result of a search, for Hertz's contacts and for
contacts of a prescribed size."""
SPINS: dict[str, dict[str, float]] = {
    "amplitude": {"velocity": -1.0},
    "load": {"amplitude": -1.0 / 3.0, "velocity": -1.0 / 3.0},
    "load of a size": {"velocity": 0.0},
}
"""Exponents that differ from POWERS for a bore."""
ENDS = ("_m_s", "_N_m", "_m", "_N", "_W", "_J", "_Pa", "_s")
"""Column-name suffixes that state the unit."""


def prediction_text(record: Any) -> str:
    """The printed text of a Prediction."""
    understood = [
        line(name.replace("_", " "), record.understood[name])
        for name in UNDERSTOOD
        if name in record.understood
    ]
    remarks = [f"warning: {text}" for text in record.warnings]
    remarks += [f"not checked: {text}" for text in record.not_checked]
    return "\n".join([*understood, "", *_Texts(record).lines(), *not_converged(record), *remarks])


def _moves_at_static_friction(record: Any) -> bool:
    """True if the force threshold equals the static friction."""
    static, threshold = record.mu_static, record.force_threshold_N
    if static is None or threshold is None:
        return False
    return math.isclose(threshold, record.friction_force_still_N * static, abs_tol=0.0)


class _Texts(dict[str, Any]):
    """Texts of the columns of a Prediction: numbers with errors and units."""

    def __init__(self, record: Any):
        length, force = length_unit(record.u_lim_m), force_unit(record.friction_force_still_N)
        powers = [record.drag_power_W or 0.0, record.vibration_power_W or 0.0]
        watts = prefixed(max(map(abs, powers)) or 1.0, "W")
        largest_speed = abs(record.speed_m_s) + (record.speed_error_m_s or 0.0)
        speed, self.record = speed_unit(largest_speed, record.u_lim_m), record
        pressure = prefixed(record.largest_pressure_Pa, "Pa")
        self.units = {"_m_s": speed, "_m": length, "_N": force, "_W": watts, "_Pa": pressure}
        super().__init__(understood=record.understood, added=ADDED.get(record.motion, "vibration"))
        less = 100.0 * record.force_reduction, 100.0 * record.mu_macro_error
        self["reduction"] = number_text(*less, "%")
        if math.isinf(record.largest_pressure_Pa):
            self["largest_pressure_Pa"] = "infinite, at the tip"
        if record.contact_radius_m >= LARGEST_NUMBER * length[1]:
            unit = unit_for(record.contact_radius_m, LENGTHS)
            self["contact_radius_m"] = in_unit(record.contact_radius_m, 0.0, unit)
        turned = ("rad", 1.0) if record.kind.unit == "rad" else length
        if record.amplitude_si is not None:
            self["size"] = in_unit(record.amplitude_si, 0.0, turned)
        if record.sought is not None:
            self._seek({"amplitude": turned, "speed": speed, "load": force_unit(record.load_N)})
        if record.force_N is not None:
            self["fastest"] = in_unit(record.speed_m_s + record.speed_error_m_s, 0.0, speed)
        if record.natural_frequency is not None:
            frequency = record.natural_frequency * record.frequency_Hz
            self["natural_frequency_Hz"] = in_unit(frequency, 0.0, prefixed(frequency, "Hz"))

    def lines(self) -> list[str]:
        """The lines about the answer."""
        record, show, forced = self.record, self.show, self.record.force_N is not None
        pressure = "{largest_pressure_Pa}" + (" under {load_N}" if record.load_amplitude_N else "")
        lines = show("contact radius", "{contact_radius_m}")
        lines += show("indentation", "{indentation_m}", not math.isnan(record.indentation_m))
        lines += show("u_lim", "{u_lim_m}") + show("largest pressure", pressure)
        several = record.kind.several
        lines += show("amplitude", "{size}, dimensionless {amplitude}", not several)
        lines += show("amplitude", "the largest is dimensionless {amplitude}", several)
        lines += show("velocity", "dimensionless {velocity}", not forced)
        sentence = "{sought} {sought_text}, {least} with a reduction of {understood[reduction]}"
        lines += show("found", sentence + "; all other lines are for {sought_exact}")
        for name in ("force", "stiffness", "mass", "damping"):
            lines += show(name, f"dimensionless {{{name}}}")
        driven = record.stiffness is not None or record.mass is not None
        lines += show("groups", REFERENCE_LOADS, bool(record.load_amplitude_N and driven))
        mass = "{natural_frequency_Hz}, of the mass on a contact that sticks"
        lines += show("natural frequency", mass)
        lines += self._outcome() if forced else self._friction()
        lines += self._spread()
        lines += show("torque", "{torque_N_m}")
        lines += show("power", "{vibration_power_W} for the {added}")
        lines += show("", "{drag_power_W} for the drag", record.dissipated_power_W is not None)
        lines += show("energy", "{energy_per_cycle_J} of heat a cycle")
        return lines + show("wear", "{wear_depth_per_cycle_m} a cycle, mean depth over the contact")

    def _friction(self) -> list[str]:
        """Lines about the friction at a prescribed speed."""
        record, show = self.record, self.show
        lines = show("mu_macro", "{mu_macro}: ratio of friction with {added} to friction without")
        coefficient = "coefficient of friction with {added}, instead of {understood[mu]}"
        lines += show("mu_apparent", f"{{mu_apparent}}: {coefficient}")
        force = "{friction_force_N} instead of {friction_force_still_N}: {reduction} less"
        lines += show("friction force", force)
        static = "{mu_static_apparent}: coefficient of friction at vanishing speed"
        lines += show("static friction", static) + show("", "{mu_static_apparent_interval}")
        if record.mu_static is not None:
            threshold, along = record.force_threshold_N, record.kind.along_the_drive
            lines += show("", UNKNOWN_THRESHOLD, threshold is None and along)
            apart = threshold is not None and not _moves_at_static_friction(record)
            lines += show("", ALONG_THE_DRIVE, apart)
        return lines + self._threshold()

    def _threshold(self) -> list[str]:
        """Lines about the force threshold; empty if the threshold is unknown."""
        record, unit = self.record, self.units["_N"]
        value, error = record.force_threshold_N, record.force_threshold_error_N
        if value is None or error is None:
            return []
        rounding = ROUNDING * record.load_N  # as for static friction, multiplied by the load
        if value > max(error, rounding):
            sentence = "{force_threshold_N}: no smaller constant force moves the contact"
        elif value <= error <= rounding:
            sentence = f"{in_unit(0.0, 0.0, unit)}: any constant force moves the contact"
        else:
            zero = in_unit(0.0, value + error, unit)
            sentence = f"{zero}: any larger constant force moves the contact"
        positive = value > max(error, rounding) or bool(record.force_threshold_high_N)
        lines = self.show("force threshold", sentence)
        return lines + self.show("", "{force_threshold_interval_N}", positive)

    def _outcome(self) -> list[str]:
        """Lines about a contact under a force: its threshold, outcome and displacement."""
        record, show, lines = self.record, self.show, self._threshold()
        columns, factor = record.uncertainty, record.safety_factor or 0.0
        safe = factor > (record.safety_factor_error or 0.0) or record.safety_factor_high
        lines += show("safety factor", "{safety_factor}: threshold over force", bool(safe))
        lines += show("", "{safety_factor_interval}", bool(safe))
        central = "with the central values " if "probability_error" in columns else ""
        away = record.outcome == "runs away"
        text = runs_away(record) if away else OUTCOMES.get(record.outcome, "")
        lines += show("outcome", central + text, record.outcome is not None)
        shares = [
            f"{probability_text(columns[name], columns['probability_error'])} that it {words}"
            for name, words in PROBABILITIES.items()
            if name in columns
        ]
        if shares and "probability_stays" not in columns:
            shares.append("not computed for staying and moving")
        lines += show("probability", ", ".join(shares), bool(shares))
        if record.outcome == "moves":
            lines += show("speed", "{speed_m_s}")
            lines += show("displacement", "{displacement_per_cycle_m} a cycle")
            way = "{time_to_1_mm_s}, the contact radius of {contact_radius_m} in"
            lines += show("travel", f"1 mm in {way} {{time_to_contact_radius_s}}")
        if record.outcome == "stays":
            most = "the vibration adds nothing"
            if record.cycles_to_rest:
                cycles = f"about {record.cycles_to_rest:.2g} cycles"
                most = f"nine tenths of the part caused by the vibration within {cycles}"
            lines += show("displacement", f"{{displacement_m}} forward, then no further: {most}")
            unknown = record.displacement_m is None
            lines += show("displacement", "unknown: {displacement_reason}", unknown)
        return lines

    def _spread(self) -> list[str]:
        """The line with the standard uncertainties that result from uncertain inputs."""
        record, show = self.record, self.show
        if not record.uncertainty:
            return []
        parts = ["{mu_apparent_spread} of mu_apparent", "{friction_force_spread_N} of the force"]
        if record.force_N is not None:
            spread, moves = record.speed_spread_m_s, record.probability_moves or 0.0
            if math.isinf(spread):
                return show("spread", NO_SPREAD_OF_SPEED)
            if spread == 0.0 and moves > EXCLUDED:
                return show("spread", STAYS_WITHIN_SPREADS)
            parts = ["{speed_spread_m_s} of the speed"]
        text = "standard uncertainties from the uncertain inputs"
        if record.sought is not None:
            parts.insert(0, "{sought_spread_text} of the {sought}")
        if record.dissipated_power_W is not None:
            text += "; not computed for torque, power and energy"
        return show("spread", f"{', '.join(parts)}: {text}")

    def _seek(self, units: dict[str, tuple[str, float]]) -> None:
        """Add the texts for the result of a search."""
        record, unit = self.record, units[self.record.sought]
        self["sought_text"] = in_unit(record.sought_value, record.sought_error, unit)
        self["sought_exact"] = in_unit(record.sought_value, 0.0, unit)
        self["least"] = "the least" if record.sought == "amplitude" else "the largest"
        spread = record.sought_spread
        if spread is not None:
            self["sought_spread_text"] = number_text(spread / unit[1], 0.0, unit[0], digits=2)

    def show(self, title: str, template: str, when: bool = True) -> list[str]:
        """The line for a template; empty if a column in the template is unknown."""
        try:
            return [line(title, template.format_map(self))] if when else []
        except KeyError:
            return []

    def __missing__(self, name: str) -> str:
        """The text of a column or of an interval.  Raises KeyError if the column is unknown."""
        end = next((end for end in ENDS if name.endswith(end)), "")
        stem = name.removesuffix(end)
        if stem.endswith("_interval"):
            return self._interval(stem.removesuffix("_interval"), end)
        value = getattr(self.record, name, None)
        if value is None:
            raise KeyError(name)
        if isinstance(value, str):
            return value
        unit = self.units.get(end, ("", 1.0))
        if end == "_s":
            unit = unit_for(value, TIMES)
        elif end in ("_J", "_N_m") or stem.startswith("wear_"):
            unit = prefixed(value, end[1:].replace("_", " "))
        if stem.endswith("_spread"):
            return number_text(value / unit[1], 0.0, unit[0], digits=2)
        error = getattr(self.record, f"{stem}_error{end}", None)
        return in_unit(value, error or self._error_of_root(name), unit)

    def _error_of_root(self, name: str) -> float:
        """Error of a value that is a power of the result of a search; 0 for other values."""
        record = self.record
        if record.sought is None:
            return 0.0
        sized = "contact_radius" in record.understood
        key = f"{record.sought} of a size" if sized and record.sought == "load" else record.sought
        powers = POWERS[key] | (SPINS.get(key, {}) if record.kind.unit == "rad" else {})
        share = record.sought_error / record.sought_value if record.sought_value else 0.0
        return abs(powers.get(name, 0.0) * share * getattr(record, name))

    def _interval(self, stem: str, end: str) -> str:
        """The text of a 95 % interval, with its method."""
        columns, (name, size) = self.record.uncertainty, self.units.get(end, ("", 1.0))
        low, high = (columns[f"{stem}_{side}{end}"] / size for side in ("low", "high"))
        error = getattr(self.record, f"{stem}_error{end}") / size
        of_static = stem == "mu_static_apparent" or _moves_at_static_friction(self.record)
        first_order = of_static and columns.get("interval_method") == FIRST_ORDER
        origin = FROM_LINEAR_MODEL if first_order else FROM_INPUTS
        return f"95 % interval {interval_text(low, high, name, error=error)}, {origin}"
