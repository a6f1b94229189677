"""Pressures from files, "file:measured.csv": a grid of them, see pressures.measured.

CSV: one line a point, forward,lateral,pressure, with a first line that says so; netCDF: a variable
``pressure`` with the coordinates ``forward`` and ``lateral``.  The points fill a regular grid, in
any unit of length and of pressure.  A relative path counts from the working directory, or from the
folder that the environment names as MICROSLIP_FILES if there is no such file.
"""

from __future__ import annotations

import hashlib
import os
from functools import lru_cache
from pathlib import Path

import numpy as np

from .errors import InputError
from .pressures import SOURCES
from .pressures.measured import of_grid

NAME = "file"
COLUMNS = ("forward", "lateral", "pressure")
DIGITS = 16


def pressure(text):
    """The Pressure in a file; text: its path, and perhaps ",sha256=...", the first digits of its
    digest.  The name of the record has the digest, so that results belong to the content.

    Raises InputError for a file that cannot be read, is not as described above, or is not the one
    that the digest is of.
    """
    path, _, digest = text.partition(",sha256=")
    said = f"{NAME}:{text}"
    if not path:
        raise InputError("pressure", said, "allowed is a file, as in file:measured.csv")
    there = Path(path)
    if not there.exists():
        there = Path(os.environ.get("MICROSLIP_FILES", ""), path)
    try:
        content = there.read_bytes()
    except OSError as error:
        raise InputError("pressure", said, f"{path} cannot be read: {error.strerror}") from None
    found = hashlib.sha256(content).hexdigest()[:DIGITS]
    if digest not in ("", found):
        raise InputError("pressure", said, f"{path} has changed: its sha256 begins with {found}")
    return _of_content(path, str(there), found)


@lru_cache(maxsize=8)
def _of_content(path, there, digest):
    name = f"{NAME}:{path},sha256={digest}"
    try:
        table = _netcdf(there) if path.endswith((".nc", ".nc4", ".cdf")) else _csv(there)
        return of_grid(name, *table)
    except ValueError as error:
        raise InputError("pressure", f"{NAME}:{path}", str(error)) from None


def _csv(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        head = tuple(word.strip().strip('"') for word in file.readline().split(","))
        if head != COLUMNS:
            raise ValueError(
                f"the first line is {','.join(head)[:80]!r}; allowed: {','.join(COLUMNS)}"
            )
        lines = [line for line in file if line.strip()]
        try:
            rows = np.loadtxt(lines, delimiter=",", ndmin=2) if lines else np.empty((0, 3))
        except ValueError as error:
            raise ValueError(f"not three numbers a line: {str(error)[:120]}") from None
    if rows.shape[1:] != (3,) or len(rows) == 0:
        raise ValueError("allowed are lines of three numbers, forward,lateral,pressure")
    forward, i = np.unique(rows[:, 0], return_inverse=True)
    lateral, j = np.unique(rows[:, 1], return_inverse=True)
    values = np.full((len(forward), len(lateral)), np.nan)
    values[i, j] = rows[:, 2]
    if len(rows) != values.size or np.isnan(values).any():
        raise ValueError(
            f"{len(rows)} points do not fill a grid of {len(forward)} x {len(lateral)}; allowed: "
            "every point of a regular grid once"
        )
    return forward, lateral, values


def _netcdf(path):
    import xarray as xr  # only here: it takes a while to load

    try:
        data = xr.load_dataset(path)
    except (OSError, ValueError) as error:
        raise ValueError(f"not a netCDF file: {str(error)[:120]}") from None
    missing = [name for name in COLUMNS if name not in data.variables]
    if missing or set(data["pressure"].dims) != set(COLUMNS[:2]):
        raise ValueError(
            "allowed is a variable pressure with the dimensions and coordinates forward and lateral"
        )
    values = data["pressure"].sortby(["forward", "lateral"]).transpose("forward", "lateral")
    return tuple(np.array(part, float) for part in (values.forward, values.lateral, values))


SOURCES[NAME] = pressure
