"""Friction under longitudinal oscillation in closed form, by Masing's rules.

If the sphere moves along a line, the tangential force depends only on the history of its
displacement. The force of the first loading is F(d), with d in u_lim and F in mu F_z. For a sphere
it is 1 - (1 - d)^(3/2) (Cattaneo and Mindlin). After each turn the force follows the same curve at
twice the scale until it reaches the previous turn, and then the older branch. This is exact for
Poisson's ratio 0. Quantities are dimensionless as in `paper`.
"""

from collections.abc import Callable

import numpy as np

from microslip.theory.hertz import checked, mindlin_force

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
# Clustered at both ends, where the curves have half powers.
_ANGLES = 0.25 * np.pi * (_NODES + 1.0)
_NODES, _WEIGHTS = np.sin(_ANGLES) ** 2, 0.25 * np.pi * _WEIGHTS * np.sin(2.0 * _ANGLES)
_HALVINGS = 60

Function = Callable[[np.ndarray], np.ndarray]


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
        Force divided by mu F_z as a function of the displacement from rest. Defaults to the curve
        of a sphere.

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


def _mean(v: np.ndarray, x: np.ndarray, curve: Function) -> np.ndarray:
    """Mean force for 0 < v < x, where the motion turns back; shape (n,)."""

    def travel(phase: np.ndarray) -> np.ndarray:
        return v * phase + x * np.sin(phase)

    back = np.arccos(-v / x)  # phases of the two turns: back, and forth
    forth = 2.0 * np.pi - back
    end = back + 2.0 * np.pi
    stroke = travel(back) - travel(forth)
    # The loop closes when the sphere returns to the place of its last turn back.
    closed = _first(lambda phase: travel(phase) - travel(back), forth, end)

    def backward(phase: np.ndarray) -> np.ndarray:
        return 1.0 - _turned(curve, travel(back) - travel(phase))

    def forward(phase: np.ndarray) -> np.ndarray:
        return 1.0 - _turned(curve, stroke) + _turned(curve, travel(phase) - travel(forth))

    sliding = _first(lambda phase: travel(back) - travel(phase) - 2.0, back, forth)
    area = _integral(backward, back, sliding) + _integral(backward, sliding, forth)
    sliding = _first(lambda phase: travel(phase) - travel(forth) - 2.0, forth, closed)
    area += _integral(forward, forth, sliding) + _integral(forward, sliding, closed)
    return (area + end - closed) / (2.0 * np.pi)


def _turned(curve: Function, travel: np.ndarray) -> np.ndarray:
    """Change of the force since a turn: the curve of first loading at twice the scale."""
    return 2.0 * curve(np.maximum(0.5 * travel, 0.0))


def _first(function: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Root of an increasing function between low and high, or high if there is no root; shape
    (n,)."""
    low, high = low.copy(), high.copy()
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        below = function(middle) < 0.0
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return high


def _integral(function: Function, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    total = np.zeros_like(start)
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += weight * function(start + node * (end - start))
    return total * (end - start)
