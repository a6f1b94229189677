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

from microslip.foundation.csv_text import PURE
from microslip.foundation.named_files import DECIMALS, GRID, FileReader, NamedFile
from microslip.foundation.number_table import NumberTable, read_numbers
from microslip.motions.samples import NORMAL, PLANE, Sampled, uneven_row

COLUMNS = (*PLANE, *NORMAL)
ALLOWED = "some of forward,lateral,angle, and load or indentation, and time"
EVEN = 1e-2
"""Largest allowed deviation of a time from equal spacing, divided by the spacing.  It changes a
sine with N samples by at most 2 pi EVEN / N of its amplitude."""


def table_of(file: NamedFile, content: bytes) -> NumberTable:
    """Parse the content of a file with equally spaced samples.

    Raises
    ------
    ValueError
        If the content has another format, or if the times are not equally spaced.
    """
    if file.grid != GRID or file.pitch:
        raise ValueError("allowed after the path: decimal=comma or encoding=cp1252")
    table = columns_of(content, decimal=DECIMALS[file.decimal], encoding=file.encoding)
    time = table.columns.get("time")
    if time is not None and (row := uneven_row(time, EVEN)) is not None:
        where = table.lines[row]
        raise ValueError(f"line {where}: time is not equally spaced; allowed: equal steps")
    return table


def columns_of(content: bytes, *, decimal: str, encoding: str) -> NumberTable:
    """Parse the content of a file.  The table has at least one of the columns in COLUMNS.

    Parameters
    ----------
    content : bytes
        Content of the file.
    decimal, encoding : str
        Decimal mark and encoding of the file.

    Raises
    ------
    ValueError
        If the content has another format.
    """
    table = read_numbers(content, (*COLUMNS, "time"), ALLOWED, decimal=decimal, encoding=encoding)
    if not table.units.keys() & set(COLUMNS):
        raise ValueError(f"there is no displacement or load; allowed: {ALLOWED}")
    if not table.lines:
        raise ValueError("no line follows the heading; allowed: one for each sample")
    return table


def _of_content(file: NamedFile, content: bytes) -> Sampled:
    table = table_of(file, content)
    for name in COLUMNS:
        unit = table.units.get(name, "")
        if unit not in PURE:
            raise ValueError(
                f"{name} has the unit {unit}, which microslip predict accepts; allowed here: "
                "dimensionless numbers without a unit"
            )
    samples = Sampled.of_columns({n: table.columns.get(n) for n in COLUMNS})
    return replace(samples, text=file.name)


read_motion = FileReader("motion", _of_content)
"""Function that returns the motion for a text such as "file:stroke.csv".  In the name of the
motion, a digest of the file's content replaces the path."""
