"""The class Problem: a motion at one velocity and amplitude, with a drive and a pressure.

Without a drive, the velocity is prescribed.  A drive prescribes the force, or the velocity of the
far end of a spring.  The equations of motion are

    velocity   u = v t                              force   m u'' + f = P
    spring     m u'' + c u' + f = k (v t - u)

Here u is the forward displacement of the body without the oscillation of the motion.  The forward
force of the contact is f.  The units are mu F_z for forces, u_lim for lengths, and 1 / omega for
times. Here F_z is the normal load without oscillation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial

import numpy as np

from microslip.foundation import spec
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import LOOP, Motion
from microslip.scene.pressure import Pressure

DRIVEN = {"force": -math.inf, "stiffness": 0.0, "mass": 0.0, "damping": 0.0}
"""Smallest allowed value of each parameter of a drive."""


class Drive(spec.Named):
    """Base class of drives.

    Attributes
    ----------
    force : float or None
        Prescribed force P divided by mu times the mean normal load; None for a spring.
    stiffness, mass, damping : float
        Stiffness k in units of mu F_z / u_lim, mass m in units of mu F_z / (u_lim omega^2), and
        damping c in units of mu F_z / (u_lim omega).
    """

    force: float | None
    stiffness: float
    mass: float
    damping: float

    def __post_init__(self) -> None:
        for name, value in vars(self).copy().items():
            object.__setattr__(self, name, real(name, value, DRIVEN[name]))


@dataclass(frozen=True)
class Force(Drive):
    """A prescribed forward force on a body with or without mass.

    Parameters
    ----------
    force : float
        Force divided by mu times the mean normal load.
    mass : float
        Mass of the body in units of mu F_z / (u_lim omega^2).

    Raises
    ------
    InputError
        If the force is not a finite number, or the mass is negative.
    """

    force: float
    mass: float = 0.0

    stiffness = 0.0
    damping = 0.0


@dataclass(frozen=True)
class Spring(Drive):
    """A spring attached to the body.  The far end of the spring moves at the velocity of the
    problem.

    Parameters
    ----------
    stiffness : float
        Stiffness of the spring in units of mu F_z / u_lim.
    mass : float
        Mass of the body in units of mu F_z / (u_lim omega^2).
    damping : float
        Damping constant of a dashpot parallel to the spring, in units of mu F_z / (u_lim omega).

    Raises
    ------
    InputError
        If an argument is negative or not finite.
    """

    stiffness: float
    mass: float = 0.0
    damping: float = 0.0

    force = None


@lru_cache(maxsize=8)
def _check(motion: Motion, pressure: Pressure) -> None:
    """Repeat the checks of the base classes, because a subclass can replace `__post_init__`."""
    Motion.__post_init__(motion)
    Pressure.__post_init__(pressure)


@dataclass(frozen=True)
class Problem:
    """A motion at one velocity and amplitude.

    All quantities are dimensionless.  The object is hashable.

    Parameters
    ----------
    motion : Motion
        The motion, such as `Transverse()` or `Elliptic(forward=0.5)`.
    velocity : float
        Dimensionless velocity, as in the paper; 0 stands for the limit v -> 0.  If the force is
        prescribed, the velocity is part of the result; keep the default of 0.
    amplitude : float or None
        Dimensionless amplitude, as in the paper; None for steady motions.
    poisson : float
        Poisson's ratio, from 0 to 0.5.
    pressure : Pressure
        Distribution of the normal load over the contact.
    drive : Force, Spring or None
        Drive of the forward motion; None if the velocity is prescribed.
    backward : bool
        Whether the forward direction is reversed.  For a symmetric pressure, the friction at v is
        then minus the friction of the original motion at -v.
    follows : bool
        Whether the body follows the forward oscillation of the contact, like a massless body under
        a constant force.  If True, the forward oscillation is subtracted from the motion.

    Attributes
    ----------
    size : float
        Amplitude of the motion, or 0 for a steady motion.
    force : float or None
        Prescribed force.  The force is None if the velocity is prescribed directly, or if a spring
        pulls the contact.
    half_period_mirror : bool
        Whether the second half of a period is the mirror image of the first half; see Motion.
    straight : bool
        Whether the oscillation alone follows a straight line; see Motion.
    on_a_line : bool
        Whether the motion is straight and the normal load is constant.  The tractions at the
        turning points then determine the static limit.
    depth : callable or None
        Function that returns the indentation depth at a phase, divided by the reference depth.
        None if the load is constant.

    Raises
    ------
    InputError
        If an argument has the wrong type, if a number is not finite, if the amplitude is missing,
        or if an amplitude is given for a steady motion.
    """

    motion: Motion
    velocity: float = 0.0
    amplitude: float | None = None
    poisson: float = 0.0
    pressure: Pressure = HERTZ
    drive: Drive | None = None
    backward: bool = False
    follows: bool = False
    size: float = field(init=False, repr=False, compare=False)
    force: float | None = field(init=False, repr=False, compare=False)
    half_period_mirror: bool = field(init=False, repr=False, compare=False)
    straight: bool = field(init=False, repr=False, compare=False)
    on_a_line: bool = field(init=False, repr=False, compare=False)
    depth: Callable | None = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        kinds = {"motion": Motion, "pressure": Pressure, "backward": bool, "follows": bool}
        for name, kind in kinds.items():
            if not isinstance(getattr(self, name), kind):
                raise InputError(name, getattr(self, name), f"allowed is a {kind.__name__}")
        if self.drive is not None and not isinstance(self.drive, Drive):
            raise InputError("drive", self.drive, "allowed is a Force or a Spring")
        _check(self.motion, self.pressure)
        limits = {"velocity": (-math.inf, math.inf), "poisson": (0.0, 0.5)}
        if self.motion.periodic:
            limits["amplitude"] = (0.0, math.inf)
        elif self.amplitude is not None:
            raise InputError("amplitude", self.amplitude, f"{self.motion.name} has no amplitude")
        for name, (low, high) in limits.items():
            object.__setattr__(self, name, real(name, getattr(self, name), low, high))
        motion, size = self.motion, 0.0 if self.amplitude is None else self.amplitude
        straight = motion.straight and not self.follows
        depth = partial(motion.depth, amplitude=size, pressure=self.pressure)
        vars(self).update(  # the class is frozen
            size=size,
            force=None if self.drive is None else self.drive.force,
            half_period_mirror=motion.half_period_mirror and self.pressure.mirrored,
            straight=straight,
            on_a_line=straight and not motion.loads,
            depth=depth if motion.loads else None,
        )
        if not motion.loads:
            vars(self).update(mean_load=1.0)

    def __str__(self) -> str:
        """Describe the problem in one line. Arguments with default values are omitted."""
        words = [f"{self.motion.name} velocity={self.velocity:.12g}"]
        if self.amplitude is not None:
            words.append(f"amplitude={self.amplitude:.12g}")
        words += [f"poisson={self.poisson:.12g}"] if self.poisson else []
        words += [f"pressure={self.pressure.name}"] if self.pressure != HERTZ else []
        words += [str(self.drive)] if self.drive else []
        return " ".join(words)

    def displacement(
        self, phase: np.ndarray, velocity: float | None = None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the rigid displacement (forward, lateral, angle) at a phase.

        The default of `velocity` is the velocity of the problem.
        """
        motion, sign = self.motion, -1.0 if self.backward else 1.0
        velocity = sign * (self.velocity if velocity is None else velocity)
        forward, lateral, angle = motion.moved(phase, velocity, self.size, self.poisson)
        if self.follows:
            forward = forward - motion.moved(phase, 0.0, self.size, self.poisson)[0]
        return sign * forward, lateral, sign * angle

    @cached_property
    def turns(self) -> tuple[float, ...]:
        """Phases of the turning points; see Motion.

        The phases cover a whole period if the pressure is not symmetric.
        """
        velocity = 0.0 if self.follows else -self.velocity if self.backward else self.velocity
        first = self.motion.turns(velocity, self.size)
        if self.motion.half_period_mirror and not self.half_period_mirror:
            return (*first, *(phase + np.pi for phase in first[1:]))
        return first

    @cached_property
    def focus(self) -> float | None:
        """Radius towards which rings are graded, or None; see Motion."""
        velocity = -self.velocity if self.backward else self.velocity
        return self.motion.focus(velocity, self.size, self.pressure)

    @property
    def propels(self) -> bool:
        """Whether the oscillation alone can propel the contact; see Motion."""
        return self.motion.propels and not self.follows

    @cached_property
    def unit_drift(self) -> float:
        """Mean forward displacement per radian of phase at the dimensionless velocity 1, in units
        of u_lim."""
        return self.motion.drift(1.0, self.size, self.poisson)

    @cached_property
    def drift(self) -> float:
        """Mean forward displacement per radian of phase, in units of u_lim."""
        return self.motion.drift(self.velocity, self.size, self.poisson)

    @cached_property
    def stroke(self) -> float:
        """Half the peak-to-peak displacement of the contact edge, in units of u_lim."""
        return self.motion.stroke(self.size, self.poisson)

    @cached_property
    def mean_speed(self) -> float:
        """Mean speed of the oscillation (path length per radian of phase), in units of u_lim."""
        places = np.array(self.displacement(LOOP, 0.0))
        moves = places[:, 1:] - places[:, :-1]
        return float(np.sqrt(np.sum(moves**2, axis=0)).sum()) / (2.0 * np.pi)

    @cached_property
    def mean_load(self) -> float:
        """Mean normal load over a period, divided by the reference load."""
        return float(self.motion.mean_load(self.size, self.pressure))

    @property
    def readings(self) -> tuple[Problem, ...]:
        """Problems with alternative interpolations of the same data; see Motion.readings and
        Pressure.readings."""
        if not (self.motion.readings or self.pressure.readings):
            return ()
        motions = (replace(self, motion=other) for other in self.motion.readings)
        others: tuple[Pressure, ...] = self.pressure.readings
        return (*motions, *(replace(self, pressure=other) for other in others))
