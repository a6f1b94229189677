"""Pressures from files, "file:measured.csv": values on a grid, see grid.

CSV: a line that names the columns forward, lateral and pressure, then one line a point; netCDF: a
variable `pressure` with the coordinates `forward` and `lateral`.  The points fill a regular
grid.  ",grid=samples" after the path says that the values hold at the points, with bilinear ones
between them; without it they are means over cells of the grid's own step around the points, which
is what sensors give, and what makes the load the sum of values times areas whatever the grid.
",decimal=comma" and ",encoding=cp1252" say how a CSV is written.
"""

from __future__ import annotations

from pathlib import PurePath

from microslip.foundation import csv_text, named_files
from microslip.foundation.errors import InputError
from microslip.pressures import grid_csv, grid_netcdf
from microslip.pressures.grid import READINGS
from microslip.pressures.pressure import Measured, Pressure

PACKED = {
    b"\x1f\x8b": "gzip",
    b"PK\x03\x04": "zip, as spreadsheets are",
    b"BZh": "bzip2",
    b"\xfd7zXZ": "xz",
}
NETCDF = (".nc", ".nc4", ".cdf")
"""Ends of names that only netCDF files have."""
MOST_KNOWN = 8

_KNOWN: dict[str, Pressure] = {}
"""One record for a name: what is prepared for a pressure is found again by it."""


def pressure(name: str) -> Pressure:
    """The Pressure in the file that a name speaks of; see named_files.

    The name of the record has the digest of the content and not the path, so that results belong to
    what the file holds.

    Raises
    ------
    InputError
        For a file that is not there, is not as described above, or is not the one that the digest
        is of.
    """
    file, content = named_files.found(name)
    if file.grid not in READINGS:
        raise InputError("pressure", name, f"allowed for grid is one of {', '.join(READINGS)}")
    if file.name not in _KNOWN:
        try:
            _KNOWN[file.name] = _of_content(file, content)
        except ValueError as error:
            problem = str(error).replace("decimal = ','", "decimal=comma after the path")
            raise InputError("pressure", name, f"{file.path}: {problem}") from None
        if len(_KNOWN) > MOST_KNOWN:
            del _KNOWN[next(iter(_KNOWN))]
    return _KNOWN[file.name]


def _of_content(file: named_files.NamedFile, content: bytes) -> Measured:
    for begins, kind in PACKED.items():
        if content.startswith(begins):
            raise ValueError(f"packed ({kind}); allowed: CSV or netCDF as it is")
    if content.startswith(grid_netcdf.BEGINNINGS):
        return Measured.on_grid(file.name, *grid_netcdf.grid(content), file.grid)
    if PurePath(file.path).suffix.lower() in NETCDF:
        raise ValueError("not a netCDF file that can be read: it does not begin as one does")
    decimal = named_files.DECIMALS[file.decimal]
    try:
        csv_text.check_format(decimal, file.encoding)
    except InputError as error:
        raise InputError("pressure", file.encoding, error.allowed) from None
    return Measured.on_grid(file.name, *grid_csv.grid(content, decimal, file.encoding), file.grid)
