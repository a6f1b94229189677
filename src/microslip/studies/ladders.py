"""Ladders: the resolutions in which every model is run, from coarse to fine.

Cells, angles and steps are refined jointly, so that no part of the discretisation holds up the
others.  A method may bring a model and a resolution of its own, which its file says.  Here is also
which model applies where, as plain data; a test keeps it the same as what the solver refuses.
"""

from typing import NamedTuple

from microslip.config.records import MODELS_OF_MOTION
from microslip.solver.method_names import SHIPPED, declared, missing, split


class Level(NamedTuple):
    """One rung: cells (rings, or squares along a side), angles on half the disc, steps a period."""

    cells: int
    angles: int
    steps: int


def _doubled(cells: int, angles: int, steps: int, count: int) -> tuple[Level, ...]:
    """Levels from the first one on; what is 1 stays 1, the rest doubles."""
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
"""Levels by model.  Squares cost the most by far, so theirs are few."""

OF_OTHER_METHODS = {"radial": 5, "polar": 4, "cartesian": 3}
"""Levels for methods that are not shipped: some keep dense matrices or solve point by point."""

COARSEST_TOLERANCE, TOLERANCE_POWER = 3e-5, 1.5
"""How near the periodic state a run has to come, a force over mu F_z: at the first level, and with
which power of the steps it falls. That is below what the discretisation leaves at every level
(rings at nu = 0: from 1e-4 to 1e-6), so that it takes part in no comparison."""


TRANSLATIONS = ("transverse", "longitudinal", "zigzag")
"""Motions without rotation."""


def models_of(motion: str, poisson: float) -> list[str]:
    """Names of the models that apply to a motion at a Poisson's ratio, from crude to costly."""
    rings_suffice = poisson == 0
    known = MODELS_OF_MOTION[motion]
    return [m for m in LADDERS if m in known and (m != "radial" or rings_suffice)]


def exact_model(motion: str, poisson: float) -> str:
    """The model that model auto takes: rings where they suffice, angular points otherwise."""
    return "radial" if "radial" in models_of(motion, poisson) else "polar"


def ladder(model: str, method: str, count: int) -> list:
    """List (number of the level, Level, tolerance) to run `method` in, at most `count` of them."""
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
    """Models that `method` is run on: all for the shipped one, else its own or what auto takes.

    None for a rotation that it does not know, or where it requires a package that is not installed.
    """
    name, _ = split(method)
    if name == SHIPPED:
        return models_of(motion, poisson)
    knows = motion in TRANSLATIONS or declared(name, "turns") is not False
    if missing(method) or not knows:
        return []
    return [declared(name, "model") or exact_model(motion, poisson)]
