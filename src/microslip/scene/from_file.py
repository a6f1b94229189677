"""Motions from data files such as "file:stroke.csv", with equally spaced samples of one period.

A CSV file has a heading with some of the columns forward, lateral, angle, and load or indentation,
and one line for each sample.  The end point of the period is left out, because it equals the first
point.  Without units, displacements are in u_lim, angles in u_lim / a, and loads and indentations
are divided by their reference values.  A file with units is for predictions in SI units, see
si/strokes.py.  ",decimal=comma" and ",encoding=cp1252" after the path describe the format.

A column `time` is used to check that the samples are equally spaced.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from microslip.foundation.csv_table import Table, read_table
from microslip.foundation.named_files import DECIMALS, GRID, NamedFile
from microslip.scene.samples import NORMAL, PLANE, Sampled, uneven_row

COLUMNS = (*PLANE, *NORMAL)
UNITS = {"forward": "m", "lateral": "m", "angle": "rad", "load": "N", "indentation": "m"}
"""SI units of the columns of a path or a period."""
EVEN = 1e-2
"""Largest allowed deviation of a time from equal spacing, divided by the spacing.  It changes a
sine with N samples by at most 2 pi EVEN / N of its amplitude."""


def read_samples(
    content: bytes, *, need_units: bool = False, decimal: str = ".", encoding: str = "utf-8"
) -> tuple[Table, dict[str, np.ndarray]]:
    """Read the samples in a file: the table, and its columns as numbers in the units of the file.

    The keywords are those of `csv_table.read_table`.  Raises ValueError if the content has another
    format, or has no displacement or load.
    """
    form: dict = {"need_units": need_units, "decimal": decimal, "encoding": encoding}
    table = read_table(content, UNITS | {"time": "s"}, **form)
    columns = {name: np.array(one) for name, one in table.numbers().items() if name in table.units}
    if not columns.keys() & set(COLUMNS):
        raise ValueError(f"no displacement and no load; allowed: some of {', '.join(COLUMNS)}")
    if not table.lines:
        raise ValueError("no line follows the heading; allowed: one for each sample")
    return table, columns


def read_period(
    file: NamedFile, content: bytes, need_units: bool = False
) -> tuple[Table, dict[str, np.ndarray]]:
    """Read a file with equally spaced samples, as read_samples does.  Raises ValueError also if the
    times are not equally spaced."""
    if file.grid != GRID or file.pitch:
        raise ValueError("allowed after the path: decimal=comma or encoding=cp1252")
    form: dict = {"decimal": DECIMALS[file.decimal], "encoding": file.encoding}
    table, columns = read_samples(content, need_units=need_units, **form)
    row = uneven_row(columns["time"], EVEN) if "time" in columns else None
    if row is not None:
        where = table.lines[row]
        raise ValueError(f"line {where}: time is not equally spaced; allowed: equal steps")
    return table, columns


def create_samples(file: NamedFile, content: bytes) -> Sampled:
    """Create the motion in a data file.  Raises ValueError if the content has another format."""
    table, columns = read_period(file, content)
    for name in columns.keys() & set(COLUMNS):
        if table.units[name]:
            raise ValueError(
                f"{name} has the unit {table.units[name]}, which microslip predict accepts; "
                "allowed here: dimensionless numbers without a unit"
            )
    samples = Sampled.of_columns({name: columns.get(name) for name in COLUMNS})
    return replace(samples, text=file.name)
