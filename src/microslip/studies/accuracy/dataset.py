"""Build the dataset accuracy_cost: errors and costs of trials, and model maps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from operator import itemgetter

import numpy as np
import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.config.settings import Accuracy
from microslip.datasets.variables import variable
from microslip.studies.accuracy import accuracy_cost as study
from microslip.studies.accuracy import profiles
from microslip.studies.accuracy.fronts import cheapest, confirmed, on_front
from microslip.studies.ladders import exact_model
from microslip.studies.requests import AnyPoint, Point
from microslip.studies.tables import Answers, finished, table, value_of
from microslip.theory import paper

MEASURED = (
    "seconds are CPU times measured in the runs that made this file: medians of compiled runs, "
    "after one run that is not timed. They depend on the computers in the group machines and vary "
    "a little; all other values are reproducible."
)

GROUPS = {
    "points": ("Points of the trials, and their references", ("point",)),
} | {
    f"{motion}_map": (
        f"Cheapest model within the tolerance, motion {motion}",
        ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity"),
    )
    for motion in study.MAP_MOTIONS
}
GROUPS["machines"] = ("Computers that times were measured on", ("machine",))
GROUPS["profile"] = (
    "Cost of a model or method over that of the best one",
    ("competitor", "map_tolerance", "point"),
)
"""Title and dimensions of each group of the dataset, by name. The table of trials is the root."""

POINT_COLUMNS: dict[str, tuple] = {
    "point": (lambda name, *_: name, "name of the point", str),
    "point_title": (lambda name, point, _: point.title or name, "title of the point", str),
    "point_motion": (lambda _, point, __: point.motion, "motion", str),
    "point_velocity": (lambda _, point, __: point.velocity, "forward velocity of the point"),
    "point_amplitude": (lambda _, point, __: point.amplitude, "amplitude"),
    "point_poisson": (lambda _, point, __: point.poisson, "Poisson's ratio of the point"),
    "reference": (lambda _, __, reference: reference[0], "mu_macro that trials are compared with"),
    "reference_error": (lambda _, __, reference: reference[1], "error estimate of the reference"),
    "reference_source": (lambda _, __, reference: reference[2], "source of the reference", str),
}
"""Columns of the table of points: (function of the name, the point and its reference, long_name,
type)."""
TRIAL_COLUMNS: dict[str, tuple] = {
    name: (itemgetter(name), *about)
    for name, about in {
        "trial_point": ("point of the trial", str),
        "trial_model": ("contact model, or auto for a solve at a tolerance", str),
        "trial_method": ("method of the run", str),
        "trial_level": ("level of the ladder of resolutions, or of tolerances", np.int32),
        "trial_cells": ("rings, or squares across the contact; 0 where it has none", np.int32),
        "trial_angles": ("angular points on half a ring; 0 where it has none", np.int32),
        "trial_steps": ("time steps in a period; 0 where it has none", np.int32),
        "trial_tolerance": ("requested tolerance",),
        "mu_macro": (MU_MACRO.description,),
        "error": ("distance of mu_macro from the reference",),
        "seconds": ("median CPU time of a compiled run", float, "s"),
        "effort": ("iterations of the step solver times unknowns",),
        "converged": ("the run converged", bool),
        "reason": ("reason why the run did not converge, else empty", str),
        "trial_machine": ("computer of the time, an index of the group machines", np.int32),
        "claimed_error": ("error estimate of the result, where it has one",),
        "front_seconds": ("no trial of the point is both faster and as accurate", bool),
        "front_effort": ("no trial of the point takes less effort and is as accurate", bool),
    }.items()
}
"""Columns of the table of trials: (function of a row, long_name, type, units)."""
MACHINE_COLUMNS: dict[str, tuple] = {
    "machine_cpu": (itemgetter("cpu"), "model of the processor", str),
    "machine_host": (itemgetter("host"), "name of the computer", str),
    "machine_threads": (itemgetter("threads"), "threads of a run", np.int32),
}


def build(settings: Accuracy, answer: Callable) -> xr.Dataset:
    """Build the dataset of the study.

    answer: function that returns the record of a request, such as batches.answer with a store.
    """
    answers = Answers(answer)
    points = settings.points
    references = {name: _reference(point, answers) for name, point in points.items()}
    trials = [
        row
        for name, point in points.items()
        for row in _trials(settings, name, point, references[name], answers)
    ]
    tolerances = settings.map.tolerance[::-1]  # from loose to tight
    about_points = zip(points, points.values(), references.values(), strict=True)
    variables = table("point", about_points, POINT_COLUMNS)
    variables |= table("trial", ((row,) for row in trials), TRIAL_COLUMNS)
    variables |= profiles.variables(trials, list(points), tolerances)
    for motion in study.MAP_MOTIONS:
        variables |= _map(settings, motion, answers)
        for name, values in (
            ("velocity", settings.map.velocity),
            ("amplitude", settings.map.amplitude[motion]),
        ):
            long_name = f"{name} in the groups of the motion {motion}"
            variables[f"{motion}_{name}"] = variable(f"{motion}_{name}", values, long_name)
    within = "largest error of mu_macro that the map allows"
    variables["map_tolerance"] = variable("map_tolerance", tolerances, within)
    title = "Accuracy and cost of methods for the friction of a vibrated Hertz contact"
    if answers.machines:
        variables |= table("machine", ((one,) for one in answers.machines), MACHINE_COLUMNS)
    return finished(variables, title, answers, settings, comment=MEASURED)


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield a line for each point: the number of trials, and the reference's error estimate."""
    for point in dataset["point"].values:
        own = dataset["trial_point"].values == point
        bad = int(own.sum() - dataset["converged"].values[own].sum())
        error = float(dataset["reference_error"].sel(point=point))
        yield (
            f"{point}: {own.sum()} trials, {bad or 'none'} not converged, "
            f"reference within {error:.1e}"
        )


# Trials


def _reference(point: AnyPoint, answers: Answers) -> tuple[float, float, str]:
    """Return (mu_macro, error, source) of the reference of a point."""
    request = study.truth(point)
    if request is None:
        return float(paper.bore_forward(point.velocity)), 0.0, "closed form, Eq 21"
    result = answers(request)
    source = f"model {value_of(result, 'model', str)}, tolerance {request['tolerance']}"
    if not result["converged"]:
        source += f", not met: {value_of(result, 'reason', str)}"
    return value_of(result, "mu_macro"), value_of(result, "mu_macro_error"), source


def _trials(
    settings: Accuracy,
    name: str,
    point: AnyPoint,
    reference: tuple[float, float, str],
    answers: Answers,
) -> list[dict]:
    """Return the rows of the trials at one point, with the keys of TRIAL_COLUMNS."""
    mu_reference, floor, _ = reference
    rows = []
    for level, request in study.trials(settings, point):
        result = answers(request)
        if not result.get("applies", True):
            continue
        chosen = request["kind"] == "choice"
        used = result if chosen else request | result
        mu = value_of(result, "mu_macro")
        rows.append(
            {
                "trial_point": name,
                "trial_model": "auto" if chosen else request["model"],
                "trial_method": study.SHIPPED if chosen else request["method"],
                "trial_level": level,
                "trial_cells": value_of(used, "cells", int),
                "trial_angles": value_of(used, "angles", int),
                "trial_steps": value_of(used, "steps_per_period" if chosen else "steps", int),
                "trial_tolerance": float(request["tolerance"]),
                "mu_macro": mu,
                "error": abs(mu - mu_reference),
                "seconds": value_of(result, "seconds"),
                "effort": value_of(result, "effort"),
                "converged": value_of(result, "converged", bool),
                "reason": value_of(result, "reason", str),
                "trial_machine": answers.machine_of(result),
                "claimed_error": value_of(result, "mu_macro_error") if chosen else np.nan,
            }
        )
    # Errors below the reference's error count as equal.
    error = [max(row["error"], floor) if row["converged"] else np.nan for row in rows]
    for cost in ("seconds", "effort"):
        front = on_front([row[cost] for row in rows], error)
        for row, mark in zip(rows, front, strict=True):
            row[f"front_{cost}"] = mark
    return rows


# Cheapest models, and the cost of a step


def _map(settings: Accuracy, motion: str, answers: Answers) -> dict:
    """Return the cheapest model at each point of a map, for each tolerance."""
    dims = ("map_tolerance", f"{motion}_amplitude", f"{motion}_velocity")
    tolerances = settings.map.tolerance[::-1]
    candidates = [_candidates(settings, p, answers) for p in study.map_points(settings, motion)]
    best = np.empty((len(CHEAPEST), len(tolerances), len(candidates)), object)
    for t, tolerance in enumerate(tolerances):
        for p, (trials, error) in enumerate(candidates):
            i = cheapest([seconds for *_, seconds in trials], error, tolerance)
            best[:, t, p] = ("", 0, np.nan) if i is None else trials[i]
    shape = (len(tolerances), len(settings.map.amplitude[motion]), -1)
    return {
        f"{motion}_cheapest{name}": variable(dims, values.reshape(shape), long_name, kind, units)
        for (name, kind, units, long_name), values in zip(CHEAPEST, best, strict=True)
    }


CHEAPEST = (
    ("", str, "", "cheapest model within the tolerance, empty if there is none"),
    ("_cells", np.int32, "1", "cells of the cheapest model"),
    ("_seconds", float, "s", "median CPU time of the cheapest model"),
)
"""Variables of a map: (suffix of the name, type, units, long_name)."""


def _candidates(
    settings: Accuracy, point: Point, answers: Answers
) -> tuple[list[tuple[str, int, float]], np.ndarray]:
    """Return the models, cells, seconds and confirmed errors of all trials at a map point."""
    truth = value_of(answers(study.map_truth(settings, point)), "mu_macro")
    trials, error = [], []
    for request in study.map_trials(settings, point):
        result = answers(request)
        trials.append((request["model"], request["cells"], value_of(result, "seconds")))
        converged = value_of(result, "converged", bool)
        error.append(abs(value_of(result, "mu_macro") - truth) if converged else np.inf)
    models = [model for model, *_ in trials]
    return trials, confirmed(models, error, exact_model(point.motion, point.poisson))
