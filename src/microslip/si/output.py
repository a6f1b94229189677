"""The outputs of a prediction: one table for text, JSON, CSV files, datasets and reference page."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from microslip.foundation.number_text import ROUNDING, interval_text, number_text, prefixed
from microslip.si.inputs import INPUTS

if TYPE_CHECKING:
    import xarray as xr


class Output(NamedTuple):
    """An output of `predict`.

    Attributes
    ----------
    unit : str
        SI unit, empty for a pure number.
    sentence : str
        Sentence that is printed after the number.
    closed_form : callable or None
        closed_form(contact): value of the output for an si.contact.Contact, which can have arrays.
        None for an output that predict.outputs computes from the answer of the solver.
    """

    unit: str
    sentence: str = ""
    closed_form: Callable[[Any], Any] | None = None


OUTPUTS = {
    "contact_radius": Output("m", "", attrgetter("contact_radius")),
    "indentation": Output("m", "", attrgetter("indentation")),
    "u_lim": Output("m", "displacement at which the whole contact slides", attrgetter("u_lim")),
    "largest_pressure": Output("Pa", "", attrgetter("largest_pressure")),
    "poisson": Output("", "Poisson's ratio of the equivalent half-space", attrgetter("poisson")),
    "amplitude": Output("", "dimensionless amplitude, the largest of several"),
    "velocity": Output("", "dimensionless velocity"),
    "force": Output("", "dimensionless force"),
    "stiffness": Output("", "dimensionless stiffness"),
    "mass": Output("", "dimensionless mass"),
    "damping": Output("", "dimensionless damping"),
    "natural_frequency": Output("Hz", "of the mass on its spring and the sticking contact"),
    "mu_macro": Output("", "ratio of friction with vibration to friction without"),
    "mu_apparent": Output("", "coefficient of friction with vibration"),
    "friction_force": Output("N", "with vibration"),
    "sliding_friction": Output("N", "friction force without vibration"),
    "force_reduction": Output("", "1 - mu_macro"),
    "mu_static": Output("", "mu_macro at vanishing speed"),
    "mu_static_apparent": Output("", "coefficient of friction at vanishing speed"),
    "force_threshold": Output("N", "smallest constant force that moves the contact"),
    "safety_factor": Output("", "force threshold divided by the force"),
    "probability_stays": Output("", "probability that the contact stays"),
    "probability_moves": Output("", "probability that it moves, cycle by cycle"),
    "probability_runs_away": Output("", "probability that it runs away"),
    "speed": Output("m/s", "mean forward speed"),
    "displacement_per_cycle": Output("m", "forward displacement in a period"),
    "time_to_1_mm": Output("s", "time to travel 1 mm"),
    "time_to_contact_radius": Output("s", "time to travel one contact radius"),
    "displacement": Output("m", "forward displacement until the contact rests"),
    "cycles_to_rest": Output("", "periods until nine tenths of the vibration's part of it"),
    "torque": Output("N m", "torque of the spin"),
    "vibration_power": Output("W", "power of the oscillation or the spin"),
    "drag_power": Output("W", "power of the forward force"),
    "dissipated_power": Output("W", "power dissipated by friction"),
    "energy_per_cycle": Output("J", "energy dissipated by friction in a period or a turn"),
    "wear_volume_per_cycle": Output("m^3", "wear volume of a body in a period or a turn"),
    "wear_depth_per_cycle": Output("m", "mean wear depth over the contact"),
}
"""Every output of `predict`, in the order in which they are printed."""
PREFIXED = ("m", "N", "Pa", "W", "J", "Hz", "N m", "m/s", "N/m")
"""Units that are printed with metric prefixes."""
KINDS = ("value", "error", "spread", "low", "high")
INTERVAL = 0.025, 0.975
"""Probabilities of the quantiles at the ends of a 95 % interval."""
WIDTH = 24
"""Width of the name at the start of a line, in characters."""
TIMES = (("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0))
"""Units of long times, s."""
TEXTS = ("motion", "pressure", "model", "outcome", "search", "reason", "counterbody")
"""Text columns of a prediction.  The other columns are numbers."""
OUTCOMES = {
    "moves": "it moves, cycle by cycle",
    "stays": "it stays: the force is below the threshold",
    "undecided": "undecided within the error",
}
"""Sentences about the outcomes, except for a contact that runs away."""
REASONS = ("mu_static_reason", "displacement_reason")


@dataclass(frozen=True)
class Value:
    """An output or an input in its SI unit.

    Attributes
    ----------
    value : float or array
        The value.
    error : float or array
        Numerical error estimate; 0 for a closed form.
    spread : float or None
        Standard uncertainty due to the uncertain inputs.  It is infinite if more than one draw in a
        thousand has no value, or an infinite one.  None if all inputs are exact.
    low, high : float or None
        Ends of the 95 % interval due to the uncertain inputs.
    """

    value: Any
    error: Any = 0.0
    spread: float | None = None
    low: float | None = None
    high: float | None = None


@cache
def column(name: str, unit: str, kind: str = "value") -> str:
    """Name of a column in JSON, CSV files and datasets, such as friction_force_error_N."""
    words = re.findall(r"[a-zA-Z0-9]+", unit.replace("^", ""))
    return "_".join([name, *[kind] * (kind != "value"), *words])


def input_column(name: str, unit: str, kind: str = "value") -> str:
    """Name of the column of an input, such as speed_m_s."""
    factor = name == "amplitude" and not unit
    return column("amplitude_factor" if factor else name, unit, kind)


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """Friction of a vibrated contact in SI units.

    Every column of `to_dict` is an attribute: the value of an output, such as `mu_macro` or
    `friction_force_N`, its error estimate (`friction_force_error_N`), and with uncertain inputs its
    standard uncertainty (`..._spread...`) and 95 % interval (`..._low...`, `..._high...`).  A
    missing number is None.

    Attributes
    ----------
    values : dict of Value
        Outputs by the names in OUTPUTS, in SI units.
    input_values, input_units : dict
        Inputs as Value in SI units, and their units.
    inputs : dict of str
        The inputs as the user wrote them.
    motion, pressure : str
        The motion, and the pressure for microslip.solve.
    model : str
        Contact model, "closed-form" or "map".
    converged, reason : bool, str
        True if the error estimate of mu_macro, or of the speed under a force, is at most the
        tolerance.  Otherwise, `reason` is set.
    outcome : str or None
        Under a force "moves", "stays", "runs away", or "undecided" if the speed is below its error
        estimate.  None for a contact at a speed, and if the solver failed.
    search : str or None
        Input that a reduction replaces: "amplitude", "speed" or "load".
    mu_static_reason, displacement_reason : str
        Why the error of mu_static is above its tolerance, and why the displacement is unknown.
    remarks, warnings, not_checked : tuple of str
        Explanations, violated assumptions of the theory, and checks that were skipped because a
        property is missing.
    """

    values: dict[str, Value] = field(default_factory=dict)
    input_values: dict[str, Value] = field(default_factory=dict)
    input_units: dict[str, str] = field(default_factory=dict)
    inputs: dict[str, str] = field(default_factory=dict, compare=False)
    motion: str
    pressure: str = ""
    model: str = "none"
    converged: bool = False
    reason: str = ""
    outcome: str | None = None
    search: str | None = None
    mu_static_reason: str = ""
    displacement_reason: str = ""
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    not_checked: tuple[str, ...] = ()

    @property
    def counterbody(self) -> str:
        """The counterbody in words."""
        return self.inputs["counterbody"]

    def numbers(self) -> Iterator[tuple[str, str, str, Any]]:
        """Name of the column, SI unit, description and number of each input and each output."""
        for name, one in self.input_values.items():
            unit = self.input_units[name]
            for kind in KINDS:
                number = getattr(one, kind)
                if kind == "value" or number is not None and (kind != "error" or number):
                    text = name.replace("_", " ")
                    yield input_column(name, unit, kind), unit, f"{text}, {kind}", number
        for name, output in OUTPUTS.items():
            one = self.values.get(name, Value(None, None))
            for kind in KINDS:
                number = getattr(one, kind)
                if kind in ("value", "error") or number is not None:
                    text = f"{name.replace('_', ' ')}, {kind}"
                    yield column(name, output.unit, kind), output.unit, text, number

    def to_dict(self) -> dict[str, Any]:
        """All columns as a plain dict.  The value and the error of every output are present, None
        if they do not apply; spread, low and high are present if an input is uncertain."""
        plain: dict[str, Any] = {name: getattr(self, name) for name in (*TEXTS, *REASONS)}
        plain |= {"converged": self.converged, "inputs": dict(self.inputs)}
        plain |= {
            name: list(getattr(self, name)) for name in ("remarks", "warnings", "not_checked")
        }
        numbers: dict[str, Any] = {}
        for name, _, _, number in self.numbers():
            if number is not None or name not in numbers:
                numbers[name] = number
        return plain | numbers

    def to_xarray(self) -> xr.Dataset:
        """The numbers as variables with units, and the texts as attributes."""
        import xarray as xr

        variables = {
            name: ((), number, {"units": unit or "1", "long_name": text})
            for name, unit, text, number in self.numbers()
            if number is not None
        }
        about = {name: getattr(self, name) or "" for name in (*TEXTS, *REASONS)}
        about |= {name: "; ".join(getattr(self, name)) for name in ("warnings", "not_checked")}
        about["inputs"] = "; ".join(f"{name}: {text}" for name, text in self.inputs.items())
        variables["converged"] = ((), self.converged, {})
        return xr.Dataset(variables, attrs={"record": "Prediction"} | about)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in ATTRIBUTES:
            raise AttributeError(f"{type(self).__name__} has no column {name!r}")
        return next((number for key, _, _, number in self.numbers() if key == name), None)

    def __str__(self) -> str:
        """The lines that `microslip predict` prints."""
        lines = []
        for name, text in self.inputs.items():
            lines.append(line(name.replace("_", " "), text))
        if self.search:
            one = self.input_values[self.search]
            least = "smallest" if self.search == "amplitude" else "largest"
            sentence = f"the {least} with a reduction of {self.inputs['reduction']}"
            unit = self.input_units[self.search]
            lines.append(line(str(self.search), f"{_text(one.value, one.error, unit)}: {sentence}"))
            lines += _uncertainty(one, unit)
        lines.append("")
        for name, one in self.values.items():
            output = OUTPUTS[name]
            text = _text(one.value, one.error, output.unit)
            title = name.replace("_", " ") if name not in PLAIN else name
            lines.append(line(title, f"{text}: {output.sentence}" if output.sentence else text))
            lines += _uncertainty(one, output.unit)
        lines += (
            [line("outcome", OUTCOMES.get(self.outcome, f"it {self.reason}"))]
            if self.outcome
            else []
        )
        if self.displacement_reason:
            lines.append(line("displacement", f"unknown: {self.displacement_reason}"))
        lines += self.remarks
        return "\n".join([*lines, *self.problems, *(f"not checked: {x}" for x in self.not_checked)])

    @property
    def problems(self) -> list[str]:
        """Lines for quantities that did not converge, and for warnings."""
        lines = []
        if not self.converged and self.outcome != "runs away":
            name = "speed" if "force" in self.input_values else "mu_macro"
            lines.append(f"NOT CONVERGED: {self.search or name}: {self.reason}")
        if self.mu_static_reason:
            lines.append(f"NOT CONVERGED: static friction: {self.mu_static_reason}")
        return lines + [f"warning: {text}" for text in self.warnings]


PLAIN = {"u_lim", "mu_macro", "mu_apparent", "mu_static", "mu_static_apparent"}
"""Outputs that are symbols, whose underscore is printed."""


class _Columns:
    """Container of all possible names of numbers, as the tables are at the time of the question."""

    def __contains__(self, name: str) -> bool:
        units = {one: (output.unit,) for one, output in OUTPUTS.items()}
        outputs = (column(n, u, kind) for n, us in units.items() for u in us for kind in KINDS)
        texts = {n: one.unit for n, one in INPUTS.items() if one.unit is not None}
        inputs = (input_column(n, u, kind) for n, u in texts.items() for kind in KINDS)
        angle = (column("amplitude", "rad", kind) for kind in KINDS)
        factor = (input_column("amplitude", "", kind) for kind in KINDS)
        return any(name in names for names in (outputs, inputs, angle, factor))


ATTRIBUTES = _Columns()


def line(title: str, text: str) -> str:
    """A line with its title."""
    return f"{title:<{WIDTH - 1}} {text}"


def _text(value: float, error: float, unit: str) -> str:
    """A value with its error and a readable unit."""
    if math.isinf(value):
        return "infinite"
    size = max(abs(value), error if math.isfinite(error) and abs(value) <= error else 0.0)
    if unit == "s":
        name, scale = next((one for one in TIMES if size >= 2.0 * one[1]), ("s", 1.0))
    else:
        name, scale = prefixed(size, unit) if unit in PREFIXED else (unit, 1.0)
    if not unit and abs(value) <= error <= ROUNDING:
        value, error = 0.0, 0.0
    return number_text(value / scale, error / scale, name)


def _uncertainty(one: Value, unit: str) -> list[str]:
    """The line about the uncertainty due to the inputs; empty without one."""
    if not one.spread or one.low is None or one.high is None:
        return []
    size = max(abs(x) for x in (one.low, one.high, 0.0) if math.isfinite(x))
    name, scale = prefixed(size, unit) if unit in PREFIXED else (unit, 1.0)
    ends = interval_text(one.low / scale, one.high / scale, name)
    deviation = (
        "infinite"
        if math.isinf(one.spread)
        else number_text(one.spread / scale, 0.0, name, digits=2)
    )
    return [line("", f"standard uncertainty {deviation}, 95 % interval {ends}, from the inputs")]


def reference_page() -> str:
    """The reference page of the inputs and the outputs, in Markdown."""
    text = ["# Inputs and outputs of a prediction", ""]
    text += [
        "The inputs are arguments of `microslip.predict`, options of `microslip predict` (with `-`",
        "in place of `_`), and columns of a table of contacts.",
        "",
        "| input | unit | range | meaning |",
        "|---|---|---|---|",
    ]
    for name, one in INPUTS.items():
        unit, range_ = ("text", "") if one.unit is None else (one.unit or "1", one.range)
        text.append(f"| `{name}` | {unit} | {range_} | {one.help} |")
    text += [
        "",
        "The outputs are fields of the answer.  `NAME_error` is the numerical error estimate.  If",
        "an input is uncertain, `NAME_spread` is the standard uncertainty, and `NAME_low` and",
        "`NAME_high` are the ends of the 95 % interval.  The unit is at the end of each name, as",
        "in `friction_force_error_N`.",
        "",
    ]
    text += ["| output | unit | meaning |", "|---|---|---|"]
    for name, output in OUTPUTS.items():
        meaning = output.sentence or name.replace("_", " ")
        text.append(f"| `{column(name, output.unit)}` | {output.unit or '1'} | {meaning} |")
    return "\n".join(text) + "\n"
