"""One run of a contact under a force below the static limit, until it comes to rest.

First, the force alone displaces the contact by partial slip.  Then the oscillation begins at its
mean position, and each period displaces the contact by less than the period before.  The remaining
displacement decays at least as fast as a power of the number of periods.  So the displacements
between successive doublings of this number decay at least as fast as a geometric series.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from microslip.contact.contact import Body, March, StepFailure, forward_slip
from microslip.contact.path import EULER, Path, make_path
from microslip.contact.ring_contact import RingContact
from microslip.motions.motion import HALF_PERIOD
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, path_of
from microslip.solver.effort import Effort
from microslip.solver.run import Run, Settings, unsolved
from microslip.solver.search import PeriodMap

FIRST_LOOK, MOST_INTERVALS = 16, 16384
"""Number of (half) periods before the first check for rest, and largest number of (half)
periods."""
LOOKS = 1.5, 4.0 / 3.0
"""Factors, used alternately, by which the number of (half) periods grows from check to check.  The
factors keep this number a multiple of four."""
STEP_SHARE = 1e-4
"""Ratio of the tolerance of a step (as a force divided by mu F_z) to the tolerance of the
displacement (in u_lim)."""
SLOWEST_RATIO = 0.9
"""Let r be the ratio of the displacements in two successive doublings of the number of periods.
The remaining displacement is extrapolated only if r is at most this value."""
LONG, DRIFTING = 200, 1.8
"""After LONG (half) periods, a ratio r above DRIFTING means that the contact keeps drifting; a
steady drift has r = 2.  On a coarse mesh, the force can exceed the threshold."""
MOST_SHARE = 0.9
"""`most_after` is the number of periods after which the oscillation has caused this fraction of the
displacement."""


def run_to_rest(
    problem: Problem, model: str, resolution: Resolution, tolerance: float, settings: Settings
) -> Run:
    """Run a contact under a constant force until it comes to rest.

    Parameters
    ----------
    problem : problem.Problem
        The problem at velocity 0 with a Force below the static limit.  Its motion must be even, see
        under_force.is_even.
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
        The run, with the values `displacement` (from the position without a force to the position
        at rest, in u_lim), `pushed` (the part of it caused by the force alone), and `most_after`
        (the number of periods in which the contact covers the fraction MOST_SHARE of the
        displacement caused by the oscillation).  Its `distance` bounds the remaining displacement.
        It is not converged if the contact does not come to rest or a step failed.
    """
    # or a contact wrapped to count its marches
    contact = cast(RingContact, settings.contact(problem, model, resolution))
    assert problem.drive is not None and problem.drive.force is not None
    body = Body(0.0, 0.0, 0.0, problem.drive.force * problem.mean_load)
    return _Walk(problem, contact, resolution.steps, body).to_rest(tolerance)


class _Walk:
    """The march of a contact to its position at rest."""

    def __init__(self, problem: Problem, contact: RingContact, steps: int, body: Body):
        self.problem, self.contact, self.steps, self.body = problem, contact, steps, body
        path = path_of(problem, contact, steps)
        self.map = PeriodMap(contact, path, mirror=problem.half_period_mirror)
        self.marches = 0
        self.interval = path.phase[-1] - path.phase[0]
        self.ways: list[float] = []
        self.residual, self.iterations, self.solves = 0.0, 0, 0

    def to_rest(self, tolerance: float) -> Run:
        """March to rest; `tolerance` refers to the remaining displacement."""
        step_tolerance = STEP_SHARE * tolerance
        state = 0.0 * forward_slip(self.contact)
        still, pushed = self._march(self._still(), state, step_tolerance)
        first, images = self._first_part()
        march, first_way = self._march(first, still.state, step_tolerance)
        state = march.state
        for _ in range(images):
            state = self.map.image(state)
        look, previous = FIRST_LOOK, None
        for turn in range(MOST_INTERVALS):
            previous, way = self._march(self.map.path, state, step_tolerance, previous)
            state = self.map.image(previous.state)
            self.ways.append(way)
            self.marches += 1
            if turn + 1 == look:
                remaining = self._remaining()
                if remaining <= tolerance or self._drifts():
                    break
                look = round(look * LOOKS[look % 3 == 0])
        reason = unsolved(self.residual, self.solves, step_tolerance)
        if remaining > tolerance:
            reason = f"still moves after {self._periods:g} periods, by {self.ways[-1]:.1e} in the "
            reason += "last march"
        return self._summary((pushed, first_way), remaining, reason, state)

    @property
    def _periods(self) -> float:
        """Number of full periods marched so far."""
        return float(self.marches * self.interval / (2.0 * np.pi))

    def _still(self) -> Path:
        """Path without oscillation.  One step suffices, since slip only grows with the force."""
        of_phase, depth = self.problem.depth, None
        if of_phase is not None:

            def depth(phase: np.ndarray) -> np.ndarray:
                return of_phase(0.0 * phase)

        def displacement(phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
            return 0.0 * phase, 0.0 * phase, 0.0 * phase

        return make_path(displacement, np.array([0.0, 1.0]), EULER, depth)

    def _first_part(self) -> tuple[Path, int]:
        """Path from the mean position to the start of an interval of the map.

        Also returns the number of intervals by which this start was postponed.  The state is
        mirrored once for each of these intervals.
        """
        end, images = self.map.path.phase[0], 0
        while end <= 0.0:
            end, images = end + self.interval, images + 1
        steps = max(1, round(self.steps * end / (HALF_PERIOD[1] - HALF_PERIOD[0])))
        phases = np.linspace(0.0, end, steps + 1)
        return make_path(self.problem.displacement, phases, depth=self.problem.depth), images

    def _march(
        self,
        path: Path,
        state: np.ndarray,
        step_tolerance: float,
        previous: March | None = None,
    ) -> tuple[March, float]:
        """March along a path; returns the march and the displacement of the contact.

        Raises StepFailure if the tractions diverge.
        """
        march = self.contact.march(path, state, step_tolerance, previous, body=self.body)
        if not np.isfinite(march.state).all():
            raise StepFailure("diverged: tractions are not finite")
        self.residual += march.residual
        self.iterations += march.iterations
        self.solves += march.solves
        return march, float(march.body[-1, 0] - march.body[0, 0])

    def _drifts(self) -> bool:
        """Whether the contact keeps moving at a nearly constant velocity."""
        before, last = self._last_two()
        return len(self.ways) >= LONG and last > DRIFTING * before

    def _remaining(self) -> float:
        """Upper bound on the remaining displacement, extrapolated as a geometric series.

        The terms of the series are the displacements between doublings of the number of intervals.
        The bound is infinite if the ratio of the last two terms is above SLOWEST_RATIO.
        """
        before, last = self._last_two()
        # at rest within the residual of the steps
        if last <= self.residual / self.contact.stiffness:
            return last
        ratio = last / before if before > 0.0 else np.inf
        return last * ratio / (1.0 - ratio) if ratio < SLOWEST_RATIO else np.inf

    def _last_two(self) -> tuple[float, float]:
        """Displacements in the last two doublings of the number of intervals."""
        count = len(self.ways)
        before, last = sum(self.ways[count // 4 : count // 2]), sum(self.ways[count // 2 :])
        return max(before, 0.0), max(last, 0.0)

    def _summary(
        self, parts: tuple[float, float], remaining: float, reason: str, state: np.ndarray
    ) -> Run:
        pushed, first_way = parts
        travel = np.cumsum([first_way, *self.ways])
        added = travel[-1] + (0.5 * remaining if np.isfinite(remaining) else 0.0)
        most = int(np.searchsorted(np.maximum.accumulate(travel), MOST_SHARE * added))
        if added <= self.residual / self.contact.stiffness:  # within the residual of the steps
            most = 0
        periods = self.interval / (2.0 * np.pi)
        values = {
            "displacement": float(pushed + added),
            "pushed": float(pushed),
            "most_after": float(most * periods),
        }
        return Run(
            values,
            distance=0.5 * remaining,
            residual=self.residual / self.contact.stiffness,
            periods=self._periods,
            effort=Effort.of(self.solves, self.iterations, state.size),
            reason=reason,
            state=state,
        )
