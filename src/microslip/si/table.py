"""Many contacts at once: arrays of quantities in, a dataset out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.predict import predict
from microslip.si.prediction import Prediction

if TYPE_CHECKING:
    import xarray as xr

MOST_CASES = 100_000
UNITS = (("_N_m", "N m"), ("_N_s_m", "N s m-1"), ("_m_s", "m s-1"), ("_rad_s", "rad s-1"))
UNITS += (("_Pa", "Pa"), ("_Hz", "Hz"), ("_kg", "kg"), ("_rad", "rad"), ("_W", "W"), ("_J", "J"))
UNITS += (("_N", "N"), ("_m", "m"), ("_s", "s"))
"""Ends of names of fields, and the units that they stand for; the first that fits counts."""
OTHER_UNITS = {"drive_stiffness_N_m": "N m-1", "time_to_1_mm_s": "s"}
TEXTS = ("warnings", "not_checked")


def predict_table(scene: str, cases: Mapping[str, object], **shared: object) -> xr.Dataset:
    """Predictions for a table of contacts.

    Parameters
    ----------
    scene : str
        As for `microslip.predict`.
    cases : mapping
        Sequences of one length by the names of predict's arguments: {"load": ["1 N", "10 N"]}.
    shared
        What all cases have in common, as for `microslip.predict`.

    Returns
    -------
    xarray.Dataset
        Every field of Prediction over `case`, NaN for what a case does not have, with units; texts
        joined by semicolons.  `case_` and a name in front is what was given.

    Raises
    ------
    InputError
        As predict does, with the number of the case in front of what is allowed.
    """
    count = _count(cases, shared)
    found = []
    for case in range(count):
        try:
            found.append(predict(scene, **shared, **{k: v[case] for k, v in cases.items()}))
        except InputError as error:
            allowed = f"in case {case}: {error.allowed}"
            raise InputError(error.argument, error.value, allowed) from None
    return _dataset(scene, cases, found)


def _count(cases, shared):
    """How many cases there are; raises InputError for a table that is none."""
    if not isinstance(cases, Mapping) or not cases:
        raise InputError("cases", cases, "allowed is a mapping of names to sequences")
    for name, values in cases.items():
        if name in shared:
            raise InputError(name, shared[name], "allowed once: it is in the table, too")
        if isinstance(values, str) or not hasattr(values, "__len__"):
            raise InputError(name, values, "allowed is a sequence with a value for each case")
    counts = {len(values) for values in cases.values()}
    if len(counts) > 1:
        raise InputError("cases", sorted(counts), "allowed are columns of one length")
    (count,) = counts
    if not 0 < count <= MOST_CASES:
        raise InputError("cases", count, f"allowed are 1 to {MOST_CASES} cases")
    return count


def _dataset(scene, cases, found):
    import xarray as xr

    variables = {}
    for field in fields(Prediction):
        values = [getattr(one, field.name) for one in found]
        if field.name in ("scene", "understood"):
            continue
        if field.name in TEXTS:
            column, about = ["; ".join(texts) for texts in values], {}
        elif all(isinstance(value, str | None) for value in values):
            column, about = ["" if value is None else value for value in values], {}
            if all(value is None for value in values):  # a number that no case has
                column, about = np.full(len(found), np.nan), {"units": _unit(field.name)}
        elif isinstance(values[0], bool):
            column, about = values, {}
        else:
            column = [np.nan if value is None else float(value) for value in values]
            about = {"units": _unit(field.name)}
        variables[field.name] = "case", column, about
    variables |= {
        f"case_{name}": ("case", [str(one) for one in values]) for name, values in cases.items()
    }
    return xr.Dataset(variables, {"case": np.arange(len(found))}, {"scene": scene})


def _unit(name):
    """Of a field, in the SI; "1" for what has none, and for errors that of what they are of."""
    if name in OTHER_UNITS:
        return OTHER_UNITS[name]
    return next((unit for end, unit in UNITS if name.endswith(end)), "1")
