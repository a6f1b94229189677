"""The Coulomb step, and its dispatch to the contact's solver in compiled code.

The unknowns of a step are tractions q with |q| <= g.  The slip b - A q occurs only where |q| = g,
in the direction of q.  A driven body (drive.py) adds one unknown, its displacement d, and one
equation, stiffness d + forward force = load.  The displacement d is added to b.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from microslip.foundation.compiled import OPTIONS

LEVELS = 4
"""Number of penalties for which a resolvent is available."""


class Step(NamedTuple):
    """Data of a Coulomb step.

    Attributes
    ----------
    imposed : np.ndarray, field
        Imposed displacement b for d = 0.
    bound : np.ndarray, shape (points,)
        Friction bound g.
    tolerance : float
        Largest allowed residual, as a force divided by mu F_z.
    """

    imposed: np.ndarray
    bound: np.ndarray
    tolerance: float


class Balance(NamedTuple):
    """The equation of a driven body in one stage.

    Attributes
    ----------
    stiffness, load : float
        Coefficients in the equation `stiffness d + forward force = load`.
    response : np.ndarray, shape (levels, *field)
        Tractions in response to d = 1, computed with the resolvent of each penalty.
    slope : np.ndarray, shape (levels,)
        Forward force of each response, or the stiffness of a contact without resolvents.  The array
        is empty if there is no driven body.
    """

    stiffness: float
    load: float
    response: np.ndarray
    slope: np.ndarray


class Fields(NamedTuple):
    """Arrays that a step solver changes.

    Attributes
    ----------
    y : np.ndarray, field
        Unknown of the solver: initial guess on entry, solution on return.
    q : np.ndarray, field
        Tractions, which are within the friction bound.
    slip : np.ndarray, field
        Slip of the points.
    scratch : tuple of np.ndarray, field
        Three arrays for intermediate results.
    """

    y: np.ndarray
    q: np.ndarray
    slip: np.ndarray
    scratch: tuple[np.ndarray, np.ndarray, np.ndarray]


SOLVER = 1
"""Index of the solver in the fields of system.System."""

_SOLVERS: dict[type, tuple[Callable, Callable, Callable]] = {}
"""Class of a step solver -> its kernels (solve, solve_driven, respond)."""


def step_solver(of: type, solve_driven: Callable, respond: Callable) -> Callable:
    """Decorator that registers the kernel called by `solve_step`.  of: class of the solvers.

    solve_driven, respond: kernels called by `solve_driven_step` and `response_to_drive`.
    """

    def register(function: Callable) -> Callable:
        _SOLVERS[of] = function, solve_driven, respond
        return function

    return register


def solve_step(
    system: NamedTuple, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step with the solver of the system, in compiled code.

    The `slope` of `balance` must be empty, because there is no driven body.

    Returns
    -------
    iterations : int
        Number of iterations; -1 after an interrupt.
    residual : float
        Residual force divided by mu F_z.
    displacement : float
        Always 0.
    """
    raise NotImplementedError("solve_step is for compiled code")


def solve_driven_step(
    system: NamedTuple, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step of a driven contact, in compiled code.

    Returns the same values as `solve_step`, with the displacement d of the body as the third value.
    """
    raise NotImplementedError("solve_driven_step is for compiled code")


def response_to_drive(
    system: NamedTuple, fields: Fields, response: np.ndarray, slope: np.ndarray
) -> None:
    """Fill the response and the slope of a Balance, in compiled code."""
    raise NotImplementedError("response_to_drive is for compiled code")


# without type hints, because Numba compares the signature with that of the lambda
@overload(solve_step, inline="always")
def _solve_step(system, balance, step, fields):  # type: ignore[no-untyped-def]
    solve, _, _ = _SOLVERS[system.types[SOLVER].instance_class]
    return lambda system, balance, step, fields: solve(system, balance, step, fields)


# without type hints, because Numba compares the signature with that of the lambda
@overload(solve_driven_step, inline="always")
def _solve_driven_step(system, balance, step, fields):  # type: ignore[no-untyped-def]
    _, solve, _ = _SOLVERS[system.types[SOLVER].instance_class]
    return lambda system, balance, step, fields: solve(system, balance, step, fields)


# without type hints, because Numba compares the signature with that of the lambda
@overload(response_to_drive, jit_options=OPTIONS)
def _response_to_drive(system, fields, response, slope):  # type: ignore[no-untyped-def]
    _, _, respond = _SOLVERS[system.types[SOLVER].instance_class]
    return lambda system, fields, response, slope: respond(system, fields, response, slope)
