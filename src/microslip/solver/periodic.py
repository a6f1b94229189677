"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point by Anderson acceleration, in compiled code
(states/search.py) where the contact has a system.
"""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING, cast

import numpy as np

from microslip.models.contact import StepFailure
from microslip.solver import anderson
from microslip.solver.period_map import DriftRate, Goal, PeriodicState, PeriodMap
from microslip.states import search

if TYPE_CHECKING:
    from microslip.models.system_contact import SystemContact


def find_periodic_state(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """March periods until the state repeats itself to the tolerance.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map over a (half) period.
    start : np.ndarray
        State of the map.
    goal : period_map.Goal
        What to reach.

    Returns
    -------
    period_map.PeriodicState
        Never raises for want of convergence: see `converged` there.

    Raises
    ------
    StepFailure
        Where the tractions blow up.
    """
    if not period_map.contact.compiled:
        return anderson.search(period_map, start, goal)
    contact = cast("SystemContact", period_map.contact)  # or one that counts its marches
    path, rate = period_map.path, period_map.drift_rate
    slow = rate or DriftRate(0.0, 0.0, np.inf)
    target = search.Goal(
        float(goal.tolerance),
        float(goal.step_tolerance),
        bool(period_map.mirror),
        bool(goal.near),
        path.share,
        float(slow.static_force),
        float(slow.static_force if np.isnan(slow.least) else slow.least),
        float(slow.full),
        float(slow.gain),
    )
    tractions, place = period_map.parts(start)
    stages = path.stages.shape[1]
    layout = contact.layout
    memory = search.memory_of(layout.pack(tractions), place, stages, path.steps, target)
    system, loading, inertia = contact.system(), contact.loading(path), period_map.inertia()
    done, most = False, goal.most_marches - period_map.marches
    while not done and memory.counts[0] < most:
        marches, iterations = memory.counts[:2]
        affordable = contact.affordable(path.steps * stages * tractions.size)
        some = int(min(most - marches, affordable))
        done, broken = search.search(system, loading, inertia, target, memory, some)
        if broken:
            signal.raise_signal(signal.SIGINT)
        marched = int(memory.counts[0] - marches)
        contact.take(
            marched * path.steps * stages, int(memory.counts[1] - iterations), tractions.size
        )
    period_map.marches += int(memory.counts[0])
    period_map.iterations += int(memory.counts[1])
    period_map.solves = period_map.marches * path.steps * stages
    state, forces, body, numbers = memory.best
    state = layout.unpack(state)
    distance, residual, solver_residual, converged = map(float, numbers)
    if np.isnan(distance):
        raise StepFailure("diverged: tractions are not finite")
    return PeriodicState(
        forces=forces,
        start=period_map.state(state, body[0]),
        residual=residual,
        distance=distance,
        solver_residual=solver_residual,
        marches=period_map.marches,
        iterations=period_map.iterations,
        solves=period_map.solves,
        converged=bool(converged),
        body=body,
        fields=layout.unpack(memory.guess),
    )
