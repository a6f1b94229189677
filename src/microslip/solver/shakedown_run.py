"""One run of a contact from rest under a force that does not keep it moving, until it stands.

First the force alone pushes it as far as partial slip lets it go.  Then the oscillation begins at
its mean position, and every period moves the contact on by less than the one before.  What these
still add in the end falls by powers of their number, and faster: the distances that are gone while
that number doubles fall at least as a geometric series does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np

from microslip.models.contact import March, StepFailure, forward_slip
from microslip.models.driven_body import Body
from microslip.models.path import EULER, Path, make_path
from microslip.models.system_contact import SystemContact
from microslip.motions.motion import HALF_PERIOD
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, path_of
from microslip.solver.effort import Effort
from microslip.solver.period_map import PeriodMap
from microslip.solver.run import Run, Settings, failed_run, unsolved

FIRST_LOOK, MOST_INTERVALS = 16, 16384
"""(Half) periods after which it is first looked at what is left, and the most that are marched."""
LOOKS = 1.5, 4.0 / 3.0
"""From one such number to the next, in turns: multiples of four."""
STEP_SHARE = 1e-4
"""Tolerance of a step, a force over mu F_z, divided by the tolerance of the displacement."""
SLOWEST_RATIO = 0.9
"""Largest ratio of the distances gone in two successive doublings of the number of periods; above
it the remaining distance cannot be extrapolated."""
LONG, DRIFTING = 200, 1.8
"""(Half) periods from which on such a ratio, of 2 if it never slowed down, tells that the contact
drifts: the threshold of so coarse a contact is another."""
MOST_SHARE = 0.9
"""Share of the displacement added by the oscillation after which `most_after` is counted."""


@dataclass(frozen=True)
class ShakedownRun(Run):
    """A Run with the displacement of the contact; `distance` bounds the remaining displacement.

    Attributes
    ----------
    displacement : float
        Displacement of the contact at the end, from its position without a force, in u_lim.
    pushed : float
        Part of the displacement that the force alone causes.
    most_after : float
        Periods after which MOST_SHARE of the rest is gone.
    """

    displacement: float = np.nan
    pushed: float = np.nan
    most_after: float = np.nan


def run_to_rest(
    problem: Problem,
    force: float,
    model: str,
    resolution: Resolution,
    tolerance: float,
    settings: Settings,
) -> ShakedownRun:
    """Run a contact that a force pulls until it stands.

    Parameters
    ----------
    problem : problem.Problem
        At velocity 0, its motion even.
    force : float
        Over mu times the mean normal load, below the static limit.
    model : str
        Name in models.registry.MODELS, of a contact that may be pulled.
    resolution : discretise.Resolution
        Resolution of the model.
    tolerance : float
        Tolerance of the remaining displacement, in u_lim.
    settings : run.Settings
        How it is done.

    Returns
    -------
    ShakedownRun
        Not converged where the contact does not come to rest, or a step failed.
    """
    # or one that counts its marches
    contact = cast(SystemContact, settings.contact(problem, model, resolution))
    body = Body(0.0, 0.0, 0.0, force * problem.mean_load)
    try:
        return _Walk(problem, contact, resolution.steps, body).to_rest(tolerance)
    except StepFailure as failure:
        return ShakedownRun(**vars(failed_run(str(failure))))


class _Walk:
    """A contact on its way."""

    def __init__(self, problem: Problem, contact: SystemContact, steps: int, body: Body):
        self.problem, self.contact, self.steps, self.body = problem, contact, steps, body
        path = path_of(problem, contact, steps)
        self.map = PeriodMap(contact, path, mirror=problem.half_period_mirror)
        self.marches = 0
        self.interval = path.phase[-1] - path.phase[0]
        self.gone: list[float] = []
        self.residual, self.iterations, self.solves = 0.0, 0, 0

    def to_rest(self, tolerance: float) -> ShakedownRun:
        """The ShakedownRun; tolerance: of what may be left of the way."""
        step_tolerance = STEP_SHARE * tolerance
        state = 0.0 * forward_slip(self.contact)
        still, pushed = self._march(self._still(), state, step_tolerance)
        first, images = self._first_part()
        march, begun = self._march(first, still.state, step_tolerance)
        state = march.state
        for _ in range(images):
            state = self.map.image(state)
        look, previous = FIRST_LOOK, None
        for turn in range(MOST_INTERVALS):
            previous, way = self._march(self.map.path, state, step_tolerance, previous)
            state = self.map.image(previous.state)
            self.gone.append(way)
            self.marches += 1
            if turn + 1 == look:
                left = self._left()
                if left <= tolerance or self._drifts():
                    break
                look = round(look * LOOKS[look % 3 == 0])
        reason = unsolved(self.residual, self.solves, step_tolerance)
        if left > tolerance:
            reason = f"still moves after {self._periods:g} periods, by {self.gone[-1]:.1e} in the "
            reason += "last march"
        return self._summary((pushed, begun), left, reason, state)

    @property
    def _periods(self) -> float:
        """Full periods marched so far."""
        return float(self.marches * self.interval / (2.0 * np.pi))

    def _still(self) -> Path:
        """The path on which the force alone grows: one step, since slip only grows with it."""
        of_phase, depth = self.problem.depth, None
        if of_phase is not None:

            def depth(phase: np.ndarray) -> np.ndarray:
                return of_phase(0.0 * phase)

        def displacement(phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
            return 0.0 * phase, 0.0 * phase, 0.0 * phase

        return make_path(displacement, np.array([0.0, 1.0]), EULER, depth)

    def _first_part(self) -> tuple[Path, int]:
        """The path from the mean position to where an interval of the map ends, and of how many
        such intervals that is the image of the beginning."""
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
        """A march along a path, and how far the contact went.

        Raises StepFailure where the tractions blow up.
        """
        march = self.contact.march(path, state, step_tolerance, previous, body=self.body)
        if not np.isfinite(march.state).all():
            raise StepFailure("diverged: tractions are not finite")
        self.residual += march.residual
        self.iterations += march.iterations
        self.solves += march.solves
        return march, float(march.body[-1, 0] - march.body[0, 0])

    def _drifts(self) -> bool:
        """Whether the contact goes on as fast as it did long before."""
        before, last = self._last_two()
        return len(self.gone) >= LONG and last > DRIFTING * before

    def _left(self) -> float:
        """How much of the way may be left: the series of distances that are gone while the number
        of intervals doubles, if it went on as it did last; infinite if that does not end."""
        before, last = self._last_two()
        if last <= self.residual / self.contact.stiffness:  # as far as steps are solved, it stands
            return last
        ratio = last / before if before > 0.0 else np.inf
        return last * ratio / (1.0 - ratio) if ratio < SLOWEST_RATIO else np.inf

    def _last_two(self) -> tuple[float, float]:
        """Distances gone while the number of intervals doubled to half of what it is, and to it."""
        count = len(self.gone)
        before, last = sum(self.gone[count // 4 : count // 2]), sum(self.gone[count // 2 :])
        return max(before, 0.0), max(last, 0.0)

    def _summary(
        self, parts: tuple[float, float], left: float, reason: str, state: np.ndarray
    ) -> ShakedownRun:
        pushed, begun = parts
        marched = np.cumsum([begun, *self.gone])
        added = marched[-1] + (0.5 * left if np.isfinite(left) else 0.0)
        most = int(np.searchsorted(np.maximum.accumulate(marched), MOST_SHARE * added))
        if added <= self.residual / self.contact.stiffness:  # no more than steps leave unsolved
            most = 0
        periods = self.interval / (2.0 * np.pi)
        return ShakedownRun(
            mu=self.body.load / self.problem.mean_load,
            torque=0.0,
            distance=0.5 * left,
            solver_residual=self.residual / self.contact.stiffness,
            periods=self._periods,
            effort=Effort.of(self.solves, self.iterations, state.size),
            converged=not reason,
            reason=reason,
            state=state,
            displacement=float(pushed + added),
            pushed=float(pushed),
            most_after=float(most * periods),
        )
