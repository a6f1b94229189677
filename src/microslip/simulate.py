"""One run at one resolution: build the contact and the path, find the state that repeats itself."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from microslip import hertz
from microslip.cycle import Pace
from microslip.friction import project
from microslip.models import MODELS
from microslip.models.contact import UNIT_STIFFNESS
from microslip.path import half_period_phases, make_path, turning_point_grading
from microslip.periodic import find_periodic_state
from microslip.rings import Focus
from microslip.static import STEPS, static_state
from microslip.steady import forward_slip, steady_state

STEP_SHARE = 1e-2
SLOW_STEP_SHARE = 3e-4
"""Tolerance of a step over that of the periodic state: the slower the motion, the less a state
changes in a period, and the more an error of its steps adds up."""
MARCH_SHARE = 0.16
"""Bound of the sum over the steps of half a period, two stages each: a third of the tolerance."""
SLOW_PUSH, LARGEST_PUSH = 4.0, 0.6
"""Forward traction added to the static limit's, as a share of the bound, for a start: it grows as
the friction itself does with the creep in a radian, so that every point slips forward too much.
From there an accelerated search finds its way down; below, points would only drift."""

COARSENING, COARSEST_STEPS = 8, 12
COARSE_TOLERANCE = 1e-5
"""Where marches give derivatives, a search in this many times fewer steps comes first, as long as
no fewer are left than these, and no tighter than this."""

WEAKEST_FOCUS, STRONGEST_FOCUS, STATIC_FOCUS = 0.3, 1.0 - 2.0**-6, 0.9
"""Bounds of rings.Focus.strength, and its value for the static limit."""


@dataclass(frozen=True, order=True)
class Resolution:
    """Cells (rings, or squares along a side), angular points on half the disc, steps a half period
    (steady motion: not used)."""

    cells: int
    angles: int
    steps: int


@dataclass(frozen=True)
class Run:
    """Outcome of one run: forward friction and torque over their full-slip values, and the effort.

    distance: estimated distance from the periodic (steady) state; solver_residual: summed over the
    last period; both forces over mu F_z.  periods, iterations, solves: of all searches together;
    work: step solves x unknowns.  For other runs of the point: state, the periodic tractions;
    inverse: see cycle.PeriodicState; static_force: mean forward force of the static limit.
    """

    mu: float
    torque: float
    distance: float
    solver_residual: float
    periods: int
    iterations: int
    solves: int
    work: int
    converged: bool
    reason: str
    state: np.ndarray | None = None
    inverse: np.ndarray | None = None
    static_force: float = 0.0


@dataclass(frozen=True)
class Motion:
    """A periodic scene at one point of its parameters."""

    scene: object
    velocity: float
    amplitude: float
    poisson: float

    def displacement(self, phase):
        """Rigid displacement (forward, lateral, angle) at a phase."""
        return self.scene.displacement(phase, self.velocity, self.amplitude, self.poisson)

    def oscillation(self, phase):
        """... without the forward motion."""
        return self.scene.displacement(phase, 0.0, self.amplitude, self.poisson)

    @cached_property
    def creep(self):
        """Forward displacement in one radian of phase, in u_lim."""
        return self.scene.creep(self.velocity, self.amplitude, self.poisson)

    @cached_property
    def grading(self):
        """How much shorter steps are at the turning points (see path.turning_point_grading)."""
        return turning_point_grading(self.creep, self.scene.stroke(self.amplitude, self.poisson))

    def path(self, contact, steps):
        """Half a period in steps that suit the motion, or the contact if it has a say in it."""
        return _path(self, steps, getattr(contact, "grading", self.grading))


@lru_cache(maxsize=32)
def _path(motion, steps, grading):
    return make_path(motion.displacement, half_period_phases(steps, grading))


def simulate(scene, velocity, amplitude, poisson, model, resolution, tolerance, guess=None):
    """Run ``model`` on a scene at one resolution to its periodic (or steady) state.

    scene: scenes.Scene; velocity > 0, amplitude > 0 (None for steady scenes), poisson in 0..0.5:
    checked by the caller; tolerance: of the periodic state, a force over mu F_z, steps are solved
    a hundred times tighter; guess: a Run of the same point, of use if cells and angles are the
    same, too.  Returns a Run; never raises for want of convergence.
    """
    contact = build_contact(scene, velocity, amplitude, poisson, model, resolution)
    step_tolerance = STEP_SHARE * tolerance
    if not scene.periodic:

        def displacement(phase):
            return scene.displacement(phase, velocity, amplitude, poisson)

        return _steady_run(contact, displacement, velocity, tolerance, step_tolerance)
    motion = Motion(scene, velocity, amplitude, poisson)
    slow_share = UNIT_STIFFNESS * motion.creep * np.pi * STEP_SHARE
    share = min(max(slow_share, SLOW_STEP_SHARE), STEP_SHARE, MARCH_SHARE / resolution.steps)
    step_tolerance = share * tolerance
    search = _Search(contact, motion, resolution.steps, tolerance, step_tolerance)
    return search.run(guess)


class _Search:
    """The search for the periodic state of one run, from one start after the other."""

    def __init__(self, contact, motion, steps, tolerance, step_tolerance):
        self.contact, self.motion, self.steps = contact, motion, steps
        self.tolerance, self.step_tolerance = tolerance, step_tolerance
        self.pace = Pace(0.0, UNIT_STIFFNESS * motion.creep * np.pi)
        self.path = motion.path(contact, steps)
        self.done = []

    def run(self, guess=None):
        """The Run; guess: see simulate."""
        found = None
        if guess is not None and self._fits(guess):
            self.pace = replace(self.pace, static_force=guess.static_force)
            found = self._find(self.path, guess.state, guess.inverse)
        if found is None or not found.converged:
            found = self._search_afresh()
        return self._summary(found)

    def _fits(self, guess):
        shape = (2, *self.contact.forward_position.shape)
        return guess.converged and guess.state.shape == shape

    def _search_afresh(self):
        slipping = forward_slip(self.contact)
        for start in (self._start_near_the_limit(slipping), slipping):
            found = self._find_in_stages(start)
            if found.converged:
                break
        return found

    def _start_near_the_limit(self, slipping):
        """The static limit with all points pushed forward; also takes note of its force."""
        contact, creep = self.contact, self.motion.creep
        if not contact.has_memory:
            return slipping
        residual, oscillating = static_state(contact, self.motion.oscillation, self.step_tolerance)
        force = float(np.sum(contact.weight * residual[0]))
        self.pace = replace(self.pace, static_force=force)
        push = min(SLOW_PUSH * creep ** (2.0 / 3.0), LARGEST_PUSH)
        return project(residual + oscillating + push * slipping, contact.bound)

    def _find_in_stages(self, start):
        """From coarse steps to the steps asked for, each on the result of the last."""
        counts = [self.steps]
        while self.contact.has_sensitivity and counts[0] >= 2 * COARSEST_STEPS:
            counts.insert(0, max(counts[0] // COARSENING, COARSEST_STEPS))
        inverse = None
        for count in counts[:-1]:
            path = self.motion.path(self.contact, count)
            found = self._find(path, start, inverse, max(self.tolerance, COARSE_TOLERANCE))
            if found.converged:
                start, inverse = found.start, found.inverse
        return self._find(self.path, start, inverse)

    def _find(self, path, start, inverse, tolerance=None):
        looser = (tolerance or self.tolerance) / self.tolerance
        self.done.append(
            find_periodic_state(
                self.contact,
                path,
                start,
                looser * self.tolerance,
                looser * self.step_tolerance,
                self.pace,
                inverse,
            )
        )
        return self.done[-1]

    def _summary(self, found):
        mean = self.path.mean(found.forces)
        solves = sum(one.solves for one in self.done)
        solved = found.solver_residual <= found_limit(self.path, self.step_tolerance)
        periods = sum(one.periods for one in self.done)
        reason = ""
        if not found.converged:
            reason = f"no periodic state within {periods} half periods: {found.distance:.1e} left"
        elif not solved:
            reason = f"a step was left unsolved: residual {found.solver_residual:.1e}"
        return Run(
            mu=float(mean[0]),
            torque=float(mean[2]) / hertz.TORQUE_FULL_SLIP,
            distance=found.distance,
            solver_residual=found.solver_residual,
            periods=periods,
            iterations=sum(one.iterations for one in self.done),
            solves=solves,
            work=solves * found.start.size,
            converged=found.converged and solved,
            reason=reason,
            state=found.start,
            inverse=found.inverse,
            static_force=self.pace.static_force,
        )


def found_limit(path, step_tolerance):
    """Largest sum of residuals that a march solved to ``step_tolerance`` can leave."""
    return path.stages.shape[0] * path.stages.shape[1] * step_tolerance


def simulate_static(scene, amplitude, poisson, model, resolution, tolerance):
    """The limit of vanishing velocity at one resolution (see static.py): a Run, without a march in
    forward direction.  The rigid contact keeps no residual traction: 0."""
    contact = build_contact(scene, 0.0, amplitude, poisson, model, resolution)
    force, solves = 0.0, 0
    if contact.has_memory:
        residual, _ = static_state(
            contact,
            lambda phase: scene.displacement(phase, 0.0, amplitude, poisson),
            STEP_SHARE * tolerance,
        )
        force = float(np.sum(contact.weight * residual[0]))
        solves = STEPS // 2
    return Run(
        mu=force,
        torque=0.0,
        distance=0.0,
        solver_residual=STEP_SHARE * tolerance * solves,
        periods=1,
        iterations=0,
        solves=solves,
        work=solves * 2 * contact.forward_position.size,
        converged=True,
        reason="",
    )


def _focus_strength(creep):
    """How closely rings should gather at the stick radius; creep: in a radian, in u_lim.

    Slip that is as small as the creep fills a layer whose width goes like creep^(2/3).  With ring
    widths that grow quadratically from it, the square root of that is the right share of the mean
    width; in powers of two, so that points share grids.
    """
    layer = 2.0 ** round(np.log2(creep) / 3.0)
    return float(np.clip(1.0 - layer, WEAKEST_FOCUS, STRONGEST_FOCUS))


def build_contact(scene, velocity, amplitude, poisson, model, resolution):
    """The contact, its rings gathered where the slip starts: the closer, the slower the creep."""
    radius = scene.focus(velocity, amplitude)
    focus = radius
    if radius is not None and scene.periodic:
        creep = scene.creep(velocity, amplitude, poisson)
        focus = Focus(radius, _focus_strength(creep) if creep > 0.0 else STATIC_FOCUS)
    return MODELS[model].build(scene, poisson, resolution.cells, resolution.angles, focus)


def _steady_run(contact, displacement, velocity, tolerance, step_tolerance):
    found = steady_state(contact, displacement, velocity, tolerance, step_tolerance)
    return Run(
        mu=float(found.forces[0]),
        torque=float(found.forces[2]) / hertz.TORQUE_FULL_SLIP,
        distance=found.distance,
        solver_residual=found.solver_residual,
        periods=found.stretches,
        iterations=found.iterations,
        solves=found.solves,
        work=found.solves * found.state.size,
        converged=found.converged,
        reason="" if found.converged else f"no steady state: {found.distance:.1e} left",
    )
