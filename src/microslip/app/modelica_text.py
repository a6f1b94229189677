"""Text files of tables for Modelica.Blocks.Tables, which interpolates in one or two dimensions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from microslip.app.question import heading

if TYPE_CHECKING:
    import xarray as xr


def text_of(dataset: xr.Dataset, comments: Sequence[str]) -> str:
    """Return the variables of a dataset as tables.

    With one axis, there is one table `friction` for CombiTable1Ds, with the axis in its first
    column.  With more axes, each variable has a table for CombiTable2Ds: the first axis is u1 and
    the second one is u2.  Each combination of values on further axes has its own numbered table.
    """
    lines = ["#1", *(f"# {text}" for text in comments)]
    for name, note, rows in _tables(dataset):
        lines += [f"double {name}({rows.shape[0]},{rows.shape[1]}) # {note}"]
        lines += [" ".join(f"{value:.15g}" for value in row) for row in rows]
    return "\n".join(lines) + "\n"


def _tables(dataset: xr.Dataset) -> Iterator[tuple[str, str, np.ndarray]]:
    """Yield the name, comment and values of each table."""
    first, *others = dataset.dims
    x = dataset[first].values
    if not others:
        columns = ", ".join(map(_title, (dataset[first], *dataset.values())))
        values = [one.values for one in dataset.values()]
        yield "friction", f"columns: {columns}", np.stack([x, *values], axis=1)
        return
    second, *rest = others
    corner = np.concatenate([[0.0], dataset[second].values])
    for name, values in dataset.items():
        places = product(*(range(dataset.sizes[axis]) for axis in rest))
        for number, place in enumerate(places, 1):
            chosen = values.isel(dict(zip(rest, place, strict=True)))
            note = f"{_title(values)}; u1: {_title(dataset[first])}; u2: {_title(dataset[second])}"
            note += "".join(f"; {_title(chosen[axis])} = {float(chosen[axis]):g}" for axis in rest)
            rows = np.concatenate([x[:, None], chosen.transpose(first, second).values], axis=1)
            yield f"{name}_{number}" if rest else str(name), note, np.vstack([corner, rows])


def _title(values: xr.DataArray) -> str:
    """Return the long name and the unit of a variable."""
    return heading(values.attrs["long_name"], values.attrs["units"])
