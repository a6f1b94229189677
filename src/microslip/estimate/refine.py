"""Refinement of a problem until its estimated error is within the tolerance.

The error estimate has four sources:

- resolution: Richardson extrapolation of the runs at n/4, n/2 and n, see richardson.py;
- periodicity, solver: the value is a combination sum c_i f_i of runs, so that their distances d_i
  from the periodic state and the residuals r_i of their steps add up to sum |c_i| (d_i + r_i);
- model: a pressure that is known on a grid alone stands for several pressures; the finest run is
  repeated under each of them, and the differences are an error that no refinement removes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from microslip.estimate.estimate import Estimate
from microslip.estimate.ladder import LOOSEST, Ladder
from microslip.estimate.richardson import WEIGHTS, Extrapolation, extrapolate
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.effort import Effort
from microslip.solver.run import Run

RUN_SHARE = 0.05
"""Largest distance of a run from its periodic state over the tolerance: by the weights of the runs
that takes up to a twelfth of the tolerance."""
READING_SAFETY = 2.5
"""Safety factor on the differences between readings of a pressure: a peak or an edge between the
points of a grid shows in none of them in full."""
SMALLEST_SHARE = 0.7
"""Smallest error estimate by resolution over the tolerance: three levels that agree by chance are
off by up to this.  Calibrated by benchmarks/error_estimates.py."""
LARGEST_REST = 0.5
"""Largest share of the tolerance in the other errors for which finer runs are worth their cost."""


@dataclass(frozen=True)
class Refined:
    """A value with its error estimate; a force over mu F_z, or a velocity.

    Attributes
    ----------
    value : Estimate
        The requested quantity, extrapolated.
    torque : Estimate
        The torque, extrapolated.
    order : float
        Observed order of convergence, NaN where it is not known.
    finest : discretise.Resolution
        Resolution of the finest run.
    periods : float
        Periods of the longest run.
    effort : Effort
        Sum over all runs.
    converged : bool
        Whether every run found its periodic state and nothing ended the refinement early.
    reason : str
        Why it is not converged, else empty.
    periodic : bool
        Whether every run found its periodic state.
    """

    value: Estimate
    torque: Estimate
    order: float
    finest: Resolution
    periods: float
    effort: Effort
    converged: bool
    reason: str
    periodic: bool


UNKNOWN = Estimate(np.nan, dict.fromkeys(("resolution", "periodicity", "solver"), np.inf))
"""The estimate of a quantity of which nothing is known."""


def unknown(reason: str) -> Refined:
    """Result of a problem whose budget ended before the first estimate."""
    none = Resolution(0, 0, 0)
    return Refined(UNKNOWN, UNKNOWN, np.nan, none, 0.0, Effort(), False, reason, False)


def run_tolerance(tolerance: float) -> float:
    """Largest distance of a run from its periodic state."""
    return RUN_SHARE * tolerance


def refine(
    run: Callable[[Resolution, Run | None], Run],
    ladder: Ladder,
    tolerance: float,
    readings: Sequence[Callable] = (),
    quantity: str = "mu",
) -> Refined:
    """Refine until the estimated error is within the tolerance.

    Parameters
    ----------
    run : callable
        run(resolution, guess) -> run.Run; guess: the run at half the level, or None.
    ladder : Ladder
        Resolutions of the problem.
    tolerance : float
        Absolute, on the quantity.
    readings : sequence of callable
        Like `run`, under other pressures that the same numbers may stand for.
    quantity : str
        Attribute of a run.Run: "mu", or "velocity" under a prescribed force.

    Returns
    -------
    Refined
        Not converged, with the reason, where a run did not converge, the levels end, or a run
        raised budget.Spent: then it is the estimate before that run, NaN if there was none.
    """
    levels = _Levels(run, ladder, readings, quantity)
    goal, refined = tolerance, None
    try:
        for level in ladder.levels(tolerance):
            if level < ladder.levels(goal)[0]:
                continue
            refined = levels.estimate(level, goal)
            error = refined.value.error
            rest = error - refined.value.by_source["resolution"]
            if error <= tolerance or rest > LARGEST_REST * tolerance:
                return refined
            if ladder.imposed or not refined.converged:
                return refined
            goal = tolerance - rest
    except Spent as spent:
        if refined is None:
            return unknown(f"{spent}: no error is known yet")
        reason = f"{spent}: the error is still {refined.value.error:.1e}"
        return replace(refined, converged=False, reason=reason)
    assert refined is not None  # as no ladder is without levels
    reason = f"the error is still {refined.value.error:.1e} with {refined.finest.cells} cells"
    return replace(refined, converged=False, reason=reason)


class _Levels:
    """Runs by level, each done once."""

    def __init__(
        self,
        run: Callable[[Resolution, Run | None], Run],
        ladder: Ladder,
        readings: Sequence[Callable],
        quantity: str,
    ):
        self.run, self.ladder, self.readings = run, ladder, readings
        self.read = attrgetter(quantity)
        self.runs: dict[int, Run] = {}
        self.other_runs: dict[tuple[int, int], Run] = {}

    def at(self, level: int) -> Run:
        """Run at a level, started from the one at half the level."""
        if level not in self.runs:
            guess = self.runs.get(level // 2)
            self.runs[level] = self.run(self.ladder.resolution(level), guess)
        return self.runs[level]

    def under_other_readings(self, level: int) -> list[Run]:
        """Runs at a level under the other readings of the pressure."""
        for number, run in enumerate(self.readings):
            if (number, level) not in self.other_runs:
                finest = self.ladder.resolution(level)
                self.other_runs[number, level] = run(finest, self.runs[level])
        return [self.other_runs[number, level] for number in range(len(self.readings))]

    def estimate(self, level: int, goal: float) -> Refined:
        """The Refined with the given finest level, for a resolution error up to the goal."""
        three = [self.at(level // 4), self.at(level // 2), self.at(level)]
        others = self.under_other_readings(level)
        value, errors, order = self._of(self.read, goal, three, others)
        torque, torque_errors, _ = self._of(attrgetter("torque"), goal, three, others)
        base = (0.0, 0.0, 1.0) if self.ladder.imposed else np.abs(WEIGHTS)
        # a run that did not converge has a weight of at least 1: the levels may agree by chance
        weights = [w if one.converged else max(w, 1.0) for w, one in zip(base, three, strict=True)]
        common = {
            "periodicity": _weighted(weights, [one.distance for one in three]),
            "solver": _weighted(weights, [one.solver_residual for one in three]),
        }
        done = [*self.runs.values(), *self.other_runs.values()]
        reason = next((one.reason for one in done if not one.converged), "")
        return Refined(
            value=Estimate(value, errors | common),
            torque=Estimate(torque, torque_errors | common),
            order=order,
            finest=self.ladder.resolution(level),
            periods=max(one.periods for one in done),
            effort=sum((one.effort for one in done), Effort()),
            converged=not reason,
            reason=reason,
            periodic=not reason,
        )

    def _of(
        self, read: Callable[[Run], float], goal: float, three: Sequence[Run], others: Sequence[Run]
    ) -> tuple[float, dict[str, float], float]:
        """Value of a quantity, its errors by resolution and model, and its observed order."""
        values = [float(read(one)) for one in three]
        limit = Extrapolation(*map(float, extrapolate(values)))
        if self.ladder.imposed:
            value, error = values[-1], limit.difference
        else:
            value, error = limit.value, max(limit.error, SMALLEST_SHARE * min(goal, LOOSEST))
        errors = {"resolution": error}
        if others:
            apart = sum(abs(read(one) - values[-1]) for one in others)
            errors["model"] = READING_SAFETY * apart
        return value, errors, limit.order


def _weighted(weights: Iterable[float], errors: Iterable[float]) -> float:
    """Sum of errors times weights; a run without weight does not count, even if its error is
    infinite."""
    return float(sum(w * e for w, e in zip(weights, errors, strict=True) if w))
