"""A body on several contacts: which groups each of them has, and the path of all together.

The groups of the body are those of the contact that carries the mean load: forces are over mu times
the load of all, displacements over its u_lim.  A contact of the same shape and material under
another load is indented by `extent` as much, and with the indentation grows its u_lim; its radius,
and with this its stiffness, grow less.  The amplitude and the velocity of the body are lengths, so
that in a contact's own groups they are less by its extent.

All contacts go forward with the body.  At a given velocity none of them feels the others, and its
phase does not count.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np

from microslip.models.contact import Contact
from microslip.models.path import SDIRK2, BodyPath, Integrator, Path, make_path, phases_between
from microslip.models.registry import MODELS
from microslip.models.rings.mesh import Focus
from microslip.motions.body_contacts import BodyContact, written
from microslip.motions.motion import LOOP
from microslip.solver.problem import Problem, Resolution, build_contact

RETURNED = 1e-12
"""Share of the amplitude below which an oscillation is rounding."""
NEAREST_TURNS = 1e-6
"""Radians between two turning points, below which they are one."""


@dataclass(frozen=True)
class Part:
    """One contact of a body.

    Attributes
    ----------
    problem : problem.Problem
        It alone, in its own groups.
    share : float
        Of the load of the body, without oscillation.
    extent : float
        Its u_lim over that of the body.
    lead : float
        Phase by which its oscillation is ahead, in radians.
    """

    problem: Problem
    share: float
    extent: float
    lead: float

    def oscillation(self, phase: np.ndarray) -> np.ndarray:
        """Its own displacement at a phase of the body, shape (3, ...): in the units of this, and
        the angle in that of which the places in the contact, over its radius, are moved by so
        much."""
        return self.extent * np.array(self.problem.oscillation(phase + self.lead))

    def depth(self, phase: np.ndarray) -> np.ndarray:
        """Its indentation at a phase of the body, where that changes; see problem.Problem."""
        return self.problem.depth(phase + self.lead)


@dataclass(frozen=True)
class BodyProblem(Problem):
    """A motion at one point of its parameters, done by every contact of a body.

    Attributes
    ----------
    contacts : tuple of body_contacts.BodyContact
        What differs between them.
    steadied : bool
        Whether the body itself takes no part in the mean forward oscillation of its contacts.
    """

    contacts: tuple[BodyContact, ...] = ()
    steadied: bool = False

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Every contact as a Part."""
        return tuple(_part(self, one) for one in self.contacts)

    @cached_property
    def depth(self) -> Callable | None:
        """Those of all contacts at a phase, one a row; None: they do not change."""
        if self.motion.depth is None:
            return None
        return lambda phase: np.stack([part.depth(phase) for part in self.parts])

    @cached_property
    def mean_load(self) -> float:
        return sum(part.share * part.problem.mean_load for part in self.parts)

    @property
    def shares(self) -> tuple[float, ...]:
        """Of every contact in the mean normal load."""
        if self.motion.depth is None:
            return tuple(part.share for part in self.parts)
        return tuple(part.share * part.problem.mean_load / self.mean_load for part in self.parts)

    @property
    def start(self) -> float:
        """Phase at which a march begins: the first turning point of the first contact."""
        return self.turns_of(self.parts[0])[0]

    def turns_of(self, part: Part) -> np.ndarray:
        """Phases of the body at which a contact turns; where the body goes along with what all of
        them do, the contacts turn with the oscillation alone."""
        velocity = 0.0 if self.steadied else part.problem.velocity
        turns = part.problem.motion.turns(velocity, part.problem.amplitude)
        return np.array(turns) - part.lead

    @property
    def written(self) -> str:
        """The contacts as a text."""
        return written(self.contacts)

    @cached_property
    def moves_together(self) -> bool:
        """Whether all contacts oscillate alike along the direction of the forward motion."""
        ahead = np.array([part.oscillation(LOOP)[0] for part in self.parts])
        return float(np.ptp(ahead, axis=0).max()) <= RETURNED * max(self.amplitude, 1.0)

    @cached_property
    def is_balanced(self) -> bool:
        """Whether what the contacts do half a period later is what they do, reversed.

        Each has an opposite then, and at rest the two of them exert no forward force together.
        """
        there = self.oscillation(LOOP + np.pi)
        here = self.oscillation(LOOP)
        reversed_at = max(float(np.ptp(a + b)) for a, b in zip(here, there, strict=True))
        if reversed_at > RETURNED * max(self.amplitude, 1.0):
            return False
        count = self.contacts.count
        return all(count(one) == count(_opposite(one)) for one in self.contacts)

    def contact(self, model: str, resolution: Resolution, focus: Focus | None = None) -> Contact:
        """All contacts at a resolution, side by side; each gathers its own rings."""
        parts = self.parts
        return MODELS[model].side_by_side(
            [
                build_contact(part.problem, model, resolution, focus, self.start + part.lead)
                for part in parts
            ],
            [part.share for part in parts],
            [part.extent for part in parts],
        )

    def path(self, contact: Contact, steps: int, integrator: Integrator = SDIRK2) -> Path:
        """The BodyPath, in about so many steps in half a period, finer where a contact turns."""
        return _body_path(self, steps, integrator)


def _part(body, one):
    motion = body.motion
    if one.load == 1.0:
        extent = radius = 1.0
    else:
        extent = float(motion.pressure.of_load(one.load))
        radius = float(motion.pressure.radius(extent))
    length = radius / extent if motion.rotates else 1.0 / extent
    alone = Problem(motion, body.velocity, body.amplitude * one.amplitude * length, body.poisson)
    unit = extent * alone.motion.creep(1.0, alone.amplitude, alone.poisson)
    if unit > 0.0:
        alone = replace(alone, velocity=body.creep / unit)
    share = one.load / len(body.contacts)
    return Part(alone, share, extent, float(np.deg2rad(one.phase)))


def _opposite(one):
    return replace(one, phase=(one.phase + 180.0) % 360.0)


def why_not(problem: BodyProblem) -> str:
    """What is allowed where a motion or a pressure does not go with the contacts; "" if it does."""
    motion = problem.motion
    if not motion.periodic:
        return f"allowed is none: {motion.name} does not oscillate"
    if any(one.load != 1.0 for one in problem.contacts):
        if not motion.pressure.is_indenter:
            return f"allowed are equal loads: how {motion.pressure.name} grows is not known"
        if motion.depth is not None:
            return f"allowed are equal loads for {motion.name}, of which a part is the load"
        translation = problem.oscillation(LOOP)[:2]
        if motion.rotates and max(np.ptp(along) for along in translation) > 0.0:
            return f"allowed are equal loads for {motion.name}, of which a part is an angle"
    if motion.rotates and any(one.amplitude == 0.0 for one in problem.contacts):
        return f"allowed are amplitudes above 0 for {motion.name}, which measure its velocity"
    return ""


@lru_cache(maxsize=32)
def _body_path(problem, steps, integrator):
    phases = _phases(problem, steps)
    creep = problem.creep

    def forward(phase):
        return creep * phase, np.zeros_like(phase), np.zeros_like(phase)

    base = make_path(forward, phases, integrator)
    each = tuple(
        make_path(
            _besides(problem, part),
            phases,
            integrator,
            None if problem.motion.depth is None else part.depth,
        )
        for part in problem.parts
    )
    return BodyPath(**vars(base), each=each)


def _besides(problem, part) -> Callable:
    """Displacement of a contact beyond that of the body."""

    def displacement(phase):
        forward, lateral, angle = part.oscillation(phase)
        if problem.steadied:
            forward = forward - _together(problem, phase)
        return forward, lateral, angle

    return displacement


def _together(problem, phase):
    """Mean forward oscillation of the contacts, weighted with how stiff each of them is."""
    stiff = np.array([part.share / part.extent for part in problem.parts])
    ahead = np.array([part.oscillation(phase)[0] for part in problem.parts])
    return np.tensordot(stiff / stiff.sum(), ahead, axes=1)


def _phases(problem, steps):
    """From where the first contact turns over half a period, or a whole one, in pieces from turning
    point to turning point of any contact."""
    interval = np.pi if problem.motion.half_period_mirror else 2.0 * np.pi
    turns, start = [problem.turns_of(part) for part in problem.parts], problem.start
    inner = np.sort(np.concatenate([(turn - start) % interval for turn in turns]))
    inside = inner[(inner > NEAREST_TURNS) & (inner < interval - NEAREST_TURNS)]
    kept = inside[np.diff(inside, prepend=0.0) > NEAREST_TURNS]
    ends = start + np.concatenate([[0.0], kept, [interval]])
    pieces = [ends[:1]]
    for one, other in pairwise(ends):
        count = max(round(steps * (other - one) / np.pi), 1)
        pieces.append(phases_between((one, other), count, problem.grading)[1:])
    return np.concatenate(pieces)
