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
from microslip.solver.static_run import edges_on_a_line, edges_on_a_loop

SLOW_LINE = 0.01
"""Drift in a radian, in u_lim, below which the stick zone of the static limit governs the state on
a line; for loops see static_loop.SLOW_LOOP."""
LOOP_RESOLUTION, SWEPT_RESOLUTION = Resolution(24, 4, 32), Resolution(24, 4, 96)
TOLERANCE = 1e-3
"""Resolution and tolerance at which its edge is found on a loop, and where the load oscillates:
there the edge of the contact sweeps over the rings, which asks for more steps."""
LINE_RESOLUTION, FINE_RESOLUTION = Resolution(48, 2, 1), Resolution(192, 2, 1)
"""And on a line, where nothing is marched, so more rings are cheap.  Edges that were found to half
a thousandth of the radius leave 1e-4 in the limit of a translation until rings are as narrow."""
FINE_TOLERANCE = 1e-5
"""Tolerance on so many rings: at a larger one some that stick seem to have nothing left, and the
search for the edge does not settle."""


def edge_focus(
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
        needed = problem.pressure != HERTZ and motion.half_disc and drift < SLOW_LINE
    else:
        slow = not motion.loads and model == "radial" and drift < SLOW_LOOP
        needed = drift == 0.0 or slow
    if not needed:
        return None
    # at nu = 0, since Poisson's ratio moves the edges little
    limit = replace(problem, velocity=0.0, poisson=0.0, drive=None, contacts=())
    radii = _search_of(limit).within(budget or Budget(), progress)
    return Focus(radii, focus_strength(drift)) if radii else None


class _EdgeSearch:
    """A search for the edges of the stick zone of a static limit, done once.

    `radii` are these edges over the contact radius, None before the search.  The effort of the
    search is charged to every point that uses its result, so that the work allowed for a point does
    not depend on the points before it.
    """

    def __init__(self, limit: Problem):
        self.limit = limit
        self.radii: tuple[float, ...] | None = None
        self.marches: list[tuple[int, int, int]] = []

    def within(self, budget: Budget, progress: Callable | None) -> tuple[float, ...]:
        """The radii; raises Spent if the budget is exceeded."""
        if self.radii is None:
            metered = _Recorder(budget)
            try:
                self.radii = self._edges(Settings(budget=metered), progress)
            except StepFailure:
                self.radii = ()
            self.marches = metered.marches
        else:
            for march in self.marches:
                budget.take(*march)
        return self.radii

    def _edges(self, settings: Settings, progress: Callable | None) -> tuple[float, ...]:
        limit, motion = self.limit, self.limit.motion
        model = "polar" if motion.rotates else "radial"
        if not at_turning_points(limit):
            resolution = SWEPT_RESOLUTION if motion.loads else LOOP_RESOLUTION
            resolution = replace(resolution, steps=resolution.steps * motion.cycles)
            return edges_on_a_loop(limit, model, resolution, TOLERANCE, settings, progress)[1]
        if limit.focus is not None and not motion.rotates:
            return ()  # the motion has a closed form of the edge under this pressure
        search = partial(edges_on_a_line, limit, model, settings=settings, progress=progress)
        radii = search(LINE_RESOLUTION, TOLERANCE)
        if radii and not motion.rotates:
            radii = search(FINE_RESOLUTION, FINE_TOLERANCE, near=radii)
        return radii


class _Recorder(Budget):
    """A budget that records what each march takes from another budget."""

    def __init__(self, budget: Budget):
        super().__init__()
        self.budget = budget
        self.marches: list[tuple[int, int, int]] = []

    def take(self, solves: int, iterations: int, unknowns: int) -> None:
        self.budget.take(solves, iterations, unknowns)
        self.marches.append((solves, iterations, unknowns))


@lru_cache(maxsize=64)
def _search_of(limit: Problem) -> _EdgeSearch:
    """The _EdgeSearch of a static limit."""
    return _EdgeSearch(limit)
