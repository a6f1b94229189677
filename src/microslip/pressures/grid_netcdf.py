"""Read a grid of pressures from a netCDF file.  Its variable `pressure` depends on `forward` and
`lateral`."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from microslip.pressures.grid_units import COLUMNS, MOST_POINTS, Units, read_units

if TYPE_CHECKING:
    import xarray as xr

BEGINNINGS = (b"\x89HDF", b"CDF\x01", b"CDF\x02", b"CDF\x05")
"""First bytes of netCDF files."""
LARGEST_CHUNK = 100_000_000
"""Largest chunk in bytes.  HDF5 reads whole chunks; the default chunks of netCDF have up to 16
MB."""
ALLOWED = "allowed: a variable pressure with the dimensions and coordinates forward and lateral"


def grid(content: bytes) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], Units]:
    """Return the coordinates (n,) and (m,), the pressures (n, m) and the Units in a netCDF file.

    Raises
    ------
    ValueError
        If the content has another format.  The message is a single line.
    """
    import xarray as xr  # only here, because it takes a while to load

    with tempfile.TemporaryDirectory(prefix="microslip-") as folder:
        path = Path(folder, "pressure.nc")
        path.write_bytes(content)
        try:
            _refuse_oversized(path)
            with xr.open_dataset(path, engine="netcdf4", decode_times=False) as data:
                return _grid(data)
        except (OSError, RuntimeError, AttributeError, TypeError) as error:
            reason = " ".join(str(error).replace(str(path), "the file").split())[:120]
            raise ValueError(f"not a netCDF file that can be read: {reason}") from None


def _refuse_oversized(path: Path) -> None:
    """Raise ValueError if a dimension or a chunk is too large, before it is read into memory.

    xarray reads the coordinates of all dimensions when it opens a file, and HDF5 reads whole
    chunks.
    """
    import netCDF4  # only here, because it takes a while to load

    with netCDF4.Dataset(path) as file:
        for name, dimension in file.dimensions.items():
            if len(dimension) > MOST_POINTS:
                raise ValueError(
                    f"the dimension {name} has {len(dimension)} points; allowed: at most "
                    f"{MOST_POINTS}"
                )
        for name, variable in file.variables.items():
            chunk = variable.chunking()  # None in netCDF 3 files
            size = getattr(variable.dtype, "itemsize", 1)  # strings of any length have no itemsize
            if isinstance(chunk, list) and math.prod(chunk) * size > LARGEST_CHUNK:
                raise ValueError(
                    f"{name} is stored in chunks of {' x '.join(map(str, chunk))}; allowed: chunks "
                    f"of at most {LARGEST_CHUNK / 1e6:g} MB"
                )


def _grid(data: xr.Dataset) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], Units]:
    missing = [name for name in COLUMNS if name not in data.variables]
    if missing:
        raise ValueError(f"there is no variable {missing[0]}; {ALLOWED}")
    for name, dims in zip(COLUMNS, ({"forward"}, {"lateral"}, {"forward", "lateral"}), strict=True):
        if set(data[name].dims) != dims:
            dimensions = ", ".join(map(str, data[name].dims)) or "none"
            raise ValueError(f"{name} has the dimensions {dimensions}; {ALLOWED}")
        if data[name].dtype.kind not in "iuf":
            raise ValueError(f"{name} holds {data[name].dtype}; allowed: numbers")
    if data["pressure"].size > MOST_POINTS:
        raise ValueError(f"{data['pressure'].size} points; allowed: at most {MOST_POINTS}")
    if not data["pressure"].size:
        raise ValueError("no points; allowed: two or more along each coordinate")
    ratio, units = read_units([_unit(name, data[name].attrs) for name in COLUMNS])
    forward, lateral, values = (
        np.array(data[name].transpose(*(d for d in COLUMNS if d in data[name].dims)), float)
        for name in COLUMNS
    )
    along, across = np.argsort(forward), np.argsort(lateral)
    return (forward[along], lateral[across] * ratio, values[np.ix_(along, across)]), units


def _unit(name: str, attributes: Mapping[str, object]) -> str | None:
    """Return the unit of a variable from its attribute "unit" or "units", in upper or lower case;
    None if there is no such attribute."""
    values = [value for key, value in attributes.items() if key.lower() in ("unit", "units")]
    texts = [value for value in values if isinstance(value, str)]
    if len(values) > 1 or len(texts) < len(values):
        units = ", ".join(map(str, values))[:80]
        raise ValueError(f"{name} has the units {units}; allowed: one attribute units, a text")
    return texts[0] if texts else None
