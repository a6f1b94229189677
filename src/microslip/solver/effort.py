"""The effort of runs, which adds up."""

from __future__ import annotations

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Effort:
    """The effort of a run or of several, which adds up.

    Attributes
    ----------
    solves : int
        Step solves.
    iterations : int
        Iterations of the step solver.
    work : int
        Step solves times unknowns.
    updates : int
        Iterations times unknowns.
    retried : int
        Number of runs that found no periodic state at first and were repeated with safer steps.
    """

    solves: int = 0
    iterations: int = 0
    work: int = 0
    updates: int = 0
    retried: int = 0

    @staticmethod
    def of(solves: int, iterations: int, unknowns: int) -> Effort:
        """The effort of marches with so many unknowns in a step."""
        return Effort(solves, iterations, solves * unknowns, iterations * unknowns)

    def __add__(self, other: Effort) -> Effort:
        names = [one.name for one in fields(self)]
        return Effort(*(getattr(self, name) + getattr(other, name) for name in names))
