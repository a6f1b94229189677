"""Simulate a problem at one resolution.

A simulation builds the contact and the path, and then finds the state.

The steady state of a motion without oscillation is the fixed point of a march over a path of any
length.

The search for the state of a driven contact starts from the periodic state at a prescribed
velocity.  This velocity is the velocity of the spring's far end, or an approximate velocity under
the force.  The number of periods in a search does not depend on the number of steps.  To save time,
a run with many steps therefore starts from the result of a run with few steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from microslip.contact.contact import (
    FORWARD,
    TORQUE,
    Body,
    Contact,
    StepFailure,
    forward_slip,
    project,
)
from microslip.contact.path import EULER, Path, make_path
from microslip.periodic.discretise import (
    Resolution,
    contact_of,
    dissipated_energy,
    mean_forces,
    path_of,
)
from microslip.periodic.rest import run_to_rest
from microslip.periodic.run import (
    AS_SHIPPED,
    MARCH_SHARE,
    SLOW_STEP_SHARE,
    STEP_SHARE,
    TIGHTER,
    Budget,
    Effort,
    Run,
    Settings,
    failed_run,
    unsolved,
)
from microslip.periodic.search import (
    AT_REST,
    MOST_MARCHES,
    Goal,
    find_periodic_state,
)
from microslip.periodic.static_limit import SLOW_LOOP, limit_on_a_line, limit_on_a_loop, static_run
from microslip.scene.problem import Problem

STEADY_STRETCH = 8
"""Number of steps in the path of a steady motion."""
STEADY_TRAVEL = 0.5
"""Largest rigid displacement of a steady motion in one step, in u_lim."""


def steady_state(
    contact: Contact, problem: Problem, tolerance: float, budget: Budget | None = None
) -> Run:
    """Find the steady state of a motion without oscillation.

    Parameters
    ----------
    contact : contact.Contact
        The contact, in full forward slip at the start.
    problem : problem.Problem
        The steady motion; its velocity sets the length of a step.
    tolerance : float
        Tolerance of the state, as a force divided by mu F_z.
    budget : run.Budget or None
        Budget of the marches.  None means unlimited.

    Returns
    -------
    Run
        Forces and tractions of the steady state.
    """
    step = STEADY_TRAVEL / max(1.0, problem.velocity)
    path = make_path(problem.displacement, step * np.arange(STEADY_STRETCH + 1.0), EULER)
    goal, start = Goal(tolerance, STEP_SHARE * tolerance), forward_slip(contact)
    steady = find_periodic_state(contact, path, start, goal, mirror=False, budget=budget)
    march = steady.march
    reason = unsolved(march, goal.step_tolerance)
    return Run(
        {
            "friction": float(march.forces[-1, FORWARD]),
            "torque": float(march.forces[-1, TORQUE]) / problem.pressure.torque,
        },
        distance=steady.distance,
        residual=march.residual,
        effort=steady.effort,
        reason=reason if steady.converged else f"no steady state: {steady.distance:.1e} left",
        state=march.state,
    )


SLOW_EXCESS, LARGEST_EXCESS = 4.0, 0.6
"""A search starts from the static limit plus a forward traction.  This traction, divided by the
friction bound, is `SLOW_EXCESS` times drift^(2/3), but at most `LARGEST_EXCESS`.  The rise of the
friction is also proportional to drift^(2/3).  SLOW_EXCESS is large enough that the search starts
with too much forward traction.  An accelerated search converges faster from such a start."""
MARCHES_FROM_COARSER = 50
"""Largest number of marches in a search that starts from interpolated tractions.  If more marches
are needed, a search from the usual start is faster."""
DRIVEN_MARCHES = 2 * MOST_MARCHES
"""Largest number of marches in a search for a driven contact, whose body can oscillate."""
LOOSEST_START = 1e-4
"""A search for a driven contact starts from a state at a prescribed velocity.  This value is the
largest tolerance of that state at the prescribed velocity, as a force divided by mu F_z."""
COARSENING, PREPARED_FROM = 6, 96
"""PREPARED_FROM: a run of a driven contact with at least this number of steps starts from a run
with fewer steps.  COARSENING: ratio of the numbers of steps in these two runs.  Runs with fewer
steps than `PREPARED_FROM` are cheap and start directly.  Such runs suffice for a tolerance of
1e-3."""
MOST_SCALED = 4.0
"""Largest factor by which the initial tractions are scaled to match the prescribed force."""


def simulate(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    guess: Run | None = None,
    settings: Settings = AS_SHIPPED,
) -> Run:
    """Simulate a problem with a model at one resolution.

    The problem determines which state is computed.  Without oscillation, this is the steady state
    of the motion.  At velocity 0, the computed state is the static limit, or the state of rest
    under a force.  In all other cases, the periodic state is computed.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.  With a spring, the prescribed velocity is the velocity of the
        far end of the spring.  Under a prescribed force, a velocity above 0 is an initial guess.
    model : str
        Name in contact.registry.MODELS.
    resolution : discretise.Resolution
        Resolution of the model.
    tolerance : float
        Tolerance of the state: a force divided by mu times the mean normal load, a velocity under a
        prescribed force, or a displacement in u_lim for a run to rest.
    guess : Run or None
        Run of the same point.  It is the initial guess if it has the same numbers of cells and
        angles, or if the contact can interpolate its tractions.
    settings : Settings
        Settings of the run.

    Returns
    -------
    Run
        The run.  If it did not converge, its `reason` says why; no exception is raised.

    Raises
    ------
    run.Spent
        If the budget is exceeded.
    """
    method, rests = settings.method, problem.velocity == 0.0
    try:
        if method.run is not None:
            return method.run(problem, model, resolution, tolerance * problem.mean_load)
        if not problem.motion.periodic:
            contact = contact_of(problem, model, resolution, settings)
            return steady_state(contact, problem, tolerance * problem.mean_load, settings.budget)
        if rests and problem.drive is None:
            return static_run(problem, model, resolution, tolerance, settings)
        if rests and problem.force is not None:
            return run_to_rest(problem, model, resolution, tolerance, settings)
        setup = _discretised(problem, model, resolution, tolerance, settings)
        find: Any = method.search or find_periodic_state
        periods, effort = 0.0, Effort()
        for start in _starts(setup, guess):
            goal = setup.goal._replace(static_force=start.static_force, least=start.least)
            if start.near:
                goal = goal._replace(most_marches=MARCHES_FROM_COARSER, near=True)
            drive: dict[str, Any] = {}
            if setup.body is not None:
                drive = {"body": setup.body, "place": start.place}
                if problem.force is None:
                    # 1 - mu decreases at most as fast as 1 / velocity^2, as at large velocities
                    fall = 2.0 * (1.0 - start.friction) * problem.mean_load
                    drive["slope"] = fall / (problem.drift * setup.interval)
            place = setup.contact, setup.path, start.state, goal
            common = {"mirror": problem.half_period_mirror, "budget": settings.budget}
            periodic = find(*place, **common, **drive)
            periods += start.periods + setup.lap * periodic.marches
            effort += start.effort + periodic.effort
            if periodic.converged:
                break
    except StepFailure as failure:
        return failed_run(str(failure))
    march, reason = periodic.march, unsolved(periodic.march, goal.step_tolerance)
    if not periodic.converged:
        reason = f"no periodic state within {periods:g} periods: {periodic.distance:.1e} left"
    mean = mean_forces(setup.contact, problem, setup.path, march.forces)[FORWARD]
    values = {
        "friction": float(mean) / problem.mean_load,
        "dissipation": dissipated_energy(setup.contact, setup.path, march),
    }
    if setup.body is not None:
        advance = float(march.body[-1, 0] - march.body[0, 0]) / setup.interval
        values["velocity"] = problem.velocity + advance / problem.unit_drift
    return Run(
        values,
        distance=periodic.distance / setup.unit,
        residual=march.residual / setup.unit,
        periods=periods,
        effort=effort,
        reason=reason,
        state=periodic.start,
        place=march.body[0] if len(march.body) else AT_REST,
        static_force=start.static_force,
        limit=start.limit,
    )


class Start(NamedTuple):
    """Initial state of a search, and known properties of the periodic state.

    Attributes
    ----------
    state : np.ndarray
        Tractions, minus those of the static limit if `above_limit` is True.
    place : np.ndarray, shape (2,)
        x and x' of a driven body.
    above_limit : bool
        Whether the tractions of the static limit are still to be added.
    near : bool
        Whether the tractions are interpolated from a coarser mesh.
    friction : float
        Approximate friction of a driven contact.
    static_force, limit
        See run.Run.
    least : float
        See search.Goal.
    periods, effort
        Number of periods and effort of the searches that prepared the state.
    """

    state: np.ndarray
    place: np.ndarray = AT_REST
    above_limit: bool = False
    near: bool = False
    friction: float = np.nan
    static_force: float = np.nan
    limit: np.ndarray | None = None
    least: float = np.nan
    periods: float = 0.0
    effort: Effort = Effort()


class Setup(NamedTuple):
    """A discretised problem, and the goal of the search for its periodic state.

    Attributes
    ----------
    problem, model, resolution, settings
        See `simulate`.
    tolerance : float
        Tolerance in the unit of the result.
    contact : contact.Contact
        The contact.
    path : path.Path
        Path over a period, or half a period.
    body : contact.Body or None
        The driven body and its drive; None if the velocity is prescribed.
    goal : search.Goal
        Goal of the search.
    unit : float
        Force, divided by mu F_z, that corresponds to an error of 1 in the result.  If the velocity
        is prescribed or a spring pulls the contact, the result is a force.  For a prescribed force,
        the result is a velocity, and `unit` is the smaller of two estimates.  The first estimate is
        the product of two numbers: the stiffness of the contact, and the displacement of the
        contact in an interval at velocity 1.  The second estimate is the rise of the friction force
        with the velocity.
    interval, lap : float
        Length of the path as a phase, and as a number of periods.
    """

    problem: Problem
    model: str
    resolution: Resolution
    settings: Settings
    tolerance: float
    contact: Contact
    path: Path
    body: Body | None
    goal: Goal
    unit: float
    interval: float
    lap: float


def _discretised(
    problem: Problem, model: str, resolution: Resolution, tolerance: float, settings: Settings
) -> Setup:
    """Discretise a problem with a periodic state."""
    drive, full = problem.drive, problem.mean_load
    contact = contact_of(problem, model, resolution, settings)
    path = path_of(problem, contact, resolution.steps, settings.method.integrator)
    interval = float(path.phase[-1] - path.phase[0])
    rate = contact.stiffness * problem.drift
    unit, most, body = full, MOST_MARCHES, None
    gain = rate * interval
    if drive is not None:
        most, force = DRIVEN_MARCHES, (drive.force or 0.0) * full
        constant = force - drive.damping * problem.drift
        body = Body(drive.stiffness, drive.damping, drive.mass, constant)
        if drive.force is not None:  # the velocity is not known
            stuck = contact.stiffness * interval * problem.unit_drift
            unit, gain = min(stuck, settings.slope * full), np.inf
    floor = TIGHTER * SLOW_STEP_SHARE if settings.tighter else SLOW_STEP_SHARE
    share = min(max(rate * np.pi * STEP_SHARE, floor), STEP_SHARE)
    step_tolerance = min(share, MARCH_SHARE / resolution.steps) * (tolerance * unit)
    goal = Goal(tolerance * unit, step_tolerance, most, full=full, gain=gain)
    how = problem, model, resolution, settings, tolerance
    lap = 0.5 if problem.half_period_mirror else 1.0
    return Setup(*how, contact, path, body, goal, unit, interval, lap)


def _starts(setup: Setup, guess: Run | None) -> Iterator[Start]:
    """Yield initial states, best first.  If a state needs the static limit, the static limit is
    added to the state."""
    problem, contact, settings = setup.problem, setup.contact, setup.settings
    rise, tolerance = problem.drift ** (2.0 / 3.0), setup.goal.tolerance
    # the accuracy of a static limit is chosen according to the rise of friction above it
    inner, first = STEP_SHARE * max(rise, tolerance), Start(forward_slip(contact))
    if setup.body is None and (problem.straight or not contact.sticks):
        first = first._replace(static_force=0.0)
    known = None if guess is None else _from_run(setup, guess, first)
    if known is not None:
        first = first._replace(static_force=known.static_force, limit=known.limit)
    start, others = first, (_prescribed if setup.body is None else _driven)(setup, first)
    for start in others if known is None else chain([known], others):
        state = start.state
        if start.above_limit and problem.straight:
            oscillation = partial(problem.displacement, velocity=0.0)
            line = limit_on_a_line(contact, oscillation, inner, settings.budget)
            limit = line.shift + line.oscillating
            state, start = state + limit, start._replace(limit=limit)
            if not unsolved(line.march, inner):
                start = start._replace(static_force=line.force)
        elif start.above_limit:
            # the force of this limit only sets `least`
            rest = replace(problem, velocity=0.0)
            steps, integrator = setup.resolution.steps, settings.method.integrator
            path = path_of(rest, contact, steps, integrator)
            place = contact, rest, path, max(rise, tolerance), inner
            loop, oscillating = limit_on_a_loop(*place, settings.budget)
            state = loop.oscillating + loop.shift + state
            periods, effort = setup.lap * oscillating.marches, oscillating.effort
            start = start._replace(least=loop.force, periods=periods, effort=effort)
        if start.above_limit or start.near:
            state = project(state, contact.bound)
        yield start._replace(state=state)
    if setup.body is None:
        slipping = forward_slip(contact)
        yield start._replace(state=slipping, near=False, periods=0.0, effort=Effort())


def _prescribed(setup: Setup, start: Start) -> Iterator[Start]:
    """Yield initial states at a prescribed velocity, best first."""
    problem, contact = setup.problem, setup.contact
    rise, slow = problem.drift ** (2.0 / 3.0), problem.drift < SLOW_LOOP
    if problem.straight:
        # if the drift alone adds full friction in an interval, Goal.drift_error is at most the
        # change of the state, whatever the limit
        slow = setup.goal.gain < problem.mean_load
    if slow and contact.sticks:
        # for a loop, a factor of SLOW_EXCESS would prevent convergence at the smallest drifts
        excess = min(SLOW_EXCESS * rise, LARGEST_EXCESS) if problem.straight else rise
        start = start._replace(state=excess * start.state, above_limit=True)
    if setup.settings.method.prepared:
        yield start


def _from_run(setup: Setup, run: Run, start: Start) -> Start | None:
    """Return the initial state that follows from a converged run.

    Returns None if the tractions of the run are unknown or cannot be interpolated.
    """
    contact, state = setup.contact, run.state
    if state is None or run.reason:
        return None
    start = start._replace(place=run.place, friction=run.values["friction"])
    if state.shape == (2, *contact.forward_position.shape):
        return start._replace(state=state, static_force=run.static_force, limit=run.limit)
    # the static limit, which has kinks, is computed on each mesh
    above = run.limit is not None
    near = contact.prolong(state - run.limit if above else state)
    return None if near is None else start._replace(state=near, near=True, above_limit=above)


def _driven(setup: Setup, start: Start) -> Iterator[Start]:
    """Yield initial states under a prescribed force or on a spring, best first."""
    problem, resolution, contact = setup.problem, setup.resolution, setup.contact
    body, force, full = setup.body, problem.force, problem.mean_load
    assert body is not None
    periods, effort = 0.0, Effort()
    if resolution.steps >= PREPARED_FROM:  # a run with fewer steps has a similar state
        fewer = replace(resolution, steps=resolution.steps // COARSENING)
        run = simulate(problem, setup.model, fewer, setup.tolerance, settings=setup.settings)
        periods, effort = run.periods, run.effort
        known = _from_run(setup, run, start)
        if known is not None:
            yield known._replace(periods=periods, effort=effort)
            periods, effort = 0.0, Effort()
    share, free = max(setup.goal.tolerance, LOOSEST_START) / full, replace(problem, drive=None)
    run = simulate(free, setup.model, resolution, share, settings=setup.settings)
    start = start._replace(
        friction=run.mu,
        static_force=run.static_force,
        limit=run.limit,
        periods=periods + run.periods,
        effort=effort + run.effort,
    )
    # tractions at a prescribed velocity, and their mean force over a period
    slipping = forward_slip(contact)
    starts = [(slipping, float(np.sum(contact.weight * slipping[0])))]
    if run.state is not None:
        starts.insert(0, (run.state, run.mu * full))
    for tractions, mean in starts:
        if force is not None:
            if mean > 0.0 and 0.0 <= force * full < MOST_SCALED * mean:
                tractions = tractions * (force * full / mean)
            tractions = project(tractions, contact.bound)
        place = (body.load - mean) / body.stiffness if body.stiffness else 0.0
        yield start._replace(state=tractions, place=np.array([place, 0.0]))
        start = start._replace(periods=0.0, effort=Effort())
