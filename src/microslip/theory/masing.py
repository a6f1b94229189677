"""Friction under longitudinal oscillation in closed form, by Masing's rules.

If the sphere moves along a line, the tangential force depends only on the history of its
displacement. The force of the first loading is F(d), with d in u_lim and F in mu F_z. For a sphere
it is 1 - (1 - d)^(3/2) (Cattaneo and Mindlin). After each turn, the force follows the same curve at
twice the scale until it reaches the previous turn. Then it follows the older branch. This is exact
for Poisson's ratio 0. Quantities are dimensionless as in `paper`.
"""

from collections.abc import Callable

import numpy as np

from microslip.theory.hertz import checked, mindlin_force

Function = Callable[[np.ndarray], np.ndarray]
_HALVINGS = 60


def clustered_rule(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss rule (nodes, weights) on 0..1, clustered at both ends, for half-integer powers."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    angles = 0.25 * np.pi * (nodes + 1.0)
    return np.sin(angles) ** 2, 0.25 * np.pi * weights * np.sin(2.0 * angles)


def last_true(condition: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Points between low and high where a condition changes from true to false, shape (n,)."""
    low, high = low.copy(), high.copy()
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        still = condition(middle)
        low, high = np.where(still, middle, low), np.where(still, high, middle)
    return 0.5 * (low + high)


_NODES, _WEIGHTS = clustered_rule(48)


def longitudinal(
    velocity: np.ndarray | float, amplitude: np.ndarray | float, curve: Callable = mindlin_force
) -> np.ndarray:
    """Mean forward friction under an oscillation along the direction of sliding, nu = 0.

    Parameters
    ----------
    velocity : array_like
        Velocity divided by omega u_lim, >= 0. The value 0 gives the static limit.
    amplitude : array_like
        Amplitude in u_lim, >= 0. It is broadcast with the velocity.
    curve : callable
        Force divided by mu F_z as a function of the displacement from rest. The default is the
        curve of a sphere.

    Returns
    -------
    np.ndarray
        Friction divided by mu F_z, by quadrature with an error of about 1e-10. It is 1 if the
        motion never turns back (velocity >= amplitude), and 1 - curve(amplitude) at velocity 0.

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
    """Dissipated energy per period of the motion in `longitudinal`, divided by mu F_z u_lim.

    The sphere slides forward over its net advance, and the backward and forward strokes form a
    loop. The arguments are those of `longitudinal`, as floats.
    """
    stroke = 0.0
    if velocity < amplitude:
        back = np.arccos(-velocity / amplitude)
        stroke = velocity * (2.0 * back - 2.0 * np.pi) + 2.0 * amplitude * np.sin(back)
    return float(2.0 * np.pi * velocity + loop_energy(0.5 * stroke, curve))


def loop_energy(
    amplitude: np.ndarray | float, curve: Callable = mindlin_force
) -> np.ndarray | float:
    """Dissipated energy of a loop of force against displacement, 8 W(A) - 4 A F(A).

    W is the work of the first loading, the integral of the curve F from 0 to the amplitude A. For a
    sphere, this is the formula of Mindlin and Deresiewicz.

    Parameters
    ----------
    amplitude : array_like
        Half the distance between the turns, in u_lim, >= 0.
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

    def rise(u: np.ndarray) -> np.ndarray:  # no cancellation in the sum 8 W - 4 A F
        return curve(u) - u / np.where(partial > 0.0, partial, 1.0) * force

    # beyond full sliding, both strokes add their length
    loop = 8.0 * _integral(rise, np.zeros_like(partial), partial)
    return (loop + 4.0 * force * (amplitude - partial))[()]


def _mean(v: np.ndarray, x: np.ndarray, curve: Function) -> np.ndarray:
    """Mean force for 0 < v < x, where the motion turns back; shape (n,)."""

    def travel(phase: np.ndarray) -> np.ndarray:
        return v * phase + x * np.sin(phase)

    back = np.arccos(-v / x)  # phases of the two turns: back, and forth
    forth = 2.0 * np.pi - back
    end = back + 2.0 * np.pi
    stroke = travel(back) - travel(forth)
    # The loop closes when the sphere returns to the position of its last backward turn.
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
    """Change of the force since a turn. It is the curve of the first loading at twice the scale."""
    return 2.0 * curve(np.maximum(0.5 * travel, 0.0))


def _integral(function: Function, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    total = np.zeros_like(start)
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += weight * function(start + node * (end - start))
    return total * (end - start)
