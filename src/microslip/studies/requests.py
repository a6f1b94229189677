"""Requests of the studies, and the models and resolutions at which methods are compared.

A request is a dict whose numbers are canonical strings (see sweeps.request).  All studies share the
following kinds of requests:

- trial: a timed run at a point, with a model, a method and a resolution;
- choice: a timed solve at a tolerance, with automatic selection of the model and resolution;
- probe: an untimed solve with a given method;
- point: a solve at a tolerance, which also serves as the reference for other requests.

A timed request contains the name of the CPU.  Times measured on different CPUs therefore have
different keys and are never drawn in the same chart.

Cells, angles and steps are refined together, so that the errors due to each of them decrease
together.  The file of a method can prescribe the model and the resolution of the method.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple, Union

from microslip.foundation.machine import cpu_model
from microslip.periodic.methods import SHIPPED, declared, missing, split
from microslip.sweeps.request import request_of

if TYPE_CHECKING:
    from microslip.config.settings import StudyPoint

RINGS_TOLERANCE, TOLERANCE = 1e-6, 3e-5
"""Tolerances of references computed with rings and with angular points.  Rings are cheap, so the
tolerance for rings is tighter."""
ROTATIONS = ("bore", "continuous-bore")
"""Motions with a rotation.  Only a few models apply to such motions."""
OF_ROTATIONS = ("rigid", "polar", "cartesian")
"""Models that apply to rotations.  The names are copied from contact.registry, because that module
is slow to import."""


class Point(NamedTuple):
    """A motion with its dimensionless parameters.  The amplitude of a steady motion is None."""

    motion: str
    velocity: float
    amplitude: float | None = None
    poisson: float = 0.0


AnyPoint = Union[Point, "StudyPoint"]
"""Type of points: a point of a study, or a point of the configuration."""


class Level(NamedTuple):
    """Resolution of a run: cells (rings, or squares along a side), angles on half the disc, and
    time steps in a period."""

    cells: int
    angles: int
    steps: int


def _doubled(cells: int, angles: int, steps: int, count: int) -> tuple[Level, ...]:
    """Return `count` levels.  Each number doubles from level to level, except that 1 stays 1."""
    return tuple(
        Level(*(1 if n == 1 else n * 2**k for n in (cells, angles, steps))) for k in range(count)
    )


LADDERS = {
    "rigid": _doubled(4, 4, 16, 6),
    "slider": _doubled(1, 1, 16, 6),
    "dahl": _doubled(1, 1, 16, 6),
    "mdr": _doubled(4, 1, 16, 6),
    "radial": _doubled(4, 1, 16, 6),
    "polar": tuple(
        Level(n, n, steps)
        for n, steps in ((4, 16), (6, 24), (8, 32), (12, 48), (16, 64), (24, 128))
    ),
    "cartesian": _doubled(8, 1, 16, 4),
}
"""Levels of each model, from coarse to fine.  The model with squares has few levels, because it is
by far the most expensive."""
OF_OTHER_METHODS = {"radial": 5, "polar": 4, "cartesian": 3}
"""Number of levels of each model for methods other than the shipped one.  These methods can be slow
or use dense matrices."""
COARSEST_TOLERANCE, TOLERANCE_POWER = 3e-5, 1.5
"""Tolerance of the periodic state at the first level, as a force divided by mu F_z.  At other
levels, the tolerance is proportional to 1 / steps^TOLERANCE_POWER.  At every level, the tolerance
is below the discretisation error.  For rings at nu = 0, this error is 1e-4 to 1e-6."""


# Models and resolutions


def models_of(motion: str, poisson: float) -> list[str]:
    """Return the names of the models that apply to a motion and a Poisson's ratio, coarsest
    first."""
    names = OF_ROTATIONS if motion in ROTATIONS else tuple(LADDERS)
    return [name for name in names if name != "radial" or poisson == 0]


def exact_model(motion: str, poisson: float) -> str:
    """Return the model that `model="auto"` selects: rings if they apply, and angular points
    otherwise."""
    return "radial" if "radial" in models_of(motion, poisson) else "polar"


def models_for(method: str, motion: str, poisson: float) -> list[str]:
    """Return the names of the models with which a method is run.

    The shipped method is run with all models.  Any other method is run with the model named in its
    file.  If the file names no model, the method is run with the model that `model="auto"` selects.
    The list is empty if the method does not support the motion, or if a package that the method
    requires is not installed.
    """
    name, _ = split(method)
    if name == SHIPPED:
        return models_of(motion, poisson)
    if missing(method) or (motion in ROTATIONS and declared(name, "turns") is False):
        return []
    return [declared(name, "model") or exact_model(motion, poisson)]


def ladder(model: str, method: str, count: int) -> list[tuple[int, Level, float]]:
    """Return a list of tuples (level number, Level, tolerance) for a method.  `count` is the
    largest allowed length of the list."""
    name, _ = split(method)
    if (own := declared(name, "resolution")) is not None:
        return [(0, Level(*own), COARSEST_TOLERANCE)]
    levels = LADDERS[model][:count]
    if name != SHIPPED:
        levels = levels[: OF_OTHER_METHODS.get(model, 0)]
    return [
        (k, level, COARSEST_TOLERANCE * (levels[0].steps / level.steps) ** TOLERANCE_POWER)
        for k, level in enumerate(levels)
    ]


# Requests


def of(kind: str, point: AnyPoint, **arguments: Any) -> dict:
    """Return the request of the given kind at a point.  A timed request contains the name of the
    CPU."""
    place = {name: getattr(point, name) for name in Point._fields}
    timed = {"cpu": cpu_model()} if kind in ("trial", "choice") else {}
    return request_of(kind, **place, **timed, **arguments)


def solve(point: AnyPoint, tolerance: float, model: str = "auto", cells: int | None = None) -> dict:
    """Return the request for a solve at a point. The request equals the request of a sweep for this
    point.

    cells: imposed number of rings or squares.  If None, the number follows from the tolerance.
    """
    return of("point", point, model=model, tolerance=tolerance, cells=cells, steps=None)


def reference(point: AnyPoint) -> dict:
    """Return the request that computes the reference solution at a point, with a tight
    tolerance."""
    rings = exact_model(point.motion, point.poisson) == "radial"
    return solve(point, RINGS_TOLERANCE if rings else TOLERANCE)


def trials(
    point: AnyPoint, methods: Iterable[str], levels: int, repeats: int
) -> Iterator[tuple[int, dict]]:
    """Yield (level number, request) for each timed run.  Every method is run with all models and
    levels that apply to it.

    The number of steps of a steady motion is None.
    """
    for method in methods:
        for model in models_for(method, point.motion, point.poisson):
            for k, level, tolerance in ladder(model, method, levels):
                sizes = level._asdict() | ({"steps": None} if point.amplitude is None else {})
                how = {"model": model, "method": method, "tolerance": tolerance} | sizes
                yield k, of("trial", point, repeats=repeats, **how)
