"""A problem: a motion at one velocity and amplitude, its drive, pressure and contacts.

A body can rest on several contacts of the same shape.  In the units of the body, forces are divided
by mu times the load of all contacts, and displacements by the u_lim of a contact under the mean
load.  Under another load, the indentation and the u_lim of a contact are `extent` times larger.
Its radius and its stiffness change as well, but by less.  The amplitude and the velocity of the
body are lengths, so they are divided by `extent` to convert them to the units of a contact.

All contacts move forward with the body.  At a prescribed velocity, the contacts are independent,
and their phases have no effect.
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

SMALLEST_OSCILLATION = 1e-12
"""A difference between oscillations counts as a rounding error if it is below this fraction of the
amplitude."""
ROUNDING = 1e-9
"""Largest accepted difference between 1 and the mean load of several contacts.  A text gives loads
with 12 digits."""


@dataclass(frozen=True)
class Problem:
    """A motion at one velocity and amplitude.  All quantities are dimensionless, and the object is
    hashable.

    Parameters
    ----------
    motion : Motion
        The motion, such as `Transverse()` or `Elliptic(forward=0.5)`.
    velocity : float
        The paper's dimensionless velocity; 0 is the limit v -> 0.  Under a prescribed force, the
        velocity is part of the result; leave this argument at 0.
    amplitude : float or None
        The paper's dimensionless amplitude; None for steady motions.
    poisson : float
        Poisson's ratio, 0 to 0.5.
    pressure : Pressure
        Distribution of the load.
    drive : Force, Spring or None
        Drive of the forward motion; None if the velocity is prescribed.
    contacts : tuple of BodyContact
        Contacts that carry the body; empty for a single contact.
    backward : bool
        Whether the forward direction is reversed.  Then, under a symmetric pressure, friction at v
        equals minus the friction of the original motion at -v.
    follows : bool
        Whether the body follows the mean forward oscillation of its contacts, as a massless body
        under a constant force does.  The mean oscillation is then subtracted from each contact's
        oscillation.

    Raises
    ------
    InputError
        If an argument has another type, if a number is not finite, if the amplitude is missing, or
        if a steady motion has one.
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
            allowed = "allowed are loads over their mean load: the mean of all loads must be 1"
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
        """The problem as one line of text, without default values."""
        words = [f"{self.motion.name} velocity={self.velocity:.12g}"]
        if self.amplitude is not None:
            words.append(f"amplitude={self.amplitude:.12g}")
        words += [f"poisson={self.poisson:.12g}"] if self.poisson else []
        words += [f"pressure={self.pressure.name}"] if self.pressure != HERTZ else []
        words += [str(self.drive)] if self.drive else []
        words += [f"contacts={contacts_text(self.contacts)}"] if self.contacts else []
        return " ".join(words)

    # Symmetries that both the motion and the pressure have

    @property
    def half_period_mirror(self) -> bool:
        """Whether the second half of a period is the mirror image of the first half; see Motion."""
        return self.motion.half_period_mirror and self.pressure.mirrored

    @property
    def straight(self) -> bool:
        """Whether the oscillation alone follows a straight line; see Motion."""
        return self.motion.straight and not self.follows

    @property
    def propels(self) -> bool:
        """Whether the oscillation alone can propel the contact; see Motion."""
        return self.motion.propels and not self.follows

    # Kinematics

    @property
    def size(self) -> float:
        """The amplitude; 0 for a steady motion."""
        return 0.0 if self.amplitude is None else self.amplitude

    @property
    def _sign(self) -> float:
        return -1.0 if self.backward else 1.0

    def _displacement(
        self, phase: np.ndarray, velocity: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rigid displacement at a velocity."""
        motion, sign = self.motion, self._sign
        amplitude = (self.size, self.poisson)
        forward, lateral, angle = motion.displacement(phase, sign * velocity, *amplitude)
        if self.follows and not self.contacts:
            forward = forward - motion.displacement(phase, 0.0, *amplitude)[0]
        return sign * forward, lateral, sign * angle

    def displacement(self, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rigid displacement (forward, lateral, angle) at a phase."""
        return self._displacement(phase, self.velocity)

    def oscillation(self, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rigid displacement (forward, lateral, angle) at a phase, for velocity 0."""
        return self._displacement(phase, 0.0)

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Phases of the turning points; see Motion.  They cover a whole period if the pressure is
        not symmetric."""
        velocity = 0.0 if self.follows else self._sign * self.velocity
        first = self.motion.turns(velocity, self.size)
        if self.motion.half_period_mirror and not self.half_period_mirror:
            return (*first, *(phase + np.pi for phase in first[1:]))
        return first

    @property
    def start(self) -> float:
        """Phase at which a march begins: the first turning point of the first contact."""
        return self.parts[0].turns(self.follows)[0] if self.contacts else self.turns[0]

    @property
    def focus(self) -> float | None:
        """Radius towards which rings are graded, or None; see Motion."""
        return self.motion.focus(self._sign * self.velocity, self.size, self.pressure)

    @property
    def unit_drift(self) -> float:
        """Mean forward displacement per radian of phase at velocity 1, in u_lim."""
        return self.motion.drift(1.0, self.size, self.poisson)

    @cached_property
    def drift(self) -> float:
        """Mean forward displacement per radian of phase, in u_lim."""
        return self.motion.drift(self.velocity, self.size, self.poisson)

    @property
    def stroke(self) -> float:
        """Half the peak-to-peak displacement of the edge of the contact, in u_lim."""
        return self.motion.stroke(self.size, self.poisson)

    @cached_property
    def mean_speed(self) -> float:
        """Mean speed of the oscillation: path length per radian of phase, in u_lim.

        For several contacts, it is the mean weighted by their loads.
        """
        if self.contacts:
            return sum(part.share * part.extent * part.problem.mean_speed for part in self.parts)
        moves = np.diff(np.stack(self.oscillation(LOOP)), axis=1)
        return float(np.sqrt(np.sum(moves**2, axis=0)).sum()) / (2.0 * np.pi)

    @property
    def largest_energy(self) -> float:
        """Work of full friction along the path of one period, divided by mu F_z u_lim.

        It is an upper bound on the dissipated energy.
        """
        return 2.0 * np.pi * self.mean_load * (self.mean_speed + abs(self.drift))

    # Numbers from files

    @property
    def readings(self) -> tuple[Problem, ...]:
        """Problems that interpolate the same data differently; see Motion.readings and
        Pressure.readings."""
        motions = (replace(self, motion=other) for other in self.motion.readings)
        pressures = (replace(self, pressure=other) for other in self.pressure.readings)
        return (*motions, *pressures)

    # Normal load

    @property
    def depth(self) -> Callable[[np.ndarray], np.ndarray] | None:
        """Function of the phase that returns the indentation depth divided by its reference value.

        For several contacts, the function returns one row for each contact.  The attribute is None
        if the load is constant.
        """
        if not self.motion.loads:
            return None
        if self.contacts:
            return lambda phase: np.stack([part.depth(phase) for part in self.parts])
        return lambda phase: self.motion.depth(phase, self.size, self.pressure)

    @property
    def deepest(self) -> float:
        """Largest indentation depth divided by its reference value."""
        return self.motion.deepest(self.size, self.pressure)

    @cached_property
    def mean_load(self) -> float:
        """Mean normal load in a period divided by its reference value."""
        if self.contacts:
            return sum(part.share * part.problem.mean_load for part in self.parts)
        return float(self.motion.mean_load(self.size, self.pressure))

    # Several contacts

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """The contacts of the body as separate problems; empty for a single contact."""
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
        """Whether the contacts form pairs such that each pair exerts no mean forward force.

        The oscillation changes its sign after half a period, and the phases in a pair differ by
        half a period.  So the two contacts of a pair oscillate in opposite directions.
        """
        there = self.motion.displacement(LOOP + np.pi, 0.0, self.size, self.poisson)
        here = self.motion.displacement(LOOP, 0.0, self.size, self.poisson)
        reversed_at = max(float(np.ptp(a + b)) for a, b in zip(here, there, strict=True))
        if reversed_at > SMALLEST_OSCILLATION * max(self.size, 1.0):
            return False
        count = self.contacts.count
        opposite = [replace(one, phase=(one.phase + 180.0) % 360.0) for one in self.contacts]
        return all(count(a) == count(b) for a, b in zip(self.contacts, opposite, strict=True))


@dataclass(frozen=True)
class Part:
    """One of several contacts, treated as a separate problem.

    Attributes
    ----------
    problem : Problem
        Problem of the single contact, in the units of this contact.
    share : float
        Fraction of the body's load that the contact carries without oscillation.
    extent : float
        u_lim of the contact divided by u_lim of the body.
    lead : float
        Phase lead of the contact's oscillation, in radians.
    """

    problem: Problem
    share: float
    extent: float
    lead: float

    def oscillation(self, phase: np.ndarray) -> np.ndarray:
        """Forward, lateral and angular oscillation at a phase of the body, shape (3, ...).

        Displacements are in u_lim of the body.  The angle is multiplied by the contact's radius, so
        it is also in u_lim of the body.
        """
        return self.extent * np.array(self.problem.oscillation(phase + self.lead))

    def depth(self, phase: np.ndarray) -> np.ndarray:
        """Indentation depth at a phase of the body, if the load oscillates; see Problem."""
        problem = self.problem
        return problem.motion.depth(phase + self.lead, problem.size, problem.pressure)

    def turns(self, still: bool) -> np.ndarray:
        """The body's phases at the turning points of the contact.  still: True for velocity 0."""
        problem = replace(self.problem, velocity=0.0) if still else self.problem
        return np.array(problem.turns) - self.lead


def _move_together(parts: Sequence[Part], amplitude: float) -> bool:
    """Whether the forward oscillations of all contacts are equal."""
    ahead = np.array([part.oscillation(LOOP)[0] for part in parts])
    return float(np.ptp(ahead, axis=0).max()) <= SMALLEST_OSCILLATION * max(amplitude, 1.0)


def _part(body: Problem, one: BodyContact) -> Part:
    """Return the Part for one contact of a body."""
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
    """Return a message if the contacts cannot be combined with the motion or the pressure,
    otherwise "".  The message describes the allowed contacts."""
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
