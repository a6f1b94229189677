"""Power needed to vibrate a contact: mean power of the oscillation, with an error estimate.

The forward drive adds the power mu_macro v.  Elastic energy is recovered, so that friction
dissipates the sum of the power of the oscillation and the power of the drive.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.friction import plan_for
from microslip.adaptive.request import TOLERANCE, request_for
from microslip.estimate.refine import refine
from microslip.foundation.errors import InputError
from microslip.motions.motion import LOOP, Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure


class Answer(NamedTuple):
    """A quantity with its error estimate.

    Attributes
    ----------
    value, error : float
        The quantity and its estimated error.
    reason : str
        Reason why the error exceeds the tolerance; empty if it does not.
    """

    value: float
    error: float
    reason: str = ""


def vibration_power(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    tolerance: float = TOLERANCE,
) -> Answer:
    """Compute the mean power of the oscillation on the contact.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson
        See `microslip.solve`; the motion oscillates, velocity and amplitude are above 0.
    tolerance : float
        Largest accepted error, divided by the mean speed of the oscillation.

    Returns
    -------
    Answer
        Work per radian of phase, divided by mu times the mean normal load and by u_lim.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    """
    problem = checked_problem(motion, velocity, amplitude, pressure=pressure, poisson=poisson)
    for name, value in (("velocity", problem.velocity), ("amplitude", problem.amplitude)):
        if not value:
            raise InputError(name, value, "allowed is a number above 0, for work to be done")
    if tolerance is None:
        raise InputError("tolerance", tolerance, "allowed is a number")
    request, speed = request_for(problem, "auto", tolerance), mean_speed(problem)
    run, ladder, readings = plan_for(request)
    refined = refine(run, ladder, request.accuracy, readings, lambda one: one.power / speed)
    reason, power = refined.reason, speed * refined.value
    if refined.converged and refined.value.error > request.accuracy:
        reason = f"the estimated error of the power is {power.error:.1e}"
    return Answer(power.value, power.error, reason)


def mean_speed(problem: Problem) -> float:
    """Mean speed of the oscillation, as the path length per radian of phase, in u_lim."""
    moves = np.diff(np.stack(problem.oscillation(LOOP)), axis=1)
    return float(np.sqrt(np.sum(moves**2, axis=0)).sum()) / (2.0 * np.pi)
