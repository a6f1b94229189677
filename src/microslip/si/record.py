"""One period of a motion from a long record, such as that of a laser vibrometer.

A record contains many periods, noise, and a slow drift.  The drift is the moving mean over one
period.  For a periodic motion it is constant.  The difference from the drift is averaged over all
whole periods.  The scatter between the periods gives the standard error of the average.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from microslip.foundation.arguments import count, real
from microslip.foundation.errors import InputError
from microslip.motions.samples import FEWEST_SAMPLES, NORMAL, uneven_row

FEWEST_PERIODS = 4
"""Smallest number of periods in a record.  Half a period is lost at each end."""
ROWS, MOST_ROWS = 32, 10_000
"""Default and largest number of samples in the period.  More samples keep more harmonics, and more
noise."""
REFINEMENTS = 3
"""Number of corrections of the frequency.  After each correction, only the error of the phases
remains."""
JITTER = 0.4
"""Largest allowed deviation of a time from equal spacing, divided by the spacing.  Exported times
are rounded.  A missing sample, however, shifts some times by at least half a spacing."""
TREND = 3
"""Degree of the polynomial that is subtracted before the search for the frequency."""
SLOWEST = 3
"""Smallest number of periods per record in the search for the frequency."""


@dataclass(frozen=True, eq=False)
class Fold:
    """The mean period of a record.

    Attributes
    ----------
    frequency, frequency_error : float
        Frequency and its standard error.  The unit is one over the unit of the times.
    periods : int
        Number of averaged periods.
    columns : dict of str to np.ndarray, shape (rows,)
        The mean period, without its end point.  Displacements are relative to their mean.
    errors : dict of str to np.ndarray, shape (rows,)
        Standard error of each sample of `columns`, from the scatter between the periods.
    drift : dict of str to float
        Mean rate of the slow drift of each column.
    """

    frequency: float
    frequency_error: float
    periods: int
    columns: dict[str, np.ndarray]
    errors: dict[str, np.ndarray]
    drift: dict[str, float]

    @property
    def time(self) -> np.ndarray:
        """Times of the samples, (rows,)."""
        rows = len(next(iter(self.columns.values())))
        return np.arange(rows) / (rows * self.frequency)


def fold(
    time: Any, columns: Mapping[str, Any], *, frequency: float | None = None, rows: int = ROWS
) -> Fold:
    """Average a record over its periods, without its slow drift.

    Parameters
    ----------
    time : array_like, shape (samples,)
        Equally spaced times.
    columns : mapping of array_like, shape (samples,)
        Columns forward, lateral, angle, load and indentation, in any units.
    frequency : float or None
        Approximate frequency, which is refined.  Over the whole record, its error must be less than
        half a period.  The default is the frequency of the strongest component.
    rows : int
        Number of samples in the period, an even number.  Harmonics up to the order rows / 2 - 1 are
        kept.

    Returns
    -------
    Fold

    Raises
    ------
    InputError
        If an argument is invalid, or if the record has fewer than FEWEST_PERIODS periods.
    """
    rows = count("rows", rows, 2 * FEWEST_SAMPLES, most=MOST_ROWS, even=True)
    step, values = _checked(time, columns)
    samples = len(next(iter(values.values())))
    longest = (samples - 1) * step
    if frequency is None:
        frequency = _strongest(values) / (samples * step)
    else:
        frequency = real("frequency", frequency, 0.0)
    if not FEWEST_PERIODS <= frequency * longest <= 0.25 * samples:
        allowed = f"allowed are {FEWEST_PERIODS} periods or more, of at least 4 samples each, in "
        raise InputError("frequency", frequency, f"{allowed}a record of {longest:.6g}")
    splines = {name: _spline(step, one) for name, one in values.items()}
    error = math.inf
    for _ in range(REFINEMENTS):
        harmonics = {n: _harmonics(s, frequency, longest, step, rows) for n, s in splines.items()}
        change, error = _correction(harmonics)
        frequency += change * frequency
    mean, errors, drift = {}, {}, {}
    for name, spline in splines.items():
        periods = np.fft.irfft(_harmonics(spline, frequency, longest, step, rows), rows) * rows
        mean[name] = periods.mean(axis=0)
        errors[name] = periods.std(axis=0, ddof=1) / math.sqrt(len(periods))
        integral, half = spline.antiderivative(), 0.5 / frequency
        ends = [_moving_mean(integral, one, half) for one in (half, longest - half)]
        drift[name] = float((ends[1] - ends[0]) / (longest - 2.0 * half))
        if name in NORMAL:
            mean[name] += values[name].mean()
    return Fold(frequency, error * frequency, len(periods), mean, errors, drift)


def _checked(time: Any, columns: Mapping[str, Any]) -> tuple[float, dict[str, np.ndarray]]:
    """Return the time step and the columns as arrays.  Raises InputError."""
    values = {}
    for name, one in {"time": time, **columns}.items():
        try:
            values[name] = np.array(one, float)
        except (TypeError, ValueError):
            raise InputError(name, one, "allowed is an array of numbers") from None
        if values[name].ndim != 1 or len(values[name]) != len(values["time"]):
            allowed = f"allowed are as many numbers as times: {len(values['time'])}"
            raise InputError(name, values[name].shape, allowed)
        if not np.isfinite(values[name]).all():
            raise InputError(name, math.nan, "allowed are finite numbers")
    time = values.pop("time")
    if not values:
        raise InputError("columns", None, "allowed is one column or more")
    if len(time) < 4 * FEWEST_PERIODS:
        raise InputError("time", len(time), f"allowed are at least {4 * FEWEST_PERIODS} samples")
    row = uneven_row(time, JITTER)
    if row is not None:
        raise InputError("time", float(time[row]), f"not equally spaced; this is row {row}")
    return float(time[-1] - time[0]) / (len(time) - 1), values


def _strongest(values: Mapping[str, np.ndarray]) -> float:
    """Number of periods of the strongest component, from the record's spectrum."""
    power = 0.0
    for one in values.values():
        x = np.linspace(-1.0, 1.0, len(one))
        rest = one - np.polynomial.Polynomial.fit(x, one, TREND)(x)
        if rest.any():
            spectrum = np.abs(np.fft.rfft(rest * np.hanning(len(one)))) ** 2
            power = power + spectrum / spectrum.sum()
    if not np.any(power):
        raise InputError("columns", 0.0, "constant; allowed is an oscillation")
    first, height = SLOWEST + int(np.argmax(power[SLOWEST:])), np.sqrt(power)  # type: ignore[index]
    low, top, high = (height[min(n, len(height) - 1)] for n in (first - 1, first, first + 1))
    curve = low - 2.0 * top + high
    return first + (0.5 * (low - high) / curve if curve else 0.0)


def _spline(step: float, values: np.ndarray) -> Any:
    from scipy.interpolate import CubicSpline  # only here: it takes a while to load

    return CubicSpline(step * np.arange(len(values)), values - values.mean())


def _moving_mean(integral: Any, time: np.ndarray | float, half: float) -> Any:
    """Mean from half a period before a time to half a period after it."""
    return (integral(time + half) - integral(time - half)) / (2.0 * half)


def _harmonics(spline: Any, frequency: float, longest: float, step: float, rows: int) -> np.ndarray:
    """Fourier coefficients of each whole period without the drift, shape (periods, rows / 2 + 1).

    The coefficient of the order rows / 2 is 0.
    """
    periods = int(frequency * longest * (1.0 + 1e-12)) - 1
    points = max(rows, math.ceil(1.0 / (frequency * step)))
    phase = np.arange(periods)[:, None] + np.arange(points) / points
    time = (0.5 + phase) / frequency
    rest = spline(time) - _moving_mean(spline.antiderivative(), time, 0.5 / frequency)
    coefficients = np.fft.rfft(rest, axis=1)[:, : rows // 2 + 1] / points
    coefficients[:, -1] = 0.0
    return coefficients


def _correction(harmonics: Mapping[str, np.ndarray]) -> tuple[float, float]:
    """Return the relative correction of the frequency, and the standard error of the correction.

    Both follow from the phases of the strongest harmonic.
    """
    powers = {name: np.mean(np.abs(one) ** 2, axis=0) for name, one in harmonics.items()}
    shares = {name: one / (one.sum() or 1.0) for name, one in powers.items()}
    name = max(shares, key=lambda one: shares[one].max())
    order = int(np.argmax(shares[name][1:])) + 1
    if not powers[name][order] > 0.0:
        raise InputError("columns", 0.0, "constant; allowed is an oscillation")
    turns = np.unwrap(np.angle(harmonics[name][:, order])) / (2.0 * np.pi * order)
    place = np.arange(len(turns)) - 0.5 * (len(turns) - 1)
    spread = float(np.sum(place**2))
    slope = float(np.sum(place * turns)) / spread
    rest = turns - turns.mean() - slope * place
    return slope, math.sqrt(float(np.sum(rest**2)) / max(len(turns) - 2, 1) / spread)
