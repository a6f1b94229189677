"""A small configuration of the claims, and results from the formulas that the claims test."""

import numpy as np

from microslip.config import load
from microslip.scene.by_name import pressure_named
from microslip.theory import oscillating_load, paper

CLAIMS = {
    "tolerance": 0.001,
    "velocity": [0.001, 0.1, 1],
    "amplitude_transverse": [0.5, 2],
    "amplitude_bore": [1, 3, 5],
    "cells": 8,
}


def configured(**changes):
    """Configuration of the claims with some settings changed."""
    return load.from_mapping({"claims": CLAIMS | changes})


LIMITS = {"transverse": paper.static_limit_transverse, "bore": paper.static_limit_bore}


def friction(request):
    """Friction that increases with velocity from the exact limit to above Eq 6 or Eq 29; exact for
    an oscillating indentation."""
    motion, velocity = request["motion"], float(request["velocity"])
    if motion == "continuous-bore":
        return float(paper.bore_forward(velocity))
    amplitude = float(request["amplitude"])
    if motion == "normal:indentation=1":
        pressure = pressure_named(request["pressure"])
        return oscillating_load.friction(velocity, amplitude, False, pressure)
    limit = float(LIMITS[motion](amplitude))
    if motion == "bore":
        large = float(paper.large_amplitude_bore(velocity))
    else:
        large = float(paper.large_amplitude_transverse(velocity, amplitude))
    return limit + (1 - limit) * large


def steady(request):
    """Tractions that slip everywhere along the rigid motion (Eq 15)."""
    lateral, forward = np.array([-0.5, 0.1, 0.6, 0.2]), np.array([0.1, -0.4, 0.3, 0.7])
    velocity = float(request["velocity"])
    one, other = paper.steady_bore_traction(lateral, forward, velocity)
    bound = np.hypot(one, other)
    names = ("lateral_position", "forward_position", "traction_lateral", "traction_forward")
    field = dict(zip(names, (lateral, forward, one, other), strict=True)) | {"bound": bound}
    return {name: values.tolist() for name, values in field.items()}


def period(request):
    """Four steps each way; the smallest contact sticks on one side at the end of a stroke."""
    points = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    share = np.where(np.cos(points) < 0, 0.5, 1.0)
    right = [0.0, 0.5, 0.4, 0.2, 0.0, 0.5, 0.4, 0.3, 0.1]
    left = [0.1, 0.5, 0.4, 0.3, 0.1, 0.5, 0.4, 0.2, 0.0]
    return {
        "mu_macro": 0.3,
        "converged": True,
        "reason": "",
        "phase": np.linspace(-0.5, 1.5, 9) * np.pi,
        "stick_right": right,
        "stick_left": left,
        "least_stick": 0.1,
        "area": [np.pi / 48] * 48,
        "lateral_position": 0.4 * np.cos(points),
        "forward_position": 0.4 * np.sin(points),
        "moment_phase": np.array([0.45, 0.0, 1.45, 1.0]) * np.pi,
        "moment_share": np.array([share, 0.3 + 0 * share, share[::-1], 0.3 + 0 * share]),
    }


def result(request):
    """Results of an exact solver with error estimates of 1e-4, and of squares with an error of
    0.002."""
    kind = request["kind"]
    if kind == "history":
        force = [0.0, *[float(paper.bore_forward(0.8))] * 30]
        return {"force_forward": force, "torque": [0.0, *[float(paper.bore_torque(0.8))] * 30]}
    if kind == "field":
        return steady(request)
    if kind == "patches":
        return period(request)
    off = 0.002 if request["model"] == "cartesian" else 0.0
    answer = {"mu_macro": friction(request) + off, "converged": True, "reason": ""}
    if kind == "point":
        static = request["velocity"] == "0" and request["model"] == "auto"
        answer |= {"mu_macro_error": 1e-12 if static else 1e-4, "cells": 16, "angles": 8}
        answer |= {"steps_per_period": 64, "model": request["model"]}
    return answer
