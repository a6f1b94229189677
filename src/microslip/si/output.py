"""The outputs of a prediction.  One table defines how the outputs appear in the printed text, JSON,
CSV files, datasets and the reference page."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from microslip.foundation.number_text import interval_text, number_text, prefixed
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
    factors : str
        Names of the factors whose product is the output.  A factor is an item of
        predict.factors_of, or an attribute of a Contact.  By default, there is one factor, with the
        same name as the output.
    """

    unit: str
    sentence: str = ""
    factors: str = ""


OUTPUTS = {
    "contact_radius": Output("m"),
    "indentation": Output("m"),
    "u_lim": Output("m", "displacement at which the whole contact slides"),
    "largest_pressure": Output("Pa"),
    "poisson": Output("", "Poisson's ratio of the equivalent half-space"),
    "amplitude": Output("", "largest dimensionless amplitude"),
    "velocity": Output("", "dimensionless velocity"),
    "force": Output("", "dimensionless force"),
    "stiffness": Output("", "dimensionless stiffness"),
    "mass": Output("", "dimensionless mass"),
    "damping": Output("", "dimensionless damping"),
    "natural_frequency": Output("Hz", "of the mass on its spring and the sticking contact"),
    "mu_macro": Output("", "mean forward force divided by mu times the mean load", "friction"),
    "mu_apparent": Output("", "coefficient of friction with vibration", "friction mu"),
    "friction_force": Output("N", "with vibration", "friction sliding_friction"),
    "sliding_friction": Output("N", "mu times the mean load"),
    "force_reduction": Output("", "relative to friction without vibration, mu times the load"),
    "mu_static": Output("", "mu_macro at vanishing speed", "static"),
    "mu_static_apparent": Output("", "coefficient of friction at vanishing speed", "static mu"),
    "force_threshold": Output(
        "N", "smallest constant force that moves the contact", "threshold sliding_friction"
    ),
    "safety_factor": Output("", "force threshold divided by the force"),
    "probability_stays": Output("", "probability that the contact stays"),
    "probability_moves": Output("", "probability that it moves, cycle by cycle"),
    "probability_runs_away": Output("", "probability that it runs away"),
    "speed": Output("m/s", "mean forward speed"),
    "displacement_per_cycle": Output("m", "forward displacement in a period"),
    "time_to_1_mm": Output("s", "time to travel 1 mm", "pace millimetre"),
    "time_to_contact_radius": Output(
        "s", "time to travel one contact radius", "pace contact_radius"
    ),
    "displacement": Output(
        "m", "forward displacement until the contact rests", "displacement u_lim"
    ),
    "cycles_to_rest": Output(
        "", "periods until nine tenths of the vibration's part of it", "cycles"
    ),
    "torque": Output("N m", "torque of the spin", "torque sliding_friction contact_radius"),
    "vibration_power": Output("W", "power of the oscillation or the spin"),
    "drag_power": Output("W", "power of the forward force"),
    "dissipated_power": Output("W", "power dissipated by friction"),
    "energy_per_cycle": Output("J", "energy dissipated by friction in a period or a turn", "heat"),
    "wear_volume_per_cycle": Output("m^3", "wear volume of a body in a period or a turn", "worn"),
    "wear_depth_per_cycle": Output("m", "mean wear depth over the contact", "worn per_area"),
}
"""All outputs of `predict`, in the order in which they are printed."""
PREFIXED = ("m", "N", "Pa", "W", "J", "Hz", "N m", "m/s", "N/m")
"""Units that are printed with metric prefixes."""
KINDS = ("value", "error", "spread", "low", "high")
INTERVAL = 0.025, 0.975
"""Probabilities of the quantiles that bound a 95 % interval."""
WIDTH = 24
"""Width of the name at the start of a line, in characters."""
TIMES = (("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0))
"""Names of time units, and their lengths in s."""
TEXTS = ("motion", "pressure", "model", "outcome", "search", "reason", "counterbody")
"""Text columns of a prediction.  The other columns are numbers."""
OUTCOMES = {
    "moves": "it moves, cycle by cycle",
    "stays": "it stays: the force is below the threshold",
    "undecided": "undecided within the error",
}
"""Sentence for each outcome except "runs away"."""
REASONS = ("mu_static_reason", "displacement_reason")
LISTS = ("remarks", "warnings", "not_checked")
"""Columns of a prediction that are lists of strings."""


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
        thousand is infinite or has no value.  None if all inputs are exact.
    low, high : float or None
        Bounds of the 95 % interval due to the uncertain inputs.
    unit : str
        SI unit, empty for a pure number.
    """

    value: Any
    error: Any = 0.0
    spread: float | None = None
    low: float | None = None
    high: float | None = None
    unit: str = ""
    __array_ufunc__ = None  # an array times a Value is a Value

    def __mul__(self, other: Any) -> Value:
        if not isinstance(other, Value):
            return Value(self.value * other, self.error * abs(other))
        error = self.error * abs(other.value) + abs(self.value) * other.error
        return Value(self.value * other.value, error)

    __rmul__ = __mul__

    def __add__(self, other: Value) -> Value:
        return Value(self.value + other.value, self.error + other.error)


@cache
def column(name: str, unit: str, kind: str = "value") -> str:
    """Return the column name of an output in JSON, CSV files and datasets, such as
    friction_force_error_N."""
    words = re.findall(r"[a-zA-Z0-9]+", unit.replace("^", ""))
    return "_".join([name, *[kind] * (kind != "value"), *words])


def input_column(name: str, unit: str, kind: str = "value") -> str:
    """Return the column name of an input, such as speed_m_s."""
    factor = name == "amplitude" and not unit
    return column("amplitude_factor" if factor else name, unit, kind)


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """Friction of a vibrated contact in SI units, as returned by `predict`.

    Every column of `to_dict` is also an attribute.  Each output has a value, such as `mu_macro` or
    `friction_force_N`, and an error estimate, such as `friction_force_error_N`.  If inputs are
    uncertain, each output also has a standard uncertainty (`..._spread...`) and a 95 % interval
    (`..._low...`, `..._high...`).  A missing number is None.

    Attributes
    ----------
    values : dict of Value
        Outputs in SI units, keyed by their names in OUTPUTS.
    input_values : dict of Value
        Inputs in SI units, keyed by name.
    inputs : dict of str
        The inputs as the user wrote them.
    motion, pressure : str
        The motion, and the pressure for microslip.solve.
    model : str
        Name of the contact model, "closed-form" or "map".
    converged, reason : bool, str
        `converged` is True if the error estimate of mu_macro, or of the speed under a force, is at
        most the tolerance.  Otherwise, `reason` is the reason why it is not.
    outcome : str or None
        Outcome under a prescribed force: "moves", "stays", "runs away", or "undecided" if the speed
        is below its error estimate.  None at a prescribed speed, and if the solver failed.
    search : str or None
        Input that a reduction replaces: "amplitude", "speed" or "load".
    mu_static_reason, displacement_reason : str
        Reason why the error of mu_static is above its tolerance, and reason why the displacement is
        unknown.
    remarks, warnings, not_checked : tuple of str
        Explanations of outputs, warnings about violated assumptions of the theory, and checks that
        were skipped because a property is missing.
    """

    values: dict[str, Value] = field(default_factory=dict)
    input_values: dict[str, Value] = field(default_factory=dict)
    inputs: dict[str, str] = field(default_factory=dict, compare=False)
    motion: str = ""
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

    def columns(self) -> tuple[dict[str, Any], dict[str, dict[str, str]]]:
        """Return two dicts, keyed by name: all columns, and the attributes of the numerical
        columns.  The value and the error of every output are included, and are None if the output
        does not apply.  The columns spread, low and high are included only if an input is
        uncertain."""
        columns = {name: getattr(self, name) for name in (*TEXTS, *REASONS, "converged")}
        columns["inputs"], attributes = dict(self.inputs), {}
        columns |= {name: list(getattr(self, name)) for name in LISTS}
        rows: list[tuple] = [(input_column, n, one, ()) for n, one in self.input_values.items()]
        for name, output in OUTPUTS.items():
            one = self.values.get(name, Value(None, None, unit=output.unit))
            rows.append((column, name, one, KINDS[:2]))
        for key, name, one, always in rows:
            for kind in KINDS:
                number = getattr(one, kind)
                if number is not None or kind in always:
                    title = key(name, one.unit, kind)
                    columns.setdefault(title, number)  # the speed is an input or an output
                    about = f"{name.replace('_', ' ')}, {kind}"
                    attributes[title] = {"units": one.unit or "1", "long_name": about}
        return columns, attributes

    def to_dict(self) -> dict[str, Any]:
        """Return the columns, keyed by name."""
        return self.columns()[0]

    def to_xarray(self) -> xr.Dataset:
        """Return a dataset in which the numbers are variables with units, and the strings are
        attributes."""
        import xarray as xr

        columns, attributes = self.columns()
        numbers = [name for name in attributes if columns[name] is not None]
        variables = {name: ((), columns[name], attributes[name]) for name in numbers}
        texts = {name: columns[name] or "" for name in (*TEXTS, *REASONS)}
        texts |= {name: "; ".join(columns[name]) for name in ("warnings", "not_checked")}
        texts["inputs"] = "; ".join(f"{name}: {text}" for name, text in self.inputs.items())
        variables["converged"] = ((), self.converged, {})
        return xr.Dataset(variables, attrs={"record": "Prediction"} | texts)

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_"):
            columns = self.to_dict()
            if name in columns or name in _names():
                return columns.get(name)
        raise AttributeError(f"{type(self).__name__} has no column {name!r}")

    def __str__(self) -> str:
        """Return the lines that `microslip predict` prints."""
        lines = [line(name.replace("_", " "), text) for name, text in self.inputs.items()]
        if name := self.search:
            least = "smallest" if name == "amplitude" else "largest"
            sentence = f"the {least} with a reduction of {self.inputs['reduction']}"
            lines += _lines(name, self.input_values[name], sentence)
        lines.append("")
        for name, one in self.values.items():
            title = name if name.startswith(("mu_", "u_")) else name.replace("_", " ")  # a symbol
            sentence = self.reason if math.isnan(one.value) else OUTPUTS[name].sentence
            lines += _lines(title, one, sentence)
        if self.outcome:
            lines.append(line("outcome", OUTCOMES.get(self.outcome, f"it {self.reason}")))
        if self.displacement_reason:
            lines.append(line("displacement", f"unknown: {self.displacement_reason}"))
        lines += [*self.remarks, *self.problems]
        return "\n".join([*lines, *(f"not checked: {x}" for x in self.not_checked)])

    @property
    def problems(self) -> list[str]:
        """Lines about quantities that did not converge, followed by the warnings."""
        lines = []
        if not self.converged and self.outcome != "runs away":
            name = "speed" if "force" in self.input_values else "mu_macro"
            lines.append(f"NOT CONVERGED: {self.search or name}: {self.reason}")
        if self.mu_static_reason:
            lines.append(f"NOT CONVERGED: static friction: {self.mu_static_reason}")
        return lines + [f"warning: {text}" for text in self.warnings]


def _names() -> set[str]:
    """Return the names of all columns that may contain numbers."""
    units = [(name, one.unit) for name, one in OUTPUTS.items()]
    units += [(name, one.unit) for name, one in INPUTS.items() if one.unit is not None]
    units += [("amplitude", "rad"), ("amplitude_factor", "")]
    return {column(name, unit, kind) for name, unit in units for kind in KINDS}


def line(title: str, text: str) -> str:
    """Return a line of text that begins with a title."""
    return f"{title:<{WIDTH - 1}} {text}"


def _scaled(size: float, unit: str) -> tuple[str, float]:
    """Return a readable unit for numbers of a given size, and the factor from this unit to the SI
    unit."""
    if unit == "s":
        return next((one for one in TIMES if size >= 2.0 * one[1]), ("s", 1.0))
    return prefixed(size, unit) if unit in PREFIXED else (unit, 1.0)


def _lines(title: str, one: Value, sentence: str) -> list[str]:
    """Format a `Value` and its error as a line of text.  If the inputs are uncertain, a second line
    contains the uncertainty of the value."""
    value, error = one.value, one.error
    size = max(abs(value), error if abs(value) <= error < math.inf else 0.0)
    name, scale = _scaled(size, one.unit)
    text = "infinite" if math.isinf(value) else number_text(value / scale, error / scale, name)
    text = "unknown" if math.isnan(value) or math.isnan(error) else text
    lines = [line(title, f"{text}: {sentence}" if sentence else text)]
    if one.spread and one.low is not None and one.high is not None:
        size = max(abs(x) for x in (one.low, one.high, 0.0) if math.isfinite(x))
        name, scale = (one.unit, 1.0) if one.unit == "s" else _scaled(size, one.unit)
        ends = interval_text(one.low / scale, one.high / scale, name)
        deviation = number_text(one.spread / scale, 0.0, name, digits=2)
        deviation = "infinite" if math.isinf(one.spread) else deviation
        text = f"standard uncertainty {deviation}, 95 % interval {ends}, from the inputs"
        lines.append(line("", text))
    return lines
