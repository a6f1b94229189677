"""Which resolutions to run: levels of cells, angles and steps, and where refinement begins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from microslip.adaptive.cells_policies import (
    RINGS,
    SLOW_CREEP,
    cells_axis,
    is_loop,
    levels_finer,
    like_a_sphere,
)
from microslip.adaptive.chains import JUDGED, Axis
from microslip.models.contact import Contact
from microslip.models.registry import MODELS
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, path_of
from microslip.solver.static_limit import at_turning_points
from microslip.solver.stick_edge import found_focus

ANGLES = (2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96)
STEPS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024, 1536, 2048)
"""Levels: angles on half the disc, steps in half a period."""
BASE_RINGS, BASE_ANGLES, BASE_STEPS = 8, 6, 16
RADIAL_STEPS, RADIAL_CAUTION = 32, 1.5
"""Steps at the tolerance 1e-3 where rings alone are marched, to and fro, and the error in time over
the spread of the runs: few unknowns pay for finer runs, which do not agree by chance."""
TURNING_CAUTION = 2.0
"""Error in time over the spread of the runs where the contact turns or slides back: the first step
after a turning point, in which all points stick and slip again, errs to one side whatever its
length."""
COUPLED_STEPS, COUPLED_RUNS = 48, 5
"""Steps at the tolerance 1e-3 where contacts that turn work against each other on one body, and the
runs whose spread is the error: which of them slides changes within a step, and where in it that
comes to lie scatters from run to run."""
DOUBLED_STEPS, DOUBLED_CAUTION = (4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048), 1.25
"""Steps of a loop, each level twice the last one, since runs that lie closer together agree by
chance, and the error in time over their spread."""
PROJECTED_CAUTION = {"angles": 1.3, "steps": 1.8}
PROJECTED_SCATTER = 0.3
"""See chains.Axis."""
MIXED_BELOW = 5e-4
"""Tolerance below which what rings and steps do together is measured: the error in time may change
its sign over the steps of few rings, and then says nothing of that of more."""
TOGETHER_FROM, TOGETHER_RESOLVED = 1e-3, 0.9
"""Tolerance from which on rings, angles and steps of a bore are refined together, and the share of
it below which none of these points claims its error to be: the few runs of a point may come to lie
on a line by chance."""
TOGETHER_AMPLITUDES = 0.3, 6.0
"""Between which that pays: at less, each axis by itself is cheaper; at more, the error falls with
the first power in the end, after it has changed its sign, and four runs do not show it."""
SWEEPING_STEPS = 4
"""Steps in half a period over rings where the edge of the contact sweeps over these.  They join it
one by one, and the error scatters unless both are refined together."""
SWEEPING_CAUTION, TOLD_CAUTION = 1.5, 2.0
"""Error over the spread of these runs, and where their rings gather at an edge that another run
found: they lie closer together there than they are right."""
LONGEST_NATURAL_STEP = 1.0
"""Longest step at the tolerance 1e-2, in radians of the natural oscillation of a mass against the
contact: within about a radian second-order steps converge, and differences show their error."""
MOST_MASS_STEPS = 8192
"""Steps in half a period that a mass may ask for: runs over 24 rings take a few seconds then."""
LONGEST_STROKE = 16.0
"""Stroke in u_lim beyond which more steps are left to the estimate of the error."""


def plan(
    problem: Problem,
    model: str,
    tolerance: float,
    cells: int | None = None,
    steps: int | None = None,
    *,
    together: bool = False,
) -> tuple[Resolution, tuple[Axis, ...]]:
    """Resolution of what is not refined, and the axes to refine (see refinement.certify).

    Parameters
    ----------
    problem : problem.Problem
        As checked by the caller.
    model : str
        Name in models.registry.MODELS.
    tolerance : float
        Absolute, on the friction.
    cells, steps : int or None
        Impose a resolution instead; steps in a full period.
    together : bool
        Whether rings, angles and steps may be refined together, where that is cheaper.
    """
    motion = problem.motion
    free = cells is None and steps is None and tolerance <= TOGETHER_FROM
    if together and free and _falls_smoothly(problem, model):
        return Resolution(cells=1, angles=1, steps=STEPS[0]), (_all_together(problem, tolerance),)
    resolved, axes = MODELS[model].axes(problem), []
    marches = motion.periodic and (problem.velocity > 0.0 or not at_turning_points(problem))
    sweeps = motion.loads and marches and cells is None and steps is None
    if sweeps:
        axes.append(_sweeping(problem, model, tolerance))
    elif "cells" in resolved:
        axes.append(
            cells_axis(problem, model, tolerance)
            if cells is None
            else _imposed("cells", cells, motion)
        )
    if "angles" in resolved:
        # only nu > 0 makes tractions of a translation depend on the angle, and only a little
        axes.append(_angles(problem, tolerance))
    if marches and not sweeps:
        axes.append(
            _steps(problem, model, tolerance)
            if steps is None
            else _imposed("steps", steps // 2, motion)
        )
    return Resolution(cells=1, angles=1, steps=STEPS[0]), tuple(axes)


class WithMass(NamedTuple):
    """Axes whose steps suit a mass.

    Attributes
    ----------
    axes : tuple of chains.Axis
        To be refined.
    reason : str
        Why their steps do not resolve the natural oscillation of the mass; "" if they do.
    """

    axes: tuple[Axis, ...]
    reason: str


def with_mass(
    axes: Sequence[Axis], problem: Problem, contact: Contact, mass: float, tolerance: float
) -> WithMass:
    """Shorten the steps of axes until they resolve a mass that oscillates against the contact.

    The natural frequency is sqrt(stiffness / mass), with the stiffness of the contact (1.5 for a
    sphere at nu = 0), over that of the vibration.  Runs whose steps are longer than a radian of it
    may agree with each other, but not with the solution.  A spring that is s times stiffer than the
    contact raises the frequency by the square root of s, and lowers the force of the oscillation on
    the contact by s.  An error of second order then asks for the same steps.

    Parameters
    ----------
    axes : sequence of chains.Axis
        As planned without a mass.
    problem : problem.Problem
        Its path is cut into steps.
    contact : contact.Contact
        A contact of the problem at any resolution.
    mass : float
        Over mu F_z / (u_lim omega^2).
    tolerance : float
        Absolute, on the answer.
    """
    steps = next((axis for axis in axes if "steps" in axis.refines), None)
    if mass == 0.0 or steps is None:
        return WithMass(tuple(axes), "")
    count = steps.levels[steps.base]
    frequency = (contact.stiffness / mass) ** 0.5
    longest = float(np.diff(path_of(problem, contact, count).phase).max())
    allowed = LONGEST_NATURAL_STEP
    if not steps.imposed:
        allowed *= (tolerance / 1e-2) ** 0.5  # second order in time
    finer = max(longest * frequency / allowed, 1.0)
    if finer > 1.0 and (steps.imposed or finer * count > MOST_MASS_STEPS):
        most = 2 * (count if steps.imposed else MOST_MASS_STEPS)
        return WithMass(
            tuple(axes),
            f"mass too small for {most} steps in a period: it oscillates against the contact at"
            f" {frequency:.3g} times the frequency of the vibration, which takes"
            f" {2 * int(np.ceil(finer * count))}",
        )
    levels = tuple(2 * int(np.ceil(0.5 * finer * level)) for level in steps.levels)
    finer_axis = replace(steps, levels=levels) if finer > 1.0 else steps
    return WithMass(tuple(finer_axis if axis is steps else axis for axis in axes), "")


def _imposed(name, count, motion):
    """An axis whose resolution is asked for; two coarser ones show what it is worth."""
    levels = (count // 2, round(0.75 * count), count)
    caution = 1.0 if not motion.loads else SWEEPING_CAUTION
    return Axis(name, levels, 2, (0, 1, 2), imposed=True, caution=caution)


def _falls_smoothly(problem, model):
    """Whether the error of a contact that oscillates falls smoothly if all is refined together."""
    motion = problem.motion
    oscillates = motion.periodic and motion.rotates and motion.half_disc and not motion.loads
    least, most = TOGETHER_AMPLITUDES
    if not (model == "polar" and oscillates and least <= problem.amplitude <= most):
        return False
    return like_a_sphere(problem) and problem.velocity > 0.0


def _all_together(problem, tolerance):
    """Rings, angles and steps: a point that starts to slip between two rings, two angles or two
    steps makes the value scatter along each axis, the more, the coarser the others are."""
    rings = RINGS[: len(ANGLES)]
    tied = ("angles", ANGLES), ("steps", _step_levels(problem, STEPS[1 : len(ANGLES) + 1]))
    start = levels_finer(1e-2 / tolerance) // 2
    first = tuple(range(start, start + JUDGED))
    resolved = TOGETHER_RESOLVED
    return Axis("cells", rings, start, first, tied=tied, fitted=True, resolved=resolved)


def _sweeping(problem, model, tolerance):
    """Steps and rings together."""
    rings = RINGS[RINGS.index(BASE_RINGS) :]
    levels = _step_levels(problem, [SWEEPING_STEPS * count for count in rings])
    base = 1 if tolerance >= 5e-3 else 2
    first = tuple(range(base - 1, base + 3))
    if problem.motion.rotates and problem.drift < SLOW_CREEP:
        # few rings are far off there, and finer runs that outweigh them cost more than they do
        base = 1 if tolerance >= 1e-2 else 2
        first = (base, base + 1, base + 2)
    caution = SWEEPING_CAUTION if found_focus(problem, model) is None else TOLD_CAUTION
    return Axis("steps", levels, base, first, caution=caution, tied=(("cells", rings),))


def _step_levels(problem, counts):
    """Even numbers of steps that stay short against u_lim where the stroke is long."""
    motion = problem.motion
    stroke = min(max(1.0, problem.stroke), LONGEST_STROKE)
    return tuple(2 * round(0.5 * count * motion.cycles * stroke**0.5) for count in counts)


class Coarsest(NamedTuple):
    """Angles and steps that a point begins with where errors over both are projected: the many
    unknowns make each run cost more, and what corrections lack that are found at so few is measured
    as their mixed difference."""

    angles: int
    steps: int


def _coarsest(problem):
    """The Coarsest of a problem, None where errors are the spread of runs."""
    motion = problem.motion
    if not motion.periodic or problem.velocity == 0.0:
        return None
    if motion.rotates:
        return Coarsest(angles=4, steps=12)
    if problem.poisson > 0.0 and problem.half_period_mirror:
        return Coarsest(angles=2, steps=16)  # tractions depend on the angle a little only
    return None


def _angles(problem, tolerance):
    motion, coarsest = problem.motion, _coarsest(problem)
    if coarsest is None:
        # only nu > 0 makes tractions of a translation depend on the angle, and only a little
        base = ANGLES.index(BASE_ANGLES) + (not motion.periodic) - (not motion.rotates)
        return Axis("angles", ANGLES, base, (base - 1, base, base + 1), mixed=True)
    base = ANGLES.index(coarsest.angles) + levels_finer(1e-3 / tolerance)
    first, caution = (base, base + 1, base + 2), PROJECTED_CAUTION["angles"]
    return Axis("angles", ANGLES, base, first, projected=True, caution=caution, mixed=True)


def _doubled_steps(problem, tolerance):
    """The axis of the steps of a loop."""
    wanted = max(RADIAL_STEPS * (1e-3 / tolerance) ** 0.5, BASE_STEPS)
    base = next(k for k, count in enumerate(DOUBLED_STEPS) if count >= wanted)
    levels = _step_levels(problem, DOUBLED_STEPS)
    first = tuple(range(base - 2, base + 1))
    return Axis("steps", levels, base, first, caution=DOUBLED_CAUTION)


def _steps(problem, model, tolerance):
    if is_loop(problem, model):
        return _doubled_steps(problem, tolerance)
    levels, coarsest = _step_levels(problem, STEPS), _coarsest(problem)
    if coarsest is None:
        few_unknowns = model == "radial" and problem.half_period_mirror
        wanted, runs = RADIAL_STEPS if few_unknowns else BASE_STEPS, 3
        if problem.parts and not problem.half_period_mirror:
            wanted, runs = COUPLED_STEPS, COUPLED_RUNS
        # second order in time
        wanted *= (1e-3 / tolerance) ** 0.5
        base = next(k for k, count in enumerate(STEPS) if count >= max(wanted, BASE_STEPS))
        caution = RADIAL_CAUTION if few_unknowns else 1.0
        if not problem.half_period_mirror:
            caution = TURNING_CAUTION
        first = tuple(range(base + 1 - runs, base + 1))
        return Axis("steps", levels, base, first, caution=caution)
    base = STEPS.index(coarsest.steps) + levels_finer(1e-3 / tolerance) // 2
    caution, scatter = PROJECTED_CAUTION["steps"], PROJECTED_SCATTER
    # counts that lie close together agree by chance where the error in time changes its sign
    first = (base - 2, base, base + 2)
    mixed = tolerance < MIXED_BELOW
    return Axis(
        "steps", levels, base, first, projected=True, caution=caution, scatter=scatter, mixed=mixed
    )
