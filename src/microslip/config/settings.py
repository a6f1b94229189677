"""Keys of a configuration: types, defaults, ranges and descriptions.

Validation, the JSON schema and the tables in config/README.md follow from these models.  Axes are
serialised as they were written, so that the output is a valid configuration.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    Tag,
    model_serializer,
    model_validator,
    with_config,
)
from pydantic_core import core_schema
from typing_extensions import TypedDict

from microslip.config.axes import MOST_MAP_POINTS, coordinates, refuse_crowd
from microslip.config.records import LOOSEST_POINTS, STATIC_AMPLITUDES, Refusal
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.solver import method_names

CONFIG = ConfigDict(
    extra="forbid",
    strict=True,
    frozen=True,
    allow_inf_nan=False,
    regex_engine="python-re",  # the patterns have lookaheads
    use_attribute_docstrings=True,
    validate_default=True,
    defer_build=True,  # only the validator of Root is built
)
PLAIN = CONFIG | ConfigDict(use_attribute_docstrings=False)
"""Pydantic configuration of typed dicts. Extracting their docstrings would be slow."""
STUDIES: dict[str, dict] = json.loads(
    Path(__file__).with_name("study_defaults.json").read_text(encoding="utf-8")
)
POINTS = STUDIES["accuracy"]
"""Default points of the accuracy study, by name."""


class Settings(BaseModel):
    """Settings by key. Unknown keys are refused."""

    model_config = CONFIG

    @model_serializer(mode="wrap")
    def _without_unset(self, handler: Callable) -> dict[str, Any]:
        """Omit optional keys that are not set, so that the output is a valid configuration."""
        values = handler(self).items()
        return {k: v for k, v in values if v is not None or k in self.model_fields_set}


# Values


def _whole(value: Any) -> Any:
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _kind(value: object) -> str | None:
    """Tag of the union member for a value. Pydantic adds the tag to the location of an error."""
    if isinstance(value, list | dict):
        return "(list)" if isinstance(value, list) else "(spacing)"
    return "(number)" if isinstance(value, int | float) else None


def _no_default(rule: dict[str, Any]) -> None:
    del rule["default"]


def _optional() -> Any:
    """A key that may be omitted, but must not be null."""
    return Field(default=None, validate_default=False, json_schema_extra=_no_default)


def _raw(value: Any) -> Any:
    """A default value as written in YAML. Pydantic validates it."""
    return Field(default=value)


WHOLE = BeforeValidator(_whole)
NonNegative = Annotated[float, Field(ge=0, le=LARGEST["velocity"])]
Positive = Annotated[float, Field(gt=0, le=LARGEST["velocity"])]
Ratio = Annotated[float, Field(ge=0, le=0.5)]
Tolerance = Annotated[float, Field(ge=1e-6, le=0.1)]
Count = Annotated[int, Field(ge=2, le=100_000), WHOLE]
Cells = Annotated[int, Field(ge=4, le=LARGEST["cells"], multiple_of=2), WHOLE]
Steps = Annotated[int, Field(ge=8, le=LARGEST["steps"], multiple_of=2), WHOLE]
Points = Annotated[int, Field(ge=1, le=100_000), WHOLE]

# At least one character other than spaces; no control characters, line breaks and surrogates.
WRITABLE = r"^(?=.*\S)[^\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufffe\uffff]+$(?!\n)"
# A folder without wildcards and without ~, $NAME and ://, which other programs expand.
FOLDER = (
    r"^(?!~)(?!.*://)(?!.*\$[A-Za-z_])(?=.*\S)"
    r"[^{}*?\x00-\x1f\x7f\x85\u2028\u2029\ud800-\udfff]+$(?!\n)"
)
ONE_LINE = "text on one line, of up to 100 characters that can be written"
Text = Annotated[str, Field(min_length=1)]
Title = Annotated[str, Field(max_length=100, pattern=WRITABLE, title=ONE_LINE)]
PointName = Annotated[
    Title, BeforeValidator(lambda name: str(name) if type(name) in (int, float) else name)
]
PlainName = Annotated[
    str,
    Field(
        max_length=100,
        pattern=r"^[a-z][a-z0-9_]*$(?!\n)",
        title="a name of up to 100 small letters, digits and _ that begins with a letter",
    ),
]
Model = Literal["auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"]


# Axes


@with_config(PLAIN)
class Range(TypedDict):
    """Coordinates from start to stop, including both, rounded to six significant digits."""

    start: Annotated[NonNegative, Field(description="First; above 0 for equal ratios.")]
    stop: Annotated[NonNegative, Field(description="Last, above start.")]
    count: Annotated[Count, Field(description="Number of coordinates.")]


@with_config(PLAIN | ConfigDict(title="linear or log spacing"))
class Spacing(TypedDict, total=False):
    """Evenly spaced coordinates."""

    linear: Annotated[Range, Field(description="Equal distances.")]
    log: Annotated[Range, Field(description="Equal ratios.")]


def _one(spacing: Spacing) -> Spacing:
    if len(spacing) != 1:
        raise ValueError("allowed: linear or log")
    return spacing


_Number = Annotated[NonNegative, Tag("(number)")]
_List = Annotated[list[NonNegative], Field(min_length=1), Tag("(list)")]
_Spacing = Annotated[Spacing, AfterValidator(_one), Tag("(spacing)")]
_Ratios = Annotated[list[Ratio], Field(min_length=1), Tag("(list)")]


class Axis(tuple[float, ...]):
    """Coordinates in ascending order.

    Attributes
    ----------
    raw : list, dict or number
        The axis as in YAML.
    """

    raw: Any
    form: ClassVar[Any] = Annotated[_List | _Spacing, Discriminator(_kind)]

    @classmethod
    def of(cls, raw: Any) -> Self:
        """Convert an axis from YAML; raises Refusal."""
        axis = cls(coordinates(raw))
        axis.raw = raw
        return axis

    @classmethod
    def __get_pydantic_core_schema__(
        cls, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        as_written = core_schema.plain_serializer_function_ser_schema(
            lambda axis: axis and axis.raw
        )
        form = handler.generate_schema(cls.form)
        return core_schema.no_info_after_validator_function(cls.of, form, serialization=as_written)


class NumberOrAxis(Axis):
    """A number, or an axis, which becomes a dimension of the dataset."""

    form = Annotated[_Number | _List | _Spacing, Discriminator(_kind)]


class Poisson(Axis):
    """A Poisson's ratio, or a list of them."""

    form = Annotated[Annotated[Ratio, Tag("(number)")] | _Ratios, Discriminator(_kind)]


class Tolerances(Axis):
    """A list of tolerances."""

    form = Annotated[list[Tolerance], Field(min_length=1)]


def _above_zero(axis: Axis) -> Axis:
    if axis[0] <= 0:
        raise Refusal(f"{axis[0]:g} is not allowed; allowed: numbers > 0")
    return axis


def _two(axis: Axis) -> Axis:
    if len(axis) < 2:
        raise Refusal(f"{list(axis)} is not allowed; allowed: two numbers or more")
    return axis


PositiveAxis = Annotated[Axis, AfterValidator(_above_zero)]
MapAxis = Annotated[PositiveAxis, AfterValidator(_two)]


# Sweeps


class Adaptive(Settings):
    """A certified map over the ranges of the sweep. `snakemake certified` makes
    certified_NAME.nc."""

    error: Annotated[float, Field(ge=1e-5, le=0.1)]
    """Largest absolute error of mu_macro anywhere in the ranges. Under a force, it is the largest
    error of the velocity v, divided by sqrt(1 + v^2)."""
    tolerance: Annotated[float, Field(ge=1e-6, le=LOOSEST_POINTS)] | None = None
    """Largest error of mu_macro at the points. It must be smaller than `error`. The default null
    means three tenths of `error`, at most 0.01."""

    @model_validator(mode="after")
    def _refuse_loose_points(self) -> Self:
        if self.tolerance is not None and self.tolerance >= self.error:
            message = f"{self.tolerance:g} is not allowed; allowed: less than the error"
            raise Refusal(f"{message}, which is {self.error:g}", "tolerance")
        return self


class SteadySweep(Settings):
    """Keys of every sweep."""

    velocity: Axis
    """Forward velocity in the unit of the motion, which is v0/(omega u_lim) (Eq 4), v0/(Omega phi0
    a) (Eq 28) or v0/(omega a) (Eq 13). The value 0 requests the static limit."""
    poisson: Poisson = _raw(0.0)
    """Poisson's ratio of the half-space. A list makes it a dimension of the dataset."""
    model: Model = "auto"
    """Contact model. The value auto selects the cheapest model that is exact for the motion."""
    tolerance: Tolerance | None = 1e-3
    """Largest accepted absolute error of mu_macro. With null, cells and steps are prescribed, and a
    point has converged if its runs have reached the periodic state."""
    cells: Cells | None = None
    """Number of rings, or of squares across the contact. It must be even. By default, it follows
    from the tolerance."""
    steps: Steps | None = None
    """Number of time steps in a period. It must be even. By default, it follows from the
    tolerance."""
    points_per_job: Points | None = None
    """Number of points that one job of this sweep computes. The default is the top-level value."""

    @model_validator(mode="after")
    def _refuse_no_tolerance(self) -> Self:
        steady = getattr(self, "amplitude", None) is None  # without time steps
        free = [name for name in ("cells", "steps") if getattr(self, name) is None]
        free = [name for name in free if not (steady and name == "steps")]
        if self.tolerance is None and free:
            imposed = f"{' and '.join(free)} imposed"
            raise Refusal(f"null is not allowed; allowed: a number, or {imposed}", "tolerance")
        return self


class Sweep(SteadySweep):
    """Keys of a sweep for transverse oscillations (Eq 1) or oscillating rotations (Eq 23)."""

    amplitude: Axis
    """Amplitude, which is y0/u_lim (Eq 2) or phi0/phi_lk(a/2) (Eq 27)."""
    adaptive: Adaptive | None = None
    """Settings of a certified map over the same ranges (see below). By default, no map is made."""


class _NamedSweep(SteadySweep):
    motion: Text
    """Motion, with parameters as in "elliptic:forward=0.5,phase=30", or file:FILE."""
    pressure: Text = "hertz"
    """Normal pressure, with parameters as in "power:exponent=1", or file:FILE."""
    title: Title | None = None
    """Title of the dataset, also used in figures. It is plain text: $ and \\ have no special
    meaning. The default is the name."""
    amplitude: Axis = _optional()
    """Amplitude in the unit of the motion. It is required unless the motion is steady."""
    tolerance: Tolerance = 1e-3
    """Largest accepted absolute error of mu_macro."""


class ExtendedSweep(_NamedSweep):
    """A sweep of any motion under any pressure. A group of sweeps with at least two amplitudes and
    two positive velocities is drawn as maps. Other groups are drawn as lines. A figure has at most
    12 maps or 8 lines."""

    group: PlainName
    """Group of the sweep. The figure extended_GROUP shows all sweeps of the group, either as maps
    or as lines."""
    adaptive: Adaptive | None = None
    """Settings of a certified map over the same ranges (see below). By default, no map is made."""


class DriveSweep(_NamedSweep):
    """A sweep of a contact driven by a force or a spring. Each axis is a dimension of the
    dataset."""

    velocity: Axis = _optional()
    """Velocity of the far end of the spring, in the unit of the motion. It is not allowed together
    with a force."""
    force: NumberOrAxis = _optional()
    """Prescribed force P divided by mu times the mean normal load. It replaces the velocity. A
    number or an axis."""
    stiffness: NumberOrAxis = _optional()
    """Stiffness of the spring divided by mu F_z / u_lim, above 0. A number or an axis."""
    mass: NumberOrAxis = _optional()
    """Mass of the body divided by mu F_z / (u_lim omega^2). A number or an axis."""
    damping: NumberOrAxis = _optional()
    """Damping parallel to the spring, divided by mu F_z / (u_lim omega). A number or an axis."""


@with_config(PLAIN)
class Sweeps(TypedDict, total=False):
    """Sweeps of the paper. A sweep that is left out is not run."""

    transverse: Annotated[Sweep, Field(description="Oscillation across the motion (Eq 1).")]
    bore: Annotated[Sweep, Field(description="Oscillating rotation (Eq 23).")]
    continuous_bore: Annotated[SteadySweep, Field(description="Steady rotation (Eq 12).")]


# Single runs


class ForceHistory(Settings):
    """Forces during the first periods of a transverse oscillation (Figure 1)."""

    velocity: Positive = 0.1
    """Forward velocity v0/(omega u_lim)."""
    amplitude: NonNegative = 1.0
    """Amplitude of the oscillation y0/u_lim."""
    periods: Annotated[int, Field(ge=1, le=1000), WHOLE] = 4
    """Number of periods. The tractions are zero at the start."""
    cells: Cells | None = None
    """Number of rings. It must be even. The default is the same as in microslip.history."""
    steps: Steps | None = None
    """Number of time steps in a period. It must be even. The default is the same as in
    microslip.history."""


class TractionField(Settings):
    """Traction field of the steady continuous bore (Figure 3)."""

    velocity: Positive = 0.5
    """Forward velocity v0/(a omega). The centre of rotation is at the coordinate -velocity."""
    cells: Cells | None = None
    """Number of rings. It must be even. The default is the same as in microslip.history."""


class Transients(Settings):
    """Approach of a continuous bore to its steady state, from three initial states (Figure 5)."""

    velocity: Positive = 0.8
    """Forward velocity v0/(a omega)."""
    travel: Positive = 5.0
    """Forward displacement of each run, in units of u_lim."""
    cells: Cells | None = None
    """Number of rings. It must be even. The default is the same as in microslip.history."""
    steps: Steps | None = None
    """Number of time steps in a run. It must be even. The default is the same as in
    microslip.history."""


class Histories(Settings):
    """Single runs for Figures 1, 3 and 5, stored in the dataset of their motion."""

    transverse: ForceHistory = _raw({})
    """Forces during the first periods of a transverse oscillation (Figure 1)."""
    field: TractionField = _raw({})
    """Traction field of the steady continuous bore (Figure 3)."""
    transients: Transients = _raw({})
    """Approach of a continuous bore to its steady state, from three initial states (Figure 5)."""


# Studies


def _refuse_repeats(values: list[str] | None) -> list[str] | None:
    names = values or []
    twice = next((name for i, name in enumerate(names) if name in names[:i]), None)
    if twice is not None:
        raise Refusal(f"{twice} occurs twice; allowed: different values")
    return values


def _refuse_unknown(methods: list[str]) -> list[str]:
    for i, text in enumerate(methods):
        try:
            method_names.check(text)
        except InputError as error:
            raise Refusal(f"{error.value!r}: {error.allowed}", f"[{i}]") from None
    return methods


def _all_methods(methods: Any) -> Any:
    return list(method_names.names()) if methods is None else methods


_Names = Annotated[list[str], Field(min_length=1)]
Methods = Annotated[
    _Names,
    BeforeValidator(_all_methods, json_schema_input_type=_Names | None),
    AfterValidator(_refuse_repeats),
    AfterValidator(_refuse_unknown),
]
Block = Literal[
    "steps",
    "slow-transverse",
    "slow-bore",
    "critical-amplitude",
    "tiny-amplitude",
    "poisson",
    "edge",
    "centre",
    "rotation-centre",
    "reversal",
    "step-length",
]


class StudyPoint(Settings):
    """A point at which methods are compared."""

    motion: Literal["transverse", "longitudinal", "bore", "continuous-bore", "zigzag"]
    """Name of the motion."""
    velocity: Positive
    """Forward velocity in the unit of the motion, above 0."""
    amplitude: Positive | None = None
    """Amplitude in the unit of the motion, above 0. The motion continuous-bore has no amplitude."""
    poisson: Ratio = 0.0
    """Poisson's ratio of the half-space."""
    title: Title | None = None
    """Title of the panel, as plain text. The default is the name of the point."""

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        steady, amplitude = self.motion == "continuous-bore", self.amplitude
        if steady and amplitude is not None:
            message = f"{amplitude:g} is not allowed; {self.motion} has no amplitude"
            raise Refusal(message, "amplitude")
        if not steady and amplitude is None:
            raise Refusal(f"missing; required for {self.motion}", "amplitude")
        return self


class _Grid(Settings):
    velocity: Axis
    amplitude_transverse: Axis
    amplitude_bore: Axis

    @property
    def amplitude(self) -> dict[str, Axis]:
        """Amplitudes by motion."""
        return {"transverse": self.amplitude_transverse, "bore": self.amplitude_bore}

    @model_validator(mode="after")
    def _refuse_crowd(self) -> Self:
        for motion, amplitudes in self.amplitude.items():
            points = len(self.velocity) * len(amplitudes)
            refuse_crowd(points, MOST_MAP_POINTS, f"velocity x amplitude_{motion}")
        return self


class ModelMap(_Grid):
    """Grid for maps of the cheapest model for each tolerance, at Poisson's ratio 0."""

    velocity: MapAxis = _raw({"log": {"start": 0.001, "stop": 10, "count": 13}})
    """Forward velocities of both motions, above 0."""
    amplitude_transverse: MapAxis = _raw({"log": {"start": 0.1, "stop": 3, "count": 9}})
    """Amplitudes of the oscillation y0/u_lim, above 0."""
    amplitude_bore: MapAxis = _raw({"log": {"start": 0.1, "stop": 5, "count": 9}})
    """Amplitudes of the rotation phi0/phi_lk(a/2), above 0."""
    tolerance: Tolerances = _raw([0.01, 0.001])
    """Absolute tolerances of mu_macro. Each one has a map."""


class Accuracy(Settings):
    """Study of the cost of accuracy. `snakemake accuracy` makes accuracy_cost.nc and its
    figures."""

    methods: Methods = _raw(None)
    """Methods to compare, with parameters as in "projected-gradient:step=0.5". A method has the
    name of its file in src/microslip/solver/methods, with hyphens. The name "shipped" means the
    method used by microslip.solve. The default is all methods."""
    points: Annotated[dict[PointName, StudyPoint], Field(min_length=1)] = _raw(POINTS)
    """Points at which all methods and models run, by name. Each point has a panel."""
    levels: Annotated[int, Field(ge=1, le=6), WHOLE] = 6
    """Number of resolutions of each method, starting at the coarsest one."""
    repeats: Annotated[int, Field(ge=1, le=100), WHOLE] = 5
    """Number of measurements of each computing time. The result is their median."""
    map: ModelMap = _raw({})
    """Grid for maps of the cheapest model for each tolerance."""


class Stability(Settings):
    """Study of method failures. `snakemake stability` makes stability.nc and its figure."""

    methods: Methods = _raw(None)
    """Methods to compare, named as under `accuracy`."""
    tolerance: Tolerance = 1e-3
    """Largest accepted absolute error of mu_macro."""
    axes: Annotated[
        Annotated[list[Block], Field(min_length=1)] | None, AfterValidator(_refuse_repeats)
    ] = None
    """Blocks of the atlas. Each block varies one quantity. The default is all blocks."""


class Claims(_Grid):
    """Test of the paper's statements: `snakemake claims` makes claims.nc and its figures."""

    tolerance: Tolerance = 5e-4
    """Largest accepted absolute error of mu_macro."""
    velocity: PositiveAxis = _raw([1e-4, 1e-3, 0.005, 0.02, 0.1, 0.3, 1, 3])
    """Forward velocities of both motions, above 0. The smallest velocity of the paper, 0.005, is
    added if a statement needs it."""
    amplitude_transverse: PositiveAxis = _raw([0.25, 0.5, 0.75, 1, 2, 3])
    """Amplitudes of the oscillation y0/u_lim, above 0. At least one must not exceed 1."""
    amplitude_bore: PositiveAxis = _raw([0.5, 1, 2, 3, 5, 10])
    """Amplitudes of the rotation phi0/phi_lk(a/2), above 0. At least one must not exceed 5."""
    cells: Annotated[int, Field(ge=8, le=64, multiple_of=2), WHOLE] = 32
    """Number of rings, and number of angular points on half the disc, in the runs whose tractions
    are evaluated. It must be even. A run with half this number gives the error estimate."""

    @model_validator(mode="after")
    def _refuse_mismatch(self) -> Self:
        for motion, values in self.amplitude.items():
            largest = STATIC_AMPLITUDES[motion]
            if values[0] > largest:
                allowed = f"at least one number up to {largest:g}, where there is static friction"
                message = f"{list(values)} is not allowed; allowed: {allowed}"
                raise Refusal(message, f"amplitude_{motion}")
        return self


class Root(Settings):
    """Points to compute, accuracy of the points, and folder of results. All quantities are
    dimensionless."""

    results: Annotated[
        str,
        Field(
            pattern=FOLDER,
            title="text for a folder, without braces, *, ?, line breaks, ~ in front, $NAME and ://",
        ),
    ] = "results"
    """Folder for all results, relative to the working directory of the workflow."""
    points_per_job: Points = 50
    """Mean number of points that one job computes in sequence. A job takes about a second to start.
    Large jobs leave cores idle at the end. A sweep can have its own value."""
    sweeps: Annotated[Sweeps, Field(min_length=1)]
    """Sweeps of the paper. At least one is required."""
    extended: dict[PlainName, ExtendedSweep] = {}
    """Sweeps of other motions and pressures, by name. `snakemake extended` makes a dataset for each
    sweep and a figure for each group."""
    drives: dict[PlainName, DriveSweep] = {}
    """Sweeps of contacts driven by a force or a spring, by name (see `snakemake drives`)."""
    histories: Histories = _raw({})
    """Single runs for Figures 1, 3 and 5."""
    accuracy: Accuracy = _raw({})
    """Study of the cost of accuracy (see `snakemake accuracy`)."""
    stability: Stability = _raw({})
    """Study of method failures (see `snakemake stability`)."""
    claims: Claims = _raw({})
    """Test of the paper's statements (see `snakemake claims`)."""
