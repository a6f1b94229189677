"""A number as refinement leaves it, with what is known of its error."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from microslip.solver.discretise import Resolution


@dataclass(frozen=True)
class Certified:
    """A number and what is wrong with it at most; forces over mu F_z, or a velocity.

    Attributes
    ----------
    mu, torque : float
        Corrected means; for mu the quantity that was asked for.
    errors : dict of float
        Of mu by source: space, time, periodicity, solver; model, where there are readings.
    torque_error : float
        Of the torque in space, and over the readings.
    finest : problem.Resolution
        Largest resolution used along each axis.
    periods : float
        Of the longest run.
    iterations, work, effort, retried : int
        Of all runs.
    converged : bool
        Whether every run found its periodic state and nothing kept the refinement from going on.
    reason : str
        What is to blame else.
    periodic : bool
        Whether every run found its periodic state.
    """

    mu: float
    torque: float
    errors: dict
    torque_error: float
    finest: Resolution
    periods: float
    iterations: int
    work: int
    effort: int
    retried: int
    converged: bool
    reason: str
    periodic: bool

    @property
    def error(self) -> float:
        return sum(self.errors.values())


def given_up(spent: Exception) -> Certified:
    """The Certified of a point whose budget was spent (budget.Spent) before its first run."""
    certified = nothing(Resolution(0, 0, 0))
    return replace(certified, reason=f"{spent}: no error is known yet")


def nothing(coarsest: Resolution) -> Certified:
    """The Certified of a point of which no error is known yet."""
    errors = dict.fromkeys(("space", "time", "periodicity", "solver"), np.inf)
    none = replace(coarsest, cells=0, angles=0, steps=0)
    return Certified(np.nan, np.nan, errors, np.inf, none, 0.0, 0, 0, 0, 0, False, "", False)
