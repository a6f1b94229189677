"""Compiled Douglas-Rachford splitting that solves the Coulomb steps of a contact made of rings.

The unknowns of a step are tractions q with |q| <= g.  The slip b - A q occurs only where |q| = g,
in the direction of q.  A driven body adds one unknown, its displacement d, which is added to b, and
one equation, stiffness d + forward force = load.

The state of the iteration is a single field y.  With the projection P onto the discs |q| <= g and
the penalty s, one iteration is

    q = P(y),    t = 2 q - y,    v = (A + s)^-1 (b + s t),    y <- y + RELAXATION (v - q).

The iteration ends when the force Sum weight |v - q| is within the tolerance.  The slip is b - A v =
s (v - t), so A itself is never applied.  The iteration converges for any relaxation factor below 2
(Lions and Mercier 1979; Eckstein and Bertsekas 1992).  The response of v to the displacement d of a
driven body is d times a constant field, so the equation of the body is solved by a division.  After
every BETWEEN_BALANCES iterations, `rebalance` solves the equation of the body for the tractions
P(y).

A small penalty is best for points that stick, and a large penalty is best for points that slip.
Let D be the derivative of the projection, averaged over the points and both directions.  A point
that sticks contributes 1, and a point that slips contributes |q| / (2 |y|).  The best penalty is
about (1 - D) / D times the best penalty for D = 1/2.  Each step uses the nearest value in
PENALTIES.
"""

from __future__ import annotations

import numpy as np
from numba import types

from microslip.contact.operators import ZERO, four, multiply, multiply_two, shrink
from microslip.foundation.compiled import kernel

MOST_ITERATIONS = 4000
"""Largest number of iterations of a step."""
RELAXATION = 1.7
"""Relaxation factor.  Usual values are 1.5 to 1.8 (Eckstein and Bertsekas 1992)."""
BETWEEN_BALANCES = 32
"""Number of iterations between calls of `rebalance` in a step with a driven body.  The mean number
of iterations per step is lower in benchmarks/splitting.py.  Therefore, `rebalance` is rarely
called."""
FIRST_ADVANCE, LONGEST_ADVANCE, HALVINGS = 1e-3, 1e6, 40
"""Parameters of the search for the displacement at which the forces balance.  FIRST_ADVANCE,
LONGEST_ADVANCE: first and largest trial value, in u_lim.  Each trial value is four times the
previous one.  HALVINGS: number of bisections."""
BALANCED_RINGS = 12
"""If half of the points stick, the best penalty is sqrt(rings / BALANCED_RINGS) times the
self-influence of a ring.  The splitting converges fastest if the penalty is the geometric mean of
the smallest and the largest eigenvalue of A.  The smallest eigenvalue belongs to a narrow ring, and
the largest eigenvalue belongs to the whole contact.  The ratio of the two eigenvalues is
proportional to the number of rings.  The value is calibrated by benchmarks/splitting.py."""
LEVELS = 4
"""Number of penalties for which a resolvent is computed."""
PENALTIES = 2.0 ** (np.arange(LEVELS) - 0.5 * (LEVELS - 1))
"""Possible penalties of a step.  The penalties range from 1/sqrt(8) to sqrt(8) times the penalty
that is best if half of the points stick."""
BETWEEN_LOOKS = 2e5
"""Approximate number of point updates between two calls of `interrupted`.  These updates take a few
hundredths of a second.  A call waits for the other threads of the interpreter, so calls should be
rare."""

_acquire = types.ExternalFunction("PyGILState_Ensure", types.intc())
_release = types.ExternalFunction("PyGILState_Release", types.void(types.intc))
_occurred = types.ExternalFunction("PyOS_InterruptOccurred", types.intc())


@kernel
def interrupted() -> bool:
    """Return whether Ctrl-C was pressed since the last call. Outside the main thread, the result is
    always false.

    Python handles signals only between its own instructions, and a time integration in compiled
    code can take minutes.  After an interrupt, the time integration ends early, and the calling
    Python code raises the signal again.
    """
    state = _acquire()
    occurred = _occurred()
    _release(state)
    return occurred != 0


@kernel
def forward_force(weight: np.ndarray, q: np.ndarray) -> float:
    """Return the forward force due to tractions."""
    force = 0.0
    for i in range(len(weight)):
        force += weight[i] * q[0, i]
    return force


@kernel
def respond(
    operators: tuple,
    weight: np.ndarray,
    unit: np.ndarray,
    waves: np.ndarray,
    response: np.ndarray,
    slope: np.ndarray,
) -> None:
    """For each penalty, compute the tractions v for d = 1, and the forward force that these
    tractions exert.

    `unit` is a scratch field.
    """
    for i in range(unit.shape[1]):
        unit[0, i], unit[1, i] = 1.0, 0.0
    for level in range(len(slope)):
        multiply(operators, 1 + level, unit, response[level], waves)
        slope[level] = forward_force(weight, response[level])


@kernel
def squared_distance(weight: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """Return Sum weight |a - b|^2 for two fields a and b.

    The number of points must be a multiple of four.
    """
    total = ZERO
    for at in range(0, len(weight), 4):
        w, p, q, r, s = (
            four(weight, at),
            four(a[0], at),
            four(b[0], at),
            four(a[1], at),
            four(b[1], at),
        )
        total = (
            total[0] + w[0] * ((p[0] - q[0]) ** 2 + (r[0] - s[0]) ** 2),
            total[1] + w[1] * ((p[1] - q[1]) ** 2 + (r[1] - s[1]) ** 2),
            total[2] + w[2] * ((p[2] - q[2]) ** 2 + (r[2] - s[2]) ** 2),
            total[3] + w[3] * ((p[3] - q[3]) ** 2 + (r[3] - s[3]) ** 2),
        )
    return (total[0] + total[1]) + (total[2] + total[3])


@kernel
def stuck_share(y: np.ndarray, bound: np.ndarray, q: np.ndarray, factors: np.ndarray) -> float:
    """Set q to P(y).  Returns D (see the docstring of the module) times the number of points with a
    bound above 0.

    `factors` is a scratch array.
    """
    for i in range(len(bound)):
        f = shrink(y[0, i], y[1, i], bound[i])
        q[0, i], q[1, i], factors[i] = f * y[0, i], f * y[1, i], f
    share = 0.0
    for i in range(len(bound)):
        share += factors[i] if factors[i] == 1.0 else 0.5 * factors[i]
    return share


@kernel
def imbalance(
    points: tuple,
    bound: np.ndarray,
    y: np.ndarray,
    excess: float,
    stiffness: float,
    advance: float,
) -> float:
    """Return the residual of the body's equation if the body is displaced further by `advance`.

    The advance is added to the slip of the points that slip.  For an advance of 0, `excess` is the
    part of the residual that does not include the forward force.
    """
    weight, penalty, _, _, _ = points
    force = excess + stiffness * advance
    for i in range(len(bound)):
        forward = y[0, i] + advance / penalty[i]
        force += weight[i] * shrink(forward, y[1, i], bound[i]) * forward
    return force


@kernel
def rebalance(
    points: tuple,
    bound: np.ndarray,
    y: np.ndarray,
    excess: float,
    stiffness: float,
    tolerance: float,
) -> None:
    """Shift y, in place, to the displacement at which the forces on the body balance.

    The splitting alone converges slowly if nearly all points slip and the drive is soft.  The shift
    is at most LONGEST_ADVANCE.  If a larger shift would be needed, y remains unchanged.
    """
    residual = imbalance(points, bound, y, excess, stiffness, 0.0)
    if not abs(residual) > tolerance:
        return
    near, far = 0.0, np.copysign(FIRST_ADVANCE, -residual)
    while residual * imbalance(points, bound, y, excess, stiffness, far) > 0.0:
        near, far = far, 4.0 * far
        if abs(far) > LONGEST_ADVANCE:
            return
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if residual * imbalance(points, bound, y, excess, stiffness, middle) > 0.0:
            near = middle
        else:
            far = middle
    for i in range(len(bound)):
        y[0, i] += near / points[1][i]


@kernel(inline="always")
def solve_step(operators: tuple, points: tuple, step: tuple, body: tuple, scratch: tuple) -> tuple:
    """Solve a Coulomb step.

    Parameters
    ----------
    operators : tuple
        See operators.multiply.  The operators are A and the resolvents for PENALTIES.
    points : tuple
        Area of each point, of shape (points,); penalty of each point if half of the points stick,
        of shape (points,); sum of the areas; number of points with an area above 0; positions,
        which are not used here.
    step : tuple
        Imposed displacement b for d = 0, of shape (2, points); friction bound, of shape (points,);
        largest allowed residual, as a force divided by mu F_z.
    body : tuple
        Whether there is a driven body; stiffness and load in the equation of the body; results of
        `respond`.
    scratch : tuple
        Four arrays.  The first has the shape (5 or more, 2, points) and contains the unknown y,
        which is the initial guess on entry and refers to the penalty in `points` on entry and on
        return; the tractions; and three scratch fields.  The second is the slip, of shape (2,
        points), which is an output.  The third is the scratch array of operators.multiply.  The
        fourth, of shape (1,), is the number of point updates since the last check for an interrupt.

    Returns
    -------
    iterations : int
        Number of iterations; -1 after an interrupt.
    residual, displacement : float
        Residual force, and displacement d of the body.
    """
    weight, penalty, area, count, _ = points
    b, bound, tolerance = step
    driven, stiffness, load, response, slope = body
    work, slip, waves, clock = scratch
    rings, matrices = operators[0].shape[1] == 1, operators[2]
    guess, q, y, right, v = work[0], work[1], work[2], work[3], work[4]
    size, accepted = len(bound), tolerance * tolerance / area
    iterations, residual, displacement = 0, np.inf, 0.0
    while True:
        stuck = stuck_share(guess, bound, q, right[0])
        level, ratio = 0, 0.5  # the available penalty nearest to (1 - D) / D
        while level < LEVELS - 1 and count - stuck > ratio * stuck:
            level, ratio = level + 1, 2.0 * ratio
        factor = PENALTIES[level]
        for c in range(2):
            for i in range(size):
                y[c, i] = q[c, i] + (guess[c, i] - q[c, i]) / factor
                right[c, i] = b[c, i] + factor * penalty[i] * (2.0 * q[c, i] - y[c, i])
        while True:
            if rings:  # without a call of multiply, which would take a tenth of the time
                multiply_two(matrices[1 + level, 0], right, v)
            else:
                multiply(operators, 1 + level, right, v, waves)
            if driven:
                displacement = (load - forward_force(weight, v)) / (stiffness + slope[level])
                for c in range(2):
                    for i in range(size):
                        v[c, i] += displacement * response[level, c, i]
            iterations += 1
            residual = squared_distance(weight, v, q)  # bounds the force (Schwarz's inequality)
            solved = not residual > accepted or iterations >= MOST_ITERATIONS
            if solved or (driven and iterations % BETWEEN_BALANCES == 0):
                break
            for i in range(size):
                forward = y[0, i] + RELAXATION * (v[0, i] - q[0, i])
                lateral = y[1, i] + RELAXATION * (v[1, i] - q[1, i])
                f = shrink(forward, lateral, bound[i])
                y[0, i], y[1, i] = forward, lateral
                q[0, i], q[1, i] = f * forward, f * lateral
                f = (2.0 * f - 1.0) * factor * penalty[i]
                right[0, i], right[1, i] = b[0, i] + f * forward, b[1, i] + f * lateral
            clock[0] += size
            if clock[0] > BETWEEN_LOOKS:
                clock[0] = 0.0
                if interrupted():
                    return -1, residual, displacement
        for c in range(2):
            for i in range(size):
                slip[c, i] = b[c, i] - right[c, i] + factor * penalty[i] * v[c, i]
                guess[c, i] = q[c, i] + factor * (y[c, i] - q[c, i])
        if solved:
            return iterations, np.sqrt(area * residual), displacement
        excess = stiffness * displacement - load
        rebalance(points, bound, guess, excess, stiffness, tolerance)
