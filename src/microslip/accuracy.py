"""How fine is fine enough: resolutions chosen by the tolerance, errors estimated from the runs.

Each refinable axis (cells, angles, steps) has a chain of runs of its own, refined from a common
base, so that what an axis contributes is seen by itself and nothing has to be run fine in all of
them at once.  The answer is the base value plus the correction of every chain.  Where corrections
do not add up (time scatter in the differences of other chains, mixed difference of cells and
angles) that counts as error too, and if it is the largest one the base itself is refined.

- cells, doubled: the error falls smoothly with the second power, so the last difference is
  extrapolated by a third; 0.6 of it stays as the error, which covers any order above 1.05, or 0.35
  where the last two differences show an order between 1.3 and 2.7.
- angles, grown likewise in smaller steps: the error falls fast but irregularly.
- steps, grown by 4/3 and 3/2 in turn: the error scatters about its second-power trend, since a
  ring starts to slip somewhere within a step; so the spread of the last three runs is the error and
  nothing is extrapolated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

ERROR_SHARE = {"cells": 0.6, "angles": 1.0, "steps": 1.0}
"""Error over the last difference (cells), over the spread of the last three (angles, steps)."""
REGULAR = 0.35
REGULAR_RATIOS = (2.5, 6.5)
"""Error share of cells whose last two differences have a ratio within these bounds (4: order 2)."""
EXTRAPOLATED_CELLS = 1.0 / 3.0
RESOLVED = 0.02
"""Share of the tolerance below which no axis claims its error to be: nothing was run to see it."""
COINCIDENCE = 1.0 / 6.0
"""Share of the difference before the last that an error does not fall below: two runs that happen
to agree prove little."""
SCATTER = 0.5
"""Share of the time error of the base that its scatter may reach."""
MOST_REBASED = 5
LEVELS = {
    "cells": (0.5, 1, 2, 4, 8, 16, 32),
    "angles": (0.5, 1, 1.5, 2, 3, 4, 6, 8, 12),
    "steps": (2 / 3, 1, 4 / 3, 2, 8 / 3, 4, 16 / 3, 8, 32 / 3, 16, 64 / 3, 32),
}
"""Resolutions of each chain over the base."""
FIRST_RUNS = {"cells": 3, "angles": 3, "steps": 3}
SOURCES = {"cells": "space", "angles": "space", "steps": "time"}


@dataclass(frozen=True)
class Certified:
    """A number and what is wrong with it at most; forces over mu F_z.

    mu, torque: corrected means; errors: of mu by source (space, time, periodicity, solver);
    torque_error: of the torque in space; finest: largest resolution used along each axis; the rest
    sums up the effort of all runs.
    """

    mu: float
    torque: float
    errors: dict
    torque_error: float
    finest: object
    periods: int
    iterations: int
    work: int
    converged: bool
    reason: str

    @property
    def error(self):
        return sum(self.errors.values())


class _Chain:
    """Runs along one axis.  imposed: the base is what was asked for; it is run, and its half."""

    def __init__(self, at, base, axis, imposed):
        self.at, self.base, self.axis, self.imposed = at, base, axis, imposed
        levels = (0.5, 1) if imposed else LEVELS[axis]
        values = [max(round(level * getattr(base, axis)), 2) for level in levels]
        self.resolutions = [replace(base, **{axis: value}) for value in values]
        self.runs = [at(r) for r in self.resolutions[: 2 if imposed else FIRST_RUNS[axis]]]

    @property
    def finest(self):
        return getattr(self.resolutions[len(self.runs) - 1], self.axis)

    def refine(self):
        """One more run; False if there is no finer level."""
        if self.imposed or len(self.runs) == len(self.resolutions):
            return False
        self.runs.append(self.at(self.resolutions[len(self.runs)]))
        return True

    def correction(self, name):
        """What the chain adds to the value at the base."""
        values = [getattr(run, name) for run in self.runs]
        added = values[-1] - getattr(self.at(self.base), name)
        if self.axis == "cells" and not self.imposed:
            added += EXTRAPOLATED_CELLS * (values[-1] - values[-2])
        return added

    def error(self, name):
        """Estimated error after the correction."""
        values = [getattr(run, name) for run in self.runs]
        if self.imposed:
            return abs(values[1] - values[0])
        if self.axis != "cells":
            return ERROR_SHARE[self.axis] * (max(values[-3:]) - min(values[-3:]))
        before, last = (values[-2] - values[-3], values[-1] - values[-2])
        low, high = REGULAR_RATIOS
        if low * abs(last) <= abs(before) <= high * abs(last) and before * last > 0.0:
            return REGULAR * abs(last)
        return ERROR_SHARE["cells"] * max(abs(last), COINCIDENCE * abs(before))


def _scatter(chains):
    """What the time steps of the base may do to the differences of the other chains.

    Their runs share the steps of the base, and the part of its time error that scatters from run to
    run does not cancel.
    """
    if "steps" not in chains or len(chains) == 1:
        return 0.0
    return SCATTER * abs(chains["steps"].correction("mu"))


def _mixed(chains, base, at, imposed):
    """How far the corrections along cells and angles fail to add up: their mixed difference."""
    if not {"cells", "angles"} <= chains.keys() or "cells" in imposed:
        return 0.0
    cells, angles = (chains[axis].resolutions[2] for axis in ("cells", "angles"))
    both = at(replace(base, cells=cells.cells, angles=angles.angles))
    return abs(both.mu - at(cells).mu - at(angles).mu + at(base).mu)


def certify(run, base, axes, tolerance, imposed=()):
    """Refine until the estimated error is within ``tolerance``.

    run(resolution, guess) -> simulate.Run (guess: the run at the base, or None); base:
    simulate.Resolution; axes: names that can be refined;
    imposed: those whose resolution the caller fixed, so that their error is only reported.
    Returns a Certified; converged is False, with the reason, where a run did not converge or the
    estimate over a free axis stays too large.
    """
    cache = {}

    def at(resolution):
        if resolution not in cache:
            cache[resolution] = run(resolution, cache.get(base))
        return cache[resolution]

    def start_chains():
        at(base)
        return {axis: _Chain(at, base, axis, axis in imposed) for axis in axes}

    chains = start_chains()
    rebased = 0
    while True:
        reason = next((r.reason for r in cache.values() if not r.converged), "")
        left = {axis: chain.error("mu") for axis, chain in chains.items() if axis not in imposed}
        hidden = {"steps": _scatter(chains), "angles": _mixed(chains, base, at, imposed)}
        if reason or sum(left.values()) + sum(hidden.values()) <= 0.9 * tolerance:
            break
        worst = max(left, key=left.get, default="steps")
        cause = max(hidden, key=hidden.get)
        if hidden[cause] > left.get(worst, 0.0) and cause not in imposed and rebased < MOST_REBASED:
            base = replace(base, **{cause: 2 * getattr(base, cause)})
            chains, rebased = start_chains(), rebased + 1
        elif not left:
            break
        elif not chains[worst].refine():
            reason = f"the error over {worst} is still {left[worst]:.1e} at {chains[worst].finest}"
            break
    runs = list(cache.values())
    start = cache[base]
    errors = {"space": hidden["angles"], "time": hidden["steps"]}
    for axis, chain in chains.items():
        errors[SOURCES[axis]] += max(chain.error("mu"), RESOLVED * tolerance)
    errors["periodicity"] = float(max(r.distance for r in runs))
    errors["solver"] = float(max(r.solver_residual for r in runs))
    return Certified(
        mu=start.mu + sum(chain.correction("mu") for chain in chains.values()),
        torque=start.torque + sum(chain.correction("torque") for chain in chains.values()),
        errors=errors,
        torque_error=sum(chain.error("torque") for chain in chains.values()),
        finest=replace(base, **{axis: chain.finest for axis, chain in chains.items()}),
        periods=max(r.periods for r in runs),
        iterations=sum(r.iterations for r in runs),
        work=sum(r.work for r in runs),
        converged=not reason,
        reason=reason,
    )
