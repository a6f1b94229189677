"""Closed forms for any axisymmetric indenter at Poisson's ratio 0 (bore: any): static limits
under an oscillation, and torsion.

For a sphere they are those of paper.py, which are quicker and better tested; here they are
integrals over the record of a pressure.Pressure, to about 1e-8.  Dimensionless as there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from microslip.theory.indenter_pressure import IndenterPressure

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
SMALLEST_STICK_RADIUS = 1e-6


def static_transverse(pressure: IndenterPressure, amplitude: float) -> float:
    """Static friction under transverse oscillation, v -> 0, nu = 0.

    Integral over the stick zone of sqrt(g^2 - (g - g_c)^2), see paper.static_limit_transverse.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    amplitude : float
        In u_lim, >= 0.

    Returns
    -------
    float
        Over mu F_z, 0 to 1.
    """
    if amplitude >= 1.0:
        return 0.0
    c = float(pressure.radius(1.0 - amplitude))

    def left(r: np.ndarray) -> np.ndarray:
        inner = pressure.bound(r, c)
        return np.sqrt(inner * np.maximum(2.0 * pressure.bound(r, 1.0) - inner, 0.0))

    return min(_over_the_circle(left, c, _kink(pressure)), 1.0)


def static_stick_zone(pressure: IndenterPressure, stick_radius: np.ndarray | float) -> np.ndarray:
    """Share of the load inside a stick radius, 0 to 1 (Eq 9).

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    stick_radius : array_like
        Over the contact radius, 0 to 1, any shape.
    """
    return pressure.load(stick_radius, 1.0)


def torsion_angle(pressure: IndenterPressure, stick_radius: float, poisson: float = 0.0) -> float:
    """Angle of pure torsion, from rest, that leaves a stick circle (Eq 24 for a sphere).

    Torsion is a sum of turned flat punches, whose inversion by Abel gives
    phi = 1/(2 G) Integral_c^1 g / sqrt(r^2 - c^2) dr.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    stick_radius : float
        Over the contact radius, above 0 and at most 1.
    poisson : float
        Poisson's ratio, 0 to 0.5.

    Returns
    -------
    float
        In u_lim / a.
    """
    end = np.arccosh(1.0 / stick_radius)
    eta = end * np.sin(0.5 * np.pi * _NODES)  # the bound falls like a root at the edge
    step = end * 0.5 * np.pi * np.cos(0.5 * np.pi * _NODES) * _WEIGHTS
    bound = pressure.bound(np.minimum(stick_radius * np.cosh(eta), 1.0), 1.0)
    return 2.0 / ((2.0 - poisson) * pressure.G_star) * float(np.sum(step * bound))


def torsion_stick_radius(pressure: IndenterPressure, angle: float, poisson: float = 0.0) -> float:
    """Stick radius left by pure torsion from rest, the inverse of torsion_angle.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    angle : float
        In u_lim / a, >= 0.
    poisson : float
        Poisson's ratio, 0 to 0.5.

    Returns
    -------
    float
        Over the contact radius; 0 below SMALLEST_STICK_RADIUS.
    """
    from scipy.optimize import brentq  # takes long to load, and few ask for it

    if angle <= 0.0:
        return 1.0

    def excess(log_c: float) -> float:
        return torsion_angle(pressure, np.exp(log_c), poisson) - angle

    smallest = np.log(SMALLEST_STICK_RADIUS)
    return float(np.exp(brentq(excess, smallest, 0.0, xtol=1e-13))) if excess(smallest) > 0 else 0.0


def torsion_traction(pressure: IndenterPressure, r: np.ndarray, stick_radius: float) -> np.ndarray:
    """Circumferential traction of pure torsion inside the stick circle.

    The turned punches summed up: (2 r/pi) Integral g(t)/t d(theta), t^2 = c^2 + (c^2 - r^2) tan^2.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    r : array_like
        Radii below the stick radius, over the contact radius, any shape.
    stick_radius : float
        Stick radius over the contact radius.

    Returns
    -------
    np.ndarray
        Over mu F_z / a^2, of the shape of r.
    """
    r = np.asarray(r, float)[..., None]
    inside = stick_radius**2 - r**2
    end = np.arctan2(np.sqrt(1.0 - stick_radius**2), np.sqrt(inside))
    theta = end * np.sin(0.5 * np.pi * _NODES)
    step = end * 0.5 * np.pi * np.cos(0.5 * np.pi * _NODES) * _WEIGHTS
    t = np.minimum(np.sqrt(stick_radius**2 + inside * np.tan(theta) ** 2), 1.0)
    return 2.0 / np.pi * r[..., 0] * np.sum(step * pressure.bound(t, 1.0) / t, axis=-1)


def static_bore(pressure: IndenterPressure, angle: float, poisson: float = 0.0) -> float:
    """Static friction under oscillating bore, v -> 0.

    4 Integral_0^c g arccos(tau / g) r dr, see paper.static_limit_bore.

    Parameters
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    angle : float
        Half stroke of the oscillation in u_lim / a, >= 0.
    poisson : float
        Poisson's ratio, 0 to 0.5.

    Returns
    -------
    float
        Over mu F_z, 0 to 1.
    """
    c = torsion_stick_radius(pressure, angle, poisson)
    if c in (0.0, 1.0):
        return c

    def left(r: np.ndarray) -> np.ndarray:
        bound = pressure.bound(r, 1.0)
        share = np.clip(torsion_traction(pressure, r, c) / bound, 0.0, 1.0)
        return 2.0 / np.pi * bound * np.arccos(share)

    return min(_over_the_circle(left, c, _kink(pressure)), 1.0)


def _kink(pressure: IndenterPressure) -> float:
    """Radius of the flat end of an indenter, where its pressure has a kink; 0 if it has none."""
    return float(pressure.radius(1e-300))


def _over_the_circle(
    function: Callable[[np.ndarray], np.ndarray], radius: float, kink: float
) -> float:
    """Integral of a function of the radius over a circle, at whose edge it falls like a root."""
    total = 0.0
    for start, end in ((0.0, min(kink, radius)), (min(kink, radius), radius)):
        r = end - (end - start) * _NODES**4
        step = (end - start) * 4.0 * _NODES**3 * _WEIGHTS
        total += 2.0 * np.pi * float(np.sum(step * r * function(r))) if end > start else 0.0
    return total
