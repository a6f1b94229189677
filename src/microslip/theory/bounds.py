"""How far vibration can lower the friction at most: brackets that need no simulation.

Over a period the work of the contact forces is dissipated; elastic energy returns.  Every point
slips forward by the drift, and no detour makes a slip path shorter, so the dissipation is at least
drift x period.  With F the force (|F| <= 1) and d = 1 - mu:

- transverse (forward v t, lateral y sin t): v mu + y <F_lateral cos t> >= v, where by Schwarz and
  Jensen <F_lateral cos t>^2 <= (1 - mu^2) / 2 = d (1 - d/2).  Hence d <= 1 / ((v/y)^2 + 1/2).
- bore (forward v phi t, angle phi sin t): the same with the torque, whose forward tractions give
  at most phi d and whose lateral ones phi sqrt(d/5), 1/5 being the second moment of Hertz's
  pressure about a diameter.  Hence d <= 1 / (5 (v - 1)^2) for v > 1.
- longitudinal (forward v t + x sin t): the sphere never turns back where v >= x, so d = 0.

All hold for any nu and any stiffness.  Arguments are the paper's dimensionless groups.

Friction never falls with the forward velocity: two marches of the same oscillation at velocities v1
and v2 that have become periodic dissipate no less than nothing on the difference of their motions,
(mu1 - mu2)(v1 - v2) >= 0, since Coulomb's law at given pressure is monotone and the half-space is
elastic.  Where the oscillation reverses its forward motion under the same load half a period later
(motions/symmetry.py), friction is odd in the velocity, and so it is never negative for v > 0.
Other motions may propel the contact (Motion.propels).
"""

from __future__ import annotations


def largest_drop_transverse(velocity: float, amplitude: float) -> float:
    """Upper bound of 1 - mu_macro (dimensionless) for velocity >= 0, amplitude >= 0."""
    if amplitude == 0.0:
        return 0.0
    ratio = velocity / amplitude
    return 1.0 / (ratio * ratio + 0.5)


def largest_drop_bore(velocity: float, amplitude: float) -> float:
    """Upper bound of 1 - mu_macro (dimensionless) for velocity >= 0, whatever the amplitude."""
    if amplitude == 0.0:
        return 0.0
    excess = velocity - 1.0
    if excess <= 0.0:
        return 1.0
    return min(1.0, 0.2 / (excess * excess))


def largest_drop_longitudinal(velocity: float, amplitude: float) -> float:
    """Upper bound of 1 - mu_macro (dimensionless) for velocity >= 0, amplitude >= 0: 0 or 1."""
    return 0.0 if velocity >= amplitude else 1.0
