"""How fine is fine enough: resolutions chosen by the tolerance, errors estimated from the runs.

Each refinable axis (cells, angles, steps) has a chain of runs of its own, coarser and finer than a
common base, so that what an axis contributes is seen by itself and nothing has to be run fine in
all of them at once.  The answer is the base value plus the correction of every chain and the first
mixed difference of cells and angles.  Where corrections do not add up (that mixed difference, and
time scatter in the differences of other chains) that counts as error too, and if it is the largest
one the base itself is refined.

- cells: the error falls smoothly with about the second power, so the last difference is
  extrapolated; 0.6 of that extrapolation stays as error, and half of the change that the last run
  made to the extrapolated value.
- angles: the error falls fast but irregularly, so the spread of the last three runs is the error.
- steps: the error scatters about its trend, since a ring starts to slip somewhere within a step; so
  the spread of the last three runs is the error here, too, and nothing is extrapolated.
- readings: where the pressure is known on a grid alone, the finest run along the cells is done
  again for every other pressure that the same numbers may stand for; how far these are apart is an
  error that no refinement removes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from microslip.adaptive.chains import Chain, Readings, Runs, mixed_difference, refines_cells
from microslip.solver.budget import Spent

RESOLVED = 0.125
"""Share of the tolerance below which no axis claims its error to be: nothing was run to see it."""
SCATTER = 0.5
"""Share of the correction in time that its scatter may do to the differences of other chains."""
LARGEST_OPEN = 0.5
"""Share of the tolerance that the readings may take for runs to be refined for what is left."""
MOST_REBASED = 6
SOURCES = {"cells": "space", "angles": "space", "steps": "time"}


@dataclass(frozen=True)
class Certified:
    """A number and what is wrong with it at most; forces over mu F_z.

    mu, torque: corrected means; errors: of mu by source (space, time, periodicity, solver; model,
    where there are readings); torque_error: of the torque in space, and over the readings; finest:
    largest resolution used along each axis; periods: of the longest run; iterations, work, effort,
    retried: of all runs; converged: whether every run found its periodic state and nothing kept the
    refinement from going on, else reason says what; periodic: the first of these alone.
    """

    mu: float
    torque: float
    errors: dict
    torque_error: float
    finest: object
    periods: float
    iterations: int
    work: int
    effort: int
    retried: int
    converged: bool
    reason: str
    periodic: bool

    @property
    def error(self):
        return sum(self.errors.values())


def certify(run, coarsest, axes, tolerance, readings=()):
    """Refine until the estimated error is within ``tolerance``.

    run(resolution, guess) -> simulate.Run (guess: the run at the base, or None); coarsest:
    problem.Resolution, for what is not refined; axes: the Axis to be refined; readings: functions
    like ``run`` for other pressures that the same numbers may stand for.
    Returns a Certified; converged is False, with the reason, where a run did not converge, the
    estimate over a free axis stays too large, or a run raised budget.Spent: then it is what was
    known before that run, NaN if that was nothing yet.
    """
    runs = Runs(run, coarsest, axes)
    known = None
    try:
        for found in _refined(runs, axes, tolerance, readings):
            known = found
    except Spent as spent:
        still = "no error is known yet"
        if known is not None:
            still = f"the error is still {known.error:.1e}"
        return replace(known or _nothing(coarsest), converged=False, reason=f"{spent}: {still}")
    return known


def _refined(runs, axes, tolerance, readings):
    """Yield a Certified whenever something is known, the last one when no more is to be done."""
    chains = {axis.name: Chain(runs, axis) for axis in axes}
    others, none = Readings(runs, readings), Readings(runs, ())
    rebased, goal = 0, tolerance
    while True:
        runs()  # the base first: its state is a guess for others
        left = {name: c.error("mu") for name, c in chains.items() if not c.axis.imposed}
        hidden = {"steps": 0.0, "angles": abs(mixed_difference(runs, chains, "mu"))}
        if "steps" in chains and len(chains) > 1:
            hidden["steps"] = SCATTER * abs(chains["steps"].correction("mu"))
        errors = _errors(runs, chains, hidden, tolerance)
        reason = next((r.reason for r in runs.done.values() if not r.converged), "")
        if reason:
            break
        if sum(errors.values()) <= goal:
            left_open = others.open(chains, "mu") if goal == tolerance else np.inf
            within = sum(errors.values()) + left_open <= tolerance
            if within or left_open > LARGEST_OPEN * tolerance:
                break
            goal = tolerance - left_open  # runs that are finer still can make room for it
            continue
        yield _summary(runs, chains, errors, none, "not refined any further")
        worst = max(left, key=left.get, default=None)
        cause = max(hidden, key=hidden.get)
        if hidden[cause] > left.get(worst, 0.0) and _can_rebase(chains, cause, rebased):
            for name in _rebased_together(chains, cause):
                runs.base[name] += 1
            rebased += 1
            for chain in chains.values():
                chain.rebase()
        elif worst is None or sum(left.values()) + sum(hidden.values()) < 0.5 * goal:
            break  # finer runs would not help
        elif not chains[worst].refine():
            reason = f"the error over {worst} is still {left[worst]:.1e}"
            reason += f" at {chains[worst].levels[-1]}"
            break
    yield _summary(runs, chains, errors, others, reason)


def _nothing(coarsest):
    """The Certified of a point of which no error is known yet."""
    errors = dict.fromkeys((*SOURCES.values(), "periodicity", "solver"), np.inf)
    none = replace(coarsest, cells=0, angles=0, steps=0)
    return Certified(np.nan, np.nan, errors, np.inf, none, 0.0, 0, 0, 0, 0, False, "", False)


def _can_rebase(chains, cause, rebased):
    """Whether the axes whose base would cure ``cause`` are there and have a finer level."""
    if rebased == MOST_REBASED:
        return False
    return all(
        name in chains
        and not chains[name].axis.imposed
        and chains[name].runs.base[name] + 1 < len(chains[name].axis.levels)
        for name in _rebased_together(chains, cause)
    )


def _rebased_together(chains, cause):
    """Axes whose base is refined where corrections do not add up, by the cause."""
    return ("steps",) if cause == "steps" else (refines_cells(chains), "angles")


def _errors(runs, chains, hidden, tolerance):
    """Errors of mu by source."""
    errors = {"space": hidden["angles"], "time": hidden["steps"]}
    for name, chain in chains.items():
        floor = 0.0 if chain.axis.imposed else RESOLVED * tolerance
        errors[SOURCES[name]] += max(chain.error("mu"), floor)
    done = runs.done.values()
    errors["periodicity"] = float(max(r.distance for r in done))
    errors["solver"] = float(max(r.solver_residual for r in done))
    return errors


def _corrected(runs, chains, name):
    corrections = sum(chain.correction(name) for chain in chains.values())
    return getattr(runs(), name) + corrections + mixed_difference(runs, chains, name)


def _summary(runs, chains, errors, others, reason):
    """The Certified of chains that are fine enough, or as fine as they get."""
    torque_error = sum(chain.error("torque") for chain in chains.values())
    if others.readings:
        errors = errors | {"model": others.open(chains, "mu")}
        torque_error += others.open(chains, "torque")
    done = [*runs.done.values(), *others.done.values()]
    if not reason:
        reason = next((r.reason for r in done if not r.converged), "")
    return Certified(
        mu=_corrected(runs, chains, "mu"),
        torque=_corrected(runs, chains, "torque"),
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
