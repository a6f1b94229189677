"""Settings, effort and result of a run, and the budget of a point.

A run is one simulation at one resolution. A march is one time integration over a period or half a
period.  The budget limits the work and the wall-clock time of a point.  Both limits are checked
after every march.  Therefore, the limits can also end a single long search.  With a limit on the
work, the result is the same on every machine.  The time limit depends on the machine, so a result
that reached the time limit is not stored.  The time limit does not include the time that Numba
needs to compile or load kernels.  Only the first points of a process need this time.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from operator import add
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.foundation.errors import SolverError
from microslip.periodic.method import OWN, Method
from microslip.periodic.methods import SHIPPED

if TYPE_CHECKING:
    from microslip.contact.rings import Focus


class Effort(NamedTuple):
    """Computational effort of one or several runs. Efforts can be added.

    Attributes
    ----------
    solves : int
        Number of step solves.
    iterations : int
        Number of iterations of the step solver.
    work : int
        Number of step solves times number of unknowns.
    updates : int
        Number of iterations times number of unknowns.
    retried : int
        Number of runs that did not converge at first and had a second attempt.
    """

    solves: int = 0
    iterations: int = 0
    work: int = 0
    updates: int = 0
    retried: int = 0

    @staticmethod
    def of(solves: int, iterations: int, unknowns: int) -> Effort:
        """Return the effort of marches.  `unknowns` is the number of unknowns in a step."""
        return Effort(solves, iterations, solves * unknowns, iterations * unknowns)

    def __add__(self, other: Effort) -> Effort:  # type: ignore[override]
        return Effort(*map(add, self, other))


class Spent(SolverError):
    """Raised if the budget of a point is exceeded.  The message, which names the limit, becomes the
    `reason` of the result."""


@dataclass
class Budget:
    """Counter of the effort of a point, with limits.

    Parameters
    ----------
    most_work : float
        Limit on the work of all marches together.  The work of a march is its number of step solves
        times its number of unknowns.
    time_limit : float
        Largest wall-clock time in seconds since the first call of `take`, without the time for
        compilation.

    Attributes
    ----------
    taken : Effort
        Effort of all marches so far.
    exhausted : str
        Name of the exceeded limit, "work" or "time", otherwise empty.
    began : float or None
        Time of the first call of `take`.
    """

    most_work: float = math.inf
    time_limit: float = math.inf
    taken: Effort = Effort()
    exhausted: str = ""
    began: float | None = None

    def take(
        self, solves: int = 0, iterations: int = 0, unknowns: int = 0, *, next_work: int = 0
    ) -> None:
        """Count the effort of marches.  `unknowns` is the number of unknowns in a step.

        Raises Spent if a limit is exceeded, or if the next march would exceed the limit on the
        work.  The next march is checked in advance because a fine mesh takes long to build.
        """
        taken = self.taken
        self.taken = Effort(
            taken.solves + solves,
            taken.iterations + iterations,
            taken.work + solves * unknowns,
            taken.updates + iterations * unknowns,
            taken.retried,
        )
        if self.taken.work + next_work > self.most_work:
            self.exhausted = "work"
            raise Spent(f"the work that the point may take, {self.most_work:.3g}, is spent")
        if self.time_limit < math.inf:
            from microslip.foundation.compiled import compile_seconds  # imports Numba

            now = time.monotonic() - compile_seconds()
            self.began = now if self.began is None else self.began
            if now - self.began > self.time_limit:
                self.exhausted = "time"
                raise Spent(f"the time limit of {self.time_limit:g} s is over")


STEP_SHARE = 1e-2
"""Largest ratio of the step tolerance to the tolerance of the periodic state."""
SLOW_STEP_SHARE = 3e-4
"""Smallest ratio of the step tolerance to the tolerance of the periodic state.  Slow motions have
long transients, in which the errors in the steps accumulate."""
TIGHTER = 0.1
"""The step tolerance in a second attempt is at least this fraction of the step tolerance in the
first attempt."""
MARCH_SHARE = 0.16
"""Largest sum of the step tolerances in half a period, divided by the tolerance of the periodic
state.  With two stages per step, the residuals add up to at most a third of the tolerance."""
NAMES = ("friction", "torque", "dissipation", "velocity", "displacement")
"""Names of those values of a run for which error estimates exist."""


@dataclass(frozen=True)
class Settings:
    """Settings of a run that do not depend on the problem.

    Attributes
    ----------
    method : method.Method
        Method, which contains the step solver and the search for the periodic state.
    tighter : bool
        Whether the steps of slow motions are solved to a smaller tolerance.
    budget : run.Budget
        Budget of the marches, by default unlimited.
    focus : rings.Focus or None
        Grading of the rings.  By default, they are graded towards the radius at which slip starts.
    slope : float
        Rise of the friction with the velocity, for contacts under a prescribed force.  It converts
        an unbalanced force, divided by mu times the mean normal load, to an error of the velocity.
    """

    method: Method = OWN[SHIPPED]
    tighter: bool = False
    budget: Budget = field(default_factory=Budget)
    focus: Focus | None = None
    slope: float = np.inf


AS_SHIPPED = Settings()


@dataclass(frozen=True)
class Run:
    """Result of one run.

    Attributes
    ----------
    values : mapping of str to float
        Values by name.  All runs except runs to rest have `friction`, the mean forward force
        divided by mu times the mean normal load.  Further values are `torque` (of a steady
        motion, divided by its full-slip value), `dissipation` (energy per period, divided by mu F_z
        u_lim), `velocity` (mean forward velocity of a driven contact), and, for runs to rest, those
        listed in rest.py.
    distance : float
        Estimated distance from the periodic (or steady) state, in the unit of the result.
    residual : float
        Residual of the step solver summed over the last period, in the unit of the result.
    periods : float
        Number of full periods in the search for the periodic state; 0 for a steady motion.
    effort : Effort
        Effort of all searches.
    reason : str
        Reason why the state is not periodic (or steady) or a step was not solved, otherwise empty.
    state : np.ndarray or None
        Periodic or steady tractions, used by other runs as an initial guess; None if unknown.
    place : np.ndarray, shape (2,)
        Position x and rate x' of a driven body at the start of a period, see contact/march.py.
    static_force : float
        Mean forward force of the static limit, also used by other runs; NaN if unknown.
    limit : np.ndarray or None
        Tractions in the static limit, for a motion along a line; None if they are unknown.
    """

    values: Mapping[str, float]
    distance: float
    residual: float
    periods: float = 0.0
    effort: Effort = Effort()
    reason: str = ""
    state: np.ndarray | None = None
    place: np.ndarray = field(default_factory=lambda: np.zeros(2))
    static_force: float = np.nan
    limit: np.ndarray | None = None

    @property
    def converged(self) -> bool:
        """True if the state is periodic (or steady) and every step was solved."""
        return not self.reason

    @property
    def mu(self) -> float:
        """The entry `friction` of `values`."""
        return self.values["friction"]


def unsolved(steps: Any, tolerance: float) -> str:
    """Return the reason why the stages are not solved to their tolerance, or "" if they are solved.

    Parameters
    ----------
    steps : March, or another object with the same attributes
        The attribute `residual` is the residual of the step solver summed over the stages, as a
        force divided by mu F_z.  The attribute `solves` is the number of stages.
    tolerance : float
        Tolerance of each stage, as a force divided by mu F_z.
    """
    if steps.residual <= steps.solves * tolerance:
        return ""
    return f"a step was left unsolved: residual {steps.residual:.1e}"


def failed_run(reason: str) -> Run:
    """Create the `Run` of a failed march.  The values of this run are NaN, and the errors are
    infinite."""
    return Run(dict.fromkeys(NAMES, np.nan), np.inf, np.inf, reason=reason)
