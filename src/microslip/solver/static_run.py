"""One run of the static limit at one resolution: nothing moves forward, but it is a Run too."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from microslip.models.contact import FORWARD, StepFailure, forces
from microslip.models.rings.mesh import Focus
from microslip.solver import anderson
from microslip.solver.period_map import Goal, PeriodMap
from microslip.solver.power import oscillation_power
from microslip.solver.problem import STRONGEST_FOCUS, Problem, Resolution, focus_strength
from microslip.solver.run import AS_SHIPPED, Run, Settings, failed_run
from microslip.solver.simulate import STEP_SHARE, mean_forces, periods_of
from microslip.solver.snapshots import bounds_at_phases, frames
from microslip.solver.static_limit import STEPS, at_turning_points, static_state
from microslip.solver.static_loop import largest_shift

FELT = 4.0
"""How much more than the distance from the periodic state of the oscillation alone the limit may
feel: three times were seen.  Where points slip, every step puts them on the bound, so that no
shift is left to them however far the state is from periodic."""
MARCHES, MOST_ROUNDS = 120, 3
"""Of a search for it, and how often it starts again: rounding may stall an accelerated one."""
ENOUGH = 4.0
"""Times the distance that was asked for, which does where rounding leaves no more to be had."""
MOST_PASSES = 4
NOTHING_LEFT = 1e-2
"""Share of the largest bound that a ring outside of the stick radius may seem to have left."""
SLOW_LOOP = 0.02
"""Creep in a radian, in u_lim, below which what never slips in the limit decides a loop."""
TELLING, TOLD = Resolution(24, 1, 32), 1e-3
"""Resolution and tolerance at which its edge is found for that."""


def simulate_static(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    settings: Settings = AS_SHIPPED,
) -> Run:
    """The limit of vanishing velocity at one resolution: arguments and Run as simulate.simulate.

    The velocity of the problem is 0.  The rigid contact keeps no residual traction: 0 where the
    oscillation is on a line.
    """
    try:
        if at_turning_points(problem.motion):
            return _on_a_line(settings.contact(problem, model, resolution), problem, tolerance)
        return _on_a_loop(problem, model, resolution, tolerance, settings)
    except (StepFailure, ArithmeticError, np.linalg.LinAlgError) as failure:
        return failed_run(str(failure))


def _on_a_line(contact, problem, tolerance):
    force, solves = 0.0, 0
    if contact.sticks:
        residual, _ = static_state(contact, problem.displacement, STEP_SHARE * tolerance)
        force, solves = float(forces(contact, residual)[FORWARD]), STEPS // 2
    return Run(
        mu=force / problem.mean_load,
        torque=0.0,
        distance=0.0,
        solver_residual=STEP_SHARE * tolerance * solves,
        periods=0.0,  # a quarter of one tells the limit, and nothing is searched for
        iterations=0,
        solves=solves,
        work=solves * 2 * contact.forward_position.size,
        effort=0,
        converged=True,
        reason="",
    )


def loop_focus(problem: Problem, model: str) -> Focus | None:
    """Where rings should gather for a slow loop in the plane: at the edge of what never slips in
    the limit of vanishing velocity.

    No formula tells it: of a circle it lies further in than that of a line which is as long, since
    the slip never comes to rest.

    Parameters
    ----------
    problem : problem.Problem
        Any.
    model : str
        Name in models.registry.MODELS.

    Returns
    -------
    mesh.Focus or None
        None: motion or model is another, the motion is fast, or all of the contact slips.
    """
    motion = problem.motion
    loops = motion.periodic and not motion.rotates and not motion.straight and motion.depth is None
    if model != "radial" or not loops or not 0.0 < problem.creep < SLOW_LOOP:
        return None
    radius = _limit_radius(motion, problem.amplitude)
    return None if radius is None else Focus(radius, focus_strength(problem.creep))


@lru_cache(maxsize=64)
def _limit_radius(motion, amplitude):
    """Edge of what never slips, over the contact radius, or None."""
    limit = Problem(motion, 0.0, amplitude, 0.0)
    try:
        return _passes(limit, "radial", TELLING, TOLD, AS_SHIPPED)[1]
    except (StepFailure, ArithmeticError, np.linalg.LinAlgError):
        return None


def _on_a_loop(problem, model, resolution, tolerance, settings):
    done, _ = _passes(problem, model, resolution, tolerance, settings)
    spent = ("periods", "iterations", "solves", "work", "effort")
    return replace(done[-1], **{name: sum(getattr(one, name) for one in done) for name in spent})


def _passes(problem, model, resolution, tolerance, settings):
    """Runs on rings that are gathered at the edge of what never slips, which no formula tells, and
    the last radius of it, or None."""
    done, focus = [], None
    while len(done) < MOST_PASSES:
        contact = settings.contact(problem, model, resolution, focus)
        path = problem.path(contact, resolution.steps, settings.method.integrator)
        run, left = _on_these_points(contact, problem, path, tolerance)
        done.append(run)
        radius = _stick_radius(contact, left)
        if not run.converged or radius is None or (focus is not None and radius == focus.radius):
            break
        focus = Focus(radius, STRONGEST_FOCUS)
    return done, radius


def _stick_radius(contact, left):
    """Outer edge of the last ring of which more than half has something `left`, or None: there is
    none, or the contact tells no edges."""
    edges = getattr(contact, "edges", None)
    if left is None or edges is None:
        return None
    rings = np.flatnonzero(left.mean(axis=0) > 0.5)
    return float(edges[rings[-1] + 1]) if rings.size and rings[-1] + 2 < len(edges) else None


def _on_these_points(contact, problem, path, tolerance):
    """The Run on one contact, and which points have something left to resist with, if any has."""
    mirror = problem.motion.half_period_mirror
    distance = tolerance / FELT
    shape = np.broadcast_shapes(contact.bound.shape, contact.lateral_position.shape)
    period_map = PeriodMap(contact, path, mirror=mirror)
    start, inner = np.zeros((2, *shape)), STEP_SHARE * distance
    for _ in range(MOST_ROUNDS):  # not Newton's method: what never slips keeps what it began with
        goal = Goal(distance, inner, period_map.marches + MARCHES)
        found = anderson.search(period_map, start, goal)
        start = found.start
        if found.converged:
            break
    force, left = mean_forces(contact, problem, path, found.forces)[FORWARD], None
    if contact.sticks:
        tractions, _ = frames(contact, path, found.start, inner)
        bounds = np.broadcast_to(bounds_at_phases(contact, path), tractions[:, 0].shape)
        if mirror:
            bounds = np.concatenate([bounds, bounds])
            tractions = np.concatenate([tractions, [contact.mirrored(q) for q in tractions]])
        shift = largest_shift(tractions, bounds)
        force += float(np.sum(contact.weight * shift))
        left = shift > NOTHING_LEFT * bounds.max()
    near = found.converged or found.distance <= ENOUGH * distance  # and its error is told
    periods, reason = periods_of(found.marches, problem.motion), ""
    if not near:
        reason = f"no periodic state within {periods:g} periods: {found.distance:.1e} left"
    run = Run(
        mu=float(force) / problem.mean_load,
        torque=0.0,
        distance=FELT * found.distance / problem.mean_load,
        solver_residual=found.solver_residual / problem.mean_load,
        periods=periods,
        iterations=found.iterations,
        solves=found.solves,
        work=found.solves * found.start.size,
        effort=found.iterations * found.start.size,
        converged=near,
        reason=reason,
        # a constant traction does no work on a motion that returns
        power=oscillation_power(problem, path, found.forces),
    )
    return run, left
