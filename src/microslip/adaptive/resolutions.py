"""Which resolutions to run: levels of cells, angles and steps, and where refinement begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from microslip.adaptive.chains import EXTRAPOLATED_SHARES, Axis
from microslip.models.registry import MODELS
from microslip.solver.problem import Problem, Resolution
from microslip.solver.static_limit import at_turning_points

RINGS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
SQUARES = (8, 16, 32, 64, 128)
STATIC_SQUARES = (16, 24, 32, 48, 64, 96, 128, 192)
ANGLES = (2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96)
STEPS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768)
"""Levels: rings (squares along a side), angles on half the disc, steps in half a period."""
BASE_RINGS, BASE_ANGLES, BASE_STEPS = 8, 6, 16
SLOW_CREEP = 3e-3
"""Creep in a radian (u_lim) below which the layer at the stick radius is thin: the coarsest rings
agree with each other there before they see it, and prove nothing."""
TURNING_CAUTION = 2.0
"""Error in time over the spread of the runs where the contact turns or slides back: the first step
after a turning point, in which all points stick and slip again, errs to one side whatever its
length."""
PROJECTED_CAUTION = {"angles": 1.3, "steps": 1.8}
PROJECTED_SHARES, PROJECTED_SCATTER = (0.35, 0.45), 0.3
"""See chains.Axis: where errors over angles and steps are projected, those of cells are bounded
more closely, too."""
SWEEPING_STEPS = 4
"""Steps in half a period over rings where the edge of the contact sweeps over these.  They join it
one by one, and the error scatters unless both are refined together."""
SWEEPING_CAUTION = 1.5
EDGE_CAUTION = 1.25
"""Error over the spread of four runs where each gathers its rings at a stick radius that it finds
by itself, to the width of a ring."""
LONGEST_STROKE = 16.0
"""Stroke in u_lim beyond which more steps are left to the estimate of the error."""


def plan(
    problem: Problem,
    model: str,
    tolerance: float,
    cells: int | None = None,
    steps: int | None = None,
) -> tuple[Resolution, tuple[Axis, ...]]:
    """Resolution of what is not refined, and the axes to refine (see refinement.certify).

    Parameters
    ----------
    problem : problem.Problem
        As checked by the caller.
    model : str
        Name in models.registry.MODELS.
    tolerance : float
        Absolute, on the friction.
    cells, steps : int or None
        Impose a resolution instead; steps in a full period.
    """
    motion = problem.motion
    resolved, axes = MODELS[model].axes(motion), []
    marches = motion.periodic and (problem.velocity > 0.0 or not at_turning_points(motion))
    sweeps = motion.depth is not None and marches and cells is None and steps is None
    if sweeps:
        axes.append(_sweeping(problem, tolerance))
    elif "cells" in resolved:
        axes.append(
            _cells(problem, model, tolerance) if cells is None else _imposed("cells", cells)
        )
    if "angles" in resolved:
        # only nu > 0 makes tractions of a translation depend on the angle, and only a little
        axes.append(_angles(problem, tolerance))
    if marches and not sweeps:
        axes.append(_steps(problem, tolerance) if steps is None else _imposed("steps", steps // 2))
    return Resolution(cells=1, angles=1, steps=STEPS[0]), tuple(axes)


@dataclass(frozen=True)
class CellsPolicy:
    """Which cells a point begins with.

    Attributes
    ----------
    reason : str
        Why with these.
    applies : callable
        applies(problem, model) -> whether the policy is for such a point.
    base : int
        Cells at which the angles and the steps are refined.
    first : tuple of int
        Cells of the coarsest and of the finest of the runs to start with.
    levels : tuple of int
        Cells there may be.
    regular, caution, shares
        See chains.Axis.
    follows : bool
        Whether all of them are finer where the tolerance is.
    """

    reason: str
    applies: Callable[[Problem, str], bool]
    base: int
    first: tuple[int, int]
    levels: tuple[int, ...] = RINGS
    regular: bool = True
    caution: float = 1.0
    shares: tuple[float, float] = EXTRAPOLATED_SHARES
    follows: bool = False

    def axis(self, tolerance: float) -> Axis:
        """The Axis to refine."""
        finer = _levels_finer(tolerance) if self.follows else 0
        coarsest, finest = (self.levels.index(cells) + finer for cells in self.first)
        return Axis(
            "cells",
            self.levels,
            base=self.levels.index(self.base) + finer,
            first=tuple(range(coarsest, finest + 1)),
            regular=self.regular,
            caution=self.caution,
            shares=self.shares,
        )


def _is_slow(problem):
    """Whether the layer at the stick radius is thin."""
    return problem.motion.periodic and 0.0 < problem.creep < SLOW_CREEP


def _is_static(problem):
    return problem.motion.periodic and problem.velocity == 0.0


CELLS_POLICIES = (
    CellsPolicy(
        "static limit: cells come and go at the edge; nothing is marched, so more are cheap",
        lambda problem, model: model == "cartesian" and problem.velocity == 0.0,
        base=32,
        first=(16, 64),
        levels=STATIC_SQUARES,
        regular=False,
    ),
    CellsPolicy(
        "squares, slow: the layer at the stick radius is thin",
        lambda problem, model: model == "cartesian" and _is_slow(problem),
        base=32,
        first=(16, 64),
        levels=SQUARES,
    ),
    CellsPolicy(
        "squares: doubled from run to run, since cells come and go at the edge",
        lambda problem, model: model == "cartesian",
        base=16,
        first=(8, 32),
        levels=SQUARES,
    ),
    CellsPolicy(
        "springs know nothing of each other, and slip one by one",
        lambda problem, model: model == "mdr",
        base=16,
        first=(12, 24),
        regular=False,
    ),
    CellsPolicy(
        "steady: the centre of rotation stays where it is, and only fine rings see it",
        lambda problem, model: not problem.motion.periodic,
        base=12,
        first=(8, 16),
    ),
    CellsPolicy(
        "static limit on a loop: each run finds the edge of what sticks by itself",
        lambda problem, model: _is_static(problem) and not at_turning_points(problem.motion),
        base=24,
        first=(16, 48),
        regular=False,
        caution=EDGE_CAUTION,
    ),
    CellsPolicy(
        "static limit: a stick zone that is not circular cuts rings, and the corners are steep",
        lambda problem, model: _is_static(problem),
        base=16,
        first=(8, 48),
        regular=False,
    ),
    CellsPolicy(
        "rotation: with angles there are many unknowns, so as few rings as will do",
        lambda problem, model: problem.motion.rotates,
        base=6,
        first=(6, 12),
        shares=PROJECTED_SHARES,
        follows=True,
    ),
    CellsPolicy(
        "translation to and fro at nu > 0: the front of slip is oval, which rings are not",
        lambda problem, model: problem.poisson > 0.0 and problem.motion.half_period_mirror,
        base=8,
        first=(8, 16),
        shares=PROJECTED_SHARES,
        follows=True,
    ),
    CellsPolicy(
        "translation on a loop at nu > 0",
        lambda problem, model: problem.poisson > 0.0,
        base=12,
        first=(8, 16),
    ),
    CellsPolicy(
        "translation at nu = 0: few unknowns",
        lambda problem, model: True,
        base=8,
        first=(6, 12),
    ),
)
"""The first that applies is taken."""


def _levels_finer(tolerance):
    """Levels of rings and angles by which a point begins finer than at 1e-3."""
    return max(round(2.0 * np.log10(1e-3 / tolerance)), 0)


def _cells(problem, model, tolerance):
    policy = next(policy for policy in CELLS_POLICIES if policy.applies(problem, model))
    return policy.axis(tolerance)


def _imposed(name, count):
    """An axis whose resolution is asked for; two coarser ones show what it is worth."""
    levels = (count // 2, round(0.75 * count), count)
    return Axis(name, levels, 2, (0, 1, 2), imposed=True)


def _sweeping(problem, tolerance):
    """Steps and rings together."""
    rings = RINGS[RINGS.index(BASE_RINGS) :]
    levels = _step_levels(problem, [SWEEPING_STEPS * count for count in rings])
    base = 1 if tolerance >= 5e-3 else 2
    first = tuple(range(base - 1, base + 3))
    return Axis("steps", levels, base, first, caution=SWEEPING_CAUTION, tied=("cells", rings))


def _step_levels(problem, counts):
    """Even numbers of steps that stay short against u_lim where the stroke is long."""
    motion = problem.motion
    stroke = min(max(1.0, motion.stroke(problem.amplitude, problem.poisson)), LONGEST_STROKE)
    return tuple(2 * round(0.5 * count * motion.cycles * stroke**0.5) for count in counts)


class Coarsest(NamedTuple):
    """Angles and steps that a point begins with where errors over both are projected: the many
    unknowns make each run cost more, and what corrections lack that are found at so few is measured
    as their mixed difference."""

    angles: int
    steps: int


def _coarsest(problem):
    """The Coarsest of a problem, None where errors are the spread of runs."""
    motion = problem.motion
    if not motion.periodic or problem.velocity == 0.0:
        return None
    if motion.rotates:
        return Coarsest(angles=4, steps=12)
    if problem.poisson > 0.0 and motion.half_period_mirror:
        return Coarsest(angles=2, steps=16)  # tractions depend on the angle a little only
    return None


def _angles(problem, tolerance):
    motion, coarsest = problem.motion, _coarsest(problem)
    if coarsest is None:
        # only nu > 0 makes tractions of a translation depend on the angle, and only a little
        base = ANGLES.index(BASE_ANGLES) + (not motion.periodic) - (not motion.rotates)
        return Axis("angles", ANGLES, base, (base - 1, base, base + 1))
    base = ANGLES.index(coarsest.angles) + _levels_finer(tolerance)
    first, caution = (base, base + 1, base + 2), PROJECTED_CAUTION["angles"]
    return Axis("angles", ANGLES, base, first, projected=True, caution=caution)


def _steps(problem, tolerance):
    motion, levels, coarsest = problem.motion, _step_levels(problem, STEPS), _coarsest(problem)
    if coarsest is None:
        # second order in time
        wanted = BASE_STEPS * max(1.0, (1e-3 / tolerance) ** 0.5)
        base = next(k for k, count in enumerate(STEPS) if count >= wanted)
        caution = 1.0 if motion.half_period_mirror else TURNING_CAUTION
        return Axis("steps", levels, base, (base - 2, base - 1, base), caution=caution)
    base = STEPS.index(coarsest.steps) + _levels_finer(tolerance) // 2
    caution, scatter = PROJECTED_CAUTION["steps"], PROJECTED_SCATTER
    first = (base - 2, base - 1, base)
    return Axis("steps", levels, base, first, projected=True, caution=caution, scatter=scatter)
