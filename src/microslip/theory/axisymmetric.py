"""The paper's formulas that hold for any axisymmetric pressure, by quadrature.

Dimensionless as in theory, where their closed forms for Hertz's pressure stand; apart from it,
since a library of integration takes longer to load than a closed form to evaluate.
"""

import numpy as np

from microslip.theory import paper
from microslip.theory.hertz import checked


def static_stick_zone_of(pressure, stick_radius):
    """Share of the load inside the stick radius (Eq 9).

    pressure: function of a float radius in 0..1, in any unit. 0 <= stick_radius <= 1 (any shape).
    Adaptive quadrature. Raises ValueError also for a load that is not positive.
    """
    stick_radius = checked("stick_radius", stick_radius, high=1.0)
    total = _total(pressure, 1)
    return _each(lambda c: _integral(lambda r: pressure(r) * r, 0.0, c) / total, stick_radius)


def bore_of(pressure, velocity):
    """Steady continuous bore (Eqs 17, 18; 21 and 22 for Hertz's pressure).

    pressure: function of a float radius in 0..1, in any unit. velocity > 0 (any shape), else
    ValueError. Returns two arrays, theory.bore_forward and bore_torque for this pressure. Adaptive
    quadrature. Raises ValueError also for a load that is not positive.
    """
    velocity = checked("velocity", velocity, low_open=True)
    forward = _bore_mean(pressure, velocity, paper.forward_kernel, power=1)
    return forward, _bore_mean(pressure, velocity, paper.torque_kernel, power=2)


def _bore_mean(pressure, velocity, kernel, power):
    total = 2 * np.pi * _total(pressure, power)

    def resistance(v):
        def ring(r):
            return kernel(r / v) * pressure(r) * r**power

        # The kernel's slope is logarithmic on the ring through the centre of rotation.
        split = min(v, 1.0)
        return (_integral(ring, 0.0, split) + _integral(ring, split, 1.0)) / total

    return _each(resistance, velocity)


def _total(pressure, power):
    total = _integral(lambda r: pressure(r) * r**power, 0.0, 1.0)
    if not 0 < total < np.inf:
        raise ValueError(f"pressure integrates to {total!r}: allowed is a finite load > 0")
    return total


def _integral(function, start, end):
    from scipy.integrate import quad  # only here: it takes a while to load

    return quad(function, start, end, epsabs=0.0, epsrel=1e-11, limit=200)[0]


def _each(function, values):
    return np.array([function(float(v)) for v in values.flat]).reshape(values.shape)[()]
