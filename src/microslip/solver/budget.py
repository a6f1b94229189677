"""Budget of a point: a bound on its work, the same on every machine, and one on its time.

Both are looked at after every march, wherever it belongs to, so that no search, however long, goes
on beyond them.  What the work allows follows from the request alone; what the time allows depends
on the machine, and no such answer may be kept as that of the request.
"""

from __future__ import annotations

import math
import time
from typing import Any

from microslip.foundation.errors import SolverError
from microslip.models.contact import Contact, March
from microslip.solver.effort import Effort


class Spent(SolverError):
    """A point has taken what it may.  The message says of what, for the reason of its result."""


class Budget:
    """Counts what the marches of a point take.

    Parameters
    ----------
    most_work : float
        Step solves times unknowns, of all marches together.
    time_limit : float
        Seconds by the wall clock, from now on.

    Attributes
    ----------
    taken : Effort
        Effort so far.
    exhausted : str
        The bound that was crossed: "work" or "time", empty as long as none is.
    """

    def __init__(self, most_work: float = math.inf, time_limit: float = math.inf):
        self.most_work, self.time_limit = most_work, time_limit
        self.taken = Effort()
        self.exhausted = ""
        self._began = time.monotonic()

    def renewed(self) -> Budget:
        """Another one that may take as much work; the time goes on from where this one began."""
        other = Budget(self.most_work, self.time_limit)
        other._began = self._began
        return other

    def metered(self, contact: Contact) -> Contact:
        """The contact, whose marches count from now on."""
        return _Metered(contact, self)

    def take(self, solves: int, iterations: int, unknowns: int) -> None:
        """Count a march; raises Spent where that was too much.

        Parameters
        ----------
        solves, iterations : int
            Step solves and step-solver iterations of the march.
        unknowns : int
            Number of unknowns of each step.
        """
        self.taken += Effort.of(solves, iterations, unknowns)
        if self.taken.work > self.most_work:
            self.exhausted = "work"
            raise Spent(f"the work that the point may take, {self.most_work:.3g}, is spent")
        if time.monotonic() - self._began > self.time_limit:
            self.exhausted = "time"
            raise Spent(f"the time limit of {self.time_limit:g} s is over")


class _Metered:
    """A contact (see models.contact.Contact) that counts its marches."""

    def __init__(self, contact: Contact, budget: Budget):
        self._contact: Any = contact  # which may have methods that not all have
        self._budget = budget

    def __getattr__(self, name: str) -> Any:
        return getattr(self._contact, name)

    def march(self, *path: Any, **settings: Any) -> March:
        return self._taken(self._contact.march(*path, **settings))

    def affordable(self, work: float) -> float:
        """Marches of so much work until the budget has to be looked at."""
        budget = self._budget
        if budget.time_limit < math.inf:
            return 1
        return max((budget.most_work - budget.taken.work) // work + 1, 1)

    def take(self, solves: int, iterations: int, unknowns: int) -> None:
        """Count marches that compiled code has done."""
        self._budget.take(solves, iterations, unknowns)

    def _taken(self, march: March) -> March:
        self._budget.take(march.solves, march.iterations, march.state.size)
        return march
