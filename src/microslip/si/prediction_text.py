"""A Prediction in words: the lines that `microslip predict` and print() show."""

from __future__ import annotations

import math
from collections.abc import Iterator

from microslip.foundation.number_text import ROUNDING, interval_text, number_text
from microslip.si.motions import COMBINED, is_along_the_pull, unit_of_amplitude
from microslip.si.prediction import (
    Forced,
    Oscillating,
    Prediction,
    Rest,
    Search,
    Sliding,
    SteadySpin,
    Travel,
)
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
PLAIN = ("", 1.0)
"""The unit of dimensionless numbers."""
RADIAN = ("rad", 1.0)


def prediction_text(found: Prediction) -> str:
    """All lines of a Prediction."""
    return "\n".join(_Text(found).lines())


class _Text:
    """A Prediction with the units in which its quantities are shown."""

    def __init__(self, found: Prediction):
        self.found = found
        self.length = length_unit(found.u_lim_m)
        self.speed = f"{self.length[0]}/s", self.length[1]
        self.force = force_unit(found.friction_force_still_N)
        self.turned = unit_of_amplitude(found.motion) == "rad"
        self.added = ADDED.get(found.motion, "vibration")

    def number(self, name: str, si: str = "", unit: tuple[str, float] = PLAIN) -> str:
        """A quantity with its error, si: the SI unit at the end of its column."""
        end = f"_{si}" if si else ""
        error = getattr(self.found, f"{name}_error{end}")
        return in_unit(getattr(self.found, name + end), error, unit)

    def interval(
        self, name: str, si: str = "", unit: tuple[str, float] = PLAIN, *, linear: bool = True
    ) -> list[str]:
        """The line of the 95 % interval of a quantity, if there is one.

        linear: whether the method of the interval of static friction is that of this one, too.
        """
        end, columns = f"_{si}" if si else "", self.found.uncertainty
        if f"{name}_low{end}" not in columns:
            return []
        low, high = (columns[f"{name}_{side}{end}"] / unit[1] for side in ("low", "high"))
        error = getattr(self.found, f"{name}_error{end}") / unit[1]
        first_order = linear and columns.get("interval_method") == FIRST_ORDER
        origin = FROM_LINEAR_MODEL if first_order else FROM_INPUTS
        text = interval_text(low, high, unit[0], error=error)
        return [line("", f"95 % interval {text}, {origin}")]

    def lines(self) -> Iterator[str]:
        found = self.found
        for name in UNDERSTOOD:
            if name in found.understood:
                yield line(name.replace("_", " "), found.understood[name])
        yield ""
        yield from self.contact()
        if isinstance(found, Sliding) and found.search is not None:
            yield self.sought(found.search)
        yield from self.groups_of_drive()
        if isinstance(found, Forced):
            yield from self.threshold()
            yield from self.safety(found)
            yield from self.outcome(found)
        else:
            yield from self.friction()
        yield from self.spread()
        yield from self.energy()
        yield from not_converged(found)
        yield from (f"warning: {text}" for text in found.warnings)
        yield from (f"not checked: {text}" for text in found.not_checked)

    def contact(self) -> Iterator[str]:
        found = self.found
        unit = self.length
        if found.contact_radius_m >= LARGEST_NUMBER * unit[1]:
            unit = unit_for(found.contact_radius_m, LENGTHS)
        yield line("contact radius", in_unit(found.contact_radius_m, 0.0, unit))
        if not math.isnan(found.indentation_m):
            yield line("indentation", in_unit(found.indentation_m, 0.0, self.length))
        yield line("u_lim", in_unit(found.u_lim_m, 0.0, self.length))
        pressure = "infinite, at the tip"
        if math.isfinite(found.largest_pressure_Pa):
            pressure = in_unit(found.largest_pressure_Pa, 0.0, ("MPa", 1e6))
        yield line("largest pressure", pressure)
        if isinstance(found, Oscillating):
            size = "the largest is "
            if found.motion not in COMBINED:
                unit = RADIAN if self.turned else self.length
                size = f"{in_unit(found.amplitude_si or 0.0, 0.0, unit)}, "
            yield line("amplitude", f"{size}dimensionless {number_text(found.amplitude)}")
        if found.velocity is not None and not isinstance(found, Forced):
            yield line("velocity", f"dimensionless {number_text(found.velocity)}")

    def unit_of_sought(self, search: Search) -> tuple[str, float]:
        if search.sought == "amplitude":
            return RADIAN if self.turned else self.length
        return self.speed if search.sought == "speed" else force_unit(self.found.load_N)

    def sought(self, search: Search) -> str:
        """The line of the quantity with the wanted reduction."""
        size, unit = self.found.sought_value, self.unit_of_sought(search)
        value, exact = in_unit(size, search.sought_error, unit), in_unit(size, 0.0, unit)
        end = "the least that" if search.sought == "amplitude" else "the largest at which vibration"
        share = f"takes {self.found.understood['reduction']} away"
        here = f"all other lines are for {exact}"
        return line("found", f"{search.sought} {value}, {end} {share}; {here}")

    def groups_of_drive(self) -> Iterator[str]:
        """Lines of the groups of the drive, and of its regime."""
        found = self.found
        groups = {"force": found.force} if isinstance(found, Forced) else {}
        body = found.body if isinstance(found, Oscillating) else None
        if body is not None:
            groups |= {name: getattr(body, name) for name in ("stiffness", "mass", "damping")}
        for name, group in groups.items():
            if group is not None:
                yield line(name, f"dimensionless {number_text(group)}")
        if body is None:
            return
        if found.load_amplitude_N:
            yield line("groups", REFERENCE_LOADS)
        yield line("regime", REGIMES[body.regime])
        if body.natural_frequency is not None:
            frequency = body.natural_frequency * found.frequency_Hz
            text = in_unit(frequency, 0.0, prefixed(frequency, "Hz"))
            yield line("natural frequency", f"{text}, of the mass on a contact that sticks")

    def friction(self) -> Iterator[str]:
        """Lines of the friction at a given speed: which number is a ratio, which a coefficient."""
        found, added = self.found, self.added
        still = in_unit(found.friction_force_still_N, 0.0, self.force)
        less = number_text(100.0 * found.force_reduction, 100.0 * found.mu_macro_error, "%")
        ratio = f"ratio of friction with {added} to friction without"
        yield line("mu_macro", f"{self.number('mu_macro')}: {ratio}")
        coefficient = f"coefficient of friction with {added}, instead of {found.understood['mu']}"
        yield line("mu_apparent", f"{self.number('mu_apparent')}: {coefficient}")
        force = self.number("friction_force", "N", self.force)
        yield line("friction force", f"{force} instead of {still}: {less} less")
        if found.mu_static is not None:
            value = self.number("mu_static_apparent")
            yield line("static friction", f"{value}: coefficient of friction at vanishing speed")
            yield from self.interval("mu_static_apparent")
            if found.force_threshold_N is not None:
                if not self.moves_at_static_friction():
                    yield line("", ALONG_THE_PULL)
            elif is_along_the_pull(found.motion):
                yield line("", UNKNOWN_THRESHOLD)
        yield from self.threshold()

    def moves_at_static_friction(self) -> bool:
        """Whether the force threshold is the static friction."""
        still, static = self.found.friction_force_still_N, self.found.mu_static
        return static is not None and math.isclose(
            self.found.force_threshold_N or 0.0, still * static, abs_tol=0.0
        )

    def threshold(self) -> Iterator[str]:
        """Lines of the force that moves the contact, if it is known."""
        value, error = self.found.force_threshold_N, self.found.force_threshold_error_N
        if value is None or error is None:
            return
        rounding = ROUNDING * self.found.load_N  # as for static friction, times the load
        nothing = value <= max(error, rounding)
        if nothing:
            most = 0.0 if value <= error <= rounding else value + error
            text, words = in_unit(0.0, most, self.force), "any constant force"
            words += " beyond that" if most else ""
        else:
            text, words = in_unit(value, error, self.force), "no smaller constant force"
        yield line("force threshold", f"{text}: {words} moves the contact")
        if not nothing or self.found.force_threshold_high_N:
            linear = self.moves_at_static_friction()
            yield from self.interval("force_threshold", "N", self.force, linear=linear)

    def safety(self, found: Forced) -> Iterator[str]:
        factor, error = found.safety_factor, found.safety_factor_error
        if factor is None or error is None:
            return
        if factor > error or found.safety_factor_high:
            yield line("safety factor", f"{number_text(factor, error)}: threshold over force")
            yield from self.interval("safety_factor", linear=self.moves_at_static_friction())

    def outcome(self, found: Forced) -> Iterator[str]:
        """Lines of the outcome of a force, and of its probabilities."""
        if found.outcome is not None:
            verdict = {
                "moves": "it moves, cycle by cycle",
                "stays": "it stays: the force is below the threshold",
                "runs away": runs_away(found),
                "undecided": "the error does not tell whether it moves: by "
                + in_unit(found.speed_m_s + found.speed_error_m_s, 0.0, self.speed)
                + " at most",
            }[found.outcome]
            central = "with the central values " if "probability_error" in found.uncertainty else ""
            yield line("outcome", central + verdict)
        yield from self.probability()
        if found.travel is not None:
            yield from self.way(found, found.travel)
        if isinstance(found, Rest):
            yield from self.rest(found)

    def probability(self) -> Iterator[str]:
        """The line of the probabilities of each outcome."""
        columns = self.found.uncertainty
        shares = [
            f"{probability_text(columns[name], columns['probability_error'])} that it {words}"
            for name, words in PROBABILITIES.items()
            if name in columns
        ]
        if shares and "probability_stays" not in columns:
            shares.append("not computed: that it stays or moves")
        if shares:
            yield line("probability", ", ".join(shares))

    def way(self, found: Forced, travel: Travel) -> Iterator[str]:
        """Lines of the speed of a contact that moves."""
        yield line("speed", self.number("speed", "m_s", self.speed))
        if isinstance(found, Oscillating):
            way = self.number("displacement_per_cycle", "m", self.length)
            yield line("displacement", f"{way} a cycle")
        radius = in_unit(found.contact_radius_m, 0.0, self.length)
        short = self.number("time_to_1_mm", "s", unit_for(travel.time_to_1_mm_s, TIMES))
        unit = unit_for(travel.time_to_contact_radius_s, TIMES)
        long = self.number("time_to_contact_radius", "s", unit)
        yield line("walks", f"1 mm in {short}, the contact radius of {radius} in {long}")

    def rest(self, found: Rest) -> Iterator[str]:
        """The line of the displacement of a contact that stays."""
        text = f"not known: {found.displacement_reason}"
        if found.displacement_m is not None:
            most = "the vibration adds nothing"
            if found.cycles_to_rest:
                cycles = f"about {found.cycles_to_rest:.2g} cycles"
                most = f"nine tenths of what the vibration adds within {cycles}"
            way = self.number("displacement", "m", self.length)
            text = f"{way} forward, then no further: {most}"
        yield line("displacement", text)

    def spread(self) -> Iterator[str]:
        """The line of the standard uncertainties that follow from those of the inputs."""
        found, columns = self.found, self.found.uncertainty
        if not columns:
            return
        if isinstance(found, Forced):
            spread = columns["speed_spread_m_s"]
            if math.isinf(spread):
                yield line("spread", NO_SPREAD_OF_SPEED)
                return
            if spread == 0.0 and columns.get("probability_moves", 0.0) > EXCLUDED:
                yield line("spread", STAYS_WITHIN_SPREADS)
                return
            shares = {"the speed": (spread, self.speed)}
        else:
            shares = {
                "mu_apparent": (columns["mu_apparent_spread"], PLAIN),
                "the force": (columns["friction_force_spread_N"], self.force),
            }
        text = "standard uncertainties that follow from those of the inputs"
        if isinstance(found, Sliding) and found.search is not None:
            sought, unit = found.search.sought, self.unit_of_sought(found.search)
            shares = {f"the {sought}": (columns["sought_spread"], unit)} | shares
            text += f", as does the {sought}"
        if found.power is not None:
            text += "; none is computed for torque, power and energy"
        parts = [
            f"{number_text(value / size, unit=name, digits=2)} of {what}"
            for what, (value, (name, size)) in shares.items()
        ]
        yield line("spread", f"{', '.join(parts)}: {text}")

    def energy(self) -> Iterator[str]:
        """Lines of torque and power, where they are known and more than the force tells."""
        found, power = self.found, self.found.power
        if power is None:
            return
        if isinstance(found, SteadySpin):
            unit = prefixed(found.torque_N_m or 0.0, "N m")
            yield line("torque", self.number("torque", "N_m", unit))
        largest = max(abs(found.drag_power_W or 0.0), abs(power.vibration_power_W)) or 1.0
        unit = prefixed(largest, "W")
        yield line("power", f"{self.number('vibration_power', 'W', unit)} for the {self.added}")
        yield line("", f"{self.number('drag_power', 'W', unit)} for the drag")
        heat = self.number("energy_per_cycle", "J", prefixed(power.energy_per_cycle_J, "J"))
        yield line("energy", f"{heat} a cycle turn into heat")
