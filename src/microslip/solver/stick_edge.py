"""Radius of the slip front in slow motions, computed by a coarse run of the static limit.

The run is needed for pressures without a closed form.  For rotating indenters, the radius is also
the root of an integral (indenters.torsion_stick_radius); a test compares both results.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial

from microslip.contact.contact import StepFailure
from microslip.contact.rings import Focus
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.budget import Budget
from microslip.solver.discretise import Resolution, focus_strength
from microslip.solver.run import Settings
from microslip.solver.static_limit import at_turning_points
from microslip.solver.static_loop import SLOW_LOOP
from microslip.solver.static_run import edges_on_a_line, edges_on_a_loop

SLOW_LINE = 0.01
"""The stick zone of the static limit determines the state of a motion on a line if the drift is
below this value, in u_lim per radian of phase.  For loops, see static_loop.SLOW_LOOP."""
LOOP_RESOLUTION, SWEPT_RESOLUTION = Resolution(24, 4, 32), Resolution(24, 4, 96)
TOLERANCE = 1e-3
"""Resolutions and tolerance of the search for motions on a loop.  Under an oscillating load, the
edge of the contact moves across the rings, so more steps are needed."""
LINE_RESOLUTION, FINE_RESOLUTION = Resolution(48, 2, 1), Resolution(192, 2, 1)
"""Resolutions of the search for motions on a line.  This search needs no march, so many rings are
cheap.  If the edges are accurate to 5e-4 of the radius, the static limit of a translation is
accurate to 1e-4."""
FINE_TOLERANCE = 1e-5
"""Tolerance at FINE_RESOLUTION.  With a larger tolerance, some sticking rings appear to slip, and
the search does not converge."""


def edge_focus(
    problem: Problem,
    model: str,
    budget: Budget | None = None,
    progress: Callable | None = None,
) -> Focus | None:
    """Grading of the rings for a slow motion, towards the edges of the static limit's stick zone.

    The stick zone of a circular motion is smaller than that of a linear motion of the same
    amplitude, because slip on a circle never stops.  The stick zone of a contact with a hole is a
    ring with two edges.  Under an oscillating load, the edges are computed for the static limit
    only.

    Parameters
    ----------
    problem : problem.Problem
        The problem.
    model : str
        Name in contact.registry.MODELS.
    budget : budget.Budget or None
        Budget of the search.  None means unlimited.
    progress : callable or None
        Called before every run of the search, with the run's Resolution.

    Returns
    -------
    mesh.Focus or None
        The grading.  It is None if Motion.focus gives the radius, the motion is fast, the model has
        no rings, the stick zone is not round, or the whole contact slips.

    Raises
    ------
    budget.Spent
        If the budget is exceeded.
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
    # at nu = 0, since Poisson's ratio hardly changes the edges
    limit = replace(problem, velocity=0.0, poisson=0.0, drive=None)
    radii = _search_of(limit).within(budget or Budget(), progress)
    return Focus(radii, focus_strength(drift)) if radii else None


class _EdgeSearch:
    """Search for the stick zone's edges in a static limit.  The search is done only once.

    `radii` are the edges' radii divided by the contact radius, or None before the search.  The
    effort of the search is charged to every point that uses the result.  So the work left for a
    point does not depend on earlier points.
    """

    def __init__(self, limit: Problem):
        self.limit = limit
        self.radii: tuple[float, ...] | None = None
        self.marches: list[tuple[int, int, int]] = []

    def within(self, budget: Budget, progress: Callable | None) -> tuple[float, ...]:
        """Return the radii; raises Spent if the budget is exceeded."""
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
            return ()  # the edge has a closed form for this motion and pressure
        search = partial(edges_on_a_line, limit, model, settings=settings, progress=progress)
        radii = search(LINE_RESOLUTION, TOLERANCE)
        if radii and not motion.rotates:
            radii = search(FINE_RESOLUTION, FINE_TOLERANCE, near=radii)
        return radii


class _Recorder(Budget):
    """A budget that charges each march to another budget and records the effort."""

    def __init__(self, budget: Budget):
        super().__init__()
        self.budget = budget
        self.marches: list[tuple[int, int, int]] = []

    def start(self) -> None:
        self.budget.start()

    def take(self, solves: int, iterations: int, unknowns: int) -> None:
        self.budget.take(solves, iterations, unknowns)
        self.marches.append((solves, iterations, unknowns))


@lru_cache(maxsize=64)
def _search_of(limit: Problem) -> _EdgeSearch:
    """The _EdgeSearch of a static limit."""
    return _EdgeSearch(limit)
