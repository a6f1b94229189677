"""A grid of pressures as netCDF: a variable `pressure` over `forward` and `lateral`."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from microslip.pressures import grid_units
from microslip.pressures.grid_units import COLUMNS, MOST_POINTS

if TYPE_CHECKING:
    import xarray as xr

BEGINNINGS = (b"\x89HDF", b"CDF\x01", b"CDF\x02", b"CDF\x05")
LARGEST_CHUNK = 100_000_000
"""Bytes of a chunk, which HDF5 reads as a whole; the largest default of netCDF is 16 MB."""
ALLOWED = "allowed: a variable pressure with the dimensions and coordinates forward and lateral"


def grid(content: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Coordinates and pressures of a netCDF file, shapes (n,), (m,) and (n, m).

    Raises
    ------
    ValueError
        For what is not described above, in one line.
    """
    import xarray as xr  # only here: it takes a while to load

    with tempfile.TemporaryDirectory(prefix="microslip-") as folder:
        path = Path(folder, "pressure.nc")
        path.write_bytes(content)
        try:
            _refuse_oversized(path)
            with xr.open_dataset(path, engine="netcdf4", decode_times=False) as data:
                return _grid(data)
        except (OSError, RuntimeError, AttributeError, TypeError) as error:
            said = " ".join(str(error).replace(str(path), "the file").split())[:120]
            raise ValueError(f"not a netCDF file that can be read: {said}") from None


def _refuse_oversized(path: Path) -> None:
    """Raise ValueError for declared sizes that are too large, before anything is allocated.

    xarray reads the coordinates of all dimensions when it opens a file, and HDF5 whole chunks.
    """
    import netCDF4  # only here: it takes a while to load

    with netCDF4.Dataset(path) as file:
        for name, dimension in file.dimensions.items():
            if len(dimension) > MOST_POINTS:
                raise ValueError(
                    f"the dimension {name} has {len(dimension)} points; allowed: at most "
                    f"{MOST_POINTS}"
                )
        for name, variable in file.variables.items():
            chunk = variable.chunking()  # None in files of netCDF 3
            size = getattr(variable.dtype, "itemsize", 1)  # texts of any length have none
            if isinstance(chunk, list) and math.prod(chunk) * size > LARGEST_CHUNK:
                raise ValueError(
                    f"{name} is stored in chunks of {' x '.join(map(str, chunk))}; allowed: chunks "
                    f"of at most {LARGEST_CHUNK / 1e6:g} MB"
                )


def _grid(data: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    missing = [name for name in COLUMNS if name not in data.variables]
    if missing:
        raise ValueError(f"there is no variable {missing[0]}; {ALLOWED}")
    for name, dims in zip(COLUMNS, ({"forward"}, {"lateral"}, {"forward", "lateral"}), strict=True):
        if set(data[name].dims) != dims:
            said = ", ".join(map(str, data[name].dims)) or "none"
            raise ValueError(f"{name} has the dimensions {said}; {ALLOWED}")
        if data[name].dtype.kind not in "iuf":
            raise ValueError(f"{name} holds {data[name].dtype}; allowed: numbers")
    if data["pressure"].size > MOST_POINTS:
        raise ValueError(f"{data['pressure'].size} points; allowed: at most {MOST_POINTS}")
    if not data["pressure"].size:
        raise ValueError("no points; allowed: two or more along each coordinate")
    factors = grid_units.factors([_unit(name, data[name].attrs) for name in COLUMNS])
    forward, lateral, values = (
        np.array(data[name].transpose(*(d for d in COLUMNS if d in data[name].dims)), float)
        * factor
        for name, factor in zip(COLUMNS, factors, strict=True)
    )
    along, across = np.argsort(forward), np.argsort(lateral)
    return forward[along], lateral[across], values[np.ix_(along, across)]


def _unit(name: str, attributes: Mapping[str, object]) -> str | None:
    """The unit among the attributes of a variable, however the attribute is spelt."""
    given = [value for key, value in attributes.items() if key.lower() in ("unit", "units")]
    texts = [value for value in given if isinstance(value, str)]
    if len(given) > 1 or len(texts) < len(given):
        said = ", ".join(map(str, given))[:80]
        raise ValueError(f"{name} has the units {said}; allowed: one attribute units, a text")
    return texts[0] if texts else None
