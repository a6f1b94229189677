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

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from microslip.estimate.estimate import Estimate
from microslip.estimate.ladder import LOOSEST, Ladder
from microslip.estimate.richardson import WEIGHTS, extrapolate
from microslip.motions.problem import Problem
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.effort import Effort
from microslip.solver.run import NAMES, Run, failed_run

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
UNKNOWN = Estimate(np.nan, dict.fromkeys(("resolution", "periodicity", "solver"), np.inf))
"""Estimate of an unknown quantity."""


@dataclass(frozen=True)
class Refined:
    """Values of a problem with their error estimates, and the runs behind them.

    Attributes
    ----------
    ladder : ladder.Ladder
        Resolutions of the runs at all levels.
    estimates : dict of str to Estimate
        Extrapolated values of the runs by name, see run.Run.values.
    finest : run.Run
        The finest run.
    resolution : discretise.Resolution
        Resolution of the finest run.
    order : float
        Observed order of convergence; NaN if unknown.
    periods : float
        Number of periods in the longest run.
    effort : Effort
        Effort of all runs.
    reason : str
        Reason why the result is not converged, otherwise empty.
    periodic : bool
        Whether every run found its periodic state.
    """

    ladder: Ladder
    estimates: Mapping[str, Estimate] = field(default_factory=lambda: dict.fromkeys(NAMES, UNKNOWN))
    finest: Run = field(default_factory=lambda: failed_run(""))
    resolution: Resolution = Resolution(0, 0, 0)
    order: float = np.nan
    periods: float = 0.0
    effort: Effort = Effort()
    reason: str = ""
    periodic: bool = False

    @property
    def converged(self) -> bool:
        """Whether every run found its periodic state and nothing ended the refinement early."""
        return not self.reason


def run_tolerance(tolerance: float) -> float:
    """Largest distance of a run from its periodic state."""
    return RUN_SHARE * tolerance


def refine(
    run: Callable[[Problem, Resolution, Run | None], Run],
    ladder: Ladder,
    problems: Sequence[Problem],
    tolerance: float,
    name: str = "friction",
    *,
    energy_unit: float = np.nan,
    drive_work: float = 0.0,
) -> Refined:
    """Refine until the estimated error is within the tolerance.  No run is repeated.

    Parameters
    ----------
    run : callable
        `run(problem, resolution, guess)` returns a run.Run.  `guess` is the run of the first
        problem at half the level or, for another interpolation, at the same level; None if there is
        no such run.
    ladder : Ladder
        Resolutions of the problem.
    problems : sequence of problem.Problem
        The problem, followed by problems that interpolate the same data differently
        (Problem.readings).
    tolerance : float
        Absolute tolerance of the requested value.
    name : str
        Name of the requested value in Run.values.
    energy_unit : float
        Largest error of the dissipated energy for an error of 1 in the requested value.
    drive_work : float
        If the requested value is a velocity: work that the prescribed force does in a period at the
        velocity 1, divided by mu F_z u_lim.

    Returns
    -------
    Refined
        The values.  They are not converged if a run did not converge, if the finest level is not
        fine enough, or if a run raised budget.Spent.  In the last case, the values are the
        estimates before that run, or NaN if there are no such estimates.
    """
    goal, refined = tolerance, None
    runs: dict[tuple[int, int], Run] = {}
    try:
        for level in ladder.levels(tolerance):
            if level < ladder.levels(goal)[0]:
                continue
            places = [(0, level // 4), (0, level // 2), *((k, level) for k in range(len(problems)))]
            for number, at in places:
                if (number, at) not in runs:
                    guess = runs.get((0, at if number else at // 2))
                    runs[number, at] = run(problems[number], ladder.resolution(at), guess)
            estimates, order = _estimates(
                [runs[place] for place in places], ladder, goal, name, energy_unit, drive_work
            )
            reason = next((one.reason for one in runs.values() if one.reason), "")
            refined = Refined(
                ladder,
                estimates,
                runs[0, level],
                ladder.resolution(level),
                order=order,
                periods=max(one.periods for one in runs.values()),
                effort=sum((one.effort for one in runs.values()), Effort()),
                reason=reason,
                periodic=not reason,
            )
            error = estimates[name].error
            rest = error - estimates[name].by_source["resolution"]
            if error <= tolerance or rest > LARGEST_REST * tolerance or ladder.imposed or reason:
                return refined
            goal = tolerance - rest
    except Spent as spent:
        if refined is None:
            return Refined(ladder, reason=f"{spent}: there is no error estimate yet")
        return replace(refined, reason=f"{spent}: the error is still {error:.1e}")
    assert refined is not None  # every ladder has a level
    reason = f"the error is still {error:.1e} with {refined.resolution.cells} cells"
    return replace(refined, reason=reason)


def _estimates(
    runs: Sequence[Run],
    ladder: Ladder,
    goal: float,
    name: str,
    energy_unit: float,
    drive_work: float,
) -> tuple[dict[str, Estimate], float]:
    """Estimates of all values, and the observed order of convergence of the requested one.

    runs: at n/4, n/2 and n, and those of other interpolations at n.  goal: largest accepted
    resolution error of the value `name`.  The other arguments are those of `refine`.
    """
    three, others, imposed = runs[:3], runs[3:], ladder.imposed > 0.0
    base = (0.0, 0.0, 1.0) if imposed else np.abs(WEIGHTS)
    # a run that did not converge has a weight of at least 1, since levels can agree by chance
    weights = [max(w, 1.0) if one.reason else w for w, one in zip(base, three, strict=True)]
    common = {
        "periodicity": _weighted(weights, [one.distance for one in three]),
        "solver": _weighted(weights, [one.residual for one in three]),
    }
    accuracy = ladder.accuracy if imposed else min(goal, LOOSEST)
    estimates: dict[str, Estimate] = {}
    orders: dict[str, float] = {}
    for one in [name, *(other for other in three[-1].values if other != name)]:
        values = [float(run.values.get(one, np.nan)) for run in three]
        limit = extrapolate(values)
        extrapolated, least, unit = float(limit.value), SMALLEST_SHARE * accuracy, 1.0
        if one == "dissipation":
            # the energy of a small cycle (Mindlin) is proportional to the third power of the force,
            # and its upper bound to the force: an error of the force changes the energy by their
            # geometric mean
            unit, dissipated = energy_unit, abs(values[-1])
            scale = max(dissipated, (dissipated * energy_unit) ** 0.5)
            # for a velocity above 1, the tolerance is already proportional to the velocity
            least *= max(scale / max(1.0, abs(estimates[name].value)), drive_work)
        value = values[-1] if imposed else extrapolated
        error = max(float(limit.error), least) + abs(extrapolated - value)
        errors = {"resolution": error} | {source: unit * e for source, e in common.items()}
        if others:
            apart = sum(abs(run.values.get(one, np.nan) - values[-1]) for run in others)
            errors["model"] = READING_SAFETY * apart
        estimates[one], orders[one] = Estimate(value, errors), float(limit.order)
    return estimates, orders[name]


def _weighted(weights: Iterable[float], errors: Iterable[float]) -> float:
    """Weighted sum of errors.  Terms with weight 0 are omitted, because their error can be
    infinite."""
    return float(sum(w * e for w, e in zip(weights, errors, strict=True) if w))
