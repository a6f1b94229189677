"""Write the page as one file: markup, style, plotly.js, scripts, and all data as one JSON value.

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
import os
from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from plotly.offline import get_plotlyjs

from microslip.config.quantities import MU_MACRO
from microslip.datasets.catalogue import ClosedForm
from microslip.foundation.canonical import number, plain
from microslip.foundation.files import write_atomically
from microslip.report.explorer import contact_form
from microslip.report.explorer.explorer import ASSETS
from microslip.report.figures import drawing
from microslip.report.figures import style as look
from microslip.report.figures.curves import closed_forms
from microslip.report.figures.panels import at_each_poisson, limit
from microslip.sweeps.period_codec import SHARES, text_of, unpacked_half, values_of

FOLDER = Path(__file__).parent
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


def write(path: str | os.PathLike, datasets: dict, periods: dict, certified: Sequence = ()) -> None:
    """Write the page atomically. Equal arguments give equal bytes.

    datasets, periods, certified: arguments of `build`. Raises CacheError if the file cannot be
    written.
    """
    write_atomically(Path(path), page(build(datasets, periods, certified)).encode())


def page(content: dict) -> str:
    """Return the text of the page. content: result of `build`."""
    template, style, *scripts = (
        (FOLDER / name).read_text(encoding="utf-8").rstrip() for name in ASSETS
    )
    # A "<" could end the script, so it is escaped.
    numbers = json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    parts = {"style": style, "plotly": get_plotlyjs(), "numbers": numbers}
    parts["scripts"] = "\n".join(scripts)
    # The template is split only once, so that a part can contain "@@".
    pieces = template.split("@@")
    pieces[1::2] = [parts[name] for name in pieces[1::2]]
    return "".join(pieces) + "\n"


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
            plane = {"velocity", "amplitude"} <= set(part.dims) and "drive" not in dataset.attrs
            if plane and (part["velocity"] > 0).sum() > 1:
                one = _map(part, None if index else periods.get(name))
            else:
                one = _lines(part)
            sweeps.append(_about(name, part) | one)
    return {
        "sweeps": sweeps,
        "made": {name: _provenance(datasets[name], periods.get(name, ())) for name in datasets},
        "certified": [contact_form.table(dataset) for dataset in certified],
        "si": contact_form.packed(),
        "errors": ERRORS,
        "shares": SHARES,
        "unsigned": UNSIGNED,
    }


def _about(name: str, dataset: xr.Dataset) -> dict:
    """Return the description of a map or of lines."""
    settings = json.loads(dataset.attrs.get("configuration", "{}")).get("sweep", {})
    return {
        "name": name,
        "title": settings.get("title") or name.replace("_", " ").capitalize(),
        "motion": dataset.attrs["motion"],
        "pressure": dataset.attrs.get("pressure", "hertz"),
        "poisson": float(dataset["poisson"]),
    }


def _label(dataset: xr.Dataset, dim: str) -> str:
    """Return the name and the formula of an axis as HTML for plotly."""
    attributes = dataset[dim].attrs
    text = attributes.get("long_name", dim).split(",")[0]
    return f"{text}  {look.html(attributes.get('formula', ''))}".strip()


def _values(dataset: xr.Dataset, **names: str) -> dict:
    """Return the values of variables by new names."""
    return {key: plain(dataset[name].values) for key, name in names.items()}


def _map(dataset: xr.Dataset, records: list[dict] | None) -> dict:
    """Pack a map. records: periods of its points, or None."""
    shown = dataset.transpose("amplitude", "velocity", ...)
    names: tuple[str, ...] = POINTS
    packed: dict = {"index": None, "failed": [], "count": 0}
    labels = [_label(shown, dim) for dim in ("velocity", "amplitude")]
    if records is not None:
        force, label = OTHER_FORCES[dataset.attrs["motion"]]
        names, packed = (*POINTS, *DETAILS), _periods(shown, records, force)
        labels.append(label)
    return {
        "kind": "map",
        "labels": labels,
        **_values(shown, velocity="velocity", amplitude="amplitude"),
        "points": _values(shown, **dict(zip(names, names, strict=True))),
        "limits": [_limit(shown, form) for form in _friction_forms(shown)],
        "periods": packed,
    }


def _lines(dataset: xr.Dataset) -> dict:
    """Pack the lines of a sweep, and the torque of a steady bore, which the chart does not show."""
    over_force = "force" in dataset.dims
    value = "velocity" if over_force else "mu_macro"
    sizes = {str(dim): dataset.sizes[dim] for dim in dataset[value].dims}
    along = max(sizes, key=lambda dim: (sizes[dim], dim == "velocity"))
    others = [dim for dim in sizes if dim != along]
    shown = dataset.transpose(*others, along, ...).sortby(along)
    series = []
    for place in product(*(range(shown.sizes[dim]) for dim in others)):
        line = shown.isel(dict(zip(others, place, strict=True)))
        label = ", ".join(f"{dim} {number(float(line[dim]))}" for dim in others)
        columns = _values(line, values=value, errors=f"{value}_error", converged="converged")
        series.append({"label": label} | columns)
    at = shown[along].values
    is_wide = at[0] > 0 and at[-1] > 10 * at[0]
    forms = [form for form in _friction_forms(shown) if form.arguments == (along,)]
    beside = []
    if "mu_torque" in shown and shown["mu_torque"].dims == (along,):
        torque: dict = _values(shown, values="mu_torque", errors="mu_torque_error")
        for form in closed_forms(shown):
            if form.name == "mu_torque_theory":
                torque["theory"] = {"label": form.label} | _values(shown, values=form.name)
        beside.append(torque | {"label": "torque  M_z/M_z,0"})
    return {
        "kind": "lines",
        "x": {"label": _label(shown, along), "values": plain(at), "log": bool(is_wide)},
        "y": {"label": "mean velocity" if over_force else MU_MACRO.description, "log": over_force},
        "series": series,
        "limits": [] if over_force else [_limit(shown, form) for form in forms],
        "beside": beside,
    }


def _friction_forms(dataset: xr.Dataset) -> list[ClosedForm]:
    """Return the closed forms of friction in a dataset."""
    return [form for form in closed_forms(dataset) if "torque" not in form.name]


def _limit(dataset: xr.Dataset, form: ClosedForm) -> dict:
    """Pack a closed form: its value at every point, and its curve if it has a fine axis, unless it
    depends on both velocity and amplitude."""
    color, dash = look.LIMITS[form.name]
    only_at_0 = dataset["poisson"] > 0 and form.exact and not form.any_poisson
    values, line = dataset[form.name], limit(dataset, form.name)
    entry = {
        "label": f"{form.label} for ν = 0" if only_at_0 else form.label,
        "long_name": values.attrs["long_name"],
        "color": color,
        "dash": "solid" if dash == "-" else ",".join(f"{2 * length:g}px" for length in dash[1]),
        "dims": list(values.dims),
        "values": plain(values.values),
    }
    if values.ndim == 1 and line.name != values.name:
        entry["curve"] = [plain(line[line.dims[0]].values), plain(line.values)]
    return entry


def _periods(dataset: xr.Dataset, records: list[dict], force: str) -> dict:
    """Pack a map's periods, and the index of each point's period (-1 for no period)."""
    rows, columns = (
        {number(value): i for i, value in enumerate(dataset[dim].values)}
        for dim in ("amplitude", "velocity")
    )
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
    # The frame half a period later is the mirror image of the first one and is omitted.
    shares, slips = (
        np.array([half[:-1] for half in halves])
        for halves in zip(*map(unpacked_half, results), strict=True)
    )
    column = {name: np.array([r[name] for r in results]) for name in ("phase", "radius", "bound")}
    forces = np.array([[r["force_forward"], r[force]] for r in results])
    step = float(np.abs(forces).max()) / SIGNED
    count, frames, _, angles, cells = shares.shape
    start = float(column["phase"][0, 0])  # phase of the turning point where periods begin
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
        "phases": _unsigned((column["phase"] - start) / (2 * np.pi)),
        "radii": _unsigned(column["radius"]),
        "bounds": _unsigned(column["bound"]),
        "mean": [r["mu_macro"] for r in results],
        "converged": [r["converged"] for r in results],
        "reason": [r["reason"] for r in results],
    }


def _unsigned(values: ArrayLike) -> str:
    return text_of(np.round(UNSIGNED * np.clip(values, 0.0, 1.0)).astype(np.uint16))


def _provenance(dataset: xr.Dataset, records: Sequence[dict]) -> list[list[str]]:
    """Return the provenance of a map and its periods as pairs of a name and a text."""
    provenance = drawing.provenance(dataset)
    if "configuration" in provenance:
        provenance["configuration"] = json.dumps(json.loads(provenance["configuration"]), indent=1)
    if records:
        request = records[0]["request"]
        counts = ", ".join(f"{name} {request[name]}" for name in ("cells", "angles", "steps"))
        provenance["periods"] = f"{len(records)} of the polar model: {counts}"
    return [[key.replace("_", " "), str(value)] for key, value in provenance.items()]
