"""Motions from samples: a path through a sequence of samples, or one period of any shape.

Each sample is a row with the forward, lateral and angular displacement of the indenter, and the
normal load or the indentation.  Along a path, all of these quantities change linearly between the
rows.  A period is interpolated by periodic cubic splines through equally spaced rows.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation import spec
from microslip.foundation.arguments import LARGEST, numbers
from microslip.foundation.errors import InputError
from microslip.scene.motion import NORMAL, PLANE, ROUNDING, Motion, Wave
from microslip.scene.pressure import Pressure

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


@dataclass(frozen=True, eq=False)
class _Samples(Motion):
    """A motion given by rows.

    Attributes
    ----------
    rows : np.ndarray, shape (rows, 3)
        Forward and lateral displacement in units of u_lim, and angle in units of u_lim / a.
    height : np.ndarray or None, shape (rows,)
        Normal load or indentation divided by its reference value; None if both are constant.
    by_load : bool
        Whether `height` is a load.
    """

    rows: np.ndarray
    height: np.ndarray | None
    by_load: bool

    @cached_property
    def moving(self) -> set[str]:
        plane = {name for name, one in zip(PLANE, self.rows.T, strict=True) if np.ptp(one) > 0.0}
        return plane if self.height is None else {*plane, NORMAL[not self.by_load]}


@dataclass(frozen=True, eq=False)
class SampledPath(_Samples):
    """A motion through a sequence of rows.  The sequence is not repeated.  The phase is the row
    number."""

    periodic = False
    summary = "a path through rows"

    @classmethod
    def of_columns(cls, columns: Mapping[str, Any]) -> SampledPath:
        """Create the path from columns. The allowed names of columns are listed in PLANE and
        NORMAL.  A quantity is constant if its column is None.

        Raises
        ------
        InputError
            If a column has an unknown name, if a value is not a number from -1e6 to 1e6, if columns
            have different lengths, if there are fewer than two rows, if a load or an indentation is
            below 0, or if both a load and an indentation are given.
        """
        return cls(*_rows_of(columns, 2))

    name = "path"

    def at(self, phase: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Interpolate values linearly at a phase.  There is one value for each row."""
        return np.interp(phase, np.arange(len(values)), values)

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        forward, lateral, angle = (self.at(phase, column) for column in self.rows.T)
        return forward, lateral, angle

    def depth(self, phase: np.ndarray, amplitude: float, pressure: Pressure) -> np.ndarray:
        assert self.height is not None  # else the depth is constant
        return self._depth_at(self.at(phase, self.height), pressure)

    def deepest(self, amplitude: float, pressure: Pressure) -> float:
        return float(self.depth(np.arange(len(self.rows)), amplitude, pressure).max())

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> None:
        """Return None, because kinks of the traction move along the path."""

    def lengths(self, pressure: Pressure) -> np.ndarray:
        """For each pair of consecutive rows, compute the largest displacement of any contact point,
        in units of u_lim.

        If the indentation changes, the change in the local u_lim is added to the displacement.  The
        result has the shape (rows - 1,).
        """
        forward, lateral, angle = np.abs(np.diff(self.rows, axis=0)).T
        out = np.hypot(forward, lateral) + angle
        if self.loads:
            out += np.abs(np.diff(self.depth(np.arange(len(self.rows)), 0.0, pressure)))
        return out


@dataclass(frozen=True, eq=False)
class Sampled(spec.NamedByText, _Samples):
    """One period of a motion of any shape, given by equally spaced samples.

    At the amplitude A, the displacement of the indenter is A times the interpolated displacement.
    A sample h of the load or the indentation is replaced by 1 + A (h - 1).

    Attributes
    ----------
    rows : np.ndarray, shape (rows, 3)
        Forward and lateral displacement in units of u_lim, and angle in units of u_lim / a, for A =
        1.  The end point of the period is omitted.
    height : np.ndarray or None, shape (rows,)
        Normal load or indentation divided by its reference value; None if both are constant.
    by_load : bool
        Whether `height` is a load.
    text : str
        Name of the motion, including a digest of the samples or of the file.  Motions with equal
        names are equal.
    """

    text: str

    summary = "sliding forward while moving along samples of a period"
    amplitude_label = "factor of the samples"
    straight = False

    @classmethod
    def of_columns(cls, columns: Mapping[str, Any]) -> Sampled:
        """Create the motion from columns. The allowed names of columns are listed in PLANE and
        NORMAL.  A quantity is constant if its column is None.

        Raises
        ------
        InputError
            In the same cases as `SampledPath.of_columns`, and if there are fewer than
            FEWEST_SAMPLES rows, if nothing changes, or if the last row is the end of the period.
        """
        rows, height, by_load = _rows_of(columns, FEWEST_SAMPLES)
        parts = [rows] if height is None else [rows, height]
        values, problem = np.column_stack(parts), ""
        if not np.ptp(values, axis=0).any():
            problem = "equal in all rows; allowed is a motion, in this or in another column"
        elif _ends_with_first(values):
            problem = "the last row repeats the first; leave it out: it begins the next period"
        if problem:
            name = next(name for name, one in columns.items() if one is not None)
            raise InputError(name, float(np.array(columns[name], float)[-1]), problem)
        digest = hashlib.sha256(b"".join(one.tobytes() for one in parts)).hexdigest()[:16]
        kind = "" if height is None else ",load" if by_load else ",indentation"
        return cls(rows, height, by_load, f"array:sha256={digest}{kind}")

    @cached_property
    def _plane(self) -> CubicSpline:
        return _spline(self.rows - self.rows.mean(axis=0))

    @cached_property
    def _normal(self) -> Wave:
        height = np.ones(len(self.rows)) if self.height is None else self.height
        return Wave(form=_spline(height - 1.0))

    @cached_property
    def readings(self) -> tuple[Motion, ...]:
        """Tuple that contains the motion through every second sample.  The tuple is empty if there
        are too few samples."""
        if len(self.rows) < 2 * FEWEST_SAMPLES:
            return ()
        height = None if self.height is None else self.height[::2]
        text = f"{self.text} (every second row)"
        return (Sampled(self.rows[::2], height, self.by_load, text),)

    @cached_property
    def cycles(self) -> int:
        """Effective number of cycles per period: the root mean square of the orders of the
        harmonics, weighted by their power.  The result is the largest value of all columns."""
        values = self.rows if self.height is None else np.column_stack([self.rows, self.height])
        power = np.abs(np.fft.rfft(values - values.mean(axis=0), axis=0)) ** 2
        power = power[:, power.sum(axis=0) > 0.0]
        order = np.arange(len(power))[:, None]
        return int(
            np.ceil(np.sqrt((order**2 * power).sum(axis=0) / power.sum(axis=0)).max(initial=1.0))
        )

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        forward, lateral, angle = amplitude * np.moveaxis(self._plane(phase), -1, 0)
        return velocity * phase + forward, lateral, angle

    @cached_property
    def reach(self) -> float:
        """Largest distance from the centre, or 0 if the contact rotates."""
        plane = self._loop[:2]
        centre = 0.5 * (plane.max(axis=1) + plane.min(axis=1))
        return 0.0 if self.rotates else float(np.hypot(*(plane - centre[:, None])).max())

    def stroke(self, amplitude: float, poisson: float) -> float:
        return 0.5 * amplitude * float(np.ptp(self._loop, axis=1).max())

    def _extremes(self, amplitude: float, pressure: Pressure) -> tuple[float, float]:
        """Return the smallest and the largest indentation."""
        spline: Any = self._normal.form
        turns = spline.derivative().roots(extrapolate=False)
        phases = np.concatenate([[0.0], turns[np.isfinite(turns)]])
        depths = self.depth(phases, amplitude, pressure)
        return float(depths.min()), float(depths.max())

    def share_without_load(self, amplitude: float) -> float:
        """Compute the fraction of a period in which the load or the indentation is at most 0."""
        return float(np.mean(1.0 + amplitude * self._fine_heights <= ROUNDING))

    @cached_property
    def _fine_heights(self) -> np.ndarray:
        return self._normal(np.linspace(0.0, 2.0 * np.pi, 64 * len(self.rows), endpoint=False))

    def mean_load(self, amplitude: float, pressure: Pressure) -> float:
        if not self.loads:
            return 1.0
        depths = self._depth_at(1.0 + amplitude * self._fine_heights, pressure)
        return float(np.mean(pressure.total(depths)))


FEWEST_SAMPLES = 4
"""Smallest number of rows in a period.  The alternative motion through every second row is used
only if it has at least this number of rows."""
ROUGHER = 2.0
"""If the last row equals the first row, the roughness is computed with and without the last row. If
the first roughness, divided by the second, is above this limit, the last row is the end of the
period.  For waves of 4 to 64 rows without an end point, the ratio is below 1.9. Examples are
cosines and pulses.  For a sine with its end point, the ratio is 3 to 1e6."""
FEWEST_LEVELS = 4
"""Smallest number of different values in a column. In a column with fewer different values, no
value counts as the mark of a missing sample.  Consider n equally spaced values. The first value is
one step away from the second, and the values between the first and the last extend over n - 3
steps.  With n below 4, the first and the last value would therefore count as marks of missing
samples."""
ABSURD = 100.0
"""A single value is refused if its distance from all other values exceeds this limit times the
range of the other values.  In a motion of 1000 rows, the rows next to the top of a sharp pulse can
have a hundredth of the pulse's height."""
NINES = re.compile(r"-?99(9+|9*\.9+)")
"""Pattern of a number that consists of nines, such as -9999 or -99.99."""
UNUSUAL = (
    "far outside of all others; allowed are measured values; such a value often marks a missing "
    "sample"
)


def unusual_rows(values: np.ndarray, is_record: bool = False) -> np.ndarray:
    """Return the rows of values that probably mark missing samples.

    The distance of these values from all others exceeds the range of the others.  In addition, one
    of three conditions is met.  First, the values consist of nines (with or without noise).
    Second, the values are equal and occur several times in a record.  Third, the values have no
    neighbours in time, and their distance from the others exceeds `ABSURD` times the range.
    """
    levels = np.unique(values)
    if len(levels) < FEWEST_LEVELS:
        return np.array([], int)
    gaps = np.diff(levels)
    far = values <= levels[np.argmax(gaps)]
    far = ~far if far.mean() > 0.5 else far
    nines = all(NINES.fullmatch(f"{value:.4g}") for value in values[far])
    repeated = is_record and far.sum() > 1 and np.ptp(values[far]) == 0.0
    alone = not (far & np.roll(far, 1)).any()
    least = 1.0 if nines or repeated else ABSURD if alone else np.inf
    return np.flatnonzero(far & (gaps.max() > least * np.ptp(values[~far])))


def _ends_with_first(values: np.ndarray) -> bool:
    """Return whether the last row is the end of the period.

    In this case, the last row equals the first row, and the motion is smoother without the last
    row.  values: array of shape (rows, columns).
    """
    values = values / np.maximum(np.ptp(values, axis=0), np.finfo(float).tiny)
    longer, shorter = (
        np.sum(np.diff(np.concatenate([rows, rows[:4]]), n=4, axis=0) ** 2)
        for rows in (values, values[:-1])
    )
    same = np.abs(values[-1] - values[0]).max() <= ROUNDING * np.abs(values).max()
    return bool(same and longer > ROUGHER * shorter)


def uneven_row(time: np.ndarray, most: float) -> int | None:
    """Return the index of the time that deviates most from equal spacing.

    The result is None if the times increase and no time deviates by more than `most` spacings.
    """
    even = np.linspace(time[0], time[-1], len(time))
    distance = np.abs(time - even)
    step = (time[-1] - time[0]) / max(len(time) - 1, 1)
    return None if step > 0.0 and distance.max() <= most * step else int(np.argmax(distance))


def _spline(values: np.ndarray) -> CubicSpline:
    """Return the periodic cubic spline through one period of samples, as a function of the phase.
    The samples are along the first axis."""
    from scipy.interpolate import CubicSpline  # imported here, because loading takes a while

    phase = np.linspace(0.0, 2.0 * np.pi, len(values) + 1)
    return CubicSpline(phase, np.concatenate([values, values[:1]]), bc_type="periodic")


def checked_columns(
    columns: Mapping[str, Any], units: Mapping[str, str], fewest: int, most: float
) -> dict[str, np.ndarray]:
    """Convert columns to arrays of equal length.

    units, fewest, most: units of the allowed columns, keyed by name; smallest number of rows;
    largest absolute value.  Every column except the first can be None.  Raises InputError if a
    column is invalid, or if both a load and an indentation are given.
    """
    if not isinstance(columns, Mapping):
        raise InputError("columns", columns, "allowed is a mapping of names to arrays")
    arrays: dict[str, np.ndarray] = {}
    for name, values in columns.items():
        if name not in units:
            raise InputError("columns", name, f"unknown; allowed are {', '.join(units)}")
        if values is None:
            continue
        out = arrays[name] = numbers(name, values, units[name])
        if out.ndim != 1:
            raise InputError(name, values, "allowed is an array with one number for each row")
        first, length = next((name, len(one)) for name, one in arrays.items())
        if length < fewest:
            raise InputError(first, length, f"the number of rows; allowed are at least {fewest}")
        if len(out) != length:
            raise InputError(name, len(out), f"number of rows; allowed is {length}, as in {first}")
        if (unusual := ~(np.abs(out) <= most)).any():
            row = int(np.argmax(unusual))
            allowed = f"allowed are numbers from -{most:g} to {most:g}; this is row {row}"
            raise InputError(name, float(out[row]), allowed)
    if not arrays:
        raise InputError("forward", None, "allowed is a displacement for every row")
    if set(NORMAL) <= arrays.keys():
        raise InputError("indentation", "with a load", "allowed is one of the two")
    return arrays


def _rows_of(columns: Mapping[str, Any], fewest: int) -> tuple[np.ndarray, np.ndarray | None, bool]:
    """Convert columns to three values. The first value is an array of the displacements, of shape
    (rows, 3). The second value is None, or an array of the loads or indentations with the shape
    (rows,). The third value is True if the second value is a load."""
    units = dict.fromkeys(PLANE + NORMAL, "")
    arrays = checked_columns(columns, units, fewest, LARGEST["amplitude"])
    heights = [name for name in NORMAL if name in arrays]
    for name in heights:
        if arrays[name].min() < 0.0:
            raise InputError(name, float(arrays[name].min()), "allowed are numbers >= 0")
        if arrays[name].max() == 0.0:
            raise InputError(name, 0.0, "allowed is a path that touches the flat")
    zeros = np.zeros(len(next(iter(arrays.values()))))
    rows = np.stack([arrays.get(name, zeros) for name in PLANE], axis=1)
    return rows, arrays[heights[0]] if heights else None, "indentation" not in arrays
