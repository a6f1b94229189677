"""One run of the static limit at one resolution."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from microslip.contact.contact import FORWARD, Contact, forces
from microslip.contact.rings import Focus
from microslip.motions.problem import Problem
from microslip.solver.discretise import STRONGEST_FOCUS, Resolution, path_of
from microslip.solver.effort import Effort
from microslip.solver.means import dissipated_energy
from microslip.solver.run import AS_SHIPPED, Run, Settings, unsolved
from microslip.solver.snapshots import bounds_at_phases
from microslip.solver.static_limit import at_turning_points, loop_energy, static_state
from microslip.solver.static_loop import loop_limit
from microslip.solver.tolerances import MARCH_SHARE, STEP_SHARE, periods_of

FELT = 4.0
"""Ratio of the limit's error to the distance between the tractions and the periodic state of the
oscillation alone.  In tests, this ratio was at most 3.  Slipping points are on the bound after
every step, so their shift is 0."""
LOOP_STEP_SHARE = 1e-4
"""Ratio of the step tolerance to the tolerance of the periodic state.  A point's shift depends on
the square root of the distance between its traction and the bound."""
ENOUGH = 4.0
"""Largest accepted ratio of the distance reached to the distance requested; rounding limits the
search."""
MOST_PASSES = 4
"""Largest number of runs in the search for the edges of the stick zone."""
MOST_EDGES = 4
"""Largest number of edges of the stick zone.  If there are more, they are treated as scatter."""
SLIVER = 1e-3
"""Two edges closer than this fraction of the contact radius are treated as scatter.  If there is
little slip, the shift is almost 0 in the rings on either side of an edge."""
LARGEST_SHIFT = 1e-2
"""Largest shift of a ring outside the stick radius, divided by the largest friction bound."""


def static_run(
    problem: Problem, model: str, resolution: Resolution, tolerance: float, settings: Settings
) -> Run:
    """Compute the static limit at one resolution; for arguments and result, see simulate.simulate.

    The velocity of the problem is 0.  For a rigid contact and an oscillation on a line, the limit
    is 0.
    """
    if at_turning_points(problem):
        return _on_a_line(settings.contact(problem, model, resolution), problem, tolerance)
    return _on_a_loop(problem, model, resolution, tolerance, settings)


def _on_a_line(contact: Contact, problem: Problem, tolerance: float) -> Run:
    force, solves, residual, step_tolerance = 0.0, 0, 0.0, STEP_SHARE * tolerance
    oscillating = None
    if contact.sticks:
        limit = static_state(contact, problem.displacement, step_tolerance)
        oscillating = limit.oscillating
        force = float(forces(contact, limit.residual)[FORWARD])
        solves, residual = limit.solves, limit.solver_residual
    reason = unsolved(residual, solves, step_tolerance)
    values = {
        "friction": force / problem.mean_load,
        "dissipation": loop_energy(contact, problem.displacement, oscillating),
    }
    # the limit needs a march of a quarter period and no search, so there are no periods
    effort = Effort.of(solves, 0, 2 * contact.forward_position.size)
    return Run(values, 0.0, residual / problem.mean_load, effort=effort, reason=reason)


def _on_a_loop(
    problem: Problem, model: str, resolution: Resolution, tolerance: float, settings: Settings
) -> Run:
    if settings.focus is not None:  # the edges of the stick zone are known
        contact = settings.contact(problem, model, resolution)
        return _on_these_points(contact, problem, resolution, tolerance, settings)[0]
    runs, _ = edges_on_a_loop(problem, model, resolution, tolerance, settings)
    effort = sum((one.effort for one in runs), Effort())
    return replace(runs[-1], periods=sum(one.periods for one in runs), effort=effort)


def edges_on_a_loop(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    settings: Settings,
    progress: Callable | None = None,
) -> tuple[list[Run], tuple[float, ...]]:
    """Find the edges of the stick zone for a motion on a loop.  No formula gives them, so runs
    compute them.

    The arguments are those of `static_run`.  In addition, `progress` is called before every
    run, with the run's Resolution.  Returns the Runs and the radii of the edges; the last Run is
    the result.  There are no radii if the whole contact sticks or slips, or if the contact has no
    rings.
    """

    def points_that_stick(contact: Contact) -> np.ndarray | None:
        run, sticks = _on_these_points(contact, problem, resolution, tolerance, settings)
        runs.append(run)
        return sticks if run.converged else None

    runs: list[Run] = []
    return runs, _edges(problem, model, resolution, points_that_stick, settings, progress)


def edges_on_a_line(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    near: tuple[float, ...] = (),
    *,
    settings: Settings = AS_SHIPPED,
    progress: Callable | None = None,
) -> tuple[float, ...]:
    """Use the tractions at the turning points to find the edges of the stick zone for a motion on a
    line.

    The arguments are those of `edges_on_a_loop`.  In addition, `near` contains approximate radii;
    it is empty if they are unknown.  Returns the radii of the edges.
    """

    def points_that_stick(contact: Contact) -> np.ndarray | None:
        limit = static_state(contact, problem.displacement, STEP_SHARE * tolerance)
        if unsolved(limit.solver_residual, limit.solves, STEP_SHARE * tolerance):
            return None
        bounds = np.broadcast_to(contact.bound, limit.residual[0].shape)
        return np.hypot(*limit.residual) > LARGEST_SHIFT * bounds.max()

    return _edges(problem, model, resolution, points_that_stick, settings, progress, radii=near)


def _edges(
    problem: Problem,
    model: str,
    resolution: Resolution,
    points_that_stick: Callable[[Contact], np.ndarray | None],
    settings: Settings,
    progress: Callable[[Resolution], object] | None,
    *,
    radii: tuple[float, ...] = (),
) -> tuple[float, ...]:
    """Find the radii of the stick zone's edges, on rings graded towards these edges.

    Repeats the run on new rings until the radii stay the same, or at most MOST_PASSES times.
    `points_that_stick(contact)` returns a mask of the sticking points, or None if the mask is
    unknown.  `radii` are the edges for the first grading.
    """
    for _ in range(MOST_PASSES):
        if progress is not None:
            progress(resolution)
        before, focus = radii, Focus(radii, STRONGEST_FOCUS) if radii else None
        contact = settings.contact(problem, model, resolution, focus)
        radii = _stick_radii(contact, points_that_stick(contact))
        if not radii or radii == before:
            break
    return radii


def _stick_radii(contact: Contact, sticks: np.ndarray | None) -> tuple[float, ...]:
    """Radii between rings that stick and rings that slip; a ring sticks if most of its points do.

    Returns only the outermost radius if there are more than MOST_EDGES radii, and no radius if
    `sticks` is None.
    """
    edges = contact.edges
    if sticks is None or edges is None:
        return ()
    sticks = (sticks.mean(axis=0) if sticks.ndim > 1 else sticks) > 0.5
    radii = _without_slivers([float(radius) for radius in edges[1:-1][np.diff(sticks)]])
    return tuple(radii if len(radii) <= MOST_EDGES else radii[-1:])


def _without_slivers(radii: list[float]) -> list[float]:
    """Remove pairs closer than SLIVER from ascending radii."""
    while len(radii) > 1:
        closest = int(np.argmin(np.diff(radii)))
        if radii[closest + 1] - radii[closest] > SLIVER:
            break
        radii = radii[:closest] + radii[closest + 2 :]
    return radii


def _on_these_points(
    contact: Contact, problem: Problem, resolution: Resolution, tolerance: float, settings: Settings
) -> tuple[Run, np.ndarray | None]:
    """The Run for one contact, and a mask of sticking points (None if the contact cannot stick)."""
    path = path_of(problem, contact, resolution.steps, settings.method.integrator)
    distance = tolerance / FELT
    inner = min(LOOP_STEP_SHARE, MARCH_SHARE / path.steps) * distance
    limit, sticks = loop_limit(contact, problem, path, distance, inner), None
    periodic = limit.periodic
    if contact.sticks:
        bounds = bounds_at_phases(contact, path)
        sticks = limit.shift[FORWARD] > LARGEST_SHIFT * bounds.max()
    # the distance is part of the error
    near = periodic.converged or periodic.distance <= ENOUGH * distance
    periods = periods_of(periodic.marches, problem)
    reason = unsolved(limit.solver_residual, limit.solves, inner)
    if not near:
        reason = f"no periodic state within {periods:g} periods: {periodic.distance:.1e} left"
    values = {
        "friction": limit.force / problem.mean_load,
        # a constant traction does no work over a closed loop
        "dissipation": dissipated_energy(contact, path, periodic),
    }
    run = Run(
        values,
        distance=FELT * periodic.distance / problem.mean_load,
        residual=limit.solver_residual / problem.mean_load,
        periods=periods,
        effort=Effort.of(periodic.solves, periodic.iterations, periodic.start.size),
        reason=reason,
    )
    return run, sticks
