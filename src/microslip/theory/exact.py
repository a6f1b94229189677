"""Results about friction that need no simulation: upper bounds, closed forms and kinks.

Upper bounds limit the reduction of friction by vibration. Over a period, all work of the contact
forces is dissipated, because the elastic energy is periodic. Every point slips forward by velocity
times period, and the length of its slip path is at least this distance. This distance gives a lower
bound on the dissipation.  Let F be the force, with |F| <= 1, and let d be 1 - mu. The bounds on d
follow for three motions:

- Transverse motion has the forward displacement v t and the lateral displacement y sin t. Then
  v mu + y <F_lateral cos t> >= v. By the inequalities of Schwarz and Jensen,
  <F_lateral cos t>^2 <= (1 - mu^2) / 2 = d (1 - d/2). Hence d <= 1 / ((v/y)^2 + 1/2).
- Bore motion has the forward displacement v phi t and the angle phi sin t. The work of the torque
  takes the place of the work of the lateral force. Forward tractions contribute at most phi d to
  the mean power of the torque. Lateral tractions contribute at most phi sqrt(d/5), where 1/5 is the
  second moment of Hertz pressure about a diameter. Hence d <= 1 / (5 (v - 1)^2) for v > 1.
- Longitudinal motion has the forward displacement v t + x sin t. If v >= x, the sphere never moves
  backward, and d = 0.

For the transverse motion, the dissipated energy per radian equals the work, which is v mu + y
<F_lateral cos t>. This energy is at least v and at most v (1 - d) + y sqrt(d). The upper limit is
at most v + y^2 / (4 v). For the bore motion, consider the dissipated energy per radian, divided by
phi.  This energy is at least v and at most v + 1 / (20 (v - 1)). Let b be the upper bound on d.
Then both energies are at most v (1 + b / (4 - 2 b)). The energy of longitudinal motions with v >= x
obeys the same bound.

The bounds apply to every Poisson's ratio and every stiffness. The functions take the dimensionless
groups of the paper as arguments.

Friction never decreases as the forward velocity increases. The reasons are that Coulomb's law at a
given pressure is monotone, and that the half-space is elastic. For periodic states of the same
oscillation at the velocities v1 and v2, it follows that (mu1 - mu2)(v1 - v2) >= 0. Assume that,
after half a period, the forward oscillation is reversed and the load is the same. Then friction is
an odd function of the velocity. Hence friction is never negative for v > 0. Motions without this
symmetry can propel the contact; see Motion.propels.

For some motions under Hertz pressure, closed forms replace simulations. Stored results depend on
this file and on the functions that it uses. Stored results do not depend on datasets/catalogue.py,
which contains the names of these and other formulas.

As a function of velocity and amplitude, friction can have kinks. At a kink, friction is continuous,
but its slope or curvature is not. One kink is at the amplitude above which no point sticks during
slow sliding. Another kink is at the velocity above which no point ever sticks. An interpolation
needs a border between two cells at each kink. The border need not be exact, because the samples of
friction resolve the remaining part of the kink.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from microslip.foundation import spec
from microslip.theory import paper


def largest_drop_transverse(velocity: float, amplitude: float) -> float:
    """Return an upper bound on 1 - mu_macro under transverse oscillation, for a nonnegative
    velocity and amplitude."""
    if amplitude == 0.0:
        return 0.0
    ratio = velocity / amplitude
    return 1.0 / (ratio * ratio + 0.5)


def largest_drop_bore(velocity: float, amplitude: float) -> float:
    """Return an upper bound on 1 - mu_macro under bore, for a nonnegative velocity and
    amplitude."""
    if amplitude == 0.0:
        return 0.0
    excess = velocity - 1.0
    if excess <= 0.0:
        return 1.0
    return min(1.0, 0.2 / (excess * excess))


def largest_drop_longitudinal(velocity: float, amplitude: float) -> float:
    """Return an upper bound on 1 - mu_macro, for a nonnegative velocity and amplitude. The bound is
    either 0 or 1."""
    return 0.0 if velocity >= amplitude else 1.0


class StaticLimit(NamedTuple):
    """Exact limit of friction as the velocity tends to 0.

    Attributes
    ----------
    function : callable
        Function that returns the friction for an array of dimensionless amplitudes.
    any_poisson : bool
        Whether the limit applies to every Poisson's ratio; otherwise it applies to the ratio 0
        only.
    """

    function: Callable
    any_poisson: bool = False


STATIC_LIMITS = {
    "transverse": StaticLimit(paper.static_limit_transverse),
    "bore": StaticLimit(paper.static_limit_bore, any_poisson=True),
    "longitudinal": StaticLimit(paper.static_limit_longitudinal),
    # zigzag and sine have the same limit, because it depends on the turning points only
    "zigzag": StaticLimit(paper.static_limit_transverse),
}

LARGEST_DROPS = {
    "longitudinal": largest_drop_longitudinal,
    "transverse": largest_drop_transverse,
    "bore": largest_drop_bore,
}
"""Upper bounds on 1 - mu_macro, by motion. Each bound is a function of velocity and amplitude,
which are floats."""


LOOP = "elliptic"
"""Name of the motions that oscillate in two directions. Parameters that are absent from the name
have the value 1."""
LOAD = "normal"
"""Name of the motions whose normal load or indentation oscillates. If the name contains no load,
the load is 1."""


class Kinks(NamedTuple):
    """Dimensionless amplitudes and velocity at which friction has kinks.

    Attributes
    ----------
    amplitudes : tuple of float
        Amplitudes at which friction has a kink if the velocity is below the kink velocity.
    velocity : tuple of float
        Kink velocity.  The tuple is empty if there is no kink velocity. The tuple (v,) stands for
        the velocity v at all amplitudes. The tuple (n0, n1, c0, c1, c2) stands for the velocity (n0
        + n1 A + A^2) / (c0 + c1 A + c2 A^2) at the amplitude A.
    """

    amplitudes: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()


KINKS = {
    # The centre of rotation leaves the contact at the velocity 1.
    "bore": Kinks((), (1.0,)),
    # Contact is lost from the amplitude 1 on. At smaller amplitudes, there is full friction above a
    # certain velocity, at which the springs are stretched faster than their friction bounds grow.
    # This velocity is the maximum over t of A sin t / (1.5 (1 - A cos t)^(1/3)). The formula here
    # exceeds it by up to 2 %.
    "normal": Kinks((1.0,), (0.0, 1.0, 1.5, 1.25, 0.0)),
}
"""Kinks under Hertz pressure, by name of the motion."""
UNDER_ANY = {
    # From the amplitude 1 on, the whole contact slides sideways. Above the kink velocity, a part of
    # the contact no longer sticks at the turning points. The curve is fitted to the velocities of
    # jumps in the second differences of friction under Hertz pressure: 0.030, 0.113, 0.30, 0.56 and
    # 0.69 at the amplitudes 0.2, 0.5, 1, 2 and 3. The curve is slightly above these velocities, so
    # that the neighbouring cells are deformed less. Under other pressures, the curve saves a tenth
    # to a quarter of the points.
    "transverse": Kinks((1.0,), (0.004, 0.12, 1.69, 0.975, 0.965)),
    # There is full friction at velocities above A, because the contact never moves backward. Above
    # the amplitude 1, there are times at which the whole contact slides backward.
    "longitudinal": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
    # All springs in contact are compressed at the same velocity. Contact is lost from the amplitude
    # 1 on.
    "normal:indentation=1": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
}
"""Kinks under every pressure, in the working units of that pressure. The keys are the names of the
motions."""


def kinks_of(motion: str, pressure: str = "hertz") -> Kinks:
    """Return the kinks for a motion and a pressure, both given by name. Most motions have no
    kinks."""
    known = UNDER_ANY | (KINKS if pressure == "hertz" else {})
    return known[motion] if motion in known else _of_family(motion)


def _of_family(motion: str) -> Kinks:
    """Return the kinks of loops, and of motions that combine an oscillating load with other
    components.

    The kink velocity of a loop is the largest velocity of the forward oscillation. At larger
    velocities, the contact never moves backward. Friction has no kink at this velocity. However, at
    all amplitudes, friction changes over a range of velocities of about this size. If the load
    oscillates, the kink velocity equals the amplitude of the oscillation. Above a certain
    amplitude, contact is lost during a part of the period.
    """
    name, _, rest = motion.partition(":")
    if name not in (LOOP, LOAD):
        return Kinks()
    numbers = spec.numbers_in(rest or None, motion, "motion", name)
    if name == LOAD:
        share = numbers.get("indentation", 0.0) or numbers.get("load", 1.0)
        return Kinks((1.0 / share,) if share > 0.0 else (), (0.0, 1.0, 1.0, 1.0, 0.0))
    back = numbers.get("forward", 1.0) * numbers.get("forward_cycles", 1.0)
    return Kinks((), (0.0, 1.0, 1.0 / back, 1.0 / back, 0.0)) if back > 0.0 else Kinks()


def kink_velocity(kinks: Kinks, amplitude: np.ndarray | float) -> np.ndarray:
    """Return the kink velocity at each amplitude, as an array with the shape of `amplitude`. The
    amplitudes must not be negative.

    `kinks.velocity` must not be empty.
    """
    first, *rest = kinks.velocity
    amplitude = np.asarray(amplitude, float)
    if not rest:
        return np.full_like(amplitude, first)
    n1, c0, c1, c2 = rest
    return (first + n1 * amplitude + amplitude**2) / (c0 + c1 * amplitude + c2 * amplitude**2)
