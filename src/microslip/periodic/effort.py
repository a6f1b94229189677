"""Computational effort of runs."""

from __future__ import annotations

from dataclasses import dataclass


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
