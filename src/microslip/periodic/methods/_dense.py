"""A contact with a dense influence matrix and a replaceable step solver.

The step solver is a function

    solve(points: Points, b, q, tolerance, settings) -> (q, slip, iterations, residual)

for the imposed displacement b and a guess q of the tractions, both of shape (2, K).  `settings` is
the return value of `prepare(points, **parameters)`.  contact.coulomb_residual defines the residual.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from microslip.contact.contact import (
    Contact,
    March,
    Step,
    StepFailure,
    coulomb_residual,
    march_by_steps,
)
from microslip.contact.path import Path

FAR_FROM_SOLVED = 1e-2
"""Residual of a step, divided by mu F_z, above which the solver is considered diverged."""
Solve = Callable[..., tuple[np.ndarray, np.ndarray, int, float]]


class Points(NamedTuple):
    """The K points of a contact.

    Attributes
    ----------
    matrix : np.ndarray, shape (2 K, 2 K)
        Influence matrix A, forward components first.
    scale, bound, weight : np.ndarray, shape (K,)
        Diagonal of A for the forward components, friction bound and area of each point.
    """

    matrix: np.ndarray
    scale: np.ndarray
    bound: np.ndarray
    weight: np.ndarray

    def judged(self, b: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, float]:
        """Return the slip b - A q, and the residual of the step."""
        slip = b - (self.matrix @ q.ravel()).reshape(b.shape)
        return slip, coulomb_residual(q, slip, self.bound, self.weight, self.scale)


class DenseContact:
    """A contact (see contact.Contact) whose steps are solved by `solve`."""

    def __init__(
        self, contact: Contact, solve: Solve, prepare: Callable | None = None, **parameters: float
    ):
        self.contact, self._solve = contact, solve
        shape = contact.forward_position.shape
        units = np.eye(2 * int(np.prod(shape))).reshape(-1, 2, *shape)
        matrix = np.stack([contact.displacement(unit).ravel() for unit in units], axis=1)
        fields = (contact.compliance, contact.bound, contact.weight)
        self.points = Points(matrix, *(np.broadcast_to(one, shape).ravel() for one in fields))
        self.settings = None if prepare is None else prepare(self.points, **parameters)
        self.tolerance, self.last = 0.0, np.zeros(2 * len(self.points.bound))

    def __getattr__(self, name: str) -> Any:
        return getattr(self.contact, name)

    def march(
        self, path: Path, state: np.ndarray, tolerance: float, previous: March | None = None
    ) -> March:
        """Integrate along a path; see contact.Contact.  Raises StepFailure if a step is not
        solved."""
        self.tolerance, self.last = tolerance, state
        return march_by_steps(self.contact, self, path, state, previous)

    def solve(self, b: np.ndarray, guess: np.ndarray) -> Step:
        """Solve a step, see contact.march_by_steps.  The initial guess is the solution of the last
        step, since some methods fail if they start from an extrapolated guess."""
        try:
            q, slip, count, residual = self._solve(
                self.points,
                b.reshape(2, -1),
                self.last.reshape(2, -1),
                self.tolerance,
                self.settings,
            )
            self.last = q
        except np.linalg.LinAlgError as error:
            raise StepFailure(f"diverged: {error}") from error
        if not residual <= self.tolerance:  # also true for NaN
            far = not residual <= FAR_FROM_SOLVED
            raise StepFailure(
                f"{'diverged: ' if far else ''}a step was left unsolved after {count} iterations: "
                f"residual {residual:.1e}"
            )
        return q.reshape(b.shape), slip.reshape(b.shape), count, residual, 0.0


def dense(solve: Solve, prepare: Callable | None = None) -> Callable:
    """Return a function that can be used as Method.dress.

    The function takes `(contact, **parameters)` and returns a DenseContact.
    """
    return lambda contact, **parameters: DenseContact(contact, solve, prepare, **parameters)
