"""The model curve of a fit: friction between the rows, on an axis fine enough to draw."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from microslip.si.fitting.friction_models import FrictionModel
from microslip.si.fitting.measured import Measured
from microslip.si.fitting.scales import Scale

PIECES = 96
"""Approximate number of points of a curve, enough for a figure of 1000 pixels."""


class Curve(NamedTuple):
    """Points of the model curves of a fit, one curve after another, shape (n,) each.

    The abscissa is the condition with the most values.  At least two rows with equal other
    conditions share a curve.

    Attributes
    ----------
    speed_m_s, amplitude_si, frequency_Hz, row_load_N : np.ndarray
        The conditions, as for the rows of a Fit.
    fitted, fitted_error : np.ndarray
        Friction of the model and its error estimate, in the unit of the rows.
    """

    speed_m_s: np.ndarray
    amplitude_si: np.ndarray
    frequency_Hz: np.ndarray
    row_load_N: np.ndarray
    fitted: np.ndarray
    fitted_error: np.ndarray


def abscissa(conditions: Mapping[str, np.ndarray]) -> str:
    """Name of the condition with the most values; the first one of equals."""
    return max(conditions, key=lambda name: len(np.unique(conditions[name])))


def curve_of(scale: Scale, model: FrictionModel, mu: float, size: float) -> Curve:
    """The model curves through the rows of a fit.

    Parameters
    ----------
    scale : Scale
        The second unknown, with the rows.
    model : FrictionModel
        Model, anchored at the best fit.
    mu, size : float
        Both unknowns at the best fit.
    """
    rows = scale.rows
    columns = {name: getattr(rows, name) for name in ("speed", "amplitude", "load", "frequency")}
    along = abscissa(columns)
    others = np.stack([values for name, values in columns.items() if name != along], axis=1)
    _, kinds = np.unique(others, axis=0, return_inverse=True)
    # The correction of the coarse map is known at the rows, and interpolated between them.
    at_rows = scale.points(mu, size)
    off, error = model.at(at_rows) - model.rough(at_rows), model.errors(at_rows)
    parts = []
    for kind in np.unique(kinds):
        chosen = np.flatnonzero(kinds.reshape(-1) == kind)
        _, first = np.unique(columns[along][chosen], return_index=True)
        chosen = chosen[first]  # in the order of the abscissa
        if len(chosen) < 2:
            continue
        place = np.linspace(0, len(chosen) - 1, _count(len(chosen)))
        fine = {name: np.full(len(place), values[chosen[0]]) for name, values in columns.items()}
        fine[along] = _between(columns[along][chosen], place)
        known = np.arange(len(chosen))
        corrections = (np.interp(place, known, part[chosen]) for part in (off, error))
        parts.append(np.stack([*(fine[name] for name in columns), *corrections]))
    speed, amplitude, load, frequency, off, error = np.concatenate([np.empty((6, 0)), *parts], 1)
    blank = np.full(len(speed), np.nan)
    drawn = Measured(speed, amplitude, frequency, load, blank, blank, rows.quantity, {})
    ratio = model.rough(scale.points(mu, size, drawn)) + off if len(speed) else blank
    factor = mu * drawn.weight
    return Curve(speed, amplitude, frequency, load, factor * ratio, factor * error)


def _count(rows: int) -> int:
    """Number of points of a curve through a number of rows, including the rows."""
    return 1 + (rows - 1) * -(-PIECES // (rows - 1))


def _between(values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values at fractional indices: geometric interpolation between positive neighbours, else
    linear."""
    cell = np.clip(place.astype(int), 0, len(values) - 2)
    share, low, high = place - cell, values[cell], values[cell + 1]
    ratio = np.divide(high, low, out=np.ones_like(low), where=low > 0.0)
    even = np.where(low > 0.0, low * ratio**share, low + share * (high - low))
    return np.where(share == 0.0, low, np.where(share == 1.0, high, even))
