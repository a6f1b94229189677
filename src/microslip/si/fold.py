"""Average a long record of a motion, such as one measured by a laser vibrometer, to one period.

A record contains many periods, noise, and a slow drift.  The drift is the moving mean over one
period.  For a periodic motion, this mean is constant.  The difference between the record and the
drift is averaged over all whole periods.  The scatter between the periods gives the standard error
of the average.

The record is interpolated by cubic splines.  A spline multiplies a wave by a known factor, which is
removed.  The spline also adds fast waves, most of which are discarded.  The error
includes an estimate of the harmonics that the average omits.

If the frequency drifts, the periods are averaged out of phase, and the average is too small.  The
noise of neighbouring periods is uncorrelated.  Therefore, the variance of this slow phase drift
equals the covariance of the phases of neighbouring periods.  The phase of harmonic m is m times the
phase of the motion.  The phase drift multiplies the average of this harmonic by exp(-x), where x is
half the variance of the harmonic's phase.  The error includes this loss of amplitude.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from microslip.foundation.arguments import count, real
from microslip.foundation.errors import InputError
from microslip.scene.files import COLUMNS, EVEN, UNITS
from microslip.scene.samples import FEWEST_SAMPLES, NORMAL, UNUSUAL, checked_columns, unusual_rows

FEWEST_PERIODS, FEWEST_PER_PERIOD = 4, 4
"""Smallest number of periods in a record, and smallest number of samples in a period.  At each end
of the record, half a period is lost."""
HIGHEST = 0.65
"""Largest frequency of a harmonic, divided by the sampling rate.  Above one half, the harmonic is
distinct from others if the samples of different periods lie at different places of the period."""
RINGING, NOISY = 5.0, 2.0
"""RINGING: error due to the omitted harmonics, divided by the sum of the last two complex
amplitudes.  For a jump, whose amplitudes decrease like 1/k, the partial sum overshoots by 4.2 times
the last amplitude (Gibbs).  NOISY: an amplitude within this number of standard errors counts as
0."""
ROWS, MOST_ROWS = 32, 10_000
"""Default number of samples in the period, and largest allowed number.  With more samples, the
period contains more harmonics, but also more noise."""
REFINEMENTS = 3
"""Number of corrections of the frequency.  After a correction, the remaining error of the frequency
is due to the errors of the phases."""
MOST_PARTS, PERIODS_OF_PART = 20, 10
"""Largest number of parts of a record whose amplitudes are compared, and number of periods in such
a part."""
LARGEST_CHANGE = 0.1
"""Largest accepted difference between the amplitudes of two parts of a record, divided by the mean
amplitude."""
MOST_DECIMALS = 12
"""Times with at most this number of decimals count as rounded.  Times with more decimals need no
allowance for rounding."""
LARGEST_LOSS = 0.01
"""Largest accepted relative loss of the strongest harmonic due to a drift of the frequency.  The
estimate of the loss is of first order, so it is correct for small losses only."""
SIGNIFICANT = 5.0
"""Smallest accepted ratio of the peak-to-peak value to the standard error of this value.  For white
noise, this ratio is about 3 at the frequency of the strongest component."""
PHASE_OF_A_DRIFT = 0.5 * math.sqrt(1.0 / 80.0 - 1.0 / 144.0)
"""Standard deviation of the phase, in periods, for a frequency that changes linearly over the
record.  During the record, the frequency changes by 1 divided by the duration of the record.  The
value is the standard deviation of u**2 / 2, where u is uniformly distributed from -1/2 to 1/2."""
FINER = 32
"""Number of interpolated points per sample for the peak-to-peak value.  With 32 samples, the peak
of a sine is too small by at most 5e-6 of its amplitude."""
SUBHARMONICS = 2, 3
"""Numbers of periods after which the motion may repeat.  A slower component is drift."""
CONSTANT = 1e-12
"""A column counts as constant if its variation, divided by its largest value, is at most this
value.  This value allows for rounding errors."""
SHORTER = "cut the record into shorter ones"
LONGER = "use a longer record, or give the correct approximate frequency of the motion"
NO_OSCILLATION = "in the first row, without an oscillation; allowed is an oscillating column"
SLOWEST = 3
"""Smallest number of periods per record in the search for the frequency."""


@dataclass(frozen=True, eq=False)
class Fold:
    """The mean period of a record.

    Attributes
    ----------
    frequency, frequency_error : float
        Frequency and its standard error, in Hz.
    periods : int
        Number of averaged periods.
    columns : dict of str to np.ndarray, shape (rows,)
        The mean period, without its end point.  Displacements are relative to their mean.
    errors : dict of str to np.ndarray, shape (rows,)
        Standard error of each sample of `columns`, from the scatter between the periods.  The loss
        of amplitude due to a drift of the frequency is added, and half of a change of the
        amplitude, and the largest difference of every second or third period from the mean.
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
        """Times of the samples in s, as an array of shape (rows,)."""
        rows = len(next(iter(self.columns.values())))
        return np.arange(rows) / (rows * self.frequency)

    def peak_to_peak(self, name: str) -> tuple[float, float]:
        """Return the peak-to-peak value of a column and the standard error of this value.

        The column is interpolated between its samples.  The standard error is an upper bound: twice
        the largest standard error of a sample.
        """
        size, missed = _peak_to_peak(self.columns[name])
        return size, 2.0 * float(np.max(self.errors[name])) + missed


def _peak_to_peak(values: np.ndarray) -> tuple[float, float]:
    """Return the peak-to-peak value, and its largest error due to the distance between points."""
    fine = np.fft.irfft(np.fft.rfft(values), FINER * len(values)) * FINER
    return float(np.ptp(fine)), float(np.abs(np.diff(fine, 2)).max() / 4.0)


def fold(
    time: Any, columns: Mapping[str, Any], *, frequency: float | None = None, rows: int = ROWS
) -> Fold:
    """Average a record over its periods, after removing its slow drift.

    Parameters
    ----------
    time : array_like, shape (samples,)
        Equally spaced times, in s.  Each time may be rounded to its last digit.
    columns : mapping of array_like, shape (samples,)
        Columns forward, lateral, angle, and load or indentation, as numbers in any units.
        Quantities with a unit, such as those of pint, are converted to m, rad and N.
    frequency : float or None
        Approximate frequency, in Hz, which is then refined.  Its error must correspond to less than
        half a period over the whole record.  The default is the frequency of the strongest
        component.
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
    from scipy.interpolate import CubicSpline  # only here: it takes a while to load

    rows = count("rows", rows, 2 * FEWEST_SAMPLES, most=MOST_ROWS, even=True)
    step, rounding, names, values = _checked(time, columns)
    longest, typed = (len(values) - 1) * step, frequency is not None
    hz = _strongest(names, values) / (len(values) * step)
    hz = real("frequency", frequency, 0.0) if typed else hz
    absent = f"no component of the record; allowed is the frequency to {0.5 / longest:.3g} Hz"
    spline = CubicSpline(step * np.arange(len(values)), values - values.mean(axis=0))
    integral = spline.antiderivative()

    def drift(time: Any) -> np.ndarray:
        """Return the mean over one period.  The given time is the centre of this period."""
        return (integral(time + 0.5 / hz) - integral(time - 0.5 / hz)) * hz

    for refinement in range(REFINEMENTS + 1):
        _check_periods(hz, longest, step, frequency)
        points, whole = max(rows, 2 * math.ceil(1.0 / (hz * step))), int(hz * longest + 1e-9) - 1
        times = (0.5 + np.arange(whole)[:, None] + np.arange(points) / points) / hz
        turns = hz * step * np.arange(min(rows // 2, math.ceil(HIGHEST / (hz * step))))
        factors = points * np.sinc(turns) ** 4 * 3.0 / (2.0 + np.cos(2.0 * np.pi * turns))
        # Fourier coefficients of each whole period, shape (periods, orders + 1, columns)
        parts = np.fft.rfft(spline(times) - drift(times), axis=1)[:, : len(turns)]
        parts /= factors[:, None]
        if refinement < REFINEMENTS:
            change, error, variance, order, column = _phases(parts)
            hz += change * hz
            _refuse(abs(hz - (frequency or hz)) * longest > 1.0, "frequency", frequency, absent)
    harmonics = parts.mean(axis=0)
    deviations = (parts - harmonics) / math.sqrt(whole * (whole - 1.0))
    scatter = np.linalg.norm(np.fft.irfft(deviations, rows, axis=1) * rows, axis=0)
    mean = np.fft.irfft(harmonics, rows, axis=0) * rows
    noise = np.linalg.norm(deviations, axis=0)
    certain = np.maximum(np.abs(harmonics) - NOISY * noise, 0.0)
    omitted = certain[2:][-2:].sum(axis=0)
    power = np.abs(parts) ** 2
    # amplitude of the strongest harmonic in each period, the columns together
    sizes = np.sqrt((power[:, order] / np.maximum(power.mean(axis=(0, 1)), 1e-300)).sum(axis=-1))
    count_of_parts = min(max(whole // PERIODS_OF_PART, FEWEST_PERIODS - 1), MOST_PARTS)
    means = np.array([one.mean() for one in np.array_split(sizes, count_of_parts)])
    change, random = (one / means.mean() for one in (np.ptp(means), np.diff(sizes).std()))
    change *= change > SIGNIFICANT * random / math.sqrt(2.0 * whole / len(means))
    problem = f"the amplitude changes by {100.0 * change:.2g} %, and is smallest in part "
    problem += f"{np.argmin(means) + 1} of {len(means)}; allowed are {100.0 * LARGEST_CHANGE:g} %"
    _refuse(change > LARGEST_CHANGE, "time", longest, f"{problem}; {SHORTER}")
    peaks = np.array([_peak_to_peak(one)[0] for one in mean.T])
    ratios = peaks / np.maximum(2.0 * scatter.max(axis=0), 1e-300)
    best = int(np.argmax(ratios))
    weak = ratios[best] <= SIGNIFICANT
    _refuse(weak and typed, "frequency", frequency, absent)
    problem = f"peak to peak at {hz:.6g} Hz, only {ratios[best]:.2g} times its standard error; "
    problem += f"allowed is at least {SIGNIFICANT:g} times; {LONGER}"
    # checked before the drift, since the phases of noise look like a drift
    _refuse(weak, names[best], peaks[best], problem, 3)
    beats = np.abs(np.fft.fft(parts[:, order, column]))
    _refuse(beats[1:].max() > beats[0], "frequency", frequency or hz, absent)
    between = np.arange(len(noise)) % order > 0
    alike = np.all(np.abs(harmonics[between]) <= SIGNIFICANT * noise[between])
    problem = f"the motion repeats {order} times in a period; allowed is {order * hz:.6g} Hz"
    _refuse(order > 1 and alike, "frequency", frequency or hz, problem)
    alternation = np.zeros(mean.shape)
    for m in (m for m in SUBHARMONICS if whole >= FEWEST_PERIODS * m):
        groups = parts[: whole // m * m].reshape(-1, m, *parts.shape[1:])
        middle = groups.mean(axis=0)
        offset = middle - middle.mean(axis=0)
        variance_by_chance = np.sum(np.abs(groups - middle) ** 2, axis=(0, 1, 2))
        variance_by_chance *= (m - 1) / ((whole // m - 1) * whole)
        found = np.sum(np.abs(offset) ** 2, axis=(0, 1)) > SIGNIFICANT**2 * variance_by_chance
        offset *= found / (1.0 - np.sinc(1.0 / m))  # the rest counts as drift
        problem = f"the motion repeats after {m} periods; allowed is {hz / m:.6g} Hz"
        size = np.linalg.norm(harmonics, axis=0)
        wrong = np.any(np.linalg.norm(offset, axis=1) > LARGEST_CHANGE * size)
        _refuse(wrong, "frequency", frequency or hz, problem)
        alternation += np.abs(np.fft.irfft(offset, rows, axis=1)).max(axis=0) * rows
    loss = 0.5 * (2.0 * np.pi * np.arange(parts.shape[1])) ** 2 * variance
    drifted = math.sqrt(variance) / (PHASE_OF_A_DRIFT * longest)
    most = drifted * math.sqrt(LARGEST_LOSS / max(loss[order], 1e-300))
    problem = f"the frequency changes by about {drifted:.2g} Hz; allowed are {most:.2g} Hz"
    _refuse(loss[order] > LARGEST_LOSS, "time", longest, f"{problem}; {SHORTER}")
    lost = np.fft.irfft(-np.expm1(-loss)[:, None] * harmonics, rows, axis=0) * rows
    errors = scatter + np.abs(lost) + 0.5 * change * np.abs(mean)
    errors += RINGING * omitted + alternation
    is_normal = np.array([name in NORMAL for name in names])
    mean += (values.mean(axis=0) + drift(times).mean(axis=(0, 1))) * is_normal
    below = np.maximum(-mean, 0.0) * is_normal
    for index in np.flatnonzero(below.max(axis=0) > LARGEST_LOSS * peaks)[:1]:
        allowed = "the smallest of the mean period; allowed are numbers >= 0"
        raise InputError(names[index], float(mean[:, index].min()), allowed)
    first, end = drift(np.array([0.5 / hz, longest - 0.5 / hz]))
    rates = (end - first) / (longest - 1.0 / hz)
    return Fold(
        frequency=float(hz),
        # the phase of a period is off by 1 / (4 pi) of the amplitude's relative change within it
        frequency_error=float(
            hz * math.hypot(error, rounding / longest, (change / whole) ** 2 / (4.0 * math.pi))
        ),
        periods=whole,
        columns=dict(zip(names, (mean + below).T, strict=True)),
        errors=dict(zip(names, (errors + below).T, strict=True)),
        drift=dict(zip(names, map(float, rates), strict=True)),
    )


def _refuse(wrong: object, argument: str, value: Any, allowed: str, digits: int = 6) -> None:
    """Raise InputError if `wrong` is true.  A float `value` is rounded to `digits` significant
    digits."""
    if wrong:
        value = float(f"{value:.{digits}g}") if isinstance(value, float) else value
        raise InputError(argument, value, allowed)


def _check_periods(hz: float, longest: float, step: float, frequency: float | None) -> None:
    """Raise InputError if the record has too few periods, or too few samples in a period."""
    periods, samples = hz * longest, 1.0 / max(hz * step, 1e-300)
    wrong = periods < FEWEST_PERIODS or samples < FEWEST_PER_PERIOD
    problem = f"the record of {longest:.6g} s has {periods:.6g} periods of {samples:.3g} samples; "
    problem += f"allowed are at least {FEWEST_PERIODS}, of {FEWEST_PER_PERIOD} samples or more"
    _refuse(wrong and frequency is not None, "frequency", frequency, problem)
    _refuse(wrong, "time", longest, f"at {hz:.6g} Hz, the strongest component, {problem}; {LONGER}")


def _phases(parts: np.ndarray) -> tuple[float, float, float, int, int]:
    """Find the strongest harmonic, and compute three values from the phases of this harmonic.
    These values are the relative correction of the frequency, the standard error of this
    correction, and the variance of the slow phase drift (in periods squared).  The function returns
    the three values, the order of the harmonic, and the column of the harmonic."""
    power = np.mean(np.abs(parts) ** 2, axis=0)
    share = power / np.maximum(power.sum(axis=0), 1e-300)
    column = int(np.argmax(share[1:].max(axis=0)))
    order = int(np.argmax(share[1:, column])) + 1
    turns = np.unwrap(np.angle(parts[:, order, column])) / (2.0 * np.pi * order)
    place = np.arange(len(turns)) - 0.5 * (len(turns) - 1)
    slope, spread = float(place @ turns / (place @ place)), float(place @ place)
    rest = turns - turns.mean() - slope * place
    error = math.sqrt(float(rest @ rest) / max(len(turns) - 2, 1) / spread)
    return slope, error, max(float(np.mean(rest[1:] * rest[:-1])), 0.0), order, column


def _checked(time: Any, columns: Mapping[str, Any]) -> tuple[float, float, list[str], np.ndarray]:
    """Return the time step, the rounding of the times, the names of the columns, and the values of
    the columns.  The values are an array of shape (samples, columns)."""
    known = ", ".join(COLUMNS)
    _refuse(not hasattr(columns, "keys"), "columns", columns, f"allowed is a mapping with {known}")
    _refuse("time" in columns, "columns", "time", f"unknown; allowed are {known}")
    given = {"time": () if time is None else time, **columns}
    fewest = FEWEST_PER_PERIOD * FEWEST_PERIODS
    arrays = checked_columns(given, {"time": "s"} | UNITS, fewest, float(np.finfo(float).max))
    times = arrays.pop("time")
    _refuse(not arrays, "columns", dict(columns), f"allowed is one column or more of {known}")
    for name, array in arrays.items():
        for row in unusual_rows(array, is_record=True)[:1]:
            raise InputError(name, float(array[row]), f"this is row {row}, {UNUSUAL}")
    return *_step(times), list(arrays), np.stack(list(arrays.values()), axis=1)


def _step(time: np.ndarray) -> tuple[float, float]:
    """Return the time step, and the standard error of the length of the record.  This error is due
    to the rounding of the times.  Times that are rounded to the same number do not have independent
    rounding errors.

    Raises InputError if the steps differ by more than rounding can explain.
    """
    problem = f"the last time, and the first is {time[0]:.9g} s; allowed are increasing times"
    _refuse(not time[-1] > time[0], "time", time[-1], problem, 17)
    index = np.arange(len(time))
    step, start = np.polyfit(index, time - time[0], 1)
    rest = np.abs(time - time[0] - start - step * index)
    # Numbers with a fixed number of significant digits have the fewest decimals at the end.
    end = time[-len(time) // 8 :]
    places = (10.0**-k for k in range(MOST_DECIMALS + 1))
    rounded = (one for one in places if np.abs(end / one - np.rint(end / one)).max() <= 1e-6)
    half = 0.5 * next(rounded, 0.0)
    most = 1.02 * half + EVEN * step
    if half <= 0.5 * step:  # a missing sample shifts some times by at least half a step
        most = min(most, (0.5 - EVEN) * step)
    row = int(np.argmax(rest))
    problem = f"not equally spaced, in row {row} (the first is 0); allowed are equal steps, "
    problem += "and times rounded to their last digit"
    _refuse(rest[row] > most, "time", time[row], problem, 17)
    alike = max(2.0 * half / step, 1.0)  # times that are rounded to the same number
    return float(step), float(np.sqrt(12.0 * alike * np.mean(rest**2) / len(time)))


def _strongest(names: list[str], values: np.ndarray) -> float:
    """Return the number of periods of the strongest spectral component in the record.  Raises
    InputError if no column oscillates."""
    from scipy.signal import periodogram

    _, spectrum = periodogram(values, window="hann", detrend="linear", axis=0)
    moves = spectrum.sum(axis=0) > (CONSTANT * np.abs(values).max(axis=0)) ** 2
    _refuse(not moves.any(), names[0], values[0, 0], NO_OSCILLATION)
    spectrum = spectrum[:, moves]
    height = np.sqrt((spectrum / spectrum.sum(axis=0)).sum(axis=1))
    first = SLOWEST + int(np.argmax(height[SLOWEST:]))
    low, top, high = (height[min(n, len(height) - 1)] for n in (first - 1, first, first + 1))
    curve = low - 2.0 * top + high
    shift = 0.5 * (low - high) / curve if curve else 0.0
    return float(first + np.clip(shift, -0.5, 0.5))
