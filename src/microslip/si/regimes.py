"""Regimes of a drive: nearly constant velocity, nearly constant force, or oscillating velocity and
force.

A vibration makes the forward force oscillate, by up to mu F_z, at multiples n of a basic frequency.
The dynamic stiffness of the driven body is |k - m n^2 + i c n|, dimensionless.  The contact's
stiffness is 1.5.  If the body is ten times as stiff as the contact at all relevant n, the body's
velocity is nearly constant.  If only a small part of mu F_z is needed to make the body follow the
contact, the force is nearly constant.  A vibration along the drive reverses the force, so the
limits are ten times stricter.

The limits were tested with a few hundred random drives just inside these limits, at amplitudes from
0.3 to 10 and velocities from 0.01 to 3.  Friction differs by less than SAME from its value at
constant velocity, or with the softest and lightest drive.  For a soft drive along the vibration,
the limit is an estimate.  Here the force changes by the stiffness times the amplitude.
"""

from __future__ import annotations

import math

from microslip.motions.drive import Drive
from microslip.si.motions import kind_of

SAME = 0.01
"""Largest difference in mu_macro between two drives that count as equivalent."""
CONTACT_STIFFNESS = 1.5
"""Stiffness 2 G* a of a sticking Hertz contact, divided by mu F_z / u_lim."""
STIFFER = 10.0
"""Smallest stiffness of a body with a nearly constant velocity, divided by the stiffness of the
contact."""
LEAST_FORCE = 0.03
"""Largest change of a nearly constant force, divided by mu F_z."""
ALONG = 10.0
"""Factor by which both limits are stricter for a vibration along the drive."""
HARMONICS = 4
"""Number of multiples of the basic frequency that are checked."""
REGIMES = {
    "velocity": "stiff or heavy: the velocity is nearly constant",
    "force": "soft and light: the force is nearly constant",
    "between": "neither stiff nor soft: the body oscillates, and can resonate",
}
"""Descriptions of the regimes."""


def regime(motion: str, amplitude: float, drive: Drive) -> str:
    """The regime of a drive, a key of REGIMES.

    Parameters
    ----------
    motion : str
        A motion of microslip.predict that oscillates.
    amplitude : float
        Dimensionless amplitude.
    drive : drive.Drive
        Dimensionless stiffness, mass and damping.
    """
    first, further = (1, ALONG) if kind_of(motion).along_the_drive else (2, 1.0)
    swings = [n * first for n in range(1, HARMONICS + 1)]
    answers = [math.hypot(drive.stiffness - drive.mass * n * n, drive.damping * n) for n in swings]
    if min(answers) >= STIFFER * CONTACT_STIFFNESS * further:
        return "velocity"
    parts = (drive.stiffness, drive.mass * first * first, drive.damping * first)
    if max(parts) * max(amplitude, 1.0) <= LEAST_FORCE / further:
        return "force"
    return "between"


def natural_frequency(drive: Drive) -> float | None:
    """Natural frequency of the body on its spring and the sticking contact.

    It is relative to the frequency of the vibration.  It is None without a mass.
    """
    if drive.mass == 0.0:
        return None
    return math.sqrt((drive.stiffness + CONTACT_STIFFNESS) / drive.mass)
