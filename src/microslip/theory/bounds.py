"""Upper bounds on the reduction of friction by vibration.

Over a period, all work of the contact forces is dissipated, because the elastic energy is periodic.
Every point slips forward by velocity times period, and the length of its slip path is at least this
distance.  This gives a lower bound on the dissipation.  With the force F (|F| <= 1) and d = 1 - mu,
it follows that:

- transverse (forward v t, lateral y sin t): v mu + y <F_lateral cos t> >= v, where by Schwarz and
  Jensen <F_lateral cos t>^2 <= (1 - mu^2) / 2 = d (1 - d/2).  Hence d <= 1 / ((v/y)^2 + 1/2).
- bore (forward v phi t, angle phi sin t): the work of the torque replaces the work of the lateral
  force.  Forward tractions contribute at most phi d, and lateral tractions at most phi sqrt(d/5);
  1/5 is the second moment of Hertz pressure about a diameter.  Hence d <= 1 / (5 (v - 1)^2) for
  v > 1.
- longitudinal (forward v t + x sin t): the sphere never moves backward if v >= x, so d = 0.

The dissipated energy per radian of the transverse motion is the work v mu + y <F_lateral cos t>.
It is at least v and at most v (1 - d) + y sqrt(d), hence at most v + y^2 / (4 v).  For the bore,
the energy divided by phi is between v and v + 1 / (20 (v - 1)).  With the bound b on d, both
energies are at most v (1 + b / (4 - 2 b)).  The same bound applies to longitudinal motions with
v >= x.

The bounds hold for any nu and any stiffness.  The arguments are the paper's dimensionless groups.

Friction never decreases as the forward velocity increases.  Coulomb's law at a given pressure is
monotone, and the half-space is elastic.  So (mu1 - mu2)(v1 - v2) >= 0 for periodic states of the
same oscillation at the velocities v1 and v2.  Friction is odd in the velocity if the oscillation
reverses its forward motion half a period later under the same load (Motion.propels).  So it is
never negative for v > 0.  Other motions can propel the contact (Motion.propels).
"""

from __future__ import annotations


def largest_drop_transverse(velocity: float, amplitude: float) -> float:
    """Upper bound on 1 - mu_macro (dimensionless) for velocity >= 0 and amplitude >= 0."""
    if amplitude == 0.0:
        return 0.0
    ratio = velocity / amplitude
    return 1.0 / (ratio * ratio + 0.5)


def largest_drop_bore(velocity: float, amplitude: float) -> float:
    """Upper bound on 1 - mu_macro (dimensionless) for velocity >= 0 and any amplitude > 0."""
    if amplitude == 0.0:
        return 0.0
    excess = velocity - 1.0
    if excess <= 0.0:
        return 1.0
    return min(1.0, 0.2 / (excess * excess))


def largest_drop_longitudinal(velocity: float, amplitude: float) -> float:
    """Upper bound on 1 - mu_macro (dimensionless) for velocity >= 0 and amplitude >= 0.  It is 0 or
    1."""
    return 0.0 if velocity >= amplitude else 1.0
