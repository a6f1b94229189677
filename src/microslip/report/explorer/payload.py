"""What the page holds: maps, limits and periods as one value that JSON can hold.

Numbers of datasets are kept as they are. Those of periods are whole numbers of steps in base64:
tractions in steps of bound/127, phases in steps of 2 pi/65535, radii and bounds in steps of
1/65535, forces in steps of the largest one over 32767. So each is off by half a step at most.
"""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np

from microslip.config.quantities import AMPLITUDE, VELOCITY
from microslip.foundation.canonical import number
from microslip.report.figures import drawing, maps, style
from microslip.report.figures.data import limit, require, sweep
from microslip.report.figures.formulas import html
from microslip.sweeps.evaluate import plain
from microslip.sweeps.period_codec import SHARES, text_of, unpacked_half
from microslip.theory.catalogue import FORMS

UNSIGNED, SIGNED = 65535, 32767


@dataclass(frozen=True)
class Labels:
    """Names of a map, in the markup that plotly knows, and of the other component of its force."""

    title: str
    other: str
    force: str  # what of a period it is


LABELS = {
    "transverse": Labels(
        "Transverse oscillation", "lateral force / (<i>μF<sub>z</sub></i>)", "force_lateral"
    ),
    "bore": Labels(
        "Oscillating bore", "torque  <i>M<sub>z</sub></i>/<i>M</i><sub><i>z</i>,0</sub>", "torque"
    ),
}
FIGURES = {"transverse": "fig2_transverse_map", "bore": "fig6_bore_map"}
ERRORS = {
    "error_space": "cells",
    "error_time": "time steps",
    "error_periodicity": "distance to the periodic state",
    "error_solver": "iteration in each step",
    "error_model": "closed form",
}
POINTS = ("mu_macro", "mu_macro_error", *ERRORS, "converged", "cells", "angles")
POINTS += ("steps_per_period", "model", "reason")
SPARE_COLOURS = (style.SKY, style.GREY)


def build(datasets: dict, periods: dict) -> dict:
    """All that the page shows, as a dict.

    datasets: xarray.Datasets by the names of maps, see `requests.MAPS`; periods: lists of records
    of periods by the same names. Raises ValueError where a dataset lacks what the page shows, or
    a period belongs to no point of its map.
    """
    return {
        "maps": [_map(name, datasets[name], periods[name]) for name in datasets],
        "errors": ERRORS,
        "shares": SHARES,
        "unsigned": UNSIGNED,
    }


def _map(name, dataset, records):
    names = FORMS[name]
    require("explorer", name, dataset, ["amplitude", "velocity", *POINTS, *names])
    shown, poisson = sweep(dataset, ("amplitude", "velocity"))
    shown = shown.transpose("amplitude", "velocity", ...)
    labels = LABELS[name]
    return {
        "name": name,
        "title": labels.title,
        "labels": [
            *(f"{q.text}  {html(q.unit)}" for q in (VELOCITY[name], AMPLITUDE[name])),
            labels.other,
        ],
        "poisson": poisson,
        "other_poissons": [
            float(ratio) for ratio in np.atleast_1d(dataset["poisson"]) if ratio != poisson
        ],
        "velocity": plain(shown["velocity"].values),
        "amplitude": plain(shown["amplitude"].values),
        "points": {key: plain(shown[key].values) for key in POINTS},
        "limits": [_limit(shown, name, key) for key in names],
        "periods": _periods(shown, records, labels.force),
        "made": _made(dataset, records),
    }


def _limit(dataset, name, key):
    """A limit on the axes of the map, and as a curve on its fine axis where it has one of its own.

    The curve of one that depends on both axes belongs to a single amplitude and is left out.
    """
    plan = maps.MAPS[FIGURES[name]]
    looks = {overlay.variable: overlay for overlay in (*plan.static, plan.large)}
    spare = list(FORMS[name]).index(key) % len(SPARE_COLOURS)
    look = looks.get(key, maps.Overlay(key, key, SPARE_COLOURS[spare], style.DOTTED))
    values = dataset[key]
    found = {
        "label": look.label,
        "long_name": values.attrs["long_name"],
        "color": look.color,
        "dash": "solid" if look.linestyle == style.SOLID else _dash(look.linestyle),
        "dims": list(values.dims),
        "values": plain(values.values),
    }
    if len(values.dims) == 1:
        x, y = maps.curve(limit(dataset, key))
        found["curve"] = [plain(x), plain(y)]
    return found


def _dash(linestyle):
    return ",".join(f"{2 * length:g}px" for length in linestyle[1])


def _periods(dataset, records, force):
    """Periods of the points of a map, one after another in the order of `index`."""
    rows = {number(value): i for i, value in enumerate(dataset["amplitude"].values)}
    columns = {number(value): j for j, value in enumerate(dataset["velocity"].values)}
    index = np.full((len(rows), len(columns)), -1)
    failed, kept = [], []
    for record in records:
        request, result = record["request"], record["result"]
        try:
            place = rows[request["amplitude"]], columns[request["velocity"]]
        except KeyError as error:
            raise ValueError(f"explorer: a period at {error}, which the map has not") from None
        if "tractions" in result:
            index[place] = len(kept)
            kept.append(result)
        else:
            failed.append([*place, result["reason"]])
    return {"index": plain(index), "failed": failed} | _packed(kept, force)


def _packed(results, force):
    if not results:
        return {"count": 0}
    halves = [unpacked_half(result) for result in results]
    # the frame half a period later is the mirror image of the first one
    shares = np.array([half[0][:-1] for half in halves])
    slips = np.array([half[1][:-1] for half in halves])
    forces = np.array([[r["force_forward"], r[force]] for r in results])
    step = float(np.abs(forces).max()) / SIGNED
    count, frames, _, angles, cells = shares.shape
    phases = np.array([r["phase"] for r in results])
    start = float(phases[0, 0])  # the turning point that periods begin at
    return {
        "count": count,
        "frames": 2 * frames,
        "angles": angles,
        "cells": cells,
        "turned": results[0]["turned"],
        "tractions": text_of(shares),
        "slips": text_of(np.packbits(slips.reshape(count, -1), axis=1)),
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


def _unsigned(values):
    return np.round(UNSIGNED * np.clip(values, 0.0, 1.0)).astype(np.uint16)


def _made(dataset, records):
    """What made a map and its periods, as a list of pairs of texts."""
    found = {key: dataset.attrs[key] for key in drawing.PROVENANCE if key in dataset.attrs}
    if "configuration" in found:
        found["configuration"] = json.dumps(json.loads(found["configuration"]), indent=1)
    if records:
        request = records[0]["request"]
        counts = ", ".join(f"{name} {request[name]}" for name in ("cells", "angles", "steps"))
        found["periods"] = f"{len(records)} of the polar model: {counts}"
    return [[key.replace("_", " "), str(value)] for key, value in found.items()]
