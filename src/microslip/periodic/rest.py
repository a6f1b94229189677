"""Run a contact under a force below the static limit until it comes to rest.

First, the force alone displaces the contact by partial slip.  Then the oscillation begins at its
mean position.  In each period, the displacement is smaller than in the period before.  The
remaining displacement decays at least as fast as a power of the number of periods.  Therefore, the
displacements between n and 2 n periods, for n = 1, 2, 4, ..., decay at least as fast as a geometric
series.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from microslip.contact.contact import Body, March, StepFailure, forward_slip
from microslip.contact.path import EULER, Path, make_path
from microslip.contact.ring_contact import RingContact
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.run import Budget, Effort, Run, Settings, unsolved
from microslip.scene.motion import HALF_PERIOD
from microslip.scene.problem import Problem

FIRST_LOOK, MOST_INTERVALS = 16, 16384
"""FIRST_LOOK: number of (half) periods before the first check for rest.  MOST_INTERVALS: largest
number of (half) periods."""
LOOKS = 1.5, 4.0 / 3.0
"""Factors by which the number of (half) periods grows from check to check.  The two factors
alternate.  With these factors, the number of (half) periods remains a multiple of four."""
STEP_SHARE = 1e-4
"""Ratio of two tolerances.  The first value is the tolerance of a step, as a force divided by mu
F_z.  The second value is the tolerance of the displacement, in u_lim."""
SLOWEST_RATIO = 0.9
"""Each time the number of periods doubles, the contact moves by a further displacement.  Let r be
the ratio of the displacements in two successive doublings.  The remaining displacement is
extrapolated only if r is at most this value."""
LONG, DRIFTING = 200, 1.8
"""LONG is a number of (half) periods.  If the ratio r is above DRIFTING after this number, the
contact keeps drifting.  In a steady drift, r is 2.  A contact on a coarse mesh can drift under a
force that is below the exact threshold."""
MOST_SHARE = 0.9
"""`most_after` is the number of periods in which the contact covers this fraction of the
displacement caused by the oscillation."""


def run_to_rest(
    problem: Problem, model: str, resolution: Resolution, tolerance: float, settings: Settings
) -> Run:
    """Run a contact under a constant force until it comes to rest.

    Parameters
    ----------
    problem : problem.Problem
        The problem at velocity 0 with a Force below the static limit.  It must satisfy
        limits.is_even.
    model : str
        Name in contact.registry.MODELS of a model that supports drives.
    resolution : discretise.Resolution
        Resolution of the model.
    tolerance : float
        Tolerance of the remaining displacement, in u_lim.
    settings : run.Settings
        Settings of the run.

    Returns
    -------
    Run
        The run, with three values.  `displacement` is measured from the position without a force to
        the position at rest, in u_lim.  `pushed` is the part of the displacement caused by the
        force alone.  `most_after` is the number of periods in which the contact covers the fraction
        MOST_SHARE of the displacement caused by the oscillation.  The `distance` of the run bounds
        the remaining displacement.  The run has not converged if the contact does not come to rest
        or a step failed.
    """
    contact = cast(RingContact, contact_of(problem, model, resolution, settings))  # or with squares
    assert problem.force is not None
    body = Body(0.0, 0.0, 0.0, problem.force * problem.mean_load)
    walk = _Walk(contact, body, STEP_SHARE * tolerance, settings.budget)
    cycle, mirror = path_of(problem, contact, resolution.steps), problem.half_period_mirror
    interval = cycle.phase[-1] - cycle.phase[0]
    pushed = walk.march(_still(problem), 0.0 * forward_slip(contact))
    # march from the mean position to the start of an interval of the map; the state is mirrored
    # once for each interval by which this start is postponed
    end, images = cycle.phase[0], 0
    while end <= 0.0:
        end, images = end + interval, images + 1
    steps = max(1, round(resolution.steps * end / (HALF_PERIOD[1] - HALF_PERIOD[0])))
    phases = np.linspace(0.0, end, steps + 1)
    ways = [
        walk.march(make_path(problem.displacement, phases, depth=problem.depth), walk.last.state)
    ]
    state = walk.last.state
    if mirror and images % 2:
        state = contact.mirrored(state)
    look, guess = FIRST_LOOK, None
    for count in range(1, MOST_INTERVALS + 1):
        ways.append(walk.march(cycle, state, guess))
        guess = walk.last
        state = contact.mirrored(guess.state) if mirror else guess.state
        if count == look:
            remaining, drifts = _remaining(ways[1:], walk.residual / contact.stiffness)
            if remaining <= tolerance or drifts:
                break
            look = round(look * LOOKS[look % 3 == 0])
    residual, period = walk.residual / contact.stiffness, interval / (2.0 * np.pi)
    reason = unsolved(walk, walk.step_tolerance)
    if remaining > tolerance:
        reason = (
            f"still moves after {count * period:g} periods, by {ways[-1]:.1e} in the last march"
        )
    travel = np.cumsum(ways)
    added = travel[-1] + (0.5 * remaining if np.isfinite(remaining) else 0.0)
    most = int(np.searchsorted(np.maximum.accumulate(travel), MOST_SHARE * added))
    if added <= residual:  # within the residual of the steps
        most = 0
    return Run(
        {
            "displacement": float(pushed + added),
            "pushed": float(pushed),
            "most_after": float(most * period),
        },
        distance=0.5 * remaining,
        residual=residual,
        periods=float(count * period),
        effort=Effort.of(walk.solves, walk.iterations, state.size),
        reason=reason,
        state=state,
    )


class _Walk:
    """Successive marches of a contact under a force.  The effort and the residuals of all marches
    are added up."""

    def __init__(self, contact: RingContact, body: Body, step_tolerance: float, budget: Budget):
        self.contact, self.body, self.step_tolerance = contact, body, step_tolerance
        self.budget = budget
        self.residual, self.iterations, self.solves = 0.0, 0, 0

    def march(self, path: Path, state: np.ndarray, guess: March | None = None) -> float:
        """March along a path, and return the displacement of the contact.

        Raises StepFailure if the tractions diverge.
        """
        march = self.contact.march(path, state, self.step_tolerance, guess, body=self.body)
        self.budget.take(march.solves, march.iterations, march.state.size)
        if not np.isfinite(march.state).all():
            raise StepFailure("diverged: tractions are not finite")
        self.residual += march.residual
        self.iterations += march.iterations
        self.solves += march.solves
        self.last = march
        return float(march.body[-1, 0] - march.body[0, 0])


def _still(problem: Problem) -> Path:
    """Return a path without oscillation.  One step suffices, since slip only grows with the
    force."""
    of_phase = problem.depth
    depth = None if of_phase is None else lambda phase: of_phase(0.0 * phase)
    return make_path(lambda phase: (0.0 * phase,) * 3, np.array([0.0, 1.0]), EULER, depth)


def _remaining(ways: list[float], rounding: float) -> tuple[float, bool]:
    """Return two values: an upper bound on the remaining displacement, and True if the contact
    keeps drifting.

    Each time the number of intervals doubles, the contact moves by a further displacement.  These
    displacements are extrapolated as a geometric series.  The bound is infinite if the ratio of the
    last two displacements is above SLOWEST_RATIO.

    Parameters
    ----------
    ways : list of float
        Displacement in each interval.
    rounding : float
        Displacement that the residuals of the steps can cause.  A contact that moves by less is at
        rest.
    """
    count = len(ways)
    before = max(sum(ways[count // 4 : count // 2]), 0.0)
    last = max(sum(ways[count // 2 :]), 0.0)
    drifts = count >= LONG and last > DRIFTING * before
    if last <= rounding:
        return last, drifts
    ratio = last / before if before > 0.0 else np.inf
    return last * ratio / (1.0 - ratio) if ratio < SLOWEST_RATIO else np.inf, drifts
