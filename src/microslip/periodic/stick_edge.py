"""Edges of the stick zone in slow motions, computed by coarse runs of the static limit.

No formula gives the edges for motions on a loop, or for pressures without a closed form.  For
rotating indenters, the radius is also the root of an integral (indenters.torsion_stick_radius); a
test compares both results.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np

from microslip.contact.contact import Contact, StepFailure
from microslip.contact.rings import Focus
from microslip.periodic.budget import Budget, Effort
from microslip.periodic.discretise import STRONGEST_FOCUS, Resolution, focus_strength
from microslip.periodic.run import AS_SHIPPED, Run, Settings
from microslip.periodic.static_limit import SLOW_LOOP, at_turning_points, limit_run
from microslip.pressures.hertz import HERTZ
from microslip.scene.problem import Problem

SLOW_LINE = 0.01
"""The stick zone of the static limit determines the state of a motion on a line if the drift is
below this value, in u_lim per radian of phase.  For loops, see static_limit.SLOW_LOOP."""
LOOP_RESOLUTION, SWEPT_RESOLUTION = Resolution(24, 4, 32), Resolution(24, 4, 96)
TOLERANCE = 1e-3
"""Resolutions and tolerance of the search for motions on a loop.  Under an oscillating load, the
edge of the contact moves across the rings, so more steps are needed."""
LINE_RESOLUTION, FINE_RESOLUTION = Resolution(48, 2, 1), Resolution(192, 2, 1)
"""Resolutions of the search for motions on a line.  This search needs no march, so many rings are
cheap.  If the edges are accurate to 5e-4 of the radius, the static limit of a translation is
accurate to 1e-4."""
FINE_TOLERANCE = 1e-5
"""Tolerance at FINE_RESOLUTION.  With a larger tolerance, some sticking rings appear to slip, and
the search does not converge."""
MOST_PASSES = 4
"""Largest number of runs in the search for the edges of the stick zone."""
MOST_EDGES = 4
"""Largest number of edges of the stick zone.  If there are more, they are treated as scatter."""
SLIVER = 1e-3
"""Two edges closer than this fraction of the contact radius are treated as scatter.  If there is
little slip, the shift is almost 0 in the rings on either side of an edge."""
_EDGES: dict[Problem, tuple[tuple[float, ...], Effort]] = {}
MOST_STORED = 64
"""Number of static limits whose edges are stored, with the effort of their search."""


def edge_focus(
    problem: Problem,
    model: str,
    budget: Budget | None = None,
    progress: Callable | None = None,
) -> Focus | None:
    """Grading of the rings for a slow motion, towards the edges of the static limit's stick zone.

    The stick zone of a circular motion is smaller than that of a linear motion of the same
    amplitude, because slip on a circle never stops.  The stick zone of a contact with a hole is a
    ring with two edges.  Under an oscillating load, the edges are computed for the static limit
    only.

    The effort of a search is charged to every point that uses its result.  So the work left for a
    point does not depend on earlier points.

    Parameters
    ----------
    problem : problem.Problem
        The problem.
    model : str
        Name in contact.registry.MODELS.
    budget : budget.Budget or None
        Budget of the search.  None means unlimited.
    progress : callable or None
        Called before every run of the search, with the run's Resolution.

    Returns
    -------
    mesh.Focus or None
        The grading.  It is None if Motion.focus gives the radius, the motion is fast, the model has
        no rings, the stick zone is not round, or the whole contact slips.

    Raises
    ------
    budget.Spent
        If the budget is exceeded.
    """
    motion, drift = problem.motion, problem.drift
    if model not in ("radial", "polar") or not motion.periodic:
        return None
    if at_turning_points(problem):
        needed = problem.pressure != HERTZ and motion.half_disc and drift < SLOW_LINE
    else:
        slow = not motion.loads and model == "radial" and drift < SLOW_LOOP
        needed = drift == 0.0 or slow
    if not needed:
        return None
    # at nu = 0, since Poisson's ratio hardly changes the edges
    limit, budget = replace(problem, velocity=0.0, poisson=0.0, drive=None), budget or Budget()
    if limit in _EDGES:
        radii, effort = _EDGES[limit]
        budget.take(effort)
    else:
        before, radii = budget.taken, ()
        with suppress(StepFailure):
            radii = _edges_of(limit, Settings(budget=budget), progress)
        if len(_EDGES) >= MOST_STORED:
            _EDGES.pop(next(iter(_EDGES)))
        _EDGES[limit] = radii, budget.taken - before
    return Focus(radii, focus_strength(drift)) if radii else None


def _edges_of(limit: Problem, settings: Settings, progress: Callable | None) -> tuple[float, ...]:
    """Radii of the edges for a problem at velocity 0."""
    motion, model = limit.motion, "polar" if limit.motion.rotates else "radial"
    edges = partial(stick_edges, limit, model, settings=settings, progress=progress)
    if not at_turning_points(limit):
        resolution = SWEPT_RESOLUTION if motion.loads else LOOP_RESOLUTION
        resolution = replace(resolution, steps=resolution.steps * motion.cycles)
        return edges(resolution, TOLERANCE)[1]
    if limit.focus is not None and not motion.rotates:
        return ()  # the edge has a closed form for this motion and pressure
    radii = edges(LINE_RESOLUTION, TOLERANCE)[1]
    if radii and not motion.rotates:
        radii = edges(FINE_RESOLUTION, FINE_TOLERANCE, radii=radii)[1]
    return radii


def static_run(
    problem: Problem, model: str, resolution: Resolution, tolerance: float, settings: Settings
) -> Run:
    """Compute the static limit at one resolution; for arguments and result, see simulate.simulate.

    The velocity of the problem is 0.
    """
    if at_turning_points(problem) or settings.focus is not None:  # the edges are known
        contact = settings.contact(problem, model, resolution)
        return limit_run(contact, problem, resolution, tolerance, settings)[0]
    runs, _ = stick_edges(problem, model, resolution, tolerance, settings=settings)
    effort = sum((one.effort for one in runs), Effort())
    return replace(runs[-1], periods=sum(one.periods for one in runs), effort=effort)


def stick_edges(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    *,
    settings: Settings = AS_SHIPPED,
    progress: Callable[[Resolution], object] | None = None,
    radii: tuple[float, ...] = (),
) -> tuple[list[Run], tuple[float, ...]]:
    """Find the radii of the stick zone's edges, on rings graded towards these edges.

    Repeats the run on new rings until the radii stay the same, or at most MOST_PASSES times.

    Parameters
    ----------
    problem, model, resolution, tolerance, settings
        See `static_run`.
    progress : callable or None
        Called before every run, with the run's Resolution.
    radii : tuple of float
        Approximate radii; empty if they are unknown.

    Returns
    -------
    runs : list of Run
        The runs; the last one is the result.
    radii : tuple of float
        The radii.  There are none if the whole contact sticks or slips, or if the contact has no
        rings.
    """
    runs: list[Run] = []
    for _ in range(MOST_PASSES):
        if progress is not None:
            progress(resolution)
        before, focus = radii, Focus(radii, STRONGEST_FOCUS) if radii else None
        contact = settings.contact(problem, model, resolution, focus)
        run, sticks = limit_run(contact, problem, resolution, tolerance, settings)
        runs.append(run)
        radii = _stick_radii(contact, sticks)
        if not radii or radii == before:
            break
    return runs, radii


def _stick_radii(contact: Contact, sticks: np.ndarray | None) -> tuple[float, ...]:
    """Radii between rings that stick and rings that slip; a ring sticks if most of its points do.

    Pairs closer than SLIVER are removed.  Returns only the outermost radius if there are more than
    MOST_EDGES radii, and no radius if `sticks` is None.
    """
    edges = contact.edges
    if sticks is None or edges is None:
        return ()
    sticks = (sticks.mean(axis=0) if sticks.ndim > 1 else sticks) > 0.5
    radii = [float(radius) for radius in edges[1:-1][np.diff(sticks)]]
    while len(radii) > 1:
        closest = int(np.argmin(np.diff(radii)))
        if radii[closest + 1] - radii[closest] > SLIVER:
            break
        del radii[closest : closest + 2]
    return tuple(radii if len(radii) <= MOST_EDGES else radii[-1:])
