"""Longitudinal oscillation without marching: the curve of first loading with Masing's memory.

While the sphere moves along one line the tangential force follows from its displacement alone: on
the first loading F(d) (d in u_lim, F over mu F_z; Cattaneo and Mindlin's 1 - (1 - d)^(3/2) for a
sphere), after each turn the same curve at twice the scale, back to where the last turn was, and the
older branch from there on.  Exact for Poisson's ratio 0.  Dimensionless as in theory.
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
        Over omega u_lim, >= 0; 0: its limit.
    amplitude : array_like
        In u_lim, >= 0; the two broadcast.
    curve : callable
        Force over mu F_z after a displacement from rest, by default that of a sphere.

    Returns
    -------
    np.ndarray
        To about 1e-10, by quadrature; 1 where the motion never turns back (velocity >= amplitude),
        1 less the curve at the amplitude for velocity to 0.

    Raises
    ------
    ValueError
        For another velocity or amplitude.
    """
    velocity, amplitude = checked("velocity", velocity), checked("amplitude", amplitude)
    velocity, amplitude = np.broadcast_arrays(velocity, amplitude)
    turns = (velocity > 0.0) & (velocity < amplitude)
    mean = np.where(velocity > 0.0, 1.0, 1.0 - curve(amplitude))
    mean = np.where(amplitude > 0.0, mean, 1.0)
    mean[turns] = _mean(velocity[turns], amplitude[turns], curve)
    return mean[()]


def _mean(v: np.ndarray, x: np.ndarray, curve: Function) -> np.ndarray:
    """Mean force where 0 < v < x, so that the motion turns back, shape (n,)."""

    def travel(phase: np.ndarray) -> np.ndarray:
        return v * phase + x * np.sin(phase)

    back = np.arccos(-v / x)  # turns back, and forward again
    forth = 2.0 * np.pi - back
    end = back + 2.0 * np.pi
    stroke = travel(back) - travel(forth)
    # What lies behind the last turn back has been forgotten when the sphere gets there again.
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
    """Change of the force on the way from a turn on: the first curve at twice the scale."""
    return 2.0 * curve(np.maximum(0.5 * travel, 0.0))


def _first(function: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Root of a rising function between low and high, high if there is none; shape (n,)."""
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
