"""One run at one resolution of a contact that a force or a spring pulls.

It begins with the contact moved at a given velocity, whose tractions are near: that of the spring's
far end, or under a force one that is about as slow.  From there an accelerated search goes on.  A
search takes as many periods with few steps as with many, so that many steps begin where few ended.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple, cast

import numpy as np

from microslip.contacts.coulomb import project
from microslip.models.contact import FORWARD, StepFailure, forces, forward_slip
from microslip.models.driven_body import Body
from microslip.models.system_contact import SystemContact
from microslip.motions.problem import Problem
from microslip.solver.body_run import simulate_each
from microslip.solver.discretise import Resolution, path_of
from microslip.solver.effort import Effort
from microslip.solver.means import mean_forces
from microslip.solver.period_map import MOST_MARCHES, DriftRate, Goal, PeriodicState
from microslip.solver.periodic import find_periodic_state
from microslip.solver.pulled_map import PulledMap
from microslip.solver.run import Run, Settings, failed_run, unsolved
from microslip.solver.simulate import periods_of, step_share

MARCHES = 2 * MOST_MARCHES
"""Largest number of marches in a search: twice the default, since a body may swing."""
LOOSEST_MOVED = 1e-4
"""Force over mu F_z to which the state of a contact that is moved is found at least."""
COARSENING, PREPARED_FROM = 6, 96
"""By how much steps are fewer where a search begins, and from how many steps on it does: fewer cost
little, and are what tolerances of 1e-3 ask for."""
MOST_SCALED = 4.0
"""By how much the tractions of a contact that is moved are scaled to the force at most."""


class Accuracy(NamedTuple):
    """How exactly the periodic state is to be found.

    Attributes
    ----------
    tolerance : float
        Tolerance of the result: a force over mu F_z, or under a force the mean velocity.
    slope : float
        About how much friction rises with the velocity, over mu times the mean normal load: what
        an unbalanced force does to the velocity.
    """

    tolerance: float
    slope: float = np.inf


def simulate_pulled(
    problem: Problem,
    model: str,
    resolution: Resolution,
    accuracy: Accuracy,
    settings: Settings,
    *,
    guess: Run | None = None,
) -> Run:
    """Run a model of a contact that is pulled to its periodic state.

    Parameters
    ----------
    problem : problem.Problem
        With a drive; its velocity is that of the spring's far end, or an initial guess.
    model : str
        Name in models.registry.MODELS, of a contact that may be pulled.
    resolution : discretise.Resolution
        Resolution of the model.
    accuracy : Accuracy
        Accuracy of the periodic state.
    settings : run.Settings
        How it is done; of the method the integrator counts.
    guess : run.Run or None
        Run of the same point under the same drive; used if it has the same cells and angles.

    Returns
    -------
    run.Run
        Under a force `velocity` is what was asked for, and distance and solver_residual are
        velocities.  Never raises for want of convergence.

    Raises
    ------
    budget.Spent
        Where the budget is.
    """
    pulled = _Pulled(problem, model, resolution, settings)
    pulled.slope = accuracy.slope
    try:
        return pulled.run(accuracy.tolerance * pulled.force_of_answer, guess)
    except StepFailure as failure:
        return failed_run(str(failure))


class _Pulled:
    """The search for the periodic state of one run."""

    def __init__(self, problem: Problem, model: str, resolution: Resolution, settings: Settings):
        drive = problem.drive
        assert drive is not None  # as simulate_pulled demands
        self.problem, self.drive, self.model = problem, drive, model
        self.resolution, self.settings = resolution, settings
        # or one that counts its marches
        self.contact = cast(SystemContact, settings.contact(problem, model, resolution))
        self.path = path_of(problem, self.contact, resolution.steps, settings.method.integrator)
        self.interval = self.path.phase[-1] - self.path.phase[0]
        load = -drive.damping * problem.drift
        if drive.force is not None:
            load += drive.force * problem.mean_load
        self.body = Body(drive.stiffness, drive.damping, drive.mass, load)
        self.slope = np.inf
        self.before: list[Run] = []

    @property
    def force_of_answer(self) -> float:
        """Force over mu F_z that stands for a unit of the answer, to judge states by.

        A state that is wrong by a force is wrong by that over the stiffness in its displacement,
        and a march that began with it, in the velocity by this over the interval.  A force that is
        not balanced is wrong by what friction would rise by in the velocity.
        """
        if self.drive.force is None:
            return self.problem.mean_load
        unit = self.problem.unit_drift
        stuck = self.contact.stiffness * self.interval * unit
        return min(stuck, self.slope * self.problem.mean_load)

    def run(self, tolerance: float, guess: Run | None = None) -> Run:
        """The Run, to a tolerance that is a force over mu F_z; guess: see simulate_pulled."""
        rate = self.contact.stiffness * self.problem.drift
        step_tolerance = tolerance * step_share(rate, self.resolution.steps, False)
        goal, done = Goal(tolerance, step_tolerance, MARCHES), []
        for start, static_force, mu in self._starts(tolerance, guess):
            period_map = self._map(static_force, rate, mu)
            if not self._fits(start, period_map):
                continue
            done.append(find_periodic_state(period_map, start, goal))
            if done[-1].converged:
                break
        return self._summary(done, static_force, step_tolerance)

    def _map(self, static_force: float, rate: float, mu: float) -> PulledMap:
        drift_rate, slope, full = None, np.inf, self.problem.mean_load
        if self.drive.force is None:
            drift_rate = DriftRate(static_force, full, rate * self.interval)
            # 1 - mu falls at most as 1 / velocity^2, the law of large velocities
            slope = 2.0 * (1.0 - mu) * full / (self.problem.drift * self.interval)
        mirror = self.problem.half_period_mirror
        return PulledMap(self.contact, self.path, self.body, drift_rate, mirror, slope)

    def _fits(self, start: np.ndarray, period_map: PulledMap) -> bool:
        return start.shape == period_map.state(forward_slip(self.contact), np.zeros(2)).shape

    def _starts(
        self, tolerance: float, guess: Run | None
    ) -> Iterator[tuple[np.ndarray, float, float]]:
        """States to begin with, the nearest one first, each with the force of the static limit and
        the friction near by."""
        if guess is not None and guess.state is not None and guess.converged:
            yield guess.state, guess.static_force, guess.mu
        if self.resolution.steps >= PREPARED_FROM:
            coarser = self._coarser(tolerance)
            if coarser.state is not None and coarser.converged:
                yield coarser.state, coarser.static_force, coarser.mu
        moved = self._moved(tolerance)
        self.before.append(moved)
        slipping = forward_slip(self.contact)
        if moved.state is not None:
            state = self._state(moved.state, moved.mu * self.problem.mean_load)
            yield state, moved.static_force, moved.mu
        full = float(forces(self.contact, slipping)[FORWARD])
        yield self._state(slipping, full), moved.static_force, moved.mu

    def _coarser(self, tolerance: float) -> Run:
        """The Run with fewer steps."""
        fewer = replace(self.resolution, steps=self.resolution.steps // COARSENING)
        accuracy = Accuracy(tolerance / self.force_of_answer, self.slope)
        found = simulate_pulled(self.problem, self.model, fewer, accuracy, self.settings)
        self.before.append(found)
        return found

    def _moved(self, tolerance: float) -> Run:
        """The Run at a velocity that is given."""
        share = max(tolerance, LOOSEST_MOVED) / self.problem.mean_load
        return simulate_each(self.problem, self.model, self.resolution, share, self.settings)

    def _state(self, tractions: np.ndarray, mean: float) -> np.ndarray:
        """State near tractions whose mean force in a period is about `mean`."""
        if self.drive.force is not None:
            wanted = self.drive.force * self.problem.mean_load
            if mean > 0.0 and 0.0 <= wanted < MOST_SCALED * mean:
                tractions = tractions * (wanted / mean)
            tractions = project(tractions, self.contact.bound)
        place = (self.body.load - mean) / self.drive.stiffness if self.drive.stiffness else 0.0
        moved = np.array([place, 0.0]) if self.body.remembers else np.zeros(0)
        return np.append(tractions.ravel(), moved)

    def _summary(
        self, done: list[PeriodicState], static_force: float, step_tolerance: float
    ) -> Run:
        problem, unit, found = self.problem, self.force_of_answer, done[-1]
        forward, _, torque = mean_forces(self.contact, problem, self.path, found.forces)
        periods = periods_of(sum(one.marches for one in done), problem)
        reason = unsolved(found.solver_residual, self.path.solves, step_tolerance)
        if not found.converged:
            reason = f"no periodic state within {periods:g} periods: {found.distance:.1e} left"
        assert found.body is not None  # as of all contacts that are pulled
        ahead = float(found.body[-1, 0] - found.body[0, 0]) / self.interval
        drift = problem.unit_drift
        solves, iterations = (sum(getattr(m, n) for m in done) for n in ("solves", "iterations"))
        effort = Effort.of(solves, iterations, found.start.size)
        return Run(
            mu=float(forward) / problem.mean_load,
            torque=float(torque) / problem.pressure.torque,
            distance=found.distance / unit,
            solver_residual=found.solver_residual / unit,
            periods=periods + sum(run.periods for run in self.before),
            effort=sum((run.effort for run in self.before), effort),
            converged=not reason,
            reason=reason,
            state=found.start,
            static_force=static_force,
            velocity=problem.velocity + ahead / drift,
        )
