"""The dataset accuracy_cost: trials with errors and costs, maps of models, costs of a step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.config.settings import Accuracy
from microslip.datasets.variables import variable
from microslip.studies.accuracy import accuracy_cost as study
from microslip.studies.accuracy import profiles
from microslip.studies.accuracy.fronts import cheapest, confirmed, exponent, on_front
from microslip.studies.ladders import exact_model
from microslip.studies.requests import Point
from microslip.studies.tables import Answers, columns, finished, value_of
from microslip.theory import paper

MEASURED = (
    "seconds are CPU times measured in the runs that made this file: medians, compiled, after one "
    "run that is not timed. They belong to the computers in the group machines and vary a little; "
    "all other values are reproducible."
)

GROUPS = {
    "points": ("Points that trials are run at, and their references", ("point",)),
    "scaling": ("What a step costs on finer grids", ("scaling_model", "scaling_size")),
} | {
    f"{motion}_map": (
        f"The cheapest model that is good enough, motion {motion}",
        ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity"),
    )
    for motion in study.MAP_MOTIONS
}
GROUPS["machines"] = ("Computers that times were measured on", ("machine",))
GROUPS["profile"] = (
    "How much dearer than the best a model or a method is",
    ("competitor", "map_tolerance", "point"),
)
"""Groups of the dataset besides the table of trials: titles and dims."""

# Columns of the table of trials: name -> (long_name, type, units). 0: a count does not apply.
TRIAL_VARIABLES = {
    "trial_point": ("point that the trial was run at", str),
    "trial_model": ("contact model, or auto for the choice that follows a tolerance", str),
    "trial_method": ("method that was run", str),
    "trial_level": ("level of the ladder of resolutions, or of tolerances", np.int32),
    "trial_cells": ("rings, or squares across the contact", np.int32),
    "trial_angles": ("angular points on half a ring", np.int32),
    "trial_steps": ("time steps in a period", np.int32),
    "trial_tolerance": ("tolerance that was asked for",),
    "mu_macro": (MU_MACRO.description,),
    "error": ("distance of mu_macro from the reference",),
    "seconds": ("median CPU time of a run, compiled", float, "s"),
    "effort": ("iterations of the step solver times unknowns",),
    "converged": ("the run says that it converged", bool),
    "reason": ("why the run did not converge, empty if it did", str),
    "trial_machine": ("computer of the time, an index of the group machines", np.int32),
    "claimed_error": ("error that the result claims for itself, where it claims one",),
    "front_seconds": ("no trial of the point is faster and as accurate", bool),
    "front_effort": ("no trial of the point takes less effort and is as accurate", bool),
}


def build(settings: Accuracy, answer: Callable) -> xr.Dataset:
    """Assemble the Dataset.

    answer(request) -> record, such as batches.answer with a store.
    """
    answers = Answers(answer)
    points = study.points(settings)
    coords = {"point": variable("point", list(points), "name of the point", str)}
    titles = [given.title or name for name, given in settings.points.items()]
    variables = _points(list(points.values()), titles, answers)
    trials = _trials(settings, points, answers, variables)
    tolerances = settings.map.tolerance[::-1]  # from loose to tight
    rows = {name: (trials[name], *about) for name, about in TRIAL_VARIABLES.items()}
    variables |= columns("trial", rows)
    variables |= profiles.variables(trials, list(points), tolerances)
    variables |= _scaling(settings, answers)
    for motion in study.MAP_MOTIONS:
        variables |= _map(settings, motion, answers)
        for name, values in (
            ("velocity", settings.map.velocity),
            ("amplitude", settings.map.amplitude[motion]),
        ):
            long_name = f"{name} in the groups of the motion {motion}"
            coords[f"{motion}_{name}"] = variable(f"{motion}_{name}", values, long_name)
    within = "largest error of mu_macro that the map allows"
    coords["map_tolerance"] = variable("map_tolerance", tolerances, within)
    models = list(study.SCALING_SIZES)
    coords["scaling_model"] = variable("scaling_model", models, "contact model", str)
    title = "Accuracy and cost of methods for the friction of a vibrated Hertz contact"
    if answers.machines:
        variables |= columns("machine", _machines(answers.machines))
    return finished(variables, coords, title, answers, settings, comment=MEASURED)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Lines of text: how many trials there are at every point, and how good the reference is."""
    for point in dataset["point"].values:
        own = dataset["trial_point"].values == point
        bad = int(own.sum() - dataset["converged"].values[own].sum())
        error = float(dataset["reference_error"].sel(point=point))
        yield (
            f"{point}: {own.sum()} trials, {bad or 'none'} not converged, "
            f"reference within {error:.1e}"
        )


def _machines(machines: list[dict]) -> dict[str, tuple]:
    return {
        "machine_cpu": ([m["cpu"] for m in machines], "model of the processor", str),
        "machine_host": ([m["host"] for m in machines], "name of the computer", str),
        "machine_threads": ([m["threads"] for m in machines], "threads of a run", np.int32),
    }


# Points and trials


def _points(points: list[Point], titles: list[str], answers: Answers) -> dict:
    found = [_reference(point, answers) for point in points]
    amplitudes = [np.nan if p.amplitude is None else p.amplitude for p in points]
    return columns(
        "point",
        {
            "point_title": (titles, "title of the point", str),
            "point_motion": ([p.motion for p in points], "what moves", str),
            "point_velocity": ([p.velocity for p in points], "forward velocity of the point"),
            "point_amplitude": (amplitudes, "amplitude of the point"),
            "point_poisson": ([p.poisson for p in points], "Poisson's ratio of the point"),
            "reference": ([f[0] for f in found], "mu_macro that trials are compared with"),
            "reference_error": ([f[1] for f in found], "error that the reference claims"),
            "reference_source": ([f[2] for f in found], "where the reference comes from", str),
        },
    )


def _reference(point: Point, answers: Answers) -> tuple[float, float, str]:
    """(mu, error, source) that the trials of a point are compared with."""
    request = study.truth(point)
    if request is None:
        return float(paper.bore_forward(point.velocity)), 0.0, "closed form, Eq 21"
    result = answers(request)
    source = f"model {value_of(result, 'model', str)}, tolerance {request['tolerance']}"
    if not result["converged"]:
        source += f", not met: {value_of(result, 'reason', str)}"
    return value_of(result, "mu_macro"), value_of(result, "mu_macro_error"), source


def _trials(
    settings: Accuracy, points: dict[str, Point], answers: Answers, of_points: dict
) -> dict[str, list]:
    """Columns of TRIAL_VARIABLES, as lists."""
    rows: list[dict] = []
    fronts: dict[str, list] = {"front_seconds": [], "front_effort": []}
    for i, (name, point) in enumerate(points.items()):
        reference, floor = (of_points[name][1][i] for name in ("reference", "reference_error"))
        found = []
        for level, request in study.trials(settings, point):
            result = answers(request)
            if result.get("applies", True):
                found.append(_row(name, level, request, result, reference))
                found[-1]["trial_machine"] = answers.machine_of(result)
        rows += found
        # What the reference does not resolve does not count.
        error = [max(row["error"], floor) if row["converged"] else np.nan for row in found]
        for name, front in fronts.items():
            front.extend(on_front([row[name.removeprefix("front_")] for row in found], error))
    return {name: [row[name] for row in rows] for name in TRIAL_VARIABLES if name not in fronts} | (
        fronts
    )


def _row(point: str, level: int, request: dict, result: dict, reference: float) -> dict[str, Any]:
    chosen = request["kind"] == "choice"
    used = result if chosen else request | result
    mu = value_of(result, "mu_macro")
    return {
        "trial_point": point,
        "trial_model": "auto" if chosen else request["model"],
        "trial_method": study.SHIPPED if chosen else request["method"],
        "trial_level": level,
        "trial_cells": value_of(used, "cells", int),
        "trial_angles": value_of(used, "angles", int),
        "trial_steps": value_of(used, "steps_per_period" if chosen else "steps", int),
        "trial_tolerance": float(request["tolerance"]),
        "mu_macro": mu,
        "error": abs(mu - reference),
        "seconds": value_of(result, "seconds"),
        "effort": value_of(result, "effort"),
        "converged": value_of(result, "converged", bool),
        "reason": value_of(result, "reason", str),
        "claimed_error": value_of(result, "mu_macro_error") if chosen else np.nan,
    }


# Models that are good enough, and the cost of a step


def _map(settings: Accuracy, motion: str, answers: Answers) -> dict:
    dims = ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity")
    tolerances = settings.map.tolerance[::-1]
    found = [_candidates(settings, p, answers) for p in study.map_points(settings, motion)]
    best = np.empty((len(CHEAPEST), len(tolerances), len(found)), object)
    for t, tolerance in enumerate(tolerances):
        for p, (trials, error) in enumerate(found):
            i = cheapest([seconds for *_, seconds in trials], error, tolerance)
            best[:, t, p] = ("", 0, np.nan) if i is None else trials[i]
    shape = (len(tolerances), len(settings.map.amplitude[motion]), -1)
    return {
        f"{motion}_cheapest{name}": variable(dims, values.reshape(shape), long_name, kind, units)
        for (name, kind, units, long_name), values in zip(CHEAPEST, best, strict=True)
    }


CHEAPEST = (
    ("", str, "", "cheapest model within the tolerance, empty if there is none"),
    ("_cells", np.int32, "1", "cells that the cheapest model needs"),
    ("_seconds", float, "s", "median CPU time of the cheapest model"),
)
"""Variables of a map: end of the name, type, units and long_name."""


def _candidates(
    settings: Accuracy, point: Point, answers: Answers
) -> tuple[list[tuple[str, int, float]], np.ndarray]:
    """Model, cells and seconds of all trials at a point of a map, and their errors."""
    truth = value_of(answers(study.map_truth(settings, point)), "mu_macro")
    requests = study.map_trials(settings, point)
    results = [answers(request) for request in requests]
    error = [
        abs(value_of(r, "mu_macro") - truth) if value_of(r, "converged", bool) else np.inf
        for r in results
    ]
    models = [request["model"] for request in requests]
    trials = [
        (request["model"], request["cells"], value_of(result, "seconds"))
        for request, result in zip(requests, results, strict=True)
    ]
    return trials, confirmed(models, error, exact_model(point.motion, point.poisson))


def _scaling(settings: Accuracy, answers: Answers) -> dict:
    dims = ("scaling_model", "scaling_size")
    asked = [study.scaling(settings, model) for model in study.SCALING_SIZES]
    shape = (len(asked), max(map(len, asked)))
    described = {
        "unknowns": ("1", "tractions that a step solves for"),
        "iterations": ("1", "iterations of the step solver in a step"),
        "seconds": ("s", "median CPU time of a step"),
        "memory": ("byte", "memory that the contact's arrays take"),
    }
    values = {name: np.full(shape, np.nan) for name in described}
    labels = np.full(shape, "", object)
    for i, requests in enumerate(asked):
        for j, request in enumerate(requests):
            result = answers(request)
            labels[i, j] = study.size_label(request)
            for name in described:
                values[name][i, j] = value_of(result, name)
    variables = {
        f"scaling_{name}": variable(dims, values[name], long_name, units=units)
        for name, (units, long_name) in described.items()
    }
    variables["scaling_label"] = variable(dims, labels, "size of the grid", str)
    for name in ("iterations", "seconds", "memory"):
        fitted = [exponent(*row) for row in zip(values["unknowns"], values[name], strict=True)]
        long_name = f"exponent of {name} over unknowns, fitted to the larger half of the sizes"
        variables[f"scaling_exponent_{name}"] = variable("scaling_model", fitted, long_name)
    return variables
