"""A contact with a dense influence matrix and a replaceable step solver.

The step solver is a compiled function

    solve(points: Points, stage: Stage, settings) -> (iterations, residual)

where `settings` is the return value of `prepare(matrix, scale, **parameters)`.  The residual is
defined by coulomb.coulomb_residual.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from microslip.contact.contact import (
    Contact,
    Guess,
    March,
    StepFailure,
    forces,
    rigid_displacement,
)
from microslip.contact.coulomb import coulomb_residual, shrink
from microslip.contact.path import Path
from microslip.foundation.compiled import kernel

FAR_FROM_SOLVED = 1e-2
"""Residual of a step, divided by mu F_z, above which the solver is considered diverged."""
MAX_DESCENTS = 3000
"""Largest number of gradient steps in `descend`."""


class Points(NamedTuple):
    """Data on the K points of a contact, for compiled code.

    Attributes
    ----------
    matrix : np.ndarray, shape (2 K, 2 K)
        Influence matrix A, forward components first.
    scale : np.ndarray, shape (K,)
        Diagonal of A for the forward components.
    bound, weight : np.ndarray, shape (K,)
        Friction bound and area of each point.
    """

    matrix: np.ndarray
    scale: np.ndarray
    bound: np.ndarray
    weight: np.ndarray


class Stage(NamedTuple):
    """Data on one stage, for compiled code.

    Attributes
    ----------
    b : np.ndarray, shape (2, K)
        Imposed displacement.
    q : np.ndarray, shape (2, K)
        Tractions.  The initial guess is overwritten with the solution.
    slip : np.ndarray, shape (2, K)
        Slip b - A q, written by the solver.
    tolerance : float
        Largest accepted residual, as a force divided by mu F_z.
    """

    b: np.ndarray
    q: np.ndarray
    slip: np.ndarray
    tolerance: float


def nothing(matrix: np.ndarray, scale: np.ndarray) -> float:
    """Stand-in for `prepare` if the step solver has no settings."""
    return 0.0


class DenseContact:
    """A contact (see contact.Contact) whose steps are solved by `solve`."""

    def __init__(
        self, contact: Contact, solve: Callable, prepare: Callable = nothing, **parameters: float
    ):
        self.contact, self.solve = contact, solve
        self.shape = (2, *contact.forward_position.shape)
        flat = (
            np.broadcast_to(values, self.shape[1:]).ravel().astype(float)
            for values in (contact.compliance, contact.bound, contact.weight)
        )
        self.points = Points(_matrix(contact, self.shape), *flat)
        try:
            self.settings = prepare(self.points.matrix, self.points.scale, **parameters)
        except np.linalg.LinAlgError as error:
            raise StepFailure(f"the method does not apply: {error}") from error

    def __getattr__(self, name: str) -> Any:
        return getattr(self.contact, name)

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: Guess | None = None,
    ) -> March:
        """March along a path, see Contact; raises StepFailure if a step is not solved."""
        q = state.reshape(2, -1).copy()
        at_end, z = q.copy(), self._elastic(q) - self._rigid(path.positions[0])
        all_forces = np.empty((path.steps + 1, 3))
        all_forces[0] = forces(self.contact, at_end.reshape(self.shape))
        slips = np.empty((path.stages.shape[1], *q.shape))
        total, iterations = 0.0, 0
        for k, stages in enumerate(path.stages):
            for s, position in enumerate(stages):
                rigid = self._rigid(position)
                b = z + rigid - np.tensordot(path.carry[s, :s], slips[:s], 1)
                count, residual = self._solved(b, q, slips[s], tolerance)
                iterations, total = iterations + count, total + residual
            now = b - slips[-1] - rigid
            z = z + (now - z) / path.end
            at_end = q.copy() if path.end == 1.0 else at_end + (q - at_end) / path.end
            all_forces[k + 1] = forces(self.contact, at_end.reshape(self.shape))
        solves = path.solves
        return March(at_end.reshape(self.shape), all_forces, total, iterations, solves)

    def _solved(
        self, b: np.ndarray, q: np.ndarray, slip: np.ndarray, tolerance: float
    ) -> tuple[int, float]:
        try:
            count, residual = self.solve(self.points, Stage(b, q, slip, tolerance), self.settings)
        except np.linalg.LinAlgError as error:
            raise StepFailure(f"diverged: {error}") from error
        if not residual <= tolerance:  # also true for NaN
            far = not residual <= FAR_FROM_SOLVED
            raise StepFailure(
                f"{'diverged: ' if far else ''}a step was left unsolved after {count} iterations: "
                f"residual {residual:.1e}"
            )
        return count, residual

    def _elastic(self, q: np.ndarray) -> np.ndarray:
        return self.contact.displacement(q.reshape(self.shape)).reshape(2, -1)

    def _rigid(self, position: np.ndarray) -> np.ndarray:
        return rigid_displacement(self.contact, position).reshape(2, -1)


def dense(solve: Callable, prepare: Callable = nothing) -> Callable:
    """Make a function for Method.dress: `dress(contact, **parameters)` returns a DenseContact."""
    return lambda contact, **parameters: DenseContact(contact, solve, prepare, **parameters)


def safe_length(matrix: np.ndarray) -> float:
    """Inverse of the largest eigenvalue; gradient steps of this length always lower the energy."""
    return 1.0 / np.abs(np.linalg.eigvals(matrix)).max()


def _matrix(contact: Contact, shape: tuple[int, ...]) -> np.ndarray:
    """Influence matrix of a contact; `shape` is the shape of its states."""
    size = int(np.prod(shape))
    columns = np.empty((size, size))
    unit = np.zeros(size)
    for k in range(size):
        unit[k] = 1.0
        columns[k] = contact.displacement(unit.reshape(shape)).ravel()
        unit[k] = 0.0
    return np.ascontiguousarray(columns.T)


@kernel
def judge(points: Points, b: np.ndarray, q: np.ndarray, slip: np.ndarray) -> float:
    """Compute slip = b - A q, arrays of shape (2, K), and return the residual of the step."""
    product, n = points.matrix @ q.ravel(), q.shape[1]
    for c in range(2):  # loops, since array assignments take seconds to compile
        for i in range(n):
            slip[c, i] = b[c, i] - product[c * n + i]
    shape = (2, 1, q.shape[1])
    rows = q.reshape(shape), slip.reshape(shape)
    return coulomb_residual(rows[0], rows[1], points.bound, points.weight, points.scale)


@kernel
def project_in_place(q: np.ndarray, bound: np.ndarray) -> None:
    """Project the tractions q, shape (2, K), onto the disc of radius `bound` at every point."""
    for i in range(q.shape[1]):
        f = shrink(q[0, i], q[1, i], bound[i])
        q[0, i] *= f
        q[1, i] *= f


@kernel
def descend(points: Points, stage: Stage, length: np.ndarray) -> tuple[int, float]:
    """Solve a step by projected gradient steps; `length[k]` is the fixed step length at point k."""
    b, q, slip, tolerance = stage
    residual = judge(points, b, q, slip)
    for iteration in range(MAX_DESCENTS):
        if residual <= tolerance:
            return iteration, residual
        for c in range(2):
            for i in range(q.shape[1]):
                q[c, i] += length[i] * slip[c, i]
        project_in_place(q, points.bound)
        residual = judge(points, b, q, slip)
    return MAX_DESCENTS, residual
