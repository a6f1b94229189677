"""The paper's formulas for any axisymmetric pressure, evaluated by adaptive quadrature.

All quantities are dimensionless, as in the module `paper`, which contains the closed forms for
Hertz pressure.
"""

from collections.abc import Callable

import numpy as np

from microslip.theory import paper
from microslip.theory.hertz import checked


def static_stick_zone_of(
    pressure: Callable[[float], float], stick_radius: np.ndarray | float
) -> np.ndarray | float:
    """Fraction of the load inside the stick radius (Eq 9).

    Parameters
    ----------
    pressure : callable
        Pressure, in any unit, as a function of the radius divided by the contact radius (0 to 1).
    stick_radius : array_like
        Stick radius divided by the contact radius, 0 to 1, any shape.

    Raises
    ------
    ValueError
        If a stick radius is out of range or the load is not positive.
    """
    stick_radius = checked("stick_radius", stick_radius, high=1.0)
    total = _total(pressure, 1)
    return _each(lambda c: _integral(lambda r: pressure(r) * r, 0.0, c) / total, stick_radius)


def bore_of(
    pressure: Callable[[float], float], velocity: np.ndarray | float
) -> tuple[np.ndarray | float, np.ndarray | float]:
    """Force and torque of the steady continuous bore (Eqs 17 and 18).

    Parameters
    ----------
    pressure : callable
        Pressure, in any unit, as a function of the radius divided by the contact radius (0 to 1).
    velocity : array_like
        Velocity divided by omega a, above 0, any shape.

    Returns
    -------
    forward, torque : np.ndarray
        Forward friction and torque under this pressure, normalised as in paper.bore_forward and
        paper.bore_torque.

    Raises
    ------
    ValueError
        If a velocity is out of range or the load is not positive.
    """
    velocity = checked("velocity", velocity, low_open=True)
    forward = _bore_mean(pressure, velocity, paper.forward_kernel, power=1)
    return forward, _bore_mean(pressure, velocity, paper.torque_kernel, power=2)


def _bore_mean(
    pressure: Callable[[float], float], velocity: np.ndarray, kernel: Callable, power: int
) -> np.ndarray | float:
    total = 2 * np.pi * _total(pressure, power)

    def resistance(v: float) -> float:
        def ring(r: float) -> float:
            return kernel(r / v) * pressure(r) * r**power

        # The slope of the kernel is logarithmic on the ring through the centre of rotation.
        split = min(v, 1.0)
        return (_integral(ring, 0.0, split) + _integral(ring, split, 1.0)) / total

    return _each(resistance, velocity)


def _total(pressure: Callable[[float], float], power: int) -> float:
    total = _integral(lambda r: pressure(r) * r**power, 0.0, 1.0)
    if not 0 < total < np.inf:
        raise ValueError(f"pressure integrates to {total!r}: allowed is a finite load > 0")
    return total


def _integral(function: Callable[[float], float], start: float, end: float) -> float:
    from scipy.integrate import quad  # takes a third of a second to import

    return quad(function, start, end, epsabs=0.0, epsrel=1e-11, limit=200)[0]


def _each(function: Callable[[float], float], values: np.ndarray) -> np.ndarray | float:
    return np.array([function(float(v)) for v in values.flat]).reshape(values.shape)[()]
