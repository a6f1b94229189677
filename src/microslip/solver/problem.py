"""A motion at one point of its parameters: its path in time, and the contact that suits it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from microslip.models.contact import Contact
from microslip.models.path import (
    SDIRK2,
    Integrator,
    Path,
    make_path,
    phases_between,
    turning_point_grading,
)
from microslip.models.registry import MODELS
from microslip.models.rings.mesh import Focus

WEAKEST_FOCUS, STRONGEST_FOCUS, STATIC_FOCUS = 0.3, 1.0 - 2.0**-6, 0.9
"""Bounds of mesh.Focus.strength, and its value for the static limit."""


@dataclass(frozen=True, order=True)
class Resolution:
    """How finely a problem is resolved.

    Attributes
    ----------
    cells : int
        Rings, or squares along a side.
    angles : int
        Angular points on half the disc.
    steps : int
        In half a period (steady motion: not used).
    """

    cells: int
    angles: int
    steps: int


@dataclass(frozen=True)
class Problem:
    """A motion at one point of its parameters.

    Attributes
    ----------
    motion : motion.Motion
        What moves, and the pressure that it is under.
    velocity, amplitude : float
        The dimensionless groups of the motion; amplitude None where it is steady.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    """

    motion: object
    velocity: float
    amplitude: float
    poisson: float

    def displacement(self, phase: np.ndarray) -> tuple[np.ndarray, ...]:
        """Rigid displacement (forward, lateral, angle) at a phase."""
        return self.motion.displacement(phase, self.velocity, self.amplitude, self.poisson)

    def oscillation(self, phase: np.ndarray) -> tuple[np.ndarray, ...]:
        """... without the forward motion."""
        return self.motion.displacement(phase, 0.0, self.amplitude, self.poisson)

    @cached_property
    def depth(self) -> Callable | None:
        """Indentation over the reference one, a function of the phase; None: it does not change."""
        depth, pressure = self.motion.depth, self.motion.pressure
        return None if depth is None else lambda phase: depth(phase, self.amplitude, pressure)

    @cached_property
    def mean_load(self) -> float:
        """Mean of the normal load over a period, over that of the reference state."""
        return float(self.motion.mean_load(self.amplitude, self.motion.pressure))

    @cached_property
    def creep(self) -> float:
        """Forward displacement in one radian of phase, in u_lim."""
        return self.motion.creep(self.velocity, self.amplitude, self.poisson)

    @cached_property
    def grading(self) -> float:
        """How much shorter steps are at the turning points (see path.turning_point_grading)."""
        return turning_point_grading(self.creep, self.motion.stroke(self.amplitude, self.poisson))

    @property
    def parts(self) -> tuple:
        """Contacts of a body that has several, see body_problem.Part; here none: it is the one."""
        return ()

    def contact(self, model: str, resolution: Resolution, focus: Focus | None = None) -> Contact:
        """The contact at a resolution, see build_contact."""
        return build_contact(self, model, resolution, focus)

    def path(self, contact: Contact, steps: int, integrator: Integrator = SDIRK2) -> Path:
        """The path to march, in steps that suit the motion, or the contact if it has a say in it.

        It is half a period where the second half is the mirror image of the first, else the whole.
        """
        return _path(self, steps, getattr(contact, "grading", self.grading), integrator)


@lru_cache(maxsize=32)
def _path(problem, steps, grading, integrator):
    turns = problem.motion.turns(problem.velocity, problem.amplitude)
    phases = phases_between(turns, steps, grading)
    return make_path(problem.displacement, phases, integrator, problem.depth)


def focus_strength(creep: float) -> float:
    """How closely rings should gather at the stick radius; creep: in a radian, in u_lim, 0 in the
    static limit.

    Slip that is as small as the creep fills a layer whose width goes like creep^(2/3).  With ring
    widths that grow quadratically from it, the square root of that is the right share of the mean
    width; in powers of two, so that points share grids.
    """
    if creep == 0.0:
        return STATIC_FOCUS
    layer = 2.0 ** round(np.log2(creep) / 3.0)
    return float(np.clip(1.0 - layer, WEAKEST_FOCUS, STRONGEST_FOCUS))


def _focus(problem):
    """Where the slip starts: rings gather there, the closer, the slower the creep."""
    motion = problem.motion
    radius = motion.focus(problem.velocity, problem.amplitude, motion.pressure)
    if radius is None or not motion.periodic:
        return radius
    return Focus((radius,), focus_strength(problem.creep))


def build_contact(
    problem: Problem,
    model: str,
    resolution: Resolution,
    focus: Focus | None = None,
    start: float | None = None,
) -> Contact:
    """The contact of a problem.

    Parameters
    ----------
    problem : Problem
        Where the normal load changes, the contact is that of the start of a period.
    model : str
        Name in models.registry.MODELS.
    resolution : Resolution
        Of the model.
    focus : mesh.Focus or None
        Where rings gather; None: where the slip starts.
    start : float or None
        Phase at which a period starts; None: the first turning point.
    """
    motion = problem.motion
    focus = focus or _focus(problem)
    build = MODELS[model].build
    contact = build(motion, problem.poisson, resolution.cells, resolution.angles, focus)
    if motion.depth is None:
        return contact
    start = motion.turns(problem.velocity, problem.amplitude)[0] if start is None else start
    deepest = motion.deepest(problem.amplitude, motion.pressure)
    return contact.at_indentation(deepest, float(problem.depth(np.array(start))))
