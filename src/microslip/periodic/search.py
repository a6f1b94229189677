"""Search for the periodic state of a contact.

A march is the time integration over a period or half a period.  A march maps the state at the start
to the state at the end.  The periodic state is the fixed point of this map.  The transients of
plain marches last about 1/(2 pi v~) periods.  Anderson acceleration (Walker and Ni 2011) finds the
fixed point of the map much sooner.  Convergence is judged by three quantities: the residual of the
plain map (without acceleration), the distance to the next state, and an error computed from the
residual and the drift rate of the motion.  The error is needed near the static limit.  There, the
state changes so slowly that a small residual is no evidence of convergence.

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
from operator import sub
from typing import NamedTuple

import numpy as np

from microslip.contact.contact import Body, Contact, March, StepFailure, energy_norm, project
from microslip.contact.path import Path
from microslip.foundation.compiled import kernel
from microslip.periodic.run import Budget, Effort

MOST_MARCHES = 200
"""Default limit on the number of marches in a search."""
FORCING = 1e-3
"""Tolerance of the steps in a march, divided by the last change of the state."""
LOOSEST, LOOSEST_NEAR = 1e-4, 1e-5
"""Largest tolerance of a step.  The first value applies if the initial state is far from the
periodic state.  The second value applies if the initial state is near the periodic state."""
NOISE = 1e-2
"""The drift adds a force in each march.  This value is the largest accepted residual of a march, as
a fraction of this force.  The rate at which an error of the state decays is at most the rate at
which the state drifts."""
DRIFTING, MOST_RETURNS = 0.5, 3
"""DRIFTING: a fraction of the force that the drift adds in a march.  A state below the static limit
is stuck if the residual of the state exceeds this fraction.  Such a state drifts without slip, so
the change of the state does not measure the distance to the periodic state.  The search then goes
halfway back to the last state that was not stuck.  MOST_RETURNS: largest number of times that the
search goes halfway back in succession."""
FORGETFUL = 0.2
"""The plain map is not accelerated if its contraction factor is below this value."""
CAUTION = 0.3
"""Largest ratio of the effective stiffness of a soft spring to that of the contact.  With a larger
ratio, the search would overshoot."""
DEPTH = 12
"""Number of stored differences.  Among the values 5, 8 and 12, this one needs the fewest marches
for bores and loops."""
DEPENDENT = 1e-8
"""Each difference is split into a linear combination of newer differences and an orthogonal part.
The difference is dropped if the norm of the orthogonal part is below this fraction of the full
norm.  The value is about the square root of the rounding error."""
AT_REST = np.zeros(2)
"""Position x and rate x' of a contact without a driven body."""


class Goal(NamedTuple):
    """Goal of a search for the periodic state, and known properties of the drift.

    Slow motions change the state little in a period.  Let r be the remaining change of the state in
    the plain map, expressed as a force.  The relative error of the velocity of the state is then r
    / `gain`.  Only the difference between the force and the static limit depends on the velocity.
    Therefore, the error of the force is at most r / `gain` times the difference between the force
    and the static limit.

    Attributes
    ----------
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, as forces divided by mu F_z.
    most_marches : int
        Largest number of marches.
    near : bool
        Whether the initial state is near the periodic state.  In this case, the first steps are
        solved more accurately.
    static_force : float
        Mean forward force of the static limit, divided by mu F_z; NaN if unknown.
    full : float
        Mean forward force in full slip, the largest possible force.
    gain : float
        Rise of the force in a (half) period for a contact without slip; infinite if the motion is
        not slow.
    least : float
        Mean forward force below which a state sticks and changes slowly.  It approximately equals
        the static limit.  NaN means that `static_force` is used.
    """

    tolerance: float
    step_tolerance: float
    most_marches: int = MOST_MARCHES
    near: bool = False
    static_force: float = 0.0
    full: float = 0.0
    gain: float = np.inf
    least: float = np.nan

    def drift_error(self, force: float, change: float) -> float:
        """Return the error of a mean force.  `change` is the change of the state by the plain
        map."""
        excess = abs(force - self.static_force)
        if math.isnan(excess):  # the limit can be any force from 0 to full slip
            excess = max(abs(force), abs(self.full - force))
        return excess * change / self.gain


class PeriodicState(NamedTuple):
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
    effort : Effort
        Effort of all marches.
    converged : bool
        Whether the distance is within the tolerance.
    """

    march: March
    start: np.ndarray
    residual: float
    distance: float
    marches: int
    effort: Effort
    converged: bool


@kernel
def accelerated(pairs: np.ndarray, count: int, scale: np.ndarray) -> np.ndarray:
    """Return the combination of the stored images that has the smallest change.

    The least-squares problem is solved by modified Gram-Schmidt, starting with the newest
    difference.  `pairs` contains pairs of an image and a change.  The newest pair is the last one.
    The least-squares norm is the norm of the changes times `scale`.  Both `scale` and the result
    have the shape (n,).
    """
    images, changes = pairs[0], pairs[1]
    last, n = count - 1, len(scale)
    out = np.empty(n)
    basis, triangle = np.empty((count, n)), np.zeros((count, count))
    projection, source, residual = np.zeros(count), np.zeros(count, np.int64), np.empty(n)
    for i in range(n):
        out[i] = images[last, i]
        residual[i] = changes[last, i] * scale[i]
    size = 0
    for j in range(last - 1, -1, -1):
        column, whole = basis[size], 0.0
        for i in range(n):
            column[i] = (changes[j + 1, i] - changes[j, i]) * scale[i]
            whole += column[i] ** 2
        for k in range(size):
            share = 0.0
            for i in range(n):
                share += basis[k, i] * column[i]
            triangle[k, size] = share
            for i in range(n):
                column[i] -= share * basis[k, i]
        rest = 0.0
        for i in range(n):
            rest += column[i] ** 2
        if not rest > DEPENDENT**2 * whole:
            continue
        length, share = np.sqrt(rest), 0.0
        for i in range(n):
            column[i] /= length
            share += column[i] * residual[i]
        for i in range(n):
            residual[i] -= share * column[i]
        triangle[size, size], projection[size], source[size] = length, share, j
        size += 1
    for k in range(size - 1, -1, -1):
        factor = projection[k]
        for p in range(k + 1, size):
            factor -= triangle[k, p] * projection[p]
        projection[k] = factor / triangle[k, k]
    for k in range(size):
        j, factor = source[k], projection[k]
        for i in range(n):
            out[i] -= factor * (images[j + 1, i] - images[j, i])
    return out


def matched(
    contact: Contact, path: Path, body: Body, slope: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Match a driven body to the stiffness of the contact; see the docstring of this module.

    Returns three arrays.  The first array contains the factors by which the map scales up the
    changes of x and x'. The second array contains the weights of the squares of these changes in
    the energy of a change of the state.  The third array contains tractions that exert the unit
    force.  For the arguments, see find_periodic_state.
    """
    bound = np.broadcast_to(contact.bound, contact.forward_position.shape)
    load = float(np.sum(contact.weight * bound))
    # without contact at the start of a period there are no tractions to correct
    unit = bound / load if load > 0.0 else 0.0 * bound
    interval, stiffness = path.phase[-1] - path.phase[0], contact.stiffness
    mass = min(body.mass, stiffness * interval**2)
    slow, factors = max(1.0, body.damping / (stiffness * interval)), np.ones(2)
    if body.stiffness > 0.0:
        factors[0] = max(1.0, min(CAUTION * stiffness, slope) / body.stiffness * slow)
    if body.mass > 0.0:
        factors[1] = max(1.0, body.mass / (mass * slow))
    return factors, np.array([body.stiffness * min(1.0, body.stiffness / stiffness), mass]), unit


def find_periodic_state(
    contact: Contact,
    path: Path,
    start: np.ndarray,
    goal: Goal,
    *,
    mirror: bool = True,
    budget: Budget | None = None,
    body: Body | None = None,
    place: np.ndarray = AT_REST,
    slope: float = np.inf,
) -> PeriodicState:
    """Repeat marches over a (half) period until the state is periodic to within the tolerance.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    path : path.Path
        Path over half a period, from turning point to turning point.  Without `mirror`, the path
        covers a whole period.
    start : np.ndarray
        Initial tractions.
    goal : Goal
        Tolerances, largest number of marches, and data for slow motions.
    mirror : bool
        Whether the other half of the period is the lateral mirror image of the path.
    budget : run.Budget or None
        Budget of the marches.  None means unlimited.
    body : contact.Body or None
        The driven body and its drive; None if the contact follows the path.
    place : np.ndarray, shape (2,)
        Initial x and x' of a driven body.
    slope : float
        Largest rise of the mean forward force if the body advances by one unit of x per interval.

    Returns
    -------
    PeriodicState
        The result of the search.  `converged` is False if the search failed.

    Raises
    ------
    StepFailure
        If the tractions diverge.
    """
    remembers, soft = body is not None and body.remembers, 0.0
    factors, weights, drive = np.ones(2), np.zeros(2), {}
    if body is not None:
        factors, weights, unit = matched(contact, path, body, slope)
        # the displacement in a spring that is no part of the state follows from the tractions
        soft = 0.0 if remembers else body.stiffness
    compliance = np.broadcast_to(contact.weight * contact.compliance, start.shape)
    scale = np.sqrt(np.append(compliance, weights))

    def norm(change: np.ndarray, moved: np.ndarray) -> float:
        """Return an upper bound on the change of the force due to a change of the state."""
        energy = max(contact.energy(change), 0.0)
        if soft:
            moved = np.array([np.sum(contact.weight * change[0]) / soft, 0.0])
        if body is not None:
            energy += float(weights @ moved**2)
        return math.sqrt(contact.stiffness * energy)

    loosest, tightest = LOOSEST_NEAR if goal.near else LOOSEST, goal.step_tolerance
    inner = max(tightest, min(loosest, NOISE * goal.gain / (len(path.motion) - 1)))
    sticking = goal.static_force if math.isnan(goal.least) else goal.least
    # the last states by the plain map, and the changes of the state, newest last
    pairs, count = np.empty((2, DEPTH + 1, len(scale))), 0
    state = above = start
    last, forgets, returns = math.inf, True, 0
    budget = budget or Budget()
    before = budget.taken
    march, best = None, None
    for marches in range(1, goal.most_marches + 1):
        if body is not None:  # RingContact, or another contact that supports drives
            drive = {"body": body, "start": place}
        march = contact.march(path, state, inner, march, **drive)
        budget.take(march.solves, march.iterations, state.size)
        image = contact.mirrored(march.state) if mirror else march.state
        moved = factors * (march.body[-1] - march.body[0]) if remembers else AT_REST
        if soft and factors[0] > 1.0:
            # computed from the motion of the body, which is more accurate than the forces of the
            # steps
            advance = factors[0] * (march.body[-1, 0] - march.body[0, 0])
            image = image.copy()
            image[0] += (march.forces[0, 0] - soft * advance - march.forces[-1, 0]) * unit
        change = image - state
        residual = norm(change, moved)
        if not math.isfinite(residual):
            raise StepFailure("diverged: tractions are not finite")
        solved = inner <= tightest
        inner = max(tightest, min(FORCING * residual, inner))
        forgets, last = forgets and residual <= FORGETFUL * last, residual
        mean = float(path.weights @ march.forces[:, 0])
        stuck = marches > 1 and mean < sticking and residual > DRIFTING * goal.gain
        back = stuck and body is None and returns < MOST_RETURNS
        returns = returns + 1 if back else returns if stuck else 0
        above = above if stuck else state
        following, there = image, place + moved
        if back:  # halfway
            count, following, there = 0, 0.5 * (state + above), place
        else:
            if count == len(pairs[0]):
                pairs[:, :-1] = pairs[:, 1:]
                count -= 1
            pairs[0, count, :-2], pairs[0, count, -2:] = image.ravel(), there
            pairs[1, count, :-2], pairs[1, count, -2:] = change.ravel(), moved
            count += 1
            if not forgets:
                combined = accelerated(pairs, count, scale)
                following, there = combined[:-2].reshape(state.shape), combined[-2:]
        if path.end == 1.0:
            following = project(following, contact.bound)
        distance, gained = max(norm(following - state, there - place), residual), residual
        if body is not None:  # by the plain map, without scaled changes
            advance = abs(march.body[-1, 0] - march.body[0, 0])
            gained = float(advance * contact.stiffness + energy_norm(contact, change))
        distance = max(distance, goal.drift_error(mean, gained))
        near_enough = distance <= goal.tolerance
        converged = solved and near_enough
        if near_enough:  # solve the steps of the next march to the final tolerance
            inner = tightest
        if converged or best is None or distance < best[0]:
            best = distance, march, state, residual
        if converged:
            break
        state, place = following, there
    assert best is not None  # there is at least one march
    distance, march, state, residual = best
    effort = Effort(*map(sub, budget.taken, before))
    return PeriodicState(march, state, residual, distance, marches, effort, converged)
