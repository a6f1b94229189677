"""Power needed to vibrate a contact: mean work of the oscillation, with an error estimate.

The forward drive does the work mu_macro v in addition.  Elastic energy is returned, so that
friction dissipates the sum of both.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.moved import marched
from microslip.adaptive.request import TOLERANCE, request_for
from microslip.estimate.refine import refine
from microslip.foundation.errors import InputError
from microslip.motions.motion import LOOP, Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.run import Run


class VibrationPower(NamedTuple):
    """Mean work of an oscillation on the contact.

    Attributes
    ----------
    value, error : float
        Work in a radian of phase over mu times the mean normal load and u_lim, and the largest
        error that it may have, by estimate.
    reason : str
        Why that is not within the tolerance, else empty.
    """

    value: float
    error: float
    reason: str


def vibration_power(
    motion: str | Motion | Problem,
    velocity: float | None = None,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    tolerance: float = TOLERANCE,
) -> VibrationPower:
    """Mean work that an oscillation does on the contact.

    Parameters
    ----------
    motion, velocity, amplitude, pressure, poisson
        As for `microslip.solve`: a motion that oscillates, velocity and amplitude above 0.
    tolerance : float
        Accepted error, over the mean speed of the oscillation.

    Returns
    -------
    VibrationPower
        In working units.

    Raises
    ------
    InputError
        For bad input; it names the argument.
    """
    problem = checked_problem(motion, velocity, amplitude, pressure=pressure, poisson=poisson)
    for name, value in (("velocity", problem.velocity), ("amplitude", problem.amplitude)):
        if not value:
            raise InputError(name, value, "allowed is a number above 0, for work to be done")
    request, speed = request_for(problem, "auto", tolerance), mean_speed(problem)
    plan = marched(request)
    readings = [power_as_force(one, speed) for one in plan.readings]
    found = refine(power_as_force(plan.run, speed), plan.ladder, request.accuracy, readings)
    reason, power = found.reason, speed * found.value
    if found.converged and found.value.error > request.accuracy:
        reason = f"the estimated error of the power is {power.error:.1e}"
    return VibrationPower(power.value, power.error, reason)


def mean_speed(problem: Problem) -> float:
    """Mean speed of the oscillation: distance in a radian of phase, in u_lim."""
    moves = np.diff(np.stack(problem.oscillation(LOOP)), axis=1)
    return float(np.sqrt(np.sum(moves**2, axis=0)).sum()) / (2.0 * np.pi)


def power_as_force(run: Callable[..., Run], speed: float) -> Callable[..., Run]:
    """Runs whose friction is replaced by the power divided by the speed, to refine the power."""

    def of_resolution(*resolution: Any) -> Run:
        found = run(*resolution)
        return replace(found, mu=found.power / speed)

    return of_resolution
