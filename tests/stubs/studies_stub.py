"""Small configurations of the studies, and their results from formulas."""

import xarray as xr

from microslip.config import load
from microslip.studies import registry
from microslip.sweeps import request as requests
from microslip.theory import paper

ACCURACY = {
    "methods": ["shipped", "euler", "paper", "full-newton"],
    "points": {
        "mid": {"motion": "transverse", "velocity": 0.1, "amplitude": 0.5, "title": "half way"},
        "steady": {"motion": "continuous-bore", "velocity": 0.8},
    },
    "levels": 3,
    "repeats": 2,
    "map": {
        "velocity": [0.1, 1],
        "amplitude_transverse": [0.5, 2],
        "amplitude_bore": [1, 2],
        "tolerance": [0.01, 0.001],
    },
}
FIXED = {"motion": "transverse", "velocity": 0.1, "amplitude": 1}
STABILITY = {
    "methods": ["shipped", "projected-gradient", "euler"],
    "axes": {
        "poisson": FIXED | {"amplitude": 0.7, "poisson": [0, 0.2, 0.4], "title": "Poisson's ratio"},
        "step-length": FIXED | {"step": [0.25, 0.5, 1, 2]},
        "steps": FIXED | {"steps": [8, 64]},
    },
}


def configured(accuracy=(), stability=()):
    """Configuration of both studies with some settings changed."""
    settings = {"accuracy": ACCURACY | dict(accuracy), "stability": STABILITY | dict(stability)}
    return load.from_mapping(settings)


GOOD = {
    "applies": True,
    "converged": True,
    "periodic": True,
    "mu_macro": 0.5,
    "mu_macro_error": 1e-3,
    "reason": "",
}


def built(configuration, study, results):
    """Root and groups of the dataset of a study with the results `results(request)`."""
    pieces = registry.pieces(study, configuration.studies[study])
    every = [request for piece in pieces for request in piece]
    records = [
        {"key": requests.key_of(one), "result": results(one), "versions": {"numpy": "2.0"}}
        for one in every
    ]
    return registry.build(configuration, study, records)


def dataset(configuration, study, results):
    """Dataset of a study with the variables of all groups."""
    root, groups = built(configuration, study, results)
    return xr.merge([root, *groups.values()], combine_attrs="override")


def mu_of(request):
    amplitude = float(request["amplitude"] or 0)
    return float(request["velocity"]) / (1 + float(request["velocity"]) + amplitude)


def accuracy_result(request):
    """Results, and the description of the computer for those with a time."""
    result = untimed(request)
    timed = {"machine": {"cpu": "a processor", "host": "here", "threads": 1}}
    return result | timed if "seconds" in result else result


def untimed(request):
    """Results with errors of 0.1/cells^2, times of cells * 1e-3 s and work of cells^2. The slider
    has an error of 0.005 and takes 1e-5 s."""
    kind = request["kind"]
    if kind == "point":
        return {"mu_macro": mu_of(request), "mu_macro_error": 2e-4, "converged": True} | {
            "model": "radial",
            "reason": "",
        }
    if kind == "choice":
        error = 0.3 * float(request["tolerance"])
        result = {"mu_macro": mu_of(request) - error, "mu_macro_error": 2 * error, "cells": 24}
        return result | {
            "seconds": 9.0,
            "effort": 900,
            "steps_per_period": 64 if request["amplitude"] else 0,
            "converged": True,
        }
    if request["method"] == "full-newton":
        return {"applies": False, "converged": False, "reason": "not here"}
    if request["method"] == "euler":
        return {"applies": True, "converged": False, "reason": "gave up", "seconds": 1e-9}
    cells = request["cells"]
    error, seconds = 0.1 / cells**2, 1e-3 * cells
    if request["model"] == "slider":
        error, seconds = 0.005, 1e-5
    mu = (
        mu_of(request)
        if request["amplitude"]
        else float(paper.bore_forward(float(request["velocity"])))
    )
    return {"mu_macro": mu + error, "converged": True, "reason": "", "seconds": seconds} | {
        "effort": cells**2,
        "applies": True,
    }


def stability_result(request):
    if request["kind"] == "point":
        return {"mu_macro": 0.5, "mu_macro_error": 1e-5, "converged": True}
    if request["method"] == "euler":
        return GOOD | {"converged": False, "periodic": False, "reason": "gave up", "work": 7}
    return GOOD | {"mu_macro": 0.5005, "work": 12}
