"""Equation of motion of a body driven by a force or a spring, for compiled code.

Let x be the displacement of the contact relative to its path.  A body of mass m with a dashpot c,
driven by a constant force or a spring k, obeys

    m x'' + c x' + k x + f = load,    f: forward force of the contact,

in working units, where primes are derivatives with respect to the phase.  The far end of the spring
follows the path.  The contact's integrator also integrates the motion of the body.  Let d = g x' be
the increment of x in a stage, where g is the implicit part of the stage.  Then each stage adds the
equation

    stiffness d + f(q) = load,    stiffness = k + c / g + m / g^2,

to the Coulomb step.  The solution is unique, because f never decreases as d increases.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel


class Drive(NamedTuple):
    """The equation of motion of a driven body.

    Attributes
    ----------
    stiffness, damping, mass : float
        k, c and m.
    load : float
        Constant force divided by mu F_z.
    lengths : np.ndarray, shape (steps,)
        g of each step, in radians.
    start : np.ndarray, shape (2,)
        x and x' at the start of the path.  They are ignored if both mass and damping are 0.
    """

    stiffness: float
    damping: float
    mass: float
    load: float
    lengths: np.ndarray
    start: np.ndarray


@kernel
def starting_place(drive: Drive, force: float) -> float:
    """Return x at the start of the path if the forward force of the contact is `force`."""
    if drive.mass > 0.0 or drive.damping > 0.0:
        return drive.start[0]
    return (drive.load - force) / drive.stiffness if drive.stiffness > 0.0 else 0.0


@kernel
def stage_balance(drive: Drive, step: int, place: float, rate: float) -> tuple[float, float]:
    """Return the stiffness and the load in the equation of a stage.

    place, rate: parts of x and x' that follow from the start of the step and earlier stages.
    """
    length = drive.lengths[step]
    stiffness = drive.stiffness + (drive.damping + drive.mass / length) / length
    return stiffness, drive.load - drive.stiffness * place + drive.mass * rate / length
