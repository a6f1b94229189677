"""One run at a prescribed velocity for a body on several contacts, which do not interact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from microslip.models.path import make_path
from microslip.motions.problem import Part, Problem
from microslip.solver.discretise import Resolution
from microslip.solver.effort import Effort
from microslip.solver.run import AS_SHIPPED, Run, Settings
from microslip.solver.simulate import simulate

LEAD_STEPS = 8
"""Number of time steps before the path of the body begins."""
LEAD_TOLERANCE = 1e-6
"""Tolerance of each of these steps, as a force divided by mu F_z."""


def simulate_each(
    problem: Problem,
    model: str,
    resolution: Resolution,
    tolerance: float,
    settings: Settings = AS_SHIPPED,
) -> Run:
    """Run a model at one resolution, for one contact or for a body on several contacts.

    The arguments are those of simulate.simulate.  The forces on a body are the mean forces on its
    contacts, weighted by their loads.  The state of a body consists of the tractions of all
    contacts, side by side, at the start of the body's path.  The state is None if any contact has
    no state.
    """
    if not problem.parts:
        return simulate(problem, model, resolution, tolerance, settings=settings)
    alone = {}
    for part in problem.parts:
        if part.problem not in alone:
            alone[part.problem] = simulate(
                part.problem, model, resolution, tolerance, settings=settings
            )
    runs, shares = list(alone.values()), [part.share for part in problem.parts]
    state = None
    if all(run.state is not None for run in runs):
        states = [
            _tractions_at_start(problem, part, model, resolution, (alone[part.problem], settings))
            for part in problem.parts
        ]
        state = np.concatenate(states, axis=-1)

    def weighted(name: str, shares: Sequence[float] = shares) -> float:
        values = [getattr(alone[part.problem], name) for part in problem.parts]
        return float(np.dot(shares, values))

    return Run(
        mu=weighted("mu", problem.shares),
        torque=weighted("torque"),
        distance=max(run.distance for run in runs),
        solver_residual=max(run.solver_residual for run in runs),
        periods=max(run.periods for run in runs),
        effort=sum((run.effort for run in runs), Effort()),
        converged=all(run.converged for run in runs),
        reason=next((run.reason for run in runs if run.reason), ""),
        state=state,
        static_force=weighted("static_force"),
    )


def _tractions_at_start(
    problem: Problem,
    part: Part,
    model: str,
    resolution: Resolution,
    result: tuple[Run, Settings],
) -> np.ndarray:
    """Tractions of a contact at the start of the body's path.

    `result` contains the contact's own run, with its periodic state, and the settings of this run.
    """
    run, settings = result
    alone = part.problem
    contact = settings.contact(alone, model, resolution)
    first = alone.start
    ahead = problem.start + part.lead - first
    interval = np.pi if alone.half_period_mirror else 2.0 * np.pi
    times, remainder = divmod(ahead, interval)
    state = run.state
    assert state is not None  # checked by simulate_each
    if remainder > 0.0:
        phases = first + np.linspace(0.0, remainder, LEAD_STEPS + 1)
        path = make_path(alone.displacement, phases, depth=alone.depth)
        state = contact.march(path, state, LEAD_TOLERANCE).state
    mirrored = alone.half_period_mirror and int(times) % 2 == 1
    return contact.mirrored(state) if mirrored else state
