"""Formulas for any axisymmetric indenter or pressure, evaluated by quadrature.

The static limits and the torsion of an indenter are accurate to about 1e-8. The limit for
transverse oscillation applies to Poisson's ratio 0, and the limit for bore applies to any ratio.
For a sphere, both limits agree with the closed forms of `paper`. The closed forms are faster.
Quantities are dimensionless, as in the module `paper`.

Eqs 9, 17 and 18 of the paper, which apply to any axisymmetric pressure, are evaluated by adaptive
quadrature.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from microslip.theory import paper
from microslip.theory.hertz import IndenterPressure, Numbers, checked

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
SMALLEST_STICK_RADIUS = 1e-6
"""Stick radius, divided by the contact radius, below which `torsion_stick_radius` returns 0."""


def static_transverse(pressure: IndenterPressure, amplitude: float) -> float:
    """Compute the static friction under transverse oscillation at nu = 0, in the limit of zero
    velocity.

    The static friction is the integral of sqrt(g^2 - (g - g_c)^2) over the stick zone; see
    paper.static_limit_transverse.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    amplitude : float
        Nonnegative amplitude, in units of u_lim.

    Returns
    -------
    float
        Friction divided by mu F_z, from 0 to 1.
    """
    if amplitude >= 1.0:
        return 0.0
    c = float(pressure.radius(1.0 - amplitude))

    def remainder(r: np.ndarray) -> np.ndarray:
        inner = pressure.bound(r, c)
        return np.sqrt(inner * np.maximum(2.0 * pressure.bound(r, 1.0) - inner, 0.0))

    return min(_over_the_circle(remainder, c, _kink(pressure)), 1.0)


def torsion_angle(pressure: IndenterPressure, stick_radius: float, poisson: float = 0.0) -> float:
    """Compute the angle at which pure torsion from rest reduces the stick radius to a given value
    (Eq 24 for a sphere).

    Torsion is a superposition of rotating flat punches. Abel's inversion gives
    phi = 1/(2 G) Integral_c^1 g / sqrt(r^2 - c^2) dr.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    stick_radius : float
        Stick radius divided by the contact radius, above 0 and at most 1.
    poisson : float
        Poisson's ratio, from 0 to 0.5.

    Returns
    -------
    float
        Angle in units of u_lim / a.
    """
    end = np.arccosh(1.0 / stick_radius)
    eta = end * np.sin(0.5 * np.pi * _NODES)  # the bound decreases like a square root at the edge
    step = end * 0.5 * np.pi * np.cos(0.5 * np.pi * _NODES) * _WEIGHTS
    bound = pressure.bound(np.minimum(stick_radius * np.cosh(eta), 1.0), 1.0)
    return 2.0 / ((2.0 - poisson) * pressure.G_star) * float(np.sum(step * bound))


def torsion_stick_radius(pressure: IndenterPressure, angle: float, poisson: float = 0.0) -> float:
    """Compute the stick radius after pure torsion from rest (inverse of torsion_angle).

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    angle : float
        Nonnegative angle, in units of u_lim / a.
    poisson : float
        Poisson's ratio, from 0 to 0.5.

    Returns
    -------
    float
        Stick radius divided by the contact radius. Values below SMALLEST_STICK_RADIUS are replaced
        by 0.
    """
    from scipy.optimize import brentq  # imported here, because the import is slow

    if angle <= 0.0:
        return 1.0

    def excess(log_c: float) -> float:
        return torsion_angle(pressure, np.exp(log_c), poisson) - angle

    smallest = np.log(SMALLEST_STICK_RADIUS)
    return float(np.exp(brentq(excess, smallest, 0.0, xtol=1e-13))) if excess(smallest) > 0 else 0.0


def torsion_traction(pressure: IndenterPressure, r: np.ndarray, stick_radius: float) -> np.ndarray:
    """Compute the circumferential traction of pure torsion inside the stick circle.

    The traction is a superposition of the tractions of rotating punches. Let c be the stick radius,
    and let t^2 be c^2 + (c^2 - r^2) tan^2 theta. Then the result is (2 r/pi) Integral g(t)/t
    d(theta).

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    r : array_like
        Radii below the stick radius, divided by the contact radius, as an array of any shape.
    stick_radius : float
        Stick radius divided by the contact radius.

    Returns
    -------
    np.ndarray
        Traction divided by mu F_z / a^2, with the shape of r.
    """
    r = np.asarray(r, float)[..., None]
    inside = stick_radius**2 - r**2
    end = np.arctan2(np.sqrt(1.0 - stick_radius**2), np.sqrt(inside))
    theta = end * np.sin(0.5 * np.pi * _NODES)
    step = end * 0.5 * np.pi * np.cos(0.5 * np.pi * _NODES) * _WEIGHTS
    t = np.minimum(np.sqrt(stick_radius**2 + inside * np.tan(theta) ** 2), 1.0)
    return 2.0 / np.pi * r[..., 0] * np.sum(step * pressure.bound(t, 1.0) / t, axis=-1)


def torsion_energy(pressure: IndenterPressure, angle: float, poisson: float = 0.0) -> float:
    """Compute the dissipated energy per period of an oscillating torsion without sliding.

    By Masing's rules, the energy is 8 W - 4 T phi. Here phi is the amplitude of the angle, and W is
    the work of the first loading. The torque T is a sum over punches of all radii s. A punch of the
    radius s contributes (16/3) G s^3 (-d phi(s)). By integration by parts, the energy is 64 G
    Integral_c^1 s^2 phi(s) (phi(c) - phi(s)) ds. For a sphere, this result agrees with the formula
    of Lubkin and Deresiewicz.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    angle : float
        Nonnegative amplitude of the rotation, in units of u_lim / a.
    poisson : float
        Poisson's ratio, from 0 to 0.5.

    Returns
    -------
    float
        Energy divided by mu F_z u_lim.
    """
    c = max(torsion_stick_radius(pressure, angle, poisson), SMALLEST_STICK_RADIUS)
    middle = min(max(_kink(pressure), c), 1.0)
    total = 0.0
    for start, end in ((c, middle), (middle, 1.0)):
        half = 0.5 * np.pi * _NODES  # the angle behaves like a square root at both ends
        radii = start + (end - start) * np.sin(half) ** 2
        step = 0.5 * np.pi * (end - start) * np.sin(2.0 * half) * _WEIGHTS
        turned = np.array([torsion_angle(pressure, s, poisson) for s in radii])
        total += float(np.sum(step * radii**2 * turned * (angle - turned))) if end > start else 0.0
    return 16.0 * (2.0 - poisson) * pressure.G_star * total


def static_bore(pressure: IndenterPressure, angle: float, poisson: float = 0.0) -> float:
    """Compute the static friction under oscillating bore, in the limit of zero velocity.

    The static friction is 4 Integral_0^c g arccos(tau / g) r dr; see paper.static_limit_bore.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    angle : float
        Nonnegative amplitude of the rotation, in units of u_lim / a.
    poisson : float
        Poisson's ratio, from 0 to 0.5.

    Returns
    -------
    float
        Friction divided by mu F_z, from 0 to 1.
    """
    c = torsion_stick_radius(pressure, angle, poisson)
    if c in (0.0, 1.0):
        return c

    def remainder(r: np.ndarray) -> np.ndarray:
        bound = pressure.bound(r, 1.0)
        share = np.clip(torsion_traction(pressure, r, c) / bound, 0.0, 1.0)
        return 2.0 / np.pi * bound * np.arccos(share)

    return min(_over_the_circle(remainder, c, _kink(pressure)), 1.0)


def _kink(pressure: IndenterPressure) -> float:
    """Return the radius of the flat end of an indenter.

    The pressure has a kink at this radius. The radius is 0 if there is no flat end.
    """
    return float(pressure.radius(1e-300))


def _over_the_circle(
    function: Callable[[np.ndarray], np.ndarray], radius: float, kink: float
) -> float:
    """Integrate a function of the radius over a circle.

    Near the edge of the circle, the function should vary as the square root of the distance from
    the edge.
    """
    total = 0.0
    for start, end in ((0.0, min(kink, radius)), (min(kink, radius), radius)):
        r = end - (end - start) * _NODES**4
        step = (end - start) * 4.0 * _NODES**3 * _WEIGHTS
        total += 2.0 * np.pi * float(np.sum(step * r * function(r))) if end > start else 0.0
    return total


def static_stick_zone_of(pressure: Callable[[float], float], stick_radius: Numbers) -> Numbers:
    """Compute the fraction of the load inside the stick radius (Eq 9).

    Parameters
    ----------
    pressure : callable
        Function that returns the pressure, in any unit, for a radius divided by the contact radius
        (0 to 1).
    stick_radius : array_like
        Stick radius divided by the contact radius, from 0 to 1, as an array of any shape.

    Raises
    ------
    ValueError
        If a stick radius is out of range or the load is not positive.
    """
    stick_radius = checked("stick_radius", stick_radius, high=1.0)
    total = _total(pressure, 1)
    return _each(lambda c: _integral(lambda r: pressure(r) * r, 0.0, c) / total, stick_radius)


def bore_of(pressure: Callable[[float], float], velocity: Numbers) -> tuple[Numbers, Numbers]:
    """Compute the force and the torque for sliding with a steady rotation (Eqs 17 and 18).

    The rotation is about the contact normal.

    Parameters
    ----------
    pressure : callable
        Function that returns the pressure, in any unit, for a radius divided by the contact radius
        (0 to 1).
    velocity : array_like
        Velocity divided by omega a, at least 0, as an array of any shape.

    Returns
    -------
    forward, torque : np.ndarray
        Forward friction and torque, normalised as in paper.bore_forward and paper.bore_torque.

    Raises
    ------
    ValueError
        If a velocity is out of range or the load is not positive.
    """
    slow = np.finfo(float).tiny
    velocity = np.asarray(np.maximum(checked("velocity", velocity), slow))
    forward = _bore_mean(pressure, velocity, paper.forward_kernel, power=1)
    return forward, _bore_mean(pressure, velocity, paper.torque_kernel, power=2)


def _bore_mean(
    pressure: Callable[[float], float], velocity: np.ndarray, kernel: Callable, power: int
) -> Numbers:
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
    from scipy.integrate import quad  # the import takes a third of a second

    # the full output has no warnings, which quad gives near the limit of rounding
    return quad(function, start, end, epsabs=0.0, epsrel=1e-11, limit=200, full_output=1)[0]


def _each(function: Callable[[float], float], values: np.ndarray) -> Numbers:
    return np.array([function(float(v)) for v in values.flat]).reshape(values.shape)[()]
