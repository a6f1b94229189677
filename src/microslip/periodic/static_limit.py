"""The static limit: friction of a forward motion that is infinitely slow.

The limit can be computed separately at every point.  Let q(t) be the periodic tractions of the
oscillation alone, and g(t) the friction bound.  Consider a forward velocity that tends to 0.  In
each period, every point slips forward a little when q(t) + s reaches the bound.  Here s is a
constant traction.  Such a slow drift does not change q(t).  By the flow rule, s has the largest
forward component that the bound allows:

    mu F_z mu_static = Integral { mean of q_forward
                                  + max s_forward : |q(t) + s| <= g(t) for all t } dA.

For ratcheting, this equation is the counterpart of Melan's shakedown theorem.  Some points slip in
every period even if only the oscillation acts.  At points that slip in every period, q reaches the
bound in several directions. No constant traction can then be added, so s is 0.  The mean of q at
these points is not 0 for a loop without half-period symmetry.  The reason is that the oscillation
drags the contact along.  At points that never slip, q contains an arbitrary constant.  The sum q +
s does not depend on this constant.

For a motion on a line under a constant load, q(t) moves along the segment between the tractions at
the two turning points.  After the mean of these tractions is subtracted, the tractions at the
turning points are +q and -q.  So only the two turning points matter.

Coarse runs of the static limit also give the edges of the stick zone in slow motions.  No formula
gives the edges for motions on a loop, or for pressures without a closed form.  For rotating
indenters, the radius of the edge is also the root of an integral (indenters.torsion_stick_radius).
A test compares both results.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from operator import sub
from typing import NamedTuple

import numpy as np

from microslip.contact.contact import (
    FORWARD,
    Contact,
    March,
    StepFailure,
    forward_slip,
    full_slip,
    rigid_displacement,
)
from microslip.contact.path import EULER, Path, make_path
from microslip.contact.rings import Focus
from microslip.periodic.discretise import (
    STRONGEST_FOCUS,
    Resolution,
    bounds_at_phases,
    contact_of,
    dissipated_energy,
    focus_strength,
    mean_forces,
    path_of,
    tractions_at_phases,
)
from microslip.periodic.run import (
    AS_SHIPPED,
    MARCH_SHARE,
    STEP_SHARE,
    Budget,
    Effort,
    Run,
    Settings,
    unsolved,
)
from microslip.periodic.search import Goal, PeriodicState, find_periodic_state
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Problem

QUARTER = np.linspace(0.0, np.pi / 2, 3)
"""Phases from the mean position to the second turning point.  Between turning points, the slip of
each point grows in a constant direction.  Therefore, backward Euler gives the same tractions for
any number of steps.  A second-order method can end a step below the bound.  Even a small distance
from the bound matters, because s depends on the square root of this distance."""
SLOW_LOOP = 0.02
"""If the drift is below this value, the stick zone of the static limit determines the state on a
loop.  The value is in u_lim per radian of phase."""
MARCHES, MOST_ROUNDS = 120, 3
"""MARCHES: largest number of marches in a search for the periodic state of a loop.  MOST_ROUNDS:
largest number of searches.  An accelerated search that stalls because of rounding errors is
restarted."""
HALVINGS = 50
"""Number of bisections in the search for the largest shift.  This number is enough to reach the
rounding error."""
FELT = 4.0
"""The error of the limit is this factor times the distance between the tractions and the periodic
state of the oscillation alone.  In tests, the ratio of the error to this distance was at most 3.
Slipping points are on the bound after every step, so their shift is 0."""
LOOP_STEP_SHARE = 1e-4
"""Ratio of the step tolerance to the tolerance of the periodic state.  A point's shift depends on
the square root of the distance between its traction and the bound."""
ENOUGH = 4.0
"""Largest accepted distance from the periodic state, divided by the tolerance of this distance.
Rounding errors can prevent a search from reaching the tolerance."""
ROUNDING = 1e-12
"""Tolerance of the periodic state of a contact that never sticks. A search finds this state in a
few marches."""
LARGEST_SHIFT = 1e-2
"""Largest shift of a ring outside the stick radius, divided by the largest friction bound."""


class StaticLimit(NamedTuple):
    """The static limit of a contact, see the docstring of this module.

    Attributes
    ----------
    shift : np.ndarray, shape (2, ...)
        Constant tractions s at every point.
    oscillating : np.ndarray, shape (2, ...)
        Tractions of the oscillation alone at the start of a period.
    force : float
        Mean forward force, divided by mu F_z.
    march : March
        Last march.
    """

    shift: np.ndarray
    oscillating: np.ndarray
    force: float
    march: March


def limit_on_a_line(
    contact: Contact, oscillation: Callable, step_tolerance: float, budget: Budget | None = None
) -> StaticLimit:
    """Compute the static limit of a contact from its tractions at the turning points.

    `oscillation(phase)` returns the rigid displacement without forward motion.  The first turning
    point is at the phase -pi/2.
    """
    # by Masing's rule the first quarter period from a stress-free start ends on the closed loop, at
    # the second turning point; the tractions at the first one have the opposite sign
    quarter = make_path(oscillation, QUARTER, EULER)
    march = contact.march(quarter, 0.0 * forward_slip(contact), step_tolerance)
    if budget is not None:
        budget.take(march.solves, march.iterations, march.state.size)
    shift = lens_corner(-march.state, contact.bound)
    force = float(np.sum(contact.weight * shift[FORWARD]))
    return StaticLimit(shift, -march.state, force, march)


def lens_corner(oscillating: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Return the constant tractions s at every point, for a motion on a line.

    `oscillating` and the result have the shape (2, ...), with the forward component first.

    The two discs |s +- q| <= g intersect in a lens.  s is the forward tip of one disc if the other
    disc contains this tip, otherwise the forward corner of the lens.
    """
    q_forward, q_lateral = oscillating
    size = np.hypot(q_forward, q_lateral)
    height = np.sqrt(np.maximum(bound**2 - size**2, 0.0))
    # at a point without traction, the result is the tip
    turned = np.array([np.abs(q_lateral), -np.sign(q_lateral) * q_forward])
    corner = height * (turned / np.where(size > 0.0, size, 1.0))
    # only the disc whose centre is further back can have its tip inside the other disc
    ahead = np.abs(q_forward)
    tip = np.array([bound - ahead, -np.sign(q_forward) * q_lateral])
    other = np.hypot(bound - 2.0 * ahead, 2.0 * q_lateral)
    shift = np.where(other <= bound, tip, corner)
    return np.where(size < bound, shift, 0.0)


def loop_energy(
    contact: Contact, oscillation: Callable, oscillating: np.ndarray | None = None
) -> float:
    """Compute the energy that an oscillation on a line dissipates in a period, divided by mu F_z
    u_lim.

    Each slipping point slips in a constant direction.  By Masing's rule, a point slips twice as far
    between the turning points as in the initial loading.  Therefore, the contribution of a point is
    four times the product of its friction bound and its slip in the initial loading.  The energy is
    the sum over all points.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    oscillation : callable
        Rigid displacement at a phase, as in `limit_on_a_line`.
    oscillating : np.ndarray or None
        Tractions of the oscillation at the first turning point, see StaticLimit.  None for a
        contact that never sticks; the tractions are then those of the periodic state.
    """
    if oscillating is None:
        path = make_path(oscillation, np.pi * np.array([-0.5, 0.5, 1.5]), EULER)
        start, goal = 0.0 * forward_slip(contact), Goal(ROUNDING, ROUNDING)
        oscillating = find_periodic_state(contact, path, start, goal, mirror=False).march.state
    place = np.array(oscillation(np.array(-0.5 * np.pi)), dtype=float)
    slip = rigid_displacement(contact, place) - contact.displacement(oscillating)
    return 4.0 * float(np.vdot(contact.weight * full_slip(contact, *oscillating), slip))


def limit_on_a_loop(
    contact: Contact,
    problem: Problem,
    path: Path,
    tolerance: float,
    step_tolerance: float,
    budget: Budget | None = None,
) -> tuple[StaticLimit, PeriodicState]:
    """Compute the static limit of a contact from the periodic state of the oscillation alone.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    problem : problem.Problem
        The problem at velocity 0.
    path : path.Path
        Path over a period, or half a period.
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, as forces divided by mu F_z.
    budget : run.Budget or None
        Budget of the marches.  None means unlimited.

    Returns
    -------
    tuple of StaticLimit and search.PeriodicState
        The limit, and the periodic state.
    """
    mirror, rounds, found = problem.half_period_mirror, 0, False
    start, goal = 0.0 * forward_slip(contact), Goal(tolerance, step_tolerance, MARCHES)
    marches, effort = 0, Effort()
    while not found and rounds < MOST_ROUNDS:
        periodic = find_periodic_state(contact, path, start, goal, mirror=mirror, budget=budget)
        start, found, rounds = periodic.start, periodic.converged, rounds + 1
        marches, effort = marches + periodic.marches, effort + periodic.effort
    periodic = periodic._replace(marches=marches, effort=effort)
    march, shift = periodic.march, 0.0 * start
    force = float(mean_forces(contact, problem, path, march.forces)[FORWARD])
    if contact.sticks:
        tractions, bounds = tractions_at_phases(contact, path, march)
        if mirror:
            bounds = np.concatenate([bounds, bounds])
            tractions = np.concatenate([tractions, [contact.mirrored(q) for q in tractions]])
        shift = largest_shift(tractions, bounds)
        force += float(np.sum(contact.weight * shift[FORWARD]))
    return StaticLimit(shift, start, force, march), periodic


def largest_shift(tractions: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Find the shift s with the largest forward component such that |q + s| <= g at all phases.

    The discs |q + s| <= g are convex, and so is their intersection.  The intersection contains
    s = 0 and therefore every forward shift below the largest one.

    Parameters
    ----------
    tractions : np.ndarray, shape (phases, 2, ...)
        Tractions q, forward component first.
    bounds : np.ndarray, shape (phases, ...) or broadcast to it
        Friction bounds g.  Tractions exceed them only by rounding errors.

    Returns
    -------
    np.ndarray, shape (2, ...)
        Shift s at every point.  Its lateral component is the middle of the allowed interval, or 0
        if the forward component is 0.
    """
    forward, lateral = tractions[:, 0], tractions[:, 1]
    bounds = np.maximum(bounds, np.hypot(forward, lateral))  # so that s = 0 is allowed
    least, most = np.zeros(forward.shape[1:]), 2.0 * bounds.min(axis=0)

    def reach(shift: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return whether a forward shift satisfies the friction bounds at all phases.  Also returns
        the bounds on the lateral shift."""
        across = bounds**2 - (forward + shift) ** 2
        width = np.sqrt(np.maximum(across, 0.0))
        ends = (-lateral - width).max(axis=0), (width - lateral).min(axis=0)
        return (across >= 0.0).all(axis=0), *ends

    for _ in range(HALVINGS):
        shift = 0.5 * (least + most)
        fits, low, high = reach(shift)
        fits &= low <= high
        least, most = np.where(fits, shift, least), np.where(fits, most, shift)
    _, low, high = reach(least)
    return np.array([least, np.where(least > 0.0, 0.5 * (low + high), 0.0)])


def limit_run(
    contact: Contact, problem: Problem, resolution: Resolution, tolerance: float, settings: Settings
) -> tuple[Run, np.ndarray | None]:
    """Compute the static limit of one discretised contact.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    problem : problem.Problem
        The problem at velocity 0.
    resolution : discretise.Resolution
        Resolution of the contact.
    tolerance : float
        Tolerance of the state, as a force divided by mu times the mean normal load.
    settings : run.Settings
        Settings of the run.

    Returns
    -------
    run : Run
        The run.  For a rigid contact and an oscillation on a line, the limit is 0.
    sticks : np.ndarray or None
        Mask of the points that stick; None if it is unknown.
    """
    sticks = None
    if problem.on_a_line:
        displacement, inner = problem.displacement, STEP_SHARE * tolerance
        if not contact.sticks:
            energy = loop_energy(contact, displacement)
            return Run({"friction": 0.0, "dissipation": energy}, distance=0.0, residual=0.0), None
        limit = limit_on_a_line(contact, displacement, inner, settings.budget)
        energy = loop_energy(contact, displacement, limit.oscillating)
        sticks = np.hypot(*limit.shift) > LARGEST_SHIFT * np.max(contact.bound)
        # the limit needs a march of a quarter period and no search, so there are no periods
        distance, periods = 0.0, 0.0
        effort = Effort.of(limit.march.solves, 0, limit.march.state.size)
        reason = unsolved(limit.march, inner)
    else:
        path = path_of(problem, contact, resolution.steps, settings.method.integrator)
        accuracy = tolerance / FELT
        inner = min(LOOP_STEP_SHARE, MARCH_SHARE / path.steps) * accuracy
        tolerances = accuracy, inner
        limit, periodic = limit_on_a_loop(contact, problem, path, *tolerances, settings.budget)
        # a constant traction does no work over a closed loop
        energy = dissipated_energy(contact, path, periodic.march)
        if contact.sticks:
            sticks = limit.shift[FORWARD] > LARGEST_SHIFT * bounds_at_phases(contact, path).max()
        distance, effort = FELT * periodic.distance, periodic.effort
        periods = periodic.marches * (0.5 if problem.half_period_mirror else 1.0)
        reason = unsolved(limit.march, inner)
        if periodic.distance > ENOUGH * accuracy:  # the distance is part of the error
            reason = f"no periodic state within {periods:g} periods: {periodic.distance:.1e} left"
    load = problem.mean_load
    values = {"friction": limit.force / load, "dissipation": energy}
    residual = limit.march.residual / load
    run = Run(values, distance / load, residual, periods, effort, reason)
    return run, None if reason else sticks


SLOW_LINE = 0.01
"""The stick zone of the static limit determines the state of a motion on a line if the drift is
small.  The drift must be below this value, in u_lim per radian of phase.  For loops, see
SLOW_LOOP."""
LOOP_RESOLUTION, SWEPT_RESOLUTION = Resolution(24, 4, 32), Resolution(24, 4, 96)
TOLERANCE = 1e-3
"""Resolutions and tolerance of the search for motions on a loop.  Under an oscillating load, the
edge of the contact moves across the rings, so more steps are needed."""
LINE_RESOLUTION, FINE_RESOLUTION = Resolution(48, 2, 1), Resolution(192, 2, 1)
"""Resolutions of the search for motions on a line.  This search needs no march.  Therefore, runs
with many rings are cheap.  If the edges are accurate to 5e-4 of the radius, the static limit of a
translation is accurate to 1e-4."""
FINE_TOLERANCE = 1e-5
"""Tolerance at FINE_RESOLUTION.  With a larger tolerance, some sticking rings appear to slip, and
the search does not converge."""
MOST_PASSES = 4
"""Largest number of runs in the search for the edges of the stick zone."""
MOST_EDGES = 4
"""Largest number of edges of the stick zone.  If a run has more edges, the edges are treated as
numerical scatter."""
SLIVER = 1e-3
"""If the distance between two edges is below this fraction of the contact radius, both edges are
treated as numerical scatter.  If there is little slip, the shift is almost 0 in the rings next to
an edge."""
_EDGES: dict[Problem, tuple[tuple[float, ...], Effort]] = {}
MOST_STORED = 64
"""The edges of at most this number of static limits are stored, each with the effort of the
search."""


def edge_focus(
    problem: Problem,
    model: str,
    budget: Budget | None = None,
    progress: Callable | None = None,
) -> Focus | None:
    """Choose the grading of the rings for a slow motion.

    The rings are graded towards the edges of the stick zone of the static limit.  The stick zone of
    a circular motion is smaller than that of a linear motion of the same amplitude, because slip on
    a circle never stops.  The stick zone of a contact with a hole is a ring with two edges.  Under
    an oscillating load, the edges are computed for the static limit only.

    The effort of a search is charged to every point that uses the result of the search.  Therefore,
    the work that remains in the budget of a point does not depend on earlier points.

    Parameters
    ----------
    problem : problem.Problem
        The problem.
    model : str
        Name in contact.registry.MODELS.
    budget : run.Budget or None
        Budget of the search.  None means unlimited.
    progress : callable or None
        Called before every run of the search, with the run's Resolution.

    Returns
    -------
    rings.Focus or None
        The grading.  It is None if Motion.focus gives the radius, the motion is fast, the model has
        no rings, the stick zone is not round, or the whole contact slips.

    Raises
    ------
    run.Spent
        If the budget is exceeded.
    """
    motion, drift = problem.motion, problem.drift
    if model not in ("radial", "polar") or not motion.periodic:
        return None
    if problem.on_a_line:
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
        budget.taken += effort
        budget.take()
    else:
        before, radii = budget.taken, ()
        with suppress(StepFailure):
            radii = _edges_of(limit, Settings(budget=budget), progress)
        if len(_EDGES) >= MOST_STORED:
            _EDGES.pop(next(iter(_EDGES)))
        _EDGES[limit] = radii, Effort(*map(sub, budget.taken, before))
    return Focus(radii, focus_strength(drift)) if radii else None


def _edges_of(limit: Problem, settings: Settings, progress: Callable | None) -> tuple[float, ...]:
    """Find the radii of the edges of the stick zone, for a problem at velocity 0."""
    motion, model = limit.motion, "polar" if limit.motion.rotates else "radial"
    edges = partial(stick_edges, limit, model, settings=settings, progress=progress)
    if not limit.on_a_line:
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
    """Compute the static limit at one resolution.

    For the arguments and the result, see simulate.simulate.  The velocity of the problem is 0.
    """
    if problem.on_a_line or settings.focus is not None:  # the edges are known
        contact = contact_of(problem, model, resolution, settings)
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

    The run is repeated on new rings until the radii stay the same.  The largest number of runs is
    MOST_PASSES.

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
        contact = contact_of(problem, model, resolution, replace(settings, focus=focus))
        run, sticks = limit_run(contact, problem, resolution, tolerance, settings)
        runs.append(run)
        radii = _stick_radii(contact, sticks)
        if not radii or radii == before:
            break
    return runs, radii


def _stick_radii(contact: Contact, sticks: np.ndarray | None) -> tuple[float, ...]:
    """Return the radii of the circles that separate sticking rings from slipping rings.

    A ring sticks if most of its points do.

    Two radii are removed if the distance between them is below `SLIVER`.  If there are more than
    `MOST_EDGES` radii, only the outermost radius is returned.  If `sticks` is None, no radius is
    returned.
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
