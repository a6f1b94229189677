"""Paths in time: phases, stages of the integrator, and the rigid displacement at each stage.

Let A q be the elastic displacement, and let w be the rigid displacement.  Let z = A q - w be the
difference of these displacements.  In the contact, the change dz equals minus the slip.  Coulomb's
law relates the slip to the traction.  Together, the two laws form a rate-independent differential
inclusion.  The inclusion is integrated by stiffly accurate diagonally implicit Runge-Kutta methods,
in which every stage is one Coulomb step,

    A q_i + r_i = b_i,

where b_i = z + w(t + c_i h) - Sum_{j<i} (a_ij / gamma) r_j, and r_i is gamma h times the slip rate.
The last stage is at the end of the step.  Therefore, the tractions at the end of a step are within
the friction bound.  Backward Euler has a single stage.  A theta method also has a single stage, but
this stage is before the end of the step.  A theta method extrapolates the state to the end of the
step.  There, tractions can exceed the bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

_GAMMA = 1.0 - np.sqrt(0.5)


@dataclass(frozen=True)
class Integrator:
    """A diagonally implicit Runge-Kutta method.

    Attributes
    ----------
    name : str
        Name of the method in tables and messages.
    order : int
        Order of convergence.
    times : tuple of float
        Times c_i of the stages, as fractions of the step.
    carried : tuple of tuple of float
        Factors a_ij / gamma for the slips of earlier stages, as a matrix of shape (stages, stages)
        with zeros on and above the diagonal.
    end : float
        Time of the last stage divided by the length of the step.  If it is below 1 (methods with a
        single stage), the state at the end of the step is extrapolated, and its tractions can
        exceed the friction bound.
    """

    name: str
    order: int
    times: tuple[float, ...]
    carried: tuple[tuple[float, ...], ...]
    end: float = 1.0


EULER = Integrator("euler", 1, (1.0,), ((0.0,),))
SDIRK2 = Integrator("sdirk2", 2, (_GAMMA, 1.0), ((0.0, 0.0), ((1.0 - _GAMMA) / _GAMMA, 0.0)))
"""Default integrator.  The integrator is L-stable and of second order, and has two stages.  For the
same work, the integrator is far more accurate than backward Euler."""


def theta_method(theta: float) -> Integrator:
    """Return the integrator whose single stage is at the fraction `theta` of the step.

    theta is between 0.5 (midpoint rule, second order) and 1 (backward Euler).  The order is 1 for
    every theta above 0.5.  Raises ValueError if theta is below 0.5 or above 1.
    """
    if not 0.5 <= theta <= 1.0:
        raise ValueError(f"theta = {theta}: allowed is a number from 0.5 to 1")
    return Integrator("theta", 2 if theta == 0.5 else 1, (theta,), ((0.0,),), theta)


LONG_STROKE = 16.0
"""Stroke in u_lim above which the number of steps is constant.  For motion along a line, the steps
of longer strokes are graded towards the turning points."""


class Path(NamedTuple):
    """A rigid motion over an interval of phase, divided into steps.

    Attributes
    ----------
    phase : np.ndarray, shape (steps + 1,)
        Phase omega t at the start of the path and at the end of every step.
    positions : np.ndarray, shape (steps + 1, 3)
        Forward displacement, lateral displacement and angle at every phase.
    motion : np.ndarray, shape (1 + steps stages, 3)
        Forward displacement, lateral displacement and angle at the start and at every stage.
    weights : np.ndarray, shape (steps + 1,)
        Weights of the phases in a time average by the trapezoidal rule.
    carry : np.ndarray, shape (stages, stages)
        Factors for the slips of earlier stages; see Integrator.carried.
    end : float
        Time of the last stage divided by the length of the step; see Integrator.
    depth : np.ndarray or None, shape (1 + steps stages,)
        Indentation depth divided by the reference depth, at the start and at every stage; None if
        the depth is constant.
    """

    phase: np.ndarray
    positions: np.ndarray
    motion: np.ndarray
    weights: np.ndarray
    carry: np.ndarray
    end: float
    depth: np.ndarray | None

    @property
    def steps(self) -> int:
        return len(self.phase) - 1


def make_path(
    displacement: Callable,
    phase: np.ndarray,
    integrator: Integrator = SDIRK2,
    depth: Callable | None = None,
) -> Path:
    """Create the path of a motion, divided into steps at the given phases.

    Parameters
    ----------
    displacement : callable
        displacement(phase) returns (forward, lateral, angle).
    phase : array_like, shape (steps + 1,)
        Increasing phases.
    integrator : Integrator
        Method that determines the stages.
    depth : callable or None
        depth(phase) returns the indentation depth divided by the reference depth; None if the depth
        is constant.
    """
    phase = np.asarray(phase, dtype=float)
    lengths, stages = phase[1:] - phase[:-1], len(integrator.times)
    times = phase[:-1, None] + np.array(integrator.times) * lengths[:, None]
    if integrator.end == 1.0:
        times[:, -1] = phase[1:]  # exact to the last bit, because the next march starts here
    every = np.concatenate([phase[:1], times.ravel()])
    motion = np.array(displacement(every), dtype=float).T.copy()
    positions = motion[::stages]
    if integrator.end < 1.0:
        # on the chord of the step, so that the extrapolation leads to the position at the next
        # phase
        positions = np.array(displacement(phase)).T
        motion[1:] = positions[:-1] + integrator.end * np.diff(positions, axis=0)
    weights = np.zeros(len(phase))
    weights[:-1] = halves = 0.5 * lengths / (phase[-1] - phase[0])
    weights[1:] += halves
    depths = None if depth is None else depth(every)
    carry = np.array(integrator.carried)
    return Path(phase, positions, motion, weights, carry, integrator.end, depths)


def phases_between(
    turns: Sequence[float], steps: int, grading: float = 0.0, width: float = math.inf
) -> np.ndarray:
    """Return phases from the first turning point to the last one.

    The number of steps between neighbouring turning points is `steps`.  Therefore, the path has
    (len(turns) - 1) * steps + 1 phases.  The steps are graded towards both turning points.  For
    `grading` and `width`, see discretise.path_of.
    """
    t = np.arange(steps + 1) * (np.pi / steps) - np.pi / 2
    t[-1] = np.pi / 2  # as in np.linspace, which takes longer
    t = t + 0.5 * grading * np.sin(2 * t)
    if width < math.inf:
        away = 1.0 - np.abs(t) / (np.pi / 2)  # distance from the nearer turning point, 0 to 1
        away = width * np.sinh(away * np.arcsinh(np.pi / 2 / width))
        t = np.sign(t) * (np.pi / 2 - away)
    parts = [np.array(turns[:1])]
    for start, end in pairwise(turns):
        parts.append((0.5 * (start + end) + (end - start) / np.pi * t)[1:])
    return np.concatenate(parts)
