"""A self-propelled motion: its pull from stall force to no-load velocity, and the power it takes.

Signs.  The sphere is what moves; its forward velocity v is held, as of a body so heavy that it does
not feel a single period.  Friction mu(v) is the mean forward force that it takes to move it, so
that the contact pulls its own body forward by the force -mu(v), against a load that pulls it back:

    force(v) = -mu(v)             power out = force v, the work on the load
    stall force = force(v -> 0)   the load that stops it
    no-load velocity: force = 0   as fast as it gets without a load

Power in is the mean work of the oscillation on the contact: of whatever moves the sphere to and fro
relative to its body.  An oscillating normal load adds nothing to it over a period.  Elastic energy
returns, and so

    power in - power out = dissipation >= 0.

Friction never falls with the velocity (theory/bounds.py), so that the line falls from stall to no
load, and two velocities at which the sign of friction is certain enclose the no-load velocity.
A motion may drive backward as well: then velocities and forces of the line are below 0.  Where
friction keeps a body at rest against a small force in either direction, the motion propels nothing.

A body without mass under a constant load is another case: it goes along with a forward oscillation,
and nothing drives (see under_force.without_forward_motion).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

import numpy as np

from microslip.adaptive.checks import checked_propulsion
from microslip.adaptive.friction import Plan, plan_for
from microslip.adaptive.request import TOLERANCE, Request, request_for
from microslip.adaptive.vibration_power import Answer, mean_speed
from microslip.estimate.refine import refine
from microslip.foundation.arguments import count
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.discretise import Resolution
from microslip.solver.run import Run

POINTS, MOST_POINTS = 9, 1000
FACTOR = 4.0
"""From one velocity to the next in search of one at which the contact resists."""
FASTEST = 1e6
MOST_HALVINGS = 60
WIDENING = 1.5
"""Steps away from the no-load velocity over the way in which friction rises by its error."""
MOST_WIDENINGS = 40
PROPELS_NOTHING = "propels nothing: friction holds a body at rest against forces from {} to {}"
"""The reason of a motion that propels nothing, with the lowest and the highest of these forces."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PropulsionLine:
    """Load and velocity of a self-propelled motion, from stall to no load.

    All values except the time are dimensionless.  Forces are divided by mu times the mean normal
    load, powers by mu times the mean normal load, u_lim and omega.  Velocities are in the unit of
    the motion's own velocity.  Every error estimate belongs to the field before it.

    Attributes
    ----------
    motion, pressure, model : str
        What moves, how the load is spread, and the contact model.
    amplitude, poisson, tolerance : float
        As asked for.
    stall_force, stall_force_error : float
        Load that stops the motion; 0 where it propels nothing, below 0 where it propels backward.
    no_load_velocity, no_load_velocity_error : float
        Velocity without a load, with the same sign.
    holding_force_low, holding_force_low_error : float or None
        Lowest of the forces against which friction holds a body at rest, below 0: a pull backward;
        None where the motion propels the contact.
    holding_force_high, holding_force_high_error : float or None
        Highest of these forces.
    velocity, force, force_error : np.ndarray, shape (points,)
        From 0 to the no-load velocity in equal parts, and the force that is pulled with there.  No
        points where nothing is driven.
    power_out, power_out_error : np.ndarray, shape (points,)
        force times velocity.
    power_in, power_in_error : np.ndarray, shape (points,)
        Mean work of the oscillation.
    efficiency, efficiency_error : np.ndarray, shape (points,)
        Power out over power in.
    converged : bool
        Whether the forces and powers are within the tolerance; of powers over the mean speed of the
        oscillation.
    reason : str
        Why not, or why nothing is driven; else empty.
    solve_time_s : float
        Seconds by the wall clock.
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
        """Fields as a plain dict, arrays as lists."""
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
    """The line from stall force to no-load velocity of a self-propelled motion.

    Parameters
    ----------
    motion : str
        A motion that may drive by itself: "elliptic:..." or "normal:forward=1,..." without the
        symmetry that keeps it from that.
    amplitude : float
        As for `microslip.solve`, above 0.
    pressure, poisson, model
        As for `microslip.solve`.
    tolerance : float
        Absolute, on every force; on powers times the mean speed of the oscillation.
    points : int
        On the line, its ends included.
    most_work : float or None
        As for `microslip.solve`, at every velocity that is looked at.
    time_limit : float or None
        Seconds by the wall clock after which the line is given up, looked at between marches; None:
        never.
    progress : callable or None
        As for `microslip.solve`.

    Returns
    -------
    PropulsionLine
        For signs and units see there and the docstring of this module.

    Raises
    ------
    InputError
        For bad input; it names the argument.
    """
    problem = checked_propulsion(motion, amplitude, pressure=pressure, poisson=poisson)
    points = count("points", points, 2, most=MOST_POINTS)
    if tolerance is None:
        raise InputError("tolerance", tolerance, "allowed is a number")
    request = request_for(
        problem, model, tolerance, most_work=most_work, time_limit=time_limit, progress=progress
    )
    return _line(_Contact(request), points)


class _Contact:
    """Friction and power of a motion at any velocity of at least 0; no run is done twice."""

    def __init__(self, request: Request):
        self.request, self.sign = request, 1
        self.done: dict[object, Any] = {}
        self.speed = mean_speed(request.problem)

    @property
    def drift(self) -> float:
        """Drift in a radian at the velocity 1."""
        problem = self.request.problem
        return problem.unit_drift

    @property
    def first(self) -> float:
        """Velocity as fast as the oscillation, where a search may begin."""
        return self.speed / self.drift

    def reversed(self) -> _Contact:
        """The mirror image, which moves forward where this one moves back."""
        problem = self.request.problem
        behind = replace(problem, backward=not problem.backward)
        image = _Contact(replace(self.request, problem=behind))
        image.sign = -self.sign
        return image

    def friction(self, velocity: float) -> Answer:
        return self._certified(velocity, "mu")

    def power(self, velocity: float) -> Answer:
        """Mean work of the oscillation: its error is that of a force times the mean speed."""
        found = self._certified(velocity, "power")
        return Answer(self.speed * found.value, self.speed * found.error, found.reason)

    def _certified(self, velocity: float, quantity: str) -> Answer:
        if (velocity, quantity) not in self.done:
            run, ladder, readings = self._plan(velocity)
            read: Callable[[Run], float] = attrgetter("mu")
            if quantity == "power":
                read = self._power_as_force
            found = refine(run, ladder, self.request.accuracy, readings, read)
            reason, estimate = found.reason, found.value
            if found.converged and estimate.error > self.request.accuracy:
                reason = f"the estimated error of its {quantity} is {estimate.error:.1e}"
            if reason:
                reason = f"velocity = {self.sign * velocity:g}: {reason}"
            self.done[velocity, quantity] = Answer(estimate.value, estimate.error, reason)
        return self.done[velocity, quantity]

    def _power_as_force(self, run: Run) -> float:
        return run.power / self.speed

    def _plan(self, velocity: float) -> Plan:
        if velocity not in self.done:
            there = replace(
                self.request,
                problem=replace(self.request.problem, velocity=velocity),
                budget=self.request.budget.renewed(),
            )
            plan = plan_for(there)
            readings = [_remembered(run) for run in plan.readings]
            self.done[velocity] = plan._replace(run=_remembered(plan.run), readings=readings)
        return self.done[velocity]


def _remembered(run: Callable[..., Run]) -> Callable[..., Run]:
    """A cache of `run` by resolution, so that two quantities share their runs."""
    done = {}

    def again(resolution: Resolution, guess: Run | None) -> Run:
        if resolution not in done:
            done[resolution] = run(resolution, guess)
        return done[resolution]

    return again


def _line(contact: _Contact, points: int) -> PropulsionLine:
    """The PropulsionLine of the motion, forward or back."""
    ahead = contact.friction(0.0)
    if ahead.value < 0.0 or not math.isfinite(ahead.value):
        return _moving(contact, points)
    behind = contact.reversed()
    back = behind.friction(0.0)
    if back.value < 0.0 or not math.isfinite(back.value):
        return _moving(behind, points)
    reason = ahead.reason or back.reason
    converged = not reason
    holding: dict[str, Any] = {
        "holding_force_low": -back.value + 0.0,
        "holding_force_low_error": back.error,
        "holding_force_high": ahead.value,
        "holding_force_high_error": ahead.error,
    }
    if converged:
        ends = number_text(-back.value, back.error), number_text(ahead.value, ahead.error)
        reason = PROPELS_NOTHING.format(*ends)
    stall_error = max(ahead.error - ahead.value, back.error - back.value, 0.0)
    uncertain = [c for c, k in ((contact, ahead), (behind, back)) if k.value < k.error]
    spread = max((no_load(one.friction, one.first).error for one in uncertain), default=0.0)
    found = Answer(0.0, spread, "")
    known = Answer(0.0, stall_error, "")
    line = _record(contact, known, found, np.zeros(0), (converged, reason))
    return replace(line, **holding)


def _moving(contact: _Contact, points: int) -> PropulsionLine:
    """The PropulsionLine of a motion that drives in its own forward direction."""
    stall, found = contact.friction(0.0), Answer(math.nan, math.inf, "")
    velocity = np.zeros(0)
    if math.isfinite(stall.value):
        found = no_load(contact.friction, contact.first)
    if math.isfinite(found.value):
        velocity = np.linspace(0.0, found.value, points)
    reason = stall.reason or found.reason
    return _record(contact, stall, found, velocity, (not reason, reason))


def _record(
    contact: _Contact, stall: Answer, found: Answer, velocity: np.ndarray, verdict: tuple[bool, str]
) -> PropulsionLine:
    request, sign = contact.request, contact.sign
    problem, (converged, reason) = request.problem, verdict
    friction = [contact.friction(v) for v in velocity]
    power = [contact.power(v) for v in velocity]
    force, error = (np.array([known[k] for known in friction]) for k in (0, 1))
    power_in, power_in_error = (np.array([known[k] for known in power]) for k in (0, 1))
    force, power_out = -force, -force * velocity * contact.drift
    power_out_error = error * velocity * contact.drift
    efficiency = power_out / power_in
    least = np.maximum(power_in - power_in_error, np.finfo(float).tiny)
    efficiency_error = (power_out_error + np.abs(efficiency) * power_in_error) / least
    reason = reason or next((known.reason for known in friction + power if known.reason), "")
    return PropulsionLine(
        motion=problem.motion.name,
        pressure=problem.pressure.name,
        model=request.model,
        amplitude=problem.size,
        poisson=problem.poisson,
        tolerance=request.accuracy,
        stall_force=sign * -stall.value + 0.0,
        stall_force_error=stall.error,
        no_load_velocity=sign * found.value,
        no_load_velocity_error=found.error,
        velocity=sign * velocity + 0.0,  # no zero has a sign
        force=sign * force,
        force_error=error,
        power_out=power_out,
        power_out_error=power_out_error,
        power_in=power_in,
        power_in_error=power_in_error,
        efficiency=efficiency,
        efficiency_error=efficiency_error,
        converged=converged and (not reason or not len(velocity)),
        reason=reason,
        solve_time_s=request.seconds,
    )


def no_load(friction: Callable, first: float) -> Answer:
    """The velocity at which friction vanishes, 0 where it is not negative at velocity 0.

    Parameters
    ----------
    friction : callable
        friction(velocity) -> a record with value, error and reason, for velocities of at least 0,
        where 0 stands for the limit.
    first : float
        Velocity above 0 to begin with.
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
    if above is None or below is None:
        return Answer(velocity, math.inf, "no velocity is known at which it resists for certain")
    return Answer(velocity, max(above - velocity, velocity - below), "")


def _root(
    friction: Callable, low: tuple[float, float], high: tuple[float, float]
) -> tuple[float, float, str]:
    """A velocity at which friction is 0 within its error, the slope there, and why there is none.

    low, high: velocity and friction on both sides.  Chords and halvings take turns.
    """
    for turn in range(MOST_HALVINGS):
        width, rise = high[0] - low[0], high[1] - low[1]
        slope = rise / width
        middle = low[0] - low[1] / slope if turn % 2 == 0 else 0.5 * (low[0] + high[0])
        found = friction(middle)
        if found.reason:
            return middle, slope, found.reason
        if abs(found.value) <= found.error:
            # by the slope to the side on which more is known of it
            return max(middle - found.value / slope, 0.5 * middle), slope, ""
        if found.value < 0.0:
            low = middle, found.value
        else:
            high = middle, found.value
    return middle, slope, ""


def _certain(friction: Callable, velocity: float, sign: float, slope: float) -> float | None:
    """The velocity next to another at which the sign of friction is certain; 0 below the lowest
    such one, None above the highest."""
    step = WIDENING * friction(velocity).error / slope
    if not math.isfinite(step):
        return 0.0 if sign < 0.0 else None
    for _ in range(MOST_WIDENINGS):
        place = velocity + sign * step
        if place <= 0.0:
            return 0.0
        found = friction(place)
        if sign * found.value > found.error:
            return place
        step *= 2.0
    return 0.0 if sign < 0.0 else None
