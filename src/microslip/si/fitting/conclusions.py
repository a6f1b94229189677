"""The result of a fit: intervals, undetermined unknowns and warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.dimensionless import MovingContact, RealMotion
from microslip.si.fitting import estimate
from microslip.si.fitting.curves import curve_of
from microslip.si.fitting.fitted import Fit
from microslip.si.fitting.scales import Modulus, Scale
from microslip.si.motions import MOTIONS
from microslip.si.validity import broken_assumptions, warnings_of

WIDEST_MU = 2.0
"""Largest allowed ratio between the upper and the lower end of the interval for mu."""
UNLIKELY = 0.01
"""Probability below which a sum of squares leads to a warning."""


def concluded(
    problem: estimate.LeastSquares,
    fits: Sequence[estimate.Best],
    *,
    motion: str,
    confidence: float,
    texts: dict,
) -> Fit:
    """The result of a fit.  Raises InputError if the rows do not determine mu.

    Parameters
    ----------
    problem : estimate.LeastSquares
        The rows and their model, corrected at the best fit.
    fits : sequence of estimate.Best
        The best fit, then the fits from other initial guesses.
    motion : str
        Name of the motion.
    confidence : float
        Confidence level of the intervals, 0 to 1.
    texts : dict of str
        Inputs as text.
    """
    best, scale, model, rows = fits[0], problem.scale, problem.model, problem.rows
    mu, size = np.exp(best.theta)
    points = scale.points(mu, size)
    model_error = mu * rows.weight * model.errors(points)
    if not np.isfinite(model_error).all():
        where = int(np.flatnonzero(~np.isfinite(model_error))[0]) + 1
        raise InputError("map", motion, f"has no friction for row {where} at the best fit")
    allowed = estimate.threshold(problem, best, confidence, model_error / problem.error)
    pairs = [(which, side) for which in (0, 1) for side in (-1.0, 1.0)]
    ends = np.array([estimate.end(problem, best, *pair, allowed) for pair in pairs]).reshape(2, 2)
    determined = [which for which in (0, 1) if np.isfinite(ends[which]).all()]
    shift = estimate.shifts(best, model_error / problem.error, determined)
    ends += np.outer(shift, (-1.0, 1.0))
    low, high = np.exp(ends[0])
    if not high < WIDEST_MU * low:
        fit = f"mu from {low:.3g} to {high:.3g} fits as well with another u_lim"
        hint = "add rows without vibration, or rows where vibration reduces friction more"
        message = f"the rows determine neither number: {fit}; {hint}"
        raise InputError("measured", rows.name, message)
    fitted = mu * rows.weight * model.at(points)
    free = len(fitted) - 2
    noise = problem.error if rows.has_errors else problem.error * math.sqrt(best.squares / free)
    chance = None
    if rows.has_errors and free:
        from scipy.stats import chi2

        chance = float(chi2.sf(best.squares, free))
    second = _second(scale, best, ends, shift, allowed if 1 in determined else None)
    warnings = _warnings(motion, scale, fits, allowed if 1 in determined else 0.0, chance)
    name = scale.name.replace(" ", "_")
    return Fit(
        motion=motion,
        quantity=rows.quantity,
        mu=float(mu),
        mu_low=float(low),
        mu_high=float(high),
        **second,
        load_N=scale.mean_load,
        confidence=confidence,
        mu_model_share=float(np.expm1(shift[0])),
        scale_model_share=float(np.expm1(shift[1])),
        standard_error=None if rows.has_errors else float(noise[0]),
        chi_square=best.squares if rows.has_errors else None,
        p_value=chance,
        degrees_of_freedom=free,
        told=("mu", name) if 1 in determined else ("mu",),
        reason="" if 1 in determined else _open(scale, np.exp(ends[1])),
        warnings=tuple(warnings),
        understood=texts,
        labels=rows.labels,
        left_out=rows.left_out,
        speed_m_s=rows.speed,
        amplitude_si=rows.amplitude,
        frequency_Hz=rows.frequency,
        row_load_N=rows.load,
        velocity=points.velocity,
        amplitude=points.amplitude,
        measured=rows.value,
        measured_error=rows.error,
        fitted=fitted,
        fitted_error=model_error,
        residual=np.divide(
            rows.value - fitted, noise, out=np.zeros_like(fitted), where=noise > 0.0
        ),
        curve=curve_of(scale, model, mu, size),
    )


def _second(
    scale: Scale, best: estimate.Best, ends: np.ndarray, shift: np.ndarray, allowed: float | None
) -> dict[str, float | None]:
    """Fields for u_lim and the shear modulus.

    allowed: threshold of the sum of squares; None if the rows do not determine the second unknown.
    """
    names = ("u_lim_m", "u_lim_low_m", "u_lim_high_m")
    moduli = ("shear_modulus_Pa", "shear_modulus_low_Pa", "shear_modulus_high_Pa")
    mu, size = np.exp(best.theta)
    fields = dict.fromkeys((*names, *moduli))
    values = [None if allowed is None else float(size)]
    values += [float(np.exp(end)) if np.isfinite(end) else None for end in ends[1]]
    if not isinstance(scale, Modulus):
        return fields | dict(zip(names, values, strict=True))
    fields |= dict(zip(moduli, values, strict=True))
    if allowed is not None:  # u_lim is proportional to mu G^(-2/3): ln u_lim is linear in theta
        direction = np.array([1.0, -2.0 / 3.0])
        covariance = np.linalg.inv(best.slopes.T @ best.slopes)
        half = math.sqrt(allowed * direction @ covariance @ direction) + np.abs(direction) @ shift
        u_lim = scale.u_lim(mu, size)
        three = (u_lim, u_lim * math.exp(-half), u_lim * math.exp(half))
        fields |= dict(zip(names, three, strict=True))
    return fields


def _open(scale: Scale, ends: np.ndarray) -> str:
    """The reason why the rows do not determine the second unknown.  ends: ends of the unknown's
    interval."""
    low, high = ends
    which = f"any {scale.name}"
    if low > 0.0:
        which += f" above {low:.3g} {scale.unit}"
    elif math.isfinite(high):
        which += f" below {high:.3g} {scale.unit}"
    return f"the rows determine mu alone: {which} fits them as well"


def _warnings(
    motion: str,
    scale: Scale,
    fits: Sequence[estimate.Best],
    allowed: float,
    chance: float | None,
) -> Iterator[str]:
    """Warnings about a fit.

    allowed: threshold of the sum of squares; 0 if the rows do not determine the second unknown.
    chance: probability of a larger sum of squares by chance; None if the errors are unknown.
    """
    best, *others = fits
    if chance is not None and chance < UNLIKELY:
        yield (
            f"the residuals are larger than the errors of the rows allow (p = {chance:.1g}): the "
            "theory does not describe these rows, or the errors are too small"
        )
    for other in others:
        apart = abs(other.theta[1] - best.theta[1])
        if other.squares < best.squares + allowed and apart > math.log(2.0):
            pair = np.exp(other.theta)
            text = f"mu {pair[0]:.3g} with {pair[1]:.3g} {scale.unit}"
            yield f"{text} fits nearly as well: two answers"
    mu = math.exp(best.theta[0])
    if not isinstance(scale, Modulus):
        yield from warnings_of({"mu": mu})
    else:
        rows = scale.rows
        widest = int(np.argmax(rows.amplitude))
        columns = (rows.speed, rows.amplitude, rows.frequency)
        speed, amplitude, frequency = (float(column[widest]) for column in columns)
        real_motion = RealMotion(motion, MOTIONS[motion].unit, speed, amplitude, frequency)
        contact = scale.contact(mu, math.exp(best.theta[1]))
        yield from broken_assumptions(MovingContact(contact, real_motion))
