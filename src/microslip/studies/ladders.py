"""Ladders: resolutions of each model, from coarse to fine, and the models of each motion.

Cells, angles and steps are refined together, so that their errors decrease together. A method's
file can prescribe the model and the resolution for that method.
"""

from typing import NamedTuple

from microslip.solver.method_names import SHIPPED, declared, missing, split

_TRANSLATED = ("auto", "rigid", "slider", "dahl", "mdr", "radial", "polar", "cartesian")
_ROTATED = ("auto", "rigid", "polar", "cartesian")
MODELS_OF_MOTION = {
    **dict.fromkeys(("transverse", "longitudinal", "zigzag"), _TRANSLATED),
    **dict.fromkeys(("bore", "continuous-bore"), _ROTATED),
}
"""Models that apply to each motion.  The table is copied from models.registry, because that module
is slow to import."""


class Level(NamedTuple):
    """Resolution of a run: cells (rings, or squares along a side), angles on half the disc, and
    time steps in a period."""

    cells: int
    angles: int
    steps: int


def _doubled(cells: int, angles: int, steps: int, count: int) -> tuple[Level, ...]:
    """Return `count` levels. Each number doubles from level to level, except that 1 stays 1."""
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
"""Levels of each model. Squares have few levels, because they are by far the most expensive."""

OF_OTHER_METHODS = {"radial": 5, "polar": 4, "cartesian": 3}
"""Number of levels per model, for all methods except the shipped method. The other methods can be
slow or use dense matrices."""

COARSEST_TOLERANCE, TOLERANCE_POWER = 3e-5, 1.5
"""Tolerance of the periodic state (force divided by mu F_z) at the first level. It is proportional
to 1 / steps^TOLERANCE_POWER. At every level, the tolerance is below the discretisation error (1e-4
to 1e-6 for rings at nu = 0)."""


TRANSLATIONS = ("transverse", "longitudinal", "zigzag")
"""Motions without rotation."""


def models_of(motion: str, poisson: float) -> list[str]:
    """Return the names of the models for a motion and a Poisson's ratio, coarsest first."""
    allowed = MODELS_OF_MOTION[motion]
    return [m for m in LADDERS if m in allowed and (m != "radial" or poisson == 0)]


def exact_model(motion: str, poisson: float) -> str:
    """Return the model that `model="auto"` selects: rings if they apply, else angular points."""
    return "radial" if "radial" in models_of(motion, poisson) else "polar"


def ladder(model: str, method: str, count: int) -> list:
    """Return at most `count` tuples (level number, Level, tolerance) for a method."""
    name, _ = split(method)
    own = declared(name, "resolution")
    if own is not None:
        return [(0, Level(*own), COARSEST_TOLERANCE)]
    levels = LADDERS[model][:count]
    if name != SHIPPED:
        levels = levels[: OF_OTHER_METHODS.get(model, 0)]
    first = levels[0].steps if levels else 1
    return [
        (k, level, COARSEST_TOLERANCE * (first / level.steps) ** TOLERANCE_POWER)
        for k, level in enumerate(levels)
    ]


def models_for(method: str, motion: str, poisson: float) -> list[str]:
    """Return the models with which a method is run.

    The shipped method is run with all models. Any other method is run with the model named in its
    file, or else with the model that `model="auto"` selects. The list is empty if the method does
    not support the motion, or if a package that the method requires is not installed.
    """
    name, _ = split(method)
    if name == SHIPPED:
        return models_of(motion, poisson)
    supported = motion in TRANSLATIONS or declared(name, "turns") is not False
    if missing(method) or not supported:
        return []
    return [declared(name, "model") or exact_model(motion, poisson)]
