"""Read motions with units from files: one period, as in "file:stroke.csv", or a long record.

time [ms],lateral [um],load [N]
0,0,10
0.1,0.62,10.3

The module scene/files.py describes the format of the file.  Here, each heading has a unit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from microslip.foundation.csv_table import table_of
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import NamedFile, parse, read_object
from microslip.foundation.units import read
from microslip.scene.files import COLUMNS, FORM, UNITS, columns_of, read_period
from microslip.scene.samples import NORMAL, PLANE, Sampled

USUAL_ROWS, MOST_ROWS = 2_000, 10_000
"""USUAL_ROWS: number of rows above which a hint to use `microslip fold` is shown.  A file with more
rows may be a record of many periods, and a prediction from such a file can take minutes.
MOST_ROWS: largest allowed number of rows."""
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
    frequency, mean_load : float or None
        Frequency from the column `time`, in Hz, and mean of the column `load`, in N; None if the
        column is missing.
    reach, pace : tuple of float
        `reach` contains the largest tangential displacement from the mean, in m, and the largest
        rotation, in rad.  `pace` contains the largest speeds of displacement and rotation, divided
        by the angular frequency.
    hint : str
        Hint for a period with many rows; empty for other periods.
    """

    name: str
    columns: dict[str, np.ndarray]
    frequency: float | None
    mean_load: float | None
    reach: tuple[float, float]
    pace: tuple[float, float]
    hint: str

    def sizes(self, contact: Any) -> dict[str, Any]:
        """Return the largest deviation of each column from its mean.  The units are those of
        `microslip.Sampled`, in which the mean of a load or an indentation is 1.  If an input of the
        contact is an array, the sizes are arrays."""
        units, sizes = scales(contact, self.columns), {}
        for name, one in self.columns.items():
            ends = (abs(end / units[name] - (name in NORMAL)) for end in (one.min(), one.max()))
            sizes[name] = np.maximum(*ends)
        return sizes

    def sampled(self, contact: Any, size: float) -> Sampled:
        """Return the motion for microslip.solve.  In this motion, the displacements are divided by
        `size`.  The deviations of the load or the indentation from 1 are also divided by `size`."""
        units, columns = scales(contact, self.columns), {}
        for name, one in self.columns.items():
            mean = float(name in NORMAL)
            columns[name] = (one / units[name] - mean) / size + mean
        return Sampled.of_columns(columns)


def scales(contact: Any, columns: dict[str, np.ndarray]) -> dict[str, float]:
    """Return the SI value of the unit of each column.  The units are those of `microslip.response`
    and `microslip.Sampled`."""
    if "indentation" in columns and not np.all(np.isfinite(contact.indentation)):
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
    """Return the factor that converts each column to its SI unit, or 1 if the column has no unit.
    Raises ValueError for a wrong unit."""
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
    rows = len(table.lines)
    if rows > MOST_ROWS:
        raise ValueError(f"{rows} rows; allowed is one period of at most {MOST_ROWS} rows; {FOLD}")
    units = factors(table.units)
    columns = {name: one * units[name] for name, one in columns.items()}
    time, frequency = columns.pop("time", None), None
    if time is not None:
        frequency = (rows - 1) / (rows * float(time[-1] - time[0]))
    Sampled.of_columns(columns)  # raises InputError
    load = float(columns["load"].mean()) if "load" in columns else None
    columns = {name: columns[name] for name in COLUMNS if name in columns}
    columns |= {name: one - one.mean() for name, one in columns.items() if name in PLANE}
    plane = np.stack([columns.get(name, np.zeros(rows)) for name in PLANE])
    rates = np.fft.irfft(1j * np.arange(rows // 2 + 1) * np.fft.rfft(plane), rows)
    sizes = [(float(np.hypot(x, y).max()), float(np.abs(z).max())) for x, y, z in (plane, rates)]
    hint = f"one period of {rows} rows, which can take minutes; {FOLD}" * (rows > USUAL_ROWS)
    return Stroke(file.name, columns, frequency, load, sizes[0], sizes[1], hint)


def read_stroke(name: str) -> Stroke:
    """Read the `Stroke` from the file in a name such as "file:stroke.csv"."""
    file = parse(name, "motion")
    assert file is not None
    return read_object(file, "motion", _of_content)


def read_record(path: str, **form: str) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, str]]:
    """Read a record for `microslip.fold`.  Returns the times in s, the columns, and the units of
    all columns.

    The columns are in the units of the file.  `form` contains the decimal mark and the encoding of
    the file.  `microslip.fold` checks the times.  Raises InputError if the file cannot be read or
    has no column `time`.
    """
    table = table_of("record", path, FORM, need_units=True, **form)
    try:
        columns = columns_of(table, is_record=True)
        if "time" not in columns:
            raise ValueError("no column time; allowed is one, as in time [s]")
        time = columns.pop("time") * factors(table.units)["time"]
    except ValueError as error:
        raise InputError("record", path, str(error)) from None
    return time, columns, {n: unit or "" for n, unit in table.units.items()} | {"time": "s"}
