"""Closed forms of the paper, and exact static limits (v -> 0).

All quantities are dimensionless. Lengths are divided by the contact radius a, forces by mu*F_z.
The amplitude y~0 of a transverse motion is in units of u_lim. The amplitude phi~ of a bore motion
is in units of phi_lk(1/2). The unit of velocity is omega u_lim for transverse motions, a omega for
continuous bore, and Omega phi0 a for oscillating bore. Forward is the direction of the macroscopic
velocity, and lateral is perpendicular to it.

Every function accepts floats or arrays, broadcasts them, and raises ValueError if an argument is
not finite or is outside its range.

The formulas for the mean velocity of a contact under a constant force apply to large amplitudes. At
each instant, a massless rigid contact moves at the velocity at which friction balances the force.
Therefore, the velocity of the contact is proportional to the velocity of the vibration.
"""

from __future__ import annotations

import numpy as np
import scipy

from microslip.foundation.errors import InputError
from microslip.theory import hertz
from microslip.theory.hertz import Numbers, checked, unit_rule


# Transverse oscillation
def large_amplitude_transverse(velocity: Numbers, amplitude: Numbers) -> Numbers:
    """Return the friction of a rigid slider under transverse oscillation (Eq 6).

    The rigid slider is the large-amplitude limit of the contact. The friction is (2/pi) K(m), where
    K is the complete elliptic integral of the first kind. The parameter is m =
    -(amplitude/velocity)^2. At amplitude 0, the friction is 1. At velocity 0 and any amplitude
    above 0, the friction is 0. Raises ValueError if the velocity or the amplitude is negative or
    not finite. The arguments are broadcast.
    """
    velocity, amplitude = checked("velocity", velocity), checked("amplitude", amplitude)
    # K(-m) = q K'(q) with q = v/sqrt(v^2 + A^2) is accurate for every ratio v/A.
    total = np.hypot(velocity, amplitude)
    q = np.where(amplitude > 0, velocity / np.where(total > 0, total, 1.0), 1.0)
    positive = np.maximum(q, np.finfo(float).tiny)
    elliptic = np.where(
        q < 1e-9, np.log(4) - np.log(positive), scipy.special.ellipkm1(np.maximum(q, 1e-9) ** 2)
    )
    return (2 / np.pi * q * elliptic)[()]


def static_slider(amplitude: Numbers) -> Numbers:
    """Return the static friction sqrt(1 - amplitude^2) of a slider on a spring (Eq 7).

    Raises ValueError if the amplitude is negative or not finite. The argument can have any shape.
    The friction is 0 for amplitude >= 1.
    """
    amplitude = np.minimum(checked("amplitude", amplitude), 1.0)
    return np.sqrt((1 - amplitude) * (1 + amplitude))


def stick_radius_transverse(amplitude: Numbers) -> Numbers:
    """Return the stick radius under transverse oscillation alone (Eq 8).

    The radius is sqrt(1 - amplitude). Raises ValueError if the amplitude is negative or not finite.
    The argument can have any shape. The radius is 0 for amplitude >= 1.
    """
    return hertz.mindlin_stick_radius(checked("amplitude", amplitude))


def static_stick_zone(stick_radius: Numbers) -> Numbers:
    """Return the fraction of the Hertz load inside the stick radius c (Eq 10).

    This fraction is 1 - (1 - c^2)^(3/2). The stick radius must be from 0 to 1; other values raise
    ValueError. The argument can have any shape.
    """
    return hertz.load_inside(checked("stick_radius", stick_radius, high=1.0))


def static_transverse(amplitude: Numbers) -> Numbers:
    """Return the paper's static friction under transverse oscillation.

    The friction is 1 - amplitude^(3/2) (Eq 11). Raises ValueError if the amplitude is negative or
    not finite. The argument can have any shape. The friction is 0 for amplitude >= 1. For the exact
    limit, see static_limit_transverse.
    """
    return 1 - np.minimum(checked("amplitude", amplitude), 1.0) ** 1.5


# Continuous bore
def rotation_centre(velocity: Numbers, time: Numbers = 0.0) -> tuple:
    """Return the lateral and the forward coordinate of the instantaneous centre of rotation, in the
    frame at rest (Eq 14).

    The time is dimensionless: t~ = t v0/a. Raises ValueError if the velocity or the time is
    negative or not finite. The arguments are broadcast. Returns the pair of arrays (-velocity,
    time). In Eq 13, the paper writes t/(v0 a). This expression is not dimensionless.
    """
    velocity, time = checked("velocity", velocity), checked("time", time)
    return 0 * time - velocity, time + 0 * velocity


def steady_bore_traction(lateral: Numbers, forward: Numbers, velocity: Numbers) -> tuple:
    """Return the lateral and the forward traction in continuous bore under full slip (Eq 15).

    The traction has the magnitude hertz.friction_bound(r) and is opposite to the local velocity
    (-forward, velocity + lateral). At the centre of rotation, the traction is 0. Eq 15 of the paper
    has a wrong sign, which is corrected here. The mean lateral force is 0 (Eq 16). The arguments
    `lateral` and `forward` are the position relative to the contact centre. Raises ValueError if
    the velocity is negative or not finite. The arguments are broadcast.
    """
    lateral = checked("lateral", lateral, low=-np.inf)
    forward = checked("forward", forward, low=-np.inf)
    arm = lateral + checked("velocity", velocity)
    speed = np.hypot(arm, forward)
    scale = hertz.friction_bound(np.hypot(lateral, forward)) / np.where(speed > 0, speed, 1.0)
    return scale * forward, -scale * arm


def forward_kernel(ratio: Numbers) -> Numbers:
    """Return the kernel Q_Y of the forward friction of a ring (Eq 19).

    The kernel is the forward friction of a ring, divided by the friction bound. The radius of the
    ring is ratio*velocity.

    Raises ValueError if the ratio is negative or not finite. The argument can have any shape. For
    ratio <= 1, the kernel is 4 E(k) at the modulus k = ratio. For ratio > 1, the kernel is
    Q_M(1/ratio). The kernel decreases from 2 pi at ratio 0 to 4 at ratio 1, and approaches pi/ratio
    at large ratios.
    """
    inside, even, odd = _ring_integrals(ratio)
    return np.where(inside, even, odd)[()]


def torque_kernel(ratio: Numbers) -> Numbers:
    """Return the kernel Q_M of the torque of a ring (Eq 20).

    The kernel is the torque of a ring, divided by the product of the friction bound and the radius.
    The radius of the ring is ratio*velocity.

    Raises ValueError if the ratio is negative or not finite. The argument can have any shape. For
    ratio <= 1, the kernel is 4 (E - (1 - k^2) K)/k at the modulus k = ratio. For ratio > 1, the
    kernel is Q_Y(1/ratio). At small ratios, the kernel is about pi times the ratio. The kernel is 4
    at ratio 1, and approaches 2 pi at large ratios.
    """
    inside, even, odd = _ring_integrals(ratio)
    return np.where(inside, odd, even)[()]


def _ring_integrals(ratio: Numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    ratio = checked("ratio", ratio)
    k = np.minimum(ratio, 1 / np.maximum(ratio, 1.0))
    # Carlson's R_D gives (E - (1 - k^2) K)/k without cancellation. R_D is infinite at k = 1 only.
    rest = np.maximum((1 - k) * (1 + k), 1e-100)
    return (
        ratio <= 1,
        4 * scipy.special.ellipe(k * k),
        4 / 3 * k * rest * scipy.special.elliprd(0.0, 1.0, rest),
    )


def bore_forward(velocity: Numbers) -> Numbers:
    """Return the forward friction for sliding with a steady rotation (Eq 21).

    The rotation is about the contact normal, and the pressure is that of Hertz.
    The friction is (3 pi/8)(v - v^3/4) for v <= 1. For v > 1, the friction is 2F1(-1/2, 1/2; 5/2;
    1/v^2), where 2F1 is the hypergeometric function. The friction tends to 1 at large velocities.
    Raises ValueError if the velocity is negative or not finite. The argument can have any shape.
    """
    velocity = checked("velocity", velocity)
    slow = np.minimum(velocity, 1.0)
    slow = 3 * np.pi / 8 * slow * (1 - slow**2 / 4)
    return np.where(velocity <= 1, slow, _fast_forward(1 / np.maximum(velocity, 1.0)))[()]


def _fast_forward(inverse: np.ndarray) -> np.ndarray:
    # Eq 21 at velocity 1/inverse >= 1: the power series of 4 E(k), integrated term by term.
    return scipy.special.hyp2f1(-0.5, 0.5, 2.5, inverse**2)


def bore_torque(velocity: Numbers) -> Numbers:
    """Return the torque of the steady continuous bore under Hertz pressure (Eq 22).

    The torque is divided by its value at velocity 0. For v <= 1, the result is 1 - v^2 + (3/8) v^4.
    For v > 1, the result is 16/(15 pi v) 2F1(1/2, 1/2; 7/2; 1/v^2). Raises ValueError if the
    velocity is negative or not finite. The argument can have any shape.
    """
    velocity = checked("velocity", velocity)
    slow, inverse = np.minimum(velocity, 1.0) ** 2, 1 / np.maximum(velocity, 1.0)
    slow = 1 - slow + 0.375 * slow**2
    fast = 16 / (15 * np.pi) * inverse * scipy.special.hyp2f1(0.5, 0.5, 3.5, inverse**2)
    return np.where(velocity <= 1, slow, fast)[()]


# Oscillating bore
def large_amplitude_bore(velocity: Numbers) -> Numbers:
    """Return the quasi-steady forward friction under oscillating bore of large amplitude (Eq 29).

    The friction is the mean of bore_forward(velocity/cos(tau)) over tau. Raises ValueError if the
    velocity is negative or not finite. The argument can have any shape.
    """
    velocity = checked("velocity", velocity)
    fast, slow = np.maximum(velocity, 1.0), np.clip(velocity, np.finfo(float).tiny, 1 - 1e-16)
    mean = np.where(velocity < 1, _slow_mean(slow), _fast_mean(fast))
    return np.where(velocity > 0, mean, 0.0)[()]


def _fast_mean(velocity: np.ndarray) -> np.ndarray:
    # The integrand is periodic and smooth, so a sum over equal steps converges exponentially. At
    # velocity 1, the integrand contains |tau|^5, and the order of convergence is 6.
    tau = (np.arange(128) + 0.5) * (np.pi / 256)
    return np.mean(_fast_forward(np.cos(tau) / velocity[..., None]), axis=-1)


def _slow_mean(velocity: np.ndarray) -> np.ndarray:
    # For cos(tau) > v, the cubic branch of Eq 21 applies, and the integral has a closed form.
    v = velocity
    sine = np.sqrt((1 - v) * (1 + v))
    rotating = 3 * np.pi / 8 * ((v - v**3 / 8) * np.log((1 + sine) / v) - v * sine / 8)
    # The rest is the integral of v f(s) / sqrt(1 - v^2 s^2) over s = cos(tau)/v from 0 to 1. Here f
    # has half-integer powers at s = 1, and the root is singular near s = 1. The substitution 1 - s
    # = (1/v - 1) sinh(h)^2 removes both difficulties.
    h_end = np.arcsinh(np.sqrt(v / (1 - v)))
    nodes, weights = unit_rule(64)
    sinh = np.sinh(h_end[..., None] * nodes)
    gap, v_col = (1 - v)[..., None], v[..., None]
    s = np.clip(1 - gap / v_col * sinh**2, 0.0, 1.0)
    integrand = 2 * np.sqrt(gap) * sinh * _fast_forward(s) / np.sqrt(1 + v_col * s)
    sliding = h_end * np.sum(weights * integrand, axis=-1)
    return 2 / np.pi * (rotating + sliding)


def bore_amplitude_at(stick_radius: Numbers) -> Numbers:
    """Return the bore amplitude at which the stick radius is c.

    The amplitude is D(c)/D(1/2) (Eqs 30, 31). The stick radius must be above 0 and at most 1; other
    values raise ValueError. The argument can have any shape.
    """
    stick_radius = checked("stick_radius", stick_radius, high=1.0, low_open=True)
    return hertz.D(stick_radius) / hertz.D_half()


def bore_stick_radius(amplitude: Numbers) -> Numbers:
    """Return the stick radius under oscillating bore alone (Eq 32). This function is the inverse of
    bore_amplitude_at.

    Raises ValueError if the amplitude is negative or not finite. The argument can have any shape.
    The radius is above 0 and at most 1.
    """
    return hertz.lubkin_stick_radius(hertz.bore_angle(amplitude))


def static_bore(amplitude: Numbers) -> Numbers:
    """Return the paper's static friction under oscillating bore (Eq 33, corrected).

    The friction is 1 - (1 - c^2)^(3/2). This expression is Eq 10. The stick radius c is given by Eq
    32. For the exact limit, see static_limit_bore. Raises ValueError if the amplitude is negative
    or not finite. The argument can have any shape.
    """
    return static_stick_zone(bore_stick_radius(amplitude))


def static_bore_printed(amplitude: Numbers) -> Numbers:
    """Return the static friction 1 - (1 - c)^(3/2), which is Eq 33 as printed.

    The printed equation contains c in place of the c^2 of Eq 10. This function is for comparison
    only. Raises ValueError if the amplitude is negative or not finite. The argument can have any
    shape.
    """
    return static_stick_zone(np.sqrt(bore_stick_radius(amplitude)))


# The exact limits for v -> 0 are integrals over the stick zone of the oscillation. The integrand is
# the largest constant forward traction that can be added to the oscillating traction without
# exceeding the bound.
def static_limit_transverse(amplitude: Numbers) -> Numbers:
    """Return the exact static friction under transverse oscillation for Poisson's ratio 0.

    The static friction is the limit v -> 0. Let g_c be the friction bound of the inner contact; see
    mindlin_traction. The friction is the integral of sqrt(g^2 - (g - g_c)^2) over the stick zone.
    The friction is 0 for amplitude >= 1. For other Poisson's ratios, Mindlin's traction and this
    limit are approximations. Raises ValueError if the amplitude is negative or not finite. The
    argument can have any shape.
    """
    amplitude = np.minimum(checked("amplitude", amplitude), 1.0)
    step, bound, inner = _stick_zone_rule(np.sqrt(1 - amplitude), np.sqrt(amplitude))
    remainder = np.sqrt(inner * (2 * bound - inner))
    return np.minimum(3 * np.sum(step * inner * bound * remainder, axis=-1), 1.0)


def static_limit_longitudinal(amplitude: Numbers) -> Numbers:
    """Return the static friction (1 - amplitude)^(3/2) under longitudinal oscillation.

    Let g_c be the friction bound of the inner contact; see mindlin_traction. The friction is the
    integral of g_c over the stick zone. For amplitude >= 1, the friction is 0. The limit is exact
    for Poisson's ratio 0. Raises ValueError if the amplitude is negative or not finite. The
    argument can have any shape.
    """
    return (1 - np.minimum(checked("amplitude", amplitude), 1.0)) ** 1.5


def static_limit_bore(amplitude: Numbers) -> Numbers:
    """Return the static friction under oscillating bore, in the limit of zero velocity.

    The friction is the integral of (2/pi) g arccos(tau/g) over the stick zone. The integrand is the
    largest forward traction, averaged over the polar angle. The limit is exact for every Poisson's
    ratio. The reason is that, for a given phi~, neither the stick radius nor the torsional traction
    tau depends on Poisson's ratio. Raises ValueError if the amplitude is negative or not finite.
    The argument can have any shape.
    """
    c = np.asarray(bore_stick_radius(amplitude))
    step, bound, inner = _stick_zone_rule(c, np.sqrt((1 - c) * (1 + c)))
    r = np.sqrt(np.maximum(c[..., None] - inner, 0.0) * (c[..., None] + inner))
    angle = np.arccos(hertz.lubkin_share(r, c[..., None]))
    return np.minimum(6 / np.pi * np.sum(step * inner * bound**2 * angle, axis=-1), 1.0)


def _stick_zone_rule(
    c: np.ndarray, complement: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return a quadrature rule for integrals over r from 0 to c.

    The three arrays contain, at each node, the weight for d(eta), the root sqrt(1 - r^2), and the
    root sqrt(c^2 - r^2).

    The integration variable is eta, and r dr is minus the product of the two roots times d(eta).
    The argument `complement` is sqrt(1 - c^2). The roots are complement*cosh(eta) and
    complement*sinh(eta). The substitution resolves the thin layer at the edge for small amplitudes.
    The nodes of eta follow a squared sine, because the integrands contain half-integer powers at
    both ends.
    """
    # Smaller amplitudes change friction by less than the rounding error.
    complement = np.maximum(complement, 1e-8)
    end = np.arcsinh(c / complement)[..., None]
    nodes, weights = unit_rule(64)
    eta = end * np.sin(np.pi / 2 * nodes) ** 2
    step = end * np.pi / 2 * np.sin(np.pi * nodes) * weights
    return step, complement[..., None] * np.cosh(eta), complement[..., None] * np.sinh(eta)


_FASTEST = 1e6
"""Largest velocity of a steady bore. At this velocity, the friction 1 - 0.1/v^2 is within 1e-13 of
full friction. Hence a rounding error of 1e-16 in the force causes a relative change of 1e-3 in the
velocity."""


def transverse_drift(force: Numbers, amplitude: Numbers) -> Numbers:
    """Return the mean velocity of a rigid contact under transverse oscillation.

    The velocity is (2/pi) A P / sqrt(1 - P^2).

    Parameters
    ----------
    force : array_like
        Nonnegative force P, divided by mu F_z.
    amplitude : array_like
        Nonnegative amplitude A, in units of u_lim. The amplitude is broadcast against the force.

    Returns
    -------
    np.ndarray or float
        Velocity divided by omega u_lim. It is infinite for P >= 1, where friction cannot balance
        the force.

    Raises
    ------
    ValueError
        If an argument is out of range.
    """
    force, amplitude = checked("force", force), checked("amplitude", amplitude)
    lateral = np.sqrt(np.maximum(1.0 - force**2, 0.0))
    with np.errstate(divide="ignore"):
        return 2.0 / np.pi * amplitude * np.where(force < 1.0, force / lateral, np.inf)[()]


def bore_drift(force: Numbers, amplitude: Numbers) -> Numbers:
    """Return the mean velocity of a rigid contact under oscillating bore.

    In units of Omega phi0 a, the velocity is (2/pi) E^-1(P). Here E^-1 is the inverse of E, the
    friction of Eq 21 as a function of velocity. The result does not depend on the amplitude,
    because the unit is proportional to the amplitude. The function has the same arguments as
    `transverse_drift`, and raises the same exceptions. In addition, forces between 1 - 1e-13 and 1
    raise InputError.
    """
    steady = np.vectorize(_steady_bore, otypes=[float])(checked("force", force))
    return np.broadcast_arrays(2.0 / np.pi * steady, checked("amplitude", amplitude))[0].copy()


def _steady_bore(force: float) -> float:
    """Return the velocity of a steady bore with the forward friction `force` (inverse of Eq 21)."""
    if force >= 1.0:
        return np.inf
    if force > bore_forward(_FASTEST):
        allowed = "allowed are forces up to 1 - 1e-13, and forces of at least 1"
        raise InputError("force", float(force), allowed)
    return scipy.optimize.brentq(
        lambda velocity: float(bore_forward(velocity)) - force, 0.0, _FASTEST, xtol=1e-14
    )
