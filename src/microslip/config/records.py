"""Records of a checked configuration: sweeps, certified maps, studies and single runs.

The module imports nothing slow, since every parse of the workflow imports it.
"""

from dataclasses import asdict, dataclass, field
from typing import Any

MOTION_OF_SWEEP = {"transverse": "transverse", "bore": "bore", "continuous_bore": "continuous-bore"}
"""Motion of the paper for each sweep, named as on the command line.  The dataset has the same name
as the sweep."""
HISTORIES_OF_SWEEP = {
    "transverse": ("transverse",),
    "bore": (),
    "continuous_bore": ("field", "transients"),
}
"""Single runs for figures in a sweep's dataset, keyed by the name of the sweep."""
CERTIFIED = "certified_"
"""Prefix of the names of certified maps.  The figure of a map has the same name as its dataset."""
RESERVED = (*MOTION_OF_SWEEP, "accuracy", "accuracy_cost", "stability", "claims")
RESERVED += tuple(f"{name}_histories" for name in MOTION_OF_SWEEP)
RESERVED += tuple(f"{name}_periods" for name in MOTION_OF_SWEEP)
RESERVED += tuple(f"{CERTIFIED}{name}" for name in MOTION_OF_SWEEP)
"""Names of datasets and batch folders.  Other sweeps must not have these names."""
MODELS_OF_MOTION = {
    "transverse": ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"),
    "bore": ("auto", "rigid", "polar", "cartesian"),
    "continuous-bore": ("auto", "rigid", "polar", "cartesian"),
    "longitudinal": ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"),
    "zigzag": ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"),
}
"""Models that apply to each motion.  The table is copied from models.registry, because that module
is slow to import."""
LOOSEST_POINTS = 1e-2
"""Largest tolerance of the points in a certified map.  The refinement would mistake larger errors
for curvature, and halve cells without need."""
STATIC_AMPLITUDES = {"transverse": 1.0, "bore": 5.0}
"""Largest amplitude with static friction in the maps of the paper, for each motion."""


class ConfigError(ValueError):
    """Error for an invalid configuration.  The message is one line with the file, the key, the
    value and the allowed values."""

    def __init__(self, message: object):
        super().__init__(" ".join(str(message).split()))


class Refusal(ValueError):
    """Error for a value that is not allowed.  The message is one line.

    Attributes
    ----------
    key : str
        Key of the value, relative to the settings that are checked.
    """

    def __init__(self, message: str, key: str = ""):
        super().__init__(message)
        self.key = key


@dataclass(frozen=True)
class Sweep:
    """A grid of points.  Its axes are ascending tuples of dimensionless floats."""

    name: str
    motion: str  # as in the configuration; extended.solver_names returns the canonical name
    velocity: tuple
    amplitude: tuple | None  # None: the motion has no amplitude
    poisson: tuple
    poisson_is_axis: bool  # True: Poisson's ratio is a dimension of the dataset
    model: str
    tolerance: float | None  # None: the resolution is imposed
    cells: int | None
    steps: int | None
    pressure: str = "hertz"  # as in the configuration
    group: str | None = None  # figure that shows the sweep; None for sweeps of the paper
    title: str | None = None  # title on that figure
    drives: tuple = ()  # (argument of solve(), values, True for a dimension of the dataset)

    @property
    def spans_a_map(self) -> bool:
        """True if the sweep can be drawn as a map, because it has at least two amplitudes and two
        positive velocities."""
        positive = [velocity for velocity in self.velocity if velocity > 0]
        return len(self.amplitude or ()) > 1 and len(positive) > 1

    @property
    def drawn_over(self) -> str:
        """Quantity on the horizontal axis in a group's figure."""
        if self.spans_a_map:
            return "velocity and amplitude"
        return "amplitude" if len(self.amplitude or ()) > 1 else "velocity"


@dataclass(frozen=True)
class CertifiedMap:
    """A map whose points are chosen so that its error is bounded everywhere.  All values are
    dimensionless."""

    name: str
    sweep: Sweep  # with the ranges and settings of the map
    error: float
    tolerance: float  # largest error of the points

    @property
    def velocity(self) -> tuple[float, ...]:
        """The smallest positive velocity and the largest velocity; () for a map of the static
        limit."""
        positive = [velocity for velocity in self.sweep.velocity if velocity > 0]
        return (positive[0], positive[-1]) if self.sweep.spans_a_map else ()

    @property
    def amplitude(self) -> tuple[float, float]:
        """The smallest and the largest amplitude."""
        amplitudes = self.sweep.amplitude or ()
        return amplitudes[0], amplitudes[-1]

    @property
    def poisson(self) -> tuple[float, ...]:
        """The smallest and the largest Poisson's ratio; () if there is only one value."""
        ratios = self.sweep.poisson
        return (ratios[0], ratios[-1]) if len(ratios) > 1 else ()

    @property
    def settings(self) -> dict:
        """Settings on which the points depend, as a dict of JSON values."""
        names = ("motion", "pressure", "model")
        settings = {name: getattr(self.sweep, name) for name in names}
        settings["poisson"] = self.poisson or self.sweep.poisson
        ranges: dict = {"velocity": self.velocity, "amplitude": self.amplitude}
        return settings | ranges | {"error": self.error, "tolerance": self.tolerance}


@dataclass(frozen=True)
class Configuration:
    """A checked configuration, with all defaults filled in and all axes expanded."""

    results: str
    sweeps: dict  # name -> Sweep, in the order of MOTION_OF_SWEEP
    extended: dict  # name -> Sweep, of other motions and pressures
    drives: dict  # name -> Sweep, of contacts under a force or a spring
    points_per_job: dict  # name of a sweep -> int; datasets do not depend on it
    histories: dict  # transverse, field, transients -> dict of settings
    accuracy: Any  # settings.Accuracy, and so on
    stability: Any
    claims: Any
    certified: dict = field(default_factory=dict)  # name -> CertifiedMap

    @property
    def grids(self) -> dict[str, Sweep]:
        """All sweeps by name.  Sweeps of the paper come first."""
        return self.sweeps | self.extended | self.drives

    @property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """Names of the sweeps in `extended`, as a dict of tuples by group."""
        groups = dict.fromkeys(sweep.group for sweep in self.extended.values())
        return {
            group: tuple(s.name for s in self.extended.values() if s.group == group)
            for group in groups
        }

    def of_sweep(self, name: str) -> dict:
        """Settings on which the dataset of a sweep depends, as a dict of JSON values."""
        names = HISTORIES_OF_SWEEP.get(name, ())
        sweep = asdict(self.grids[name])
        if not sweep["drives"]:  # older datasets have no drives
            del sweep["drives"]
        return {
            "sweep": sweep,
            "histories": {history: self.histories[history] for history in names},
        }
