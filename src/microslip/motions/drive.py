"""Drives other than a prescribed velocity: a prescribed force, or a spring that pulls a body.

    velocity   u = v t                              force   m u'' + f = P
    spring     m u'' + c u' + f = k (v t - u)

u: forward displacement of the body beyond the oscillation of the motion; f: forward force of the
contact; all over mu F_z, u_lim and the time 1 / omega.  Here F_z is the load without oscillation.
"""

from __future__ import annotations

from dataclasses import dataclass

from microslip.foundation import spec


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
    """

    force: float
    mass: float = 0.0

    stiffness = 0.0
    damping = 0.0


@dataclass(frozen=True)
class Spring(Drive):
    """A spring whose far end has the velocity of the problem, and the body that it pulls.

    Parameters
    ----------
    stiffness : float
        Over mu F_z / u_lim, above 0.
    mass : float
        Over mu F_z / (u_lim omega^2).
    damping : float
        Of a dashpot beside the spring, over mu F_z / (u_lim omega).
    """

    stiffness: float
    mass: float = 0.0
    damping: float = 0.0

    force = None
