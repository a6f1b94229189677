"""Masing's rules: closed-form friction under longitudinal oscillation, and the Iwan model.

If the sphere moves along a line, the tangential force depends only on the history of its
displacement. During the first loading, the force is F(d), where d is in units of u_lim and F is in
units of mu F_z. For a sphere, the force is 1 - (1 - d)^(3/2) (Cattaneo and Mindlin). After each
turning point, the force follows the same curve at twice the scale until the previous turning point
is reached. From the previous turning point on, the force follows the older branch. These rules are
exact for Poisson's ratio 0. Quantities are dimensionless as in `paper`.

An Iwan model consists of parallel Jenkins elements, each of which is a spring in series with a
slider. Let F(u) be the force of the first loading along one line at nu = 0. Let P(d) be the load at
the indentation depth d. Then F(u) is 1 - P(1 - u). The slope of F is 2 G* c, where c is the contact
radius at the depth 1 - u. Consider an Iwan model in which the elements with slip displacements from
phi to phi + dphi have the stiffness rho dphi. The slope of the model's force is Integral_u^1 rho
dphi.  Hence

    rho(phi) = -F''(phi) = 2 G* / h'(c)    at the depth h(c) = 1 - phi,

which is 3/4 (1 - phi)^(-1/2) for a sphere.  The model is exact for every history of the
displacement, because both the model and the contact follow Masing's rules. For a punch, the sliders
below the flat end slip together at phi = 1.

In the discrete model, the contact radius is divided into intervals. One element replaces all
elements of an interval. The stiffness and the limit force of this element are the sums over the
replaced elements. Hence the model has the initial stiffness of the contact and the correct force at
full slip. In the first loading, the force of the model follows the tangents of F at the ends of the
intervals. Since F is concave, the force of the model is never below F.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from microslip.foundation.arguments import numbers, real
from microslip.foundation.errors import InputError
from microslip.theory.hertz import IndenterPressure, Numbers, checked, mindlin_force

Function = Callable[[np.ndarray], np.ndarray]
_HALVINGS = 60


@cache
def clustered_rule(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes and the weights of a Gauss rule on [0, 1], for integrands with
    half-integer powers at both ends."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    angles = 0.25 * np.pi * (nodes + 1.0)
    return np.sin(angles) ** 2, 0.25 * np.pi * weights * np.sin(2.0 * angles)


def last_true(condition: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the points between low and high at which a condition changes from true to false.

    All arrays have the shape (n,).
    """
    low, high = low.copy(), high.copy()
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        still = condition(middle)
        low, high = np.where(still, middle, low), np.where(still, high, middle)
    return 0.5 * (low + high)


def longitudinal(
    velocity: Numbers, amplitude: Numbers, curve: Callable = mindlin_force
) -> np.ndarray:
    """Compute the mean friction at nu = 0 under an oscillation along the direction of sliding.

    Parameters
    ----------
    velocity : array_like
        Nonnegative velocity, divided by omega u_lim. The value 0 gives the static limit.
    amplitude : array_like
        Nonnegative amplitude, in units of u_lim. The amplitude is broadcast against the velocity.
    curve : callable
        Force divided by mu F_z as a function of the displacement from rest. The default is the
        curve of a sphere.

    Returns
    -------
    np.ndarray
        Friction divided by mu F_z, computed by quadrature with an error of about 1e-10. The
        friction is 1 if the motion never turns back (velocity >= amplitude). At velocity 0, the
        friction is 1 - curve(amplitude).

    Raises
    ------
    ValueError
        If a velocity or an amplitude is out of range.
    """
    velocity, amplitude = checked("velocity", velocity), checked("amplitude", amplitude)
    velocity, amplitude = np.broadcast_arrays(velocity, amplitude)
    turns = (velocity > 0.0) & (velocity < amplitude)
    mean = np.where(velocity > 0.0, 1.0, 1.0 - curve(amplitude))
    mean = np.where(amplitude > 0.0, mean, 1.0)
    mean[turns] = _mean(velocity[turns], amplitude[turns], curve)
    return mean[()]


def longitudinal_energy(
    velocity: float, amplitude: float, curve: Callable = mindlin_force
) -> float:
    """Compute the dissipated energy per period of the motion in `longitudinal`.

    The energy is divided by mu F_z u_lim. In each period, the sphere slides forward by the net
    advance, and the backward and forward strokes form a loop. The arguments have the same meaning
    as for `longitudinal`, but must be floats.
    """
    stroke = 0.0
    if velocity < amplitude:
        back = np.arccos(-velocity / amplitude)
        stroke = velocity * (2.0 * back - 2.0 * np.pi) + 2.0 * amplitude * np.sin(back)
    return float(2.0 * np.pi * velocity + loop_energy(0.5 * stroke, curve))


def loop_energy(amplitude: Numbers, curve: Callable = mindlin_force) -> Numbers:
    """Compute the dissipated energy of a force-displacement loop.

    The energy is 8 W(A) - 4 A F(A). Here W is the work of the first loading, that is, the integral
    of the curve F from 0 to the amplitude A. For a sphere, the result agrees with the formula of
    Mindlin and Deresiewicz.

    Parameters
    ----------
    amplitude : array_like
        Half the distance between the turning points, in units of u_lim.
    curve : callable
        Force divided by mu F_z as a function of the displacement from rest.

    Returns
    -------
    np.ndarray
        Energy divided by mu F_z u_lim.
    """
    amplitude = checked("amplitude", amplitude)
    partial = np.minimum(amplitude, 1.0)
    force = curve(partial)

    def rise(u: np.ndarray) -> np.ndarray:  # avoids cancellation in 8 W - 4 A F
        return curve(u) - u / np.where(partial > 0.0, partial, 1.0) * force

    # above the amplitude of full sliding, both strokes also slide the remaining distance
    loop = 8.0 * _integral(rise, np.zeros_like(partial), partial)
    return (loop + 4.0 * force * (amplitude - partial))[()]


def _mean(v: np.ndarray, x: np.ndarray, curve: Function) -> np.ndarray:
    """Return the mean force for velocities v between 0 and the amplitude x, as an array of shape
    (n,). At these velocities, the motion turns back."""

    def travel(phase: np.ndarray) -> np.ndarray:
        return v * phase + x * np.sin(phase)

    back = np.arccos(-v / x)  # phases of the backward and the forward turn
    forth = 2.0 * np.pi - back
    end = back + 2.0 * np.pi
    stroke = travel(back) - travel(forth)
    # The loop closes when the sphere returns to the position of the last backward turn.
    closed = last_true(lambda phase: travel(phase) < travel(back), forth, end)

    def backward(phase: np.ndarray) -> np.ndarray:
        return 1.0 - _turned(curve, travel(back) - travel(phase))

    def forward(phase: np.ndarray) -> np.ndarray:
        return 1.0 - _turned(curve, stroke) + _turned(curve, travel(phase) - travel(forth))

    sliding = last_true(lambda phase: travel(back) - travel(phase) < 2.0, back, forth)
    area = _integral(backward, back, sliding) + _integral(backward, sliding, forth)
    sliding = last_true(lambda phase: travel(phase) - travel(forth) < 2.0, forth, closed)
    area += _integral(forward, forth, sliding) + _integral(forward, sliding, closed)
    return (area + end - closed) / (2.0 * np.pi)


def _turned(curve: Function, travel: np.ndarray) -> np.ndarray:
    """Return the change of force since a turning point.

    The change follows the first loading curve at twice the scale.
    """
    return 2.0 * curve(np.maximum(0.5 * travel, 0.0))


def _integral(function: Function, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    total = np.zeros_like(start)
    for node, weight in zip(*clustered_rule(48), strict=True):
        total += weight * function(start + node * (end - start))
    return total * (end - start)


_GRID = 1.0 - np.linspace(0.0, 1.0, 4097)
"""Contact radii in the table that is used to interpolate the ends of the intervals."""
LOOP_ERRORS = 3.0
"""Largest error on loops, divided by the largest error e on the first loading. Let 2 x be the
travel between the last two turning points, and let 2 y be the travel since the last one. Then the
force on a branch of a loop is F(u_max) - 2 F(x) + 2 F(y). The error of each value of F is between 0
and e."""


FACTORS = 1e-100, 1e100
"""Allowed range of the factor between two units."""


@dataclass(frozen=True, eq=False)
class Iwan:
    """Parallel Jenkins elements whose forces add up to the tangential force.

    In the dimensionless form, displacements are divided by u_lim, forces by mu F_z and stiffnesses
    by mu F_z / u_lim. `microslip.predict_iwan` returns a model in m, N and N/m.

    Attributes
    ----------
    stiffness : np.ndarray, shape (elements,)
        Stiffness of the springs, in the order in which the elements slip on the first loading.
    limit_force : np.ndarray, shape (elements,)
        Force at which each element slips.
    force_error : np.ndarray, shape (elements,)
        For each element, the largest error of the force on the first loading near the element's
        slip displacement. The error is due to the finite number of elements.
    poisson_error : float
        Largest difference in force between the model and the full contact due to Poisson's ratio.
        The difference is computed on an initial loading, and on a loop between full slip in both
        directions. The difference is 0 for nu = 0.
    """

    stiffness: np.ndarray
    limit_force: np.ndarray
    force_error: np.ndarray
    poisson_error: float = 0.0

    @property
    def error(self) -> float:
        """Error of the force on an initial loading and on loops between any two displacements.

        The result is at most `error_on_any_path`. If there is a single element, `error_on_any_path`
        is the smaller of the two estimates.
        """
        on_loops = LOOP_ERRORS * float(self.force_error.max()) + self.poisson_error
        return min(on_loops, self.error_on_any_path)

    @property
    def error_on_any_path(self) -> float:
        """Error of the force on any path, including paths with many nested loops.

        The force of a slider is a Lipschitz function of the slip displacement, with the constant 1.
        Hence the total variation of the error along the first loading is an upper bound on the
        error on any path.
        """
        return 2.0 * float(self.force_error.sum()) + self.poisson_error

    def force(self, displacement: np.ndarray) -> np.ndarray:
        """Compute the force along a path that begins at zero displacement and zero tangential
        force.

        Parameters
        ----------
        displacement : array_like, shape (rows,)
            Displacement at each row. Between two rows, the displacement changes linearly.

        Returns
        -------
        np.ndarray, shape (rows,)
            Sum of the forces of the elements.

        Raises
        ------
        InputError
            If the displacement is not an array of finite numbers with one dimension.
        """
        path = numbers("displacement", displacement)
        if path.ndim != 1 or not np.isfinite(path).all():
            allowed = "allowed is an array of finite numbers with one dimension"
            raise InputError("displacement", displacement, allowed)
        forces, out = np.zeros_like(self.stiffness), []
        for step in np.diff(path, prepend=0.0):
            forces = np.clip(forces + step * self.stiffness, -self.limit_force, self.limit_force)
            out.append(forces.sum())
        return np.array(out)

    def scaled(self, force: float, displacement: float) -> Iwan:
        """Return a copy in other units.

        force, displacement: the present units of force and displacement, expressed in the new
        units.  Raises InputError unless both are numbers in FACTORS.
        """
        force = real("force", force, *FACTORS)
        displacement = real("displacement", displacement, *FACTORS)
        return Iwan(
            self.stiffness * (force / displacement),
            self.limit_force * force,
            self.force_error * force,
            self.poisson_error * force,
        )


def with_elements(pressure: IndenterPressure, count: int) -> Iwan:
    """Create an Iwan model of an axisymmetric indenter at nu = 0 with `count` elements.

    All intervals have nearly equal errors. Let k be the stiffness of an interval, and let w be the
    range of its slip displacements. The error of the interval is k w / 8. The sum of sqrt(k w) over
    many narrow intervals is therefore divided into equal parts. The flat end of a punch is a
    separate interval.
    """
    parts = np.sqrt(np.diff(pressure.depth(_GRID)) * np.diff(_GRID))
    measure = np.concatenate([[0.0], np.cumsum(parts)])
    stop = int(np.argmax(measure == measure[-1]))
    flat = float(_GRID[stop])
    ends = np.linspace(0.0, measure[-1], count + (flat == 0.0))
    c = np.interp(ends, measure[: stop + 1], _GRID[: stop + 1])
    if flat > 0.0:
        c = np.append(c, 0.0)
    slip, slope = 1.0 - pressure.depth(c), 2.0 * pressure.G_star * c
    force = pressure.loading(slip)
    stiffness, limit = -np.diff(slope), np.diff(force - slip * slope)
    own = limit / stiffness  # slip displacement of each element
    tangents = force[:-1] + slope[:-1] * (own - slip[:-1])
    return Iwan(stiffness, limit, np.maximum(tangents - pressure.loading(own), 0.0))


def with_tolerance(pressure: IndenterPressure, tolerance: float) -> Iwan:
    """Create an Iwan model for nu = 0. The attribute `error` of the model is at most the tolerance.

    The number of elements is close to the smallest possible number.
    """
    model = with_elements(pressure, 1)
    while model.error > tolerance:  # the error is proportional to count^-2
        count = len(model.stiffness)
        model = with_elements(
            pressure, max(count + 1, int(count * np.sqrt(model.error / tolerance)))
        )
    return model
