"""Motions from files with units: one period of a measured stroke, such as "file:stroke.csv".

time [ms],lateral [um],load [N]
0,0,10
0.1,0.62,10.3

The format is that of motions/from_file.py, with a unit in each heading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from microslip.foundation import csv_text
from microslip.foundation.csv_text import PURE
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import FileReader, NamedFile
from microslip.foundation.number_table import NumberTable
from microslip.motions.from_file import COLUMNS, columns_of, table_of
from microslip.motions.samples import NORMAL, PLANE, Sampled
from microslip.si.bodies import TwoBodies
from microslip.si.quantities import read
from microslip.si.record import MOST_ROWS
from microslip.si.tables import parsed_file

UNITS = {"forward": "m", "lateral": "m", "angle": "rad", "load": "N", "indentation": "m"}
"""SI units of the columns of a path or a period."""
USUAL_ROWS = 2_000
"""Largest number of rows in a period without a hint to `microslip fold`.  With more rows, a
prediction can take minutes, and the file may be a record of many periods."""
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
        if rows <= USUAL_ROWS:
            return ""
        return f"one period of {rows} rows, which can take minutes; {FOLD}"

    @property
    def mean_load(self) -> float | None:
        """Mean of the load, N; None without a load."""
        return float(self.columns["load"].mean()) if "load" in self.columns else None

    def deviations(self, contact: TwoBodies) -> dict[str, np.ndarray]:
        """Return the columns in the units of `microslip.Sampled`.  The load and the indentation are
        reduced by 1."""
        units = scales(contact, self.columns)
        over = {name: values / units[name] for name, values in self.columns.items()}
        return {name: one - 1.0 if name in NORMAL else one for name, one in over.items()}

    def sampled(self, contact: TwoBodies, size: float) -> Sampled:
        """Return the motion for microslip.solve, with deviations divided by `size`."""
        over = {name: one / size for name, one in self.deviations(contact).items()}
        return Sampled.of_columns({n: one + 1.0 if n in NORMAL else one for n, one in over.items()})

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
        return float(np.hypot(*rates[:2]).max()), float(np.abs(rates[2]).max())

    @property
    def _plane(self) -> np.ndarray:
        """Forward and lateral displacement and angle, (3, rows)."""
        rows = len(next(iter(self.columns.values())))
        return np.stack([self.columns.get(name, np.zeros(rows)) for name in PLANE])


def scales(contact: TwoBodies, columns: dict[str, np.ndarray]) -> dict[str, float]:
    """Return the unit of each column in `microslip.response` and `microslip.Sampled`, in SI
    units."""
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


def _factors(table: NumberTable) -> dict[str, float]:
    """Return the unit of each column, in SI units.  Raises ValueError for a missing or wrong
    unit."""
    factors = {}
    for name, unit in table.units.items():
        si = UNITS.get(name, "s")
        if unit in PURE:
            raise ValueError(f"{name} has no unit; allowed: one such as {name} [{EXAMPLES[si]}]")
        try:
            factors[name] = read(name, f"1 {unit}", si).si
        except InputError as error:
            raise ValueError(f"{name} [{unit}]: {error.allowed}") from None
    return factors


def _of_content(file: NamedFile, content: bytes) -> Stroke:
    table = table_of(file, content)
    factors = _factors(table)
    rows = len(next(iter(table.columns.values())))
    if rows > MOST_ROWS:
        raise ValueError(f"{rows} rows; allowed is one period of at most {MOST_ROWS} rows; {FOLD}")
    columns = {name: values * factors[name] for name, values in table.columns.items()}
    time, frequency = columns.pop("time", None), None
    if time is not None:
        frequency = (len(time) - 1) / (len(time) * float(time[-1] - time[0]))
    Sampled.of_columns(columns)  # raises InputError
    columns = {n: one - one.mean() if n in PLANE else one for n, one in columns.items()}
    return Stroke(file.name, {n: columns[n] for n in COLUMNS if n in columns}, frequency)


EXAMPLES = {"m": "um", "rad": "mrad", "N": "N", "s": "ms"}
"""Example of a column's unit for each SI unit."""

read_stroke = FileReader("motion", _of_content)
"""Function that returns the Stroke of a name such as "file:stroke.csv"."""


def read_record(
    path: str, *, decimal: str = ".", encoding: str = "utf-8"
) -> tuple[np.ndarray, dict[str, np.ndarray], dict[str, str]]:
    """Read a record for `microslip.fold`.  Returns the times in s, the columns, and their units.

    The columns are in the units of the file.  `microslip.fold` checks the times.

    Raises
    ------
    InputError
        If the file cannot be read, or has no time.
    """
    csv_text.check_format(decimal, encoding)

    def parse(content: bytes) -> tuple[NumberTable, dict[str, float]]:
        table = columns_of(content, decimal=decimal, encoding=encoding)
        if "time" not in table.columns:
            raise ValueError("no column time; allowed is one, as in time [s]")
        return table, _factors(table)

    table, factors = parsed_file("record", path, parse)
    time = table.columns.pop("time") * factors["time"]
    return time, table.columns, table.units | {"time": "s"}
