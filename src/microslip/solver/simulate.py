"""One run at one resolution: build the contact and the path, then find the periodic state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from microslip.contacts.coulomb import project
from microslip.models.contact import (
    FORWARD,
    Contact,
    StepFailure,
    forces,
    forward_slip,
)
from microslip.models.path import Path
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, path_of
from microslip.solver.effort import Effort
from microslip.solver.means import dissipated_energy, mean_forces
from microslip.solver.method import Method
from microslip.solver.period_map import MOST_MARCHES, DriftRate, Goal, PeriodicState, PeriodMap
from microslip.solver.periodic import find_periodic_state
from microslip.solver.run import AS_SHIPPED, Run, Settings, failed_run, unsolved
from microslip.solver.static_limit import static_state
from microslip.solver.static_loop import SLOW_LOOP, loop_limit
from microslip.solver.steady import steady_state

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

SLOW_EXCESS, LARGEST_EXCESS = 4.0, 0.6
"""A search starts from the static limit plus a forward traction.  This traction is the friction
bound times SLOW_EXCESS * drift^(2/3), but at most LARGEST_EXCESS times the bound.  Friction rises
with the same power of the drift.  So the search starts with too much forward traction, which makes
an accelerated search converge faster."""

MARCHES_FROM_COARSER = 50
"""Largest number of marches in a search that starts from interpolated tractions.  If more are
needed, a search from the usual start is faster."""


def simulate(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    guess: Run | None = None,
    settings: Settings = AS_SHIPPED,
) -> Run:
    """Run a model on a problem at one resolution to its periodic (or steady) state.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.  Its velocity and amplitude are above 0; for steady motions,
        the amplitude is None.
    model : str
        Name in models.registry.MODELS.
    resolution : discretise.Resolution
        Resolution of the model.
    tolerance : float
        Tolerance of the periodic state, as a force divided by mu F_z.  The tolerance of a step is
        at least 100 times smaller.
    guess : Run or None
        Run of the same point, used as the initial guess.  It is used if it has the same numbers of
        cells and angles, or if the contact can interpolate its tractions.
    settings : Settings
        Settings of the run.

    Returns
    -------
    Run
        The run.  If it did not converge, `converged` is False; no exception is raised.

    Raises
    ------
    budget.Spent
        If the budget is exceeded.
    """
    method = settings.method
    absolute = tolerance * problem.mean_load  # inside a run forces are divided by mu F_z
    try:
        if method.run is not None:
            return method.run(problem, model, resolution, absolute)
        return _run(problem, model, resolution, absolute, guess, settings)
    except StepFailure as failure:
        return failed_run(str(failure))


def _run(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    guess: Run | None,
    settings: Settings,
) -> Run:
    """Run as in `simulate`, but with a tolerance in units of mu F_z; can raise StepFailure."""
    contact = settings.contact(problem, model, resolution)
    if not problem.motion.periodic:
        return steady_state(contact, problem, tolerance, STEP_SHARE * tolerance)
    share = step_share(contact.stiffness * problem.drift, resolution.steps, settings.tighter)
    step_tolerance = share * tolerance
    search = _Search(contact, problem, settings.method, resolution.steps, tolerance, step_tolerance)
    return search.run(guess)


def step_share(force_rate: float, steps: int, tighter: bool) -> float:
    """Ratio of the step tolerance to the tolerance of the periodic state.

    `force_rate` is the rise of the force per radian of phase, divided by mu F_z, for a contact
    without slip.
    """
    slow_share = force_rate * np.pi * STEP_SHARE
    floor = TIGHTER * SLOW_STEP_SHARE if tighter else SLOW_STEP_SHARE
    return min(max(slow_share, floor), STEP_SHARE, MARCH_SHARE / steps)


class _Search:
    """Search for the periodic state of one run, trying several initial states in turn."""

    def __init__(
        self,
        contact: Contact,
        problem: Problem,
        method: Method,
        steps: int,
        tolerance: float,
        step_tolerance: float,
    ):
        self.contact, self.problem, self.method, self.steps = contact, problem, method, steps
        self.tolerance, self.step_tolerance = tolerance, step_tolerance
        interval = np.pi if problem.half_period_mirror else 2.0 * np.pi
        # for motions on a line a prepared search computes the limit;
        # for slow loops the limit only sets `least`
        limit = 0.0 if problem.straight or not contact.sticks else np.nan
        gain = contact.stiffness * problem.drift * interval
        self.drift_rate = DriftRate(limit, problem.mean_load, gain)
        self.path = path_of(problem, contact, steps, method.integrator)
        self.searches: list[PeriodicState] = []

    def run(self, guess: Run | None = None) -> Run:
        """Run the search.  For `guess` see `simulate`."""
        start, converged = self._start_from(guess), False
        if guess is not None and start is not None:
            self.drift_rate = replace(self.drift_rate, static_force=guess.static_force)
            converged = self._find(start, near=start is not guess.state).converged
        if not converged:
            self._search_afresh()
        return run_of_searches(
            self.contact,
            self.problem,
            self.path,
            self.searches,
            self.step_tolerance,
            self.problem.mean_load,
            static_force=self.drift_rate.static_force,
        )

    def _start_from(self, guess: Run | None) -> np.ndarray | None:
        """Tractions of a guess at this contact's points, or None if the guess is not usable."""
        if guess is None or guess.state is None or not guess.converged:
            return None
        if guess.state.shape == (2, *self.contact.forward_position.shape):
            return guess.state
        start = self.contact.prolonged(guess.state)
        return None if start is None else project(start, self.contact.bound)

    def _search_afresh(self) -> None:
        slipping = forward_slip(self.contact)
        if self.method.prepared and self._find(self._start_near_the_limit(slipping)).converged:
            return
        self._find(slipping)

    def _start_near_the_limit(self, slipping: np.ndarray) -> np.ndarray:
        """Tractions of the static limit plus forward tractions, or full slip if no point sticks.

        The force at the static limit is stored in `drift_rate`.
        """
        slow_loop = not self.problem.straight and self.problem.drift < SLOW_LOOP
        if not self.contact.sticks or not (self.problem.straight or slow_loop):
            return slipping
        rise = self.problem.drift ** (2.0 / 3.0)
        if slow_loop:  # a factor of 4 would prevent convergence at the smallest drifts
            limit, excess = self._limit_of_a_loop(rise), rise
        else:
            limit, excess = self._limit_of_a_line(), min(SLOW_EXCESS * rise, LARGEST_EXCESS)
        return project(limit + excess * slipping, self.contact.bound)

    def _limit_of_a_line(self) -> np.ndarray:
        limit = static_state(self.contact, self.problem.oscillation, self.step_tolerance)
        if not unsolved(limit.solver_residual, limit.solves, self.step_tolerance):
            force = float(forces(self.contact, limit.residual)[FORWARD])
            self.drift_rate = replace(self.drift_rate, static_force=force)
        return limit.residual + limit.oscillating

    def _limit_of_a_loop(self, rise: float) -> np.ndarray:
        """Tractions of the static limit, computed with reduced accuracy.

        The accuracy is chosen according to the rise of friction above the limit.  Because of the
        reduced accuracy, the limit's force only sets `least`.
        """
        rest = replace(self.problem, velocity=0.0)
        path = path_of(rest, self.contact, self.steps, self.method.integrator)
        tolerance = max(rise, self.tolerance)
        limit = loop_limit(self.contact, rest, path, tolerance, STEP_SHARE * tolerance)
        self.searches.append(limit.periodic)
        self.drift_rate = replace(self.drift_rate, least=limit.force)
        return limit.periodic.start + limit.shift

    def _find(self, start: np.ndarray, near: bool = False) -> PeriodicState:
        period_map = PeriodMap(
            self.contact, self.path, self.drift_rate, self.problem.half_period_mirror
        )
        most = MARCHES_FROM_COARSER if near else MOST_MARCHES
        goal = Goal(self.tolerance, self.step_tolerance, most, near)
        search = self.method.search or find_periodic_state
        self.searches.append(search(period_map, start, goal))
        return self.searches[-1]


def run_of_searches(
    contact: Contact,
    problem: Problem,
    path: Path,
    searches: Sequence[PeriodicState],
    step_tolerance: float,
    unit: float,
    **others: float,
) -> Run:
    """Build the Run of the last search, with the effort of all searches.

    `unit` is a force divided by mu F_z; the distance and the residual are divided by it.  `others`
    are further fields of the Run.
    """
    periodic = searches[-1]
    forward, _, torque = mean_forces(contact, problem, path, periodic.forces)
    periods = periods_of(sum(one.marches for one in searches), problem)
    reason = unsolved(periodic.solver_residual, path.solves, step_tolerance)
    if not periodic.converged:
        reason = f"no periodic state within {periods:g} periods: {periodic.distance:.1e} left"
    solves = sum(one.solves for one in searches)
    iterations = sum(one.iterations for one in searches)
    return Run(
        mu=float(forward) / problem.mean_load,
        torque=float(torque) / problem.pressure.torque,
        distance=periodic.distance / unit,
        solver_residual=periodic.solver_residual / unit,
        periods=periods,
        effort=Effort.of(solves, iterations, periodic.start.size),
        converged=not reason,
        reason=reason,
        state=periodic.start,
        energy=dissipated_energy(contact, path, periodic),
        **others,
    )


def periods_of(marches: int, problem: Problem) -> float:
    """Convert a number of marches, each over a period or half a period, to a number of full
    periods."""
    return 0.5 * marches if problem.half_period_mirror else float(marches)
