"""The dataset of a sweep.

Every dataset follows the CF conventions.  Limits from theory are variables, and attributes record
the provenance.  The root of a file contains the map.  Groups contain fine curves and single runs
(see `netcdf`).  All quantities are dimensionless.  Equal results give equal bytes: a file does not
depend on the time, the computer or the number of jobs.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np
import xarray as xr

import microslip
from microslip.config.quantities import AMPLITUDE, DRIVES, VELOCITY
from microslip.config.settings import Configuration, Sweep
from microslip.datasets import netcdf, theory_limits
from microslip.datasets.catalogue import FORMS
from microslip.datasets.variables import TABLE, TYPES, described, rows_of
from microslip.foundation import named_files, source_digest
from microslip.foundation.canonical import canonical_json
from microslip.scene.by_name import motion_named
from microslip.sweeps.request import runs_of, solver_names

CONVENTIONS = "CF-1.11"
METHOD = "boundary element method, elastic half-space with local Coulomb friction"
PAPER = "R. Pohrt, Front. Mech. Eng. 6:566440 (2020), doi:10.3389/fmech.2020.566440"


def build(
    configuration: Configuration, name: str, records: Iterable[dict]
) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Build the dataset of a sweep, and the datasets of its groups by name (see GROUPS).

    The dataset has the dimensions of the sweep.  Variables with other axes are in groups.

    Parameters
    ----------
    configuration : Configuration
        The configuration.
    name : str
        Name of the sweep.
    records : iterable of dict
        Records of the points in the order of request.points_of, then of the single runs in the
        order of request.runs_of.

    Raises
    ------
    ValueError
        If the number of records differs from the number of requests.
    """
    sweep, rest = configuration.sweeps[name], iter(records)
    motion, pressure = solver_names(sweep)
    title = sweep.title or f"Friction of a vibrated Hertz contact, motion {motion}"
    tolerance = np.nan if sweep.tolerance is None else sweep.tolerance
    about = {"motion": motion, "pressure": pressure, "tolerance": tolerance}
    for role, text in (("motion", motion), ("pressure", pressure)):
        if file := named_files.base_name(text):
            about[f"{role}_file"] = file
    axes = {dim: sweep.axes[dim] for dim in sweep.dims}
    points = islice(rest, math.prod(map(len, axes.values())))
    of_points, versions = _variables(sweep, axes, points)
    histories = list(rest)
    if len(histories) != len(runs_of(configuration, name)):
        raise ValueError(f"{name}: {len(histories)} single runs")
    failed = [record for record in histories if record["result"].get("crashed")]
    if failed:
        reasons = (f"{r['request']['kind']}: {r['result']['reason']}" for r in failed)
        about["single_runs_failed"] = "; ".join(reasons)
    if sweep.drives:
        about["drive"] = ", ".join(sweep.drives)
    versions |= {canonical_json(record["versions"]) for record in histories}
    settings = {"sweep": sweep.model_dump(mode="json"), "runs": runs_of(configuration, name)}
    root = _root(sweep, of_points).assign_attrs(provenance(title, settings, versions, **about))
    return root, _parts(sweep, histories)


GROUPS = {
    "velocity_curves": "Limits from theory on a fine axis of velocities",
    "amplitude_curves": "Limits from theory on a fine axis of amplitudes",
    "history": "Forces over time, the data of Figure 1",
    "field": "Tractions in the whole contact, the data of Figure 3",
    "transients": "Forces on the way to steady motion, the data of Figure 5",
}
"""Titles of the groups in a sweep's file.  Each motion has only some of the groups."""
ENTRIES = {"history": "periods", "transients": "travel"}
"""Entry that identifies the requests of a group of single runs."""
MISSING: dict[type, Any] = {float: np.nan, bool: False, np.int32: 0, str: ""}
LONGEST_TEXT = 256
"""Maximum number of characters in a text.  A longer text is truncated and ends with dots."""


def _root(sweep: Sweep, of_points: dict) -> xr.Dataset:
    """Return a dataset with the axes, the limits from theory and the variables of the points."""
    coords: dict[str, tuple] = {
        name: (name, np.array(values)) if name in sweep.dims else ((), values[0])
        for name, values in sweep.axes.items()
    }
    dataset = xr.Dataset(theory_limits.variables(sweep) | of_points, coords)
    describe_axes(dataset, sweep)
    return dataset


def _variables(
    sweep: Sweep, axes: dict[str, tuple[float, ...]], points: Iterable[dict]
) -> tuple[dict, set[str]]:
    """Build the variables of all points, which have the axes of the sweep.

    One record is in memory at a time.  Returns the variables, and the versions of the libraries
    that computed the records, as JSON.  Raises ValueError if the number of records differs from the
    number of points.
    """
    groups = [] if sweep.velocity else ["force"]
    table = rows_of(*groups, "points", "oscillation" if sweep.amplitude else "steady")
    columns: dict[str, np.ndarray] = {}
    shape = tuple(len(values) for values in axes.values())
    for name, row in table.items():
        kind = TYPES[row["kind"]]
        columns[name] = np.full(shape, MISSING[kind], object if kind is str else kind)
    versions, count, size = set(), 0, math.prod(shape)
    for count, record in enumerate(points, 1):
        if count > size:
            break
        versions.add(canonical_json(record["versions"]))
        for name, column in columns.items():
            if (value := record["result"].get(name)) is not None:
                column.flat[count - 1] = _shortened(value) if isinstance(value, str) else value
    if count != size:
        raise ValueError(f"{count} results for {size} points")
    if len(axes.get("poisson", ())) > 1:  # changes from the smallest ratio, with summed errors
        for name, row in rows_of("change").items():
            sign = 1.0 if name.endswith("_error") else -1.0
            column = columns[row["source"]]
            columns[name] = column + sign * column.take([0], list(axes).index("poisson"))
    return {name: described(name, tuple(axes), columns[name]) for name in columns}, versions


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 3]}..."


def _parts(sweep: Sweep, runs: Sequence[dict]) -> dict[str, xr.Dataset]:
    """Return the dataset of each group of a sweep, keyed by the names in GROUPS."""
    variables = theory_limits.curves(sweep)
    failed = any(record["result"].get("crashed") for record in runs)
    for group, own in ({} if failed else _by_group(runs)).items():  # `report` lists failed runs
        variables[group] = {name: _of_runs(name, own) for name in rows_of(group)}
    about = {"motion": solver_names(sweep)[0]}
    return {
        name: xr.Dataset(variables[name], attrs={"title": title} | about)
        for name, title in GROUPS.items()
        if name in variables
    }


def _by_group(runs: Sequence[dict]) -> dict[str, list[dict]]:
    """Return the single runs of each group: entries of requests, results and closed forms."""
    groups: dict[str, list[dict]] = {}
    for record in runs:
        request = record["request"]
        group = next((name for name, key in ENTRIES.items() if key in request), request["kind"])
        forms = FORMS["continuous-bore"].values() if group == "transients" else ()
        steady = {form.name: form.function(float(request["velocity"])) for form in forms}
        groups.setdefault(group, []).append(record["result"] | request | steady)
    return groups


def _of_runs(name: str, runs: list[dict]) -> tuple:
    """Return a variable of single runs.  Without a dimension `start`, only the first run counts."""
    dims, source = TABLE[name]["dims"].split(), TABLE[name]["source"]
    values = [run[source] for run in runs] if "start" in dims else runs[0][source]
    return described(name, dims, values)


def provenance(title: str, settings: dict, versions: set, **more: object) -> dict:
    """Return the attributes with the provenance of a dataset.

    Parameters
    ----------
    title : str
        Title of the dataset.
    settings : dict
        Settings of the configuration, stored as JSON.
    versions : set of str
        Versions of the libraries that computed the results.
    **more : object
        Additional attributes.
    """
    return {
        "Conventions": CONVENTIONS,
        "title": title,
        "institution": "not stated",  # for the publisher of a dataset to fill in
        "source": f"microslip {microslip.__version__}: {METHOD}",
        "references": PAPER,
        "microslip_version": microslip.__version__,
        "source_digest": source_digest.of_solver(),
        "configuration": canonical_json(settings),
        "library_versions": "; ".join(sorted(versions)),
    } | more


def report(dataset: xr.Dataset, name: str) -> Iterator[str]:
    """Yield lines of text: the number of points, and one line for each point that did not
    converge."""
    converged, reason = dataset["converged"], dataset["reason"]
    if netcdf.TEXTS in reason.attrs:
        reason = netcdf.texts(reason)
    bad = np.argwhere(~converged.values)
    failed = f"{len(bad)} not converged" if len(bad) else "all converged"
    yield f"{name}: {converged.size} points, {failed}"
    for index in bad:
        point = reason.isel(dict(zip(converged.dims, index, strict=True)))
        where = ", ".join(f"{dim} {float(point[dim]):g}" for dim in converged.dims)
        yield f"  not converged: {where}: {point.item()}"
    if "single_runs_failed" in dataset.attrs:
        yield f"  single runs left out: {dataset.single_runs_failed}"


def describe_axes(dataset: xr.Dataset, sweep: Sweep) -> None:
    """Set the attributes of the axes.  The attribute `formula` defines the coordinate."""
    motion = motion_named(sweep.motion)
    axes = [("velocity", VELOCITY, motion.velocity_label)] if sweep.velocity else []
    if sweep.amplitude:
        axes.append(("amplitude", AMPLITUDE, motion.amplitude_label))
    for name, of_paper, formula in axes:
        text = of_paper["transverse"].text  # the same for all motions
        about = {"long_name": f"{text}, {formula}", "units": "1", "formula": formula}
        if motion.name in of_paper:
            about["description"] = of_paper[motion.name].description
        dataset[name].attrs = about
    for name in sweep.drives:
        quantity = DRIVES[name]
        about = {"long_name": f"{quantity.text}, {quantity.unit}", "units": "1"}
        about |= {"formula": quantity.unit, "description": quantity.description}
        dataset[name].attrs = about
    dataset["poisson"].attrs = {"long_name": "Poisson's ratio", "units": "1"}
