"""Effort of runs, and budget of a point: limits on its work and its wall-clock time.

Both limits are checked after every march, so that they also end long searches.  With a limit on the
work, the result is the same on every machine.  The time limit depends on the machine, so a result
that reached the time limit is not stored.  The time that Numba needs to compile or load kernels
does not count, because only the first points of a process need it.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Any

from microslip.contact.contact import Contact, March
from microslip.foundation.errors import SolverError


@dataclass(frozen=True)
class Effort:
    """Computational effort of one or several runs; efforts can be added and subtracted.

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
        """Effort of marches; `unknowns` is the number of unknowns in a step."""
        return Effort(solves, iterations, solves * unknowns, iterations * unknowns)

    def __add__(self, other: Effort) -> Effort:
        return Effort(*(vars(self)[name] + value for name, value in vars(other).items()))

    def __sub__(self, other: Effort) -> Effort:
        return Effort(*(vars(self)[name] - value for name, value in vars(other).items()))


class Spent(SolverError):
    """Raised if the budget of a point is exceeded.  The message, which names the limit, becomes the
    `reason` of the result."""


class Budget:
    """Counter of the effort of a point, with limits.

    Parameters
    ----------
    most_work : float
        Limit on the work of all marches together.  The work of a march is its number of step solves
        times its number of unknowns.
    time_limit : float
        Largest wall-clock time in seconds since the first contact was built, without the time for
        compilation.

    Attributes
    ----------
    taken : Effort
        Effort of all marches so far.
    exhausted : str
        Name of the exceeded limit, "work" or "time", otherwise empty.
    """

    def __init__(self, most_work: float = math.inf, time_limit: float = math.inf):
        self.most_work, self.time_limit = most_work, time_limit
        self.taken = Effort()
        self.exhausted = ""
        self._began: float | None = None

    def renewed(self) -> Budget:
        """A new Budget with the same limits and start time, but without effort."""
        other = Budget(self.most_work, self.time_limit)
        other._began = self._began
        return other

    def metered(self, contact: Contact) -> Contact:
        """Wrap a contact so that its marches are counted, and start the clock."""
        self.start()
        return _Metered(contact, self)

    def start(self) -> None:
        """Start the clock, unless it runs."""
        if self._began is None and self.time_limit < math.inf:
            self._began = _seconds()

    def take(self, effort: Effort) -> None:
        """Count the effort of marches; raises Spent if a limit is exceeded."""
        self.taken += effort
        if self.taken.work > self.most_work:
            self.exhausted = "work"
            raise Spent(f"the work that the point may take, {self.most_work:.3g}, is spent")
        if self._began is not None and _seconds() - self._began > self.time_limit:
            self.exhausted = "time"
            raise Spent(f"the time limit of {self.time_limit:g} s is over")


def _seconds() -> float:
    """Time in seconds on a clock that stands still during compilation."""
    from microslip.foundation.compiled import compile_seconds  # imports Numba

    return time.monotonic() - compile_seconds()


class _Metered:
    """A contact (see contact.Contact) that counts its marches."""

    def __init__(self, contact: Contact, budget: Budget):
        self._contact: Any = contact  # not every contact has every method
        self._budget = budget

    def __getattr__(self, name: str) -> Any:
        return getattr(self._contact, name)

    def march(self, *path: Any, **settings: Any) -> March:
        march = self._contact.march(*path, **settings)
        self._budget.take(Effort.of(march.solves, march.iterations, march.state.size))
        return march
