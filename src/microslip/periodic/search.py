"""Search for the periodic state of a contact.

A march is the time integration over a period or half a period.  A march maps the state at the start
to the state at the end.  The periodic state is the fixed point of this map.  The transients of
plain marches last about 1/(2 pi v~) periods.  Anderson acceleration finds the fixed point of the
map much sooner.  Convergence is judged by three quantities: the residual of the plain map (without
acceleration), the distance to the next state, and an error computed from the residual and the drift
rate of the motion.  The last quantity is needed near the static limit, where the state changes so
slowly that a small residual is no evidence of convergence.

The state of a driven body includes two more numbers: the position x and the rate x' of the body
(see contact/march.py).  In one period, unbalanced forces hardly change the state of a heavy body or
of a body on a soft spring.  To match the stiffness of the contact, the map scales up the changes of
x and x'.  The scaling has the same effect as a stiffer spring and a lighter body.  This scaling
does not change the fixed point of the map.  A contact in full slip is much more compliant than a
sticking contact.  For a contact in full slip, the stiffness is the rise of the mean force with the
displacement.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, cast

import numpy as np

from microslip.contact.contact import Body, Contact, March, StepFailure, energy_norm, project
from microslip.contact.path import Path
from microslip.contact.ring_contact import RingContact
from microslip.periodic.anderson import DEPTH, accelerated, remember
from microslip.periodic.run import Budget, Effort

MOST_MARCHES = 200
"""Default limit on the number of marches in a search."""
FORCING = 1e-3
"""Tolerance of the steps in a march, divided by the last change of the state."""
LOOSEST, LOOSEST_NEAR = 1e-4, 1e-5
"""Largest tolerance of a step.  The first value applies if the initial state is far from the
periodic state.  The second value applies if the initial state is near the periodic state."""
NOISE = 1e-2
"""Largest accepted residual of a march, as a fraction of the force that the drift adds in this
march.  The rate at which an error of the state decays is at most the rate at which the state
drifts."""
DRIFTING, MOST_RETURNS = 0.5, 3
"""DRIFTING: in a march, the drift adds a certain force.  A state below the static limit is stuck if
its residual exceeds this fraction of the added force.  Such a state drifts without slip, so its
change does not measure the distance to the periodic state.  The search then goes halfway back to
the last state that was not stuck.  MOST_RETURNS: largest number of times that the search goes
halfway back in succession."""
FORGETFUL = 0.2
"""The plain map is not accelerated if its contraction factor is below this value."""
CAUTION = 0.3
"""Largest ratio of the effective stiffness of a soft spring to that of the contact.  With a larger
ratio, the search would overshoot."""
AT_REST = np.zeros(2)
"""Position x and rate x' of a contact without a driven body."""


class Goal(NamedTuple):
    """Goal of a search for the periodic state.

    Attributes
    ----------
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, as forces divided by mu F_z.
    most_marches : int
        Largest number of marches.
    near : bool
        Whether the initial state is near the periodic state.  In this case, the first steps are
        solved more accurately.
    """

    tolerance: float
    step_tolerance: float
    most_marches: int = MOST_MARCHES
    near: bool = False


@dataclass(frozen=True, eq=False)
class PeriodicState:
    """Result of a search for the periodic state.

    Attributes
    ----------
    march : March
        March over the last (half) period.
    start : np.ndarray
        Tractions at the beginning of this (half) period.
    residual : float
        Upper bound on the change of the state by the plain map, as a force divided by mu F_z.
    distance : float
        Estimated distance from the fixed point, as a force divided by mu F_z.
    marches : int
        Number of marches.
    iterations : int
        Number of iterations of the step solver, summed over all marches.
    converged : bool
        Whether the distance is within the tolerance.
    """

    march: March
    start: np.ndarray
    residual: float
    distance: float
    marches: int
    iterations: int
    converged: bool

    @property
    def effort(self) -> Effort:
        """Effort of all marches."""
        return Effort.of(self.marches * self.march.solves, self.iterations, self.start.size)


@dataclass(frozen=True)
class DriftRate:
    """Data for the error estimate of slow motions, whose states change little in a period.

    Let r be the force by which the plain map still changes the state.  The velocity of the state
    then has a relative error of r / `gain`.  Only the difference between the force and the static
    limit depends on the velocity.  Therefore, the error of the force is at most r / `gain` times
    the difference between the force and the static limit.

    Attributes
    ----------
    static_force : float
        Mean forward force of the static limit, divided by mu F_z; NaN if unknown.
    full : float
        Mean forward force in full slip, the largest possible force.
    gain : float
        Rise of the force in a (half) period for a contact without slip.
    least : float
        Mean forward force below which a state sticks and changes slowly.  It approximately equals
        the static limit.  NaN means that `static_force` is used.
    """

    static_force: float = 0.0
    full: float = 0.0
    gain: float = np.inf
    least: float = np.nan

    def error(self, force: float, change: float) -> float:
        """Return the error of a mean force.  `change` is the change of the state by the plain
        map."""
        excess = abs(force - self.static_force)
        if math.isnan(excess):  # the limit can be any force from 0 to full slip
            excess = max(abs(force), abs(self.full - force))
        return excess * change / self.gain


NOT_SLOW = DriftRate()


class PeriodMap:
    """Map from the state of a contact at the start of a path to its state at the end.

    A state is the array of the tractions.  With a driven body, a state is one row with all
    tractions, followed by x and x'.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    path : path.Path
        Path over half a period, from turning point to turning point.  Without `mirror`, the path
        covers a whole period.
    drift_rate : DriftRate
        Data for slow motions; by default, the motion is not slow.
    mirror : bool
        Whether the other half of the period is the lateral mirror image of the path.
    body : contact.Body or None
        The driven body and its drive; None if the contact follows the path.
    slope : float
        Largest rise of the mean forward force if the body advances by one unit of x per interval.
    budget : run.Budget or None
        Budget of the marches.  None means unlimited.
    """

    def __init__(
        self,
        contact: Contact,
        path: Path,
        drift_rate: DriftRate = NOT_SLOW,
        mirror: bool = True,
        body: Body | None = None,
        slope: float = np.inf,
        *,
        budget: Budget | None = None,
    ):
        self.contact, self.path, self.drift_rate, self.mirror = contact, path, drift_rate, mirror
        self.shape, self.body = (2, *contact.forward_position.shape), body
        self.budget = budget or Budget()
        self.metric = np.full(self.shape, np.sqrt(contact.weight * contact.compliance)).ravel()
        if body is not None:
            self._scale_body(body, slope)
            self.metric = np.append(self.metric, np.sqrt(self.weights))

    def _scale_body(self, body: Body, slope: float) -> None:
        contact, self.factors = self.contact, np.ones(2)
        bound = np.broadcast_to(contact.bound, self.shape[1:])
        load = float(np.sum(contact.weight * bound))
        # without contact at the start of a period there are no tractions to correct
        self.spread = bound / load if load > 0.0 else 0.0 * bound
        interval, stiffness = self.path.phase[-1] - self.path.phase[0], contact.stiffness
        mass = min(body.mass, stiffness * interval**2)
        slow = max(1.0, body.damping / (stiffness * interval))
        if body.stiffness > 0.0:
            self.factors[0] = max(1.0, min(CAUTION * stiffness, slope) / body.stiffness * slow)
        if body.mass > 0.0:
            self.factors[1] = max(1.0, body.mass / (mass * slow))
        self.weights = np.array([body.stiffness * min(1.0, body.stiffness / stiffness), mass])

    def tractions(self, state: np.ndarray) -> np.ndarray:
        """Return the tractions of a state."""
        return state if self.body is None else state[:-2].reshape(self.shape)

    def march(self, state: np.ndarray, tolerance: float, previous: March | None) -> March:
        """March along the path. The argument `previous` is a march from a similar state."""
        place, contact = (self.path, self.tractions(state), tolerance, previous), self.contact
        if self.body is None:
            march = contact.march(*place)
        else:  # RingContact, or another contact that supports drives
            march = cast(RingContact, contact).march(*place, body=self.body, start=state[-2:])
        self.budget.take(Effort.of(march.solves, march.iterations, march.state.size))
        return march

    def image(self, tractions: np.ndarray) -> np.ndarray:
        """Convert the tractions at the end of an interval to the tractions at the start of the next
        interval.

        This conversion is linear.
        """
        return self.contact.mirrored(tractions) if self.mirror else tractions

    def step(self, state: np.ndarray, march: March) -> tuple[np.ndarray, np.ndarray]:
        """Return the state at the start of the next interval, and the change of the state.

        The changes of x and x' are scaled up.
        """
        tractions, body, moved = self.image(march.state), self.body, AT_REST
        if body is None:
            return tractions, tractions - state
        if body.remembers:
            moved = self.factors * (march.body[-1] - march.body[0])
        elif self.factors[0] > 1.0:
            # computed from the motion of the body, which is more accurate than the forces of the
            # steps
            advance = self.factors[0] * (march.body[-1, 0] - march.body[0, 0])
            force = march.forces[0, 0] - body.stiffness * advance
            tractions = tractions.copy()
            tractions[0] += (force - march.forces[-1, 0]) * self.spread
        image = np.append(tractions, state[-2:] + moved)
        change = image - state
        change[-2:] = moved  # without a rounding error
        return image, change

    def norm(self, change: np.ndarray) -> float:
        """Return an upper bound on the change of the force that results from a change of the
        state."""
        tractions, body = self.tractions(change), self.body
        force, held = energy_norm(self.contact, tractions), 0.0
        if body is None:
            return force
        if body.remembers:
            held = float(self.weights @ change[-2:] ** 2)
        elif body.stiffness > 0.0:
            advance = float(np.sum(self.contact.weight * tractions[0])) / body.stiffness
            held = self.weights[0] * advance**2
        return float(np.sqrt(force**2 + self.contact.stiffness * held)) if held else force


def find_periodic_state(
    period_map: PeriodMap, start: np.ndarray, goal: Goal, place: np.ndarray = AT_REST
) -> PeriodicState:
    """Repeat marches over a (half) period until the state is periodic to within the tolerance.

    Parameters
    ----------
    period_map : PeriodMap
        The map over a (half) period.
    start : np.ndarray
        Initial tractions.
    goal : Goal
        Tolerances and largest number of marches.
    place : np.ndarray, shape (2,)
        Initial x and x' of a driven body.

    Returns
    -------
    PeriodicState
        The result of the search.  `converged` is False if the search failed.

    Raises
    ------
    StepFailure
        If the tractions diverge.
    """
    contact, path, rate = period_map.contact, period_map.path, period_map.drift_rate
    loosest, tightest = LOOSEST_NEAR if goal.near else LOOSEST, goal.step_tolerance
    inner = max(tightest, min(loosest, NOISE * rate.gain / (len(path.motion) - 1)))
    driven = period_map.body is not None
    state = above = np.append(start, place) if driven else start
    pairs, count = np.empty((2, DEPTH + 1, *state.shape)), 0
    rows = pairs.reshape(2, DEPTH + 1, -1)
    last, forgets, returns, iterations = np.inf, True, 0, 0
    sticking = rate.static_force if math.isnan(rate.least) else rate.least
    march = None
    best: tuple[float, March, np.ndarray, float] | None = None
    for marches in range(1, goal.most_marches + 1):
        march = period_map.march(state, inner, march)
        iterations += march.iterations
        image, change = period_map.step(state, march)
        residual = period_map.norm(change)
        if not math.isfinite(residual):
            raise StepFailure("diverged: tractions are not finite")
        solved = inner <= tightest
        inner = max(tightest, min(FORCING * residual, inner))
        forgets, last = forgets and residual <= FORGETFUL * last, residual
        mean = float(path.mean(march.forces[:, 0]))
        stuck = marches > 1 and mean < sticking and residual > DRIFTING * rate.gain
        back = stuck and not driven and returns < MOST_RETURNS
        returns = returns + 1 if back else returns if stuck else 0
        above = above if stuck else state
        if back:  # halfway
            count, following = 0, 0.5 * (state + above)
        else:
            count, following = remember(pairs, count, image, change), image
            if not forgets:
                following = np.empty(image.shape)
                accelerated(rows, count, period_map.metric, following.ravel())
        if path.end == 1.0:
            tractions = project(period_map.tractions(following), contact.bound)
            following = np.append(tractions, following[-2:]) if driven else tractions
        distance, gained = max(period_map.norm(following - state), residual), residual
        if driven:  # by the plain map, without scaled changes
            advance = abs(march.body[-1, 0] - march.body[0, 0])
            gained = energy_norm(contact, period_map.tractions(change))
            gained = float(advance * contact.stiffness + gained)
        distance = max(distance, rate.error(mean, gained))
        near_enough = distance <= goal.tolerance
        converged = solved and near_enough
        if near_enough:  # solve the steps of the next march to the final tolerance
            inner = tightest
        if converged or best is None or distance < best[0]:
            best = distance, march, state, residual
        if converged:
            break
        state = following
    assert best is not None  # there is at least one march
    distance, march, state, residual = best
    start = period_map.tractions(state)
    return PeriodicState(march, start, residual, distance, marches, iterations, converged)
