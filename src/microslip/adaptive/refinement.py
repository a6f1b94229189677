"""How fine is fine enough: resolutions chosen by the tolerance, errors estimated from the runs.

Each refinable axis (cells, angles, steps) has a chain of runs of its own, coarser and finer than a
common base, so that what an axis contributes is seen by itself and nothing has to be run fine in
all of them at once.  The answer is the base value plus the correction of every chain and the first
mixed differences of cells with angles and, at tight tolerances, with steps: the error in time may
cancel on few rings and not on more.  Where corrections do not add up (those mixed differences, and
time scatter in the differences of other chains) that counts as error too, and if it is the largest
one the base itself is refined.

- cells: the error falls smoothly with about the second power, so the last difference is
  extrapolated; shares of that and of the change that the last run made to it stay as error.
- angles: the error falls fast but irregularly, so nothing is extrapolated, and the spread of the
  last three runs is the error; of rotating motions the larger of two projections: how far the value
  would still go by each of the last two differences.
- steps: the error scatters about its trend, since a ring starts to slip somewhere within a step; so
  it is taken as over the angles.
- all together, of bores at tight tolerances: a line through the last runs is extrapolated; a share
  of the largest projection, or the distance to the extrapolation of first order if that is larger,
  and the scatter about the line, stay as error.
- readings: where the pressure is known on a grid alone, the finest run along the cells is done
  again for every other pressure that the same numbers may stand for; how far these are apart is an
  error that no refinement removes.
- periodicity, solver: the answer is a linear combination of runs, and so are its distance from the
  periodic state and its residual: sum |c_i| d_i of the runs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from microslip.adaptive.certified import Certified, nothing
from microslip.adaptive.chains import (
    CALIBRATED,
    Axis,
    Chain,
    Readings,
    Runs,
    refines_cells,
)
from microslip.adaptive.mixed_differences import mixed_differences
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.run import Run

LARGEST_OPEN = 0.5
"""Share of the tolerance that the readings may take for runs to be refined for what is left."""
LEAST_WORTH = 0.25
"""Share of the tolerance down to which an axis is refined where a worse one cannot be."""
MIXED_SHARES = {"steps": 1.0, "angles": CALIBRATED}
"""Error over the largest mixed difference of the cells and an axis, by the latter: those with the
steps are taken at twice the steps of the base, and are much the same at finer ones."""
MOST_REBASED = 6
PERIODICITY_SHARE = 0.07
"""Share of the tolerance that distances from the periodic states may take together."""
SOURCES = {"cells": "space", "angles": "space", "steps": "time"}


def certify(
    run: Callable[[Resolution, Run | None], Run],
    coarsest: Resolution,
    axes: Sequence[Axis],
    tolerance: float,
    readings: Sequence[Callable] = (),
    quantity: str = "mu",
) -> Certified:
    """Refine until the estimated error is within the tolerance.

    Parameters
    ----------
    run : callable
        run(resolution, guess) -> run.Run; guess: the run at the base, or None.
    coarsest : problem.Resolution
        For what is not refined.
    axes : sequence of chains.Axis
        To be refined.
    tolerance : float
        Absolute, on the quantity.
    readings : sequence of callable
        Like `run`, for other pressures that the same numbers may stand for.
    quantity : str
        Of a run.Run, what is asked for: "mu", or "velocity" where a force pulls.

    Returns
    -------
    Certified
        Not converged, with the reason, where a run did not converge, the estimate over a free axis
        stays too large, or a run raised budget.Spent: then it is what was known before that run,
        NaN if that was nothing yet.
    """
    runs = Runs(run, coarsest, axes, attrgetter(quantity))
    refinement = _Refinement(runs, axes, tolerance, readings)
    known = None
    try:
        while True:
            estimate = refinement.estimate()
            if estimate.reason or refinement.is_enough(estimate):
                return refinement.summary(estimate, estimate.reason)
            known = refinement.summary(estimate, "not refined any further", readings=False)
            stopped = refinement.refine(estimate)
            if stopped is not None:
                return refinement.summary(estimate, stopped)
    except Spent as spent:
        still = "no error is known yet"
        if known is not None:
            still = f"the error is still {known.error:.1e}"
        return replace(known or nothing(coarsest), converged=False, reason=f"{spent}: {still}")


class Estimate(NamedTuple):
    """What the runs so far say of mu; forces over mu F_z.

    Attributes
    ----------
    errors : dict of float
        By source.
    left : dict of float
        Errors over the axes that may be refined, by their names.
    hidden : dict of float
        What corrections that do not add up may hide, by the axis whose base would cure it.
    reason : str
        Why a run did not converge, empty if all did.
    """

    errors: dict
    left: dict
    hidden: dict
    reason: str


class _Refinement:
    """The chains of a point while they are refined."""

    def __init__(self, runs, axes, tolerance, readings):
        self.runs, self.tolerance = runs, tolerance
        self.chains = {axis.name: Chain(runs, axis) for axis in axes}
        self.readings = Readings(runs, readings)
        self.goal = tolerance
        self.rebased = 0

    def estimate(self):
        """An Estimate from the chains as they are; does the runs that they lack."""
        runs, chains = self.runs, self.chains
        runs()  # the base first: its state is a guess for others
        left = {name: c.error(runs.read) for name, c in chains.items() if not c.axis.imposed}
        hidden = {
            axis: share * max(map(abs, mixed_differences(runs, chains, runs.read, axis)))
            for axis, share in MIXED_SHARES.items()
        }
        if "steps" in chains and len(chains) > 1:
            scattered = chains["steps"].axis.scatter * abs(chains["steps"].correction(runs.read))
            hidden["steps"] = max(hidden["steps"], scattered)
        errors = _errors(runs, chains, hidden, self.tolerance)
        reason = next((r.reason for r in runs.done.values() if not r.converged), "")
        return Estimate(errors, left, hidden, reason)

    def is_enough(self, estimate):
        """Whether finer runs are of no need, or of no use since the readings are too far apart.

        What these leave open is asked for once, and from then on runs have to make room for it.
        """
        error = sum(estimate.errors.values())
        if error > self.goal:
            return False
        if self.goal == self.tolerance:
            left_open = self.readings.open(self.chains, self.runs.read)
            if error + left_open > self.tolerance and left_open <= LARGEST_OPEN * self.tolerance:
                self.goal = self.tolerance - left_open
                return error <= self.goal
        return True

    def refine(self, estimate):
        """Refine what the largest error comes from.

        Returns None where something was refined, else why not, which is empty where finer runs
        would not help.
        """
        left, hidden = estimate.left, estimate.hidden
        worst = max(left, key=left.get, default=None)
        cause = max(hidden, key=hidden.get)
        if hidden[cause] > left.get(worst, 0.0) and self._can_rebase(cause):
            self._rebase(cause)
            return None
        if worst is None or sum(left.values()) + sum(hidden.values()) < 0.5 * self.goal:
            return ""
        if self._refine_one(left):
            return None
        finest = self.chains[worst].levels[-1]
        return f"the error over {worst} is still {left[worst]:.1e} at {finest}"

    def _refine_one(self, left):
        """Refine the worst axis or, if it has no finer level, another that makes room for it."""
        worst, *others = sorted(left, key=left.get, reverse=True)
        if self.chains[worst].refine():
            return True
        worth = [name for name in others if left[name] > LEAST_WORTH * self.goal]
        return left[worst] < self.goal and any(self.chains[name].refine() for name in worth)

    def _can_rebase(self, cause):
        """Whether the axes whose base would cure it are there and have a finer level."""
        chains = self.chains
        return self.rebased < MOST_REBASED and all(
            name in chains
            and not chains[name].axis.imposed
            and self.runs.base[name] + 1 < len(chains[name].axis.levels)
            for name in self._rebased_together(cause)
        )

    def _rebase(self, cause):
        """Refine the common base, and go on from there."""
        for name in self._rebased_together(cause):
            self.runs.base[name] += 1
        self.rebased += 1
        for chain in self.chains.values():
            chain.rebase()

    def _rebased_together(self, cause):
        """Axes whose base is refined where corrections do not add up, by the cause."""
        return ("steps",) if cause == "steps" else (refines_cells(self.chains), "angles")

    def summary(self, estimate, reason, readings=True):
        """The Certified of the chains as they are; readings: whether their error is part of it."""
        others = self.readings if readings else Readings(self.runs, ())
        return _summary(self.runs, self.chains, estimate.errors, others, reason)


def _errors(runs, chains, hidden, tolerance):
    """Errors of mu by source."""
    errors = {"space": hidden["angles"], "time": hidden["steps"]}
    for name, chain in chains.items():
        floor = 0.0 if chain.axis.imposed else chain.axis.resolved * tolerance
        errors[SOURCES[name]] += max(chain.error(runs.read), floor)
    weights = np.abs(_weights(runs, chains))
    done = runs.done.values()
    errors["periodicity"] = _weighted(weights, [r.distance for r in done])
    errors["solver"] = _weighted(weights, [r.solver_residual for r in done])
    return errors


def _weighted(weights, errors):
    """Sum of errors times weights; the error of a run without weight does not count, even if it is
    infinite."""
    return float(sum(w * e for w, e in zip(weights, errors, strict=True) if w > 0.0))


def _corrected(runs, chains, read):
    """The answer: a linear combination of read(run) over the runs."""
    corrections = sum(chain.correction(read) for chain in chains.values())
    mixed = [mixed_differences(runs, chains, read, axis) for axis in MIXED_SHARES]
    return read(runs()) + corrections + sum(sum(each) / len(each) for each in mixed)


def _weights(runs, chains):
    """Weight of each of the runs in the answer, shape (len(runs.done),)."""
    _corrected(runs, chains, lambda run: 0.0)  # does the runs that are missing
    units = dict(zip(map(id, runs.done.values()), np.eye(len(runs.done)), strict=True))
    return _corrected(runs, chains, lambda run: units[id(run)])


def run_tolerance(coarsest: Resolution, axes: Sequence[Axis], tolerance: float) -> float:
    """Distance from the periodic state that each run may keep.

    The answer is a combination sum c_i f_i of runs; the distances may add up to PERIODICITY_SHARE
    of the tolerance.  The c_i follow from the levels of the axes before anything is run.
    """
    planned = Runs(lambda resolution, guess: resolution, coarsest, axes)
    weights = _weights(planned, {axis.name: Chain(planned, axis) for axis in axes})
    return PERIODICITY_SHARE * tolerance / max(float(np.sum(np.abs(weights))), 1.0)


def _summary(runs, chains, errors, others, reason):
    """The Certified of chains that are fine enough, or as fine as they get."""
    torque = attrgetter("torque")
    torque_error = sum(chain.error(torque) for chain in chains.values())
    if others.readings:
        errors = errors | {"model": others.open(chains, runs.read)}
        torque_error += others.open(chains, torque)
    done = [*runs.done.values(), *others.done.values()]
    reason = reason or next((r.reason for r in done if not r.converged), "")
    return Certified(
        mu=float(_corrected(runs, chains, runs.read)),
        torque=float(_corrected(runs, chains, torque)),
        errors=errors,
        torque_error=torque_error,
        finest=runs.resolution(**{name: chain.indices[-1] for name, chain in chains.items()}),
        periods=max(r.periods for r in done),
        iterations=sum(r.iterations for r in done),
        work=sum(r.work for r in done),
        effort=sum(r.effort for r in done),
        retried=sum(r.retried for r in done),
        converged=not reason,
        reason=reason,
        periodic=all(r.converged for r in done),
    )
