"""One run at one resolution: build the contact and the path, find the state that repeats itself."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from microslip import hertz
from microslip.friction import project
from microslip.models import MODELS
from microslip.models.contact import UNIT_STIFFNESS, energy_norm, full_slip
from microslip.path import EULER, SDIRK2, half_period_phases, make_path, turning_point_grading
from microslip.periodic import Pace, find_periodic_state
from microslip.rings import Focus
from microslip.static import STEPS, static_state

STEP_SHARE = 1e-2
SLOW_STEP_SHARE = 3e-4
"""Tolerance of a step over that of the periodic state: the slower the motion, the less a state
changes in a period, and the more an error of its steps adds up."""
STEADY_STRETCH = 8
"""Steps marched between two looks at whether a steady motion has reached its steady state."""
STEADY_TRAVEL = 0.5
"""Largest rigid displacement of a steady motion in one step, in u_lim."""
MAX_STRETCHES = 200
SLOW_PUSH = 0.5
LARGEST_PUSH = 0.1
"""Forward traction added to the static limit's, as a share of the bound, for a start: it grows as
the friction itself does with the creep in a radian, so that every point slips forward a little too
much.  From there an accelerated search finds its way down; below, points would only drift."""

WEAKEST_FOCUS, STRONGEST_FOCUS, FOCUS_STEP = 0.3, 0.9, 0.1
"""Bounds of rings.Focus.strength.  Slip that is as small as the creep fills a layer around the
stick radius whose width goes like creep^(2/3); with widths that grow from it quadratically, the
square root of that is the right share of the mean width.  In steps, so that points share grids."""


@dataclass(frozen=True, order=True)
class Resolution:
    """Cells (rings, or squares along a side), angular points on half the disc, steps a half period
    (steady motion: not used)."""

    cells: int
    angles: int
    steps: int


@dataclass(frozen=True)
class Run:
    """Outcome of one run: forward friction and torque over their full-slip values, and the effort.

    distance: estimated distance from the periodic (steady) state; solver_residual: summed over the
    last period; both forces over mu F_z.  work: step solves x unknowns.  state: the periodic
    tractions, where there are any.
    """

    mu: float
    torque: float
    distance: float
    solver_residual: float
    periods: int
    iterations: int
    solves: int
    work: int
    converged: bool
    reason: str
    state: np.ndarray | None = None


def simulate(scene, velocity, amplitude, poisson, model, resolution, tolerance, guess=None):
    """Run ``model`` on a scene at one resolution to its periodic (or steady) state.

    scene: scenes.Scene; velocity > 0, amplitude > 0 (None for steady scenes), poisson in 0..0.5:
    checked by the caller; tolerance: of the periodic state, a force over mu F_z, steps are solved
    a hundred times tighter; guess: a Run of the same point with the same cells and angles, if any.
    Returns a Run; never raises for want of convergence.
    """
    contact = _build(scene, velocity, amplitude, poisson, model, resolution)

    def displacement(phase):
        return scene.displacement(phase, velocity, amplitude, poisson)

    step_tolerance = STEP_SHARE * tolerance
    if scene.periodic:
        creep = scene.creep(velocity, amplitude, poisson)
        pace = UNIT_STIFFNESS * creep * np.pi
        step_tolerance = min(max(pace * STEP_SHARE, SLOW_STEP_SHARE), STEP_SHARE) * tolerance
    if not scene.periodic:
        return _steady_run(contact, displacement, velocity, tolerance, step_tolerance)
    grading = turning_point_grading(creep, scene.stroke(amplitude, poisson))
    phases = half_period_phases(resolution.steps, getattr(contact, "grading", grading))
    path = make_path(displacement, phases, SDIRK2)
    found = _search(contact, scene, displacement, path, tolerance, step_tolerance, guess)
    mean = path.mean(found.forces)
    solved = found.solver_residual <= found_limit(path, step_tolerance)
    reason = ""
    if not found.converged:
        reason = f"no periodic state within {found.periods} half periods: {found.distance:.1e} left"
    elif not solved:
        reason = f"a step was left unsolved: residual {found.solver_residual:.1e}"
    return Run(
        mu=float(mean[0]),
        torque=float(mean[2]) / hertz.TORQUE_FULL_SLIP,
        distance=found.distance,
        solver_residual=found.solver_residual,
        periods=found.periods,
        iterations=found.iterations,
        solves=found.solves,
        work=found.solves * found.start.size,
        converged=found.converged and solved,
        reason=reason,
        state=found.start,
    )


def simulate_static(scene, amplitude, poisson, model, resolution, tolerance):
    """The limit of vanishing velocity at one resolution (see static.py): a Run, without a march in
    forward direction.  The rigid contact keeps no residual traction: 0."""
    contact = _build(scene, 0.0, amplitude, poisson, model, resolution)
    force, solves = 0.0, 0
    if contact.has_memory:
        residual, _ = static_state(
            contact,
            lambda phase: scene.displacement(phase, 0.0, amplitude, poisson),
            STEP_SHARE * tolerance,
        )
        force = float(np.sum(contact.weight * residual[0]))
        solves = STEPS // 2
    return Run(
        mu=force,
        torque=0.0,
        distance=0.0,
        solver_residual=STEP_SHARE * tolerance * solves,
        periods=1,
        iterations=0,
        solves=solves,
        work=solves * 2 * contact.forward_position.size,
        converged=True,
        reason="",
    )


def _build(scene, velocity, amplitude, poisson, model, resolution):
    """The contact, its rings gathered where the slip starts: the closer, the slower the creep."""
    radius = scene.focus(velocity, amplitude)
    focus = radius
    if radius is not None and scene.periodic:
        layer = scene.creep(velocity, amplitude, poisson) ** (1.0 / 3.0)
        strength = np.clip(1.0 - layer, WEAKEST_FOCUS, STRONGEST_FOCUS)
        focus = Focus(radius, FOCUS_STEP * round(float(strength) / FOCUS_STEP))
    return MODELS[model].build(scene, poisson, resolution.cells, resolution.angles, focus)


def _search(contact, scene, displacement, path, tolerance, step_tolerance, guess):
    """Find the periodic state, starting near the static limit or from a known state."""
    creep = displacement(np.array([1.0]))[0][0] - displacement(np.array([0.0]))[0][0]
    pace = Pace(0.0, UNIT_STIFFNESS * creep * np.pi)
    start = forward_slip(contact)
    if contact.has_memory:

        def oscillation(phase):
            forward, lateral, angle = displacement(phase)
            return forward - creep * phase, lateral, angle

        residual, oscillating = static_state(contact, oscillation, step_tolerance)
        pace = replace(pace, static_force=float(np.sum(contact.weight * residual[0])))
        push = min(SLOW_PUSH * creep ** (2.0 / 3.0), LARGEST_PUSH)
        start = project(residual + oscillating + push * start, contact.bound)
    starts = [start, forward_slip(contact)]
    if guess is not None and guess.converged and guess.state.shape == start.shape:
        starts.insert(0, guess.state)
    for start in starts:
        found = find_periodic_state(contact, path, start, tolerance, step_tolerance, pace)
        if found.converged:
            break
    return found


def found_limit(path, step_tolerance):
    """Largest sum of residuals that a march solved to ``step_tolerance`` can leave."""
    return path.stages.shape[0] * path.stages.shape[1] * step_tolerance


def forward_slip(contact):
    """Every point on its bound, forward: the state that the search for periodicity starts from."""
    ones = np.ones_like(contact.forward_position)
    return full_slip(contact, ones, 0.0 * ones)


@dataclass(frozen=True, eq=False)
class SteadyState:
    """Where a steady motion settles: tractions, forces (3,), and the effort (see Run)."""

    state: np.ndarray
    forces: np.ndarray
    distance: float
    solver_residual: float
    stretches: int
    iterations: int
    solves: int
    converged: bool


def steady_state(contact, displacement, velocity, tolerance, step_tolerance):
    """March a steady motion until its tractions stand still to ``tolerance`` (a force)."""
    step = STEADY_TRAVEL / max(1.0, velocity)
    state, iterations, solves = forward_slip(contact), 0, 0
    previous = distance = np.inf
    for stretch in range(1, MAX_STRETCHES + 1):
        phase = step * STEADY_STRETCH * (stretch - 1) + step * np.arange(STEADY_STRETCH + 1)
        march = contact.march(make_path(displacement, phase, EULER), state, step_tolerance)
        change = energy_norm(contact, march.state - state)
        state = march.state
        iterations += march.iterations
        solves += march.solves
        # the changes of a contraction fall geometrically; what is left is their tail
        if np.isfinite(previous):
            ratio = min(change / previous, 0.9) if previous > 0.0 else 0.0
            distance = change / (1.0 - ratio)
        previous = change
        if distance <= tolerance:
            break
    solved = march.residual <= march.solves * step_tolerance
    return SteadyState(
        state,
        march.forces[-1],
        distance,
        march.residual,
        stretch,
        iterations,
        solves,
        bool(distance <= tolerance and solved),
    )


def _steady_run(contact, displacement, velocity, tolerance, step_tolerance):
    found = steady_state(contact, displacement, velocity, tolerance, step_tolerance)
    return Run(
        mu=float(found.forces[0]),
        torque=float(found.forces[2]) / hertz.TORQUE_FULL_SLIP,
        distance=found.distance,
        solver_residual=found.solver_residual,
        periods=found.stretches,
        iterations=found.iterations,
        solves=found.solves,
        work=found.solves * found.state.size,
        converged=found.converged,
        reason="" if found.converged else f"no steady state: {found.distance:.1e} left",
    )
