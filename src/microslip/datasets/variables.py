"""Dataset variables with the attributes of the CF conventions.

The table variables.csv describes every variable of a sweep's dataset, except the closed forms,
which are described in catalogue.csv.  The columns of variables.csv are:

- group: part of the dataset, or kind of sweep, that has the variable,
- name, dims, kind, units: name, dimensions (of variables outside the map), type and unit,
- source: entry of a result that contains the values; if the column is empty, the entry has the name
  of the variable,
- long_name: text that is short enough for the axis of a plot,
- description: longer text,
- flag_meanings: meanings of 0 and 1, if these are not "no" and "yes".

If a variable contains a change, the column `source` names the variable whose change is computed.
"""

from __future__ import annotations

import csv
from collections.abc import Hashable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

ANCILLARY = "ancillary_variables"
"""Name of the attribute that states which variable contains the error of a variable."""
TYPES: dict[str, type] = {"float": float, "int": np.int32, "bool": bool, "str": object}
"""Types of values, keyed by their names in tables.  Any other entry in the column of types lists
the meanings of the codes 0, 1, ..., separated by spaces."""
MISSING = {"float": np.nan, "str": ""}
"""Value that replaces a missing entry, keyed by the type of the variable.  For the other types,
this value is 0."""


def rows(path: Path) -> list[dict[str, str]]:
    """Read the rows of a CSV table as dicts."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


TABLE = {row["name"]: row for row in rows(Path(__file__).with_suffix(".csv"))}
"""Rows of variables.csv, keyed by the name of the variable."""


def rows_of(*groups: str) -> dict[str, dict[str, str]]:
    """Return the rows of variables.csv that belong to the given groups, as a dict keyed by name, in
    the order of the file."""
    return {name: row for group in groups for name, row in TABLE.items() if row["group"] == group}


def columns(
    table: Iterable[Mapping[str, str]], entries: Iterable[Mapping], size: int
) -> dict[str, np.ndarray]:
    """Return the values of variables along one dimension, as a dict keyed by name.

    Parameters
    ----------
    table : iterable of mapping
        Rows of the variables, with the entries name, kind and source.
    entries : iterable of mapping
        Entries of each result.  For an entry that is missing or None, the value of MISSING is used.
        Only one result is in memory at a time.
    size : int
        Length of the dimension.

    Raises
    ------
    ValueError
        If there are fewer results than `size`.
    """
    sources = {row["name"]: row["source"] or row["name"] for row in table}
    values: dict[str, np.ndarray] = {
        row["name"]: np.full(size, MISSING.get(row["kind"], 0), TYPES.get(row["kind"], np.int8))
        for row in table
    }
    count = 0
    for count, result in enumerate(entries, 1):
        for name, source in sources.items():
            if (value := result.get(source)) is not None:
                values[name][count - 1] = value
    if count != size:
        raise ValueError(f"{count} results for {size} points")
    return values


def described(
    row: Mapping[str, str], values: ArrayLike, dims: str | Sequence[Hashable] | None = None
) -> tuple:
    """Return a variable as the tuple (dims, values, attributes) for xarray.Dataset.

    Parameters
    ----------
    row : mapping of str to str
        Row of a table, or some of its entries: long_name, kind (by default "float"), units (by
        default "1"), description and flag_meanings.
    values : array_like
        Values of the variable.
    dims : str or sequence, optional
        Dimensions, if they are not in the row.
    """
    kind, units = row.get("kind", "float"), row.get("units", "1")
    about: dict = {"long_name": row["long_name"]}
    if kind == "bool" or kind not in TYPES:  # stored as bytes; xarray reads bool as bool
        meanings = row.get("flag_meanings") or ("no yes" if kind == "bool" else kind)
        codes = np.arange(len(meanings.split()), dtype=np.int8)
        about |= {"flag_values": codes, "flag_meanings": meanings}
    elif kind != "str" and units:
        about["units"] = units
    if row.get("description"):
        about["description"] = row["description"]
    dims = row["dims"].split() if dims is None else dims
    return dims, np.array(values).astype(TYPES.get(kind, np.int8)), about
