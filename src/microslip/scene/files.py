"""Motions and pressures from data files such as "file:stroke.csv".

A motion is given by equally spaced samples of one period.  The CSV file has one line for each
sample.  The header line names one or more of the columns `forward`, `lateral`, `angle`, `load` and
`indentation`.  A file cannot have both a `load` and an `indentation`.  The file omits the end point
of the period, because this point equals the first point.  Values without units are dimensionless:
displacements are divided by u_lim, angles by u_lim / a, and loads and indentations by their
reference values.  Files with units are used for predictions in SI units; see si/strokes.py.
Options such as ",decimal=comma" and ",encoding=cp1252" after the path describe the format.

If there is a column `time`, it is used to check that the samples are equally spaced.

A pressure is given by values on a regular grid (see grid.py), in a CSV or netCDF file.  A CSV file
has the columns forward, lateral and pressure, and one line for each point.  A netCDF file has a
variable `pressure` with the coordinates `forward` and `lateral`.  By default, each value is the
mean over the cell around its point, like the reading of a sensor of finite size.  With
",grid=samples" after the path, each value applies at its point.  The values are then interpolated
bilinearly between the points.

With ",pitch=0.5 mm" after the path, the file is a matrix of pressures, as exported by programs for
pressure sensors and pressure films: the forward coordinate increases from line to line, and the
lateral coordinate from cell to cell.  ",decimal=comma" and ",encoding=cp1252" describe the format
of a CSV file.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import PurePath
from typing import Any

import numpy as np

from microslip.foundation.csv_table import Table, lines_of, read_table
from microslip.foundation.named_files import DECIMALS, GRID, NamedFile
from microslip.foundation.units import read
from microslip.scene.grid import READINGS
from microslip.scene.pressure import Measured, Units
from microslip.scene.samples import NORMAL, PLANE, UNUSUAL, Sampled, uneven_row, unusual_rows

COLUMNS = (*PLANE, *NORMAL)
UNITS = {"forward": "m", "lateral": "m", "angle": "rad", "load": "N", "indentation": "m"}
"""SI unit of each column of a path or a period."""
FORM = UNITS | {"time": "s"}
"""SI unit of each column of a file."""
EVEN_TIMES = 1e-2
"""Largest allowed deviation of a time from equal spacing, divided by the spacing.  Consider a sine
with N samples.  A deviation of this size changes a sample by at most 2 pi EVEN_TIMES / N times the
amplitude of the sine."""


def columns_of(table: Table, is_record: bool = False) -> dict[str, np.ndarray]:
    """Return the columns of a table of samples as arrays, in the units of the file.

    is_record: True for many periods.  Raises ValueError in three cases: a value is not a number or
    is far outside the range of the others, there are no samples, or no column is a displacement or
    a load.
    """
    columns = {name: np.array(one) for name, one in table.numbers().items()}
    if not columns.keys() & set(COLUMNS):
        raise ValueError(f"no displacement and no load; allowed: some of {', '.join(COLUMNS)}")
    if not table.lines:
        raise ValueError("no line follows the heading; allowed: one for each sample")
    gaps = np.flatnonzero(np.diff(table.lines) > 1)
    if len(table.cells) == 1 and gaps.size:  # an empty line may be an empty cell
        where = table.lines[gaps[0]] + 1
        raise ValueError(f"line {where}: no number; allowed: a number in each line of one column")
    for name in columns.keys() - {"time"}:
        for row in unusual_rows(columns[name], is_record)[:1]:
            value = columns[name][row]
            raise ValueError(f"line {table.lines[row]}: {name} is {value:.9g}, {UNUSUAL}")
    return columns


def read_period(
    file: NamedFile, content: bytes, need_units: bool = False
) -> tuple[Table, dict[str, np.ndarray]]:
    """Read a file with equally spaced samples.

    Returns the table, and its columns as arrays in the units of the file.  Raises ValueError if the
    format of the file is wrong, or if the times are not equally spaced.
    """
    if file.grid != GRID or file.pitch:
        raise ValueError("allowed after the path: decimal=comma or encoding=cp1252")
    form: dict = {"decimal": DECIMALS[file.decimal], "encoding": file.encoding}
    table = read_table(content, FORM, need_units=need_units, **form)
    columns = columns_of(table)
    row = uneven_row(columns["time"], EVEN_TIMES) if "time" in columns else None
    if row is not None:
        where = table.lines[row]
        raise ValueError(f"line {where}: time is not equally spaced; allowed: equal steps")
    return table, columns


def create_samples(file: NamedFile, content: bytes) -> Sampled:
    """Create a motion from a data file.  Raises ValueError if the format of the file is wrong."""
    table, columns = read_period(file, content)
    for name in columns.keys() & set(COLUMNS):
        if table.units[name]:
            raise ValueError(
                f"{name} has the unit {table.units[name]}, which microslip predict accepts; "
                "allowed here: dimensionless numbers without a unit"
            )
    samples = Sampled.of_columns({name: columns.get(name) for name in COLUMNS})
    return replace(samples, text=file.name)


SI = {"forward": "m", "lateral": "m", "pressure": "Pa"}
"""SI unit of each column of a file with a pressure."""
MOST_POINTS = 1_000_000
SAME = 1e-9
"""Coordinates are treated as equal if they differ by less than this fraction of their range."""
FULL = "allowed: every point of a regular grid once"
HEADING = (
    "forward,lateral,pressure in any order, with units such as forward [mm] if at all; or a matrix "
    "of pressures alone, with pitch=0.5 mm after the path"
)
MATRIX = (
    "allowed: a header without numbers in columns, then one row of the matrix in each line up to "
    "the end of the file, with decimal=comma after the path for decimal commas, and such numbers "
    "in double quotes if commas separate them"
)
ALONE = "allowed: pressures alone, or columns forward,lateral,pressure without pitch"
NUMBER = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?|nan|inf|B", re.I | re.A)
"""Pattern of a cell of a matrix.  In Tekscan files, B marks a cell outside the sensor."""
DECIMALS_ALONE = re.compile(r"0\d+", re.A)
"""Pattern of a cell that contains only the decimals of a number, such as 05 in 1,05."""
END = "@@"
"""Last line of Tekscan files."""
LEAST_COORDINATES = 4
"""Evenly spaced values are interpreted as coordinates if there are at least this many values.
Three pressures can be evenly spaced by chance."""
EVEN = 0.05
"""Coordinates count as evenly spaced if the steps differ by at most this fraction of the first
step.  This value allows for coordinates rounded to 1/40 of the step."""
PITCH = re.compile(r"\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+", re.A)
ALLOWED_PITCH = "allowed: a length such as 0.5 mm, or forward x lateral as in 0.5 mm x 0.6 mm"
NETCDF = (".nc", ".nc4", ".cdf")
"""File name extensions of netCDF."""
BEGINNINGS = (b"\x89HDF", b"CDF\x01", b"CDF\x02", b"CDF\x05")
"""Possible first bytes of a netCDF file."""
LARGEST_CHUNK = 100_000_000
"""Largest allowed chunk of a netCDF file, in bytes.  HDF5 reads whole chunks.  The default chunks
of netCDF have up to 16 MB."""
VARIABLES = "allowed: a variable pressure with the dimensions and coordinates forward and lateral"

Values = tuple[Sequence[np.ndarray], Mapping[str, str | None]]
"""The result contains the two arrays of coordinates, the array of pressures, and the unit of each
array. The coordinates are arrays of shapes (n,) and (m,), and the pressures are an array of shape
(n, m)."""


def create_pressure(file: NamedFile, content: bytes) -> Measured:
    """Create a pressure from a data file.  Raises ValueError if the format of the file is wrong."""
    if file.grid not in READINGS:
        raise ValueError(f"allowed for grid is one of {', '.join(READINGS)}")
    if content.startswith(BEGINNINGS):
        if file.pitch:
            raise ValueError("pitch is for a matrix in a CSV file; allowed for netCDF: coordinates")
        values, units = _netcdf(content)
    elif PurePath(file.path).suffix.lower() in NETCDF:
        raise ValueError("not a netCDF file that can be read: it does not begin as one does")
    else:
        values, units = (_matrix if file.pitch else _points)(file, content)
    forward, lateral, pressure = values
    ratio, in_si = _factors(units)
    return Measured.on_grid(file.name, forward, ratio * lateral, pressure, file.grid, in_si)


def _factors(units: Mapping[str, str | None]) -> tuple[float, Units]:
    """Return the ratio of the unit of lateral lengths to the unit of forward lengths.  The second
    result contains both units; see `Units`."""
    factors: dict[str, float | None] = {}
    for name, si in SI.items():
        unit = units[name] or ""
        try:
            factors[name] = None if unit in ("", "1", "-") else read(f"1 {unit}", si).si
        except ValueError:
            example = "MPa" if si == "Pa" else "mm"
            problem = f"{name} [{unit[:40]}] is no known unit"
            raise ValueError(f"{problem}; allowed: one such as [{example}], or none") from None
    forward, lateral, pressure = factors.values()
    if (forward is None) != (lateral is None):
        name = "lateral" if forward is None else "forward"
        raise ValueError(f"{name} alone has a unit; allowed: one for both coordinates or none")
    return (lateral or 1.0) / (forward or 1.0), (forward, pressure)


def _refuse_many(count: int) -> None:
    if count > MOST_POINTS:
        raise ValueError(f"{count} points; allowed: at most {MOST_POINTS}")


# CSV


def _points(file: NamedFile, content: bytes) -> Values:
    """Read a table in which each line contains one point of the grid."""
    form: Any = {"decimal": DECIMALS[file.decimal], "encoding": file.encoding}
    table = read_table(content, SI, complete=HEADING, **form)
    columns = {name: np.array(one) for name, one in table.numbers({"pressure": 0.0}).items()}
    if not table.lines:
        raise ValueError("no points; allowed: a line with three numbers for each point of a grid")
    (forward, i), (lateral, j) = _distinct(columns["forward"]), _distinct(columns["lateral"])
    shape = f"{len(forward)} x {len(lateral)}"
    if max(len(i), len(forward) * len(lateral)) > MOST_POINTS:
        raise ValueError(f"{len(i)} points for a grid of {shape}; allowed: at most {MOST_POINTS}")
    count = np.zeros((len(forward), len(lateral)), int)
    np.add.at(count, (i, j), 1)
    for a, b in np.argwhere(count != 1)[:1]:
        lines = [table.lines[k] for k in np.flatnonzero((i == a) & (j == b))]
        place = f"forward {forward[a]:g}, lateral {lateral[b]:g}"
        where = f"lines {' and '.join(map(str, lines))} are" if lines else "no line is"
        raise ValueError(f"{where} the point {place} of a grid of {shape}; {FULL}")
    values = np.empty(count.shape)
    values[i, j] = columns["pressure"]
    return (forward, lateral, values), table.units


def _distinct(column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two arrays.  The first array contains the distinct coordinates in increasing order,
    and has the shape (n,).  For each point, the second array contains the index of its coordinate
    in the first array."""
    values, which = np.unique(column, return_inverse=True)
    group = np.concatenate([[0], np.cumsum(np.diff(values) > SAME * np.ptp(values))])
    return values[np.unique(group, return_index=True)[1]], group[which.reshape(-1)]


def _matrix(file: NamedFile, content: bytes) -> Values:
    """Read a matrix of pressures.  The numbers are parsed as a table in which each line contains
    one cell of the matrix."""
    forward, lateral, unit = _pitch(file.pitch)
    lines = lines_of(content, file.encoding)
    while lines and lines[-1].strip(";,\t ") in ("", END):
        lines.pop()
    marks, rows = zip(*(_split(line, file.decimal) for line in lines or [""]), strict=True)
    is_row = [any(row) and all(map(NUMBER.fullmatch, filter(None, row))) for row in rows]
    if True not in is_row:
        raise ValueError(f"no row of numbers; {MATRIX}")
    start = is_row.index(True)
    width = max(
        max((k + 1 for k, cell in enumerate(row) if cell), default=0) for row in rows[start:]
    )
    for k, (line, row) in enumerate(zip(lines, rows, strict=True)):
        numbers, cells = sum(map(bool, map(NUMBER.fullmatch, row))), row[:width]
        problem, allowed = "", MATRIX
        odd = next((j for j, cell in enumerate(cells) if not NUMBER.fullmatch(cell)), 0)
        counts = numbers > 1 or numbers and len(row) == len(rows[start])
        counts = counts and marks[k] == marks[start]
        if k <= start and counts and not NUMBER.fullmatch(row[0]) and numbers == len(cells) - 1:
            problem, allowed = f"cell 1 is {row[0][:40]!r}, as in a line of coordinates", ALONE
        elif k < start and counts:
            problem = f"cell {odd + 1} is {row[odd][:40]!r} in a line with numbers"
        elif k >= start and (not any(row) or line.startswith("#")):
            problem = "no row of the matrix"
        elif k >= start and "" in cells:
            problem = f"cell {cells.index('') + 1} is empty, where 0 stands for no pressure"
        elif k >= start and len(cells) < width:
            problem = f"{len(cells)} cells, but {width} in another line"
        elif k >= start and marks[k] == "," and any(map(DECIMALS_ALONE.fullmatch, cells)):
            problem = "digits after a zero, as if commas were decimal"
        if problem:
            raise ValueError(f"line {k + 1}: {problem}; {allowed}")
    flat = ["0" if cell == "B" else cell for row in rows[start:] for cell in row[:width]]
    _refuse_many(len(flat))
    mark = "," if marks[start] == "," and file.decimal == "point" else ";"
    text = "\n".join([f"pressure{mark}no", *(f'"{cell}"{mark}0' for cell in flat)])
    names, decimal = {"pressure": "", "no": ""}, DECIMALS[file.decimal]
    try:
        columns = read_table(text.encode(), names, decimal=decimal).numbers({"pressure": 0.0})
    except ValueError as error:
        _, line, problem = re.split(r"line (\d+)", str(error), maxsplit=1)
        place, column = divmod(int(line) - 2, width)
        raise ValueError(f"line {start + place + 1}, cell {column + 1}{problem}") from None
    values = np.array(columns["pressure"]).reshape(-1, width)
    n, m = values.shape
    if min(n, m) < 2:
        raise ValueError(f"a matrix of {n} x {m}; allowed: two rows and two columns, or more")
    for side, edge in (("row", values[0]), ("column", values[:, 0])):
        steps = np.diff(edge[1:])
        is_even = len(steps) + 1 >= LEAST_COORDINATES and np.ptp(steps) <= EVEN * abs(steps[0])
        if is_even and steps[0] != 0.0:
            raise ValueError(f"the numbers of the first {side} look like coordinates; {ALONE}")
    return (np.arange(n) * forward, np.arange(m) * lateral, values), unit


def _split(line: str, decimal: str) -> tuple[str | None, list[str]]:
    """Split a line of a matrix, and return the separator and the cells."""
    marks = ";\t," if decimal == "point" or '"' in line else ";\t"
    unquoted = re.sub('"[^"]*"', "", line)
    separator = next(filter(unquoted.__contains__, marks), None)
    cells = line.split() if separator is None else next(csv.reader([line], delimiter=separator))
    return separator, [cell.strip().strip("\"'").strip() for cell in cells]


def _pitch(text: str) -> tuple[float, float, Mapping[str, str | None]]:
    """Return the forward and the lateral distance between neighbouring cells of a matrix, and the
    unit of each distance.

    text: a length such as "0.5 mm" for both distances, or two lengths such as "0.5 mm x 0.6 mm".
    """
    parts = [(PITCH.match(part.strip()), part.strip()) for part in text.split(" x ")]
    lengths = [(float(one[0]), part[one.end() :].strip()) for one, part in parts if one]
    if not len(lengths) == len(parts) <= 2 or not all(0.0 < one < math.inf for one, _ in lengths):
        raise ValueError(f"pitch is {text[:40]!r}; {ALLOWED_PITCH}")
    (forward, unit), (lateral, other) = lengths[0], lengths[-1]
    return forward, lateral, {"forward": unit, "lateral": other, "pressure": None}


# netCDF


def _netcdf(content: bytes) -> Values:
    """Read a netCDF file.  Sizes are checked before any values are read into memory."""
    import netCDF4  # imported here, because loading takes a while

    try:
        with netCDF4.Dataset("pressure", memory=content) as data:
            return _variables(data)
    except (OSError, RuntimeError, AttributeError, TypeError) as error:
        reason = " ".join(str(error).split())[:120]
        raise ValueError(f"not a netCDF file that can be read: {reason}") from None


def _variables(data: Any) -> Values:
    units: dict[str, str | None] = {}
    values: list[np.ndarray] = []
    for name in SI:
        if name not in data.variables:
            raise ValueError(f"there is no variable {name}; {VARIABLES}")
        variable = data[name]
        expected = {"forward", "lateral"} if name == "pressure" else {name}
        if set(variable.dimensions) != expected:
            dimensions = ", ".join(variable.dimensions) or "none"
            raise ValueError(f"{name} has the dimensions {dimensions}; {VARIABLES}")
        attributes = {key: variable.getncattr(key) for key in variable.ncattrs()}
        held = attributes.get("dtype", variable.dtype)  # xarray stores booleans as integers
        if held == "bool" or getattr(variable.dtype, "kind", "") not in ("i", "u", "f"):
            raise ValueError(f"{name} holds {held}; allowed: numbers")
        _refuse_many(variable.size)
        chunk = variable.chunking()  # None in netCDF 3 files
        if isinstance(chunk, list) and math.prod(chunk) * variable.dtype.itemsize > LARGEST_CHUNK:
            shape = " x ".join(map(str, chunk))
            allowed = f"allowed: chunks of at most {LARGEST_CHUNK / 1e6:g} MB"
            raise ValueError(f"{name} is stored in chunks of {shape}; {allowed}")
        given = [text for key, text in attributes.items() if key.lower() in ("unit", "units")]
        if len(given) > 1 or not all(isinstance(text, str) for text in given):
            found = ", ".join(map(str, given))[:80]
            raise ValueError(f"{name} has the units {found}; allowed: one attribute units, a text")
        units[name] = given[0] if given else None
        values.append(np.ma.filled(np.ma.asarray(variable[:], float), np.nan))
    if not values[2].size:
        raise ValueError("no points; allowed: two or more along each coordinate")
    forward, lateral, pressure = values
    pressure = pressure if data["pressure"].dimensions[0] == "forward" else pressure.T
    along, across = np.argsort(forward), np.argsort(lateral)
    return (forward[along], lateral[across], pressure[np.ix_(along, across)]), units
