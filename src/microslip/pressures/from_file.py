"""Pressures from data files such as "file:measured.csv", with values on a regular grid (see
grid.py).

A CSV file has a heading line with the columns forward, lateral and pressure, and then one line for
each point.  A netCDF file has a variable `pressure` with the coordinates `forward` and `lateral`.
By default, a value is the mean over the cell around its point, as sensors measure it.  The load is
then the sum of the values times the cell areas.  With ",grid=samples" after the path, values apply
at the points and are interpolated bilinearly. ",pitch=0.5 mm" reads a matrix of pressures without
coordinates (see grid_csv.py). ",decimal=comma" and ",encoding=cp1252" describe the format of a
CSV file.
"""

from __future__ import annotations

from pathlib import PurePath

from microslip.foundation import named_files
from microslip.pressures import grid_csv, grid_netcdf
from microslip.pressures.grid import READINGS
from microslip.pressures.pressure import Measured

NETCDF = (".nc", ".nc4", ".cdf")
"""File name extensions of netCDF."""


def _of_content(file: named_files.NamedFile, content: bytes) -> Measured:
    if file.grid not in READINGS:
        raise ValueError(f"allowed for grid is one of {', '.join(READINGS)}")
    text = named_files.DECIMALS[file.decimal], file.encoding
    if content.startswith(grid_netcdf.BEGINNINGS):
        if file.pitch:
            raise ValueError("pitch is for a matrix in a CSV file; allowed for netCDF: coordinates")
        values, units = grid_netcdf.grid(content)
    elif PurePath(file.path).suffix.lower() in NETCDF:
        raise ValueError("not a netCDF file that can be read: it does not begin as one does")
    elif file.pitch:
        values, units = grid_csv.read_matrix(content, file.pitch, *text)
    else:
        values, units = grid_csv.read_points(content, *text)
    return Measured.on_grid(file.name, *values, file.grid, units)


read_pressure = named_files.FileReader("pressure", _of_content)
"""Function that returns the pressure for a name such as "file:measured.csv".  In the name of the
pressure, a digest of the content replaces the path."""
