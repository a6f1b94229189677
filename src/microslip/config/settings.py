"""Types, ranges, defaults and descriptions of the keys of a configuration.

The tables in config/README.md are generated from the models in this module.  All quantities are
dimensionless.
"""

import math
import re
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from itertools import pairwise, repeat
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import CoreSchema, core_schema

from microslip.config.kinds import KINDS
from microslip.config.quantities import AXES, DRIVES
from microslip.contact.registry import MODELS
from microslip.foundation.arguments import LARGEST
from microslip.foundation.canonical import number
from microslip.foundation.errors import InputError, shown
from microslip.foundation.spec import NUMBER, near_miss
from microslip.periodic.methods import names as method_names
from microslip.periodic.methods import split as split_method

MOST_POINTS = 1_000_000
"""Largest number of points in a sweep.  With more points, planning takes more than a minute."""
MOST_MAP_POINTS = 10_000
"""Largest number of points in a map of a study.  All models are run at each of these points."""
MOST_ON_PAGE = 20_000
"""Largest number of points on a page of the explorer.  Each point takes about 80 bytes."""
LOOSEST_POINTS = 1e-2
"""Largest tolerance of the points in a certified map.  The refinement would mistake larger errors
for curvature and halve cells unnecessarily."""
SHARE_OF_POINTS = 0.3
"""Default tolerance of the points in a certified map, divided by the error of the map."""
STATIC_AMPLITUDES = {"transverse": 1.0, "bore": 5.0}
"""Largest amplitude at which the paper's map of a motion shows static friction."""
STUDIES = ("accuracy", "stability", "claims")
"""Keys of the studies. These keys are also the names of the datasets."""
SOLVING = ("all", "solve_batch", "solve_map")
MAKING = ("make_products", "make_dataset", "draw_figure", "make_page", "link_file")
"""Names of the workflow's rules. These names are not allowed for datasets and figures."""


class Refusal(ValueError):
    """Error for a value that is not allowed.  The message is one line.

    Attributes
    ----------
    key : str
        Key of the value relative to the checked settings, such as ".velocity[0]".
    """

    def __init__(self, message: str, key: str = ""):
        super().__init__(message)
        self.key = key


def refuse(is_bad: bool, message: str, key: str = "") -> None:
    """Raise Refusal with the given message if `is_bad` is true."""
    if is_bad:
        raise Refusal(message, key)


def refuse_unknown(name: Any, names: Collection[str], problem: str, key: str = "") -> None:
    """Raise Refusal if `name` is not in `names`. The message states the problem and lists the
    allowed names."""
    if name not in names:
        allowed = ", ".join(names) or "none"
        raise Refusal(f"{problem}; {near_miss(name, names)}allowed: {allowed}", key)


def problem_of(value: Any) -> str:
    """Return a message that states whether a refused value is missing, empty or wrong."""
    wrong = "is empty" if value in ("", [], {}) else f"{shown(value)} is not allowed"
    return "has no value" if value is None else wrong


def _refuse_crowd(points: int, most: int, key: str = "") -> None:
    refuse(points > most, f"{points} points are not allowed; allowed: at most {most}", key)


# Types of values


@dataclass(frozen=True)
class Allowed:
    """Type of a value, stored as Pydantic field metadata.

    Attributes
    ----------
    text : str
        The allowed values, for messages and for config/README.md.
    convert : callable
        Function that converts a value from YAML.  For a value that is not allowed, it raises
        ValueError or TypeError, or else InputError or Refusal with a specific message.
    """

    text: str
    convert: Callable[[Any], Any]

    def __call__(self, value: Any) -> Any:
        try:
            return self.convert(value)
        except Refusal:
            raise
        except InputError as error:
            raise Refusal(f"{shown(error.value)}: {error.allowed}") from None
        except (ValueError, TypeError, OverflowError):
            raise Refusal(f"{problem_of(value)}; allowed: {self.text}") from None

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self)


def _number(low: float, high: float, step: int = 0, above: bool = False) -> Allowed:
    """Return the type of a number between two bounds.

    step: 1 for whole numbers, 2 for even numbers.  above: if True, `low` itself is not allowed.
    """
    word = ("a number", "a whole number", "an even number")[step]
    text = f"{word} {'>' if above else '>='} {low:g} and <= {high:g}"

    def convert(value: Any) -> float:
        if isinstance(value, str):
            refuse(not NUMBER.fullmatch(value), f"{shown(value)} is not a number; allowed: {text}")
            is_quoted = "e" not in value.lower()  # YAML 1.1 reads 1e-3 as a string
            refuse(is_quoted, f"{shown(value)} is text; allowed: a number without quotes")
            value = float(value)
        is_inside = low <= value <= high and not (above and value == low)
        if isinstance(value, bool) or not is_inside or (step and value % step):
            raise ValueError
        return int(value) if step else float(number(value))

    return Allowed(text, convert)


def _or_null(kind: Allowed) -> Allowed:
    return Allowed(f"{kind.text}, or null", lambda v: None if v is None else kind(v))


def _text(text: str, pattern: str, printable: bool = True) -> Allowed:
    def convert(value: Any) -> str:
        if not re.fullmatch(pattern, value) or (printable and not value.isprintable()):
            raise ValueError
        return value

    return Allowed(text, convert)


def _one_of(*names: str) -> Allowed:
    def convert(value: Any) -> str:
        refuse_unknown(value, names, f"{shown(value)} is not allowed")
        return value

    return Allowed(", ".join(names), convert)


def _each(kinds: Iterable[Allowed], values: Any, key: str = "") -> list:
    """Convert values.  If a value is refused, its index is added to the key of the Refusal."""
    result = []
    for i, (kind, value) in enumerate(zip(kinds, values, strict=False)):
        try:
            result.append(kind(value))
        except Refusal as error:
            raise Refusal(str(error), f"{key}[{i}]{error.key}") from None
    return result


def _list(kind: Allowed, text: str, alone: bool = False) -> Allowed:
    """Return the type of a list that is not empty and has no duplicates. The list is converted to a
    tuple.

    alone: if True, a string is allowed in place of a list with one string.
    """

    def convert(values: Any) -> tuple:
        values = [values] if alone and isinstance(values, str) else values
        if not isinstance(values, list | tuple) or not values:
            raise TypeError
        result = _each(repeat(kind), values)
        for i, value in enumerate(result):
            refuse(value in result[:i], f"{value} occurs twice; allowed: different values")
        return tuple(result)

    return Allowed(text, convert)


def _axis(
    low: float = 0.0, high: float = LARGEST["velocity"], step: int = 0, above: bool = False
) -> Allowed:
    """Return the type of an axis: a number, or a list of numbers and ranges. The value is converted
    to an ascending tuple."""
    one = _number(low, high, step, above)
    item = Allowed(one.text, lambda item: _spaced(item) if isinstance(item, dict) else [one(item)])

    def convert(raw: Any) -> tuple[float, ...]:
        parts = _each(repeat(item), raw) if isinstance(raw, list | tuple) else [item(raw)]
        values = sorted({one(value) for part in parts for value in part})
        if not values:
            raise ValueError
        for left, right in pairwise(values):
            close = right - left <= 1e-9 * right
            refuse(close, f"{right:.12g} occurs twice; allowed: different values")
        return tuple(values)

    return Allowed(f"{one.text}, or a list of numbers and ranges", convert)


def _spaced(item: dict) -> list[float]:
    """Return the values of a range such as {"log": [0.001, 10, 25]}, rounded to six significant
    digits."""
    spacing, ends = next(iter(item.items())) if len(item) == 1 else ("", None)
    key, is_log = f".{spacing}", spacing == "log"
    if spacing not in ("log", "linear"):
        example = "{log: [first, last, count]} or {linear: [first, last, count]}"
        hint = near_miss(spacing, ("log", "linear"))
        raise Refusal(f"{shown(item)} is not allowed; {hint}allowed: {example}")
    problem = f"{problem_of(ends)}; allowed:"
    is_triple = isinstance(ends, list | tuple) and len(ends) == 3
    refuse(not is_triple, f"{problem} [first, last, count]", key)
    end = _number(0.0, LARGEST["velocity"], above=is_log)
    first, last, count = _each((end, end, _number(2, 1e5, 1)), ends, key)
    too_wide = is_log and math.isinf(last / first)
    refuse(last <= first or too_wide, f"{problem} last above first", key)
    shares = (i / (count - 1) for i in range(count))
    if is_log:
        values = (first * math.exp(math.log(last / first) * share) for share in shares)
    else:
        values = (first + (last - first) * share for share in shares)
    # Coordinates with six digits are readable and do not depend on the machine.
    return [float(f"{value:.6g}") for value in values]


_METHOD = Allowed(
    "the name of a method, such as projected-gradient:step=0.5",
    lambda text: text if split_method(text) else None,
)
_METHODS = _list(_METHOD, "a list of methods, or null for all")
_MODEL = _one_of("auto", *MODELS)
_POSITIVE = _number(0, LARGEST["velocity"], above=True)
_SWEEP = _text("the name of a sweep", ".*")
_FOLDER = _text(
    "text for a folder, without braces, *, ?, ~ in front, $ and ://",
    r"(?!~)(?=.*\S)(?!.*(://|[{}*?$])).*",
)
_TITLE = _text("text on one line, up to 100 characters", r"(?=.*\S).{1,100}")
Positive = Annotated[float, _POSITIVE]
Ratio = Annotated[float, _number(0, 0.5)]
Tolerance = Annotated[float, _number(1e-6, 0.1)]
Cells = Annotated[int | None, _or_null(_number(4, LARGEST["cells"], 2))]
Steps = Annotated[int | None, _or_null(_number(8, LARGEST["steps"], 2))]
Text = Annotated[str, _text("text", "(?s:.+)", printable=False)]
Title = Annotated[str | None, _or_null(_TITLE)]
Name = Annotated[
    str,
    _text("a name of small letters, digits and _ that begins with a letter", "[a-z][a-z0-9_]{,99}"),
]
Axis = Annotated[tuple[float, ...], _axis()]
PositiveAxis = Annotated[tuple[float, ...], _axis(above=True)]
Methods = Annotated[
    tuple[str, ...], Allowed(_METHODS.text, lambda v: method_names() if v is None else _METHODS(v))
]


class Settings(BaseModel):
    """Base class of settings.  Unknown keys are refused."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    @model_validator(mode="before")
    @classmethod
    def _refuse_keys(cls, values: Any) -> Any:
        names = cls.model_fields
        if not isinstance(values, dict):
            allowed = f"a mapping with the keys {', '.join(names)}"
            raise Refusal(f"{problem_of(values)}; allowed: {allowed}")
        for name in values:
            refuse_unknown(name, names, "unknown key", f".{name}")
        required = [name for name, field in names.items() if field.is_required()]
        for name in required:
            refuse(name not in values, f"missing; required: {', '.join(required)}", f".{name}")
        return values


# Sweeps


def _tolerance(given: dict[str, Any]) -> float:
    """Return the default tolerance of the points. For a certified map, the default depends on the
    error of the map."""
    error = given.get("error")
    return 1e-3 if error is None else min(float(number(SHARE_OF_POINTS * error)), LOOSEST_POINTS)


class Sweep(Settings):
    """A grid of points.  Each axis with more than one value is a dimension of the dataset.

    A sweep that has the key `error` is a certified map over the ranges of its axes.
    """

    motion: Text
    """Name of a motion, optionally with parameters as in "elliptic:forward=0.5,phase=30". To use a
    file, write file:FILE for a data file, or the path of a Python file."""
    pressure: Text = "hertz"
    """Name of a normal pressure, optionally with parameters as in "power:exponent=1". To use a
    file, write file:FILE for a data file, or the path of a Python file."""
    title: Title = None
    """Title of the dataset, also used in figures. The title is plain text: $ and \\ have no special
    meaning."""
    velocity: Axis = ()
    """Forward velocity in the unit of the motion. The value 0 requests the static limit. If a
    stiffness is given, the velocity is that of the far end of the spring."""
    force: Axis = ()
    """Prescribed force P divided by mu times the mean normal load. A force is given instead of a
    velocity."""
    amplitude: Axis = ()
    """Amplitude in the unit of the motion. An amplitude is required unless the motion is steady."""
    poisson: Annotated[tuple[float, ...], _axis(0, 0.5)] = (0.0,)
    """Poisson's ratio of the half-space."""
    stiffness: Axis = ()
    """Stiffness of the spring divided by mu F_z / u_lim. It must be above 0."""
    mass: Axis = ()
    """Mass of the body divided by mu F_z / (u_lim omega^2)."""
    damping: Axis = ()
    """Damping parallel to the spring, divided by mu F_z / (u_lim omega)."""
    model: Annotated[str, _MODEL] = "auto"
    """Contact model. The value auto selects the cheapest model that is exact for the motion."""
    method: Annotated[str | None, _or_null(_METHOD)] = None
    """Method to compare with the default, which is the method of microslip.solve."""
    error: Annotated[float | None, _or_null(_number(1e-5, 0.1))] = None
    """Largest absolute error of mu_macro within the ranges of the axes of a certified map."""
    tolerance: Annotated[float | None, _or_null(_number(1e-6, 0.1))] = Field(
        default_factory=_tolerance
    )
    """Largest accepted absolute error of mu_macro. If the tolerance is null, cells and steps must
    be prescribed. A point then counts as converged if its runs reach the periodic state. For a
    certified map, the default is three tenths of `error`, but at most 0.01."""
    cells: Cells = None
    """Number of rings, or of squares across the contact. By default, this number follows from the
    tolerance."""
    steps: Steps = None
    """Number of time steps in a period. By default, this number follows from the tolerance."""

    @property
    def axes(self) -> dict[str, tuple[float, ...]]:
        """Values of each axis, in the order of AXES.  An axis without values is omitted."""
        return {name: getattr(self, name) for name in AXES if getattr(self, name)}

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions of the dataset: the names of the axes with more than one value."""
        return tuple(name for name, values in self.axes.items() if len(values) > 1)

    @property
    def drives(self) -> dict[str, tuple[float, ...]]:
        """Values of the given drive parameters, keyed by name."""
        return {name: values for name, values in self.axes.items() if name in DRIVES}

    @property
    def is_certified(self) -> bool:
        """True for a certified map."""
        return self.error is not None

    @property
    def several(self) -> set[str]:
        """Names of the axes with two or more values. The velocity 0 is not counted."""
        counted = self.axes | {"velocity": [value for value in self.velocity if value > 0]}
        return {name for name, values in counted.items() if len(values) > 1}

    @property
    def spans_a_map(self) -> bool:
        """True if there are at least two amplitudes and two velocities above 0."""
        return {"amplitude", "velocity"} <= self.several

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other. Only checks that do not need the solver
        are made."""
        free = [name for name in ("cells", "steps") if getattr(self, name) is None]
        free = [name for name in free if self.amplitude or name != "steps"]
        if self.tolerance is None and (free or self.is_certified):
            imposed = "a number" + (f", or {' and '.join(free)} imposed" if free else "")
            raise Refusal(f"null is not allowed; allowed: {imposed}", ".tolerance")
        _refuse_crowd(math.prod(map(len, self.axes.values())), MOST_POINTS)
        if self.error is None or self.tolerance is None:
            return
        bound = f"less than the error, {self.error:g}, and at most {LOOSEST_POINTS:g}"
        is_loose = self.tolerance >= self.error or self.tolerance > LOOSEST_POINTS
        refuse(is_loose, f"{self.tolerance:g} is not allowed; allowed: {bound}", ".tolerance")
        names = ("cells", "steps", "method", *self.drives)
        imposed = ", ".join(name for name in names if getattr(self, name))
        refuse(imposed != "", f"is not allowed with {imposed}; allowed: a tolerance", ".error")
        static = len(self.amplitude) > 1 and 0.0 in self.velocity
        ranges = "two amplitudes and two velocities above 0, or two amplitudes and velocity 0"
        problem = f"is not allowed for these axes; allowed: {ranges}"
        refuse(not (self.spans_a_map or static), problem, ".error")


# Figures


class Figure(Settings):
    """A figure.  The key `kind` determines what the figure shows."""

    kind: Annotated[str, _one_of(*KINDS)]
    """Kind of figure. The kind `map` shows friction over two axes. The kind `curves` shows friction
    along one axis. The kinds `history`, `field` and `transients` show a single run. The kind
    `explorer` is an interactive page."""
    sweep: Annotated[
        tuple[str, ...], _list(_SWEEP, f"{_SWEEP.text}, or a list of names", True)
    ] = ()
    """Sweeps to draw. A figure of a study has no sweep."""
    velocity: Annotated[float | None, _POSITIVE] = None
    """Velocity of the single run."""
    amplitude: Annotated[float | None, _number(0, LARGEST["amplitude"])] = None
    """For histories: amplitude of the single run."""
    periods: Annotated[int | None, _number(1, 1000, 1)] = None
    """For histories: number of periods in the run, which starts without tractions."""
    travel: Annotated[float | None, _POSITIVE] = None
    """For transients: forward displacement of each run, in units of u_lim."""
    cells: Cells = None
    """Number of rings of the single run."""
    steps: Steps = None
    """Number of time steps in a period. For transients: number of time steps in the run."""

    @property
    def run(self) -> dict[str, Any]:
        """Settings of the single run. The dict is empty if the figure does not show an individual
        run."""
        defaults = KINDS[self.kind].run
        return defaults | self.model_dump(include={*defaults}, exclude_none=True)

    @property
    def datasets(self) -> tuple[str, ...]:
        """Names of the drawn datasets."""
        study = KINDS[self.kind].study
        return (study,) if study else self.sweep

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        kind = KINDS[self.kind]
        usable = ["kind", *([] if kind.study else ["sweep"]), *kind.run]
        for name in self.model_fields_set:
            refuse_unknown(name, usable, f"is not allowed for the kind {self.kind}", f".{name}")
        missing = not (self.sweep or kind.study)
        refuse(missing, "missing; required: the name of a sweep", ".sweep")
        several = f"{', '.join(self.sweep)} is not allowed; allowed: one sweep"
        refuse(bool(kind.run) and len(self.sweep) > 1, several, ".sweep")


# Studies

_OSCILLATIONS = ("transverse", "longitudinal", "bore", "zigzag")


class StudyPoint(Settings):
    """A point at which the methods are compared."""

    motion: Annotated[str, _one_of(*_OSCILLATIONS, "continuous-bore")]
    """Name of the motion."""
    velocity: Positive
    """Forward velocity in the unit of the motion."""
    amplitude: Annotated[float | None, _number(0, LARGEST["amplitude"], above=True)] = None
    """Amplitude in the unit of the motion. The motion continuous-bore has no amplitude."""
    poisson: Ratio = 0.0
    """Poisson's ratio of the half-space."""
    title: Title = None
    """Title of the panel. The default is the name of the point."""

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        steady, given = self.motion == "continuous-bore", self.amplitude is not None
        refuse(steady and given, f"is not allowed; {self.motion} has no amplitude", ".amplitude")
        refuse(not (steady or given), f"missing; required for {self.motion}", ".amplitude")


class _Grid(Settings):
    velocity: PositiveAxis
    """Forward velocities of both motions."""
    amplitude_transverse: PositiveAxis
    """Amplitudes of the transverse oscillation, y0/u_lim."""
    amplitude_bore: PositiveAxis
    """Amplitudes of the oscillating rotation, phi0/phi_lk(a/2)."""

    @property
    def amplitude(self) -> dict[str, tuple[float, ...]]:
        """Amplitudes by motion."""
        return {"transverse": self.amplitude_transverse, "bore": self.amplitude_bore}

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        for motion, amplitudes in self.amplitude.items():
            key = f".velocity x amplitude_{motion}"
            _refuse_crowd(len(self.velocity) * len(amplitudes), MOST_MAP_POINTS, key)


class ModelMap(_Grid):
    """Grid of the maps of the cheapest model. There is a map for each tolerance, and Poisson's
    ratio is 0."""

    tolerance: Annotated[tuple[float, ...], _axis(1e-6, 0.1)] = (1e-3, 1e-2)
    """Absolute tolerances of mu_macro. There is a map for each tolerance."""

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        super().model_post_init(context)
        for name in _Grid.model_fields:
            problem = f"{[*getattr(self, name)]} is not allowed; allowed: two numbers or more"
            refuse(len(getattr(self, name)) < 2, problem, f".{name}")


class Accuracy(Settings):
    """Study of the cost of accuracy. Its dataset is accuracy.nc."""

    methods: Methods = method_names()
    """Methods to compare, with parameters as in "projected-gradient:step=0.5". The name of a method
    is the name of its file in src/microslip/periodic/methods, with hyphens. The name "shipped"
    stands for the method of microslip.solve. The default is all methods."""
    points: dict[Text, StudyPoint]
    """Points at which all methods and models are run, keyed by name. Each point has a panel."""
    levels: Annotated[int, _number(1, 6, 1)] = 6
    """Number of resolutions of each method, starting with the coarsest one."""
    repeats: Annotated[int, _number(1, 100, 1)] = 5
    """Number of measurements of each computing time. Their median is used."""
    map: ModelMap
    """Grid of the maps that show the cheapest model for each tolerance."""


class Block(Settings):
    """Cases in which all methods are run. The cases differ in one quantity: exactly one key must
    have a list of several numbers as its value."""

    motion: Annotated[str, _one_of(*_OSCILLATIONS)]
    """Name of the motion."""
    velocity: PositiveAxis
    """Forward velocity in the unit of the motion."""
    amplitude: PositiveAxis
    """Amplitude in the unit of the motion."""
    poisson: Annotated[tuple[float, ...], _axis(0, 0.5)] = (0.0,)
    """Poisson's ratio of the half-space."""
    cells: Annotated[tuple[int, ...], _axis(4, LARGEST["cells"], step=2)] = ()
    """Imposed number of rings. By default, this number follows from the tolerance."""
    steps: Annotated[tuple[int, ...], _axis(8, LARGEST["steps"], step=2)] = ()
    """Imposed number of time steps in a period. By default, this number follows from the
    tolerance."""
    step: PositiveAxis = ()
    """Parameter `step` of the methods. A method that lacks this parameter is omitted from the
    block."""
    title: Title = None
    """Heading of the block in the figure. The default is the name of the varied quantity."""

    @property
    def quantity(self) -> str:
        """Name of the varied quantity."""
        names = ("velocity", "amplitude", "poisson", "cells", "steps", "step")
        return " and ".join(name for name in names if len(getattr(self, name)) > 1)

    @property
    def values(self) -> tuple[float, ...]:
        """Values of the varied quantity."""
        return getattr(self, self.quantity)

    @property
    def note(self) -> str:
        """Text with the values of the fixed quantities."""
        symbols = {"velocity": "v", "amplitude": "A", "poisson": "nu"}
        values = {name: getattr(self, name)[0] for name in symbols if name != self.quantity}
        words = [f"{symbols[n]} {v:g}" for n, v in values.items() if v or n != "poisson"]
        return ", ".join([self.motion, *words])

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        several = f"{self.quantity or 'no key'} has several numbers"
        known = self.quantity in Block.model_fields
        refuse(not known, f"{several}; allowed: one key with several numbers")


class Stability(Settings):
    """Study of the failures of methods. Its dataset is stability.nc."""

    methods: Methods = method_names()
    """Methods to compare, named as in the study `accuracy`."""
    tolerance: Tolerance = 1e-3
    """Largest accepted absolute error of mu_macro."""
    axes: dict[Text, Block]
    """Blocks of cases by name."""


class Claims(_Grid):
    """Test of the statements of the paper. Its dataset is claims.nc."""

    tolerance: Tolerance = 5e-4
    """Largest accepted absolute error of mu_macro."""
    cells: Annotated[int, _number(8, 64, 2)] = 32
    """Number of rings in the runs whose tractions are evaluated. This is also the number of angular
    points on half the disc. The error estimate comes from a run with half this number."""

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        super().model_post_init(context)
        for motion, largest in STATIC_AMPLITUDES.items():
            values = self.amplitude[motion]
            allowed = f"at least one number up to {largest:g}, where there is static friction"
            problem = f"{[*values]} is not allowed; allowed: {allowed}"
            refuse(values[0] > largest, problem, f".amplitude_{motion}")


def _required(kind: str, sweep: Sweep) -> str:
    """Return the requirement of a kind of figure that a sweep does not meet, or "" if the sweep can
    be drawn."""
    several, line = sweep.several, "two velocities above 0, or two values of another axis"
    is_map = sweep.spans_a_map or {"amplitude", "force"} <= several
    is_map = is_map and several <= {"amplitude", "velocity", "force", "poisson"}
    plane = "two amplitudes, and two velocities above 0 or two forces, at one stiffness and mass"
    is_line = several & {"force"} if sweep.force else several
    is_steady = sweep.motion == "continuous-bore"
    is_run = not sweep.drives.keys() - ({"force"} if sweep.velocity else set())
    is_history = is_run and not (is_steady or sweep.is_certified)
    is_steady_run = is_run and is_steady and sweep.pressure == "hertz"
    needs = {
        "map": (is_map, plane),
        "curves": (is_line, f"{line}; with a force, two forces"),
        "history": (is_history, "an oscillation with a velocity, no spring and no key error"),
        "explorer": ({*sweep.dims} - {"poisson"}, "two values of an axis except poisson"),
    }
    what = "the motion continuous-bore with a velocity, no spring and the pressure hertz"
    needs |= dict.fromkeys(("field", "transients"), (is_steady_run, what))
    is_enough, text = needs[kind]
    return "" if is_enough else text


class Configuration(Settings):
    """A configuration of points to compute and figures to draw."""

    results: Annotated[str, _FOLDER] = "results"
    """Folder for all results, relative to the working directory of the workflow."""
    points_per_job: Annotated[int, _number(1, 100_000, 1)] = 320
    """Mean number of points that one job computes in sequence. A job takes about a second to start,
    but large jobs leave cores idle at the end."""
    sweeps: dict[Name, Sweep] = {}
    """Sweeps by name. The dataset of a sweep has the same name."""
    figures: dict[Name, Figure] = {}
    """Figures by name."""
    accuracy: Accuracy | None = None
    """Study of the cost of accuracy."""
    stability: Stability | None = None
    """Study of the failures of methods."""
    claims: Claims | None = None
    """Test of the statements of the paper."""

    @property
    def studies(self) -> dict[str, Accuracy | Stability | Claims]:
        """Studies in the configuration, keyed by name."""
        return {name: study for name in STUDIES if (study := getattr(self, name)) is not None}

    @property
    def datasets(self) -> dict[str, Sweep | Accuracy | Stability | Claims]:
        """Sweeps and studies, keyed by the name of the dataset."""
        return self.sweeps | self.studies

    def model_post_init(self, context: Any, /) -> None:
        """Raise Refusal if settings contradict each other."""
        taken = {*STUDIES, *SOLVING, *MAKING}
        for key, names in (("sweeps", self.sweeps), ("figures", self.figures)):
            for name in names:
                problem = "another result or rule has this name; allowed: a new one"
                refuse(name in taken, problem, f".{key}.{name}")
            taken |= names.keys()
        problem = f"nothing is not allowed; required: sweeps, {', '.join(STUDIES)}"
        refuse(not self.datasets, problem, ".sweeps")
        runs: set[tuple[str, ...]] = set()
        for name, figure in self.figures.items():
            self._refuse_figure(f".figures.{name}", figure)
            one = figure.kind, *figure.sweep[:1]
            problem = f"{one[-1]} has another figure of this kind; allowed: one"
            refuse(bool(figure.run) and one in runs, problem, f".figures.{name}.kind")
            runs.add(one)

    def _refuse_figure(self, key: str, figure: Figure) -> None:
        study = KINDS[figure.kind].study
        key, names = (f"{key}.kind", self.studies) if study else (f"{key}.sweep", self.sweeps)
        for name in figure.datasets:
            refuse_unknown(name, names, f"{figure.kind} needs {shown(name)}, which is missing", key)
        for name in figure.sweep:
            required = _required(figure.kind, self.sweeps[name])
            problem = f"{name} cannot be drawn as {figure.kind}; required: {required}"
            refuse(required != "", problem, key)
        if figure.kind == "explorer":
            sweeps = [one for name in figure.sweep if not (one := self.sweeps[name]).is_certified]
            points = sum(math.prod(map(len, sweep.axes.values())) for sweep in sweeps)
            _refuse_crowd(points, MOST_ON_PAGE, key)
            maps = [s for s in sweeps if s.spans_a_map and s.motion in STATIC_AMPLITUDES]
            allowed = "transverse or bore with two amplitudes and two velocities above 0"
            refuse(not maps, f"has no map; required: {allowed}", key)
