"""One run at one resolution of a contact under a prescribed force or on a spring.

The search starts from the periodic state of the contact at a prescribed velocity: the velocity of
the spring's far end, or an approximate velocity under the force.  The number of periods in a search
does not depend on the number of steps, so a run with many steps starts from the result of a run
with few steps.

The state is a one-dimensional array.  It contains the tractions and, for bodies with memory
(models/driven_body.py), the position x of the body relative to the path and its rate x'.  Mirroring
the state after half a period does not change x and x'.

During one period, unbalanced forces hardly move a heavy body, and the force of a soft spring hardly
changes.  So the map scales up the changes of x and x', as if the spring were stiffer and the body
lighter, to match the stiffness of the contact.  The fixed point of the map stays the same.  A
contact in full slip is much more compliant than a sticking contact.  Its stiffness is the rise of
the mean force with the displacement.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple, cast

import numpy as np

from microslip.contacts.coulomb import project
from microslip.models.contact import FORWARD, StepFailure, forces, forward_slip
from microslip.models.driven_body import Body
from microslip.models.path import Path
from microslip.models.system_contact import SystemContact
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, path_of
from microslip.solver.period_map import MOST_MARCHES, DriftRate, Goal, PeriodicState, PeriodMap
from microslip.solver.periodic import find_periodic_state
from microslip.solver.run import Run, Settings, failed_run
from microslip.solver.simulate import run_of_searches, simulate, step_share
from microslip.states.search import Inertia

MARCHES = 2 * MOST_MARCHES
"""Largest number of marches in a search: twice the default, since the body can oscillate."""
LOOSEST_START = 1e-4
"""Largest tolerance of the state at a prescribed velocity, as a force divided by mu F_z."""
COARSENING, PREPARED_FROM = 6, 96
"""A run with at least PREPARED_FROM steps starts from a run with COARSENING times fewer steps.
Runs with fewer steps are cheap and start directly; they suffice for a tolerance of 1e-3."""
MOST_SCALED = 4.0
"""Largest factor by which the initial tractions are scaled to match the prescribed force."""


CAUTION = 0.3
"""Largest ratio of the effective stiffness of a soft spring to that of the contact.  With a larger
ratio, the search would overshoot."""


class Accuracy(NamedTuple):
    """Accuracy of the periodic state.

    Attributes
    ----------
    tolerance : float
        Tolerance of the result: for a spring a force divided by mu F_z, otherwise the mean
        velocity.
    slope : float
        Approximate derivative, with respect to the velocity, of the friction force divided by mu
        times the mean normal load.  It converts an unbalanced force to an error of the velocity.
    """

    tolerance: float
    slope: float = np.inf


def simulate_driven(
    problem: Problem,
    model: str,
    resolution: Resolution,
    accuracy: Accuracy,
    settings: Settings,
    *,
    guess: Run | None = None,
) -> Run:
    """Run a model of a driven contact to its periodic state.

    Parameters
    ----------
    problem : problem.Problem
        The problem with a drive.  The problem's velocity is that of the spring's far end.  Under a
        prescribed force, the velocity is an initial guess.
    model : str
        Name in models.registry.MODELS of a model that supports drives.
    resolution : discretise.Resolution
        Resolution of the model.
    accuracy : Accuracy
        Accuracy of the periodic state.
    settings : run.Settings
        Settings of the run; only the integrator of the method is used.
    guess : run.Run or None
        Run of the same point under the same drive.  It is used if it has the same numbers of cells
        and angles.

    Returns
    -------
    run.Run
        The run.  Under a prescribed force, the result is `velocity`, and `distance` and
        `solver_residual` are velocities.  No exception is raised if the run does not converge.

    Raises
    ------
    budget.Spent
        If the budget is exceeded.
    """
    search = _DrivenSearch(problem, model, resolution, settings)
    search.slope = accuracy.slope
    try:
        return search.run(accuracy.tolerance * search.force_of_answer, guess)
    except StepFailure as failure:
        return failed_run(str(failure))


class _DrivenSearch:
    """Search for the periodic state of one run of a driven contact."""

    def __init__(self, problem: Problem, model: str, resolution: Resolution, settings: Settings):
        drive = problem.drive
        assert drive is not None  # required by simulate_driven
        self.problem, self.drive, self.model = problem, drive, model
        self.resolution, self.settings = resolution, settings
        # or a contact that counts its marches
        self.contact = cast(SystemContact, settings.contact(problem, model, resolution))
        self.path = path_of(problem, self.contact, resolution.steps, settings.method.integrator)
        self.interval = self.path.phase[-1] - self.path.phase[0]
        load = -drive.damping * problem.drift
        if drive.force is not None:
            load += drive.force * problem.mean_load
        self.body = Body(drive.stiffness, drive.damping, drive.mass, load)
        self.slope = np.inf
        self.earlier: list[Run] = []

    @property
    def force_of_answer(self) -> float:
        """Force, divided by mu F_z, that corresponds to an error of 1 in the result.

        For a spring, the result is a force.  For a prescribed force, the result is a velocity, and
        there are two estimates.  The first divides the force by the stiffness and by the length of
        the interval.  The second divides the unbalanced force by the rise of friction with the
        velocity.  The smaller force is used.
        """
        if self.drive.force is None:
            return self.problem.mean_load
        unit = self.problem.unit_drift
        stuck = self.contact.stiffness * self.interval * unit
        return min(stuck, self.slope * self.problem.mean_load)

    def run(self, tolerance: float, guess: Run | None = None) -> Run:
        """Run the search to a tolerance given as a force divided by mu F_z; see simulate_driven."""
        rate = self.contact.stiffness * self.problem.drift
        step_tolerance = tolerance * step_share(rate, self.resolution.steps, False)
        goal, searches = Goal(tolerance, step_tolerance, MARCHES), []
        for start, static_force, mu in self._starts(tolerance, guess):
            period_map = self._map(static_force, rate, mu)
            if not self._fits(start, period_map):
                continue
            searches.append(find_periodic_state(period_map, start, goal))
            if searches[-1].converged:
                break
        return self._summary(searches, static_force, step_tolerance)

    def _map(self, static_force: float, rate: float, mu: float) -> DrivenMap:
        drift_rate, slope, full = None, np.inf, self.problem.mean_load
        if self.drive.force is None:
            drift_rate = DriftRate(static_force, full, rate * self.interval)
            # 1 - mu decreases at most as fast as 1 / velocity^2, the rate at large velocities
            slope = 2.0 * (1.0 - mu) * full / (self.problem.drift * self.interval)
        mirror = self.problem.half_period_mirror
        return DrivenMap(self.contact, self.path, self.body, drift_rate, mirror, slope)

    def _fits(self, start: np.ndarray, period_map: DrivenMap) -> bool:
        return start.shape == period_map.state(forward_slip(self.contact), np.zeros(2)).shape

    def _starts(
        self, tolerance: float, guess: Run | None
    ) -> Iterator[tuple[np.ndarray, float, float]]:
        """Initial states, best first, each with the static limit's force and a friction value."""
        if guess is not None and guess.state is not None and guess.converged:
            yield guess.state, guess.static_force, guess.mu
        if self.resolution.steps >= PREPARED_FROM:
            coarser = self._coarser(tolerance)
            if coarser.state is not None and coarser.converged:
                yield coarser.state, coarser.static_force, coarser.mu
        prescribed = self._at_prescribed_velocity(tolerance)
        self.earlier.append(prescribed)
        slipping = forward_slip(self.contact)
        if prescribed.state is not None:
            state = self._state(prescribed.state, prescribed.mu * self.problem.mean_load)
            yield state, prescribed.static_force, prescribed.mu
        full = float(forces(self.contact, slipping)[FORWARD])
        yield self._state(slipping, full), prescribed.static_force, prescribed.mu

    def _coarser(self, tolerance: float) -> Run:
        """The Run with COARSENING times fewer steps."""
        fewer = replace(self.resolution, steps=self.resolution.steps // COARSENING)
        accuracy = Accuracy(tolerance / self.force_of_answer, self.slope)
        run = simulate_driven(self.problem, self.model, fewer, accuracy, self.settings)
        self.earlier.append(run)
        return run

    def _at_prescribed_velocity(self, tolerance: float) -> Run:
        """The Run without a drive, at the prescribed velocity of the problem."""
        share = max(tolerance, LOOSEST_START) / self.problem.mean_load
        return simulate(self.problem, self.model, self.resolution, share, settings=self.settings)

    def _state(self, tractions: np.ndarray, mean: float) -> np.ndarray:
        """Build a state from tractions whose mean force over a period is about `mean`."""
        if self.drive.force is not None:
            force = self.drive.force * self.problem.mean_load
            if mean > 0.0 and 0.0 <= force < MOST_SCALED * mean:
                tractions = tractions * (force / mean)
            tractions = project(tractions, self.contact.bound)
        place = (self.body.load - mean) / self.drive.stiffness if self.drive.stiffness else 0.0
        place_and_rate = np.array([place, 0.0]) if self.body.remembers else np.zeros(0)
        return np.append(tractions.ravel(), place_and_rate)

    def _summary(
        self, searches: list[PeriodicState], static_force: float, step_tolerance: float
    ) -> Run:
        path = self.path
        run = run_of_searches(
            self.contact,
            self.problem,
            path,
            searches,
            step_tolerance,
            self.force_of_answer,
            static_force=static_force,
        )
        body = searches[-1].body
        assert body is not None  # all driven contacts have one
        drift_rate = float(body[-1, 0] - body[0, 0]) / self.interval
        return replace(
            run,
            periods=run.periods + sum(one.periods for one in self.earlier),
            effort=sum((one.effort for one in self.earlier), run.effort),
            velocity=self.problem.velocity + drift_rate / self.problem.unit_drift,
        )


class DrivenMap(PeriodMap):
    """Map of a state (contact and body) over a path; see period_map.PeriodMap.

    Parameters
    ----------
    contact : SystemContact
        The contact.
    path : path.Path
        Path relative to which the body moves.
    body : driven_body.Body
        The body and its drive.
    drift_rate : period_map.DriftRate or None
        Drift rate of a motion whose velocity is known and can be small; otherwise None.
    mirror : bool
        Whether the second half of the period is the mirror image of the path.
    slope : float
        Largest rise of the mean forward force if the body advances by one unit of x per interval.
    """

    contact: SystemContact

    def __init__(
        self,
        contact: SystemContact,
        path: Path,
        body: Body,
        drift_rate: DriftRate | None = None,
        mirror: bool = True,
        slope: float = np.inf,
    ):
        super().__init__(contact, path, drift_rate, mirror)
        self.body = body
        self._shape = (2, *np.broadcast_shapes(contact.bound.shape, contact.lateral_position.shape))
        self._points = int(np.prod(self._shape))
        spread = np.broadcast_to(contact.bound, self._shape[1:])
        load = float(np.sum(contact.weight * spread))
        # without contact at the start of a period there are no tractions to correct
        self._spread = spread / load if load > 0.0 else 0.0 * spread
        interval, stiffness = path.phase[-1] - path.phase[0], contact.stiffness
        self._mass = min(body.mass, stiffness * interval**2)
        self._stiffness = body.stiffness * min(1.0, body.stiffness / stiffness)
        self._haste = np.ones(2)
        slow = max(1.0, body.damping / (stiffness * interval))
        if body.stiffness > 0.0:
            steepest = min(CAUTION * stiffness, slope)
            self._haste[0] = max(1.0, steepest / body.stiffness * slow)
        if body.mass > 0.0:
            self._haste[1] = max(1.0, body.mass / (self._mass * slow))

    def state(self, tractions: np.ndarray, place_and_rate: np.ndarray) -> np.ndarray:
        """Join tractions and (x, x') into a state array."""
        flat = tractions.ravel()
        return np.append(flat, place_and_rate) if self.body.remembers else flat

    def parts(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Split a state into tractions and (x, x'), or (0, 0) for a body without memory."""
        place_and_rate = state[self._points :] if self.body.remembers else np.zeros(2)
        return state[: self._points].reshape(self._shape), place_and_rate

    def inertia(self) -> Inertia:
        """Stiffness, mass and extrapolation factors of the driven body, for compiled code."""
        return Inertia(
            self.body.along(self.path, np.zeros(2)),
            float(self._haste[0]),
            float(self._haste[1]),
            float(self._stiffness),
            float(self._mass),
            self.contact.layout.pack(self._spread),
        )
