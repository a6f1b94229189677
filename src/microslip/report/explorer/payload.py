"""Pack the data of the page (maps, lines, limits and periods) as one JSON value.

Numbers in datasets are stored exactly. Numbers in periods are rounded to integers, which are
encoded in base64. The rounding steps are bound/127 for tractions, 2 pi/65535 for phases, 1/65535
for radii and bounds, and the largest force divided by 32767 for forces. The densities of dissipated
energy belong to the stored period.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from microslip.foundation.canonical import number
from microslip.report.explorer import brief, si_form
from microslip.report.explorer.certified import packed
from microslip.report.figures import drawing
from microslip.report.figures.data import at_one_poisson
from microslip.sweeps.evaluate import plain
from microslip.sweeps.period_codec import SHARES, text_of, unpacked_half, values_of

UNSIGNED, SIGNED = 65535, 32767


TITLES = {"transverse": "Transverse oscillation", "bore": "Oscillating bore"}
OTHER_FORCES = {
    "transverse": ("force_lateral", "lateral force / (<i>μF<sub>z</sub></i>)"),
    "bore": ("torque", "torque  <i>M<sub>z</sub></i>/<i>M</i><sub><i>z</i>,0</sub>"),
}
"""Second force component of each map: its name in a period, and its label for plotly."""
ERRORS = {
    "error_resolution": "cells, angles and time steps",
    "error_periodicity": "distance to the periodic state",
    "error_solver": "iteration in each step",
    "error_model": "closed form",
}
POINTS = ("mu_macro", "mu_macro_error", *ERRORS, "converged", "cells", "angles")
POINTS += ("dissipated_energy", "dissipated_energy_error")
POINTS += ("steps_per_period", "model", "reason")


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
    content: dict[str, list[dict]] = {"maps": [], "lines": []}
    for name, dataset in datasets.items():
        if name in periods:
            content["maps"] += _maps(name, dataset, periods[name])
        elif brief.is_map(dataset):
            content["maps"] += brief.maps(name, dataset)
        else:
            content["lines"] += brief.lines(name, dataset)
    return content | {
        "made": {name: _provenance(datasets[name], periods.get(name, ())) for name in datasets},
        "certified": [packed(dataset) for dataset in certified],
        "si": si_form.packed(),
        "errors": ERRORS,
        "shares": SHARES,
        "unsigned": UNSIGNED,
    }


def _maps(name: str, dataset: xr.Dataset, records: list[dict]) -> list[dict]:
    """Pack the maps at all Poisson's ratios.

    Only the map at the ratio nearest 0 has periods and all errors.
    """
    shown = at_one_poisson(dataset).transpose("amplitude", "velocity", ...)
    force, label = OTHER_FORCES[name]
    maps = [one | {"title": TITLES[name]} for one in brief.maps(name, dataset)]
    first = next(one for one in maps if one["poisson"] == float(shown["poisson"]))
    first |= {
        "labels": [*first["labels"], label],
        "points": {key: plain(shown[key].values) for key in POINTS},
        "periods": _periods(shown, records, force),
    }
    return [first, *(one for one in maps if one is not first)]


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
    return {"index": plain(index), "failed": failures} | _packed(results, force)


def _packed(results: list[dict], force: str) -> dict:
    if not results:
        return {"count": 0}
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
