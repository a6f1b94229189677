"""Drives other than a prescribed velocity: a prescribed force, or a spring that pulls a body.

    velocity   u = v t                              force   m u'' + f = P
    spring     m u'' + c u' + f = k (v t - u)

u: forward displacement of the body beyond the oscillation of the motion; f: forward force of the
contact; all over mu F_z, u_lim and the time 1 / omega.  Here F_z is the load without oscillation.
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
        P; None for a spring.
    stiffness, mass, damping : float
        k over mu F_z / u_lim, m over mu F_z / (u_lim omega^2), c over mu F_z / (u_lim omega).
    """

    force: float | None
    stiffness: float
    mass: float
    damping: float

    def __str__(self) -> str:
        return spec.text_of(self)


@dataclass(frozen=True)
class Force(Drive):
    """A prescribed forward force, on a body that may have a mass.

    Parameters
    ----------
    force : float
        Over mu times the mean normal load.
    mass : float
        Over mu F_z / (u_lim omega^2).

    Raises
    ------
    InputError
        For a force that is no finite number, or a mass below 0.
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
    """A spring whose far end has the velocity of the problem, and the body that it pulls.

    Parameters
    ----------
    stiffness : float
        Stiffness of the spring, over mu F_z / u_lim, above 0.
    mass : float
        Mass of the body, over mu F_z / (u_lim omega^2).
    damping : float
        Damping of a dashpot parallel to the spring, over mu F_z / (u_lim omega).

    Raises
    ------
    InputError
        For numbers that are not finite or below 0.
    """

    stiffness: float
    mass: float = 0.0
    damping: float = 0.0

    force = None

    def __post_init__(self) -> None:
        for name in ("stiffness", "mass", "damping"):
            real(name, getattr(self, name), 0.0)
