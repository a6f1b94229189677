"""Where slow slip starts, found by a coarse run of the static limit where no number is at hand.

Of indenters that turn there is an integral to search for a root (indenters.torsion_stick_radius);
the run serves any pressure, and a test holds the two against each other."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from microslip.models.contact import StepFailure
from microslip.models.rings.mesh import Focus
from microslip.pressures.by_name import HERTZ
from microslip.solver.problem import Problem, Resolution, focus_strength
from microslip.solver.run import AS_SHIPPED
from microslip.solver.static_limit import at_turning_points
from microslip.solver.static_run import gathered_on_a_line, gathered_on_a_loop

SLOW_LOOP, SLOW_LINE = 0.02, 0.01
"""Creep in a radian, in u_lim, below which what never slips in the limit decides a motion."""
TELLING_LOOP, TELLING_SWEPT, TOLD = Resolution(24, 4, 32), Resolution(24, 4, 96), 1e-3
"""Resolution and tolerance at which its edge is found on a loop, and where the load oscillates:
there the edge of the contact sweeps over the rings, which asks for more steps."""
TELLING_LINE, TELLING_FINER = Resolution(48, 2, 1), Resolution(192, 2, 1)
"""And on a line, where nothing is marched, so more rings are cheap.  Edges that were found to half
a thousandth of the radius leave 1e-4 in the limit of a translation until rings are as narrow."""
TOLD_FINER = 1e-5
"""Tolerance on so many rings: at a larger one some that stick seem to have nothing left, and the
search for the edge does not settle."""


def found_focus(problem: Problem, model: str) -> Focus | None:
    """Where the rings of a slow motion should gather: at the edges of what never slips in the limit
    of vanishing velocity.

    Of a circle in the plane the edge lies further in than that of a line which is as long, since
    the slip never comes to rest; a contact with a hole sticks on a ring, which has two edges.
    Under a load that oscillates they are found for the limit alone.

    Parameters
    ----------
    problem : problem.Problem
        Any.
    model : str
        Name in models.registry.MODELS.

    Returns
    -------
    mesh.Focus or None
        None: the motion tells (Motion.focus) or is fast, the model has no rings, what sticks is not
        round, or all of the contact slips.
    """
    motion, creep = problem.motion, problem.creep
    if model not in ("radial", "polar") or not motion.periodic:
        return None
    if at_turning_points(motion):
        wanted = motion.pressure is not HERTZ and motion.half_disc and creep < SLOW_LINE
        radii = _radii_on_a_line(motion, problem.amplitude) if wanted else ()
    else:
        slow = motion.depth is None and model == "radial" and creep < SLOW_LOOP
        wanted = creep == 0.0 or slow
        radii = _radii_on_a_loop(motion, problem.amplitude) if wanted else ()
    return Focus(radii, focus_strength(creep)) if radii else None


@lru_cache(maxsize=64)
def _radii_on_a_line(motion, amplitude):
    """Edges of what never slips, over the contact radius; Poisson's ratio moves them little."""
    if motion.focus(0.0, amplitude, motion.pressure) is not None and not motion.rotates:
        return ()  # ... of an indenter, by its profile
    limit, model = Problem(motion, 0.0, amplitude, 0.0), "polar" if motion.rotates else "radial"
    try:
        radii = gathered_on_a_line(limit, model, TELLING_LINE, TOLD)
        if radii and not motion.rotates:
            radii = gathered_on_a_line(limit, model, TELLING_FINER, TOLD_FINER, near=radii)
        return radii
    except StepFailure:
        return ()


@lru_cache(maxsize=64)
def _radii_on_a_loop(motion, amplitude):
    """Edges of what never slips, over the contact radius; Poisson's ratio moves them little."""
    limit, model = Problem(motion, 0.0, amplitude, 0.0), "polar" if motion.rotates else "radial"
    telling = TELLING_LOOP if motion.depth is None else TELLING_SWEPT
    telling = replace(telling, steps=telling.steps * motion.cycles)
    try:
        return gathered_on_a_loop(limit, model, telling, TOLD, AS_SHIPPED)[1]
    except StepFailure:
        return ()
