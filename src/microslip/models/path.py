"""The path in time: phases, the integrator's stages, and the rigid displacement at each of them.

With z = A q - w (A q: elastic displacement, w: rigid displacement) the contact obeys
dz = -(slip), slip and traction bound by Coulomb's law: a differential inclusion, rate-independent.
Stiffly accurate diagonally implicit Runge-Kutta methods suit it: every stage is one Coulomb step,

    A q_i + r_i = b_i,     b_i = z + w(t + c_i h) - Sum_{j<i} (a_ij / gamma) r_j,

with r_i = gamma h (slip rate), and the last stage is the end of the step, so that tractions there
never leave the friction bound.  Backward Euler is the one with a single stage.  Theta methods solve
theirs before the end of the step and extrapolate to it, bound or no bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from microslip.motions.motion import HALF_PERIOD

_GAMMA = 1.0 - np.sqrt(0.5)


@dataclass(frozen=True)
class Integrator:
    """A diagonally implicit Runge-Kutta method.

    Attributes
    ----------
    name : str
        Name for tables and messages.
    order : int
        Order of convergence.
    times : tuple of float
        Stage times c, over the step.
    carried : tuple of tuple of float
        Carried slips a_ij / gamma, (stages, stages), zero on and above the diagonal.
    end : float
        Where in the step the last stage sits; below 1 (a single stage then) the rest of the step is
        extrapolated, and tractions at its end may leave the bound.
    """

    name: str
    order: int
    times: tuple[float, ...]
    carried: tuple[tuple[float, ...], ...]
    end: float = 1.0


EULER = Integrator("euler", 1, (1.0,), ((0.0,),))
SDIRK2 = Integrator("sdirk2", 2, (_GAMMA, 1.0), ((0.0, 0.0), ((1.0 - _GAMMA) / _GAMMA, 0.0)))
"""Two stages, L-stable, second order; the default: at equal work far ahead of backward Euler."""


def theta_method(theta: float) -> Integrator:
    """One stage at the share `theta` of the step, 0.5 (midpoint rule) to 1 (backward Euler).

    Second order at 0.5 alone.  Raises ValueError for another theta.
    """
    if not 0.5 <= theta <= 1.0:
        raise ValueError(f"theta = {theta}: allowed is a number from 0.5 to 1")
    return Integrator("theta", 2 if theta == 0.5 else 1, (theta,), ((0.0,),), theta)


LONG_STROKE = 16.0
"""Stroke in u_lim beyond which the number of steps no longer grows; on a line they gather at the
turning points instead."""
STRONGEST_GRADING = 0.8
GRADED_DRIFT = 0.02
GRADED_STROKE = 2.0


def turning_point_grading(drift: float, stroke: float) -> float:
    """How much shorter steps are at the turning points than in the mean, 0 to 0.8 of it.

    drift: forward displacement in a radian of phase; stroke: amplitude of the oscillation, both in
    u_lim.  Where both are small, the forward slip of a whole half period happens next to the
    turning points; where the stroke is long, the contact slides fully and forgets them soon.
    """
    slow = 1.0 / (1.0 + drift / GRADED_DRIFT)
    short = 1.0 / (1.0 + (stroke / GRADED_STROKE) ** 2)
    return STRONGEST_GRADING * slow * short


def turning_point_width(drift: float, stroke: float) -> float:
    """Half-width, in phase, of the zone of equal steps at a turning point.

    Further away, steps are proportional to the distance from the turning point.  Infinite: only the
    grading applies.  The slip reverses within the phase max(1, drift) / stroke, where the velocity
    of the oscillation is u_lim in a radian, or the drift.  The term LONG_STROKE**2 / stroke lets
    the zone shrink gradually from LONG_STROKE on, where the longest step is twice the shortest.
    """
    if stroke <= LONG_STROKE:
        return math.inf
    return max(1.0, drift, LONG_STROKE**2 / stroke) / stroke


@dataclass(frozen=True, eq=False)
class Path:
    """A stretch of rigid motion cut into steps.

    Attributes
    ----------
    phase : np.ndarray, shape (steps + 1,)
        omega t.
    positions : np.ndarray, shape (steps + 1, 3)
        Displacement at every phase: forward, lateral, angle.
    stages : np.ndarray, shape (steps, stages, 3)
        Displacement at every stage: forward, lateral, angle.
    carry : np.ndarray, shape (stages, stages)
        Carried slips, see Integrator.
    end : float
        See `Integrator`.
    depth : np.ndarray or None, shape (1 + steps * stages,)
        Indentation over the reference one at the start and at every stage, None where it does not
        change.
    """

    phase: np.ndarray
    positions: np.ndarray
    stages: np.ndarray
    carry: np.ndarray
    end: float = 1.0
    depth: np.ndarray | None = None

    @property
    def steps(self) -> int:
        return len(self.phase) - 1

    @property
    def solves(self) -> int:
        """Number of stages of a march."""
        return self.stages.shape[0] * self.stages.shape[1]

    @cached_property
    def motion(self) -> np.ndarray:
        """Displacement at the start and at every stage, (1 + steps stages, contacts, 3)."""
        return np.concatenate([self.positions[:1], self.stages.reshape(-1, 3)])[:, None]

    @cached_property
    def share(self) -> np.ndarray:
        """Duration of each step over that of the path, (steps,)."""
        return np.diff(self.phase) / (self.phase[-1] - self.phase[0])

    def mean(self, values: np.ndarray) -> np.ndarray:
        """Time average of values at the phases (first axis), by the trapezoidal rule."""
        return 0.5 * (self.share @ values[1:] + self.share @ values[:-1])


@dataclass(frozen=True, eq=False)
class BodyPath(Path):
    """A Path of a body, and what its contacts do besides.

    Attributes
    ----------
    each : tuple of path.Path
        Path of every contact relative to the path of the body, cut into the same steps.  Only these
        paths have an indentation.
    """

    each: tuple[Path, ...] = ()

    @cached_property
    def motion(self) -> np.ndarray:
        """Displacement of every contact at the start and at every stage, as Path.motion."""
        of_body = np.concatenate([self.positions[:1], self.stages.reshape(-1, 3)])[:, None]
        return of_body + np.concatenate([one.motion for one in self.each], axis=1)


def make_path(
    displacement: Callable,
    phase: np.ndarray,
    integrator: Integrator = SDIRK2,
    depth: Callable | None = None,
) -> Path:
    """Path through the given phases.

    Parameters
    ----------
    displacement : callable
        displacement(phase) -> (forward, lateral, angle).
    phase : array_like, shape (steps + 1,)
        Increasing.
    integrator : Integrator
        Where the stages sit.
    depth : callable or None
        depth(phase) -> indentation over the reference one; None: it does not change.
    """
    phase = np.asarray(phase, dtype=float)
    times = phase[:-1, None] + np.asarray(integrator.times) * np.diff(phase)[:, None]
    stages = np.stack(displacement(times), axis=-1)
    positions = np.stack(displacement(phase), axis=-1)
    # on the chord of the step, so that what is extrapolated agrees with the end of it
    stages[:, -1] = positions[:-1] + integrator.end * np.diff(positions, axis=0)
    if integrator.end == 1.0:
        stages[:, -1] = positions[1:]
    depths = None
    if depth is not None:
        if integrator.end == 1.0:
            times[:, -1] = phase[1:]  # to the last bit: the end is where the next march begins
        depths = depth(np.concatenate([phase[:1], times.ravel()]))
    return Path(phase, positions, stages, np.array(integrator.carried), integrator.end, depths)


def half_period_phases(steps: int, grading: float = 0.0) -> np.ndarray:
    """Phases from one turning point (-pi/2) to the next, shape (steps + 1,), finer at both."""
    return phases_between(HALF_PERIOD, steps, grading)


def phases_between(
    turns: Sequence[float], steps: int, grading: float = 0.0, width: float = math.inf
) -> np.ndarray:
    """Phases from the first turning point to the last, `steps` steps between two of them, smaller
    near each; shape ((len(turns) - 1) steps + 1,).

    grading, width: see turning_point_grading and turning_point_width.
    """
    t = np.linspace(-np.pi / 2, np.pi / 2, steps + 1)
    t = t + 0.5 * grading * np.sin(2 * t)
    if width < math.inf:
        away = 1.0 - np.abs(t) / (np.pi / 2)  # from the nearer end, 0 to 1
        away = width * np.sinh(away * np.arcsinh(np.pi / 2 / width))
        t = np.sign(t) * (np.pi / 2 - away)
    parts = [np.array(turns[:1])]
    for start, end in pairwise(turns):
        parts.append((0.5 * (start + end) + (end - start) / np.pi * t)[1:])
    return np.concatenate(parts)
