"""Keys of a configuration: types, ranges, defaults and descriptions.

The tables in config/README.md are written from these models.  All quantities are dimensionless.
"""

import json
import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from microslip.config.kinds import KINDS
from microslip.foundation.arguments import LARGEST
from microslip.foundation.canonical import number
from microslip.foundation.errors import InputError
from microslip.foundation.spec import near_miss
from microslip.periodic.methods import names as method_names
from microslip.periodic.methods import split as split_method

MOST_POINTS = 1_000_000
"""Largest number of points in a sweep.  With more points, planning takes more than a minute."""
MOST_MAP_POINTS = 10_000
"""Largest number of points in a map of a study.  Every model computes all of these points."""
MOST_ON_PAGE = 20_000
"""Largest number of points on a page of the explorer.  A point takes about 80 bytes."""
LOOSEST_POINTS = 1e-2
"""Largest tolerance of the points in a certified map.  The refinement would mistake larger errors
for curvature, and halve cells without need."""
SHARE_OF_POINTS = 0.3
"""Default tolerance of the points in a certified map, divided by its error."""
STATIC_AMPLITUDES = {"transverse": 1.0, "bore": 5.0}
"""Largest amplitude with static friction in the maps of the paper, for each motion."""
DRIVES = ("mass", "damping", "stiffness", "force")
"""Parameters of a drive, in the order of dataset dimensions."""
AXES = ("mass", "damping", "stiffness", "poisson", "amplitude", "velocity", "force")
"""Axes of a sweep, in the order of dataset dimensions."""
RULES = (
    "all",
    "make_products",
    "solve_batch",
    "solve_map",
    "make_dataset",
    "draw_figure",
    "make_page",
    "link_file",
)
"""Names of the rules of the workflow, which datasets and figures must not have."""


EXPONENT = re.compile(r"[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+")


class Refusal(ValueError):
    """A value that is not allowed.  The message is one line.

    Attributes
    ----------
    key : str
        Key of the value, relative to the settings that are checked.
    """

    def __init__(self, message: str, key: str = ""):
        super().__init__(message)
        self.key = key


def refuse(is_bad: bool, message: str, key: str = "") -> None:
    """Raise Refusal with a message if a condition is true."""
    if is_bad:
        raise Refusal(message, key)


# Types of values


@dataclass(frozen=True)
class Allowed:
    """Type of a value, as metadata of pydantic.

    Attributes
    ----------
    text : str
        The allowed values, for messages and for config/README.md.
    convert : callable
        Function that converts a value from YAML.  It raises ValueError or TypeError for a value
        that is not allowed, or Refusal with a message of its own.
    """

    text: str
    convert: Callable[[Any], Any]

    def __call__(self, value: Any) -> Any:
        try:
            return self.convert(value)
        except Refusal:
            raise
        except (ValueError, TypeError, OverflowError):
            raise Refusal(f"{short_json(value)} is not allowed; allowed: {self.text}") from None

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self)


def short_json(value: object) -> str:
    """Format a value as JSON, truncated to 60 characters."""
    try:
        text = json.dumps(value, default=str, ensure_ascii=False)
    except (ValueError, RecursionError):  # an integer of thousands of digits
        text = f"a value of type {type(value).__name__}"
    text = text.encode("utf-8", "backslashreplace").decode()  # escapes lone surrogates
    return text if len(text) <= 60 else f"{text[:57]}..."


def _number(low: float, high: float, step: int = 0, above: bool = False) -> Allowed:
    """Number between two bounds.

    step: 1 for whole numbers, 2 for even numbers.  above: True if `low` itself is not allowed.
    """
    word = ("a number", "a whole number", "an even number")[step]

    def convert(value: Any) -> float:
        if isinstance(value, str) and EXPONENT.fullmatch(value):
            value = float(value)  # YAML 1.1 reads 1e-3 as text
        if isinstance(value, str):
            raise Refusal(f"{short_json(value)} is text; allowed: a number without quotes")
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise TypeError
        if not math.isfinite(value):
            raise Refusal(f"{value} is not allowed; allowed: a finite number")
        if not low <= value <= high or (above and value == low) or (step and value % step):
            raise ValueError
        return int(value) if step else float(number(value))

    return Allowed(f"{word} {'>' if above else '>='} {low:g} and <= {high:g}", convert)


def _or_null(kind: Allowed) -> Allowed:
    return Allowed(f"{kind.text}, or null", lambda v: None if v is None else kind(v))


def _text(text: str, fits: Callable[[str], bool]) -> Allowed:
    def convert(value: Any) -> str:
        if not (isinstance(value, str) and fits(value)):
            raise ValueError
        return value

    return Allowed(text, convert)


def _one_of(*names: str) -> Allowed:
    allowed = ", ".join(names)

    def convert(value: Any) -> str:
        if value not in names:
            hint = near_miss(value, names) if isinstance(value, str) else ""
            raise Refusal(f"{short_json(value)} is not allowed; {hint}allowed: {allowed}")
        return value

    return Allowed(allowed, convert)


def _list(kind: Allowed, text: str) -> Allowed:
    """List of at least one value of a kind, without repetition; it is converted to a tuple."""

    def convert(values: Any) -> tuple:
        if not isinstance(values, list | tuple) or not values:
            raise TypeError
        result = tuple(_at(f"[{i}]", kind, value) for i, value in enumerate(values))
        twice = next((value for i, value in enumerate(result) if value in result[:i]), None)
        if twice is not None:
            raise Refusal(f"{twice} occurs twice; allowed: different values")
        return result

    return Allowed(text, convert)


def _at(key: str, kind: Allowed, value: Any) -> Any:
    """Convert a value.  A Refusal gets a key."""
    try:
        return kind(value)
    except Refusal as error:
        raise Refusal(str(error), f"{key}{error.key}") from None


def _axis(
    low: float = 0.0, high: float = LARGEST["velocity"], step: int = 0, above: bool = False
) -> Allowed:
    """Axis: a number, or a list of numbers and ranges; it is converted to an ascending tuple."""
    one = _number(low, high, step, above)

    def convert(raw: Any) -> tuple[float, ...]:
        items = list(raw) if isinstance(raw, list | tuple) else [raw]
        if not items:
            raise ValueError
        values: set[float] = set()
        for i, item in enumerate(items):
            key = f"[{i}]" if isinstance(raw, list | tuple) else ""
            if isinstance(item, dict):
                values.update(_at(key, _RANGE, item))
            elif item is None or isinstance(item, list):
                raise TypeError
            else:
                values.add(_at(key, one, item))
        ordered = tuple(sorted(map(one, values)))
        for left, right in pairwise(ordered):
            if right - left <= 1e-9 * right:
                raise Refusal(f"{right:.12g} occurs twice; allowed: different values")
        return ordered

    return Allowed(f"{one.text}, or a list of numbers and ranges", convert)


def _spaced(value: Any) -> list[float]:
    """Values of a range such as {"log": [0.001, 10, 25]}, rounded to six significant digits."""
    keys = list(value)
    if len(keys) != 1 or keys[0] not in ("log", "linear"):
        hint = near_miss(keys[0], ("log", "linear")) if len(keys) == 1 else ""
        example = "{log: [first, last, count]} or {linear: [first, last, count]}"
        raise Refusal(f"{short_json(value)} is not allowed; {hint}allowed: {example}")
    ((spacing, ends),) = value.items()
    if not isinstance(ends, list | tuple) or len(ends) != 3:
        raise Refusal(
            f"{short_json(ends)} is not allowed; allowed: [first, last, count]", f".{spacing}"
        )
    kinds = (_number(0.0, LARGEST["velocity"], above=spacing == "log"),) * 2 + (_number(2, 1e5, 1),)
    first, last, count = (
        _at(f".{spacing}[{i}]", kind, end)
        for i, (kind, end) in enumerate(zip(kinds, ends, strict=True))
    )
    if last <= first or math.isinf(last / first if spacing == "log" else 1.0):
        raise Refusal(
            f"{short_json(ends)} is not allowed; allowed: last above first", f".{spacing}"
        )
    shares = (i / (count - 1) for i in range(count))
    if spacing == "linear":
        values = (first + (last - first) * share for share in shares)
    else:
        values = (first * math.exp(math.log(last / first) * share) for share in shares)
    # Coordinates with six digits are readable and do not depend on the machine.
    return [float(f"{value:.6g}") for value in values]


_RANGE = Allowed("a range", _spaced)


def _is_title(text: str) -> bool:
    return text.isprintable() and text.strip() != "" and len(text) <= 100


def _is_name(text: str) -> bool:
    plain = text.isascii() and text == text.lower() and text.isidentifier()
    return plain and not text.startswith("_") and len(text) <= 100


def _is_folder(text: str) -> bool:
    parts = ("://", "{", "}", "*", "?", "$")
    is_plain = text.isprintable() and not any(part in text for part in parts)
    return is_plain and text.strip() != "" and not text.startswith("~")


def _checked_method(text: Any) -> str:
    try:
        split_method(text)
    except InputError as error:
        raise Refusal(f"{error.value!r}: {error.allowed}") from None
    return text


_METHOD = Allowed("the name of a method, such as projected-gradient:step=0.5", _checked_method)
_MODEL = _one_of("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian")
Positive = Annotated[float, _number(0, LARGEST["velocity"], above=True)]
NonNegative = Annotated[float, _number(0, LARGEST["velocity"])]
Ratio = Annotated[float, _number(0, 0.5)]
Tolerance = Annotated[float, _number(1e-6, 0.1)]
Cells = Annotated[int | None, _or_null(_number(4, LARGEST["cells"], 2))]
Steps = Annotated[int | None, _or_null(_number(8, LARGEST["steps"], 2))]
Text = Annotated[str, _text("text", bool)]
Title = Annotated[str | None, _or_null(_text("text on one line, up to 100 characters", _is_title))]
Name = Annotated[
    str, _text("a name of small letters, digits and _ that begins with a letter", _is_name)
]
Axis = Annotated[tuple[float, ...], _axis()]
PositiveAxis = Annotated[tuple[float, ...], _axis(above=True)]
Methods = Annotated[
    tuple[str, ...],
    Allowed(
        "a list of methods, or null for all",
        lambda v: method_names() if v is None else _list(_METHOD, "a list of methods")(v),
    ),
]


def _refuse_crowd(points: int, most: int, key: str = "") -> None:
    refuse(points > most, f"{points} points are not allowed; allowed: at most {most}", key)


class Settings(BaseModel):
    """Settings by key.  Unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


# Sweeps


class Sweep(Settings):
    """A grid of points.  Every axis with more than one value is a dimension of the dataset.

    A sweep with `error` is a certified map over the ranges of its axes.
    """

    motion: Text
    """Motion, with parameters as in "elliptic:forward=0.5,phase=30", or file:FILE."""
    pressure: Text = "hertz"
    """Normal pressure, with parameters as in "power:exponent=1", or file:FILE."""
    title: Title = None
    """Title of the dataset, also used in figures. It is plain text: $ and \\ have no special
    meaning."""
    velocity: Axis = ()
    """Forward velocity in the unit of the motion. The value 0 requests the static limit. With a
    stiffness, it is the velocity of the far end of the spring."""
    force: Axis = ()
    """Prescribed force P divided by mu times the mean normal load. It replaces the velocity."""
    amplitude: Axis = ()
    """Amplitude in the unit of the motion. It is required unless the motion is steady."""
    poisson: Annotated[tuple[float, ...], _axis(0, 0.5)] = (0.0,)
    """Poisson's ratio of the half-space."""
    stiffness: Axis = ()
    """Stiffness of a spring divided by mu F_z / u_lim, above 0."""
    mass: Axis = ()
    """Mass of the body divided by mu F_z / (u_lim omega^2)."""
    damping: Axis = ()
    """Damping parallel to the spring, divided by mu F_z / (u_lim omega)."""
    model: Annotated[str, _MODEL] = "auto"
    """Contact model. The value auto selects the cheapest model that is exact for the motion."""
    method: Annotated[str | None, _or_null(_METHOD)] = None
    """Method to compare with that of microslip.solve, which is the default."""
    tolerance: Annotated[float | None, _or_null(_number(1e-6, 0.1))] = 1e-3
    """Largest accepted absolute error of mu_macro. With null, cells and steps are prescribed, and a
    point has converged if its runs have reached the periodic state. The default for a certified map
    is three tenths of `error`, at most 0.01."""
    cells: Cells = None
    """Number of rings, or of squares across the contact. By default, it follows from the
    tolerance."""
    steps: Steps = None
    """Number of time steps in a period. By default, it follows from the tolerance."""
    error: Annotated[float | None, _or_null(_number(1e-5, 0.1))] = None
    """Largest absolute error of mu_macro anywhere between the ends of the axes of a certified
    map."""

    @property
    def axes(self) -> dict[str, tuple[float, ...]]:
        """Values by axis, in the order of AXES.  An axis that is not given is left out."""
        return {name: getattr(self, name) for name in AXES if getattr(self, name)}

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions of the dataset: the names of the axes with more than one value."""
        return tuple(name for name, values in self.axes.items() if len(values) > 1)

    @property
    def drives(self) -> dict[str, tuple[float, ...]]:
        """Values by parameter of the drive, for the parameters that are given."""
        return {name: getattr(self, name) for name in DRIVES if getattr(self, name)}

    @property
    def is_certified(self) -> bool:
        """True for a certified map."""
        return self.error is not None

    @property
    def spans_a_map(self) -> bool:
        """True if there are at least two amplitudes and two velocities above 0."""
        return len(self.amplitude) > 1 and sum(v > 0 for v in self.velocity) > 1

    @model_validator(mode="before")
    @classmethod
    def _tolerance_of_a_map(cls, values: Any) -> Any:
        if not isinstance(values, dict) or "tolerance" in values:
            return values
        error = values.get("error")
        if isinstance(error, int | float) and not isinstance(error, bool):
            loosest = min(SHARE_OF_POINTS * error, LOOSEST_POINTS)
            return values | {"tolerance": max(loosest, 1e-6)}
        return values

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        if not (self.velocity or self.force):
            raise Refusal("missing; required: velocity, or force in its place", "velocity")
        if self.velocity and self.force:
            raise Refusal("is not allowed beside velocity; allowed: one of them", "force")
        free = [name for name in ("cells", "steps") if getattr(self, name) is None]
        free = [name for name in free if self.amplitude or name != "steps"]
        if self.tolerance is None and (free or self.is_certified):
            imposed = "a number" + (f", or {' and '.join(free)} imposed" if free else "")
            raise Refusal(f"null is not allowed; allowed: {imposed}", "tolerance")
        _refuse_crowd(math.prod(map(len, self.axes.values())), MOST_POINTS)
        if self.error is not None and self.tolerance is not None:
            self._refuse_uncertifiable(self.error, self.tolerance)
        return self

    def _refuse_uncertifiable(self, error: float, tolerance: float) -> None:
        bound = f"less than the error, {error:g}, and at most {LOOSEST_POINTS:g}"
        message = f"{tolerance:g} is not allowed; allowed: {bound}"
        refuse(tolerance >= error or tolerance > LOOSEST_POINTS, message, "tolerance")
        names = ("cells", "steps", "method", *self.drives)
        imposed = ", ".join(name for name in names if getattr(self, name))
        refuse(imposed != "", f"is not allowed with {imposed}; allowed: a tolerance", "error")
        static = len(self.amplitude) > 1 and 0.0 in self.velocity
        ranges = "two amplitudes and two velocities above 0, or two amplitudes and velocity 0"
        message = f"is not allowed for these axes; allowed: {ranges}"
        refuse(not (self.spans_a_map or static), message, "error")


# Figures


def _names(value: Any) -> tuple[str, ...]:
    names = _list(Allowed("the name of a sweep", str), "the name of a sweep, or a list of names")
    return names([value] if isinstance(value, str) else value)


class Figure(Settings):
    """A figure.  Its kind determines what is drawn."""

    kind: Annotated[str, _one_of(*KINDS)]
    """Kind of figure. map draws friction over two axes, and curves over one axis, with a panel for
    each sweep. history, field and transients draw a single run. explorer is an interactive page."""
    sweep: Annotated[
        tuple[str, ...], Allowed("the name of a sweep, or a list of names", _names)
    ] = ()
    """Sweeps to draw. A figure of a study has no sweep."""
    velocity: Annotated[float | None, _number(0, LARGEST["velocity"], above=True)] = None
    """Velocity of the single run."""
    amplitude: Annotated[float | None, _number(0, LARGEST["amplitude"])] = None
    """Amplitude of the single run (history)."""
    periods: Annotated[int | None, _number(1, 1000, 1)] = None
    """Number of periods, which begin without tractions (history)."""
    travel: Annotated[float | None, _number(0, LARGEST["velocity"], above=True)] = None
    """Forward displacement of each run, in units of u_lim (transients)."""
    cells: Cells = None
    """Number of rings of the single run."""
    steps: Steps = None
    """Number of time steps in a period, or in a run (transients)."""

    @property
    def run(self) -> dict[str, Any]:
        """Settings of the single run; empty if there is none."""
        values = {name: getattr(self, name) for name in KINDS[self.kind].run}
        defaults = KINDS[self.kind].run
        return {k: defaults[k] if v is None else v for k, v in values.items()}

    @property
    def datasets(self) -> tuple[str, ...]:
        """Names of the datasets that are drawn."""
        study = KINDS[self.kind].study
        return (study,) if study else self.sweep

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        kind = KINDS[self.kind]
        options = {"kind", "sweep", *kind.run} - ({"sweep"} if kind.study else set())
        for name in self.model_fields_set - options:
            allowed = ", ".join(key for key in Figure.model_fields if key in options)
            raise Refusal(f"is not allowed for the kind {self.kind}; allowed: {allowed}", name)
        if not (self.sweep or kind.study):
            raise Refusal("missing; required: the name of a sweep", "sweep")
        if kind.run and len(self.sweep) > 1:
            raise Refusal(f"{', '.join(self.sweep)} is not allowed; allowed: one sweep", "sweep")
        return self


# Studies


class StudyPoint(Settings):
    """A point at which methods are compared."""

    motion: Annotated[
        str, _one_of("transverse", "longitudinal", "bore", "continuous-bore", "zigzag")
    ]
    """Name of the motion."""
    velocity: Positive
    """Forward velocity in the unit of the motion."""
    amplitude: Annotated[float | None, _number(0, LARGEST["amplitude"], above=True)] = None
    """Amplitude in the unit of the motion. The motion continuous-bore has no amplitude."""
    poisson: Ratio = 0.0
    """Poisson's ratio of the half-space."""
    title: Title = None
    """Title of the panel. The default is the name of the point."""

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        steady = self.motion == "continuous-bore"
        if steady and self.amplitude is not None:
            message = f"{self.amplitude:g} is not allowed; {self.motion} has no amplitude"
            raise Refusal(message, "amplitude")
        if not steady and self.amplitude is None:
            raise Refusal(f"missing; required for {self.motion}", "amplitude")
        return self


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

    @model_validator(mode="after")
    def _refuse_crowd(self) -> Self:
        for motion, amplitudes in self.amplitude.items():
            points, key = len(self.velocity) * len(amplitudes), f"velocity x amplitude_{motion}"
            _refuse_crowd(points, MOST_MAP_POINTS, key)
        return self


class ModelMap(_Grid):
    """Grid for maps of the cheapest model for each tolerance, at Poisson's ratio 0."""

    tolerance: Annotated[tuple[float, ...], _axis(1e-6, 0.1)] = (1e-3, 1e-2)
    """Absolute tolerances of mu_macro. Each one has a map."""

    @model_validator(mode="after")
    def _refuse_a_line(self) -> Self:
        for name in ("velocity", "amplitude_transverse", "amplitude_bore"):
            values = list(getattr(self, name))
            message = f"{values} is not allowed; allowed: two numbers or more"
            refuse(len(values) < 2, message, name)
        return self


class Accuracy(Settings):
    """Study of the cost of accuracy, with the dataset accuracy.nc."""

    methods: Methods = method_names()
    """Methods to compare, with parameters as in "projected-gradient:step=0.5". The name
    of a file in src/microslip/periodic/methods, with hyphens, names a method; "shipped" is the
    method of microslip.solve. The default is all methods."""
    points: dict[Text, StudyPoint]
    """Points at which all methods and models run, by name. Each point has a panel."""
    levels: Annotated[int, _number(1, 6, 1)] = 6
    """Number of resolutions of each method, starting at the coarsest one."""
    repeats: Annotated[int, _number(1, 100, 1)] = 5
    """Number of measurements of each computing time. The result is their median."""
    map: ModelMap
    """Grid for maps of the cheapest model for each tolerance."""


class Block(Settings):
    """Cases at which all methods run: a point of which one quantity is varied. Exactly one key is a
    list of several numbers."""

    motion: Annotated[str, _one_of("transverse", "longitudinal", "bore", "zigzag")]
    """Name of the motion."""
    velocity: PositiveAxis
    """Forward velocity in the unit of the motion."""
    amplitude: PositiveAxis
    """Amplitude in the unit of the motion."""
    poisson: Annotated[tuple[float, ...], _axis(0, 0.5)] = (0.0,)
    """Poisson's ratio of the half-space."""
    cells: Annotated[tuple[int, ...], _axis(4, LARGEST["cells"], step=2)] = ()
    """Imposed number of rings. By default, it follows from the tolerance."""
    steps: Annotated[tuple[int, ...], _axis(8, LARGEST["steps"], step=2)] = ()
    """Imposed number of time steps in a period. By default, it follows from the tolerance."""
    step: PositiveAxis = ()
    """Parameter `step`, for methods with this parameter. Other methods are left out of the
    block."""
    title: Title = None
    """Heading of the block. The default is the name of the varied quantity."""

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
        """Values of the fixed quantities, as text."""
        symbols = {"velocity": "v", "amplitude": "A", "poisson": "nu"}
        values = {name: getattr(self, name)[0] for name in symbols if name != self.quantity}
        words = [f"{symbols[n]} {v:g}" for n, v in values.items() if v or n != "poisson"]
        return ", ".join([self.motion, *words])

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        if self.quantity not in Block.model_fields:
            message = f"{self.quantity or 'no key'} has several numbers"
            raise Refusal(f"{message}; allowed: one key with several numbers")
        return self


class Stability(Settings):
    """Study of the failures of methods, with the dataset stability.nc."""

    methods: Methods = method_names()
    """Methods to compare, named as under `accuracy`."""
    tolerance: Tolerance = 1e-3
    """Largest accepted absolute error of mu_macro."""
    axes: dict[Text, Block]
    """Blocks of the atlas by name."""


class Claims(_Grid):
    """Test of the statements of the paper, with the dataset claims.nc."""

    tolerance: Tolerance = 5e-4
    """Largest accepted absolute error of mu_macro."""
    cells: Annotated[int, _number(8, 64, 2)] = 32
    """Number of rings, and number of angular points on half the disc, in the runs whose tractions
    are evaluated. A run with half this number gives the error estimate."""

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        for motion, values in self.amplitude.items():
            largest = STATIC_AMPLITUDES[motion]
            allowed = f"at least one number up to {largest:g}, where there is static friction"
            message = f"{list(values)} is not allowed; allowed: {allowed}"
            refuse(values[0] > largest, message, f"amplitude_{motion}")
        return self


class Configuration(Settings):
    """A configuration: points to compute, figures to draw, and the folder of results."""

    results: Annotated[
        str, _text("text for a folder, without braces, *, ?, ~ in front, $ and ://", _is_folder)
    ] = "results"
    """Folder for all results, relative to the working directory of the workflow."""
    points_per_job: Annotated[int, _number(1, 100_000, 1)] = 320
    """Mean number of points that one job computes in sequence. A job takes about a second to start.
    Large jobs leave cores idle at the end."""
    sweeps: dict[Name, Sweep] = {}
    """Sweeps by name. Each has a dataset with this name."""
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
        """Studies of the configuration by name."""
        every = {name: getattr(self, name) for name in ("accuracy", "stability", "claims")}
        return {name: study for name, study in every.items() if study is not None}

    @property
    def datasets(self) -> dict[str, Sweep | Accuracy | Stability | Claims]:
        """Sweeps and studies by the name of their dataset."""
        return self.sweeps | self.studies

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        taken = {*RULES, "accuracy", "stability", "claims"}
        for key, names in (("sweeps", self.sweeps), ("figures", self.figures)):
            for name in names:
                message = "another result or rule has this name; allowed: a new one"
                refuse(name in taken, message, f"{key}.{name}")
            taken |= names.keys()
        message = "nothing is not allowed; required: sweeps, accuracy, stability or claims"
        refuse(not self.datasets, message, "sweeps")
        runs: set[tuple[str, ...]] = set()
        for name, figure in self.figures.items():
            self._refuse_figure(f"figures.{name}", figure)
            one = figure.kind, *figure.sweep[:1]
            message = f"{one[-1]} has another figure of this kind; allowed: one"
            refuse(bool(figure.run) and one in runs, message, f"figures.{name}.kind")
            runs.add(one)
        return self

    def _refuse_figure(self, key: str, figure: Figure) -> None:
        kind = KINDS[figure.kind]
        message = f"{figure.kind} needs the key {kind.study}, which is missing"
        missing = kind.study not in ("", *self.studies)
        refuse(missing, f"{message}; allowed: a kind of another key", f"{key}.kind")
        key = f"{key}.sweep"
        for name in figure.sweep:
            hint, allowed = near_miss(name, self.sweeps), ", ".join(self.sweeps) or "none"
            message = f"{short_json(name)} is no sweep; {hint}allowed: {allowed}"
            refuse(name not in self.sweeps, message, key)
            motion = self.sweeps[name].motion
            message = f"{name} has the motion {motion}; allowed: {kind.motion}"
            refuse(kind.motion not in ("", motion), message, key)
        if figure.kind == "explorer":
            grids = [self.sweeps[name] for name in figure.sweep]
            grids = [sweep for sweep in grids if not sweep.is_certified]
            points = sum(math.prod(map(len, sweep.axes.values())) for sweep in grids)
            _refuse_crowd(points, MOST_ON_PAGE, key)
            maps = [s for s in grids if s.spans_a_map and s.motion in STATIC_AMPLITUDES]
            allowed = "transverse or bore with two amplitudes and two velocities above 0"
            refuse(not maps, f"has no map; required: {allowed}", key)
