"""Samples of motions in SI units: one period of a stroke, such as "file:stroke.csv", and records.

time [ms],lateral [um],load [N]
0,0,10
0.1,0.62,10.3

The file has the format of scene/files.py, with a unit in each heading.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from microslip.foundation.csv_table import check_format, parsed_file
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import NamedFile, parse, read_object
from microslip.foundation.units import read
from microslip.scene.files import COLUMNS, UNITS, read_period, read_samples
from microslip.scene.samples import NORMAL, PLANE, Sampled

USUAL_ROWS, MOST_ROWS = 2_000, 10_000
"""Largest number of rows in a period without a hint to `microslip fold`, and at all.  With more
rows, a prediction can take minutes, and the file may be a record of many periods."""
FOLD = "for a record of many periods, `microslip fold` writes the mean period"


@dataclass(frozen=True, eq=False)
class Stroke:
    """One period of a motion in SI units.

    Attributes
    ----------
    name : str
        Name of the motion, with a digest of the file.
    columns : dict of str to np.ndarray, shape (rows,)
        Columns with names from UNITS.  Displacements are relative to their mean over the period.
    frequency : float or None
        Frequency from the column `time`, Hz.
    """

    name: str
    columns: dict[str, np.ndarray]
    frequency: float | None

    @property
    def hint(self) -> str:
        """Hint for a period with many rows; empty for other periods."""
        rows = len(next(iter(self.columns.values())))
        text = f"one period of {rows} rows, which can take minutes; {FOLD}"
        return text if rows > USUAL_ROWS else ""

    @property
    def mean_load(self) -> float | None:
        """Mean of the load, N; None without a load."""
        return float(self.columns["load"].mean()) if "load" in self.columns else None

    def deviations(self, contact: Any) -> dict[str, np.ndarray]:
        """The columns in the units of `microslip.Sampled`, without the mean load or indentation,
        which is 1."""
        units = scales(contact, self.columns)
        return {name: one / units[name] - (name in NORMAL) for name, one in self.columns.items()}

    def sampled(self, contact: Any, size: float) -> Sampled:
        """The motion for microslip.solve, with deviations divided by `size`."""
        deviations = self.deviations(contact).items()
        return Sampled.of_columns({n: one / size + (n in NORMAL) for n, one in deviations})

    @property
    def reach(self) -> tuple[float, float]:
        """Largest tangential displacement from the mean, m, and largest rotation, rad."""
        forward, lateral, angle = self._plane
        return float(np.hypot(forward, lateral).max()), float(np.abs(angle).max())

    @property
    def pace(self) -> tuple[float, float]:
        """Largest tangential speed, m, and largest angular speed, rad, both divided by the angular
        frequency."""
        order = 1j * np.arange(self._plane.shape[1] // 2 + 1)
        rates = np.fft.irfft(order * np.fft.rfft(self._plane), self._plane.shape[1])
        forward, lateral, angle = rates
        return float(np.hypot(forward, lateral).max()), float(np.abs(angle).max())

    @property
    def _plane(self) -> np.ndarray:
        """Forward and lateral displacement and angle, (3, rows)."""
        zero = np.zeros_like(next(iter(self.columns.values())))
        return np.stack([self.columns.get(name, zero) for name in PLANE])


def scales(contact: Any, columns: dict[str, np.ndarray]) -> dict[str, float]:
    """The unit of each column in `microslip.response` and `microslip.Sampled`, in SI units."""
    if "indentation" in columns and not math.isfinite(contact.indentation):
        allowed = "allowed is a load: the indentation under this pressure is not known"
        raise InputError("indentation", None, allowed)
    return {
        "forward": contact.u_lim,
        "lateral": contact.u_lim,
        "angle": contact.u_lim / contact.contact_radius,
        "load": contact.load,
        "indentation": contact.indentation,
    }


def factors(units: Mapping[str, str | None]) -> dict[str, float]:
    """The unit of each column divided by the SI unit, 1 without a unit.  Raises ValueError for a
    wrong unit."""
    result = {}
    for name, unit in units.items():
        try:
            result[name] = 1.0 if unit is None else read(f"1 {unit}", UNITS.get(name, "s")).si
        except ValueError as error:
            raise ValueError(f"{name} [{unit}]: {error}") from None
    return result


@lru_cache(8)
def _of_content(file: NamedFile, content: bytes) -> Stroke:
    table, columns = read_period(file, content, need_units=True)
    if len(table.lines) > MOST_ROWS:
        allowed = f"allowed is one period of at most {MOST_ROWS} rows; {FOLD}"
        raise ValueError(f"{len(table.lines)} rows; {allowed}")
    columns = {name: columns[name] * factor for name, factor in factors(table.units).items()}
    time, frequency = columns.pop("time", None), None
    if time is not None:
        frequency = (len(time) - 1) / (len(time) * float(time[-1] - time[0]))
    Sampled.of_columns(columns)  # raises InputError
    columns = {n: one - one.mean() if n in PLANE else one for n, one in columns.items()}
    return Stroke(file.name, {n: columns[n] for n in COLUMNS if n in columns}, frequency)


def read_stroke(name: str) -> Stroke:
    """Return the Stroke of a name such as "file:stroke.csv"."""
    file = parse(name, "motion")
    assert file is not None
    return read_object(file, "motion", _of_content)


def read_record(
    path: str, *, decimal: str = ".", encoding: str = "utf-8"
) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, str]]:
    """Read a record for `microslip.fold`: the times in s, the columns, and their units.

    The columns are in the units of the file.  `microslip.fold` checks the times.  Raises InputError
    if the file cannot be read, or has no time.
    """
    form = {"decimal": decimal, "encoding": encoding}
    check_format(**form)

    def parse(content: bytes) -> tuple[dict[str, np.ndarray], dict[str, str]]:
        table, columns = read_samples(content, need_units=True, **form)
        if "time" not in columns:
            raise ValueError("no column time; allowed is one, as in time [s]")
        columns["time"] *= factors(table.units)["time"]
        return columns, {name: unit or "" for name, unit in table.units.items()} | {"time": "s"}

    columns, units = parsed_file("record", path, parse)
    return columns.pop("time"), columns, units
