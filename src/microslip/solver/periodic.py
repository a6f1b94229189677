"""Search for the periodic state, the fixed point of the march over a period or half a period.

The transients of a plain march last about 1/(2 pi v~) periods.  Anderson acceleration of the map
finds its fixed point much sooner, in compiled code (states/search.py).  Reduced models that have no
compiled system of equations compute their periodic state directly.
"""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING, cast

import numpy as np

from microslip.models.contact import DirectContact, StepFailure, energy_norm
from microslip.solver.period_map import DriftRate, Goal, PeriodicState, PeriodMap
from microslip.states import search

if TYPE_CHECKING:
    from microslip.models.system_contact import SystemContact


def find_periodic_state(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """March periods until the state is periodic to within the tolerance.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map over a (half) period.
    start : np.ndarray
        Start state.
    goal : period_map.Goal
        Tolerances and largest number of marches.

    Returns
    -------
    period_map.PeriodicState
        The result of the search.  `converged` is False if the search failed.

    Raises
    ------
    StepFailure
        If the tractions diverge.
    """
    if not period_map.contact.compiled:
        return _direct_state(period_map, goal)
    contact = cast("SystemContact", period_map.contact)  # or a contact wrapped to count its marches
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
    finished, most = False, goal.most_marches
    while not finished and memory.counts[0] < most:
        marches, iterations = memory.counts[:2]
        affordable = contact.affordable(path.solves * tractions.size)
        some = int(min(most - marches, affordable))
        finished, broken = search.search(system, loading, inertia, target, memory, some)
        if broken:
            signal.raise_signal(signal.SIGINT)
        count = int(memory.counts[0] - marches)
        contact.take(count * path.solves, int(memory.counts[1] - iterations), tractions.size)
    marches, iterations = map(int, memory.counts[:2])
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
        marches=marches,
        iterations=iterations,
        solves=marches * path.solves,
        converged=bool(converged),
        body=body,
        fields=layout.unpack(memory.guess),
    )


def _direct_state(period_map: PeriodMap, goal: Goal) -> PeriodicState:
    """The PeriodicState of a contact with a direct solution, checked by one march."""
    contact, path = cast(DirectContact, period_map.contact), period_map.path
    start = contact.periodic_state(path, period_map.mirror)
    march = contact.march(path, start, goal.step_tolerance)
    distance = energy_norm(contact, period_map.image(march.state) - start)
    return PeriodicState(
        forces=march.forces,
        start=start,
        residual=distance,
        distance=distance,
        solver_residual=march.residual,
        marches=1,
        iterations=march.iterations,
        solves=march.solves,
        converged=distance <= goal.tolerance,
    )
