"""From the best fit to what it tells: intervals, what is left open, what makes it doubtful."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.dimensionless import RealMotion
from microslip.si.fitting import estimate
from microslip.si.fitting.curves import curve_of
from microslip.si.fitting.fitted import Fit
from microslip.si.fitting.friction_models import FrictionModel
from microslip.si.fitting.scales import Modulus, Scale
from microslip.si.validity import broken_assumptions

TELLS_MU = 2.0
"""Ratio of both ends of an interval of mu from which on it tells nothing."""
UNLIKELY = 0.01
"""A sum of squares that is less likely than this is no chance."""


class Settled(NamedTuple):
    """A fit whose two numbers no longer change.

    Attributes
    ----------
    motion : str
        The motion.
    scale : Scale
        The second number.
    model : FrictionModel
        Anchored next to the best fit.
    rows : estimate.Rows
        What was fitted.
    best : estimate.Best
        The best fit.
    others : list of estimate.Best
        Others that were tried.
    """

    motion: str
    scale: Scale
    model: FrictionModel
    rows: estimate.Rows
    best: estimate.Best
    others: list


def concluded(settled: Settled, confidence: float, texts: dict) -> Fit:
    """The answer; raises InputError where not even mu is told.

    Parameters
    ----------
    confidence : float
        Confidence level of the intervals, 0 to 1.
    texts : dict of str
        What was asked.
    """
    scale, model, rows, best = settled.scale, settled.model, settled.rows, settled.best
    mu, size = np.exp(best.theta)
    points, measured = scale.points(mu, size), scale.rows
    model_error = mu * rows.weight * model.errors(points)
    if not np.isfinite(model_error).all():
        where = int(np.flatnonzero(~np.isfinite(model_error))[0]) + 1
        raise InputError(
            "map", settled.motion, f"knows no friction for row {where} at the best fit"
        )
    allowed = estimate.threshold(rows, best, confidence, model_error / rows.error)
    ends = np.array([estimate.interval(rows, best, which, allowed) for which in (0, 1)])
    told = [which for which in (0, 1) if np.isfinite(ends[which]).all()]
    moved = estimate.shifts(best, model_error / rows.error, told)
    ends += np.outer(moved, (-1.0, 1.0))
    _refuse_mu_untold(ends[0])
    fitted = mu * rows.weight * model.at(points)
    free = len(fitted) - 2
    noise = rows.error if rows.absolute else rows.error * math.sqrt(best.squares / free)
    chance = _chance(best.squares, free) if rows.absolute and free else None
    second = _second(settled, ends, moved, allowed if 1 in told else None)
    name = scale.name.replace(" ", "_")
    return Fit(
        motion=settled.motion,
        quantity=measured.quantity,
        mu=float(mu),
        mu_low=float(np.exp(ends[0, 0])),
        mu_high=float(np.exp(ends[0, 1])),
        **second,
        load_N=scale.mean_load,
        confidence=confidence,
        mu_model_share=float(np.expm1(moved[0])),
        scale_model_share=float(np.expm1(moved[1])),
        standard_error=None if rows.absolute else float(noise[0]),
        chi_square=best.squares if rows.absolute else None,
        p_value=chance,
        degrees_of_freedom=free,
        told=("mu", name) if 1 in told else ("mu",),
        reason="" if 1 in told else _open(scale, np.exp(ends[1])),
        warnings=tuple(_warnings(settled, allowed if 1 in told else 0.0, chance)),
        understood=texts,
        labels=measured.labels,
        left_out=measured.left_out,
        speed_m_s=measured.speed,
        amplitude_si=measured.amplitude,
        frequency_Hz=measured.frequency,
        row_load_N=measured.load,
        velocity=points.velocity,
        amplitude=points.amplitude,
        measured=measured.value,
        measured_error=measured.error,
        fitted=fitted,
        fitted_error=model_error,
        residual=np.divide(
            rows.value - fitted, noise, out=np.zeros_like(fitted), where=noise > 0.0
        ),
        curve=curve_of(scale, model, mu, size),
    )


def _refuse_mu_untold(ends: np.ndarray) -> None:
    low, high = np.exp(ends)
    if not high < TELLS_MU * low:
        fits = f"mu from {low:.3g} to {high:.3g} fits as well with another u_lim"
        allowed = f"the rows tell neither number: {fits}; rows without vibration, or where more "
        raise InputError("measured", None, f"{allowed}friction falls, would tell")


def _chance(squares: float, free: int) -> float:
    from scipy.stats import chi2

    return float(chi2.sf(squares, free))


def _second(
    settled: Settled, ends: np.ndarray, moved: np.ndarray, allowed: float | None
) -> dict[str, float | None]:
    """Fields of u_lim and of the shear modulus; allowed: of the sum of squares, None: not told."""
    scale, best, told = settled.scale, settled.best, allowed is not None
    names = ("u_lim_m", "u_lim_low_m", "u_lim_high_m")
    moduli = ("shear_modulus_Pa", "shear_modulus_low_Pa", "shear_modulus_high_Pa")
    mu, size = np.exp(best.theta)
    found = dict.fromkeys((*names, *moduli))
    values = [float(size) if told else None]
    values += [float(np.exp(end)) if np.isfinite(end) else None for end in ends[1]]
    if not isinstance(scale, Modulus):
        return found | dict(zip(names, values, strict=True))
    found |= dict(zip(moduli, values, strict=True))
    if told:  # u_lim goes like mu G^(-2/3), and so do their logarithms
        direction = np.array([1.0, -2.0 / 3.0])
        spread = np.linalg.inv(best.slopes.T @ best.slopes)
        half = math.sqrt(allowed * direction @ spread @ direction) + np.abs(direction) @ moved
        u_lim = scale.u_lim(mu, size)
        three = (u_lim, u_lim * math.exp(-half), u_lim * math.exp(half))
        found |= dict(zip(names, three, strict=True))
    return found


def _open(scale: Scale, ends: np.ndarray) -> str:
    """Why the second number is not told."""
    what = scale.name
    low, high = ends
    which = f"any {what}"
    if low > 0.0:
        which += f" above {low:.3g} {scale.unit}"
    elif math.isfinite(high):
        which += f" below {high:.3g} {scale.unit}"
    return f"the rows tell mu alone: {which} fits them as well"


def _warnings(settled: Settled, allowed: float, chance: float | None) -> Iterator[str]:
    """Texts; allowed: of the sum of squares, 0 where one number is open anyway."""
    scale, best = settled.scale, settled.best
    if chance is not None and chance < UNLIKELY:
        yield (
            f"the residuals are larger than the errors of the rows allow (p = {chance:.1g}): the "
            "theory does not describe these rows, or the errors are too small"
        )
    for other in settled.others:
        apart = abs(other.theta[1] - best.theta[1])
        if other.squares < best.squares + allowed and apart > math.log(TELLS_MU):
            mu, size = np.exp(other.theta)
            yield f"mu {mu:.3g} with {size:.3g} {scale.unit} fits nearly as well: two answers"
    if isinstance(scale, Modulus):
        rows, mu = scale.rows, math.exp(best.theta[0])
        widest = int(np.argmax(rows.amplitude))
        sizes = (rows.speed[widest], rows.amplitude[widest], rows.frequency[widest])
        motion = RealMotion(settled.motion, *(float(size) for size in sizes))
        yield from broken_assumptions(scale.contact(mu, math.exp(best.theta[1])), motion)
