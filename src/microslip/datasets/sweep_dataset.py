"""The dataset of a sweep.

Every dataset follows the CF conventions.  Limits from theory are variables, and attributes record
the provenance.  The root of a file contains the map.  Groups contain fine curves and single runs
(see `netcdf`).  All quantities are dimensionless.  Equal results give equal bytes: a file does not
depend on the time, the computer or the number of jobs.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice

import numpy as np
import xarray as xr

import microslip
from microslip.config.quantities import AMPLITUDE, DRIVES, VELOCITY
from microslip.config.settings import Configuration, Sweep
from microslip.datasets import netcdf, point_variables, theory_limits
from microslip.datasets.catalogue import FORMS
from microslip.datasets.variables import variable
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
    of_points, versions = point_variables.variables(sweep, axes, points)
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


def _root(sweep: Sweep, of_points: dict) -> xr.Dataset:
    """Return a dataset with the axes, the limits from theory and the variables of the points."""
    coords: dict[str, tuple] = {
        name: (name, np.array(values)) if name in sweep.dims else ((), values[0])
        for name, values in sweep.axes.items()
    }
    dataset = xr.Dataset(theory_limits.variables(sweep) | of_points, coords)
    describe_axes(dataset, sweep)
    return dataset


def _parts(sweep: Sweep, histories: Sequence[dict]) -> dict[str, xr.Dataset]:
    """Return the dataset of each group of a sweep, keyed by the names in GROUPS."""
    variables = theory_limits.curves(sweep) | _single_runs(sweep, histories)
    about = {"motion": solver_names(sweep)[0]}
    return {
        name: xr.Dataset(variables[name], attrs={"title": title} | about)
        for name, title in GROUPS.items()
        if name in variables
    }


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


# Single runs, the data of Figures 1, 3 and 5


def _single_runs(sweep: Sweep, records: Sequence[dict]) -> dict[str, dict]:
    """For each group of single runs, by name: return a dict of variables."""
    if not records or any(record["result"].get("crashed") for record in records):
        return {}  # `report` lists failed runs
    fields = [record for record in records if record["request"]["kind"] == "field"]
    transients = [record for record in records if "travel" in record["request"]]
    histories = [record for record in records if "periods" in record["request"]]
    groups = {"history": _force_history(histories[0])} if histories else {}
    groups |= {"field": _traction_field(fields[0])} if fields else {}
    return groups | ({"transients": _transients(transients)} if transients else {})


def _force_history(record: dict) -> dict[str, tuple]:
    result, request = record["result"], record["request"]
    step, friction = "history_step", "friction force divided by mu F_z"
    return {
        "history_phase": variable(step, result["phase"], "phase of the oscillation", units="rad"),
        "history_force_forward": variable(step, result["force_forward"], f"forward {friction}"),
        "history_force_lateral": variable(step, result["force_lateral"], f"lateral {friction}"),
        "history_velocity": variable((), request["velocity"], "forward velocity of the history"),
        "history_amplitude": variable((), request["amplitude"], "amplitude of the history"),
    }


FIELD = {
    "lateral_position": "lateral position divided by a",
    "forward_position": "forward position divided by a",
    "traction_lateral": "lateral traction divided by mu F_z/a^2",
    "traction_forward": "forward traction divided by mu F_z/a^2",
    "bound": "friction bound divided by mu F_z/a^2",
}


def _traction_field(record: dict) -> dict[str, tuple]:
    result, velocity = record["result"], record["request"]["velocity"]
    centre = "lateral centre of rotation divided by a"
    variables = {f"field_{name}": variable("cell", result[name], FIELD[name]) for name in FIELD}
    return variables | {
        "field_velocity": variable((), velocity, "forward velocity of the traction field"),
        "field_centre_lateral": variable((), result["centre_lateral"], centre),
    }


def _transients(records: Sequence[dict]) -> dict[str, tuple]:
    velocity = float(records[0]["request"]["velocity"])
    starts = [record["request"]["start"] for record in records]
    force, torque = (
        "forward friction force divided by mu F_z",
        point_variables.DESCRIPTIONS["mu_torque"],
    )

    def runs(name: str, text: str, **about: str) -> tuple:
        values = [record["result"][name] for record in records]
        return variable(("start", "transient_step"), values, text, float, "1", **about)

    def steady(form: str, text: str, description: str) -> tuple:
        value = FORMS["continuous-bore"][form].function(velocity)
        return variable((), value, f"steady {text}", description=f"steady {description}")

    return {
        "start": ("start", starts, {"long_name": "initial state of the transient"}),
        "transient_displacement": runs("displacement_forward", "forward travel divided by u_lim"),
        "transient_force_forward": runs("force_forward", force),
        "transient_torque": runs("torque", point_variables.TORQUE, description=torque),
        "transient_velocity": variable((), velocity, "forward velocity of the transients"),
        "transient_force_theory": steady(
            "mu_forward_theory", "forward force (Eq 21)", f"{force} (Eq 21)"
        ),
        "transient_torque_theory": steady(
            "mu_torque_theory", "torque (Eq 22)", f"{torque} (Eq 22)"
        ),
    }
