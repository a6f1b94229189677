"""Pack sweeps without stored periods as maps and lines. Each point has a value and an error.

A sweep over velocities and amplitudes is shown as a map for each Poisson's ratio. Other sweeps, and
sweeps with a drive, are shown as lines. The abscissa of the lines is the longest axis, and there is
one line for each combination of the other axes.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.datasets.catalogue import FORMS, ClosedForm
from microslip.datasets.interpolation import Axis
from microslip.foundation.canonical import number
from microslip.report.figures import style
from microslip.report.figures.data import at_each_poisson, curve, limit, spans_a_map
from microslip.report.figures.formulas import html
from microslip.report.figures.maps import CURVES
from microslip.sweeps.evaluate import plain

POINTS = ("mu_macro", "mu_macro_error", "converged", "model", "reason")
AXES = ("mass", "damping", "stiffness", "amplitude", "force", "velocity")
"""Possible axes of a dataset besides Poisson's ratio."""
DRIVE = "drive"
"""Attribute that only datasets with a drive have."""
SPARE_COLOURS = (style.SKY, style.GREY)
NAMES = {
    name: form
    for forms in FORMS.values()
    for name, form in forms.items()
    if not name.startswith("mu_torque")
}
"""Closed form of each friction limit, by variable name."""


def is_map(dataset: xr.Dataset) -> bool:
    """Return whether a dataset is shown as maps instead of lines."""
    return DRIVE not in dataset.attrs and spans_a_map(dataset)


def maps(name: str, dataset: xr.Dataset) -> list[dict]:
    """Pack the maps at all Poisson's ratios as JSON values."""
    return [_map(name, part) for part in at_each_poisson(dataset)]


def _map(name: str, dataset: xr.Dataset) -> dict:
    shown = dataset.transpose("amplitude", "velocity", ...)
    return about(name, dataset) | {
        "labels": [axis_label(shown, dim) for dim in ("velocity", "amplitude")],
        "velocity": plain(shown["velocity"].values),
        "amplitude": plain(shown["amplitude"].values),
        "points": {key: plain(shown[key].values) for key in POINTS},
        "limits": limits_of(shown),
        "periods": {"index": None, "failed": [], "count": 0},
    }


def lines(name: str, dataset: xr.Dataset) -> list[dict]:
    """Pack the lines at all Poisson's ratios as JSON values."""
    return [_lines(name, part) for part in at_each_poisson(dataset)]


def _lines(name: str, dataset: xr.Dataset) -> dict:
    has_force = "force" in dataset.attrs.get(DRIVE, "").split(", ")
    value = "velocity" if has_force else "mu_macro"
    dims = [dim for dim in AXES if dim in dataset[value].dims]
    along = max(dims, key=lambda dim: (dataset.sizes[dim], dims.index(dim)))
    others = [dim for dim in dims if dim != along]
    shown = dataset.transpose(*others, along, ...).sortby(along)
    columns = {"values": value, "errors": f"{value}_error", "converged": "converged"}
    series = []
    for place in product(*(range(shown.sizes[dim]) for dim in others)):
        line = shown.isel(dict(zip(others, place, strict=True)))
        several = (dim for dim in others if shown.sizes[dim] > 1)
        label = ", ".join(f"{dim} {number(float(line[dim]))}" for dim in several)
        entries = {key: plain(line[column].values) for key, column in columns.items()}
        series.append({"label": label} | entries)
    at = shown[along].values
    even_ratios = at[0] > 0 and Axis(at).logarithmic
    limits = [] if has_force else limits_of(shown)
    return about(name, dataset) | {
        "x": {"label": axis_label(shown, along), "values": plain(at), "log": bool(even_ratios)},
        "y": {"label": "mean velocity" if has_force else MU_MACRO.description, "log": has_force},
        "series": series,
        "limits": [one for one in limits if one["dims"] == [along]],
        "beside": _torque(shown, along),
    }


def _torque(shown: xr.Dataset, along: str) -> list[dict]:
    """Return the torque of a steady bore and its closed form. The chart does not show them."""
    if "mu_torque" not in shown or shown["mu_torque"].dims != (along,):
        return []
    theory = FORMS["continuous-bore"]["mu_torque_theory"]
    torque = {
        "label": "torque  M_z/M_z,0",
        "values": plain(shown["mu_torque"].values),
        "errors": plain(shown["mu_torque_error"].values),
    }
    if theory.name in shown:
        torque["theory"] = {"label": theory.label, "values": plain(shown[theory.name].values)}
    return [torque]


def about(name: str, dataset: xr.Dataset) -> dict:
    """Return the description of a map or of lines. The paper's sweeps have the group None."""
    poisson = float(dataset["poisson"])
    of_paper = name in ("transverse", "bore", "continuous_bore")
    group = None if of_paper else "drives" if DRIVE in dataset.attrs else "sweeps"
    return {
        "name": name,
        "id": f"{name} {number(poisson)}",
        "title": name.replace("_", " ").capitalize() if group is None else dataset.attrs["title"],
        "group": group,
        "motion": dataset.attrs["motion"],
        "pressure": dataset.attrs.get("pressure", "hertz"),
        "poisson": poisson,
    }


def axis_label(dataset: xr.Dataset, dim: str) -> str:
    """Return the name and the formula of an axis as HTML for plotly."""
    attributes = dataset[dim].attrs
    text = attributes.get("long_name", dim).split(",")[0]
    return f"{text}  {html(attributes.get('formula', ''))}".strip()


def limits_of(dataset: xr.Dataset) -> list[dict]:
    """Return the theoretical limits of a dataset at one Poisson's ratio.

    Each limit has a value at every point. A limit with a fine axis also has a curve, unless the
    limit depends on both velocity and amplitude.
    """
    motion = dataset.attrs["motion"].partition(":")[0]
    own = FORMS.get(motion, {})
    forms = {name: form for name, form in own.items() if name in NAMES} | {
        name: form for name, form in NAMES.items() if name not in own
    }
    return [
        _limit(dataset, motion, form) for name, form in forms.items() if name in dataset.variables
    ]


def _limit(dataset: xr.Dataset, motion: str, form: ClosedForm) -> dict:
    key = form.name
    spare = SPARE_COLOURS[list(NAMES).index(key) % len(SPARE_COLOURS)], style.DOTTED
    color, dash = CURVES.get(motion, {}).get(key, spare)
    only_at_0 = dataset["poisson"] > 0 and form.exact and not form.any_poisson
    values = dataset[key]
    entry = {
        "label": f"{form.label} for ν = 0" if only_at_0 else form.label,
        "long_name": values.attrs["long_name"],
        "color": color,
        "dash": "solid" if dash == style.SOLID else _dash(dash),
        "dims": list(values.dims),
        "values": plain(values.values),
    }
    if len(values.dims) == 1 and f"{key}_curve" in dataset:
        x, y = curve(limit(dataset, key))
        entry["curve"] = [plain(x), plain(y)]
    return entry


def _dash(linestyle: Any) -> str:
    return ",".join(f"{2 * length:g}px" for length in linestyle[1])
