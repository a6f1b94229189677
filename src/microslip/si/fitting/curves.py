"""Model curves of a fit: the friction between the rows, at enough points for a figure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from microslip.si.fitting.friction_models import FrictionModel
from microslip.si.fitting.measured import Measured
from microslip.si.fitting.scales import Scale

PIECES = 60
"""Number of equally spaced points on a curve, and number of logarithmically spaced points.  A curve
drawn through these points looks smooth."""


class Curve(NamedTuple):
    """Points of all model curves of a fit, one curve after another.  Arrays have shape (n,).

    The abscissa is the condition with the most different values.  Rows that differ only in the
    abscissa share a curve if there are at least two.

    Attributes
    ----------
    speed_m_s, amplitude_si, frequency_Hz, row_load_N : np.ndarray
        The conditions, in the units of a Fit.
    fitted, fitted_error : np.ndarray
        Friction of the model, and its error estimate, in the unit of the measured values.
    """

    speed_m_s: np.ndarray
    amplitude_si: np.ndarray
    frequency_Hz: np.ndarray
    row_load_N: np.ndarray
    fitted: np.ndarray
    fitted_error: np.ndarray


def abscissa(conditions: Mapping[str, np.ndarray]) -> str:
    """Name of the condition with the most distinct values.  In a tie, it is the first of these
    conditions."""
    return max(conditions, key=lambda name: len(np.unique(conditions[name])))


def curve_of(scale: Scale, model: FrictionModel, mu: float, size: float) -> Curve:
    """Compute the model curves for the rows of a fit.

    Parameters
    ----------
    scale : Scale
        The second unknown, with the measured rows.
    model : FrictionModel
        The model, corrected at the best fit.
    mu, size : float
        Both unknowns at the best fit.
    """
    rows = scale.rows
    columns = {name: getattr(rows, name) for name in ("speed", "amplitude", "load", "frequency")}
    along = abscissa(columns)
    others = np.stack([values for name, values in columns.items() if name != along], axis=1)
    _, curve_of_row = np.unique(others, axis=0, return_inverse=True)
    # The correction of the coarse map is computed at the rows and interpolated between them.
    points = scale.points(mu, size)
    correction, error = model.at(points) - model.rough(points), model.errors(points)
    parts = [np.empty((6, 0))]
    for curve in np.unique(curve_of_row):
        members = np.flatnonzero(curve_of_row.reshape(-1) == curve)
        values, first = np.unique(columns[along][members], return_index=True)
        if len(values) < 2:
            continue
        members, axis = members[first], _axis(values)
        conditions = {name: np.full(len(axis), each[members[0]]) for name, each in columns.items()}
        conditions[along] = axis
        between = (np.interp(axis, values, part[members]) for part in (correction, error))
        parts.append(np.stack([*conditions.values(), *between]))
    speed, amplitude, load, frequency, correction, error = np.concatenate(parts, axis=1)
    blank = np.full(len(speed), np.nan)
    fine = Measured(speed, amplitude, frequency, load, blank, blank, rows.quantity, {})
    ratio = model.rough(scale.points(mu, size, fine)) + correction if len(speed) else blank
    factor = mu * fine.weight
    return Curve(speed, amplitude, frequency, load, factor * ratio, factor * error)


def _axis(values: np.ndarray) -> np.ndarray:
    """The sorted values, with additional equally and logarithmically spaced values between them."""
    least, most = values[values > 0.0][0], values[-1]
    even = np.linspace(values[0], most, PIECES), np.geomspace(least, most, PIECES)
    return np.unique(np.clip(np.concatenate([values, *even]), values[0], most))
