"""Interface of the models: a discretised contact that obeys Coulomb's law and is integrated in
time.

The unknowns of a Coulomb step are tractions q with |q| <= g.  The slip is s = b - A q, where A is
the influence operator and b is the displacement imposed by the rigid motion and the history.  Slip
occurs only where |q| = g, in the direction of q.  This condition is the optimality condition of a
convex problem, and is equivalent to the fixed point

    q = P_g(q + s / d) for any d > 0, where P_g is the projection onto the disc |q| <= g.

All quantities are dimensionless.

The time integration of a contact along a path is called a march.  For contacts on rings, the march
is compiled (see march.py).  The march in this module is written in Python and serves contacts whose
single steps take long to solve.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np

from microslip.contact.path import Path
from microslip.foundation.errors import SolverError


def project(q: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Project tractions, an array q of shape (2, ...), onto |q| <= bound.

    The bound is broadcast to the shape of q[0].
    """
    return q * np.minimum(1.0, bound / np.maximum(np.hypot(q[0], q[1]), 1e-300))


def coulomb_residual(
    q: np.ndarray, slip: np.ndarray, bound: np.ndarray, weight: np.ndarray, scale: np.ndarray
) -> float:
    """Compute the residual of Coulomb's law, Sum weight |P_g(q + slip/scale) - q|.

    The residual is a force divided by mu F_z.

    Parameters
    ----------
    q, slip : np.ndarray, shape (2, ...)
        Forward and lateral components of tractions and slip.
    bound, weight, scale : np.ndarray
        Friction bound, area of each point, and diagonal of the influence operator.  Each array
        broadcasts to the shape of q[0].
    """
    change = project(q + slip / scale, bound) - q
    return float(np.sum(weight * np.hypot(change[0], change[1])))


FORWARD, LATERAL, TORQUE = range(3)
"""Column indices of March.forces."""

MIRROR = np.array([1.0, -1.0])[:, None, None]
"""A reflection reverses the lateral direction.  The reflection multiplies the forward and the
lateral tractions by these factors.  The array has the shape (2, 1, 1)."""


class March(NamedTuple):
    """The result of the time integration of a contact along a path.

    Attributes
    ----------
    state : np.ndarray, shape (2, n_angles, n_radii) or (2, n, n)
        Forward and lateral tractions at the end of the path.
    forces : np.ndarray, shape (steps + 1, 3)
        Forward force, lateral force and torque at each phase.  Forces are divided by mu F_z, and
        the torque by mu F_z a.
    residual : float
        Sum over all stages of the residual force of the step solver, divided by mu F_z.
    iterations, solves : int
        Number of iterations of the step solver, and number of stages.
    fields : np.ndarray or None, shape (1 + steps stages, shape of state)
        Unknown of the step solver at the start and after every stage.  It can serve as the initial
        guess of a march along the same path from a similar state.
    body : np.ndarray, shape (steps + 1, 2)
        Displacement x of a driven body relative to the path, and the derivative x' with respect to
        the phase.  The array is empty for models that do not support drives.
    """

    state: np.ndarray
    forces: np.ndarray
    residual: float
    iterations: int
    solves: int
    fields: np.ndarray | None = None
    body: np.ndarray = np.empty((0, 2))


@dataclass(frozen=True)
class Body:
    """A driven body and its drive, in working units.

    Attributes
    ----------
    stiffness, damping, mass : float
        Stiffness k, damping c and mass m in units of mu F_z and u_lim, with the phase as time.  All
        three are 0 for a massless body driven by a constant force.
    load : float
        Constant force divided by mu F_z.
    """

    stiffness: float
    damping: float
    mass: float
    load: float

    @property
    def remembers(self) -> bool:
        """Whether x and x' are part of the state.  If x and x' are not part of the state, x is
        computed from the tractions."""
        return self.mass > 0.0 or self.damping > 0.0

    def along(self, path: Path, start: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        """Return the arguments `drive` and `lengths` of march.march for a path.

        start: values of x and x' at the start of the path, as an array of shape (2,); None for
        zeros.
        """
        share = 1.0 / (1.0 + path.carry[-1].sum())  # gamma: the last row of a_ij sums to 1
        place, rate = (0.0, 0.0) if start is None else start
        numbers = self.stiffness, self.damping, self.mass, self.load, place, rate
        return np.array(numbers, dtype=float), share * np.diff(path.phase)


class StepFailure(SolverError):
    """Raised if the tractions are not finite, or if a time step cannot be solved.

    The error message is stored as the reason in the result.
    """


class Contact(Protocol):
    """A discretised contact under a pressure.

    A contact whose normal load can change also has the methods `at_indentation` (see RingContact),
    `bounds` and `bounds_along`.

    Attributes
    ----------
    angles : int
        Number of angular points on a ring; 1 for contacts without angular points.
    bound, weight : np.ndarray
        Friction bound and area of each point; both arrays broadcast to the shape of state[0].
    compliance : np.ndarray
        Displacement of each point under a unit traction on the same point.  It broadcasts to the
        shape of state[0].
    forward_position, lateral_position : np.ndarray
        Coordinates of the points divided by a, as arrays with the shape of state[0].
    stiffness : float
        Force for a uniform displacement u_lim without slip, divided by mu F_z, or an upper bound on
        this ratio.
    sticks : bool
        Whether points can stick.  If no point can stick, the static limit of friction is 0.
    grading : float or None
        Grading of the time steps towards the turning points; None to use the grading of the
        problem.
    edges : np.ndarray or None, shape (cells + 1,)
        Radii of the edges of the rings; None for contacts without rings.
    radius : float
        Largest contact radius divided by the reference radius, if the normal load changes.  In this
        case, `bound` is the friction bound at the start of a period.
    """

    angles: int
    bound: np.ndarray
    weight: np.ndarray
    compliance: np.ndarray
    forward_position: np.ndarray
    lateral_position: np.ndarray
    stiffness: float
    sticks: bool
    grading: float | None = None
    edges: np.ndarray | None = None
    bounds: Any = None
    """bounds(depths) returns the friction bounds at an array of depths, with one row for each
    depth."""
    bounds_along: Any = None
    """bounds_along(path) returns the friction bounds at the start and at every stage of a path,
    with one row for each of these times."""

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Return the elastic displacement A q of each point under tractions q.

        The result is an array of the same shape as the state.
        """

    def energy(self, change: np.ndarray) -> float:
        """Return <q, A q>, which is twice the elastic energy of the tractions q."""
        return float(np.vdot(self.weight * change, self.displacement(change)))

    def prolong(self, state: np.ndarray) -> np.ndarray | None:
        """Interpolate tractions from a coarser mesh to the points of this contact.

        Returns None if the interpolation is not possible.
        """
        return None

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the mirror image of a state, in which the lateral direction is reversed and the
        lateral tractions are negated."""

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: March | None = None,
    ) -> March:
        """Integrate the contact along a path.

        Parameters
        ----------
        path : Path
            The motion, divided into time steps.
        state : np.ndarray
            Tractions at the start of the path.
        tolerance : float
            Largest allowed residual at each stage, as a force divided by mu F_z.
        previous : March or None
            Result of an earlier march along the same path from a similar state, which provides the
            initial guesses.
        """


def energy_norm(contact: Contact, change: np.ndarray) -> float:
    """Return an upper bound on the change of force due to a change of tractions, divided by mu F_z.

    The bound follows from the elastic energy: |dF| <= sqrt(stiffness <dq, A dq>).
    """
    return math.sqrt(contact.stiffness * max(contact.energy(change), 0.0))


def full_slip(contact: Contact, forward: np.ndarray, lateral: np.ndarray) -> np.ndarray:
    """Return tractions whose magnitude is the friction bound.  The tractions have the direction of
    the vector field (`forward`, `lateral`).

    The tractions are 0 where the field is 0.
    """
    size = np.hypot(forward, lateral)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = np.where(size > 0, np.stack([forward, lateral]) / size, 0.0)
    return unit * contact.bound


def rigid_displacement(contact: Contact, place: np.ndarray) -> np.ndarray:
    """Return the displacement of each point in a rigid motion, as an array of shape (2, ...).

    place: forward displacement, lateral displacement and angle.
    """
    forward, lateral, angle = place
    ahead = forward + angle * contact.lateral_position
    return np.stack([ahead, lateral - angle * contact.forward_position])


def forward_slip(contact: Contact) -> np.ndarray:
    """Return the state after forward sliding, in which the forward tractions equal the friction
    bound."""
    out = np.zeros((2, *contact.forward_position.shape))
    out[FORWARD] = contact.bound
    return out


def forces(contact: Contact, state: np.ndarray) -> np.ndarray:
    """Return the forces and the torque due to tractions, as an array of shape (3,).

    The components are the forward force, the lateral force and the torque.  The forces are divided
    by mu F_z.  The torque is divided by mu F_z a, where a is the unit of length.
    """
    forward, lateral = loads = contact.weight * state
    torque = np.vdot(contact.lateral_position, forward) - np.vdot(contact.forward_position, lateral)
    return np.array([*loads.sum(axis=(1, 2)), torque])


Step = tuple[np.ndarray, np.ndarray, int, float, float]
"""Result of a step: tractions, slip, number of iterations, residual as a force divided by mu F_z,
and displacement d of a driven body (0 without a body)."""


def march_by_steps(
    contact: Contact,
    solver: Any,
    path: Path,
    state: np.ndarray,
    previous: March | None = None,
    *,
    body: Body | None = None,
    start: np.ndarray | None = None,
) -> March:
    """Integrate a contact along a path, step by step.

    The `solver` has the method solve(b, guess), which returns a Step.  The argument b is the
    imposed displacement, and `guess` is an initial guess of the tractions.  If there is a driven
    body, the solver also has the method balance(b, guess, stiffness, load).  This method returns a
    Step that satisfies the equation stiffness * d + forward force = load, where d is the
    displacement of the body.  For the other arguments, see contact.Contact and RingContact.march.
    """
    stages, total, end = len(path.carry), len(path.motion) - 1, path.end
    guess = None if previous is None else previous.fields
    if guess is None or guess.shape != (1 + total, *state.shape):
        guess = None
    residual, iterations = 0.0, 0
    history, out = np.empty((1 + total, *state.shape)), np.empty((1 + path.steps, 3))
    moves, forward = np.zeros((1 + path.steps, 2)), np.zeros_like(state)
    forward[0] = 1.0
    slips, advances, gains = [state] * stages, np.zeros(stages), np.zeros(stages)
    at_end = history[0] = y = np.array(state, dtype=float)
    out[0] = forces(contact, state)
    if body is not None:
        drive, lengths = body.along(path, start)
        moves[0] = drive[4:]
        if not body.remembers:
            moves[0, 0] = (body.load - out[0, 0]) / body.stiffness if body.stiffness else 0.0
    rigid = rigid_displacement(contact, path.motion[0])
    z = contact.displacement(y) - rigid - moves[0, 0] * forward
    for at in range(1, 1 + total):
        k, s = divmod(at - 1, stages)
        rigid = rigid_displacement(contact, path.motion[at])
        b = z + rigid
        for j in range(s):
            b -= path.carry[s, j] * slips[j]
        if guess is not None:
            y = guess[1] if at == 1 else y + guess[at] - guess[at - 1]
        elif k > 1:
            y = 2.0 * history[at - stages] - history[at - 2 * stages]
        place = 0.0
        if body is None:
            step = solver.solve(b, y)
        else:
            place, rate = moves[k] + path.carry[s, :s] @ np.stack([advances, gains], 1)[:s]
            b += place * forward
            stiffness = body.stiffness + (body.damping + body.mass / lengths[k]) / lengths[k]
            load = body.load - body.stiffness * place + body.mass * rate / lengths[k]
            step = solver.balance(b, y, stiffness, load)
            gains[s] = step[4] / lengths[k] - rate
        y, slips[s], count, error, advances[s] = step
        history[at] = y
        iterations, residual = iterations + count, residual + error
        if s == stages - 1:
            b = b - slips[s] - rigid - place * forward
            if body is not None:
                moves[k + 1] = place + advances[s], advances[s] / lengths[k]
            z = b if end == 1.0 else z + (b - z) / end
            at_end = y if end == 1.0 else at_end + (y - at_end) / end
            out[k + 1] = forces(contact, at_end)
    return March(at_end, out, residual, iterations, total, history, moves)
