"""Refinement of a problem until its estimated error is within the tolerance.

The error estimate has four sources:

- resolution: Richardson extrapolation of the runs at n/4, n/2 and n, see richardson.py.  At an
  imposed resolution, the value is that of the finest run, and its distance from the extrapolated
  value is added;
- periodicity, solver: the value is a combination sum c_i f_i of runs.  Their distances d_i from the
  periodic state and the residuals r_i of their steps contribute sum |c_i| (d_i + r_i);
- model: a pressure on a grid, or a motion given by samples, can be interpolated in several ways.
  The finest run is repeated for each interpolation; refinement does not reduce the differences.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from microslip.estimate.estimate import Estimate
from microslip.estimate.ladder import LOOSEST, Ladder
from microslip.estimate.richardson import WEIGHTS, Extrapolation, extrapolate
from microslip.motions.problem import Problem
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.effort import Effort
from microslip.solver.run import Run

RUN_SHARE = 0.05
"""Largest distance of a run from its periodic state, divided by the tolerance.  Multiplied by the
weights of the runs, it contributes at most a twelfth of the tolerance."""
READING_SAFETY = 2.5
"""Safety factor on the differences between the interpolations (readings) of a pressure or a motion.
No interpolation resolves a peak or an edge between the points."""
SMALLEST_SHARE = 0.7
"""Smallest error estimate for the resolution, divided by the tolerance (at an imposed resolution,
by Ladder.accuracy).  It is above 0 because three levels can agree by chance.  Calibrated by
benchmarks/error_estimates.py."""
LARGEST_REST = 0.5
"""Finer runs are started only if the sum of the other errors is at most this fraction of the
tolerance."""


@dataclass(frozen=True)
class Refined:
    """A value with its error estimate: a force divided by mu F_z, or a velocity.

    Attributes
    ----------
    value : Estimate
        Extrapolated value of the requested quantity.
    torque : Estimate
        Extrapolated torque.
    energy : Estimate
        Extrapolated dissipated energy per period, divided by mu F_z u_lim.
    order : float
        Observed order of convergence; NaN if unknown.
    finest : discretise.Resolution
        Resolution of the finest run.
    periods : float
        Number of periods in the longest run.
    effort : Effort
        Effort of all runs.
    converged : bool
        Whether every run found its periodic state and nothing ended the refinement early.
    reason : str
        Reason why the result is not converged, otherwise empty.
    periodic : bool
        Whether every run found its periodic state.
    ladder : ladder.Ladder
        Resolutions of the runs at all levels.
    """

    value: Estimate
    torque: Estimate
    energy: Estimate
    order: float
    finest: Resolution
    periods: float
    effort: Effort
    converged: bool
    reason: str
    periodic: bool
    ladder: Ladder


UNKNOWN = Estimate(np.nan, dict.fromkeys(("resolution", "periodicity", "solver"), np.inf))
"""Estimate of an unknown quantity."""


def unknown(reason: str, ladder: Ladder) -> Refined:
    """Result of a problem whose budget was exceeded before the first estimate."""
    none = Resolution(0, 0, 0)
    values = UNKNOWN, UNKNOWN, UNKNOWN, np.nan
    return Refined(*values, none, 0.0, Effort(), False, reason, False, ladder)


def run_tolerance(tolerance: float) -> float:
    """Largest distance of a run from its periodic state."""
    return RUN_SHARE * tolerance


class Levels:
    """Runs of a problem at the levels of its ladder.  No run is repeated.

    Parameters
    ----------
    run : callable
        `run(problem, resolution, guess)` returns a run.Run; `guess` is a run that is close, or
        None.
    ladder : Ladder
        Resolutions of the problem.
    *problems : problem.Problem
        The problem, and problems that interpolate the same data differently (Problem.readings).
    """

    def __init__(
        self,
        run: Callable[[Problem, Resolution, Run | None], Run],
        ladder: Ladder,
        *problems: Problem,
    ):
        self.run, self.ladder, self.problems = run, ladder, problems
        self.runs: dict[tuple[int, int], Run] = {}

    def at(self, level: int, number: int = 0) -> Run:
        """The run of the problem with this number at a level.

        Its initial guess is the run at half the level or, for another interpolation, the run of the
        first problem.
        """
        if (number, level) not in self.runs:
            guess = self.runs.get((0, level if number else level // 2))
            resolution = self.ladder.resolution(level)
            self.runs[number, level] = self.run(self.problems[number], resolution, guess)
        return self.runs[number, level]


def refine(
    levels: Levels,
    tolerance: float,
    read: Callable[[Run], float] = attrgetter("mu"),
    *,
    energy_unit: float = np.nan,
    drive_work: float = 0.0,
) -> Refined:
    """Refine until the estimated error is within the tolerance.

    Parameters
    ----------
    levels : Levels
        Runs of the problem.
    tolerance : float
        Absolute tolerance of the quantity.
    read : callable
        `read(run)` returns the quantity.
    energy_unit : float
        Largest error of the dissipated energy for an error of 1 in the quantity.
    drive_work : float
        If the quantity is a velocity: work that the prescribed force does in a period at the
        velocity 1, divided by mu F_z u_lim.

    Returns
    -------
    Refined
        The value.  It is not converged if a run did not converge, if the finest level is not fine
        enough, or if a run raised budget.Spent.  In the last case, the value is the estimate before
        that run, or NaN if there is no such estimate.
    """
    ladder = levels.ladder
    goal, refined = tolerance, None
    try:
        for level in ladder.levels(tolerance):
            if level < ladder.levels(goal)[0]:
                continue
            refined = _estimate(levels, level, goal, read, energy_unit, drive_work)
            error = refined.value.error
            rest = error - refined.value.by_source["resolution"]
            if error <= tolerance or rest > LARGEST_REST * tolerance:
                return refined
            if ladder.imposed or not refined.converged:
                return refined
            goal = tolerance - rest
    except Spent as spent:
        if refined is None:
            return unknown(f"{spent}: there is no error estimate yet", ladder)
        reason = f"{spent}: the error is still {refined.value.error:.1e}"
        return replace(refined, converged=False, reason=reason)
    assert refined is not None  # every ladder has a level
    reason = f"the error is still {refined.value.error:.1e} with {refined.finest.cells} cells"
    return replace(refined, converged=False, reason=reason)


def _estimate(
    levels: Levels,
    level: int,
    goal: float,
    read: Callable[[Run], float],
    energy_unit: float,
    drive_work: float,
) -> Refined:
    """Estimate with `level` as the finest level; goal: largest accepted resolution error."""
    three = [levels.at(level // 4), levels.at(level // 2), levels.at(level)]
    others = [levels.at(level, number) for number in range(1, len(levels.problems))]
    imposed = levels.ladder.imposed > 0.0
    floor = SMALLEST_SHARE * (levels.ladder.accuracy if imposed else min(goal, LOOSEST))
    value, errors, order = _extrapolated(read, imposed, floor, three, others)
    torque, torque_errors, _ = _extrapolated(attrgetter("torque"), imposed, floor, three, others)
    # the energy of a small cycle (Mindlin) is proportional to the third power of the force, and its
    # upper bound to the force: an error of the force changes the energy by their geometric mean
    dissipated = abs(three[-1].energy)
    scale = max(dissipated, (dissipated * energy_unit) ** 0.5)
    # for a velocity above 1, the tolerance is already proportional to the velocity
    floor *= max(scale / max(1.0, abs(value)), drive_work)
    energy, energy_errors, _ = _extrapolated(attrgetter("energy"), imposed, floor, three, others)
    base = (0.0, 0.0, 1.0) if imposed else np.abs(WEIGHTS)
    # a run that did not converge has a weight of at least 1, since levels can agree by chance
    weights = [w if one.converged else max(w, 1.0) for w, one in zip(base, three, strict=True)]
    common = {
        "periodicity": _weighted(weights, [one.distance for one in three]),
        "solver": _weighted(weights, [one.solver_residual for one in three]),
    }
    runs = levels.runs.values()
    reason = next((one.reason for one in runs if not one.converged), "")
    return Refined(
        value=Estimate(value, errors | common),
        torque=Estimate(torque, torque_errors | common),
        energy=Estimate(energy, energy_errors) + energy_unit * Estimate(0.0, common),
        order=order,
        finest=levels.ladder.resolution(level),
        periods=max(one.periods for one in runs),
        effort=sum((one.effort for one in runs), Effort()),
        converged=not reason,
        reason=reason,
        periodic=not reason,
        ladder=levels.ladder,
    )


def _extrapolated(
    read: Callable[[Run], float],
    imposed: bool,
    floor: float,
    three: Sequence[Run],
    others: Sequence[Run],
) -> tuple[float, dict[str, float], float]:
    """Value of a quantity, resolution and model errors, and observed order of convergence.

    imposed: whether the resolution is imposed; floor: smallest resolution error.
    """
    values = [float(read(one)) for one in three]
    limit = Extrapolation(*map(float, extrapolate(values)))
    value = values[-1] if imposed else limit.value
    errors = {"resolution": max(limit.error, floor) + abs(limit.value - value)}
    if others:
        apart = sum(abs(read(one) - values[-1]) for one in others)
        errors["model"] = READING_SAFETY * apart
    return value, errors, limit.order


def _weighted(weights: Iterable[float], errors: Iterable[float]) -> float:
    """Weighted sum of errors.  Terms with weight 0 are omitted, because their error can be
    infinite."""
    return float(sum(w * e for w, e in zip(weights, errors, strict=True) if w))
