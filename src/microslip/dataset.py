"""Results of a sweep as an xarray Dataset, and onto disk.

Every dataset follows the CF conventions, holds the paper's limits as variables of their own and
says what made it. All quantities are dimensionless. The same results give the same bytes: nothing
in a file depends on when, where or in how many jobs it was made.
"""

import numpy as np
import xarray as xr

import microslip

from . import limits, theory
from .cache import writing_beside
from .keys import canonical_json, source_digest

CONVENTIONS = "CF-1.11"
PAPER = "R. Pohrt, Front. Mech. Eng. 6:566440 (2020), doi:10.3389/fmech.2020.566440"

VELOCITY = {
    "transverse": "forward velocity over angular frequency and u_lim (Eq 4)",
    "bore": "forward velocity over largest rotational velocity of the contact's edge (Eq 28)",
    "continuous-bore": "forward velocity over rotational velocity of the contact's edge (Eq 13)",
}
AMPLITUDE = {
    "transverse": "amplitude of the transverse oscillation over u_lim (Eq 2)",
    "bore": "amplitude of the rotation over the one that leaves the stick radius a/2 (Eq 27)",
}

# Variables over the sweep: name -> (type, long_name). 0 stands where a count does not apply.
POINT_VARIABLES = {
    "mu_macro": (float, "mean forward friction force over mu F_z"),
    "mu_macro_error": (float, "estimated error of mu_macro"),
    "error_space": (float, "part of mu_macro_error from the cells"),
    "error_time": (float, "part of mu_macro_error from the time steps"),
    "error_periodicity": (float, "part of mu_macro_error from the distance to the periodic state"),
    "error_solver": (float, "part of mu_macro_error from the iteration in each step"),
    "error_model": (float, "part of mu_macro_error from a closed form used in place of a run"),
    "converged": (bool, "mu_macro_error is within the tolerance"),
    "cells": (np.int32, "rings, or squares across the contact"),
    "angles": (np.int32, "angular points on half a ring"),
    "steps_per_period": (np.int32, "time steps in a period"),
    "periods": (np.int32, "half periods marched in the longest run"),
    "iterations": (np.int32, "iterations of the step solver in all runs"),
    "work": (np.int64, "step solves times unknowns, summed over all runs"),
    "model": (str, "contact model that was used"),
    "reason": (str, "why the point did not converge, empty if it did"),
}
TORQUE_VARIABLES = {
    "mu_torque": (float, "torque about the normal over its value at zero forward velocity"),
    "mu_torque_error": (float, "estimated error of mu_torque"),
}


def build(sweep, points, histories, settings):
    """Assemble the Dataset of a sweep.

    sweep: config.Sweep. points: records in the order of sweep.point_requests, any iterable.
    histories: records in the order of sweep.history_requests. settings: dict of the configuration
    that led here, kept as provenance. Returns an xarray.Dataset with dims (amplitude, velocity),
    those of them that the scene has, and poisson before them if that is an axis. Raises
    ValueError if there are not as many points as the grid has.
    """
    axes = _axes(sweep)
    shape = tuple(len(values) for values in axes.values())
    variables, versions = _from_points(sweep, points, tuple(axes), shape)
    variables |= limits.variables(sweep)
    for record in histories:
        versions.add(canonical_json(record["versions"]))
    coords = {name: (name, np.array(values)) for name, values in axes.items()}
    if not sweep.poisson_is_axis:
        coords["poisson"] = ((), sweep.poisson[0])
    dataset = xr.Dataset(variables | _single_runs(sweep, histories), coords)
    if "transient_step" in dataset.dims:
        starts = [r["request"]["start"] for r in histories if r["request"]["kind"] == "history"]
        dataset = dataset.assign_coords(start=("start", starts))
        dataset["start"].attrs["long_name"] = "initial state of the transient"
    _describe_axes(dataset, sweep)
    title = f"Friction of a vibrated Hertz contact, scene {sweep.scene}"
    about = {"scene": sweep.scene, "tolerance": sweep.tolerance}
    dataset.attrs = provenance(title, settings, versions, **about)
    return dataset


def provenance(title, settings, versions, **more):
    """Attributes that say what made a dataset; settings: dict, kept as JSON; versions: set of
    texts, those of the libraries behind its results."""
    return {
        "Conventions": CONVENTIONS,
        "title": title,
        "references": PAPER,
        "microslip_version": microslip.__version__,
        "source_digest": source_digest(),
        "configuration": canonical_json(settings),
        "library_versions": "; ".join(sorted(versions)),
    } | more


def write(dataset, path):
    """Write a Dataset to the netCDF-4 file `path`, all of it or nothing.

    The same dataset gives the same bytes. Raises CacheError, one line that says what to do, on a
    full disk, a read-only folder and the like.
    """
    encoding = {
        name: {"_FillValue": None} for name, v in dataset.variables.items() if v.dtype.kind == "f"
    }
    with writing_beside(path) as beside:
        dataset.to_netcdf(beside, engine="netcdf4", format="NETCDF4", encoding=encoding)


def report(dataset):
    """Lines of text: how many points there are and, one each, those that did not converge."""
    converged = dataset["converged"]
    bad = np.argwhere(~converged.values)
    yield f"{dataset.scene}: {converged.size} points, {len(bad) or 'none'} not converged"
    for index in bad:
        point = dataset.isel(dict(zip(converged.dims, index, strict=True)))
        where = ", ".join(f"{dim} {float(point[dim]):g}" for dim in converged.dims)
        yield f"  not converged: {where}: {point['reason'].item()}"


def _axes(sweep):
    axes = {"poisson": sweep.poisson} if sweep.poisson_is_axis else {}
    if sweep.amplitude is not None:
        axes["amplitude"] = sweep.amplitude
    return axes | {"velocity": sweep.velocity}


def _describe_axes(dataset, sweep):
    names = {"velocity": VELOCITY[sweep.scene], "poisson": "Poisson's ratio"}
    if sweep.amplitude is not None:
        names["amplitude"] = AMPLITUDE[sweep.scene]
    for name, long_name in names.items():
        dataset[name].attrs = {"long_name": long_name, "units": "1"}


# Points


def _from_points(sweep, points, dims, shape):
    """Variables of POINT_VARIABLES over dims, and the set of library versions behind them."""
    table = POINT_VARIABLES | (TORQUE_VARIABLES if sweep.amplitude is None else {})
    size = int(np.prod(shape))
    columns = {
        name: np.zeros(size, object if kind is str else kind) for name, (kind, _) in table.items()
    }
    versions, count = set(), 0
    for count, record in enumerate(points, start=1):
        if count > size:
            break
        versions.add(canonical_json(record["versions"]))
        for name, (kind, _) in table.items():
            value = record["result"].get(name)
            if value is None:
                value = _MISSING[kind]
            columns[name][count - 1] = value
    if count != size:
        raise ValueError(f"{sweep.name}: {count} results for the {size} points of the sweep")
    meanings = {"converged": {"flags": "not_converged converged"}}
    variables = {
        name: (dims, column.reshape(shape), attributes(*table[name], **meanings.get(name, {})))
        for name, column in columns.items()
    }
    return variables, versions


_MISSING = {float: np.nan, bool: False, np.int32: 0, np.int64: 0, str: ""}


def attributes(kind, long_name, units="1", flags="no yes"):
    """Attributes of a variable whose values are of a type; flags: what the two of bool mean."""
    if kind is str:
        return {"long_name": long_name}
    if kind is bool:
        # Stored as bytes with these meanings; xarray gives them back as bool.
        values = np.array([0, 1], np.int8)
        return {"long_name": long_name, "flag_values": values, "flag_meanings": flags}
    return {"long_name": long_name, "units": units}


# Single runs, the data of Figures 1, 3 and 5


def _single_runs(sweep, records):
    if not records:
        return {}
    if sweep.scene == "transverse":
        return _force_history(records[0])
    fields = [record for record in records if record["request"]["kind"] == "field"]
    return _traction_field(fields[0]) | _transients([r for r in records if r not in fields])


def _force_history(record):
    result, request = record["result"], record["request"]
    step, friction = "history_step", "friction force over mu F_z"
    return {
        "history_phase": _variable(step, result["phase"], "phase of the oscillation", "rad"),
        "history_force_forward": _variable(step, result["force_forward"], f"forward {friction}"),
        "history_force_lateral": _variable(step, result["force_lateral"], f"lateral {friction}"),
        "history_velocity": _variable((), request["velocity"], "forward velocity of the history"),
        "history_amplitude": _variable((), request["amplitude"], "amplitude of the history"),
    }


FIELD = {
    "lateral_position": "lateral position over a",
    "forward_position": "forward position over a",
    "traction_lateral": "lateral traction over mu F_z/a^2",
    "traction_forward": "forward traction over mu F_z/a^2",
    "bound": "friction bound over mu F_z/a^2",
}


def _traction_field(record):
    result, velocity = record["result"], record["request"]["velocity"]
    centre = "lateral position of the centre of rotation over a"
    variables = {f"field_{name}": _variable("cell", result[name], FIELD[name]) for name in FIELD}
    return variables | {
        "field_velocity": _variable((), velocity, "forward velocity of the traction field"),
        "field_centre_lateral": _variable((), result["centre_lateral"], centre),
    }


def _transients(records):
    velocity = float(records[0]["request"]["velocity"])
    dims = ("start", "transient_step")
    rows = {
        name: np.array([record["result"][name] for record in records], float)
        for name in ("displacement_forward", "force_forward", "torque")
    }
    force = "forward friction force over mu F_z"
    torque = "torque about the normal over its value at zero forward velocity"
    return {
        "transient_displacement": _variable(
            dims, rows["displacement_forward"], "forward travel over u_lim"
        ),
        "transient_force_forward": _variable(dims, rows["force_forward"], force),
        "transient_torque": _variable(dims, rows["torque"], torque),
        "transient_velocity": _variable((), velocity, "forward velocity of the transients"),
        "transient_force_theory": _variable(
            (), theory.bore_forward(velocity), f"steady {force} (Eq 21)"
        ),
        "transient_torque_theory": _variable(
            (), theory.bore_torque(velocity), f"steady {torque} (Eq 22)"
        ),
    }


def _variable(dims, values, long_name, units="1"):
    return dims, np.array(values, float), {"long_name": long_name, "units": units}
