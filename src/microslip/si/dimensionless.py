"""Dimensionless groups of a motion and a drive in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from microslip.motions.by_name import motion_named
from microslip.motions.motion import Motion
from microslip.motions.samples import Sampled
from microslip.pressures.by_name import pressure_named
from microslip.si.bodies import TwoBodies
from microslip.si.motions import MOTIONS, PARTS
from microslip.si.strokes import Stroke
from microslip.theory import hertz


@dataclass(frozen=True)
class RealMotion:
    """A motion in SI units.  A missing quantity is None.

    Attributes
    ----------
    name, unit : str, str or None
        Name of the motion, and the SI unit of its amplitude; see motions.RealMotionKind.
    speed : float or None
        Forward speed, m/s; None if a force is prescribed.
    amplitude : float or None
        Half stroke of the oscillation, m, or rad for a rotation.  For a stroke from a file, the
        factor that multiplies its samples.
    frequency : float or None
        Frequency of the oscillation, Hz.
    rotation : float or None
        Angular speed of a steady spin, rad/s.
    forward_amplitude, rotation_amplitude, load_amplitude, phase : float or None
        For a motion with several oscillations: half strokes of the forward motion (m), the rotation
        (rad) and the load (N), and the phase (rad).
    stroke : Stroke or None
        One period of the motion, if it is read from a file.
    """

    name: str
    unit: str | None
    speed: float | None
    amplitude: float | None = None
    frequency: float | None = None
    rotation: float | None = None
    forward_amplitude: float | None = None
    rotation_amplitude: float | None = None
    load_amplitude: float | None = None
    phase: float | None = None
    stroke: Stroke | None = None

    @property
    def several(self) -> bool:
        """True for a motion with several amplitudes; see `parts`."""
        return not (self.unit or self.steady)

    @property
    def steady(self) -> bool:
        """True if nothing oscillates."""
        return self.frequency is None

    @property
    def spins(self) -> bool:
        """True if the amplitude is an angle."""
        return self.unit == "rad"

    @property
    def swing(self) -> tuple[float, float]:
        """Largest displacement along the surface in a period, m, and largest rotation, rad."""
        if self.spins:
            return 0.0, self.amplitude or 0.0
        if self.stroke is not None:
            return self._times_factor(self.stroke.reach)
        along = math.hypot(self.amplitude or 0.0, self.forward_amplitude or 0.0)
        return along, self.rotation_amplitude or 0.0

    @property
    def pace(self) -> tuple[float, float]:
        """Largest tangential speed and largest angular speed of the oscillation, m and rad.  Both
        are divided by the angular frequency."""
        return self.swing if self.stroke is None else self._times_factor(self.stroke.pace)

    def _times_factor(self, pair: tuple[float, float]) -> tuple[float, float]:
        factor = self.amplitude or 0.0
        return factor * pair[0], factor * pair[1]

    @property
    def turn(self) -> float:
        """Angular frequency of the oscillation, or angular speed of a steady spin, rad/s."""
        if self.frequency is not None:
            return 2.0 * math.pi * self.frequency
        assert self.rotation is not None  # a steady motion has a rotation
        return self.rotation

    @property
    def rate(self) -> float:
        """Frequency of the oscillation, or number of turns per second of a steady spin, Hz."""
        return self.turn / (2.0 * math.pi) if self.frequency is None else self.frequency

    @property
    def known_speed(self) -> float:
        """The speed, m/s.  It must not be None."""
        assert self.speed is not None
        return self.speed


@dataclass(frozen=True, eq=False)
class MovingContact:
    """A contact and its motion, in SI units, and their dimensionless groups.

    Attributes
    ----------
    contact, motion : TwoBodies, RealMotion
        The contact and its motion.
    """

    contact: TwoBodies
    motion: RealMotion

    @cached_property
    def parts(self) -> dict[str, float]:
        """Dimensionless amplitudes of a motion with several oscillations, keyed by the solver's
        names.  For a motion from a file, they are the largest deviations in each column."""
        motion, contact = self.motion, self.contact
        if motion.stroke is not None:
            factor, columns = motion.amplitude or 0.0, motion.stroke.deviations(contact)
            return {name: factor * float(abs(one).max()) for name, one in columns.items()}
        unit = {"lateral": contact.u_lim, "forward": contact.u_lim, "load": contact.load}
        sizes = {share: getattr(motion, name) for name, share in PARTS.items()}
        return {
            share: self._bore_amplitude(size) if share == "angle" else size / unit[share]
            for share, size in sizes.items()
            if size is not None
        }

    def _bore_amplitude(self, angle: float) -> float:
        """Dimensionless amplitude for a rotation, rad."""
        angle = angle * self.contact.contact_radius / self.contact.u_lim
        return float(hertz.bore_amplitude(angle, self.contact.poisson))

    @property
    def solver_motion(self) -> str | Motion:
        """The motion for microslip.solve, as text or as an object.  If there are several
        amplitudes, each is divided by the largest."""
        motion = self.motion
        if not motion.several:
            return motion.name
        largest = max(self.parts.values())
        if motion.stroke is not None:
            return motion.stroke.sampled(self.contact, largest / (motion.amplitude or 1.0) or 1.0)
        shares = {name: size / (largest or 1.0) for name, size in self.parts.items()}
        shares["phase"] = math.degrees(motion.phase or 0.0)
        return f"{motion.name}:{','.join(f'{name}={value!r}' for name, value in shares.items())}"

    @cached_property
    def groups(self) -> tuple[float | None, float | None]:
        """Velocity and amplitude for microslip.solve (Eqs 2, 4, 13, 27, 28).

        The velocity is None if a force is prescribed.  The amplitude is None for a steady motion.
        """
        speed, unit = self.motion.speed, self.speed_unit
        size = None if self.motion.steady else self._size
        if speed is None:
            return None, size
        if speed == 0.0 or self.motion.spins and unit == 0.0:
            return 0.0, size
        return speed / unit if unit > 0.0 else math.inf, size

    @cached_property
    def _size(self) -> float:
        """Amplitude of a motion that oscillates, for microslip.solve."""
        if self.motion.several:
            return max(self.parts.values())
        size = self.motion.amplitude
        assert size is not None  # the motion has one oscillation
        if self.motion.spins and size:
            return self._bore_amplitude(size)
        return size / self.contact.u_lim

    @property
    def speed_unit(self) -> float:
        """Forward speed, m/s, at which the dimensionless velocity is 1.  It can underflow to 0."""
        motion, contact, omega = self.motion, self.contact, self.motion.turn
        if motion.steady:
            return omega * contact.contact_radius
        if motion.name == "bore":
            return omega * motion.swing[1] * contact.contact_radius
        if motion.name in MOTIONS or motion.stroke is not None:
            return omega * contact.u_lim
        drift = motion_named(motion.name).drift(1.0, self._size, contact.poisson)
        return omega * contact.u_lim * drift

    @property
    def mean_load(self) -> float:
        """Mean normal load, N.  It is larger than `contact.load` if the bodies separate in each
        period.  For some motions from files, it also differs from `contact.load`."""
        motion, load = self.motion, self.contact.load
        if motion.stroke is None and (motion.load_amplitude or 0.0) <= load:
            return load
        record = self.solver_motion
        record = record if isinstance(record, Motion) else motion_named(record)
        return load * float(record.mean_load(self._size, pressure_named(self.contact.pressure)))

    @property
    def separated(self) -> float:
        """Fraction of a period without contact, 0 to 1."""
        motion = self.motion
        if motion.stroke is None:
            swing = motion.load_amplitude or 0.0
            return (
                math.acos(self.contact.load / swing) / math.pi if swing > self.contact.load else 0.0
            )
        record = self.solver_motion
        assert isinstance(record, Sampled)  # the motion is read from a file
        return record.share_without_load(self._size)

    @property
    def full_friction(self) -> float:
        """Unit of forces: mu times the mean normal load, N."""
        return self.contact.mu * self.mean_load

    @property
    def largest_slip_speed(self) -> float:
        """Upper bound on the slip speed, m/s: the slip speed of rigid bodies at the edge of the
        contact.

        It is NaN for a contact that runs away.
        """
        motion, edge = self.motion, self.contact.contact_radius
        if motion.steady:
            return math.hypot(motion.known_speed, motion.turn * edge)
        along, turned = motion.pace
        return motion.known_speed + motion.turn * (along + edge * turned)


@dataclass(frozen=True)
class RealDrive:
    """The drive of a body, in SI units.

    Attributes
    ----------
    force : float or None
        Prescribed constant force, N.
    stiffness : float or None
        Stiffness of a spring, N/m.  The far end of the spring moves at the forward speed.
    mass, damping : float or None
        Mass of the body, kg, and damping of a dashpot parallel to the spring, N s/m.
    """

    force: float | None = None
    stiffness: float | None = None
    mass: float | None = None
    damping: float | None = None

    def groups(self, moving: MovingContact) -> dict[str, float]:
        """Force, stiffness, mass and damping for microslip.solve, without None values.

        The force is divided by mu times the mean load, the stiffness by mu F_z / u_lim, the mass by
        mu F_z / (u_lim omega^2), and the damping by mu F_z / (u_lim omega).  F_z is the load
        without oscillation.
        """
        contact, omega = moving.contact, moving.motion.turn
        stiffness = contact.mu * contact.load / contact.u_lim
        units = {
            "force": 1.0 / moving.full_friction,
            "stiffness": 1.0 / stiffness,
            "mass": omega * omega / stiffness,
            "damping": omega / stiffness,
        }
        values = ((name, getattr(self, name), unit) for name, unit in units.items())
        return {name: value * unit for name, value, unit in values if value is not None}
