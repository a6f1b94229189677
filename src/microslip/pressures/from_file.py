"""Pressures from data files such as "file:measured.csv", with values on a regular grid (see
grid.py).

A CSV file has a heading with the columns forward, lateral and pressure, and one line for each
point.  A netCDF file has a variable `pressure` with the coordinates `forward` and `lateral`.  By
default a value is the mean over the cell around its point, as sensors measure it; the load is then
the sum of values times cell areas.  With ",grid=samples" after the path, values apply at the points
and are interpolated bilinearly. ",pitch=0.5 mm" reads a matrix of pressures without coordinates
(see grid_matrix.py). ",decimal=comma" and ",encoding=cp1252" describe the format of a CSV file."""

from __future__ import annotations

from pathlib import PurePath

from microslip.foundation import csv_text, named_files
from microslip.foundation.errors import InputError
from microslip.pressures import grid_csv, grid_matrix, grid_netcdf
from microslip.pressures.grid import READINGS
from microslip.pressures.pressure import Measured, Pressure

PACKED = {
    b"\x1f\x8b": "gzip",
    b"PK\x03\x04": "zip, as spreadsheets are",
    b"BZh": "bzip2",
    b"\xfd7zXZ": "xz",
}
"""First bytes of compressed files -> their format."""
NETCDF = (".nc", ".nc4", ".cdf")
"""File name extensions of netCDF."""
LARGEST_CACHE = 8

_CACHE: dict[str, Pressure] = {}
"""Name -> pressure of the files read most recently.  Files with equal content share one entry."""


def is_file(text: object) -> bool:
    """Whether a text is the name of a file, such as "file:measured.csv"."""
    return named_files.speaks_of_file(text)


def pressure(name: str) -> Pressure:
    """Read the pressure from the file with this name (see foundation.named_files).

    The name of the returned record contains a digest of the content in place of the path.

    Raises
    ------
    InputError
        If the file does not exist, has another format, or does not match the digest in the name.
    """
    file, content = named_files.read(name)
    if file.grid not in READINGS:
        raise InputError("pressure", name, f"allowed for grid is one of {', '.join(READINGS)}")
    if file.name not in _CACHE:
        try:
            _CACHE[file.name] = _of_content(file, content)
        except ValueError as error:
            problem = str(error).replace("decimal = ','", "decimal=comma after the path")
            raise InputError("pressure", name, f"{file.path}: {problem}") from None
        if len(_CACHE) > LARGEST_CACHE:
            del _CACHE[next(iter(_CACHE))]
    return _CACHE[file.name]


def _of_content(file: named_files.NamedFile, content: bytes) -> Measured:
    for begins, kind in PACKED.items():
        if content.startswith(begins):
            raise ValueError(f"packed ({kind}); allowed: CSV or netCDF as it is")
    text = named_files.DECIMALS[file.decimal], file.encoding
    if content.startswith(grid_netcdf.BEGINNINGS):
        if file.pitch:
            raise ValueError("pitch is for a matrix in a CSV file; allowed for netCDF: coordinates")
        values, units = grid_netcdf.grid(content)
    elif PurePath(file.path).suffix.lower() in NETCDF:
        raise ValueError("not a netCDF file that can be read: it does not begin as one does")
    else:
        try:
            csv_text.check_format(*text)
        except InputError as error:
            raise InputError("pressure", file.encoding, error.allowed) from None
        if file.pitch:
            values, units = grid_matrix.grid(content, file.pitch, *text)
        else:
            values, units = grid_csv.grid(content, *text)
    return Measured.on_grid(file.name, *values, file.grid, units)
