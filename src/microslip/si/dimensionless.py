"""Dimensionless groups of a motion and a drive in SI units."""

from __future__ import annotations

import math
from dataclasses import dataclass

from microslip.motions.by_name import motion_named
from microslip.motions.motion import Motion
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


def parts(motion: RealMotion, contact: TwoBodies) -> dict[str, float]:
    """Dimensionless amplitudes of a motion with several oscillations, keyed by the solver's names.
    For a motion from a file, they are the largest deviations in each column."""
    if motion.stroke is not None:
        factor, columns = motion.amplitude or 0.0, motion.stroke.deviations(contact)
        return {name: factor * float(abs(one).max()) for name, one in columns.items()}
    unit = {"lateral": contact.u_lim, "forward": contact.u_lim, "load": contact.load}
    amplitudes = {}
    for name, share in PARTS.items():
        size = getattr(motion, name)
        if size is not None and share == "angle":
            angle = size * contact.contact_radius / contact.u_lim
            amplitudes[share] = float(hertz.bore_amplitude(angle, contact.poisson))
        elif size is not None:
            amplitudes[share] = size / unit[share]
    return amplitudes


def solver_motion(motion: RealMotion, contact: TwoBodies) -> str | Motion:
    """The motion for microslip.solve, as text or as an object.  If there are several amplitudes,
    each is divided by the largest."""
    if not motion.several:
        return motion.name
    amplitudes = parts(motion, contact)
    if motion.stroke is not None:
        factor = motion.amplitude or 1.0
        return motion.stroke.sampled(contact, max(amplitudes.values()) / factor or 1.0)
    largest = max(amplitudes.values()) or 1.0
    shares = {name: size / largest for name, size in amplitudes.items()}
    shares["phase"] = math.degrees(motion.phase or 0.0)
    return f"{motion.name}:{','.join(f'{name}={value!r}' for name, value in shares.items())}"


def groups(motion: RealMotion, contact: TwoBodies) -> tuple[float | None, float | None]:
    """Velocity and amplitude for microslip.solve (Eqs 2, 4, 13, 27, 28).

    The velocity is None if a force is prescribed.  The amplitude is None for a steady motion.
    """
    unit = speed_unit(motion, contact)
    velocity = None if motion.speed is None else _over(motion.speed, unit)
    if motion.spins and unit == 0.0:
        velocity = None if velocity is None else 0.0
    return velocity, _size(motion, contact)


def _size(motion: RealMotion, contact: TwoBodies) -> float | None:
    """Amplitude for microslip.solve; None for a steady motion."""
    if motion.steady:
        return None
    if motion.several:
        return max(parts(motion, contact).values())
    assert motion.amplitude is not None  # the motion has one oscillation
    if not motion.spins:
        return motion.amplitude / contact.u_lim
    angle = motion.amplitude * contact.contact_radius / contact.u_lim
    return float(hertz.bore_amplitude(angle, contact.poisson)) if angle else 0.0


def _known_size(motion: RealMotion, contact: TwoBodies) -> float:
    size = _size(motion, contact)
    assert size is not None  # the motion oscillates
    return size


def speed_unit(motion: RealMotion, contact: TwoBodies) -> float:
    """Forward speed, m/s, at which the dimensionless velocity is 1.  It can underflow to 0."""
    if motion.steady:
        return motion.turn * contact.contact_radius
    omega = motion.turn
    if motion.name == "bore":
        return omega * motion.swing[1] * contact.contact_radius
    if motion.name in MOTIONS or motion.stroke is not None:
        return omega * contact.u_lim
    record, size = motion_named(motion.name), _known_size(motion, contact)
    return omega * contact.u_lim * record.drift(1.0, size, contact.poisson)


def _over(speed: float, unit: float) -> float:
    """A speed divided by the unit of speed.  The unit can be 0."""
    if speed == 0.0:
        return 0.0
    return speed / unit if unit > 0.0 else math.inf


def mean_load(motion: RealMotion, contact: TwoBodies) -> float:
    """Mean normal load, N.  It is larger than `contact.load` if the bodies separate in each period.
    For some motions from files, it also differs from `contact.load`."""
    if motion.stroke is None and (motion.load_amplitude or 0.0) <= contact.load:
        return contact.load
    record = solver_motion(motion, contact)
    record = record if isinstance(record, Motion) else motion_named(record)
    pressure = pressure_named(contact.pressure)
    return contact.load * float(record.mean_load(_known_size(motion, contact), pressure))


def full_friction(motion: RealMotion, contact: TwoBodies) -> float:
    """Unit of forces: mu times the mean normal load, N."""
    return contact.mu * mean_load(motion, contact)


@dataclass(frozen=True)
class RealDrive:
    """The drive of a contact, in SI units.

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


def drive_groups(drive: RealDrive, motion: RealMotion, contact: TwoBodies) -> dict[str, float]:
    """Force, stiffness, mass and damping for microslip.solve, without None values.

    The force is divided by mu times the mean load, the stiffness by mu F_z / u_lim, the mass by mu
    F_z / (u_lim omega^2), and the damping by mu F_z / (u_lim omega).  F_z is the load without
    oscillation.
    """
    still = contact.mu * contact.load
    stiffness = still / contact.u_lim
    omega = motion.turn
    pairs = {
        "force": (drive.force, 1.0 / full_friction(motion, contact)),
        "stiffness": (drive.stiffness, 1.0 / stiffness),
        "mass": (drive.mass, omega * omega / stiffness),
        "damping": (drive.damping, omega / stiffness),
    }
    return {name: value * unit for name, (value, unit) in pairs.items() if value is not None}


def largest_slip_speed(motion: RealMotion, contact: TwoBodies) -> float:
    """Upper bound on the slip speed, m/s: the slip speed of rigid bodies at the edge of the
    contact.

    It is NaN for a contact that runs away.
    """
    edge, speed = contact.contact_radius, motion.known_speed
    if motion.steady:
        return math.hypot(speed, motion.turn * edge)
    along, turned = motion.pace
    return speed + motion.turn * (along + edge * turned)
