"""Settings of a run, and its result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from microslip.models.contact import Contact
from microslip.solver.budget import Budget
from microslip.solver.effort import Effort
from microslip.solver.method import SHIPPED, Method

if TYPE_CHECKING:
    from microslip.models.rings.mesh import Focus
    from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, contact_of


@dataclass(frozen=True)
class Settings:
    """How a run is done, whatever it is a run of.

    Attributes
    ----------
    method : method.Method
        How steps are solved and the periodic state is searched for.
    tighter : bool
        Whether to solve the steps of slow motions tighter.
    budget : budget.Budget or None
        What the marches may take, None: whatever they do.
    focus : mesh.Focus or None
        Where rings gather; None: where the motion says that the slip starts.
    """

    method: Method = SHIPPED
    tighter: bool = False
    budget: Budget | None = None
    focus: Focus | None = None

    def contact(
        self, problem: Problem, model: str, resolution: Resolution, focus: Focus | None = None
    ) -> Contact:
        """The contact of a problem with the method's steps, whose marches count."""
        contact = self.method.dressed(contact_of(problem, model, resolution, focus or self.focus))
        return contact if self.budget is None else self.budget.metered(contact)


AS_SHIPPED = Settings()


@dataclass(frozen=True)
class Run:
    """Outcome of one run: forces over their full-slip values, and the effort.

    Where the normal load changes, forces are over mu times its mean.

    Attributes
    ----------
    mu, torque : float
        Mean forward friction and torque.
    distance : float
        Estimated distance from the periodic (steady) state, a force over mu F_z.
    solver_residual : float
        Summed over the last period, a force over mu F_z.
    periods : float
        Full ones that were marched in search of a state that repeats itself, 0 for a steady motion.
    effort : Effort
        Effort of all searches together.
    converged : bool
        Whether the state repeats itself and every step was solved.
    reason : str
        Why it is not converged, else empty.
    state : np.ndarray or None
        For other runs of the point: the periodic tractions.
    static_force : float
        Mean forward force of the static limit, also for other runs; NaN where it is not known.
    velocity : float
        Mean forward velocity, in the unit of the motion, where a force pulls; else NaN.
    power : float
        Mean work of the oscillation in a radian, over u_lim, see power.oscillation_power; NaN where
        that is not told.
    """

    mu: float
    torque: float
    distance: float
    solver_residual: float
    periods: float
    effort: Effort
    converged: bool
    reason: str
    state: np.ndarray | None = None
    static_force: float = np.nan
    velocity: float = np.nan
    power: float = np.nan


def unsolved(residual: float, solves: int, step_tolerance: float) -> str:
    """Why stages are not solved to their tolerance, as one line; "" if they are.

    Parameters
    ----------
    residual : float
        Residual force of the step solver over mu F_z, summed over the stages.
    solves : int
        Number of these stages.
    step_tolerance : float
        Tolerance of each stage, a force over mu F_z.
    """
    if residual <= solves * step_tolerance:
        return ""
    return f"a step was left unsolved: residual {residual:.1e}"


def failed_run(reason: str) -> Run:
    """The Run of a march that could not go on: no number, and why."""
    return Run(np.nan, np.nan, np.inf, np.inf, 0.0, Effort(), False, reason)
