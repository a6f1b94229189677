"""Build the dataset of a sweep.

Every dataset follows the CF conventions.  Theoretical limits are stored as variables, and the
provenance as attributes.  The root of a file contains the map.  Groups contain finely sampled
curves and single runs (see `netcdf`).  All quantities are dimensionless.  Identical results give
byte-identical files: a file does not depend on the time, the computer or the number of jobs.
"""

import math
from collections.abc import Iterable, Iterator
from itertools import islice

import numpy as np
import xarray as xr

import microslip
from microslip.config.quantities import AMPLITUDE, DRIVES, VELOCITY
from microslip.config.settings import Configuration, Sweep
from microslip.datasets import netcdf, theory_limits
from microslip.datasets.catalogue import FORMS
from microslip.datasets.interpolation import CHECKSUM, checksums, scene_of
from microslip.datasets.variables import TABLE, columns, described, rows_of
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
    """Build the dataset of a sweep, and a dict of the datasets of its groups (see GROUPS).

    The dataset has the dimensions of the sweep.  Variables with other axes are in groups.

    Parameters
    ----------
    configuration : Configuration
        The configuration.
    name : str
        Name of the sweep.
    records : iterable of dict
        Records of the points in the order of request.points_of, followed by the records of the
        single runs in the order of request.runs_of.

    Raises
    ------
    ValueError
        If the number of records differs from the number of requests.
    """
    sweep = configuration.sweeps[name]
    motion, pressure = solver_names(sweep)
    versions: set[str] = set()

    def read() -> Iterator[dict]:
        for record in records:
            versions.add(canonical_json(record["versions"]))
            yield record

    rest = read()
    size = math.prod(len(sweep.axes[dim]) for dim in sweep.dims)
    kinds = [] if sweep.velocity else ["force"]
    table = rows_of(*kinds, "points", "oscillation" if sweep.amplitude else "steady")
    values = columns(table.values(), (record["result"] for record in islice(rest, size)), size)
    requests, runs = runs_of(configuration, name), list(rest)
    if len(runs) != len(requests):
        raise ValueError(f"{name}: {len(runs)} single runs")
    failed = [run for run in runs if run["result"].get("crashed")]
    tolerance = np.nan if sweep.tolerance is None else sweep.tolerance
    about = {"motion": motion, "pressure": pressure, "tolerance": tolerance}
    for role, text in (("motion", motion), ("pressure", pressure)):
        if file := named_files.base_name(text):
            about[f"{role}_file"] = file
    if failed:
        reasons = (f"{r['request']['kind']}: {r['result']['reason']}" for r in failed)
        about["single_runs_failed"] = "; ".join(reasons)
    if sweep.drives:
        about["drive"] = ", ".join(sweep.drives)
    shown = about.get("motion_file", motion)
    title = sweep.title or f"Friction of a vibrated Hertz contact, motion {shown}"
    settings = {"sweep": sweep.model_dump(mode="json"), "runs": requests}
    coords: dict[str, tuple] = {
        axis: (axis, np.array(values)) if axis in sweep.dims else ((), values[0])
        for axis, values in sweep.axes.items()
    }
    values["reason"][:] = [_shortened(text) for text in values["reason"]]
    variable = "mu_macro" if sweep.velocity else "velocity"
    numbers = values[variable], values[f"{variable}_error"]
    codes = checksums(sweep.axes.values(), *numbers, scene_of(about))
    values[CHECKSUM] = codes * values["converged"]
    shape = [len(sweep.axes[dim]) for dim in sweep.dims]
    values = {one: column.reshape(shape) for one, column in values.items()}
    if "poisson" in sweep.dims:  # differences from the smallest ratio, with summed errors
        for change, row in rows_of("change").items():
            source, sign = values[row["source"]], 1.0 if change.endswith("_error") else -1.0
            first = source.take([0], axis=sweep.dims.index("poisson"))
            values[change] = source + sign * first
    of_points = {one: described(TABLE[one], values[one], sweep.dims) for one in values}
    root = xr.Dataset(theory_limits.variables(sweep) | of_points, coords)
    describe_axes(root, sweep)
    groups = theory_limits.curves(sweep) | ({} if failed else _of_runs(runs))  # see `report`
    parts = {
        group: xr.Dataset(groups[group], attrs={"title": text, "motion": motion})
        for group, text in GROUPS.items()
        if group in groups
    }
    return root.assign_attrs(provenance(title, settings, versions, **about)), parts


GROUPS = {
    "velocity_curves": "Limits from theory on a fine axis of velocities",
    "amplitude_curves": "Limits from theory on a fine axis of amplitudes",
    "history": "Forces over time, the data of Figure 1",
    "field": "Tractions in the whole contact, the data of Figure 3",
    "transients": "Forces on the way to steady motion, the data of Figure 5",
}
"""Titles of the groups in the file of a sweep.  For each motion, only some of the groups exist."""
ENTRIES = {"history": "periods", "transients": "travel"}
"""For each group of single runs, the entry that identifies the requests of the group."""
LONGEST_TEXT = 256
"""Maximum number of characters in a string.  A longer string is truncated and ends with dots."""


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 3]}..."


def _of_runs(runs: list[dict]) -> dict[str, dict]:
    """Return the variables of single runs, keyed by group.

    The values come from the requests, the results and the closed forms.  A variable without the
    dimension `start` is taken from the first run of its group.
    """
    of_group: dict[str, list[dict]] = {}
    for record in runs:
        request = record["request"]
        group = next((name for name, key in ENTRIES.items() if key in request), request["kind"])
        forms = FORMS["continuous-bore"].values()
        steady = {form.name: form.function(float(request["velocity"])) for form in forms}
        of_group.setdefault(group, []).append(record["result"] | request | steady)
    variables: dict[str, dict] = {}
    for group, own in of_group.items():
        for name, row in rows_of(group).items():
            values = [run[row["source"]] for run in own]
            one = described(row, values if "start" in row["dims"].split() else values[0])
            variables.setdefault(group, {})[name] = one
    return variables


def provenance(title: str, settings: dict, versions: set, **more: object) -> dict:
    """Return the attributes of a dataset that state the provenance.

    Parameters
    ----------
    title : str
        Title of the dataset.
    settings : dict
        Settings from the configuration, which are stored as JSON.
    versions : set of str
        Versions of the libraries that computed the results.
    **more : object
        Additional attributes.
    """
    return {
        "Conventions": CONVENTIONS,
        "title": title,
        "institution": "not stated",  # to be filled in by the publisher of a dataset
        "source": f"microslip {microslip.__version__}: {METHOD}",
        "references": PAPER,
        "microslip_version": microslip.__version__,
        "source_digest": source_digest.of_solver(),
        "configuration": canonical_json(settings),
        "library_versions": "; ".join(sorted(versions)),
    } | more


def report(dataset: xr.Dataset, name: str) -> Iterator[str]:
    """Yield a line with the number of points, and a line for each point that did not converge."""
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
    """Set the attributes of the axes.  The attribute `formula` contains the definition of the
    coordinate."""
    motion = motion_named(sweep.motion)
    texts = {name: (one.text, one.unit, one.description) for name, one in DRIVES.items()}
    for name, of_paper, formula in (
        ("velocity", VELOCITY, motion.velocity_label),
        ("amplitude", AMPLITUDE, motion.amplitude_label),
    ):
        own = of_paper.get(motion.name)
        # The label is the same for all motions.
        texts[name] = of_paper["transverse"].text, formula, own.description if own else ""
    for name, (text, formula, description) in texts.items():
        if name in sweep.axes:
            about = {"long_name": f"{text}, {formula}", "units": "1", "formula": formula}
            about |= {"description": description} if description else {}
            dataset[name].attrs = about
    dataset["poisson"].attrs = {"long_name": "Poisson's ratio", "units": "1"}
