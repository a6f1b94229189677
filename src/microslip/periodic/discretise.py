"""Discretise a problem in space and time, and evaluate the time integration.

Some functions build the mesh of the contact and the path in time.  Other functions compute
tractions, friction bounds, mean forces and the dissipated energy from a march (a time integration
along the path).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from microslip.contact.contact import Contact, March, project
from microslip.contact.path import (
    LONG_STROKE,
    SDIRK2,
    Integrator,
    Path,
    make_path,
    phases_between,
)
from microslip.contact.registry import MODELS
from microslip.contact.rings import Focus
from microslip.periodic.run import AS_SHIPPED, Settings
from microslip.scene.problem import Problem

WEAKEST_FOCUS, STRONGEST_FOCUS, STATIC_FOCUS = 0.3, 1.0 - 2.0**-6, 0.9
"""Values of rings.Focus.strength: the smallest value, the largest value, and the value for the
static limit."""


@dataclass(frozen=True, order=True)
class Resolution:
    """Resolution of a problem.

    Attributes
    ----------
    cells : int
        Number of rings, or of squares along a side.
    angles : int
        Number of angular points on half the disc.
    steps : int
        Number of time steps in half a period; not used for steady motions.
    """

    cells: int
    angles: int
    steps: int


def focus_strength(drift: float) -> float:
    """Return the strength of the ring grading towards the stick radius.

    `drift` is the forward displacement per radian of phase, in u_lim. The drift is 0 for the static
    limit.

    In a layer of width drift^(2/3) at the stick radius, the slip is as small as the drift.  Ring
    widths grow quadratically from the stick radius.  Therefore, the ratio of the smallest to the
    mean ring width should be the square root of the width of this layer.  The ratio is rounded to a
    power of two, so that different points share meshes.
    """
    if drift == 0.0:
        return STATIC_FOCUS
    layer = 2.0 ** round(math.log2(drift) / 3.0)
    return min(max(1.0 - layer, WEAKEST_FOCUS), STRONGEST_FOCUS)


def contact_of(
    problem: Problem, model: str, resolution: Resolution, settings: Settings = AS_SHIPPED
) -> Contact:
    """Build the contact of a problem with a method's step solver.

    Parameters
    ----------
    problem : Problem
        The problem.  If its normal load oscillates, the contact carries the load at the start of a
        period.
    model : str
        Name in contact.registry.MODELS.
    resolution : Resolution
        Resolution of the model.
    settings : run.Settings
        Settings of the run.

    Raises
    ------
    run.Spent
        If one march would exceed the budget.  The contact is not built in this case.
    """
    cells, angles, steps = resolution.cells, resolution.angles, resolution.steps
    settings.budget.take(next_work=steps * cells * angles)
    focus: Focus | float | None = settings.focus
    if focus is None:
        focus = radius = problem.focus
        if radius is not None and problem.motion.periodic:
            focus = Focus((radius,), focus_strength(problem.drift))
    contact = MODELS[model].build(problem, cells, angles, focus)
    if problem.depth is not None:
        deepest = problem.motion.deepest(problem.size, problem.pressure)
        start = float(problem.depth(np.array(problem.turns[0])))
        contact = contact.at_indentation(deepest, start)
    method = settings.method
    return contact if method.dress is None else method.dress(contact, **method.parameters)


STRONGEST_GRADING = 0.8
"""Largest grading of the steps."""
GRADED_DRIFT = 0.02
"""Drift per radian of phase, in u_lim, at which the grading is half its largest value."""
GRADED_STROKE = 2.0
"""Stroke in u_lim at which the grading is half its largest value."""


def path_of(problem: Problem, contact: Any, steps: int, integrator: Integrator = SDIRK2) -> Path:
    """Build the path of a problem.  The path starts at a turning point.

    The path covers half a period if the second half is the mirror image of the first, and a whole
    period otherwise.

    Steps are graded towards the turning points.  With the grading g (0 to 0.8), a step at a turning
    point is (1 - g) times as long as the mean step.  If drift and stroke are small, most forward
    slip of a half period occurs near the turning points.  If the stroke is long, the whole contact
    slides soon after a turning point.

    A motion along a line with a stroke above LONG_STROKE has a zone of equal steps at each turning
    point.  `width` is half the width of this zone, expressed as a phase.  Outside the zone, the
    length of a step is proportional to the distance from the turning point.  The slip reverses
    while the velocity of the oscillation is below the larger of two values: u_lim per radian, and
    the drift.  This reversal takes the phase max(1, drift) / stroke.  Above LONG_STROKE, the zone
    shrinks gradually as the stroke grows, because of the term LONG_STROKE**2 / stroke.  At the
    stroke LONG_STROKE, the longest step is twice as long as the shortest.

    Parameters
    ----------
    problem : Problem
        The problem.
    contact : Contact
        The contact, or another object with the attribute `grading`.  If `grading` is not None, it
        replaces the default grading of the time steps for the problem.
    steps : int
        Approximate number of steps in half a period.
    integrator : path.Integrator
        Time integrator; it sets the positions of the stages.
    """
    drift, stroke, grading, width = problem.drift, problem.stroke, contact.grading, math.inf
    if grading is None:
        slow = 1.0 / (1.0 + drift / GRADED_DRIFT)
        short = 1.0 / (1.0 + (stroke / GRADED_STROKE) ** 2)
        grading = STRONGEST_GRADING * slow * short
    # on a loop the slip can reverse at any phase
    if stroke > LONG_STROKE and problem.straight and problem.motion.periodic:
        width = max(1.0, drift, LONG_STROKE**2 / stroke) / stroke
    phases = phases_between(problem.turns, steps, grading, width)
    return make_path(problem.displacement, phases, integrator, problem.depth)


def tractions_at_phases(
    contact: Contact, path: Path, march: March, rows: np.ndarray | slice = slice(None)
) -> tuple[np.ndarray, np.ndarray]:
    """Return two arrays for phases of the path: the tractions of a march, and the friction bounds.

    The two arrays have the shapes (phases, 2, ...) and (phases, ...).  `rows` contains the indices
    of the phases.  By default, all phases are used.  If the last stage of a step lies before the
    end of the step, all phases are needed.
    """
    assert march.fields is not None  # true for contacts whose points can stick
    bounds = bounds_at_phases(contact, path)
    bounds = bounds if len(bounds) == 1 else bounds[rows]
    stages = np.moveaxis(march.fields[:: len(path.carry)][rows], 1, 0)
    tractions = np.moveaxis(project(stages, bounds), 1, 0)
    if path.end < 1.0:  # extrapolate from the stage of each step
        tractions[0] = march.fields[0]
        for before, at in zip(tractions, tractions[1:], strict=False):
            at += (1.0 / path.end - 1.0) * (at - before)
    return tractions, np.broadcast_to(bounds, tractions[:, 0].shape)


def bounds_at_phases(contact: Contact, path: Path) -> np.ndarray:
    """Return the friction bounds at every phase.

    The shape is (steps + 1, 1, n). If the bounds are constant, the first axis has the length 1.
    """
    if path.depth is None:
        return contact.bound[None]
    return contact.bounds_along(path)[:: len(path.carry), None]


def mean_forces(contact: Contact, problem: Problem, path: Path, forces: np.ndarray) -> np.ndarray:
    """Compute the mean forces over a march, as an array of shape (3,).

    `forces` are the forces at the phases of the path.
    """
    if problem.depth is None:
        return path.weights @ forces
    # the mean force in full slip is known exactly, so the trapezoidal rule integrates only
    # the difference from it
    bounds = contact.bounds(problem.depth(path.phase))
    full = contact.angles * (bounds @ contact.weight)[:, None] * [1.0, 0.0, 0.0]
    return [problem.mean_load, 0.0, 0.0] - path.weights @ (full - forces)


def dissipated_energy(contact: Contact, path: Path, march: March) -> float:
    """Compute the energy that friction dissipates in a period, divided by mu F_z u_lim.

    The elastic energy is the same at both ends of a period.  An oscillating normal load does no net
    work, because the load is a function of the indentation.  So the dissipated energy is the work
    of the tangential forces on the rigid displacements of the contact.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    path : path.Path
        Path over a period, or over half a period if the second half is the mirror image of the
        first.
    march : March
        March along this path from a periodic state.
    """
    moves = path.positions[1:] - path.positions[:-1]
    if len(march.body):
        moves[:, 0] += march.body[1:, 0] - march.body[:-1, 0]
    work = 0.5 * np.vdot(march.forces[1:] + march.forces[:-1], moves)
    return float(work) * 2.0 * np.pi / (path.phase[-1] - path.phase[0])
