"""Pack the data of the page (maps, lines, limits and periods) as one JSON value.

A sweep over velocities and amplitudes is a map for each Poisson's ratio. Other sweeps, and sweeps
with a drive, are lines: the abscissa is the longest axis, and there is one line for each
combination of the other axes.

Numbers in datasets are stored exactly. Numbers in periods are rounded to integers, which are
encoded in base64. The rounding steps are bound/127 for tractions, 2 pi/65535 for phases, 1/65535
for radii and bounds, and the largest force divided by 32767 for forces. The densities of dissipated
energy belong to the stored period.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from itertools import product

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from microslip.config.quantities import MU_MACRO
from microslip.datasets.catalogue import ClosedForm
from microslip.foundation.canonical import number
from microslip.report.explorer import contact_form
from microslip.report.figures import drawing
from microslip.report.figures import style as look
from microslip.report.figures.curves import closed_forms
from microslip.report.figures.data import at_each_poisson, limit
from microslip.report.figures.formulas import html
from microslip.sweeps.evaluate import plain
from microslip.sweeps.period_codec import SHARES, text_of, unpacked_half, values_of

UNSIGNED, SIGNED = 65535, 32767
"""Largest integers of two bytes, without and with a sign."""
OTHER_FORCES = {
    "transverse": ("force_lateral", "lateral force / (<i>μF<sub>z</sub></i>)"),
    "bore": ("torque", "torque  <i>M<sub>z</sub></i>/<i>M</i><sub><i>z</i>,0</sub>"),
}
"""Second force component of each motion: its name in a period, and its label for plotly."""
ERRORS = {
    "error_resolution": "cells, angles and time steps",
    "error_periodicity": "distance to the periodic state",
    "error_solver": "iteration in each step",
    "error_model": "closed form",
}
POINTS = ("mu_macro", "mu_macro_error", "converged", "model", "reason")
DETAILS = (*ERRORS, "cells", "angles", "dissipated_energy", "dissipated_energy_error")
DETAILS += ("steps_per_period",)
"""Variables of the points of maps: of all maps, and also of maps with periods."""


def build(datasets: dict, periods: dict, certified: Sequence = ()) -> dict:
    """Pack all data of the page.

    Parameters
    ----------
    datasets : dict of xarray.Dataset
        Datasets, keyed by the sweep's name, see `explorer`.
    periods : dict of list
        Records of the stored periods, keyed by the sweep's name.
    certified : sequence of xarray.Dataset
        Certified maps that the form for real contacts uses.

    Returns
    -------
    dict
        JSON values.
    """
    sweeps = []
    for name, dataset in datasets.items():
        for index, part in enumerate(at_each_poisson(dataset)):
            plane = {"velocity", "amplitude"} <= set(part.dims)
            if plane and "drive" not in dataset.attrs and (part["velocity"] > 0).sum() > 1:
                sweeps.append(_map(name, part, None if index else periods.get(name)))
            else:
                sweeps.append(_lines(name, part))
    return {
        "sweeps": sweeps,
        "made": {name: _provenance(datasets[name], periods.get(name, ())) for name in datasets},
        "certified": [contact_form.table(dataset) for dataset in certified],
        "si": contact_form.packed(),
        "errors": ERRORS,
        "shares": SHARES,
        "unsigned": UNSIGNED,
    }


def _about(name: str, kind: str, dataset: xr.Dataset) -> dict:
    """Return the description of a map or of lines."""
    settings = json.loads(dataset.attrs.get("configuration", "{}")).get("sweep", {})
    return {
        "name": name,
        "kind": kind,
        "title": settings.get("title") or name.replace("_", " ").capitalize(),
        "motion": dataset.attrs["motion"],
        "pressure": dataset.attrs.get("pressure", "hertz"),
        "poisson": float(dataset["poisson"]),
    }


def _label(dataset: xr.Dataset, dim: str) -> str:
    """Return the name and the formula of an axis as HTML for plotly."""
    attributes = dataset[dim].attrs
    text = attributes.get("long_name", dim).split(",")[0]
    return f"{text}  {html(attributes.get('formula', ''))}".strip()


def _map(name: str, dataset: xr.Dataset, records: list[dict] | None) -> dict:
    """Pack a map. records: periods of its points, or None."""
    shown = dataset.transpose("amplitude", "velocity", ...)
    names: tuple[str, ...] = POINTS
    packed: dict = {"index": None, "failed": [], "count": 0}
    labels = [_label(shown, dim) for dim in ("velocity", "amplitude")]
    if records is not None:
        force, label = OTHER_FORCES[dataset.attrs["motion"]]
        names, packed = (*POINTS, *DETAILS), _periods(shown, records, force)
        labels.append(label)
    return _about(name, "map", dataset) | {
        "labels": labels,
        "velocity": plain(shown["velocity"].values),
        "amplitude": plain(shown["amplitude"].values),
        "points": {key: plain(shown[key].values) for key in names},
        "limits": [_limit(shown, form) for form in _limits(shown)],
        "periods": packed,
    }


def _lines(name: str, dataset: xr.Dataset) -> dict:
    """Pack the lines of a sweep."""
    over_force = "force" in dataset.dims
    value = "velocity" if over_force else "mu_macro"
    sizes = {str(dim): dataset.sizes[dim] for dim in dataset[value].dims}
    along = max(sizes, key=lambda dim: (sizes[dim], dim == "velocity"))
    others = [dim for dim in sizes if dim != along]
    shown = dataset.transpose(*others, along, ...).sortby(along)
    columns = {"values": value, "errors": f"{value}_error", "converged": "converged"}
    series = []
    for place in product(*(range(shown.sizes[dim]) for dim in others)):
        line = shown.isel(dict(zip(others, place, strict=True)))
        label = ", ".join(f"{dim} {number(float(line[dim]))}" for dim in others)
        entries = {key: plain(line[column].values) for key, column in columns.items()}
        series.append({"label": label} | entries)
    at = shown[along].values
    forms = [] if over_force else [form for form in _limits(shown) if form.arguments == (along,)]
    return _about(name, "lines", dataset) | {
        "x": {"label": _label(shown, along), "values": plain(at), "log": bool(_is_wide(at))},
        "y": {"label": "mean velocity" if over_force else MU_MACRO.description, "log": over_force},
        "series": series,
        "limits": [_limit(shown, form) for form in forms],
        "beside": _torque(shown, along),
    }


def _is_wide(at: np.ndarray) -> bool:
    """Return whether an axis is logarithmic: its values span more than a decade above 0."""
    return at[0] > 0 and at[-1] > 10 * at[0]


def _torque(shown: xr.Dataset, along: str) -> list[dict]:
    """Return the torque of a steady bore and its closed form. The chart does not show them."""
    if "mu_torque" not in shown or shown["mu_torque"].dims != (along,):
        return []
    names = {"values": "mu_torque", "errors": "mu_torque_error"}
    torque: dict = {key: plain(shown[name].values) for key, name in names.items()}
    for form in closed_forms(shown):
        if form.name == "mu_torque_theory":
            torque["theory"] = {"label": form.label, "values": plain(shown[form.name].values)}
    return [torque | {"label": "torque  M_z/M_z,0"}]


def _limits(dataset: xr.Dataset) -> list[ClosedForm]:
    """Return the closed forms of friction in a dataset."""
    return [form for form in closed_forms(dataset) if "torque" not in form.name]


def _limit(dataset: xr.Dataset, form: ClosedForm) -> dict:
    """Pack a closed form: its value at every point, and its curve if it has a fine axis, unless it
    depends on both velocity and amplitude."""
    color, dash = look.LIMITS[form.name]
    only_at_0 = dataset["poisson"] > 0 and form.exact and not form.any_poisson
    values = dataset[form.name]
    entry = {
        "label": f"{form.label} for ν = 0" if only_at_0 else form.label,
        "long_name": values.attrs["long_name"],
        "color": color,
        "dash": "solid" if dash == "-" else ",".join(f"{2 * length:g}px" for length in dash[1]),
        "dims": list(values.dims),
        "values": plain(values.values),
    }
    if len(values.dims) == 1 and f"{form.name}_curve" in dataset:
        line = limit(dataset, form.name)
        entry["curve"] = [plain(line[line.dims[0]].values), plain(line.values)]
    return entry


def _periods(dataset: xr.Dataset, records: list[dict], force: str) -> dict:
    """Pack a map's periods, and the index of each point's period (-1 for no period)."""
    rows = {number(value): i for i, value in enumerate(dataset["amplitude"].values)}
    columns = {number(value): j for j, value in enumerate(dataset["velocity"].values)}
    index = np.full((len(rows), len(columns)), -1)
    failures: list[list] = []
    results: list[dict] = []
    for record in records:
        request, result = record["request"], record["result"]
        place = rows[request["amplitude"]], columns[request["velocity"]]
        if "tractions" in result:
            index[place] = len(results)
            results.append(result)
        else:
            failures.append([*place, result["reason"]])
    packed = _packed(results, force) if results else {"count": 0}
    return {"index": plain(index), "failed": failures} | packed


def _packed(results: list[dict], force: str) -> dict:
    halves = [unpacked_half(result) for result in results]
    # The frame half a period later is the mirror image of the first one and is omitted.
    shares = np.array([half[0][:-1] for half in halves])
    slips = np.array([half[1][:-1] for half in halves])
    forces = np.array([[r["force_forward"], r[force]] for r in results])
    step = float(np.abs(forces).max()) / SIGNED
    count, frames, _, angles, cells = shares.shape
    phases = np.array([r["phase"] for r in results])
    start = float(phases[0, 0])  # phase of the turning point where periods begin
    return {
        "count": count,
        "frames": 2 * frames,
        "angles": angles,
        "cells": cells,
        "turned": results[0]["turned"],
        "tractions": text_of(shares),
        "slips": text_of(np.packbits(slips.reshape(count, -1), axis=1)),
        "densities": text_of(np.array([values_of(r["densities"], np.uint16) for r in results])),
        "force_step": step,
        "forces": text_of(np.round(forces / step).astype(np.int16)),
        "start": start,
        "phases": text_of(_unsigned((phases - start) / (2 * np.pi))),
        "radii": text_of(_unsigned([r["radius"] for r in results])),
        "bounds": text_of(_unsigned([r["bound"] for r in results])),
        "mean": [r["mu_macro"] for r in results],
        "converged": [r["converged"] for r in results],
        "reason": [r["reason"] for r in results],
    }


def _unsigned(values: ArrayLike) -> np.ndarray:
    return np.round(UNSIGNED * np.clip(values, 0.0, 1.0)).astype(np.uint16)


def _provenance(dataset: xr.Dataset, records: Sequence[dict]) -> list[list[str]]:
    """Return the provenance of a map and its periods as pairs of a name and a text."""
    provenance = {key: dataset.attrs[key] for key in drawing.PROVENANCE if key in dataset.attrs}
    if "configuration" in provenance:
        provenance["configuration"] = json.dumps(json.loads(provenance["configuration"]), indent=1)
    if records:
        request = records[0]["request"]
        counts = ", ".join(f"{name} {request[name]}" for name in ("cells", "angles", "steps"))
        provenance["periods"] = f"{len(records)} of the polar model: {counts}"
    return [[key.replace("_", " "), str(value)] for key, value in provenance.items()]
