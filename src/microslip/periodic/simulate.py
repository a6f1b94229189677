"""Simulate a problem at one resolution.

A simulation builds the contact and the path, and then finds the state.

The steady state of a motion without oscillation is the fixed point of a march over a path of any
length.

The search for the state of a driven contact starts from the periodic state at a prescribed
velocity.  This velocity is the velocity of the spring's far end, or an approximate velocity under
the force.  The number of periods in a search does not depend on the number of steps.  To save time,
a run with many steps therefore starts from the result of a run with few steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from microslip.contact.contact import (
    FORWARD,
    TORQUE,
    Body,
    Contact,
    StepFailure,
    forward_slip,
    project,
)
from microslip.contact.path import EULER, make_path
from microslip.periodic.discretise import Resolution, dissipated_energy, mean_forces, path_of
from microslip.periodic.rest import run_to_rest
from microslip.periodic.run import (
    AS_SHIPPED,
    MARCH_SHARE,
    SLOW_STEP_SHARE,
    STEP_SHARE,
    TIGHTER,
    Budget,
    Effort,
    Run,
    Settings,
    failed_run,
    periods_of,
    unsolved,
)
from microslip.periodic.search import (
    AT_REST,
    MOST_MARCHES,
    NOT_SLOW,
    DriftRate,
    Goal,
    PeriodicState,
    PeriodMap,
    find_periodic_state,
)
from microslip.periodic.static_limit import SLOW_LOOP, limit_on_a_line, limit_on_a_loop, static_run
from microslip.scene.problem import Problem

STEADY_STRETCH = 8
"""Number of steps in the path of a steady motion."""
STEADY_TRAVEL = 0.5
"""Largest rigid displacement of a steady motion in one step, in u_lim."""


def steady_state(
    contact: Contact, problem: Problem, tolerance: float, budget: Budget | None = None
) -> Run:
    """Find the steady state of a motion without oscillation.

    Parameters
    ----------
    contact : contact.Contact
        The contact, in full forward slip at the start.
    problem : problem.Problem
        The steady motion; its velocity sets the length of a step.
    tolerance : float
        Tolerance of the state, as a force divided by mu F_z.
    budget : run.Budget or None
        Budget of the marches.  None means unlimited.

    Returns
    -------
    Run
        Forces and tractions of the steady state.
    """
    step = STEADY_TRAVEL / max(1.0, problem.velocity)
    path = make_path(problem.displacement, step * np.arange(STEADY_STRETCH + 1.0), EULER)
    goal = Goal(tolerance, STEP_SHARE * tolerance)
    step_map = PeriodMap(contact, path, mirror=False, budget=budget)
    steady = find_periodic_state(step_map, forward_slip(contact), goal)
    march = steady.march
    reason = unsolved(march, goal.step_tolerance)
    return Run(
        {
            "friction": float(march.forces[-1, FORWARD]),
            "torque": float(march.forces[-1, TORQUE]) / problem.pressure.torque,
        },
        distance=steady.distance,
        residual=march.residual,
        effort=steady.effort,
        reason=reason if steady.converged else f"no steady state: {steady.distance:.1e} left",
        state=march.state,
    )


SLOW_EXCESS, LARGEST_EXCESS = 4.0, 0.6
"""A search starts from the static limit plus a forward traction.  This traction, divided by the
friction bound, is `SLOW_EXCESS` times drift^(2/3), but at most `LARGEST_EXCESS`.  The rise of the
friction is also proportional to drift^(2/3).  SLOW_EXCESS is large enough that the search starts
with too much forward traction.  An accelerated search converges faster from such a start."""
MARCHES_FROM_COARSER = 50
"""Largest number of marches in a search that starts from interpolated tractions.  If more marches
are needed, a search from the usual start is faster."""
DRIVEN_MARCHES = 2 * MOST_MARCHES
"""Largest number of marches in a search for a driven contact, whose body can oscillate."""
LOOSEST_START = 1e-4
"""A search for a driven contact starts from a state at a prescribed velocity.  This value is the
largest tolerance of that state, as a force divided by mu F_z."""
COARSENING, PREPARED_FROM = 6, 96
"""PREPARED_FROM: a run of a driven contact with at least this number of steps starts from a run
with fewer steps.  COARSENING: ratio of the two numbers of steps.  Runs with fewer steps than
`PREPARED_FROM` are cheap and start directly.  Such runs suffice for a tolerance of 1e-3."""
MOST_SCALED = 4.0
"""Largest factor by which the initial tractions are scaled to match the prescribed force."""


def simulate(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    guess: Run | None = None,
    settings: Settings = AS_SHIPPED,
) -> Run:
    """Simulate a problem with a model at one resolution.

    The problem determines which state is computed.  Without oscillation, this is the steady state
    of the motion.  At velocity 0, the computed state is the static limit, or the state of rest
    under a force.  In all other cases, the periodic state is computed.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.  With a spring, the prescribed velocity is the velocity of the
        far end of the spring.  Under a prescribed force, a velocity above 0 is an initial guess.
    model : str
        Name in contact.registry.MODELS.
    resolution : discretise.Resolution
        Resolution of the model.
    tolerance : float
        Tolerance of the state: a force divided by mu times the mean normal load, a velocity under a
        prescribed force, or a displacement in u_lim for a run to rest.
    guess : Run or None
        Run of the same point.  It is the initial guess if it has the same numbers of cells and
        angles, or if the contact can interpolate its tractions.
    settings : Settings
        Settings of the run.

    Returns
    -------
    Run
        The run.  If it did not converge, its `reason` says why; no exception is raised.

    Raises
    ------
    run.Spent
        If the budget is exceeded.
    """
    method, drive = settings.method, problem.drive
    try:
        if method.run is not None:
            return method.run(problem, model, resolution, tolerance * problem.mean_load)
        if not problem.motion.periodic:
            contact = settings.contact(problem, model, resolution)
            return steady_state(contact, problem, tolerance * problem.mean_load, settings.budget)
        if problem.velocity == 0.0 and drive is None:
            return static_run(problem, model, resolution, tolerance, settings)
        if problem.velocity == 0.0 and problem.force is not None:
            return run_to_rest(problem, model, resolution, tolerance, settings)
        return _Search(problem, model, resolution, tolerance, settings).run(guess)
    except StepFailure as failure:
        return failed_run(str(failure))


class Start(NamedTuple):
    """Initial state of a search.

    Attributes
    ----------
    state : np.ndarray
        Tractions.
    place : np.ndarray, shape (2,)
        x and x' of a driven body.
    near : bool
        Whether the tractions are interpolated from a coarser mesh.
    friction : float
        Approximate friction of a driven contact.
    """

    state: np.ndarray
    place: np.ndarray = AT_REST
    near: bool = False
    friction: float = np.nan


class _Search:
    """Search for the periodic state of one run, trying several initial states in turn.

    `unit` is the force, divided by mu F_z, that corresponds to an error of 1 in the result.  If the
    velocity is prescribed or a spring pulls the contact, the result is a force.  For a prescribed
    force, the result is a velocity, and `unit` is the smaller of two estimates.  The first estimate
    is the product of two numbers: the stiffness of the contact, and the displacement of the contact
    in an interval at velocity 1.  The second estimate is the rise of the friction force with the
    velocity.
    """

    def __init__(
        self,
        problem: Problem,
        model: str,
        resolution: Resolution,
        relative: float,
        settings: Settings,
    ):
        self.problem, self.model, self.resolution = problem, model, resolution
        self.settings, self.relative, drive = settings, relative, problem.drive
        self.contact = settings.contact(problem, model, resolution)
        self.path = path_of(problem, self.contact, resolution.steps, settings.method.integrator)
        self.interval = float(self.path.phase[-1] - self.path.phase[0])
        rate = self.contact.stiffness * problem.drift
        self.gain = rate * self.interval
        # the accuracy of a static limit is chosen according to the rise of friction above it
        self.rise = problem.drift ** (2.0 / 3.0)
        self.unit, self.most_marches = problem.mean_load, MOST_MARCHES
        self.force, self.body = problem.force, None
        if self.force is not None:
            self.force *= problem.mean_load
        if drive is not None:
            self.most_marches = DRIVEN_MARCHES
            constant = (self.force or 0.0) - drive.damping * problem.drift
            self.body = Body(drive.stiffness, drive.damping, drive.mass, constant)
        if self.force is not None:
            stuck = self.contact.stiffness * self.interval * problem.unit_drift
            self.unit = min(stuck, settings.slope * problem.mean_load)
        floor = TIGHTER * SLOW_STEP_SHARE if settings.tighter else SLOW_STEP_SHARE
        share = min(max(rate * np.pi * STEP_SHARE, floor), STEP_SHARE)
        self.tolerance = relative * self.unit
        self.step_tolerance = min(share, MARCH_SHARE / resolution.steps) * self.tolerance
        self.static_force = self.least = np.nan
        self.limit: np.ndarray | None = None
        # of the searches of this run, and of earlier runs from which it starts
        self.marches, self.earlier_periods, self.effort = 0, 0.0, Effort()

    def run(self, guess: Run | None) -> Run:
        """Try one initial state after the other, and return the Run of the last search, with the
        effort of all searches."""
        problem, full = self.problem, self.problem.mean_load
        find = self.settings.method.search or find_periodic_state
        for start in (self.prescribed if self.body is None else self.driven)(guess):
            most = MARCHES_FROM_COARSER if start.near else self.most_marches
            goal = Goal(self.tolerance, self.step_tolerance, most, start.near)
            drift_rate, slope = NOT_SLOW, np.inf
            if self.force is None:  # the velocity is known
                drift_rate = DriftRate(self.static_force, full, self.gain, self.least)
                if self.body is not None:
                    # 1 - mu decreases at most as fast as 1 / velocity^2, as at large velocities
                    slope = 2.0 * (1.0 - start.friction) * full / (problem.drift * self.interval)
            place = self.contact, self.path, drift_rate, problem.half_period_mirror
            period_map = PeriodMap(*place, self.body, slope, budget=self.settings.budget)
            periodic = self.count(find(period_map, start.state, goal, start.place))
            if periodic.converged:
                break
        march, periods = periodic.march, periods_of(self.marches, problem)
        reason = unsolved(march, self.step_tolerance)
        if not periodic.converged:
            reason = f"no periodic state within {periods:g} periods: {periodic.distance:.1e} left"
        mean = mean_forces(self.contact, problem, self.path, march.forces)[FORWARD]
        values = {
            "friction": float(mean) / full,
            "dissipation": dissipated_energy(self.contact, self.path, march),
        }
        if self.body is not None:
            rate = float(march.body[-1, 0] - march.body[0, 0]) / self.interval
            values["velocity"] = problem.velocity + rate / problem.unit_drift
        return Run(
            values,
            distance=periodic.distance / self.unit,
            residual=march.residual / self.unit,
            periods=periods + self.earlier_periods,
            effort=self.effort,
            reason=reason,
            state=periodic.start,
            place=march.body[0] if len(march.body) else AT_REST,
            static_force=self.static_force,
            limit=self.limit,
        )

    def count(self, search: PeriodicState) -> PeriodicState:
        """Add the marches and the effort of a search to those of the run, and return the search."""
        self.marches, self.effort = self.marches + search.marches, self.effort + search.effort
        return search

    def prescribed(self, guess: Run | None) -> Iterator[Start]:
        """Yield initial states at a prescribed velocity, best first."""
        problem, contact, method = self.problem, self.contact, self.settings.method
        if problem.straight or not contact.sticks:
            self.static_force = 0.0
        if guess is not None:
            yield from self._from_run(guess)
        start = slipping = forward_slip(contact)
        near_limit = method.prepared and contact.sticks
        if near_limit and problem.straight:
            # if the drift alone adds full friction in an interval, DriftRate.error is at most the
            # change of the state, whatever the limit
            if self.gain < problem.mean_load:
                excess = min(SLOW_EXCESS * self.rise, LARGEST_EXCESS)
                start = self._find_limit() + excess * slipping
        elif near_limit and problem.drift < SLOW_LOOP:
            # the force of this limit only sets `least`
            rest, tolerance = replace(problem, velocity=0.0), max(self.rise, self.tolerance)
            path = path_of(rest, contact, self.resolution.steps, method.integrator)
            tolerances = tolerance, STEP_SHARE * tolerance
            limit, oscillation = limit_on_a_loop(
                contact, rest, path, *tolerances, self.settings.budget
            )
            self.count(oscillation)
            self.least = limit.force
            # a factor of SLOW_EXCESS would prevent convergence at the smallest drifts
            start = limit.oscillating + limit.shift + self.rise * slipping
        if method.prepared:
            yield Start(project(start, contact.bound))
        yield Start(slipping)

    def _find_limit(self) -> np.ndarray:
        """Return the tractions of the static limit of a motion on a line, and set
        `static_force`."""
        tolerance = STEP_SHARE * max(self.rise, self.tolerance)
        limit = limit_on_a_line(self.contact, self.problem.oscillation, tolerance)
        self.settings.budget.take(limit.effort)
        if not unsolved(limit.march, tolerance):
            self.static_force = limit.force
        self.limit = limit.shift + limit.oscillating
        return self.limit

    def _from_run(self, guess: Run) -> Iterator[Start]:
        """Yield the initial state that follows from a converged run.

        No state is yielded if the tractions of the run are unknown or cannot be interpolated.
        """
        contact = self.contact
        if guess.state is None or not guess.converged:
            return
        if guess.state.shape == (2, *contact.forward_position.shape):
            self.static_force, self.limit = guess.static_force, guess.limit
            yield Start(guess.state, guess.place, friction=guess.mu)
            return
        # the static limit, which has kinks, is computed on each mesh
        excess = guess.state if guess.limit is None else guess.state - guess.limit
        near = contact.prolong(excess)
        if near is not None:
            near = near if guess.limit is None else near + self._find_limit()
            yield Start(project(near, contact.bound), guess.place, near=True, friction=guess.mu)

    def driven(self, guess: Run | None) -> Iterator[Start]:
        """Yield initial states under a prescribed force or on a spring, best first."""
        contact, problem, slipping = self.contact, self.problem, forward_slip(self.contact)
        for one in self._similar_runs(guess):
            yield from self._from_run(one)
        share = max(self.tolerance, LOOSEST_START) / problem.mean_load
        run = self._earlier_run(replace(problem, drive=None), self.resolution, share)
        self.static_force, self.limit = run.static_force, run.limit
        # tractions at a prescribed velocity, and their mean force over a period
        starts = [(slipping, float(np.sum(contact.weight * slipping[0])))]
        if run.state is not None:
            starts.insert(0, (run.state, run.mu * problem.mean_load))
        body, force = self.body, self.force
        assert body is not None
        for tractions, mean in starts:
            if force is not None:
                if mean > 0.0 and 0.0 <= force < MOST_SCALED * mean:
                    tractions = tractions * (force / mean)
                tractions = project(tractions, contact.bound)
            place = (body.load - mean) / body.stiffness if body.stiffness else 0.0
            yield Start(tractions, np.array([place, 0.0]), friction=run.mu)

    def _similar_runs(self, guess: Run | None) -> Iterator[Run]:
        """Yield runs with a similar state. If a guess is given, it is the first run. The second run
        has fewer steps (see `COARSENING`)."""
        if guess is not None:
            yield guess
        if self.resolution.steps >= PREPARED_FROM:
            fewer = replace(self.resolution, steps=self.resolution.steps // COARSENING)
            yield self._earlier_run(self.problem, fewer, self.relative)

    def _earlier_run(self, problem: Problem, resolution: Resolution, tolerance: float) -> Run:
        run = simulate(problem, self.model, resolution, tolerance, settings=self.settings)
        self.earlier_periods += run.periods
        self.effort += run.effort
        return run
