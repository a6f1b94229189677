"""Records of a checked configuration: sweeps, studies and single runs.

`config` makes them from a file. Imports nothing heavy, since the workflow reads it whenever it is
parsed.
"""

from dataclasses import asdict, dataclass, field
from typing import Any

# Sweeps are named like their datasets, motions as on the command line.
MOTION_OF_SWEEP = {"transverse": "transverse", "bore": "bore", "continuous_bore": "continuous-bore"}

# The single runs, for figures, that a dataset carries besides its sweep.
HISTORIES_OF_SWEEP = {
    "transverse": ("transverse",),
    "bore": (),
    "continuous_bore": ("field", "transients"),
}
# Names that no other sweep may have: of datasets, and of folders of batches.
TAKEN = (*MOTION_OF_SWEEP, "accuracy", "accuracy_cost", "stability", "claims", "propulsion")
TAKEN += tuple(f"{name}_histories" for name in MOTION_OF_SWEEP)
TAKEN += tuple(f"{name}_periods" for name in MOTION_OF_SWEEP)
TAKEN += tuple(f"{study}_first" for study in ("accuracy", "stability", "claims", "propulsion"))
TAKEN += tuple(f"certified_{name}" for name in MOTION_OF_SWEEP)
# What models.registry refuses, which takes too long to import here; a test keeps them the same.
MODELS_OF_MOTION = {
    "transverse": ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"),
    "bore": ("auto", "rigid", "polar", "cartesian"),
    "continuous-bore": ("auto", "rigid", "polar", "cartesian"),
    "longitudinal": ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"),
    "zigzag": ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian"),
}


LOOSEST_POINTS = 1e-2
"""Largest tolerance of the points of a map. The refinement takes larger errors for curvature of the
map and halves cells without need."""
STATIC_AMPLITUDES = {"transverse": 1.0, "bore": 5.0}
"""Amplitudes up to which the maps of the paper show static friction, by motion."""


class ConfigError(ValueError):
    """A configuration that cannot be used. The message is one line: file, key, value, allowed."""


class Refusal(ValueError):
    """A value that is not allowed, in one line.

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
    """A grid of points. The axes are ascending tuples of floats, all dimensionless."""

    name: str
    motion: str  # with numbers as they were given; extended.solver_names writes equal ones alike
    velocity: tuple
    amplitude: tuple | None  # None: the motion has no amplitude
    poisson: tuple
    poisson_is_axis: bool  # a list was given, so the dataset gets a dimension of this name
    model: str
    tolerance: float | None  # None: the resolution is imposed, and its error only told
    cells: int | None
    steps: int | None
    pressure: str = "hertz"  # as for motion
    group: str | None = None  # of the figure that shows it, None for the paper's
    title: str | None = None  # there
    drives: tuple = ()  # (name, values, whether they are an axis) of what pulls, as for solve()
    contacts: str | None = None  # of a body that several carry, as it was given

    @property
    def spans_a_map(self) -> bool:
        """Whether there is an area to draw: two amplitudes and two velocities above 0 at least."""
        positive = [velocity for velocity in self.velocity if velocity > 0]
        return len(self.amplitude or ()) > 1 and len(positive) > 1

    @property
    def drawn_over(self) -> str:
        """Abscissa of friction in the figure of a group."""
        if self.spans_a_map:
            return "velocity and amplitude"
        return "amplitude" if len(self.amplitude or ()) > 1 else "velocity"


@dataclass(frozen=True)
class CertifiedMap:
    """A map whose points are chosen so that an error holds everywhere. All is dimensionless."""

    name: str
    sweep: Sweep  # whose ranges and settings it has; its axes and tolerance do not count
    error: float
    tolerance: float  # of the points

    @property
    def velocity(self) -> tuple[float, ...]:
        """The smallest velocity above 0, and the largest; () for a map of the static limit."""
        positive = [velocity for velocity in self.sweep.velocity if velocity > 0]
        return (positive[0], positive[-1]) if self.sweep.spans_a_map else ()

    @property
    def amplitude(self) -> tuple[float, float]:
        """The smallest and the largest amplitude."""
        amplitudes = self.sweep.amplitude or ()
        return amplitudes[0], amplitudes[-1]

    @property
    def poisson(self) -> tuple[float, ...]:
        """The smallest and the largest Poisson's ratio; () for a map of one."""
        ratios = self.sweep.poisson
        return (ratios[0], ratios[-1]) if len(ratios) > 1 else ()

    @property
    def force(self) -> float | None:
        """The largest force of a map of the velocity that one gives; None: it is of friction."""
        pulls = {name: values for name, values, _ in self.sweep.drives}
        return pulls["force"][-1] if "force" in pulls else None

    @property
    def settings(self) -> dict:
        """All that its points depend on, as a dict for JSON."""
        kept = ("motion", "pressure", "model")
        found = {name: getattr(self.sweep, name) for name in kept}
        found["poisson"] = self.poisson or self.sweep.poisson
        ranges: dict = {"velocity": self.velocity, "amplitude": self.amplitude}
        if self.force is not None:
            ranges["force"] = self.force
        return found | ranges | {"error": self.error, "tolerance": self.tolerance}


@dataclass(frozen=True)
class Configuration:
    """A checked configuration with its defaults filled in and its axes expanded."""

    results: str
    sweeps: dict  # name -> Sweep, in the order of MOTION_OF_SWEEP
    extended: dict  # name -> Sweep, of other motions and pressures
    drives: dict  # name -> Sweep, of contacts that are pulled
    points_per_job: dict  # name of a sweep -> int; no dataset depends on it
    histories: dict  # transverse, field, transients -> dict of settings
    accuracy: Any  # settings.Accuracy, and so on
    stability: Any
    claims: Any
    propulsion: Any
    certified: dict = field(default_factory=dict)  # name -> CertifiedMap

    @property
    def grids(self) -> dict[str, Sweep]:
        """All sweeps by name, the paper's first."""
        return self.sweeps | self.extended | self.drives

    @property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """Names of the sweeps in `extended` by group, a dict of tuples."""
        groups = dict.fromkeys(sweep.group for sweep in self.extended.values())
        return {
            group: tuple(s.name for s in self.extended.values() if s.group == group)
            for group in groups
        }

    def of_sweep(self, name: str) -> dict:
        """All settings that the dataset of the sweep `name` depends on, as a dict for JSON."""
        names = HISTORIES_OF_SWEEP.get(name, ())
        sweep = asdict(self.grids[name])
        if not sweep["drives"]:  # which goes without saying, as it did before there were any
            del sweep["drives"]
        if sweep["contacts"] is None:
            del sweep["contacts"]
        return {
            "sweep": sweep,
            "histories": {history: self.histories[history] for history in names},
        }
