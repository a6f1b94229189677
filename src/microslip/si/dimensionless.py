"""The dimensionless groups of a motion in SI units, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from microslip.motions.by_name import motion_named
from microslip.pressures.by_name import pressure_named
from microslip.si.bodies import TwoBodies
from microslip.si.motions import COMBINED, MOTIONS, PARTS, is_steady, unit_of_amplitude
from microslip.theory import hertz


@dataclass(frozen=True)
class RealMotion:
    """A motion in SI units: forward speed, m/s; amplitude (half stroke), m or rad; frequency, Hz;
    rotation, rad/s, of a steady bore.  Quantities that a motion lacks are None, and so is a speed
    that follows from a force.  Motions that oscillate in several ways have further half strokes:
    forward, m, in rotation, rad, of the load, N; and a phase, rad, see `solver_motion`."""

    name: str
    speed: float | None
    amplitude: float | None = None
    frequency: float | None = None
    rotation: float | None = None
    forward_amplitude: float | None = None
    rotation_amplitude: float | None = None
    load_amplitude: float | None = None
    phase: float | None = None

    @property
    def steady(self) -> bool:
        """Whether nothing oscillates."""
        return is_steady(self.name)

    @property
    def spins(self) -> bool:
        """Whether the amplitude is an angle."""
        return unit_of_amplitude(self.name) == "rad"

    @property
    def swing(self) -> tuple[float, float]:
        """Half strokes along the surface, m, and in rotation, rad, each at its largest."""
        if self.spins:
            return 0.0, self.amplitude or 0.0
        along = math.hypot(self.amplitude or 0.0, self.forward_amplitude or 0.0)
        return along, self.rotation_amplitude or 0.0

    @property
    def turn(self) -> float:
        """Angular frequency of the oscillation, or angular speed of what is steady, rad/s."""
        if self.frequency is not None:
            return 2.0 * math.pi * self.frequency
        assert self.rotation is not None  # as of all that is steady
        return self.rotation

    @property
    def rate(self) -> float:
        """Frequency of the oscillation, or turns a second of what is steady, Hz."""
        return self.turn / (2.0 * math.pi) if self.frequency is None else self.frequency

    @property
    def known_speed(self) -> float:
        """The speed, m/s, of a motion whose speed is known."""
        assert self.speed is not None
        return self.speed


def parts(motion: RealMotion, contact: TwoBodies) -> dict[str, float]:
    """Amplitudes of a motion that oscillates in several ways, in the solver's groups, by the names
    of their shares."""
    unit = {"lateral": contact.u_lim, "forward": contact.u_lim, "load": contact.load}
    found = {}
    for name, (share, _) in PARTS.items():
        size = getattr(motion, name)
        if size is not None and share == "angle":
            angle = size * contact.contact_radius / contact.u_lim
            found[share] = float(hertz.bore_amplitude(angle, contact.poisson))
        elif size is not None:
            found[share] = size / unit[share]
    return found


def solver_motion(motion: RealMotion, contact: TwoBodies) -> str:
    """Text of the motion for microslip.solve; several amplitudes become shares of the largest."""
    if motion.name not in COMBINED:
        return motion.name
    found = parts(motion, contact)
    largest = max(found.values()) or 1.0
    shares = {name: size / largest for name, size in found.items()}
    shares["phase"] = math.degrees(motion.phase or 0.0)
    return f"{motion.name}:{','.join(f'{name}={value!r}' for name, value in shares.items())}"


def groups(motion: RealMotion, contact: TwoBodies) -> tuple[float | None, float | None]:
    """(velocity, amplitude) as microslip.solve takes them (Eqs 2, 4, 13, 27, 28).

    motion: RealMotion; contact: bodies.TwoBodies.  amplitude: None for a steady bore.  velocity:
    None where the speed is.
    """
    unit = speed_unit(motion, contact)
    velocity = None if motion.speed is None else _over(motion.speed, unit)
    if motion.spins and unit == 0.0:
        velocity = None if velocity is None else 0.0
    return velocity, _size(motion, contact)


def _size(motion: RealMotion, contact: TwoBodies) -> float | None:
    """The amplitude as microslip.solve takes it; None for a steady motion."""
    if motion.steady:
        return None
    if motion.name in COMBINED:
        return max(parts(motion, contact).values())
    assert motion.amplitude is not None  # as of all that oscillate in one way
    if not motion.spins:
        return motion.amplitude / contact.u_lim
    angle = motion.amplitude * contact.contact_radius / contact.u_lim
    return float(hertz.bore_amplitude(angle, contact.poisson)) if angle else 0.0


def _known_size(motion: RealMotion, contact: TwoBodies) -> float:
    size = _size(motion, contact)
    assert size is not None  # as of all that oscillate
    return size


def speed_unit(motion: RealMotion, contact: TwoBodies) -> float:
    """Forward speed whose group is 1, m/s; it may be rounded to nothing."""
    if motion.steady:
        return motion.turn * contact.contact_radius
    omega = motion.turn
    if motion.name == "bore":
        return omega * motion.swing[1] * contact.contact_radius
    if motion.name in MOTIONS:
        return omega * contact.u_lim
    record, size = motion_named(motion.name), _known_size(motion, contact)
    return omega * contact.u_lim * record.drift(1.0, size, contact.poisson)


def _over(speed: float, unit: float) -> float:
    """A speed over another one that may have been rounded to nothing."""
    if speed == 0.0:
        return 0.0
    return speed / unit if unit > 0.0 else math.inf


def mean_load(motion: RealMotion, contact: TwoBodies) -> float:
    """Mean normal load, N: more than the load where its oscillation parts the bodies."""
    if motion.load_amplitude is None or motion.load_amplitude <= contact.load:
        return contact.load
    record, pressure = (
        motion_named(solver_motion(motion, contact)),
        pressure_named(contact.pressure),
    )
    return contact.load * float(record.mean_load(_known_size(motion, contact), pressure))


def full_friction(motion: RealMotion, contact: TwoBodies) -> float:
    """mu times the mean normal load, N, the unit of mu_macro and of forces."""
    return contact.mu * mean_load(motion, contact)


@dataclass(frozen=True)
class RealDrive:
    """The drive of a contact, in SI units.

    Attributes
    ----------
    force : float or None
        Constant force, N; None: no force is prescribed.
    stiffness : float or None
        Stiffness of a spring whose far end has the speed of the motion, N/m; None: no spring.
    mass, damping : float or None
        Mass of the driven body, kg, and damping of a dashpot on it, N s/m.
    """

    force: float | None = None
    stiffness: float | None = None
    mass: float | None = None
    damping: float | None = None


def drive_groups(drive: RealDrive, motion: RealMotion, contact: TwoBodies) -> dict[str, float]:
    """force, stiffness, mass and damping as microslip.solve takes them, those that are not None.

    The force is over mu times the mean load, the others over mu F_z / u_lim, mu F_z / (u_lim
    omega^2) and mu F_z / (u_lim omega), F_z the load.
    """
    still = contact.mu * contact.load
    stiffness = still / contact.u_lim
    omega = motion.turn
    found = {
        "force": (drive.force, 1.0 / full_friction(motion, contact)),
        "stiffness": (drive.stiffness, 1.0 / stiffness),
        "mass": (drive.mass, omega * omega / stiffness),
        "damping": (drive.damping, omega / stiffness),
    }
    return {name: value * unit for name, (value, unit) in found.items() if value is not None}


def largest_slip_speed(motion: RealMotion, contact: TwoBodies) -> float:
    """Upper bound of the speed between the surfaces, m/s: rigid, at the edge.

    NaN where the contact runs away.
    """
    edge, speed = contact.contact_radius, motion.known_speed
    if motion.steady:
        return math.hypot(speed, motion.turn * edge)
    along, turned = motion.swing
    return speed + motion.turn * (along + edge * turned)
