"""A Prediction in words: the lines that `microslip predict` and print() show."""

from __future__ import annotations

import math
from typing import Any

from microslip.foundation.number_text import ROUNDING, number_text
from microslip.si.motions import COMBINED, is_along_the_pull, unit_of_amplitude
from microslip.si.printed_lines import (
    ALONG_THE_PULL,
    EXCLUDED,
    LENGTHS,
    NO_SPREAD_OF_SPEED,
    REFERENCE_LOADS,
    STAYS_WITHIN_SPREADS,
    TIMES,
    UNKNOWN_THRESHOLD,
    force_unit,
    in_unit,
    interval_lines,
    length_unit,
    line,
    not_converged,
    prefixed,
    pressure_text,
    probability_text,
    runs_away,
    unit_for,
)
from microslip.si.regimes import REGIMES

UNDERSTOOD: tuple[str, ...] = (
    "motion",
    "body",
    "counterbody",
    "radius",
    "counter_radius",
    "radius_across",
)
UNDERSTOOD += ("contact_radius", "pressure", "load", "contacts", "mu", "speed")
UNDERSTOOD += ("force", "drive_stiffness", "mass", "damping")
UNDERSTOOD += ("amplitude", "forward_amplitude", "rotation_amplitude", "load_amplitude", "phase")
UNDERSTOOD += ("frequency", "rotation", "reduction")
"""Arguments in the order in which they are shown."""
LARGEST_NUMBER = 1e4
"""Largest contact radius in the unit of the other lengths, four digits before the point."""
ADDED = {"bore": "spin", "continuous-bore": "spin", "transverse-bore": "vibration and spin"}
"""The added motion in words, where it is more than vibration."""


def prediction_text(found: Any) -> str:
    """All lines of a prediction.Prediction."""
    return _Text(found).whole()


class _Text:
    """A Prediction with the units in which its quantities are shown."""

    def __init__(self, found: Any):
        self.found = found
        self.length = length_unit(found.u_lim_m)
        self.speed = f"{self.length[0]}/s", self.length[1]
        self.force = force_unit(found.friction_force_still_N)
        powers = [found.drag_power_W, found.vibration_power_W]
        self.power = prefixed(max((abs(one) for one in powers if one), default=1.0), "W")

    def whole(self) -> str:
        found = self.found
        lines = [
            line(name.replace("_", " "), found.understood[name])
            for name in UNDERSTOOD
            if name in found.understood
        ]
        lines += ["", *self.contact(), *self.sought(), *self.groups_of_drive()]
        lines += self.friction() if found.force_N is None else self.walk()
        lines += self.spread() + self.energy() + not_converged(found)
        lines += [f"warning: {text}" for text in found.warnings]
        lines += [f"not checked: {text}" for text in found.not_checked]
        return "\n".join(lines)

    def contact(self) -> list[str]:
        found = self.found
        unit = self.length
        if found.contact_radius_m >= LARGEST_NUMBER * unit[1]:
            unit = unit_for(found.contact_radius_m, LENGTHS)
        lines = [line("contact radius", in_unit(found.contact_radius_m, 0.0, unit))]
        if not math.isnan(found.indentation_m):
            lines.append(line("indentation", in_unit(found.indentation_m, 0.0, self.length)))
        lines.append(line("u_lim", in_unit(found.u_lim_m, 0.0, self.length)))
        under = ""
        if found.load_amplitude_N:
            under = f" under {in_unit(found.load_N, 0.0, force_unit(found.load_N))}"
        lines.append(line("largest pressure", pressure_text(found.largest_pressure_Pa) + under))
        if found.amplitude is not None:
            group = f"dimensionless {number_text(found.amplitude)}"
            lines.append(line("amplitude", f"{self.amplitude()}{group}"))
        if found.velocity is not None and found.force_N is None:
            lines.append(line("velocity", f"dimensionless {number_text(found.velocity)}"))
        return lines

    def amplitude(self) -> str:
        """The amplitude with its unit and a comma; several share the largest group."""
        found = self.found
        if found.motion in COMBINED:
            return "the largest is "
        unit = ("rad", 1.0) if unit_of_amplitude(found.motion) == "rad" else self.length
        return f"{in_unit(found.amplitude_si, 0.0, unit)}, "

    def unit_of_sought(self) -> tuple[str, float]:
        found = self.found
        if found.sought == "amplitude":
            return ("rad", 1.0) if unit_of_amplitude(found.motion) == "rad" else self.length
        return self.speed if found.sought == "speed" else force_unit(found.load_N)

    def sought(self) -> list[str]:
        """The line of the quantity with the wanted reduction."""
        found = self.found
        if found.sought is None:
            return []
        value = in_unit(found.sought_value, found.sought_error, self.unit_of_sought())
        end = "the least that" if found.sought == "amplitude" else "the largest at which vibration"
        share = f"takes {found.understood['reduction']} away"
        exact = in_unit(found.sought_value, 0.0, self.unit_of_sought())
        here = f"all other lines are for {exact}"
        return [line("found", f"{found.sought} {value}, {end} {share}; {here}")]

    def groups_of_drive(self) -> list[str]:
        """Lines of the groups of the drive, and of its regime."""
        found = self.found
        names = [
            name
            for name in ("force", "stiffness", "mass", "damping")
            if getattr(found, name) is not None
        ]
        lines = [line(name, f"dimensionless {number_text(getattr(found, name))}") for name in names]
        if found.load_amplitude_N and set(names) - {"force"}:
            lines.append(line("groups", REFERENCE_LOADS))
        if found.regime is not None:
            lines.append(line("regime", REGIMES[found.regime]))
        if found.natural_frequency is not None:
            frequency = found.natural_frequency * found.frequency_Hz
            text = in_unit(frequency, 0.0, prefixed(frequency, "Hz"))
            lines.append(line("natural frequency", f"{text}, of the mass on a contact that sticks"))
        return lines

    def friction(self) -> list[str]:
        """Lines of the friction at a given speed: which number is a ratio, which a coefficient."""
        found, added = self.found, ADDED.get(self.found.motion, "vibration")
        ratio = number_text(found.mu_macro, found.mu_macro_error)
        coefficient = number_text(found.mu_apparent, found.mu_apparent_error)
        force = in_unit(found.friction_force_N, found.friction_force_error_N, self.force)
        still = in_unit(found.friction_force_still_N, 0.0, self.force)
        less = number_text(100.0 * found.force_reduction, 100.0 * found.mu_macro_error, "%")
        lines = [
            line("mu_macro", f"{ratio}: ratio of friction with {added} to friction without"),
            line(
                "mu_apparent",
                f"{coefficient}: coefficient of friction with {added}, "
                f"instead of {found.understood['mu']}",
            ),
            line("friction force", f"{force} instead of {still}: {less} less"),
        ]
        return lines + self.static_friction() + self.threshold()

    def static_friction(self) -> list[str]:
        found = self.found
        if found.mu_static is None:
            return []
        value = number_text(found.mu_static_apparent, found.mu_static_apparent_error)
        lines = [line("static friction", f"{value}: coefficient of friction at vanishing speed")]
        ends = found.mu_static_apparent_low, found.mu_static_apparent_high
        lines += interval_lines(ends, found.mu_static_apparent_error, found.interval_method)
        threshold = found.force_threshold_N
        if threshold is None and is_along_the_pull(found.motion):
            lines.append(line("", UNKNOWN_THRESHOLD))
        if threshold is not None and not self.moves_at_static_friction():
            lines.append(line("", ALONG_THE_PULL))
        return lines

    def moves_at_static_friction(self) -> bool:
        """Whether the force threshold is the static friction."""
        found = self.found
        still = found.friction_force_still_N
        return found.mu_static is not None and math.isclose(
            found.force_threshold_N, still * found.mu_static, abs_tol=0.0
        )

    def interval_of_threshold(
        self, ends: tuple[float | None, float | None], error: float, unit: tuple[str, float]
    ) -> list[str]:
        """The line of the interval of the threshold, or of the safety factor."""
        method = self.found.interval_method if self.moves_at_static_friction() else None
        return interval_lines(ends, error, method, unit)

    def threshold(self) -> list[str]:
        """Lines of the force that moves the contact, if it is known."""
        found = self.found
        value, error = found.force_threshold_N, found.force_threshold_error_N
        if value is None:
            return []
        rounding = ROUNDING * found.load_N  # as for static friction, times the load
        nothing = value <= max(error, rounding)
        if nothing:
            most = 0.0 if value <= error <= rounding else value + error
            text, words = in_unit(0.0, most, self.force), "any constant force"
            words += " beyond that" if most else ""
        else:
            text, words = in_unit(value, error, self.force), "no smaller constant force"
        lines = [line("force threshold", f"{text}: {words} moves the contact")]
        if nothing and not found.force_threshold_high_N:
            return lines
        ends = (found.force_threshold_low_N, found.force_threshold_high_N)
        return lines + self.interval_of_threshold(ends, error, self.force)

    def walk(self) -> list[str]:
        """Lines of the motion under a force."""
        found, lines = self.found, self.threshold()
        factor = found.safety_factor
        if factor is not None and (factor > found.safety_factor_error or found.safety_factor_high):
            text = number_text(factor, found.safety_factor_error)
            lines.append(line("safety factor", f"{text}: threshold over force"))
            ends = found.safety_factor_low, found.safety_factor_high
            lines += self.interval_of_threshold(ends, found.safety_factor_error, ("", 1.0))
        return lines + self.outcome()

    def outcome(self) -> list[str]:
        found = self.found
        if found.outcome is None:
            return self.probability()
        verdict, *further = {
            "moves": self.moves,
            "stays": self.stays,
            "runs away": self.accelerates,
            "undecided": self.undecided,
        }[found.outcome]()
        if found.probability_error is not None or found.probability_runs_away is not None:
            verdict = f"with the central values {verdict}"
        return [line("outcome", verdict), *self.probability(), *further]

    def probability(self) -> list[str]:
        """The line of the probabilities of each outcome."""
        found, error = self.found, self.found.probability_error or 0.0
        shares = [
            f"{probability_text(chance, error)} that it {words}"
            for chance, words in (
                (found.probability_stays, "stays"),
                (found.probability_moves, "moves"),
                (found.probability_runs_away, "runs away"),
            )
            if chance is not None
        ]
        if shares and found.probability_stays is None:
            shares.append("not computed: that it stays or moves")
        return [line("probability", ", ".join(shares))] if shares else []

    def moves(self) -> list[str]:
        found = self.found
        lines = [
            "it moves, cycle by cycle",
            line("speed", in_unit(found.speed_m_s, found.speed_error_m_s, self.speed)),
        ]
        if found.displacement_per_cycle_m is not None:
            way = in_unit(
                found.displacement_per_cycle_m, found.displacement_per_cycle_error_m, self.length
            )
            lines.append(line("displacement", f"{way} a cycle"))
        radius = in_unit(found.contact_radius_m, 0.0, self.length)
        short, long = (
            in_unit(time, error, unit_for(time, TIMES))
            for time, error in (
                (found.time_to_1_mm_s, found.time_to_1_mm_error_s),
                (found.time_to_contact_radius_s, found.time_to_contact_radius_error_s),
            )
        )
        return [*lines, line("walks", f"1 mm in {short}, the contact radius of {radius} in {long}")]

    def stays(self) -> list[str]:
        found, lines = self.found, ["it stays: the force is below the threshold"]
        if found.displacement_m is not None:
            way = in_unit(found.displacement_m, found.displacement_error_m, self.length)
            most = "the vibration adds nothing"
            if found.cycles_to_rest:
                cycles = f"about {found.cycles_to_rest:.2g} cycles"
                most = f"nine tenths of what the vibration adds within {cycles}"
            lines.append(line("displacement", f"{way} forward, then no further: {most}"))
        elif found.displacement_reason:
            lines.append(line("displacement", f"not known: {found.displacement_reason}"))
        return lines

    def accelerates(self) -> list[str]:
        return [runs_away(self.found)]

    def undecided(self) -> list[str]:
        most = self.found.speed_m_s + self.found.speed_error_m_s
        text = in_unit(most, 0.0, self.speed)
        return [f"the error does not tell whether it moves: by {text} at most"]

    def spread(self) -> list[str]:
        """The line of the standard uncertainties that follow from those of the inputs."""
        found = self.found
        if found.mu_apparent_spread is None:
            return []
        if found.force_N is not None:
            if math.isinf(found.speed_spread_m_s):
                return [line("spread", NO_SPREAD_OF_SPEED)]
            if found.speed_spread_m_s == 0.0 and (found.probability_moves or 0.0) > EXCLUDED:
                return [line("spread", STAYS_WITHIN_SPREADS)]
            shares = [f"{self.in_two_digits(found.speed_spread_m_s, self.speed)} of the speed"]
        else:
            shares = [
                f"{self.in_two_digits(found.mu_apparent_spread, ('', 1.0))} of mu_apparent",
                f"{self.in_two_digits(found.friction_force_spread_N, self.force)} of the force",
            ]
        if found.sought is not None:
            value = self.in_two_digits(found.sought_spread, self.unit_of_sought())
            shares.insert(0, f"{value} of the {found.sought}")
        text = "standard uncertainties that follow from those of the inputs"
        if found.sought is not None:
            text += f", as does the {found.sought}"
        if found.vibration_power_W is not None:
            text += "; none is computed for torque, power and energy"
        return [line("spread", f"{', '.join(shares)}: {text}")]

    def in_two_digits(self, value: float, unit: tuple[str, float]) -> str:
        name, size = unit
        return number_text(value / size, unit=name, digits=2)

    def energy(self) -> list[str]:
        """Lines of torque and power, where they are known and more than the force tells."""
        found = self.found
        if found.vibration_power_W is None:
            return []
        energy = prefixed(found.energy_per_cycle_J, "J")
        vibration, drag, heat = (
            in_unit(*one)
            for one in (
                (found.vibration_power_W, found.vibration_power_error_W, self.power),
                (found.drag_power_W, found.drag_power_error_W, self.power),
                (found.energy_per_cycle_J, found.energy_per_cycle_error_J, energy),
            )
        )
        lines = [
            line("power", f"{vibration} for the {ADDED.get(found.motion, 'vibration')}"),
            line("", f"{drag} for the drag"),
            line("energy", f"{heat} a cycle turn into heat"),
        ]
        if found.torque_N_m is not None:
            unit = prefixed(found.torque_N_m, "N m")
            lines.insert(0, line("torque", in_unit(found.torque_N_m, found.torque_error_N_m, unit)))
        return lines
