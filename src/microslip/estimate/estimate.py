"""A quantity with its error estimate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

SOURCES = ("resolution", "periodicity", "solver", "model")
"""Sources of error of an estimate, see refine.py."""


@dataclass(frozen=True)
class Estimate:
    """A quantity with its error estimate.

    Estimates can be added, and multiplied by numbers.  The error of a sum is the sum of the errors
    of its terms, separately for each source.

    Attributes
    ----------
    value : float
        The quantity.
    by_source : mapping of float
        Error estimate by source, in the unit of the value; the keys are from SOURCES.  The error of
        a missing source is 0.
    """

    value: float
    by_source: Mapping[str, float] = field(default_factory=dict)

    @property
    def error(self) -> float:
        """Sum of the errors of all sources."""
        return float(sum(self.by_source.values()))

    def __add__(self, other: Estimate) -> Estimate:
        sources = [name for name in SOURCES if name in self.by_source or name in other.by_source]
        errors = {n: self.by_source.get(n, 0.0) + other.by_source.get(n, 0.0) for n in sources}
        return Estimate(self.value + other.value, errors)

    def __rmul__(self, factor: float) -> Estimate:
        errors = {name: abs(factor) * error for name, error in self.by_source.items()}
        return Estimate(factor * self.value, errors)

    def __neg__(self) -> Estimate:
        return Estimate(-self.value, self.by_source)
