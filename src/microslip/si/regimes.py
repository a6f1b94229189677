"""Whether what pulls a contact keeps its velocity, keeps its force, or swings with the vibration.

A vibration makes the forward force swing, by up to mu F_z, with a basic frequency and its multiples
n.  The body that is pulled answers with the stiffness |k - m n^2 + i c n|, in working units, where
that of the contact is 1.5.  Where it is ten times as stiff as the contact at all n that count, the
body hardly moves; where the force that it takes to go along is small against mu F_z, the force
hardly changes.  An oscillation along the direction of the pull swings the force all the way, and
takes ten times more.

Measured on some hundred random drives just within these limits, at amplitudes of 0.3 to 10 and
velocities of 0.01 to 3: friction is within SAME of that at a constant velocity, or of that of the
softest and lightest drive.  That a soft drive along the vibration is as good as a force is an
estimate: the force changes by the stiffness times the amplitude.
"""

from __future__ import annotations

import math

from microslip.motions.drive import Drive
from microslip.si.motions import is_along_the_drive

SAME = 0.01
"""Difference of mu_macro below which two drives are equivalent."""
CONTACT_STIFFNESS = 1.5
"""Stiffness of a sticking Hertz contact, 2 G* a over mu F_z / u_lim."""
STIFFER = 10.0
"""Than the contact: how stiff a body hardly moves."""
LEAST_FORCE = 0.03
"""Over mu F_z: a force that changes by this hardly changes."""
ALONG = 10.0
"""How much further both are where the vibration is along the direction of the pull."""
HARMONICS = 4
"""Multiples of the basic frequency that count."""
REGIMES = {
    "velocity": "stiff or heavy: the velocity is as good as constant",
    "force": "soft and light: the force is as good as constant",
    "between": "neither stiff nor soft: it swings with the vibration, and may resonate",
}
"""Descriptions of the regimes."""


def regime(motion: str, amplitude: float, drive: Drive) -> str:
    """A key of REGIMES.

    Parameters
    ----------
    motion : str
        As for microslip.predict, not a steady one.
    amplitude : float
        In the group of the motion.
    drive : drive.Drive
        With stiffness, mass and damping in working units.
    """
    first, further = (1, ALONG) if is_along_the_drive(motion) else (2, 1.0)
    swings = [n * first for n in range(1, HARMONICS + 1)]
    answers = [math.hypot(drive.stiffness - drive.mass * n * n, drive.damping * n) for n in swings]
    if min(answers) >= STIFFER * CONTACT_STIFFNESS * further:
        return "velocity"
    parts = (drive.stiffness, drive.mass * first * first, drive.damping * first)
    if max(parts) * max(amplitude, 1.0) <= LEAST_FORCE / further:
        return "force"
    return "between"


def natural_frequency(drive: Drive) -> float | None:
    """Natural frequency of the body on its spring and the sticking contact, over the frequency of
    the vibration; None without a mass."""
    if drive.mass == 0.0:
        return None
    return math.sqrt((drive.stiffness + CONTACT_STIFFNESS) / drive.mass)
