"""What pulls the contact forward: a velocity, as in the paper, a force, or a spring with a body.

    velocity   u = v t                              force   m u'' + f = P
    spring     m u'' + c u' + f = k (v t - u)

u: forward displacement of the body beyond the oscillation of the motion; f: forward force of the
contact; all over mu F_z, u_lim and the time 1 / omega.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Drive:
    """A drive other than a velocity.

    Attributes
    ----------
    force : float or None
        P, over mu times the mean normal load; None: a spring pulls.
    stiffness : float
        k, over mu F_z / u_lim; 0 under a force.
    mass, damping : float
        m and c, over mu F_z / (u_lim omega^2) and mu F_z / (u_lim omega).
    """

    force: float | None = None
    stiffness: float = 0.0
    mass: float = 0.0
    damping: float = 0.0
