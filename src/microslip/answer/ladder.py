"""Levels of resolution of a problem: cells, angles and time steps refined together.

Level n has n cells. The numbers of angles and of steps are proportional to n.  So the error has a
single leading term, C / n^2.  This term is estimated from runs at the levels n/4, n/2 and n.
LEVELS interleaves two series of doublings: 2, 4, 8, ... and 3, 6, 12, ....  The cost therefore
grows moderately from level to level. In addition, level n can reuse the runs at the levels n/2 and
n/4.

The first level depends on the tolerance and on the motion.  The mesh and the path also adapt to the
problem.  Rings are graded towards the slip front (discretise.focus_strength).  The number of time
steps increases with the square root of the stroke and with the natural frequency of a mass.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from microslip.contact.path import LONG_STROKE
from microslip.contact.registry import MODELS
from microslip.foundation.arguments import SMALLEST_TOLERANCE
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.static_limit import SLOW_LOOP
from microslip.scene.problem import Problem

ORDER = 2
"""Order of convergence in the numbers of rings, angles and time steps."""
RATIO = 2
"""Ratio of successive levels in an extrapolation.  Extrapolated errors decrease with about the
third power of the level.  Therefore, the first level is multiplied by this ratio whenever the
tolerance is divided by 10."""
LEVELS = tuple(sorted(base * RATIO**k for k in range(9) for base in (RATIO, 3)))
"""Levels 2, 3, 4, 6, 8, 12, ..., 512, 768."""
LOOSEST = 1e-2
"""Tolerance to which Ladder.start refers.  Larger tolerances use the same level."""
FEWEST = 4
"""Smallest number of angles and of steps."""
MOST_MASS_STEPS = 8192
"""Largest number of steps in half a period for a body with mass.  A run with 24 rings and this
number of steps takes a few seconds."""
FREQUENCY_ERROR = (3.0 * np.sqrt(2.0) - 4.0) / 6.0
"""Coefficient of the frequency error of the integrator path.SDIRK2.  For an undamped oscillation
and a step of s radians, the relative error of the frequency is this coefficient times s^2.  A step
multiplies the amplitude by R(i s).  Here R(z) is (1 + (1 - 2 g) z) / (1 - g z)^2.  The constant g
is 1 - sqrt(1/2).  R(z) differs from exp(z) by (3 g^2 - 2 g^3 - 1/6) z^3."""
COARSEST = Resolution(cells=8, angles=4, steps=4)
"""Resolution at which the stiffness of the contact is computed for a body with mass."""


@dataclass(frozen=True)
class Ladder:
    """Resolution of a problem at each level.

    Attributes
    ----------
    start : int
        First level at the tolerance LOOSEST.
    angles, steps : float
        Number of angles on half the disc, and of time steps in half a period, divided by the level;
        0 if they are not refined.
    cells : float
        Number of rings, or of squares across the contact, divided by the level; 0 if it is not
        refined.
    imposed : float
        Largest level at which no axis is finer than the imposed resolution; 0 if no resolution is
        imposed.  An imposed resolution is the resolution of the level `start`.
    """

    start: int
    angles: float
    steps: float
    cells: float = 1.0
    imposed: float = 0.0

    def resolution(self, level: int) -> Resolution:
        """Return the resolution at a level."""
        angles = 2 * math.ceil(0.5 * self.angles * level)  # an even number
        # levels must stay different if the imposed number of steps is below FEWEST
        fewest = 1 if self.imposed and self.steps else FEWEST
        return Resolution(
            cells=max(round(self.cells * level), 2) if self.cells else 1,
            angles=max(angles, FEWEST) if self.angles else 1,
            steps=max(round(self.steps * level), fewest),
        )

    def levels(self, tolerance: float) -> tuple[int, ...]:
        """Return the finest levels to try at a tolerance, in the order in which they are tried.

        Let n be the first level for the smallest allowed tolerance. The last level in the list is
        the level after n.
        """
        if self.imposed:
            return (self.start,)
        decades = np.log10(LOOSEST / np.minimum([tolerance, SMALLEST_TOLERANCE], LOOSEST))
        # rounding of the power must not skip a level
        least = (1.0 - 1e-9) * self.start * RATIO**decades
        first, last = np.minimum(np.searchsorted(LEVELS, least), len(LEVELS) - 1)
        return LEVELS[min(first, last + 1) : last + 2]

    @property
    def accuracy(self) -> float:
        """Tolerance for which an imposed resolution is suitable.

        A ladder for this tolerance would begin at the level `imposed`.  Below the level `start`,
        this tolerance follows from the second order of the method.
        """
        coarser = self.start / self.imposed
        return LOOSEST * coarser ** (ORDER if coarser > 1.0 else 1.0 / math.log10(RATIO))


class Kind(NamedTuple):
    """First level and number of time steps for a kind of problem.

    The values are calibrated by `benchmarks/error_estimates.py --seed 3 --start FACTOR`.

    Attributes
    ----------
    start : int
        Ladder.start.
    steps : int
        Number of time steps in half a period, divided by the level, for a stroke of u_lim; 0 if no
        time integration is needed.
    """

    start: int
    steps: int


TRANSLATION = Kind(start=12, steps=2)
"""Translations.  Close to full sliding, levels coarser than `start` can agree by chance.  For an
example, see tests/answer/test_estimates.py."""
LOOP = TRANSLATION._replace(start=16)
"""Slow motions without half-period symmetry.  The two halves of a period have different slip
fronts."""
ROTATION = TRANSLATION._replace(steps=1)
WHOLE_DISC = ROTATION._replace(start=LOOP.start)
"""Rotations combined with a lateral motion.  In such motions, the slip fronts differ between the
two halves of a period."""
SQUARES = WHOLE_DISC
"""Contacts resolved by squares. The squares are not graded towards the slip front."""
LOAD = Kind(start=24, steps=4)
"""Oscillating normal loads. Under such loads, the edge of the contact moves across the rings."""
STATIC = Kind(start=32, steps=0)
"""Static limits, computed at turning points.  In static limits, slip fronts cut through the
cells."""
ANGLES_OF_ROTATION, ANGLES_OF_TRANSLATION = 0.5, 0.125
"""Number of angles on half the disc, divided by the level.  The first value is for rotations, and
the second value is for translations.  A rotation needs more angles, because the centre of rotation
is in the contact.  In a translation, the tractions depend on the angle only weakly, and only at nu
> 0.  Both values are calibrated by `benchmarks/angles.py`."""


def ladder_for(
    problem: Problem,
    model: str,
    tolerance: float,
    cells: int | None = None,
    steps: int | None = None,
) -> Ladder:
    """Choose the `Ladder` for a problem.  Its first level has the imposed resolution, if there is
    one.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    model : str
        Name in contact.registry.MODELS.
    tolerance : float
        Absolute tolerance of the friction.  If only the cells are imposed, it determines the steps.
        If only the steps are imposed, it determines the cells.
    cells, steps : int or None
        Imposed number of cells, and imposed number of steps in a full period; None if not imposed.
    """
    motion, refined = problem.motion, MODELS[model].axes(problem)
    mirrored = problem.straight and problem.half_period_mirror
    slow = motion.periodic and problem.drift < SLOW_LOOP
    if motion.periodic and problem.velocity == 0.0 and problem.on_a_line:
        kind = STATIC
    elif motion.loads:
        kind = LOAD
    elif model == "cartesian":
        kind = SQUARES
    elif motion.rotates:
        kind = ROTATION if motion.half_disc else WHOLE_DISC
    else:
        kind = LOOP if slow and not mirrored else TRANSLATION
    longer = min(max(problem.stroke, 1.0), LONG_STROKE) ** (1 / ORDER) * motion.cycles
    angles = ANGLES_OF_ROTATION if motion.rotates else ANGLES_OF_TRANSLATION
    ladder = Ladder(
        kind.start,
        angles=angles if "angles" in refined else 0.0,
        steps=kind.steps * longer if motion.periodic else 0.0,
        cells=1.0 if "cells" in refined else 0.0,
    )
    cells, steps = cells if ladder.cells else None, steps if ladder.steps else None
    if cells is None and steps is None:
        return ladder
    # if only the number of steps is imposed, the number of cells follows from the tolerance; if
    # only the number of cells is imposed, the number of steps also follows from this number
    level = max(ladder.levels(tolerance)[0], cells or 0)
    rings = ladder.cells * level if cells is None else cells
    half = ladder.steps * level if steps is None else steps // 2
    axes = ((rings, ladder.cells), (half, ladder.steps))
    return replace(
        ladder,
        cells=rings / ladder.start,
        angles=ladder.angles * level / ladder.start,
        steps=half / ladder.start,
        imposed=min(number / per_level for number, per_level in axes if per_level),
    )


def with_mass(ladder: Ladder, problem: Problem, model: str, tolerance: float) -> tuple[Ladder, str]:
    """Shorten the steps of a ladder until they resolve the natural oscillation of the mass.

    The natural frequency divided by the vibration frequency is sqrt(stiffness / mass).  The
    stiffness is the sum of two values: the stiffness of the contact (1.5 for a sphere at nu = 0),
    and the stiffness of the spring.  Time integration changes this frequency.  If a resonance is
    shifted, runs can agree with each other and still be wrong.  Therefore the steps are so short
    that the relative change of the frequency is at most the tolerance.

    Parameters
    ----------
    ladder : Ladder
        Ladder for the contact without a mass.
    problem : problem.Problem
        The problem, whose drive has a mass.
    model : str
        Name in contact.registry.MODELS.
    tolerance : float
        Absolute tolerance of the result.

    Returns
    -------
    tuple of Ladder and str
        The ladder, and the reason why its steps do not resolve the natural oscillation of the mass;
        empty if they do.
    """
    assert problem.drive is not None
    count = ladder.resolution(ladder.levels(tolerance)[0]).steps
    contact = contact_of(problem, model, COARSEST)
    frequency = ((contact.stiffness + problem.drive.stiffness) / problem.drive.mass) ** 0.5
    longest = float(np.diff(path_of(problem, contact, count).phase).max())
    allowed = 1.0 if ladder.imposed else (min(tolerance, LOOSEST) / FREQUENCY_ERROR) ** 0.5
    finer = max(longest * frequency / allowed, 1.0)
    if finer > 1.0 and (ladder.imposed or finer * count > MOST_MASS_STEPS):
        most = 2 * (count if ladder.imposed else MOST_MASS_STEPS)
        return ladder, (
            f"mass too small for {most} steps in a period: it oscillates against the contact at"
            f" {frequency:.3g} times the frequency of the vibration, which takes"
            f" {2 * int(np.ceil(finer * count))}"
        )
    return replace(ladder, steps=finer * ladder.steps), ""
