"""Write datasets to netCDF files with groups, and read such files.

The root of a file contains the variables that have the sweep's axes.  The root can therefore be
converted to one table, or joined with the roots of other files.  Variables with other axes, such as
curves and single runs, are in groups.  A group is opened by its name:

    xr.open_dataset(path)                    # the root
    xr.open_dataset(path, group="history")   # one of its groups
    microslip.datasets.netcdf.whole(path)             # root and groups as one dataset
"""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import netCDF4
import numpy as np
import xarray as xr

from microslip.datasets.variables import ANCILLARY
from microslip.foundation.errors import CacheError, InputError
from microslip.foundation.files import writing_beside


def divide(
    dataset: xr.Dataset, groups: Iterable[Mapping[str, str]]
) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Divide a dataset into several: one for the root of a file, and one for each group.

    Parameters
    ----------
    dataset : xarray.Dataset
        All variables.
    groups : iterable of mapping
        For each group, a mapping with its name `group`, its `title` and its dimensions `dims`.  A
        variable is assigned to the first group that has all dimensions of the variable.

    Returns
    -------
    root : xarray.Dataset
        Variables that fit no group or have no dimension, with all attributes of the dataset.
    parts : dict of xarray.Dataset
        Datasets of the groups, by name.  Empty groups are omitted.
    """
    remaining, parts = {n: set(v.dims) for n, v in dataset.data_vars.items()}, {}
    for group in groups:
        own = {*group["dims"].split()}
        names = [name for name, dims in remaining.items() if dims and dims <= own]
        if names:
            part = dataset[names].drop_attrs(deep=False)
            parts[group["group"]] = part.assign_attrs(title=group["title"])
        remaining = {name: dims for name, dims in remaining.items() if name not in names}
    return dataset[list(remaining)], parts


TEXTS = "flag_texts"
"""Name of the attribute that lists the strings behind the codes of a variable.  Each line contains
one string, in the order of `flag_values`.  The attribute `flag_meanings` lists the strings as
single words, as CF requires."""


def coded(variable: xr.Variable) -> xr.Variable:
    """Encode a variable of strings as integers with the attributes flag_values and flag_meanings.

    Integers are supported by all operations of xarray, also on disk and in dask chunks.  The code
    of a string is its CRC-32 in 31 bits, and 0 for an empty string.  A string therefore has the
    same code in all files, and files can be joined.
    """
    codes: dict[int, str] = {}
    code_of = {}
    for text in sorted(set(map(str, variable.values.flat)) or {""}):
        line = " ".join(text.split())
        code = zlib.crc32(line.encode()) & 0x7FFFFFFF
        while codes.setdefault(code, line) != line:
            code = (code + 1) & 0x7FFFFFFF
        code_of[text] = code
    values = np.array([code_of[str(text)] for text in variable.values.flat], np.int32)
    words: dict[str, None] = {}
    for line in codes.values():
        word = re.sub(r"[^A-Za-z0-9_.+@-]+", "_", line).strip("_") or "none"
        words[word if word not in words else f"{word}_{len(words)}"] = None
    flags = {"flag_values": np.array(list(codes), np.int32), "flag_meanings": " ".join(words)}
    flags |= {TEXTS: "\n".join(codes.values())}
    return xr.Variable(variable.dims, values.reshape(variable.shape), variable.attrs | flags)


def texts(codes: xr.DataArray) -> xr.DataArray:
    """Convert the codes in a variable to the strings that they stand for.

    For example, the variables `model` and `reason` of a map contain codes.

    Parameters
    ----------
    codes : xarray.DataArray
        Variable of a dataset, or a selection of it, with the attribute flag_texts.

    Returns
    -------
    xarray.DataArray
        The strings, in dask chunks if the codes are in dask chunks.  "?" stands for a code without
        a string, which comes from another dataset joined with this one.

    Raises
    ------
    InputError
        If the variable has no attribute flag_texts.
    """
    if TEXTS not in getattr(codes, "attrs", {}):
        name = getattr(codes, "name", codes)
        raise InputError("codes", name, f"allowed is a variable with the attribute {TEXTS}")
    values = np.atleast_1d(codes.attrs["flag_values"]).tolist()
    text_of = dict(zip(values, codes.attrs[TEXTS].split("\n"), strict=True))
    kind = f"U{max(map(len, text_of.values())) or 1}"

    def look_up(part: np.ndarray) -> np.ndarray:
        return np.array([text_of.get(code, "?") for code in part.flat], kind).reshape(part.shape)

    out = xr.apply_ufunc(look_up, codes, dask="parallelized", output_dtypes=[kind])
    about = {"flag_values", "flag_meanings", TEXTS}
    out.attrs = {name: value for name, value in codes.attrs.items() if name not in about}
    return out


def write(
    path: str | os.PathLike[str], root: xr.Dataset, parts: Mapping[str, xr.Dataset] | None = None
) -> None:
    """Write a root and its groups to a netCDF-4 file atomically.  Identical datasets give
    byte-identical files.

    parts: datasets of the groups, by name.  Raises CacheError with a one-line message if the file
    cannot be written.
    """
    with writing_beside(path) as beside:
        _append(root, beside, mode="w")
        for group, part in (parts or {}).items():
            _append(part, beside, mode="a", group=group)


def _append(dataset: xr.Dataset, path: str | os.PathLike[str], **how: Any) -> None:
    of_text = {n: v for n, v in dataset.variables.items() if v.dtype.kind in "OUT"}
    dataset = dataset.assign({n: coded(v) for n, v in of_text.items() if n not in dataset.dims})
    # xarray mistakes an empty axis of strings for an axis of numbers.
    empty = {n: v.astype(str) for n, v in of_text.items() if n in dataset.dims and not v.size}
    dataset = dataset.assign_coords(empty)
    for name, variable in dataset.variables.items():
        if f"{name}_error" in dataset.variables:
            variable.attrs[ANCILLARY] = f"{name}_error"
    encoding = {name: _encoding(name, v.dtype.kind) for name, v in dataset.variables.items()}
    dataset.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding, **how)


def _encoding(name: Hashable, kind: str) -> dict:
    if kind == "f":
        return {"_FillValue": None}
    if kind in "OUT":
        # Axes of strings are stored as arrays of characters, and other strings as codes (see
        # `coded`).  If an open file is opened again, HDF5 loses the type of variable-length
        # strings, and Python crashes.  Each variable has its own dimension of characters, so that a
        # selection can be saved.
        return {"dtype": "S1", "char_dim_name": f"characters_of_{name}"}
    return {}


def refuse_oversized(path: str | os.PathLike[str]) -> None:
    """Raise CacheError if a file declares more values than it has bytes.

    xarray reads coordinates into memory when it opens a file, so a damaged file could fill the
    memory.  Data of sweeps hardly compress, so an intact file has more bytes than values.
    """
    size = os.stat(path).st_size
    with netCDF4.Dataset(path) as file:
        groups = [file]
        while groups:
            group = groups.pop()
            groups += group.groups.values()
            lengths = {name: len(dimension) for name, dimension in group.dimensions.items()}
            lengths |= {name: variable.size for name, variable in group.variables.items()}
            for name, length in lengths.items():
                if length > size:
                    raise CacheError(
                        f"{path}: {name} has {length} values in a file of {size} bytes; allowed: a "
                        "dataset of the workflow"
                    )


def group_names(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """Return the names of a file's groups, in the order of the file."""
    with netCDF4.Dataset(path) as file:
        return tuple(file.groups)


def whole(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read the root and all groups of a file into one dataset with the attributes of the root.

    Codes are decoded to strings.

    Raises CacheError if the file declares more values than it has bytes.  Raises xarray's errors if
    the file is not a netCDF file.
    """
    refuse_oversized(path)
    dataset = xr.load_dataset(path, engine="netcdf4")
    for group in group_names(path):
        part = xr.load_dataset(path, engine="netcdf4", group=group)
        dataset = dataset.merge(part, compat="identical", join="exact")
    coded_names = [n for n, v in dataset.variables.items() if TEXTS in v.attrs]
    return dataset.assign({name: texts(dataset[name]) for name in coded_names})
