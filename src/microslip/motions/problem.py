"""A problem: a motion at one velocity and amplitude, its drive, its pressure, and its contacts.

A body can rest on several contacts of the same shape.  The units of the body are those of the
contact that carries the mean load: forces are over mu times the load of all, displacements over its
u_lim.  A contact of the same shape and material under another load has an indentation larger by
`extent`, and its u_lim grows in proportion; its radius, and with it its stiffness, grow less.  The
amplitude and the velocity of the body are lengths, so in a contact's own units they are divided by
`extent`.

All contacts go forward with the body.  At a prescribed velocity no contact acts on another, and
phases do not count.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from microslip.foundation.errors import InputError
from microslip.motions.body_contacts import BodyContact, contacts_text
from microslip.motions.drive import Drive
from microslip.motions.motion import LOOP, Motion
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

RETURNED = 1e-12
"""Share of the amplitude below which an oscillation is rounding."""
ROUNDING = 1e-9
"""Largest deviation from 1 of the mean load of several contacts, since loads are written with 12
digits."""


@dataclass(frozen=True)
class Problem:
    """A motion at one velocity and amplitude; dimensionless, hashable.

    Parameters
    ----------
    motion : Motion
        Such as `Transverse()` or `Elliptic(forward=0.5)`.
    velocity : float
        The paper's dimensionless group; 0: the limit v -> 0.  Under a prescribed force it follows
        from the force and is left at 0.
    amplitude : float or None
        The paper's dimensionless group; None for steady motions.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    pressure : Pressure
        Distribution of the load.
    drive : Force, Spring or None
        Drive of the forward motion; None: the velocity is prescribed.
    contacts : tuple of BodyContact
        Contacts that the body rests on; empty: one.
    backward : bool
        Whether the motion is seen in the mirror across the forward direction: its friction at a
        velocity v is that of the motion at -v with the other sign, for a symmetric pressure.
    follows : bool
        Whether the body follows the mean forward oscillation of its contacts, as one without mass
        under a constant force does; the contacts then oscillate as if there were none.

    Raises
    ------
    InputError
        For arguments of another type, numbers that are not finite, and an amplitude that is missing
        or that a steady motion does not have.
    """

    motion: Motion
    velocity: float = 0.0
    amplitude: float | None = None
    poisson: float = 0.0
    pressure: Pressure = HERTZ
    drive: Drive | None = None
    contacts: tuple[BodyContact, ...] = ()
    backward: bool = False
    follows: bool = False

    def __post_init__(self) -> None:
        for name, kind in (("motion", Motion), ("pressure", Pressure)):
            if not isinstance(getattr(self, name), kind):
                allowed = f"allowed is a {kind.__name__}; microslip.solve takes its text, too"
                raise InputError(name, getattr(self, name), allowed)
        if self.drive is not None and not isinstance(self.drive, Drive):
            raise InputError("drive", self.drive, "allowed is a Force or a Spring")
        if not all(isinstance(one, BodyContact) for one in self.contacts):
            raise InputError("contacts", self.contacts, "allowed is a tuple of BodyContact")
        load = sum(one.load for one in self.contacts) / max(len(self.contacts), 1)
        if self.contacts and abs(load - 1.0) > ROUNDING:
            allowed = "allowed are loads over their mean: this mean of them has to be 1"
            raise InputError("contacts", load, allowed)
        numbers = {"velocity": self.velocity, "poisson": self.poisson}
        if self.motion.periodic:
            if self.amplitude is None:
                allowed = f"{self.motion.name} needs an amplitude >= 0"
                raise InputError("amplitude", None, allowed)
            numbers["amplitude"] = self.amplitude
        elif self.amplitude is not None:
            raise InputError("amplitude", self.amplitude, f"{self.motion.name} has no amplitude")
        for name, value in numbers.items():
            if not math.isfinite(value):
                raise InputError(name, value, "allowed is a finite number")

    def __str__(self) -> str:
        """The problem in a line, without defaults."""
        words = [f"{self.motion.name} velocity={self.velocity:.12g}"]
        if self.amplitude is not None:
            words.append(f"amplitude={self.amplitude:.12g}")
        words += [f"poisson={self.poisson:.12g}"] if self.poisson else []
        words += [f"pressure={self.pressure.name}"] if self.pressure != HERTZ else []
        words += [str(self.drive)] if self.drive else []
        words += [f"contacts={contacts_text(self.contacts)}"] if self.contacts else []
        return " ".join(words)

    # Symmetries, which the pressure may break

    @property
    def half_period_mirror(self) -> bool:
        """Whether the solution half a period later is its own image, see Motion."""
        return self.motion.half_period_mirror and self.pressure.mirrored

    @property
    def straight(self) -> bool:
        """Whether the oscillation alone goes to and fro on a line, see Motion."""
        return self.motion.straight and not self.follows

    @property
    def propels(self) -> bool:
        """Whether the oscillation alone may propel the contact, see Motion."""
        return self.motion.propels and not self.follows

    # Kinematics

    @property
    def size(self) -> float:
        """The amplitude; 0 for a steady motion, which has none."""
        return 0.0 if self.amplitude is None else self.amplitude

    @property
    def _sign(self) -> float:
        return -1.0 if self.backward else 1.0

    def _moved(
        self, phase: np.ndarray, velocity: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        motion, sign = self.motion, self._sign
        place = (self.size, self.poisson)
        forward, lateral, angle = motion.displacement(phase, sign * velocity, *place)
        if self.follows and not self.contacts:
            forward = forward - motion.displacement(phase, 0.0, *place)[0]
        return sign * forward, lateral, sign * angle

    def displacement(self, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rigid displacement (forward, lateral, angle) at a phase."""
        return self._moved(phase, self.velocity)

    def oscillation(self, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Displacement without the forward motion."""
        return self._moved(phase, 0.0)

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Turning points, see Motion; under a pressure that is not symmetric both halves of a
        period."""
        velocity = 0.0 if self.follows else self._sign * self.velocity
        first = self.motion.turns(velocity, self.size)
        if self.motion.half_period_mirror and not self.half_period_mirror:
            return (*first, *(phase + np.pi for phase in first[1:]))
        return first

    @property
    def start(self) -> float:
        """Phase at which a march begins: the first turning point, of the first contact."""
        return self.parts[0].turns(self.follows)[0] if self.contacts else self.turns[0]

    @property
    def focus(self) -> float | None:
        """Radius towards which rings are graded, see Motion."""
        return self.motion.focus(self._sign * self.velocity, self.size, self.pressure)

    @property
    def unit_drift(self) -> float:
        """Mean forward displacement in one radian of phase at velocity 1, in u_lim."""
        return self.motion.drift(1.0, self.size, self.poisson)

    @cached_property
    def drift(self) -> float:
        """Mean forward displacement in one radian of phase, in u_lim."""
        return self.motion.drift(self.velocity, self.size, self.poisson)

    @property
    def stroke(self) -> float:
        """Half the way that the edge of the contact oscillates, in u_lim."""
        return self.motion.stroke(self.size, self.poisson)

    # Normal load

    @property
    def depth(self) -> Callable[[np.ndarray], np.ndarray] | None:
        """Indentation over that of the reference state, a function of the phase; of several
        contacts one a row.  None: the load is constant."""
        if not self.motion.loads:
            return None
        if self.contacts:
            return lambda phase: np.stack([part.depth(phase) for part in self.parts])
        return lambda phase: self.motion.depth(phase, self.size, self.pressure)

    @property
    def deepest(self) -> float:
        """Largest indentation over that of the reference state."""
        return self.motion.deepest(self.size, self.pressure)

    @cached_property
    def mean_load(self) -> float:
        """Mean of the normal load over a period, over that of the reference state."""
        if self.contacts:
            return sum(part.share * part.problem.mean_load for part in self.parts)
        return float(self.motion.mean_load(self.size, self.pressure))

    # Several contacts

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Each contact of a body by itself; empty for one contact."""
        if not (self.follows and self.contacts):
            return tuple(_part(self, one) for one in self.contacts)
        parts = replace(self, follows=False).parts
        if not _move_together(parts, self.size):
            return parts
        return tuple(replace(part, problem=replace(part.problem, follows=True)) for part in parts)

    @property
    def shares(self) -> tuple[float, ...]:
        """Fraction of the mean normal load carried by each contact."""
        if not self.motion.loads:
            return tuple(part.share for part in self.parts)
        return tuple(part.share * part.problem.mean_load / self.mean_load for part in self.parts)

    @cached_property
    def is_balanced(self) -> bool:
        """Whether each contact has an opposite that oscillates half a period later, where the
        oscillation is its own reverse: at rest the two exert no forward force together."""
        there = self.motion.displacement(LOOP + np.pi, 0.0, self.size, self.poisson)
        here = self.motion.displacement(LOOP, 0.0, self.size, self.poisson)
        reversed_at = max(float(np.ptp(a + b)) for a, b in zip(here, there, strict=True))
        if reversed_at > RETURNED * max(self.size, 1.0):
            return False
        count = self.contacts.count
        opposite = [replace(one, phase=(one.phase + 180.0) % 360.0) for one in self.contacts]
        return all(count(a) == count(b) for a, b in zip(self.contacts, opposite, strict=True))


@dataclass(frozen=True)
class Part:
    """One contact of a body.

    Attributes
    ----------
    problem : Problem
        The contact alone, in its own units.
    share : float
        Its fraction of the load of the body, without oscillation.
    extent : float
        Its u_lim over that of the body.
    lead : float
        Phase by which its oscillation leads, radians.
    """

    problem: Problem
    share: float
    extent: float
    lead: float

    def oscillation(self, phase: np.ndarray) -> np.ndarray:
        """Oscillation at a phase of the body, shape (3, ...), in units of the body; the angle in
        units that move a place in the contact, over its radius, by so much."""
        return self.extent * np.array(self.problem.oscillation(phase + self.lead))

    def depth(self, phase: np.ndarray) -> np.ndarray:
        """Indentation at a phase of the body, if the load oscillates; see Problem."""
        one = self.problem
        return one.motion.depth(phase + self.lead, one.size, one.pressure)

    def turns(self, still: bool) -> np.ndarray:
        """Phases of the body at which the contact turns, or its oscillation alone (`still`)."""
        problem = replace(self.problem, velocity=0.0) if still else self.problem
        return np.array(problem.turns) - self.lead


def _move_together(parts: Sequence[Part], amplitude: float) -> bool:
    ahead = np.array([part.oscillation(LOOP)[0] for part in parts])
    return float(np.ptp(ahead, axis=0).max()) <= RETURNED * max(amplitude, 1.0)


def _part(body: Problem, one: BodyContact) -> Part:
    motion, pressure = body.motion, body.pressure
    extent = radius = 1.0
    if one.load != 1.0:
        extent = float(pressure.of_load(one.load))
        radius = float(pressure.radius(extent))
    length = radius / extent if motion.rotates else 1.0 / extent
    amplitude = body.size * one.amplitude * length
    alone = replace(body, amplitude=amplitude, drive=None, contacts=())
    unit = extent * alone.unit_drift
    if unit > 0.0:
        alone = replace(alone, velocity=body.drift / unit)
    share = one.load / len(body.contacts)
    return Part(alone, share, extent, float(np.deg2rad(one.phase)))


def contacts_refusal(problem: Problem) -> str:
    """The allowed values, where a motion or a pressure excludes several contacts; else ""."""
    motion = problem.motion
    if not motion.periodic:
        return f"allowed is none: {motion.name} does not oscillate"
    if any(one.load != 1.0 for one in problem.contacts):
        if not problem.pressure.is_indenter:
            return f"allowed are equal loads: how {problem.pressure.name} grows is not known"
        if motion.loads:
            return f"allowed are equal loads for {motion.name}, whose load oscillates"
        along = motion.displacement(LOOP, 0.0, problem.size, problem.poisson)[:2]
        if motion.rotates and max(np.ptp(one) for one in along) > 0.0:
            return f"allowed are equal loads for {motion.name}, which translates and rotates"
    if motion.rotates and any(one.amplitude == 0.0 for one in problem.contacts):
        return f"allowed are amplitudes above 0 for {motion.name}, which measure its velocity"
    return ""
