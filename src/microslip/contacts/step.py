"""One Coulomb step: what it asks for, and the solver that the contact has for it.

A step asks for tractions q, |q| <= g, whose slip b - A q is along q and occurs only where |q| = g.
A driven body (drive.py) adds one unknown, its displacement d, which adds d to b, and one equation,
stiffness d + forward force = load.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from microslip.foundation.compiled import OPTIONS

LEVELS = 4
"""Number of penalties for which the resolvent is known."""


class Step(NamedTuple):
    """A Coulomb step to be solved.

    Attributes
    ----------
    imposed : np.ndarray, field
        Displacement b, at d = 0.
    bound : np.ndarray, shape (points,)
        Friction bound g.
    tolerance : float
        Force over mu F_z.
    """

    imposed: np.ndarray
    bound: np.ndarray
    tolerance: float


class Balance(NamedTuple):
    """The equation of a driven body in one stage.

    Attributes
    ----------
    stiffness, load : float
        stiffness d + forward force = load.
    response : np.ndarray, shape (levels, *field)
        Tractions that the resolvent of each penalty gives for d = 1.
    slope : np.ndarray, shape (levels,)
        Their forward force; without a resolvent the stiffness of the contact; empty without a body.
    """

    stiffness: float
    load: float
    response: np.ndarray
    slope: np.ndarray


class Fields(NamedTuple):
    """The arrays that the step solver changes.

    Attributes
    ----------
    y : np.ndarray, field
        The unknown of the solver: initial guess, and solution.
    q : np.ndarray, field
        Tractions, within the bound.
    slip : np.ndarray, field
        Slip.
    scratch : tuple of np.ndarray, field
        Three arrays for intermediate results.
    """

    y: np.ndarray
    q: np.ndarray
    slip: np.ndarray
    scratch: tuple[np.ndarray, np.ndarray, np.ndarray]


SOLVER = 1
"""Place of the solver in a system.System."""

_SOLVERS: dict[type, tuple[Callable, Callable, Callable]] = {}
"""Class of a solver -> its kernels (solve, solve_driven, respond)."""


def step_solver(of: type, solve_driven: Callable, respond: Callable) -> Callable:
    """Decorator of the kernel that solves steps by solvers of the class `of`, see `solve_step`.

    solve_driven, respond: the kernels behind `solve_driven_step` and `response_to_drive`.
    """

    def register(function: Callable) -> Callable:
        _SOLVERS[of] = function, solve_driven, respond
        return function

    return register


def solve_step(
    system: NamedTuple, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step in compiled code, by the solver of the system.

    balance: its `slope` must be empty, which means that there is no body.

    Returns
    -------
    iterations : int
        -1 after an interrupt.
    residual : float
        Force over mu F_z.
    displacement : float
        Always 0.
    """
    raise NotImplementedError("solve_step is for compiled code")


def solve_driven_step(
    system: NamedTuple, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step of a driven contact, like `solve_step`; the third value is the
    displacement d of the body."""
    raise NotImplementedError("solve_driven_step is for compiled code")


def response_to_drive(
    system: NamedTuple, fields: Fields, response: np.ndarray, slope: np.ndarray
) -> None:
    """Fill the response and the slope of a Balance, in compiled code."""
    raise NotImplementedError("response_to_drive is for compiled code")


# Numba compares the signature with that of the lambda: it may have no hints
@overload(solve_step, inline="always")
def _solve_step(system, balance, step, fields):  # type: ignore[no-untyped-def]
    solve, _, _ = _SOLVERS[system.types[SOLVER].instance_class]
    return lambda system, balance, step, fields: solve(system, balance, step, fields)


# Numba compares the signature with that of the lambda: it may have no hints
@overload(solve_driven_step, inline="always")
def _solve_driven_step(system, balance, step, fields):  # type: ignore[no-untyped-def]
    _, solve, _ = _SOLVERS[system.types[SOLVER].instance_class]
    return lambda system, balance, step, fields: solve(system, balance, step, fields)


# Numba compares the signature with that of the lambda: it may have no hints
@overload(response_to_drive, jit_options=OPTIONS | {"cache": False})
def _response_to_drive(system, fields, response, slope):  # type: ignore[no-untyped-def]
    _, _, respond = _SOLVERS[system.types[SOLVER].instance_class]
    return lambda system, fields, response, slope: respond(system, fields, response, slope)
