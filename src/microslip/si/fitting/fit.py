"""Fit mu, and u_lim or the shear modulus, to the measured friction of a contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from microslip.foundation.arguments import SMALLEST_TOLERANCE
from microslip.foundation.errors import InputError
from microslip.si.fitting import estimate
from microslip.si.fitting.conclusions import concluded
from microslip.si.fitting.fitted import Fit
from microslip.si.fitting.friction_models import FrictionModel, MapFriction, SolvedFriction
from microslip.si.fitting.measured import Measured, read_measured
from microslip.si.fitting.scales import Modulus, Scale
from microslip.si.inputs import read_argument
from microslip.si.motions import FIT_MOTIONS
from microslip.si.quantities import read

TOLERANCE, LARGEST_TOLERANCE = 1e-3, 0.02
"""Default and largest allowed tolerance of mu_macro in the solver."""
CONFIDENCE = 0.95
"""Default confidence level of the intervals."""
MOST_PASSES = 6
"""Largest number of fits.  The model is corrected before each fit."""
SETTLED = 5e-4
"""Convergence criterion: the largest relative change of both numbers between two fits."""


def fit(
    motion: str,
    measured: object,
    *,
    map: object = None,
    speed: object = None,
    amplitude: object = None,
    frequency: object = None,
    load: object = None,
    nu: object = None,
    radius: object = None,
    counterbody: object = None,
    confidence: object = None,
    tolerance: object = None,
    decimal: str = ".",
    encoding: str = "utf-8",
) -> Fit:
    """Fit mu, and u_lim or the shear modulus, to measured friction.

    Without a radius, the unknowns are mu and u_lim, and Poisson's ratio is the only property of the
    bodies.  With a radius, the unknowns are mu and the shear modulus.  In both cases, Hertz's
    theory gives the dependence on the load.

    Parameters
    ----------
    motion : str
        "transverse", "longitudinal" or "zigzag".
    measured : path, mapping or pandas DataFrame
        A CSV file with a heading line such as `speed [mm/s],amplitude [um],friction [N]`, or
        columns with such names.  Columns without a unit are in SI units.  The columns are speed,
        amplitude, frequency, load; friction (mean forward force) or mu (friction divided by load);
        optionally their standard errors friction_error or mu_error, and texts named label, name,
        id, sample or comment.
    map : xarray.Dataset, optional
        Dataset of a sweep of this motion; see `open_map`.  Interpolation in a map is fast.
        Without a map, the solver computes every point.
    speed, amplitude, frequency, load : quantity, optional
        Common value for all rows.  It replaces a column.
    nu : quantity, optional
        Poisson's ratio of the equivalent half-space.  The default is the map's Poisson's ratio, or
        0 without a map.  With a radius, `nu` is Poisson's ratio of the bodies and is required.
    radius : quantity, optional
        Radius of relative curvature, m.  For a sphere on a flat, this is the sphere's radius.
    counterbody : str, optional
        Only with a radius.  The counterbody is "rigid" (default), or "same" for the material of
        the first body.
    confidence : quantity, optional
        Confidence level of the intervals, default 0.95.
    tolerance : quantity, optional
        Largest accepted error of mu_macro in the solver, default 1e-3.
    decimal, encoding : str
        The decimal mark of the file, "." or ",", and its encoding, such as "cp1252".

    Returns
    -------
    Fit
        Both numbers with intervals.  If the rows determine only mu, the fit contains mu, and the
        reason why the other number is missing.

    Raises
    ------
    InputError
        If the table cannot be read, if it has too few rows or a single condition, or if the rows do
        not determine mu.
    """
    if not isinstance(motion, str) or motion not in FIT_MOTIONS:
        raise InputError("motion", motion, f"allowed is one of {', '.join(FIT_MOTIONS)}")
    shared = {"speed": speed, "amplitude": amplitude, "frequency": frequency, "load": load}
    rows = read_measured(motion, measured, decimal=decimal, encoding=encoding, **shared)
    _refuse_undetermined(rows)
    scale, texts = _scale(motion, rows, nu, radius, counterbody)
    accepted = CONFIDENCE if confidence is None else read("confidence", confidence, "").si
    if accepted >= 1.0:
        allowed = "allowed is a number above 0 and below 1, such as 0.95 or '95 %'"
        raise InputError("confidence", confidence, allowed)
    if map is not None:
        model: FrictionModel = MapFriction(map, motion, None if nu is None else scale.poisson)
    else:
        limits: dict[str, Any] = {"low": SMALLEST_TOLERANCE, "high": LARGEST_TOLERANCE}
        accuracy = TOLERANCE if tolerance is None else tolerance
        allowed_error = read("tolerance", accuracy, "", low_open=False, **limits).si
        extremes = [scale.points(0.3, end) for end in scale.bounds]
        model = SolvedFriction(motion, scale.poisson, allowed_error, extremes)
    problem = estimate.LeastSquares(scale, model)
    texts |= rows.texts
    return concluded(problem, _fits(problem), motion=motion, confidence=accepted, texts=texts)


def _refuse_undetermined(rows: Measured) -> None:
    least, count = 2 if rows.has_errors else 3, len(rows.value)
    if count < least:
        more = "" if rows.has_errors else ", or two with errors of their own"
        allowed = f"{count} row{'s' if count > 1 else ''}; two numbers take at least {least}{more}"
        raise InputError("measured", rows.name, allowed)
    if (rows.value <= 0.0).all():
        negative = int((rows.value < 0.0).sum())
        allowed = f"the rows determine neither number: {rows.quantity} is 0 in all rows"
        if negative:
            allowed = (
                f"{rows.quantity} is negative in {negative} of {count} rows, and above 0 in none; "
            )
            allowed += "allowed is a positive sign for a force against the motion"
        raise InputError("measured", rows.name, allowed)
    if rows.distinct < 2:
        allowed = "all rows are of one condition; allowed: two or more conditions"
        raise InputError("measured", rows.name, allowed)


def _scale(
    motion: str, rows: Measured, nu: object, radius: object, counterbody: object
) -> tuple[Scale, dict[str, str]]:
    """The second unknown, and its inputs as text."""
    texts = {"motion": motion}
    ratio = None if nu is None else read_argument("nu", nu)
    if ratio is not None:
        texts["nu"] = ratio.text
    if radius is None:
        if counterbody is not None:
            raise InputError("counterbody", counterbody, "allowed with a radius")
        return Scale(rows, 0.0 if ratio is None else ratio.si), texts
    if ratio is None:
        raise InputError("nu", None, "needed with a radius")
    if counterbody not in (None, "rigid", "same"):
        raise InputError("counterbody", counterbody, "allowed is rigid or same")
    texts["counterbody"] = "rigid (default)" if counterbody is None else counterbody
    size = read_argument("radius", radius)
    texts["radius"] = size.text
    return Modulus(rows, ratio.si, counterbody == "same", size.si), texts


def _fits(problem: estimate.LeastSquares) -> list[estimate.Best]:
    """The best fit, followed by the fits from other initial guesses.  The model is corrected at the
    best fit."""
    fits = [estimate.best_near(problem, start) for start in estimate.starts(problem)]
    best, *others = sorted(fits, key=lambda one: one.squares)
    for _ in range(MOST_PASSES):
        problem.model.anchor(problem.scale.points(*np.exp(best.theta)))
        last, best = best, estimate.best_near(problem, best.theta)
        if np.abs(best.theta - last.theta).max() <= SETTLED:
            break
    return [best, *others]
