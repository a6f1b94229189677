"""Radius of the slip front of slow motions, by a coarse run of the static limit.

The run serves pressures without a closed form.  For rotating indenters the radius is also the root
of an integral (indenters.torsion_stick_radius); a test compares the two."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial

from microslip.models.contact import StepFailure
from microslip.models.rings.mesh import Focus
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.budget import Budget
from microslip.solver.discretise import Resolution, focus_strength
from microslip.solver.run import Settings
from microslip.solver.static_limit import at_turning_points
from microslip.solver.static_loop import SLOW_LOOP
from microslip.solver.static_run import gathered_on_a_line, gathered_on_a_loop

SLOW_LINE = 0.01
"""Drift in a radian, in u_lim, below which the stick zone of the static limit governs the state on
a line; for loops see static_loop.SLOW_LOOP."""
TELLING_LOOP, TELLING_SWEPT, TOLD = Resolution(24, 4, 32), Resolution(24, 4, 96), 1e-3
"""Resolution and tolerance at which its edge is found on a loop, and where the load oscillates:
there the edge of the contact sweeps over the rings, which asks for more steps."""
TELLING_LINE, TELLING_FINER = Resolution(48, 2, 1), Resolution(192, 2, 1)
"""And on a line, where nothing is marched, so more rings are cheap.  Edges that were found to half
a thousandth of the radius leave 1e-4 in the limit of a translation until rings are as narrow."""
TOLD_FINER = 1e-5
"""Tolerance on so many rings: at a larger one some that stick seem to have nothing left, and the
search for the edge does not settle."""


def found_focus(
    problem: Problem,
    model: str,
    budget: Budget | None = None,
    progress: Callable | None = None,
) -> Focus | None:
    """Radii that the rings of a slow motion are graded towards: the edges of the stick zone in the
    limit of vanishing velocity.

    For a circular motion in the plane the edge lies further inside than for a motion of the same
    amplitude along a line, since the slip never comes to rest.  A contact with a hole sticks on a
    ring, which has two edges.  Under an oscillating load the edges are computed for the limit only.

    Parameters
    ----------
    problem : problem.Problem
        Any.
    model : str
        Name in models.registry.MODELS.
    budget : budget.Budget or None
        What the runs of the search may take; None: as much as they do.
    progress : callable or None
        Called with the Resolution of every run of the search before it starts.

    Returns
    -------
    mesh.Focus or None
        None: the motion tells (Motion.focus) or is fast, the model has no rings, what sticks is not
        round, or all of the contact slips.

    Raises
    ------
    budget.Spent
        Where the budget is.
    """
    motion, drift = problem.motion, problem.drift
    if model not in ("radial", "polar") or not motion.periodic:
        return None
    if at_turning_points(problem):
        wanted = problem.pressure != HERTZ and motion.half_disc and drift < SLOW_LINE
        search = _on_a_line
    else:
        slow = not motion.loads and model == "radial" and drift < SLOW_LOOP
        wanted = drift == 0.0 or slow
        search = _on_a_loop
    if not wanted:
        return None
    radii = search(_limit(problem)).within(budget or Budget(), progress)
    return Focus(radii, focus_strength(drift)) if radii else None


class _EdgeSearch:
    """A search for the edges of what never slips, done once.

    `radii` are these edges over the contact radius, None until they are found.  What its marches
    took counts for every point that uses them, so that the work which a point may take does not
    depend on what was asked before.
    """

    def __init__(self, locate: Callable[[Settings, Callable | None], tuple[float, ...]]):
        self.locate = locate
        self.radii: tuple[float, ...] | None = None
        self.marches: list[tuple[int, int, int]] = []

    def within(self, budget: Budget, progress: Callable | None) -> tuple[float, ...]:
        """The radii; raises Spent where the budget is."""
        if self.radii is None:
            metered = _Recorder(budget)
            self.radii = self.locate(Settings(budget=metered), progress)
            self.marches = metered.marches
        else:
            for march in self.marches:
                budget.take(*march)
        return self.radii


class _Recorder(Budget):
    """A budget that remembers what each march took from another one."""

    def __init__(self, budget: Budget):
        super().__init__()
        self.budget = budget
        self.marches: list[tuple[int, int, int]] = []

    def take(self, solves: int, iterations: int, unknowns: int) -> None:
        self.budget.take(solves, iterations, unknowns)
        self.marches.append((solves, iterations, unknowns))


def _limit(problem: Problem) -> Problem:
    """The static limit at nu = 0: Poisson's ratio moves the edges little."""
    return Problem(
        problem.motion,
        0.0,
        problem.amplitude,
        pressure=problem.pressure,
        backward=problem.backward,
        follows=problem.follows,
    )


@lru_cache(maxsize=64)
def _on_a_line(limit: Problem) -> _EdgeSearch:
    """The _EdgeSearch of a motion on a line."""
    rotates = limit.motion.rotates

    def locate(settings: Settings, progress: Callable | None) -> tuple[float, ...]:
        if limit.focus is not None and not rotates:
            return ()  # ... of an indenter, by its profile
        model = "polar" if rotates else "radial"
        try:
            search = partial(gathered_on_a_line, limit, model, settings=settings, progress=progress)
            radii = search(TELLING_LINE, TOLD)
            if radii and not rotates:
                radii = search(TELLING_FINER, TOLD_FINER, near=radii)
            return radii
        except StepFailure:
            return ()

    return _EdgeSearch(locate)


@lru_cache(maxsize=64)
def _on_a_loop(limit: Problem) -> _EdgeSearch:
    """The _EdgeSearch of a motion on a loop."""
    motion = limit.motion
    telling = TELLING_SWEPT if motion.loads else TELLING_LOOP
    telling = replace(telling, steps=telling.steps * motion.cycles)

    def locate(settings: Settings, progress: Callable | None) -> tuple[float, ...]:
        model = "polar" if motion.rotates else "radial"
        try:
            return gathered_on_a_loop(limit, model, telling, TOLD, settings, progress)[1]
        except StepFailure:
            return ()

    return _EdgeSearch(locate)
