"""Refine the solution of a problem until its estimated error is within the tolerance.

The error estimate has four sources:

- resolution: Richardson extrapolation of the runs at n/4, n/2 and n.  At an imposed resolution, the
  value is that of the finest run, and its difference from the extrapolated value is added to the
  error;
- periodicity, solver: the value is a linear combination sum c_i f_i of the values of the runs.  The
  distances d_i of the runs from the periodic state and the residuals r_i of their steps contribute
  sum |c_i| (d_i + r_i);
- model: a pressure on a grid, or a motion given by samples, can be interpolated in several ways.
  The finest run is repeated for each interpolation; refinement does not reduce the differences.

The methods are of second order, so that f(n) is approximately f + C / n^2.  The difference D of the
last two levels therefore gives the correction D / 3.  Assume that the differences decrease with
another order p.  The differences beyond the last level then add up to D / (2^p - 1).  Therefore,
the error of the extrapolated value is D (1 / (2^p - 1) - 1 / 3).  The error estimate is this error
at the observed order, multiplied by a safety factor.  The safety factor multiplies both the
correction and D.  The estimate lies between these two products.

Two levels can agree by chance.  Therefore D is at least a quarter of the difference of the first
two levels.  At second order, D is expected to equal a quarter of this difference.  This is the grid
convergence index of Roache (J. Fluids Eng. 116, 1994), applied to both pairs of levels.  In two
cases, the last two levels are taken to agree by chance: the differences change sign, or the
observed order is far above 2.  In these two cases, the last level need not be better than the
second-to-last level.  Therefore, D is the difference of the first two levels.

If the differences increase, n/4 is too coarse for the leading term to dominate.  A slightly finer
level is probably too coarse as well.  The next level n is therefore chosen such that runs at the
levels n/2 and n/4 already exist.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import repeat
from typing import Any, NamedTuple

import numpy as np

from microslip.answer.answer import UNKNOWN, Answer, Estimate
from microslip.answer.ladder import LOOSEST, ORDER, Ladder
from microslip.periodic.discretise import Resolution
from microslip.periodic.run import NAMES, Effort, Run, Spent
from microslip.scene.problem import Problem

SAFETY = 1.5
"""Safety factor on the correction.  The value is calibrated by
`benchmarks/error_estimates.py --seed 3 --safety FACTOR`."""
CHANCE_ORDER = 2 * ORDER
"""If the observed order is above this value, the agreement of the last two levels counts as chance.
Above this order, D increases linearly as the last difference decreases.  If the last two levels are
equal, D equals the first difference.  `benchmarks/attacks.py` searches for points where this rule
fails."""
WEIGHTS = 0.0, -1.0 / (2**ORDER - 1), 2**ORDER / (2**ORDER - 1)
"""Weights of the levels n/4, n/2 and n in the extrapolated value."""
READING_SAFETY = 2.5
"""A pressure or a motion from data can be interpolated in several ways (readings).  The differences
between the results are multiplied by this safety factor.  No interpolation resolves a peak or an
edge between the points."""
SMALLEST_SHARE = 0.8
"""The error estimate for the resolution is at least this fraction of the tolerance.  At an imposed
resolution, the attribute `accuracy` of the ladder replaces the tolerance.  The fraction is above 0
because three levels can agree by chance.  The calibration by benchmarks/error_estimates.py gave
0.7.  The value was then increased, because benchmarks/attacks.py found errors of up to 0.75 times
the tolerance at points where the levels agree."""
LARGEST_REST = 0.5
"""Finer runs reduce only the error due to the resolution.  Finer runs are started only if the sum
of all other errors is at most this fraction of the tolerance."""


class Extrapolation(NamedTuple):
    """Extrapolated limit of a sequence of levels.  Arrays are extrapolated element by element.

    Attributes
    ----------
    value : float or np.ndarray
        Limit at infinite n.
    error : float or np.ndarray
        Estimated error of the limit.
    order : float or np.ndarray
        Observed order of convergence.  It is infinite if the last two levels agree, and NaN if all
        three agree.
    """

    value: Any
    error: Any
    order: Any


def extrapolate(values: Sequence[Any] | np.ndarray) -> Extrapolation:
    """Apply Richardson extrapolation to the values at the levels n/4, n/2 and n."""
    coarse, middle, fine = values
    first, second = middle - coarse, fine - middle
    before, last = np.abs(first), np.abs(second)
    chance = before - 2.0**CHANCE_ORDER * (1.0 - 2.0**-ORDER) * last
    least = np.where(first * second < 0.0, before, np.maximum(chance, before / 2**ORDER))
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log2(np.divide(before, last))
        beyond = np.where(order > 0.0, 1.0 / (2.0**order - 1.0), np.inf)
    correction = 1.0 / (2**ORDER - 1)
    share = np.minimum(np.maximum(beyond - correction, correction), 1.0)
    error = SAFETY * share * np.maximum(last, least)
    value = WEIGHTS[0] * coarse + WEIGHTS[1] * middle + WEIGHTS[2] * fine
    return Extrapolation(value, error, order)


def refine(
    run: Callable[[Problem, Resolution, Run | None], Run],
    ladder: Ladder,
    problems: Sequence[Problem],
    tolerance: float,
    name: str = "friction",
    *,
    energy_unit: float = np.nan,
    drive_work: float = 0.0,
) -> Answer:
    """Refine the resolution until the estimated error is within the tolerance.  No run is repeated.

    Parameters
    ----------
    run : callable
        `run(problem, resolution, guess)` returns a run.Run.  `guess` is the finest run of the first
        problem so far; None if there is no such run.
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
    Answer
        Estimates of all values of the runs, and the following values: the finest run `finest`, its
        resolution, the observed order, the number of periods in the longest run, the effort of all
        runs, whether every run is `periodic`, and whether the resolution is `imposed`.  The Answer
        has not converged if a run did not converge, if the finest level is not fine enough, or if a
        run raised run.Spent.  In the last case, the estimates are those obtained before that run,
        or UNKNOWN if there are none.
    """
    runs: dict[tuple[int, int], Run] = {}
    goal, answer, order = tolerance, None, math.nan
    guess, effort, periods, reason, largest = None, Effort(), 0.0, "", 0
    numbers = range(len(problems))
    try:
        for level in ladder.levels(tolerance):
            if level < ladder.levels(goal)[0] or order < 0.0 and (0, level // 2) not in runs:
                continue
            every = []
            for number, at in [(0, level // 4), (0, level // 2), *zip(numbers, repeat(level))]:
                if (number, at) not in runs:
                    one = run(problems[number], ladder.resolution(at), guess)
                    effort, periods = effort + one.effort, max(periods, one.periods)
                    runs[number, at], reason = one, reason or one.reason
                    if number == 0 and at > largest:
                        guess, largest = one, at
                every.append(runs[number, at])
            estimates, order = _estimates(every, ladder, goal, name, energy_unit, drive_work)
            finest = ladder.resolution(level)
            values = {
                "finest": runs[0, level],
                "imposed": ladder.imposed > 0.0,
                "cells": finest.cells,
                "angles": finest.angles,
                "steps_per_period": 2 * finest.steps if ladder.steps else 0,
                "observed_order": order if math.isfinite(order) else None,
                "periods": periods,
                "effort": effort,
                "periodic": not reason,
            }
            answer = Answer(problems[0], values, estimates, reason)
            error = estimates[name].error
            rest = error - estimates[name].by_source["resolution"]
            if error <= tolerance or rest > LARGEST_REST * tolerance or ladder.imposed or reason:
                return answer
            goal = tolerance - rest
    except Spent as spent:
        if answer is None:
            unknown = dict.fromkeys(NAMES, UNKNOWN)
            values = {"imposed": ladder.imposed > 0.0, "periodic": False, "cells": 0}
            reason = f"{spent}: there is no error estimate yet"
            return Answer(problems[0], values, unknown, reason)
        return answer.changed(reason=f"{spent}: the error is still {error:.1e}")
    assert answer is not None  # every ladder has a level
    return answer.changed(reason=f"the error is still {error:.1e} with {finest.cells} cells")


def _estimates(
    runs: Sequence[Run],
    ladder: Ladder,
    goal: float,
    name: str,
    energy_unit: float,
    drive_work: float,
) -> tuple[dict[str, Estimate], float]:
    """Return estimates of all values, and the observed order of convergence of the requested value.

    `runs` contains the runs at n/4, n/2 and n. Further runs at n, with other interpolations,
    follow.  `goal` is the largest accepted resolution error of one value, and `name` is the name of
    this value.  The other arguments have the same meaning as for `refine`.
    """
    three, imposed = runs[:3], ladder.imposed > 0.0
    periodicity, solver = 0.0, 0.0
    for weight, run in zip((0.0, 0.0, 1.0) if imposed else WEIGHTS, three, strict=True):
        # a run that did not converge has a weight of at least 1, since levels can agree by chance
        weight = max(abs(weight), 1.0) if run.reason else abs(weight)
        if weight:  # the errors of the other runs can be infinite
            periodicity += float(weight * run.distance)
            solver += float(weight * run.residual)
    accuracy = ladder.accuracy if imposed else min(goal, LOOSEST)
    names = [*dict.fromkeys([name, *three[-1].values])]
    values = np.full((len(runs), len(names)), np.nan)
    for row, run in zip(values, runs, strict=True):
        row[:] = [*map(run.values.get, names, repeat(math.nan))]
    limits, finest = extrapolate(values[:3]), values[2]
    apart = READING_SAFETY * np.abs(values[3:] - finest).sum(axis=0)
    estimates: dict[str, Estimate] = {}
    for k, one in enumerate(names):
        least, unit = SMALLEST_SHARE * accuracy, 1.0
        if one == "dissipation":
            # the energy of a small cycle (Mindlin) is proportional to the third power of the force,
            # and its upper bound is proportional to the force: the effect of a force error is
            # estimated by the geometric mean of the energy and this bound
            unit, dissipated = energy_unit, abs(float(finest[k]))
            scale = max(dissipated, (dissipated * energy_unit) ** 0.5)
            # for a velocity above 1, the tolerance is already proportional to the velocity
            least *= max(scale / max(1.0, abs(estimates[name].value)), drive_work)
        value = float(finest[k] if imposed else limits.value[k])
        error = max(float(limits.error[k]), least) + abs(float(limits.value[k]) - value)
        errors = {"resolution": error, "periodicity": unit * periodicity, "solver": unit * solver}
        if len(runs) > len(three):
            errors["model"] = float(apart[k])
        estimates[one] = Estimate(value, errors)
    return estimates, float(limits.order[0])
