"""A body that a force or a spring drives forward, in compiled code: one unknown more, one equation.

Let x be how far the contact is ahead of its path.  A body of mass m on a dashpot c, driven by a
spring k whose far end follows the path, or by a force P, obeys

    m x'' + c x' + k x + f = load,    f: forward force of the contact,

in working units, primes for derivatives by the phase.  The integrator of the contact serves the
body, too: with the increment d = g x' of a stage (g: its implicit part) every stage leaves

    stiffness d + f(q) = load,    stiffness = k + c / g + m / g^2,

next to the Coulomb step.  As f does not fall with d, the two have one solution.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel


class Drive(NamedTuple):
    """The equation of a driven body.

    Attributes
    ----------
    stiffness, damping, mass : float
        k, c and m.
    load : float
        Constant force, over mu F_z.
    lengths : np.ndarray, shape (steps,)
        g of every step, in radians.
    start : np.ndarray, shape (2,)
        x and x' at the start; ignored without mass and dashpot.
    """

    stiffness: float
    damping: float
    mass: float
    load: float
    lengths: np.ndarray
    start: np.ndarray


@kernel
def starting_place(drive: Drive, force: float) -> float:
    """x at the start, where the contact carries `force`."""
    if drive.mass > 0.0 or drive.damping > 0.0:
        return drive.start[0]
    return (drive.load - force) / drive.stiffness if drive.stiffness > 0.0 else 0.0


@kernel
def stage_balance(drive: Drive, step: int, place: float, rate: float) -> tuple[float, float]:
    """Stiffness and load of the body in a stage; place, rate: x and x' from earlier stages."""
    length = drive.lengths[step]
    stiffness = drive.stiffness + (drive.damping + drive.mass / length) / length
    return stiffness, drive.load - drive.stiffness * place + drive.mass * rate / length
