"""Which cells a point begins with: a table of policies, each with its reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from microslip.adaptive.chains import EXTRAPOLATED_SHARES, JUDGED, Axis
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.static_limit import at_turning_points
from microslip.solver.stick_edge import SLOW_LOOP, found_focus

RINGS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
SQUARES = (8, 16, 32, 64, 128)
SLOW_SQUARES = (12, 24, 48, 96, 192)
STATIC_SQUARES = (16, 24, 32, 48, 64, 96, 128, 192)
"""Levels: rings, or squares along a side."""
SLOW_CREEP = 3e-3
"""Creep in a radian (u_lim) below which the layer at the stick radius is thin: the coarsest rings
agree with each other there before they see it, and prove nothing."""
EDGE_CAUTION = 1.25
"""Error over the spread of four runs that gather their rings at a stick radius which a coarse run
found, to the width of a ring."""
LOOP_CAUTION = 1.6
"""Likewise of slow loops: with EDGE_CAUTION a claim under a steep edge was missed by 1.1 times."""
ROUNDED = 1e-9
"""Difference of two torques below which they are one number."""
PROJECTED_SHARES = 0.35, 0.45
"""See chains.Axis; of translations to and fro, whose rings fall into line soon."""


def levels_finer(tighter: float) -> int:
    """Levels by which a point begins finer at a tolerance so many times tighter."""
    return max(round(2.0 * np.log10(tighter)), 0)


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
    regular, caution, shares, judged
        See chains.Axis.
    regular_below : float
        Tolerance below which the error is taken to fall smoothly in any case: enough rings are run
        there that they do not agree by chance.
    made_for : float or None
        Tolerance that all of them are for, which are finer where it is; None: whatever it is.
    """

    reason: str
    applies: Callable[[Problem, str], bool]
    base: int
    first: tuple[int, int]
    levels: tuple[int, ...] = RINGS
    regular: bool = True
    caution: float = 1.0
    shares: tuple[float, float] = EXTRAPOLATED_SHARES
    judged: int = 0
    regular_below: float = 0.0
    made_for: float | None = None

    def axis(self, tolerance: float) -> Axis:
        """The Axis to refine."""
        finer = 0 if self.made_for is None else levels_finer(self.made_for / tolerance)
        coarsest, finest = (self.levels.index(cells) + finer for cells in self.first)
        return Axis(
            "cells",
            self.levels,
            base=self.levels.index(self.base) + finer,
            first=tuple(range(coarsest, finest + 1)),
            regular=self.regular or tolerance < self.regular_below,
            caution=self.caution,
            shares=self.shares,
            judged=self.judged,
        )


def _is_slow(problem):
    """Whether the layer at the stick radius is thin."""
    return problem.motion.periodic and 0.0 < problem.drift < SLOW_CREEP


def is_loop(problem: Problem, model: str) -> bool:
    """Whether rings are marched through a translation whose halves are not lateral mirror images,
    or that never comes to rest."""
    motion = problem.motion
    if model != "radial" or motion.loads or problem.parts:
        return False
    back = problem.straight and problem.half_period_mirror
    return motion.periodic and problem.velocity > 0.0 and not back


def _is_slow_loop(problem, model):
    """Whether it is so slow that rings gather at an edge of what sticks."""
    return is_loop(problem, model) and problem.drift < SLOW_LOOP


def like_a_sphere(problem: Problem) -> bool:
    """Whether the load is as far from the centre, in the mean, as that of a sphere."""
    return abs(problem.pressure.torque - HERTZ.torque) < ROUNDED


def _is_static(problem):
    return problem.motion.periodic and problem.velocity == 0.0


CELLS_POLICIES = (
    CellsPolicy(
        "static limit on a loop: cells come and go at the edge, and a period is marched",
        lambda problem, model: (
            model == "cartesian" and _is_static(problem) and not at_turning_points(problem)
        ),
        base=24,
        first=(16, 48),
        levels=STATIC_SQUARES,
        regular=False,
        judged=JUDGED,
    ),
    CellsPolicy(
        "static limit: cells come and go at the edge; nothing is marched, so more are cheap",
        lambda problem, model: model == "cartesian" and problem.velocity == 0.0,
        base=32,
        first=(16, 64),
        levels=STATIC_SQUARES,
        regular=False,
        judged=JUDGED,
    ),
    CellsPolicy(
        "squares, slow: the layer at the stick radius is thin",
        lambda problem, model: model == "cartesian" and _is_slow(problem),
        base=24,
        first=(12, 48),
        levels=SLOW_SQUARES,
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
        "static limit on a loop: rings gather at an edge of what sticks that a coarse run found",
        lambda problem, model: _is_static(problem) and not at_turning_points(problem),
        base=24,
        first=(16, 48),
        regular=False,
        judged=JUDGED,
        caution=EDGE_CAUTION,
    ),
    CellsPolicy(
        "static limit: a stick zone that is not circular cuts rings, and the corners are steep",
        lambda problem, model: _is_static(problem),
        base=16,
        first=(8, 48),
        regular=False,
        judged=JUDGED,
    ),
    CellsPolicy(
        "slow rotation under another pressure: rings gather where slip starts, and see a trend",
        lambda problem, model: problem.motion.rotates and found_focus(problem, model) is not None,
        base=8,
        first=(8, 16),
        made_for=1e-3,
    ),
    CellsPolicy(
        "rotation under another pressure: its peak falls between rings, and no trend is safe",
        lambda problem, model: problem.motion.rotates and not like_a_sphere(problem),
        base=8,
        first=(8, 16),
        regular=False,
        made_for=1e-3,
    ),
    CellsPolicy(
        "rotation: with angles there are many unknowns, so as few rings as will do",
        lambda problem, model: problem.motion.rotates,
        base=6,
        first=(6, 12),
        made_for=1e-3,
    ),
    CellsPolicy(
        "translation to and fro at nu > 0, slow: the layer at the stick radius is thin",
        lambda problem, model: (
            problem.poisson > 0.0 and problem.half_period_mirror and _is_slow(problem)
        ),
        base=8,
        first=(8, 16),
        made_for=1e-3,
    ),
    CellsPolicy(
        "translation to and fro at nu > 0: the front of slip is oval, which rings are not",
        lambda problem, model: problem.poisson > 0.0 and problem.half_period_mirror,
        base=8,
        first=(8, 16),
        shares=PROJECTED_SHARES,
        made_for=1e-3,
    ),
    CellsPolicy(
        "slow loop: rings come to lie on an edge that a coarse run found, and few agree by chance",
        _is_slow_loop,
        base=12,
        first=(12, 24),
        regular=False,
        regular_below=3e-3,
        judged=JUDGED,
        caution=LOOP_CAUTION,
    ),
    CellsPolicy(
        "translation on a loop at nu > 0",
        lambda problem, model: problem.poisson > 0.0,
        base=12,
        first=(8, 16),
    ),
    CellsPolicy(
        "translation at nu = 0: few unknowns, so enough of them that no two runs agree by chance",
        lambda problem, model: model == "radial" and problem.half_period_mirror,
        base=8,
        first=(6, 12),
        made_for=1e-2,
    ),
    CellsPolicy(
        "contacts that turn work against each other on one body: few rings scatter as the steps do",
        lambda problem, model: bool(problem.parts),
        base=16,
        first=(12, 24),
    ),
    CellsPolicy(
        "all else: springs of a slider, translation on a loop at nu = 0",
        lambda problem, model: True,
        base=8,
        first=(6, 12),
    ),
)
"""The first that applies is taken."""


def cells_axis(problem: Problem, model: str, tolerance: float) -> Axis:
    """The chains.Axis of cells of a problem.Problem under a model, for a tolerance."""
    policy = next(policy for policy in CELLS_POLICIES if policy.applies(problem, model))
    return policy.axis(tolerance)
