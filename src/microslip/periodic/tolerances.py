"""Tolerances of the steps in a run, and the number of its periods."""

from __future__ import annotations

import numpy as np

from microslip.scene.problem import Problem

STEP_SHARE = 1e-2
"""Largest ratio of the step tolerance to the tolerance of the periodic state."""
SLOW_STEP_SHARE = 3e-4
"""Smallest ratio of the step tolerance to the tolerance of the periodic state.  The slower the
motion, the longer its transients, and the more the errors of the steps accumulate."""
TIGHTER = 0.1
"""Smallest ratio of the step tolerance in a second attempt to the step tolerance in the first."""
MARCH_SHARE = 0.16
"""Largest sum of the step tolerances in half a period, divided by the tolerance of the periodic
state.  With two stages per step, the residuals add up to a third of the tolerance."""


def step_share(force_rate: float, steps: int, tighter: bool) -> float:
    """Ratio of the step tolerance to the tolerance of the periodic state.

    `force_rate` is the rise of the force per radian of phase, divided by mu F_z, for a contact
    without slip.
    """
    slow_share = force_rate * np.pi * STEP_SHARE
    floor = TIGHTER * SLOW_STEP_SHARE if tighter else SLOW_STEP_SHARE
    return min(max(slow_share, floor), STEP_SHARE, MARCH_SHARE / steps)


def periods_of(marches: int, problem: Problem) -> float:
    """Convert a number of marches, each over a period or half a period, to a number of full
    periods."""
    return 0.5 * marches if problem.half_period_mirror else float(marches)
