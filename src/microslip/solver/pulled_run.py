"""One run at one resolution of a contact that a force or a spring pulls.

It begins with the contact moved at a given velocity, whose tractions are near: that of the spring's
far end, or under a force one that is about as slow.  From there an accelerated search goes on.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.models.contact import StepFailure
from microslip.models.coulomb import project
from microslip.models.pull import Body
from microslip.motions.drive import Drive
from microslip.solver import anderson
from microslip.solver.period_map import MOST_MARCHES, CreepRate, Goal
from microslip.solver.problem import Problem, Resolution
from microslip.solver.pulled_map import PulledMap
from microslip.solver.run import Run, Settings, failed_run
from microslip.solver.simulate import mean_forces, periods_of, simulate, step_share

MARCHES = 2 * MOST_MARCHES
"""Of a search: a body may swing."""
MOST_SCALED = 4.0
"""By how much the tractions of a contact that is moved are scaled to the force at most."""


class Accuracy(NamedTuple):
    """How exactly the periodic state is to be found.

    Attributes
    ----------
    tolerance : float
        Of the answer: a force over mu F_z, or under a force the mean velocity.
    slope : float
        About how much friction rises with the velocity, over mu times the mean normal load: what
        an unbalanced force does to the velocity.
    """

    tolerance: float
    slope: float = np.inf


def simulate_pulled(
    problem: Problem,
    drive: Drive,
    model: str,
    resolution: Resolution,
    accuracy: Accuracy,
    settings: Settings,
) -> Run:
    """Run a model of a contact that is pulled to its periodic state.

    Parameters
    ----------
    problem : problem.Problem
        Its velocity is that of the spring's far end, or a guess of the one to be found.
    drive : drive.Drive
        What pulls.
    model : str
        Name in models.registry.MODELS, of a contact that may be pulled.
    resolution : problem.Resolution
        Of the model.
    accuracy : Accuracy
        Of the periodic state.
    settings : run.Settings
        How it is done; the method is what ships.

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
    pulled = _Pulled(problem, drive, model, resolution, settings)
    pulled.slope = accuracy.slope
    try:
        return pulled.run(accuracy.tolerance * pulled.force_of_answer)
    except (StepFailure, ArithmeticError, np.linalg.LinAlgError) as failure:
        return failed_run(str(failure))


class _Pulled:
    """The search for the periodic state of one run."""

    def __init__(self, problem, drive, model, resolution, settings):
        self.problem, self.drive, self.model = problem, drive, model
        self.resolution, self.settings = resolution, settings
        self.contact = settings.contact(problem, model, resolution)
        self.path = problem.path(self.contact, resolution.steps, settings.method.integrator)
        self.interval = self.path.phase[-1] - self.path.phase[0]
        load = -drive.damping * problem.creep
        if drive.force is not None:
            load += drive.force * problem.mean_load
        self.body = Body(drive.stiffness, drive.damping, drive.mass, load)
        self.slope = np.inf

    @property
    def force_of_answer(self):
        """Force over mu F_z that stands for a unit of the answer, to judge states by.

        A state that is wrong by a force is wrong by that over the stiffness in its displacement,
        and a march that began with it, in the velocity by this over the interval.  A force that is
        not balanced is wrong by what friction would rise by in the velocity.
        """
        if self.drive.force is None:
            return self.problem.mean_load
        unit = self.problem.motion.creep(1.0, self.problem.amplitude, self.problem.poisson)
        stuck = self.contact.stiffness * self.interval * unit
        return min(stuck, self.slope * self.problem.mean_load)

    def run(self, tolerance):
        """The Run, to a tolerance that is a force over mu F_z."""
        moved = self._moved(tolerance)
        rate = self.contact.stiffness * self.problem.creep
        step_tolerance = tolerance * step_share(rate, self.resolution.steps, False)
        creep_rate = None
        if self.drive.force is None:
            creep_rate = CreepRate(moved.static_force, rate * self.interval)
        mirror = self.problem.motion.half_period_mirror
        period_map = PulledMap(self.contact, self.path, self.body, creep_rate, mirror)
        goal = Goal(tolerance, step_tolerance, MARCHES)
        found = anderson.search(period_map, self._start(moved, period_map), goal)
        return self._summary(found, moved, step_tolerance)

    def _moved(self, tolerance):
        """The Run at a velocity that is given."""
        share = max(tolerance, 1e-4) / self.problem.mean_load
        return simulate(self.problem, self.model, self.resolution, share, settings=self.settings)

    def _start(self, moved, period_map):
        """State near that of the contact that is moved."""
        tractions, mean = moved.state, moved.mu * self.problem.mean_load
        if self.drive.force is not None:
            wanted = self.drive.force * self.problem.mean_load
            if mean > 0.0 and 0.0 <= wanted < MOST_SCALED * mean:
                tractions = tractions * (wanted / mean)
            tractions = project(tractions, self.contact.bound)
        place = (self.body.load - mean) / self.drive.stiffness if self.drive.stiffness else 0.0
        return period_map.state(tractions, np.array([place, 0.0]))

    def _summary(self, found, moved, step_tolerance):
        problem, unit = self.problem, self.force_of_answer
        forward, _, torque = mean_forces(self.contact, problem, self.path, found.forces)
        stages = self.path.stages.shape[0] * self.path.stages.shape[1]
        solved = found.solver_residual <= stages * step_tolerance
        periods, reason = periods_of(found.marches, problem.motion), ""
        if not found.converged:
            reason = f"no periodic state within {periods:g} periods: {found.distance:.1e} left"
        elif not solved:
            reason = f"a step was left unsolved: residual {found.solver_residual:.1e}"
        ahead = float(found.body[-1, 0] - found.body[0, 0]) / self.interval
        creep = problem.motion.creep(1.0, problem.amplitude, problem.poisson)
        return Run(
            mu=float(forward) / problem.mean_load,
            torque=float(torque) / problem.motion.pressure.torque,
            distance=found.distance / unit,
            solver_residual=found.solver_residual / unit,
            periods=periods + moved.periods,
            iterations=found.iterations + moved.iterations,
            solves=found.solves + moved.solves,
            work=found.solves * found.start.size + moved.work,
            effort=found.iterations * found.start.size + moved.effort,
            converged=found.converged and solved,
            reason=reason,
            velocity=problem.velocity + ahead / creep,
            retried=moved.retried,
        )
