"""Compute the reference of a point on a mesh four times as fine as the result's mesh.

The reference shares no run with the result. It has four times the result's rings, angles and steps,
up to 192 rings or squares, 32 angles and 2048 steps in half a period, but at least twice as many
as the result. Each axis is refined alone, from a base that is finer than the first level of
any result. The mixed difference of two axes is also computed at the base. Every search for a
periodic state starts anew and ends at a distance of a tenth of the tolerance. The uncertainty is
estimated from runs with half of the refinement. If a run does not become periodic, half of the
refinement is used.

A static limit over rings scatters, because the edge of the stick zone lies within a ring. Its
reference is the mean over many numbers of rings.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from microslip.answer.limits import choose_model
from microslip.periodic.discretise import Resolution
from microslip.periodic.run import Settings
from microslip.periodic.simulate import simulate
from microslip.periodic.static_limit import edge_focus
from microslip.scene.hertz import HERTZ

SWEPT = {"radial": ((96, 1), (192, 1)), "polar": ((64, 12), (96, 24))}
SWEPT_STEPS = 4
"""For references under an oscillating load: rings and angles, and ratio of steps in half a period
to rings. All three are refined together."""
STATIC_RINGS = range(160, 513, 32)
"""Numbers of rings for static limits."""
ROUNDED = 1e-9
"""Two pressures count as equal if their full-slip torques differ by less than this."""
FINER = 4
BASE = {"radial": Resolution(32, 1, 48), "polar": Resolution(24, 12, 32)}
LEAST = {"radial": Resolution(64, 1, 96), "polar": Resolution(48, 16, 64)}
BASE["cartesian"], LEAST["cartesian"] = Resolution(32, 1, 32), Resolution(96, 1, 64)
PEAKED = 48
"""Number of rings in the base, for rotations under pressures with a peak or a steep edge."""
MOST = Resolution(192, 32, 2048)
"""Resolutions of the reference (steps in half a period): base, and limits of the finest run."""
PERIODICITY = 0.1
"""Largest distance of a reference's runs from their periodic states, divided by the tolerance."""


def reference(problem, tolerance, certified):
    """Return (mu, uncertainty) on a mesh four times as fine as that of the Result `certified`."""
    kind = problem.motion
    model = choose_model(replace(problem, velocity=1.0))
    stroke = min(max(problem.stroke, 1.0), 16.0) ** 0.5
    stroke *= kind.cycles

    # the run for a loop's static limit computes the edge of the stick zone itself
    by_itself = problem.velocity == 0.0 and not problem.on_a_line
    settings = Settings(focus=None if by_itself else edge_focus(problem, model))

    @lru_cache
    def run(resolution):
        share = PERIODICITY * tolerance
        return simulate(problem, model, resolution, share, settings=settings)

    if kind.loads:
        coarse, fine = (
            run(Resolution(rings, angles, 2 * round(0.5 * SWEPT_STEPS * rings * stroke)))
            for rings, angles in SWEPT[model]
        )
        return fine.mu, abs(fine.mu - coarse.mu)
    if problem.velocity == 0.0 and not by_itself and model == "radial":
        limits = [run(replace(BASE[model], cells=rings)).mu for rings in STATIC_RINGS]
        half = len(limits) // 2
        scatter = 2.0 * np.std(limits, ddof=1) / len(limits) ** 0.5
        trend = abs(np.mean(limits[half:]) - np.mean(limits[:half]))
        return float(np.mean(limits)), float(scatter + trend)
    base = replace(BASE[model], steps=2 * round(0.5 * BASE[model].steps * stroke))
    if model == "polar" and kind.rotates and abs(problem.pressure.torque - HERTZ.torque) > ROUNDED:
        base = replace(base, cells=PEAKED)

    distances = []  # from the periodic states

    def mean(**changes):
        solved = run(replace(base, **changes))
        distances.append(solved.distance)
        return solved.mu

    def settled(axis, finest):
        """Return the largest of finest, finest/2, ... with a periodic run along an axis."""
        while finest > 2 * getattr(base, axis):
            if run(replace(base, **{axis: finest})).converged:
                break
            finest //= 2
        return finest

    at_base, mu, uncertainty = mean(), 0.0, 0.0
    used = Resolution(certified.cells, certified.angles, certified.steps_per_period // 2)
    for axis in ("cells", "angles", "steps"):
        if axis == "angles" and model != "polar":
            continue
        has, most = getattr(used, axis), max(getattr(MOST, axis), 2 * getattr(used, axis))
        finest = settled(axis, min(max(FINER * has, getattr(LEAST[model], axis)), most))
        coarse, fine = mean(**{axis: finest // 2}), mean(**{axis: finest})
        beyond = (fine - coarse) / 3.0  # second order
        mu += fine + beyond - at_base
        uncertainty += abs(beyond)
    together = [("cells", "steps"), ("cells", "angles")][: 1 + (model == "polar")]
    for pair in together:
        twice = {axis: 2 * getattr(base, axis) for axis in pair}
        one, other = (mean(**{axis: count}) for axis, count in twice.items())
        mixed = mean(**twice) - one - other + at_base
        mu, uncertainty = mu + mixed, uncertainty + 0.5 * abs(mixed)
    return at_base + mu, uncertainty + max(distances)
