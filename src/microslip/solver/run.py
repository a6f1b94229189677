"""Settings and result of a run."""

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
    """Settings of a run that do not depend on the problem.

    Attributes
    ----------
    method : method.Method
        Method, which contains the step solver and the search for the periodic state.
    tighter : bool
        Whether the steps of slow motions are solved to a smaller tolerance.
    budget : budget.Budget or None
        Budget of the marches.  None means unlimited.
    focus : mesh.Focus or None
        Grading of the rings.  By default, they are graded towards the radius at which slip starts.
    """

    method: Method = SHIPPED
    tighter: bool = False
    budget: Budget | None = None
    focus: Focus | None = None

    def contact(
        self, problem: Problem, model: str, resolution: Resolution, focus: Focus | None = None
    ) -> Contact:
        """Build a contact with the method's step solver.  The contact counts its marches."""
        contact = self.method.dressed(contact_of(problem, model, resolution, focus or self.focus))
        return contact if self.budget is None else self.budget.metered(contact)


AS_SHIPPED = Settings()


@dataclass(frozen=True)
class Run:
    """Result of one run: forces divided by their full-slip values, and the effort.

    If the normal load oscillates, forces are divided by mu times the mean load.

    Attributes
    ----------
    mu, torque : float
        Mean forward friction and torque.
    distance : float
        Estimated distance from the periodic (or steady) state, as a force divided by mu F_z.
    solver_residual : float
        Residual of the step solver summed over the last period, as a force divided by mu F_z.
    periods : float
        Number of full periods marched in the search for the periodic state; 0 for a steady motion.
    effort : Effort
        Effort of all searches.
    converged : bool
        Whether the state is periodic (or steady) and every step was solved.
    reason : str
        Reason why the run is not converged, otherwise empty.
    state : np.ndarray or None
        Periodic or steady tractions, used by other runs as an initial guess; None if unknown.
    static_force : float
        Mean forward force of the static limit, also used by other runs; NaN if unknown.
    velocity : float
        Mean forward velocity under a prescribed force, in the unit of the motion; otherwise NaN.
    energy : float
        Energy that friction dissipates in a period, divided by mu F_z u_lim, see
        means.dissipated_energy; NaN if not computed.
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
    energy: float = np.nan


def unsolved(residual: float, solves: int, step_tolerance: float) -> str:
    """Reason why the stages are not solved to their tolerance, otherwise empty.

    Parameters
    ----------
    residual : float
        Residual of the step solver summed over the stages, as a force divided by mu F_z.
    solves : int
        Number of stages.
    step_tolerance : float
        Tolerance of each stage, as a force divided by mu F_z.
    """
    if residual <= solves * step_tolerance:
        return ""
    return f"a step was left unsolved: residual {residual:.1e}"


def failed_run(reason: str) -> Run:
    """The Run for a failed march.  Its numbers are NaN or infinite."""
    return Run(np.nan, np.nan, np.inf, np.inf, 0.0, Effort(), False, reason)
