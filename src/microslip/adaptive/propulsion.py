"""Self-propelled motions: force between stall and the no-load velocity, power and efficiency.

The sphere moves forward at a prescribed velocity v, like a body too heavy for its velocity to
change during a period.  The friction mu(v) is the mean forward force needed to move the sphere.  So
the contact exerts the force -mu(v) on its own body, and a load pulls the body back:

    force(v) = -mu(v)             power out = force v, the work on the load
    stall force = force(v -> 0)   the load that stops it
    no-load velocity: force = 0   the highest velocity, reached without a load

The power in is the mean power of the oscillation on the contact.  It is supplied by the actuator
between the sphere and its body.  An oscillating normal load does no work over a period.  Elastic
energy is recovered, so

    power in - power out = dissipation >= 0.

Friction never decreases with the velocity (theory/bounds.py).  So the force decreases from stall to
the no-load velocity, and two velocities at which friction has opposite signs bracket the no-load
velocity.  A motion can also propel the body backward.  In this case, the velocities and forces are
negative.  If friction holds the body at rest against small forces in both directions, the motion
propels nothing.

A body without mass under a constant load is not propelled: it follows the forward oscillation (see
under_force.without_forward_motion).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from microslip.adaptive.checks import checked_propulsion
from microslip.adaptive.friction import levels_for
from microslip.adaptive.request import TOLERANCE, Request, request_for
from microslip.estimate.refine import Levels, refine
from microslip.foundation.arguments import count
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.run import Run

POINTS, MOST_POINTS = 9, 1000
FACTOR = 4.0
"""Factor between successive velocities in the search for positive friction."""
FASTEST = 1e6
MOST_HALVINGS = 60
WIDENING = 1.5
"""Factor in the first step away from the no-load velocity.  The step is this factor times the error
of the friction, divided by the slope of the friction."""
MOST_WIDENINGS = 40
PROPELS_NOTHING = "propels nothing: friction holds a body at rest against forces from {} to {}"
"""Value of `reason` for a motion that propels nothing.  The placeholders are the lowest and the
highest force."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PropulsionLine:
    """Load and velocity of a self-propelled motion between stall and no load.

    All values except the time are dimensionless.  Forces are divided by mu times the mean normal
    load; powers are also divided by u_lim omega.  Velocities are in the same unit as the velocity
    of the motion.  The field `x_error` is the error estimate of the field `x`.

    Attributes
    ----------
    motion, pressure, model : str
        Names of the motion, the pressure distribution and the contact model.
    amplitude, poisson, tolerance : float
        Arguments of the request.
    stall_force, stall_force_error : float
        Load that stops the motion.  It is 0 if the motion propels nothing, and negative if it
        propels the body backward.
    no_load_velocity, no_load_velocity_error : float
        Velocity without a load, with the sign of the stall force.
    holding_force_low, holding_force_low_error : float or None
        Lowest force against which friction holds the body at rest.  It is negative, that is, it
        acts backward.  None if the motion propels the body.
    holding_force_high, holding_force_high_error : float or None
        Highest force against which friction holds the body at rest.  None if the motion propels the
        body.
    velocity, force, force_error : np.ndarray, shape (points,)
        Equidistant velocities from 0 to the no-load velocity, and the force at each velocity.  The
        arrays are empty if the motion propels nothing.
    power_out, power_out_error : np.ndarray, shape (points,)
        Mean power delivered to the load: force times velocity.
    power_in, power_in_error : np.ndarray, shape (points,)
        Mean power of the oscillation.
    efficiency, efficiency_error : np.ndarray, shape (points,)
        Power out divided by power in.
    converged : bool
        Whether all errors are within the tolerance.  The errors of powers are divided by the mean
        speed of the oscillation for this comparison.
    reason : str
        Reason why the result is not converged or why the motion propels nothing, otherwise empty.
    solve_time_s : float
        Wall-clock time in seconds.
    """

    motion: str
    pressure: str
    model: str
    amplitude: float
    poisson: float
    tolerance: float
    stall_force: float
    stall_force_error: float
    no_load_velocity: float
    no_load_velocity_error: float
    holding_force_low: float | None = None
    holding_force_low_error: float | None = None
    holding_force_high: float | None = None
    holding_force_high_error: float | None = None
    velocity: np.ndarray
    force: np.ndarray
    force_error: np.ndarray
    power_out: np.ndarray
    power_out_error: np.ndarray
    power_in: np.ndarray
    power_in_error: np.ndarray
    efficiency: np.ndarray
    efficiency_error: np.ndarray
    converged: bool
    reason: str
    solve_time_s: float

    def to_dict(self) -> dict:
        """The fields as a dict, with arrays as lists."""
        fields = dict(vars(self))
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in fields.items()}


def propulsion(
    motion: str | Motion | Problem,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    model: str = "auto",
    tolerance: float = TOLERANCE,
    points: int = POINTS,
    most_work: float | None = None,
    time_limit: float | None = None,
    progress: Callable | None = None,
) -> PropulsionLine:
    """Compute force, power and efficiency of a self-propelled motion between stall and no load.

    Parameters
    ----------
    motion : str
        A motion that can propel the contact: "elliptic:..." or "normal:forward=1,...", if no
        symmetry makes the mean force vanish.
    amplitude : float
        Amplitude as in `microslip.solve`, above 0.
    pressure, poisson, model
        See `microslip.solve`.
    tolerance : float
        Absolute tolerance of every force.  The tolerance of powers is this value times the mean
        speed of the oscillation.
    points : int
        Number of velocities, including both ends.
    most_work : float or None
        Limit on the work at each velocity, see `microslip.solve`.
    time_limit : float or None
        Limit on the wall-clock time in seconds, checked between marches.  None means no limit.
    progress : callable or None
        See `microslip.solve`.

    Returns
    -------
    PropulsionLine
        Force, power and efficiency at each velocity.  The docstring of this module defines the
        signs.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names the argument.
    """
    problem = checked_propulsion(motion, amplitude, pressure=pressure, poisson=poisson)
    points = count("points", points, 2, most=MOST_POINTS)
    if tolerance is None:
        raise InputError("tolerance", tolerance, "allowed is a number")
    request = request_for(
        problem, model, tolerance, most_work=most_work, time_limit=time_limit, progress=progress
    )
    return _line(_Contact(request), points)


class Answer(NamedTuple):
    """A quantity with its error estimate.

    Attributes
    ----------
    value, error : float
        The quantity and its estimated error.
    reason : str
        Reason why the error exceeds the tolerance, otherwise empty.
    """

    value: float
    error: float
    reason: str = ""


class _Contact:
    """Friction and power of a motion at velocities of at least 0.  No run is repeated.

    Attributes
    ----------
    sign : int
        1 for the forward direction of the request, -1 for the opposite direction.
    speed : float
        Mean speed of the oscillation.
    drift : float
        Forward displacement per radian of phase at the velocity 1, in u_lim.
    first : float
        Velocity equal to the mean speed of the oscillation, at which a search starts.
    friction, power : callable
        Functions of the velocity that return an Answer: the friction, and the mean power of the
        oscillation.
    """

    def __init__(self, request: Request, sign: int = 1):
        self.request, self.sign = request, sign
        self.speed, self.drift = request.problem.mean_speed, request.problem.unit_drift
        self.first = self.speed / self.drift
        self._levels = cache(self._levels_at)
        self.friction, self.power = cache(self._friction_at), cache(self._power_at)

    def reversed(self) -> _Contact:
        """The contact with the forward direction reversed."""
        problem = self.request.problem
        behind = replace(problem, backward=not problem.backward)
        return _Contact(replace(self.request, problem=behind), -self.sign)

    def _friction_at(self, velocity: float) -> Answer:
        return self._refined(velocity, "mu", attrgetter("mu"))

    def _power_at(self, velocity: float) -> Answer:
        load = 2.0 * math.pi * self.request.problem.mean_load

        def power_as_force(run: Run) -> float:
            """Dissipated power minus drive power, divided by the mean speed."""
            return (run.energy / load - run.mu * velocity * self.drift) / self.speed

        force = self._refined(velocity, "power", power_as_force)
        return Answer(self.speed * force.value, self.speed * force.error, force.reason)

    def _refined(self, velocity: float, quantity: str, read: Callable[[Run], float]) -> Answer:
        refined = refine(self._levels(velocity), self.request.accuracy, read)
        reason, estimate = refined.reason, refined.value
        if refined.converged and estimate.error > self.request.accuracy:
            reason = f"the estimated error of its {quantity} is {estimate.error:.1e}"
        if reason:
            reason = f"velocity = {self.sign * velocity:g}: {reason}"
        return Answer(estimate.value, estimate.error, reason)

    def _levels_at(self, velocity: float) -> Levels:
        problem = replace(self.request.problem, velocity=velocity)
        budget = self.request.budget.renewed()
        return levels_for(replace(self.request, problem=problem, budget=budget))


def _line(contact: _Contact, points: int) -> PropulsionLine:
    """The PropulsionLine of a motion that propels forward, backward, or not at all."""
    ahead = contact.friction(0.0)
    if ahead.value < 0.0 or not math.isfinite(ahead.value):
        return _moving(contact, points)
    behind = contact.reversed()
    back = behind.friction(0.0)
    if back.value < 0.0 or not math.isfinite(back.value):
        return _moving(behind, points)
    stall_error = max(ahead.error - ahead.value, back.error - back.value, 0.0)
    uncertain = [c for c, k in ((contact, ahead), (behind, back)) if k.value < k.error]
    spread = max((no_load(one.friction, one.first).error for one in uncertain), default=0.0)
    stall = Answer(0.0, stall_error, ahead.reason or back.reason)
    line = _record(contact, stall, Answer(0.0, spread), np.zeros(0))
    if line.converged:
        ends = number_text(-back.value, back.error), number_text(ahead.value, ahead.error)
        line = replace(line, reason=PROPELS_NOTHING.format(*ends))
    return replace(
        line,
        holding_force_low=-back.value + 0.0,
        holding_force_low_error=back.error,
        holding_force_high=ahead.value,
        holding_force_high_error=ahead.error,
    )


def _moving(contact: _Contact, points: int) -> PropulsionLine:
    """The PropulsionLine of a motion that propels forward."""
    stall, fastest = contact.friction(0.0), Answer(math.nan, math.inf)
    velocity = np.zeros(0)
    if math.isfinite(stall.value):
        fastest = no_load(contact.friction, contact.first)
    if math.isfinite(fastest.value):
        velocity = np.linspace(0.0, fastest.value, points)
    return _record(contact, stall, fastest, velocity)


def _record(
    contact: _Contact, stall: Answer, fastest: Answer, velocity: np.ndarray
) -> PropulsionLine:
    """The PropulsionLine at these velocities.

    stall, fastest: friction at velocity 0, and no-load velocity.
    """
    request, sign = contact.request, contact.sign
    problem = request.problem
    friction = [contact.friction(v) for v in velocity]
    power = [contact.power(v) for v in velocity]
    force, error = (np.array([one[k] for one in friction]) for k in (0, 1))
    power_in, power_in_error = (np.array([one[k] for one in power]) for k in (0, 1))
    force, power_out = -force, -force * velocity * contact.drift
    power_out_error = error * velocity * contact.drift
    efficiency = power_out / power_in
    least = np.maximum(power_in - power_in_error, np.finfo(float).tiny)
    efficiency_error = (power_out_error + np.abs(efficiency) * power_in_error) / least
    reason = next((one.reason for one in (stall, fastest, *friction, *power) if one.reason), "")
    return PropulsionLine(
        motion=problem.motion.name,
        pressure=problem.pressure.name,
        model=request.model,
        amplitude=problem.size,
        poisson=problem.poisson,
        tolerance=request.accuracy,
        stall_force=sign * -stall.value + 0.0,
        stall_force_error=stall.error,
        no_load_velocity=sign * fastest.value,
        no_load_velocity_error=fastest.error,
        velocity=sign * velocity + 0.0,  # turns -0.0 into 0.0
        force=sign * force,
        force_error=error,
        power_out=power_out,
        power_out_error=power_out_error,
        power_in=power_in,
        power_in_error=power_in_error,
        efficiency=efficiency,
        efficiency_error=efficiency_error,
        converged=not reason,
        reason=reason,
        solve_time_s=request.seconds,
    )


def no_load(friction: Callable, first: float) -> Answer:
    """Find the velocity at which friction vanishes, or 0 if friction at velocity 0 is not negative.

    Parameters
    ----------
    friction : callable
        `friction(velocity)` returns an Answer for velocities of at least 0; the velocity 0 means
        the static limit.
    first : float
        First velocity to try; must be above 0.
    """
    still = friction(0.0)
    high = first
    while not (resists := friction(high)).value > 0.0:
        high *= FACTOR
        if resists.reason or high > FASTEST:
            return Answer(math.nan, math.inf, resists.reason or "drives at any velocity")
    velocity, slope = 0.0, (resists.value - still.value) / high
    if still.value < 0.0:
        velocity, slope, reason = _root(friction, (0.0, still.value), (high, resists.value))
        if reason:
            return Answer(math.nan, math.inf, reason)
    below = _certain(friction, velocity, -1.0, slope)
    above = _certain(friction, velocity, 1.0, slope)
    reason = "" if math.isfinite(above) else "no velocity was found at which it certainly resists"
    return Answer(velocity, max(above - velocity, velocity - below), reason)


def _root(
    friction: Callable, low: tuple[float, float], high: tuple[float, float]
) -> tuple[float, float, str]:
    """Find a velocity at which friction is 0 within its error, by secant steps and bisections.

    `low` and `high` are pairs (velocity, friction) on either side of the root.  Returns the
    velocity, the slope of the friction, and a reason for failure.
    """
    for turn in range(MOST_HALVINGS):
        width, rise = high[0] - low[0], high[1] - low[1]
        slope = rise / width
        middle = low[0] - low[1] / slope if turn % 2 == 0 else 0.5 * (low[0] + high[0])
        answer = friction(middle)
        if answer.reason:
            return middle, slope, answer.reason
        if abs(answer.value) <= answer.error:
            # one more secant step
            return max(middle - answer.value / slope, 0.5 * middle), slope, ""
        if answer.value < 0.0:
            low = middle, answer.value
        else:
            high = middle, answer.value
    return middle, slope, ""


def _certain(friction: Callable, velocity: float, sign: float, slope: float) -> float:
    """Find a velocity near `velocity` at which friction certainly has the sign `sign`.

    For a negative sign, the search lowers the velocity and returns 0 if it fails.  For a positive
    sign, it raises the velocity and returns infinity if it fails.
    """
    farthest = 0.0 if sign < 0.0 else math.inf
    step = WIDENING * friction(velocity).error / slope
    if not math.isfinite(step):
        return farthest
    for _ in range(MOST_WIDENINGS):
        place = velocity + sign * step
        if place <= 0.0:
            break
        answer = friction(place)
        if sign * answer.value > answer.error:
            return place
        step *= 2.0
    return farthest
