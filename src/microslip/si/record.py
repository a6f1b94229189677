"""One period of a motion from a long record, such as that of a laser vibrometer.

A record contains many periods, noise, and a slow drift.  The drift is the moving mean over one
period.  For a periodic motion it is constant.  The difference from the drift is averaged over all
whole periods.  The scatter between the periods gives the standard error of the average.

If the frequency drifts, the periods are averaged out of phase, and the average is too small.  The
covariance of the phases of neighbouring periods is the variance of this slow phase drift, because
the noise of neighbouring periods is uncorrelated.  The average of the harmonic m is smaller by the
factor exp(-x), where x is half of the variance of m times the phase.  This loss is part of the
error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from microslip.foundation.arguments import count, real
from microslip.foundation.errors import InputError
from microslip.motions.from_file import COLUMNS, EVEN
from microslip.motions.samples import FEWEST_SAMPLES, NORMAL, uneven_row

FEWEST_PERIODS = 4
"""Smallest number of periods in a record.  Half a period is lost at each end."""
ROWS, MOST_ROWS = 32, 10_000
"""Default and largest number of samples in the period.  More samples keep more harmonics, and more
noise."""
REFINEMENTS = 3
"""Number of corrections of the frequency.  After each correction, only the error of the phases
remains."""
FEWEST_PER_PERIOD = 4
"""Smallest number of samples in a period of the record."""
PERIODIC = 0.5
"""Smallest amplitude in a quarter of the record, divided by the largest one of a quarter.  A motion
with a smaller ratio is not periodic throughout."""
QUARTERS = 4
"""Number of parts of the record whose amplitudes are compared."""
MOST_DECIMALS = 12
"""Largest number of decimals of times that count as rounded.  More decimals need no allowance."""
LARGEST_LOSS = 0.01
"""Largest relative loss of the strongest harmonic by a drift of the frequency.  The estimate of the
loss is of first order, so it is correct for small losses only."""
SIGNIFICANT = 5.0
"""Smallest ratio of the peak-to-peak value to its standard error.  White noise at the frequency of
its strongest component reaches about 3."""
PHASE_OF_A_DRIFT = 0.5 * math.sqrt(1.0 / 80.0 - 1.0 / 144.0)
"""Standard deviation of the phase, in periods, for a frequency that changes linearly by one period
per duration of the record: that of u**2 / 2 for u from -1/2 to 1/2."""
FINER = 32
"""Number of interpolated points per sample for the peak-to-peak value.  With 32 samples, the peak
of a sine is too small by at most 5e-6 of its amplitude."""
CONSTANT = 1e-12
"""Largest variation of a constant column, divided by its largest value: rounding errors."""
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
        Frequency and its standard error, Hz.
    periods : int
        Number of averaged periods.
    columns : dict of str to np.ndarray, shape (rows,)
        The mean period, without its end point.  Displacements are relative to their mean.
    errors : dict of str to np.ndarray, shape (rows,)
        Standard error of each sample of `columns`, from the scatter between the periods, plus the
        loss of amplitude by a drift of the frequency.
    drift : dict of str to float
        Mean rate of the slow drift of each column, per second.
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

    def peak_to_peak(self, name: str) -> tuple[float, float]:
        """Peak to peak value of a column between its samples, too, and its standard error.

        The standard error is twice the largest one of a sample, which is an upper bound.
        """
        values = self.columns[name]
        fine = np.fft.irfft(np.fft.rfft(values), FINER * len(values)) * FINER
        return float(np.ptp(fine)), 2.0 * float(np.max(self.errors[name]))


def fold(
    time: Any, columns: Mapping[str, Any], *, frequency: float | None = None, rows: int = ROWS
) -> Fold:
    """Average a record over its periods, without its slow drift.

    Parameters
    ----------
    time : array_like, shape (samples,)
        Equally spaced times, s.  Each time may be rounded to its last digit.
    columns : mapping of array_like, shape (samples,)
        Columns forward, lateral, angle, and load or indentation, in any units.
    frequency : float or None
        Approximate frequency, Hz, which is refined.  Over the whole record, its error must be less
        than half a period.  The default is the frequency of the strongest component.
    rows : int
        Number of samples in the period, an even number.  Harmonics up to the order rows / 2 - 1 are
        kept.

    Returns
    -------
    Fold

    Raises
    ------
    InputError
        If an argument is invalid, if the record has fewer than FEWEST_PERIODS periods, if its
        frequency drifts, or if its oscillation is not larger than the noise.
    """
    rows = count("rows", rows, 2 * FEWEST_SAMPLES, most=MOST_ROWS, even=True)
    step, values = _checked(time, columns)
    samples = len(next(iter(values.values())))
    longest = (samples - 1) * step
    typed = frequency is not None
    if frequency is None:
        frequency = _strongest(values) / (samples * step)
    else:
        frequency = real("frequency", frequency, 0.0)
    _check_periods(frequency, longest, step, typed)
    splines = {name: _spline(step, one) for name, one in values.items()}
    error, variance, order = math.inf, 0.0, 1
    for _ in range(REFINEMENTS):
        harmonics = {n: _harmonics(s, frequency, longest, step, rows) for n, s in splines.items()}
        change, error, variance, order = _correction(harmonics)
        frequency += change * frequency
        _check_periods(frequency, longest, step, typed)
    mean, scatter, lost, drift = {}, {}, {}, {}
    for name, spline in splines.items():
        harmonic = _harmonics(spline, frequency, longest, step, rows)
        periods = np.fft.irfft(harmonic, rows) * rows
        mean[name] = periods.mean(axis=0)
        loss = -np.expm1(-_exponent(variance, np.arange(harmonic.shape[1])))
        lost[name] = np.fft.irfft(loss * harmonic.mean(axis=0), rows) * rows
        scatter[name] = periods.std(axis=0, ddof=1) / math.sqrt(len(periods))
        integral, half = spline.antiderivative(), 0.5 / frequency
        ends = [_moving_mean(integral, one, half) for one in (half, longest - half)]
        drift[name] = float((ends[1] - ends[0]) / (longest - 2.0 * half))
        if name in NORMAL:
            mean[name] += values[name].mean()
    result = Fold(frequency, error * frequency, len(periods), mean, scatter, drift)
    _check_throughout(harmonics, longest, order)
    _check_noise(result)  # first, since the phases of noise look like a drift
    _check_drift(frequency, longest, variance, order)
    return replace(result, errors={n: one + np.abs(lost[n]) for n, one in scatter.items()})


def _check_periods(frequency: float, longest: float, step: float, typed: bool) -> None:
    """Raise InputError if the record has too few periods, or too few samples in a period."""
    periods, samples = frequency * longest, 1.0 / max(frequency * step, 1e-300)
    if periods >= FEWEST_PERIODS and samples >= FEWEST_PER_PERIOD:
        return
    if periods < FEWEST_PERIODS:
        problem = f"the record of {longest:.6g} s has {periods:.6g} periods"
        allowed = f"allowed are at least {FEWEST_PERIODS}"
    else:
        problem = f"a period has {samples:.3g} samples in steps of {step:.6g} s"
        allowed = f"allowed are at least {FEWEST_PER_PERIOD}"
    if typed:
        raise InputError("frequency", float(f"{frequency:.6g}"), f"{problem}; {allowed}")
    where = f"at {frequency:.6g} Hz, the strongest component, {problem}"
    hint = "if this is not the frequency of the motion, give its approximate frequency"
    raise InputError("time", float(f"{longest:.6g}"), f"{where}; {allowed}; {hint}")


def _exponent(variance: float, order: Any) -> Any:
    """Return x, where exp(-x) is the factor of the averaged harmonic for this variance of the
    phase, in periods squared."""
    return 0.5 * (2.0 * np.pi * order) ** 2 * variance


def _check_drift(frequency: float, longest: float, variance: float, order: int) -> None:
    """Raise InputError if the frequency drifts so much that the periods are out of phase."""
    loss = float(_exponent(variance, order))
    if loss <= LARGEST_LOSS:
        return
    change = math.sqrt(variance) / (PHASE_OF_A_DRIFT * longest)
    most = change * math.sqrt(LARGEST_LOSS / loss)
    problem = f"the frequency changes by about {change:.2g} Hz during the record of {longest:.6g} s"
    allowed = f"allowed are {most:.2g} Hz at this length; cut the record into shorter ones"
    raise InputError("time", float(f"{longest:.6g}"), f"{problem}; {allowed}")


def _check_throughout(harmonics: Mapping[str, np.ndarray], longest: float, order: int) -> None:
    """Raise InputError if the oscillation begins, ends, or changes its size a lot."""
    power = sum(
        np.abs(one[:, order]) ** 2 / np.mean(np.abs(one) ** 2) for one in harmonics.values()
    )
    parts = np.array_split(np.sqrt(power), QUARTERS)
    sizes = [float(np.median(one)) for one in parts]
    if min(sizes) >= PERIODIC * max(sizes):
        return
    share = 100.0 * min(sizes) / max(sizes)
    problem = (
        f"not periodic throughout: in quarter {int(np.argmin(sizes)) + 1} of the record of "
        f"{longest:.6g} s, the oscillation is only {share:.2g} % as large as in quarter "
        f"{int(np.argmax(sizes)) + 1}; allowed is a steady oscillation; cut off the rest"
    )
    raise InputError("time", float(f"{longest:.6g}"), problem)


def _check_marks(name: str, values: np.ndarray) -> None:
    """Raise InputError for a value that is repeated exactly and lies far outside of all others."""
    levels, counts = np.unique(values, return_counts=True)
    if len(levels) <= QUARTERS:  # a motion with few levels
        return
    inner = levels[-2] - levels[1]
    ends = ((levels[0], counts[0], levels[1]), (levels[-1], counts[-1], levels[-2]))
    for level, number, other in ends:
        if number > 1 and abs(level - other) > inner:
            problem = f"stands in {number} rows, far outside of all others, from {other:.6g} on"
            allowed = "allowed are measured values; such a value often marks a missing sample"
            raise InputError(name, float(level), f"{problem}; {allowed}")


def _check_noise(result: Fold) -> None:
    """Raise InputError if no column has an oscillation that is larger than its noise."""
    sizes = {name: result.peak_to_peak(name) for name in result.columns}
    name = max(sizes, key=lambda one: sizes[one][0] / (sizes[one][1] or 1e-300))
    size, error = sizes[name]
    if size > SIGNIFICANT * error:
        return
    problem = (
        f"peak to peak at {result.frequency:.6g} Hz, only {size / (error or 1e-300):.2g} times its "
        f"standard error; allowed is at least {SIGNIFICANT:g} times; use a longer record, or give "
        "the correct approximate frequency of the motion"
    )
    raise InputError(name, float(f"{size:.3g}"), problem)


def _checked(time: Any, columns: Mapping[str, Any]) -> tuple[float, dict[str, np.ndarray]]:
    """Return the time step and the columns as arrays.  Raises InputError."""
    if not hasattr(columns, "keys"):
        raise InputError("columns", columns, f"allowed is a mapping with {', '.join(COLUMNS)}")
    if len(columns) == 0:
        raise InputError("columns", None, "allowed is one column or more")
    for name in columns:
        if name not in COLUMNS:
            raise InputError("columns", name, f"unknown; allowed are {', '.join(COLUMNS)}")
    if all(name in columns for name in NORMAL):
        raise InputError("indentation", "with a load", "allowed is one of the two")
    values: dict[str, np.ndarray] = {}
    for name, one in {"time": time, **{name: columns[name] for name in columns}}.items():
        try:
            values[name] = np.array(one, float)
        except (TypeError, ValueError):
            raise InputError(name, one, "allowed is an array of numbers") from None
        if values[name].ndim != 1:
            raise InputError(name, one, "allowed is an array of one dimension")
        if len(values[name]) != len(values["time"]):
            allowed = f"allowed are as many numbers as times: {len(values['time'])}"
            raise InputError(name, values[name].shape, allowed)
        if not np.isfinite(values[name]).all():
            raise InputError(name, math.nan, "allowed are finite numbers")
        if name != "time":
            _check_marks(name, values[name])
    time = values.pop("time")
    fewest = FEWEST_PER_PERIOD * FEWEST_PERIODS
    if len(time) < fewest:
        allowed = f"the record is too short; allowed are at least {fewest} samples"
        raise InputError("time", time.shape, allowed)
    for name in NORMAL:
        if name in values and values[name].mean() <= 0.0:
            mean = float(f"{values[name].mean():.6g}")
            raise InputError(name, mean, "the mean; allowed is a mean above 0")
    return _step(time), values


def _step(time: np.ndarray) -> float:
    """Return the time step.  Raises InputError if the steps differ by more than rounding."""
    step = float(time[-1] - time[0]) / (len(time) - 1)
    if step <= 0.0:
        problem = f"the last time, and the first is {time[0]:.9g} s; allowed are increasing times"
        raise InputError("time", float(time[-1]), problem)
    if uneven_row(time, EVEN) is None:
        return step
    # Numbers with a fixed number of significant digits have the fewest decimals at the end.
    half = 0.5 * _resolution(time[-len(time) // 8 :])
    step, rest = _even_steps(time, step)
    row = int(np.argmax(np.abs(rest)))
    most = half * (1.0 + 1e-6) + EVEN * step
    if half <= 0.5 * step:  # a missing sample shifts some times by at least half a step
        most = min(most, (0.5 - EVEN) * step)
    if np.abs(rest[row]) > most:
        allowed = "allowed are equal steps, and times rounded to their last digit"
        problem = f"not equally spaced, in row {row} (the first is 0); {allowed}"
        raise InputError("time", float(time[row]), problem)
    return step


def _even_steps(time: np.ndarray, step: float) -> tuple[float, np.ndarray]:
    """The step of the equally spaced times with the smallest largest deviation, and the deviations,
    shape (samples,).

    For a step, the deviations extend over the vertical width of the times' convex hull.  As a
    function of the step, this width is smallest at the slope of an edge.
    """
    from scipy.spatial import ConvexHull

    index = np.arange(len(time))
    rest = time - time[0] - step * index
    points = np.stack([index / len(time), rest / np.ptp(rest)], axis=1)
    corners = points[ConvexHull(points).vertices]
    across, up = (corners - np.roll(corners, 1, axis=0)).T
    slopes = up[across != 0.0] / across[across != 0.0]
    widths = [np.ptp(corners[:, 1] - slope * corners[:, 0]) for slope in slopes]
    change = float(slopes[int(np.argmin(widths))]) * float(np.ptp(rest)) / len(time)
    rest = rest - change * index
    return step + change, rest - 0.5 * (rest.max() + rest.min())


def _resolution(time: np.ndarray) -> float:
    """Last decimal place of rounded times; 0 for times that are not rounded."""
    for decimals in range(MOST_DECIMALS + 1):
        place = time * 10.0**decimals
        if np.abs(place - np.rint(place)).max() <= 1e-6:
            return 10.0**-decimals
    return 0.0


def _strongest(values: Mapping[str, np.ndarray]) -> float:
    """Number of periods of the strongest component, from the record's spectrum."""
    power = 0.0
    for one in values.values():
        x = np.linspace(-1.0, 1.0, len(one))
        rest = one - np.polynomial.Polynomial.fit(x, one, TREND)(x)
        if np.abs(rest).max() > CONSTANT * np.abs(one).max():
            spectrum = np.abs(np.fft.rfft(rest * np.hanning(len(one)))) ** 2
            power = power + spectrum / spectrum.sum()
    if not np.any(power):
        raise InputError("columns", 0.0, "constant; allowed is an oscillation")
    first, height = SLOWEST + int(np.argmax(power[SLOWEST:])), np.sqrt(power)  # type: ignore[index]
    low, top, high = (height[min(n, len(height) - 1)] for n in (first - 1, first, first + 1))
    curve = low - 2.0 * top + high
    shift = 0.5 * (low - high) / curve if curve else 0.0
    return float(first + np.clip(shift, -0.5, 0.5))


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


def _correction(harmonics: Mapping[str, np.ndarray]) -> tuple[float, float, float, int]:
    """Return the relative correction of the frequency, its standard error, the variance of the slow
    phase drift in periods squared, and the order of the strongest harmonic.

    The first three follow from the phases of this harmonic.
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
    error = math.sqrt(float(np.sum(rest**2)) / max(len(turns) - 2, 1) / spread)
    return slope, error, max(float(np.mean(rest[1:] * rest[:-1])), 0.0), order
