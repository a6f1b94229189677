"""One Coulomb step on rings whose forward displacement is not given but pulled (models/pull.py).

Next to the tractions q there is one unknown more, how far the body moves, and one equation,

    stiffness x + f(q) = load,     f(q) = Sum area q_forward.

A Newton step solves for both: the factors of the tangent problem serve a second right-hand side,
the change of q with x, and what is left is one scalar equation.  Where that helps little, sweeps as
in newton_step.py keep x up to date with every ring that they move.  With a soft body that is no
contraction, so x is held near where a sweep began by as much as the contact itself holds it: every
sweep is a step of a proximal method then, which converges for any body.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import shrink
from microslip.models.rings.newton_step import (
    GOOD_STEP,
    MAX_ITERATIONS,
    RESCUE_RELAXATION,
    RESCUE_SWEEPS,
    Step,
    move,
    newton_step,
    step_residual,
    weighted_slip,
)
from microslip.models.rings.tangent import Factors, RingSystem, copy, factorise, subtract

SOFTEST = 1e-12
"""Slope of the forward force over x, below which it tells a Newton step nothing."""


class PulledStep(NamedTuple):
    """A Coulomb step to be solved together with the place of the body.

    Attributes
    ----------
    step : newton_step.Step
        With the displacement imposed at x = 0.
    stiffness, load : float
        Of the body in this stage.
    holding : float
        Force over displacement of the contact without slip.
    """

    step: Step
    stiffness: float
    load: float
    holding: float


class Trial(NamedTuple):
    """Scratch of the step solver beside tangent.Factors.

    Attributes
    ----------
    imposed : np.ndarray, shape (2, n)
        Weighted displacement with that of the body.
    follows : np.ndarray, shape (2, n)
        Change of tractions with x, in the order of the factors.
    push : np.ndarray, shape (2, n)
        Weighted displacement of x = 1.
    """

    imposed: np.ndarray
    follows: np.ndarray
    push: np.ndarray


@kernel
def make_trial(weight: np.ndarray) -> Trial:
    """Scratch for rings of these areas."""
    push = np.zeros((2, len(weight)))
    for i in range(len(weight)):
        push[0, i] = weight[i]
    return Trial(np.empty_like(push), np.empty_like(push), push)


@kernel(inline="always")
def _forward(weight, q):
    """Forward force of tractions."""
    force = 0.0
    for i in range(len(weight)):
        force += weight[i] * q[0, i]
    return force


@kernel
def _residual(rings, pulled, trial, place, q, slip) -> float:
    """Fill slip at a place; returns how far both laws are from being kept, as a force."""
    weight = rings.weight
    for i in range(len(weight)):
        trial.imposed[0, i] = pulled.step.imposed[0, i] + weight[i] * place
        trial.imposed[1, i] = pulled.step.imposed[1, i]
    weighted_slip(rings.stiffness, trial.imposed, q, slip)
    left = step_residual(rings.stiffness, q, slip, pulled.step.bound, weight)
    return left + abs(pulled.load - pulled.stiffness * place - _forward(weight, q))


@kernel
def _sweep(rings, pulled, trial, place, q, slip):
    """One projected Gauss-Seidel sweep of q and x; keeps slip up to date, returns x."""
    stiffness, weight, bound = rings.stiffness, rings.weight, pulled.step.bound
    hold = max(pulled.holding - pulled.stiffness, 0.0)
    whole = pulled.stiffness + hold
    there = (pulled.load + hold * place - _forward(weight, q)) / whole
    subtract(slip[0], place - there, weight)
    for i in range(len(weight)):
        scale = RESCUE_RELAXATION / (stiffness[i, i] + weight[i] * weight[i] / whole)
        x, y = q[0, i] + slip[0, i] * scale, q[1, i] + slip[1, i] * scale
        f = shrink(x, y, bound[i])
        dx, dy = x * f - q[0, i], y * f - q[1, i]
        if dx != 0.0 or dy != 0.0:
            q[0, i] += dx
            q[1, i] += dy
            back = weight[i] * dx / whole
            there -= back
            subtract(slip[0], dx, stiffness[i])
            subtract(slip[0], back, weight)
            subtract(slip[1], dy, stiffness[i])
    return there


@kernel(inline="always")
def _forward_change(weight, change, order):
    """Forward force of a change of tractions that is in the order of the factors."""
    force = 0.0
    for p in range(len(weight)):
        force += weight[order[p]] * change[0, p]
    return force


@kernel
def follow_place(rings: RingSystem, trial: Trial, stick: int, factors: Factors) -> float:
    """Fill trial.follows with the change of tractions with x; returns that of the forward force."""
    newton_step(trial.push, stick, factors)
    copy(trial.follows, factors.change)
    return _forward_change(rings.weight, trial.follows, factors.order)


@kernel
def solve_pulled_step(
    rings: RingSystem, pulled: PulledStep, state: tuple, factors: Factors, trial: Trial
) -> tuple:
    """Solve one Coulomb step on rings and for the place of the body, in place.

    Parameters
    ----------
    rings : tangent.RingSystem
        The contact.
    pulled : PulledStep
        What is asked for.
    state : tuple
        Tractions, shape (2, n), start and result, within the bound; slip, shape (2, n), which
        receives imposed - B q; the place to begin with.
    factors : tangent.Factors
        Scratch.
    trial : Trial
        Scratch.

    Returns
    -------
    tuple
        Iterations, residual (a force over mu F_z, of both laws), place.
    """
    q, slip, place = state
    weight, bound, tolerance = rings.weight, pulled.step.bound, pulled.step.tolerance
    residual = _residual(rings, pulled, trial, place, q, slip)
    failures = 0
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual, place
        trial_residual, there = np.inf, place
        stick = factorise(rings, bound, q, slip, factors)
        if stick >= 0:
            slope = pulled.stiffness + follow_place(rings, trial, stick, factors)
            newton_step(slip, stick, factors)
            if slope > SOFTEST:
                gap = pulled.load - pulled.stiffness * place - _forward(weight, q)
                moves = (gap - _forward_change(weight, factors.change, factors.order)) / slope
                there = place + moves
                for c in range(2):
                    subtract(factors.change[c], -moves, trial.follows[c])
                move(q, bound, stick, factors)
                trial_residual = _residual(
                    rings, pulled, trial, there, factors.trial, factors.trial_slip
                )
        good = trial_residual <= max(GOOD_STEP * residual, tolerance)
        if trial_residual < residual:
            copy(q, factors.trial)
            copy(slip, factors.trial_slip)
            residual, place = trial_residual, there
        else:
            failures += 1
        if not good:
            for _ in range(RESCUE_SWEEPS if failures > 1 else 1):
                place = _sweep(rings, pulled, trial, place, q, slip)
            residual = _residual(rings, pulled, trial, place, q, slip)
    return MAX_ITERATIONS, residual, place
