"""Write the page as one file: markup, style, plotly.js, scripts, and all data as one JSON value.

A sweep over velocities and amplitudes is shown as one map for each Poisson's ratio. Other sweeps,
and sweeps with a drive, are shown as lines. The abscissa is the longest axis. There is one line for
each combination of values along the other axes.

Numbers from datasets are stored exactly. Forces, phases, radii and bounds are rounded when a period
is stored. Tractions, slip flags and densities are strings encoded by sweeps.period_codec. The page
decodes these strings.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import jinja2
import numpy as np
import xarray as xr
from plotly.offline import get_plotlyjs

from microslip.config.quantities import MU_MACRO
from microslip.datasets.variables import TABLE
from microslip.foundation.canonical import number, plain
from microslip.report import selection
from microslip.report.explorer import contact_form
from microslip.report.explorer.explorer import ASSETS
from microslip.report.figures import style as look
from microslip.report.motions import MOTIONS
from microslip.report.pages import provenance
from microslip.report.selection import PLANE, at_each_poisson, closed_forms, is_wide, limit, lines
from microslip.sweeps.period_codec import SHARES

FOLDER = Path(__file__).parent
POINTS = ["mu_macro", "mu_macro_error", "converged", "model", "reason"]
POINTS += ["cells", "angles", "steps_per_period", "dissipated_energy", "dissipated_energy_error"]
"""Variables of the points in a map, besides the parts of the error."""
ERRORS = {
    name: row["description"].removeprefix("part of mu_macro_error from ")
    for name, row in TABLE.items()
    if name.startswith("error_")
}
"""The parts of a point's error, each with its source."""
DECIMALS = 5
"""Number of decimals of the forces, phases, radii and bounds in stored periods."""
PERIOD = ["phase", "radius", "bound", "tractions", "slips", "densities", "angles", "turned"]
PERIOD += ["mu_macro", "converged", "reason"]
"""Entries of a stored period, besides the forces. If no period was found, only the last two entries
exist."""


def page(content: dict) -> str:
    """Return the HTML of the page. `content` is the value returned by `build`."""
    texts = {name: (FOLDER / name).read_text(encoding="utf-8").rstrip() for name in ASSETS}
    template, style = jinja2.Template(texts.pop("page.html")), texts.pop("style.css")
    # A "<" could end the script, so it is escaped.
    numbers = json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    parts = {"style": style, "plotly": get_plotlyjs(), "numbers": numbers}
    return template.render(parts, scripts="\n".join(texts.values())) + "\n"


def build(datasets: dict, periods: dict, certified: Sequence = ()) -> dict:
    """Pack all data of the page.

    Parameters
    ----------
    datasets : dict of xarray.Dataset
        Datasets, keyed by the name of the sweep (see `explorer`).
    periods : dict of list
        Records of the stored periods, keyed by the name of the sweep.
    certified : sequence of xarray.Dataset
        Certified maps for the form for real contacts.

    Returns
    -------
    dict
        JSON values.
    """
    sweeps = []
    for name, dataset in datasets.items():
        title = selection.own_title(dataset) or name.replace("_", " ").capitalize()
        about = {"name": name, "title": title, "motion": dataset.attrs["motion"]}
        about |= {"pressure": dataset.attrs.get("pressure", "hertz")}
        for index, part in enumerate(at_each_poisson(dataset)):
            plane = set(PLANE) <= set(part.dims) and "drive" not in dataset.attrs
            is_map = plane and (part["velocity"] > 0).sum() > 1
            one = _map(part, () if index else periods.get(name, ())) if is_map else _lines(part)
            sweeps.append(about | {"poisson": float(part["poisson"])} | one)
    return {
        "sweeps": sweeps,
        "made": [_provenance(datasets[name], periods.get(name, ())) for name in datasets],
        "certified": [contact_form.table(dataset) for dataset in certified],
        "si": contact_form.packed(),
        "errors": ERRORS,
        "shares": SHARES,
    }


def _label(dataset: xr.Dataset, dim: str) -> str:
    """Return the name and the formula of an axis as HTML for plotly.js."""
    attributes = dataset[dim].attrs
    text = attributes.get("long_name", dim).split(",")[0]
    return f"{text}  {look.html(attributes.get('formula', ''))}".strip()


def _values(dataset: xr.Dataset, **names: str) -> dict:
    """Return the values of variables, keyed by new names."""
    return {key: plain(dataset[name].values) for key, name in names.items()}


def _map(dataset: xr.Dataset, records: Sequence[dict]) -> dict:
    """Pack a map. `records` contains the records of the stored periods."""
    shown = dataset.transpose("amplitude", "velocity", ...)
    motion = MOTIONS.get(dataset.attrs["motion"])
    return {
        "kind": "map",
        "labels": [_label(shown, "velocity"), _label(shown, "amplitude")],
        "other_force": motion and motion.force_label,
        **_values(shown, velocity="velocity", amplitude="amplitude"),
        "points": _values(shown, **{name: name for name in (*POINTS, *ERRORS) if name in shown}),
        "limits": _limits(shown),
        "periods": _periods(shown, records) if records else None,
    }


def _lines(dataset: xr.Dataset) -> dict:
    """Pack the lines of a sweep. The torque of a steady bore is included, although no chart shows
    it."""
    over_force = "force" in dataset.dims
    value = "velocity" if over_force else "mu_macro"
    along, parts = lines(dataset, value)
    series = []
    for place, line in parts:
        label = ", ".join(f"{dim} {number(at)}" for dim, at in place.items())
        names = {"values": value, "errors": f"{value}_error", "converged": "converged"}
        series.append({"label": label} | _values(line, **names))
    at = dataset[along].values
    beside = []
    if "mu_torque" in dataset and dataset["mu_torque"].dims == (along,):
        torque: dict = _values(dataset, values="mu_torque", errors="mu_torque_error")
        beside.append(torque | {"label": "torque  M_z/M_z,0", "theory": _limits(dataset, "torque")})
    return {
        "kind": "lines",
        "x": {"label": _label(dataset, along), "values": plain(at), "log": is_wide(at)},
        "y": {"label": "mean velocity" if over_force else MU_MACRO.description, "log": over_force},
        "series": series,
        "limits": [] if over_force else _limits(dataset, "", along),
        "beside": beside,
    }


def _limits(dataset: xr.Dataset, part: str = "", *arguments: str) -> list[dict]:
    """Pack the closed forms: their values at every point, and their curves on fine axes.

    part: "torque", or "" for friction. arguments: if given, only forms with these arguments are
    packed.
    """
    entries = []
    for form in closed_forms(dataset):
        if ("torque" in form.name) != bool(part) or arguments not in ((), form.arguments):
            continue
        color, dash = look.LIMITS[form.name]
        values, line = dataset[form.name], limit(dataset, form.name)
        entry = {
            "label": form.label,
            "long_name": values.attrs["long_name"],
            "color": color,
            "dash": "solid" if dash == "-" else ",".join(f"{2 * size:g}px" for size in dash[1]),
            "dims": list(values.dims),
            "values": plain(values.values),
        }
        if values.ndim == 1 and line.name != values.name:
            entry["curve"] = [plain(line[line.dims[0]].values), plain(line.values)]
        entries.append(entry)
    return entries


def _periods(dataset: xr.Dataset, records: Sequence[dict]) -> list:
    """Return the stored period of each point of a map, or None for a point without a stored
    period."""
    rows, columns = (
        {number(value): i for i, value in enumerate(dataset[dim].values)}
        for dim in ("amplitude", "velocity")
    )
    table = np.full((len(rows), len(columns)), None)
    names = {name: name for name in PERIOD} | {"forward": "force_forward"}
    names["other"] = MOTIONS[dataset.attrs["motion"]].force
    for record in records:
        request, result = record["request"], record["result"]
        place = rows[request["amplitude"]], columns[request["velocity"]]
        values = {key: plain(result[one]) for key, one in names.items() if one in result}
        for key, value in values.items():
            values[key] = np.round(value, DECIMALS).tolist() if isinstance(value, list) else value
        table[place] = values
    return table.tolist()


def _provenance(dataset: xr.Dataset, records: Sequence[dict]) -> str:
    """Return the provenance of a map and of the stored periods as text."""
    lines = []
    if records:
        request = records[0]["request"]
        counts = ", ".join(f"{name} {request[name]}" for name in ("cells", "angles", "steps"))
        lines.append(f"{len(records)} periods of the polar model: {counts}")
    return "\n".join(provenance(dataset, lines, ()))
