"""Drives other than a prescribed velocity: a prescribed force, or a spring attached to a body.

    velocity   u = v t                              force   m u'' + f = P
    spring     m u'' + c u' + f = k (v t - u)

Here u is the forward displacement of the body without the oscillation of the motion, and f is the
forward force of the contact.  Units are mu F_z, u_lim and the time 1 / omega, where F_z is the
normal load without oscillation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from microslip.foundation import spec
from microslip.foundation.arguments import real


class Drive:
    """Base class of drives.

    Attributes
    ----------
    force : float or None
        Prescribed force P divided by mu times the mean normal load; None for a spring.
    stiffness, mass, damping : float
        Stiffness k in mu F_z / u_lim, mass m in mu F_z / (u_lim omega^2) and damping c in mu F_z /
        (u_lim omega).
    """

    force: float | None
    stiffness: float
    mass: float
    damping: float

    def __str__(self) -> str:
        return spec.text_of(self)


@dataclass(frozen=True)
class Force(Drive):
    """A prescribed forward force on a body with or without mass.

    Parameters
    ----------
    force : float
        Force divided by mu times the mean normal load.
    mass : float
        Mass of the body in mu F_z / (u_lim omega^2).

    Raises
    ------
    InputError
        If the force is not a finite number, or the mass is negative.
    """

    force: float
    mass: float = 0.0

    stiffness = 0.0
    damping = 0.0

    def __post_init__(self) -> None:
        real("force", self.force, -math.inf)
        real("mass", self.mass, 0.0)


@dataclass(frozen=True)
class Spring(Drive):
    """A spring attached to a body.  The far end of the spring moves at the velocity of the problem.

    Parameters
    ----------
    stiffness : float
        Stiffness of the spring in mu F_z / u_lim.
    mass : float
        Mass of the body in mu F_z / (u_lim omega^2).
    damping : float
        Damping constant of a dashpot parallel to the spring, in mu F_z / (u_lim omega).

    Raises
    ------
    InputError
        If a number is negative or not finite.
    """

    stiffness: float
    mass: float = 0.0
    damping: float = 0.0

    force = None

    def __post_init__(self) -> None:
        for name in ("stiffness", "mass", "damping"):
            real(name, getattr(self, name), 0.0)
