"""Constants and closed forms of a Hertz contact under normal load, tangential load and torsion.

Unless a docstring states otherwise, quantities are in working units, in which the contact radius a,
the force mu*F_z and the length u_lim are 1. Here u_lim is the displacement at which the whole
contact slides. In working units, the reduced shear modulus is 3/4. The unit of tractions is
mu*F_z/a^2, the unit of torques is mu*F_z*a, and the unit of angles is u_lim/a.

Every function accepts floats or arrays, broadcasts them, and raises ValueError if an argument is
not finite or is outside its range.

Functions of SciPy are written with their full names (`scipy.special.ellipe`), so that each
subpackage of SciPy is imported only when it is first used.
"""

from functools import cache
from typing import Any

import numpy as np
import scipy

Numbers = np.ndarray | float
"""A number, or an array of any shape."""
IndenterPressure = Any
"""Pressure under an axisymmetric indenter. Any object is allowed that has the following attributes
and methods of pressure.Pressure: G_star, stiffness, bound, depth, radius, of_load, load, loading
and total."""
G_STAR = 0.75
"""Reduced shear modulus 4G/(2-nu) in working units. The value follows from u_lim = 3 mu F_z / (4 G*
a)."""
TORQUE_FULL_SLIP = 3 * np.pi / 16
"""Torque of a contact that rotates about its centre and slips everywhere, in units of mu*F_z*a."""


@cache
def unit_rule(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss-Legendre nodes and weights on [0, 1].

    A rule is computed at its first use, because the computation takes as long as the import of a
    module.
    """
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2


def checked(
    name: str,
    values: Numbers,
    low: float = 0.0,
    high: float = np.inf,
    low_open: bool = False,
) -> np.ndarray:
    """Check the range of `values`, and return them as a float array.

    Raises ValueError if a value is not finite or is outside [low, high]. If `low_open` is true, a
    value equal to `low` also raises ValueError.
    """
    array = np.asarray(values, dtype=float)
    good = np.isfinite(array) & (array <= high) & ((array > low) if low_open else (array >= low))
    if not np.all(good):
        bad = float(array[~good].flat[0])
        upper = "" if high == np.inf else f" <= {high:g}"
        sign = "<" if low_open else "<="
        raise ValueError(f"{name} = {bad!r}: allowed is a finite {low:g} {sign} {name}{upper}")
    return array


def friction_bound(r: Numbers) -> Numbers:
    """Return the friction bound g(r) = 3/(2 pi) sqrt(1 - r^2) under Hertz pressure.

    r: distance from the centre, as an array of any shape. Raises ValueError if r is negative or not
    finite. The result is dimensionless. The result equals 0 outside the contact.
    """
    r = checked("r", r)
    return 1.5 / np.pi * np.sqrt(np.maximum((1 - r) * (1 + r), 0.0))


def load_inside(r: Numbers) -> Numbers:
    """Return the fraction of the Hertz load within the radius r.

    This fraction is 1 - (1 - r^2)^(3/2). Raises ValueError if r is negative or not finite. The
    argument can have any shape. The result is dimensionless. The result equals 1 for r >= 1.
    """
    return mindlin_force(np.minimum(checked("r", r), 1.0) ** 2)


def ring_bounds(edges: np.ndarray) -> np.ndarray:
    """Compute the mean friction bound of each ring between consecutive radii.

    edges: n + 1 radii. The radii must increase strictly and lie between 0 and 1; other radii raise
    ValueError. Returns n dimensionless values. The product of each value and the area of its ring
    is the load on this ring.
    """
    edges = checked("edges", edges, high=1.0)
    if edges.ndim != 1 or edges.size < 2 or not np.all(np.diff(edges) > 0):
        raise ValueError(f"edges = {edges}: allowed is one row of at least two increasing radii")
    # With y = sqrt(1 - r^2), the mean is (y1^3 - y2^3) / (pi (y1^2 - y2^2)). The common factor y1 -
    # y2 is cancelled, so that thin rings lose no digits.
    y = np.sqrt((1 - edges) * (1 + edges))
    inner, outer = y[:-1], y[1:]
    return (inner**2 + inner * outer + outer**2) / (np.pi * (inner + outer))


def D(c: Numbers) -> Numbers:
    """Return the difference K(k) - E(k) of the elliptic integrals at the modulus k = sqrt(1 - c^2)
    (Eqs 25, 26).

    The argument must be above 0 and at most 1; other values raise ValueError. The argument can have
    any shape. The result is dimensionless. For small c, D is about ln(4/c) - 1, so D tends to
    infinity as c tends to 0. D decreases as c increases, and D(1) is 0.
    """
    return _D_of_log(np.log(checked("c", c, high=1.0, low_open=True)))[()]


def _D_of_log(log_c: np.ndarray) -> np.ndarray:
    """Return D as a function of ln c, where ln c <= 0. The result is also accurate if c is near 1,
    or so small that c underflows."""
    k_squared = 0.0 - np.expm1(2 * log_c)
    near = k_squared / 3 * scipy.special.elliprd(0.0, np.exp(2 * np.maximum(log_c, -20.0)), 1.0)
    return np.where(log_c < -20.0, np.log(4.0) - 1 - log_c, near)


@cache
def D_half() -> float:
    """Return D(1/2), which determines the unit of the bore amplitude."""
    return float(D(0.5))


def lubkin_angle(stick_radius: Numbers, poisson: float = 0.0) -> Numbers:
    """Return the angle of pure torsion from rest as a function of the stick radius (Eq 24).

    The stick radius must be above 0 and at most 1, and Poisson's ratio must be from 0 to 0.5. Other
    values raise ValueError. The arguments are broadcast. Returns an angle in units of u_lim/a.
    """
    stick_radius = checked("stick_radius", stick_radius, high=1.0, low_open=True)
    return _twist_unit(poisson) * D(stick_radius)


def lubkin_stick_radius(angle: Numbers, poisson: float = 0.0) -> Numbers:
    """Return the stick radius after pure torsion by `angle` from rest (inverse of Eq 24).

    Raises ValueError if the angle is negative or not finite, or if Poisson's ratio is outside 0 to
    0.5. The arguments are broadcast. Returns a radius above 0 and at most 1. At the angle 0, the
    radius is 1. Because the centre never slips, a radius that would underflow is replaced by the
    smallest normal float.
    """
    target = checked("angle", angle) / _twist_unit(poisson)
    # Newton's method in ln c. As a function of ln c, D is concave and has the slope -E(k), between
    # -pi/2 and -1. Therefore, iterates that start from the tangent at c = 1 approach the root from
    # one side.
    log_c = -2 / np.pi * target
    for _ in range(30):
        slope = scipy.special.ellipe(-np.expm1(2 * log_c))
        change = (_D_of_log(log_c) - target) / slope
        log_c = np.minimum(log_c + change, 0.0)
        if np.all(np.abs(change) <= 1e-8 * np.abs(log_c)):
            break  # convergence is quadratic
    return np.maximum(np.exp(log_c), np.finfo(float).tiny)


def bore_angle(amplitude: Numbers, poisson: float = 0.0) -> Numbers:
    """Convert a bore amplitude phi~ to the angle phi0 = phi~ phi_lk(1/2) (Eq 27).

    Raises ValueError if the amplitude is negative or not finite, or if Poisson's ratio is outside 0
    to 0.5. The arguments are broadcast. Returns an angle in units of u_lim/a.
    """
    return checked("amplitude", amplitude) * _twist_unit(poisson) * D_half()


@cache
def bore_unit(poisson: float) -> float:
    """Return the angle, in units of u_lim/a, that corresponds to the bore amplitude 1; see
    bore_angle."""
    return float(bore_angle(1.0, poisson))


def bore_amplitude(angle: Numbers, poisson: float = 0.0) -> Numbers:
    """Convert an angle to a bore amplitude (Eq 27, the inverse of bore_angle).

    The amplitude is phi~ = phi0 / phi_lk(1/2). Raises ValueError if the angle is negative or not
    finite, or if Poisson's ratio is outside 0 to 0.5. The arguments are broadcast. Returns a
    dimensionless array.
    """
    return checked("angle", angle) / (_twist_unit(poisson) * D_half())


def _twist_unit(poisson: Numbers) -> np.ndarray:
    """Return the ratio of the torsion angle to the function D of Eqs 25 and 26. This ratio depends
    on Poisson's ratio, because torsion depends on G, whereas u_lim depends on G* = 4G/(2-nu)."""
    return 4 / (np.pi * (2 - checked("poisson", poisson, high=0.5)))


def mindlin_force(u: Numbers) -> Numbers:
    """Return the tangential force 1 - (1 - u)^(3/2) after the displacement u from rest.

    This expression is the formula of Cattaneo and Mindlin. The force is divided by mu*F_z. For u >=
    1, the force is 1. Raises ValueError if u is negative or not finite. The argument can have any
    shape.
    """
    u = np.minimum(checked("u", u), 1.0)
    with np.errstate(divide="ignore"):  # ln 0 = -inf gives the force 1 of full sliding
        return -np.expm1(1.5 * np.log1p(-u))


def mindlin_stick_radius(u: Numbers) -> Numbers:
    """Return the stick radius sqrt(1 - u) after the displacement u from rest (Eq 8).

    Raises ValueError if u is negative or not finite. The argument can have any shape. The radius is
    in units of a. The radius equals 0 for u >= 1.
    """
    return np.sqrt(1 - np.minimum(checked("u", u), 1.0))


def mindlin_traction(r: Numbers, u: Numbers) -> Numbers:
    """Return the shear traction at the radius r after the displacement u from rest.

    The traction is g - g_c in the stick zone, and the friction bound g in the slip annulus
    (Cattaneo and Mindlin). Here g_c = 3/(2 pi) sqrt(c^2 - r^2) is the friction bound of an inner
    contact of radius c = sqrt(1 - u). The formula is exact for nu = 0. Raises ValueError if r or u
    is negative or not finite. The arguments are broadcast. The result is dimensionless.
    """
    r, u = np.broadcast_arrays(checked("r", r), np.minimum(checked("u", u), 1.0))
    gap = 1 - u - r * r
    sticks = gap > 0
    # This form of the difference of two roots loses no digits at small u.
    roots = np.sqrt(np.where(sticks, gap + u, 1.0)) + np.sqrt(np.where(sticks, gap, 0.0))
    return np.where(sticks, 1.5 / np.pi * u / roots, friction_bound(r))[()]


def lubkin_share(r: Numbers, stick_radius: Numbers) -> Numbers:
    """Return the ratio tau/g of traction to friction bound at the radius r in pure torsion from
    rest.

    Raises ValueError if r is negative or not finite, or if the stick radius is outside 0 to 1. The
    arguments are broadcast. The stick radius is 0 if all points slip. The ratio is between 0 and 1,
    and equals 1 outside the stick radius. The ratio does not depend on Poisson's ratio. The formula
    is the closed form of a superposition of rotating punches (Lubkin 1951). The radii s of the
    punches range from c to 1, and a punch of radius s rotates by -d phi_lk(s).
    """
    r, c = np.broadcast_arrays(checked("r", r), checked("stick_radius", stick_radius, high=1.0))
    sticks = r < c
    c = np.where(sticks, c, 0.5)
    rho = np.where(sticks, r, 0.0) / c
    # The ratio is 1 - Lambda0 (Heuman), with incomplete integrals of the modulus c at the angle
    # arcsin(rho). Of the two complementary angles, arcsin(rho) is the one that is exact at r = 0.
    cos2, delta2 = (1 - rho) * (1 + rho), (1 - c * rho) * (1 + c * rho)
    first = rho * scipy.special.elliprf(cos2, delta2, 1.0)
    rest = rho**3 / 3 * scipy.special.elliprd(cos2, delta2, 1.0) + rho * np.sqrt(cos2 / delta2)
    # c^2 K(k) tends to 0 as c tends to 0. It is set to 0 before c^2 underflows.
    k_term = np.where(c > 1e-150, c * c * scipy.special.ellipkm1(np.maximum(c * c, 1e-300)), 0.0)
    share = 2 / np.pi * (scipy.special.ellipe((1 - c) * (1 + c)) * first - k_term * rest)
    return np.where(sticks, np.clip(share, 0.0, 1.0), 1.0)[()]


def lubkin_traction(r: Numbers, stick_radius: Numbers) -> Numbers:
    """Return the circumferential traction at the radius r in pure torsion from rest.

    Raises ValueError if r is negative or not finite, or if the stick radius is outside 0 to 1. The
    arguments are broadcast. The result is dimensionless. In the slip annulus, the result equals the
    friction bound. See lubkin_share.
    """
    return lubkin_share(r, stick_radius) * friction_bound(r)


def lubkin_torque(stick_radius: Numbers) -> Numbers:
    """Return the torque of pure torsion from rest as a function of the stick radius.

    The stick radius must be from 0 to 1; other values raise ValueError. The argument can have any
    shape. The unit of the torque is mu*F_z*a. For every Poisson's ratio, the torque is 0 at the
    stick radius 1 and TORQUE_FULL_SLIP at the stick radius 0. The torque is the integral of
    lubkin_traction. The torque also equals the sum of the torques of rotating punches whose radii s
    range from c to 1 (Lubkin 1951).  A punch of radius s contributes (16/3) G s^3 (-d phi_lk(s)).
    """
    c = checked("stick_radius", stick_radius, high=1.0)[..., None]
    # With dD/ds = -E(k)/s, the integrand is s^2 E(k). After the substitution s = t^2, its only
    # singularity, s^4 ln s at 0, is weak enough for a fixed Gauss rule.
    start = np.sqrt(c)
    length = (1 - c) / (1 + start)
    nodes, weights = unit_rule(48)
    t = start + length * nodes
    integral = np.sum(
        weights * 2 * t**5 * scipy.special.ellipe((1 - t) * (1 + t) * (1 + t * t)), axis=-1
    )
    return 4 / np.pi * length[..., 0] * integral
