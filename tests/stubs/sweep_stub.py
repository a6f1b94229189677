"""A fast substitute for the solver."""

from types import SimpleNamespace

import numpy as np

from microslip.config import load
from microslip.sweeps import batch, request

EFFORT = {
    "cells": 16,
    "angles": 1,
    "steps_per_period": 64,
    "periods": 2.5,
    "iterations": 9,
    "work": 8,
    "effort": 72,
}


def configured(sweeps, **keys):
    """A configuration of sweeps; a sweep without a motion has the motion of its name."""
    named = {name: {"motion": name.replace("_", "-")} | sweep for name, sweep in sweeps.items()}
    return load.from_mapping({"sweeps": named, **keys})


RUNS = {
    "history": {"kind": "history", "sweep": "transverse"},
    "field": {"kind": "field", "sweep": "continuous_bore"},
    "transients": {"kind": "transients", "sweep": "continuous_bore"},
}
"""Figures that ask for single runs."""


def requests_of(configuration, name):
    """Requests of the points and single runs of a sweep."""
    points = request.points_of(configuration.sweeps[name]).requests
    return points + request.runs_of(configuration, name)


def records_of(configuration, name):
    """Records of a sweep, from the solver or its substitute."""
    return [batch.computed(one)[0] for one in requests_of(configuration, name)]


class Solver:
    """Substitute for microslip.solve, history and traction_field that counts its calls.

    mu_macro is velocity/(1 + velocity + amplitude), and less with Poisson's ratio and on a spring.
    fails: amplitude at which no point converges.
    """

    def __init__(self, monkeypatch, fails=None):
        self.calls = 0
        self.fails = fails
        for name in ("solve", "history", "traction_field"):
            monkeypatch.setattr(f"microslip.{name}", getattr(self, name), raising=False)

    def solve(self, motion, velocity, amplitude=None, **settings):
        self.calls += 1
        result = {"motion": motion, "velocity": velocity, "amplitude": amplitude, **EFFORT}
        result |= {"poisson": settings["poisson"], "tolerance": settings["tolerance"]}
        result |= {f"error_{part}": 1e-5 for part in ("resolution", "periodicity", "solver")}
        good = self.fails is None or amplitude != self.fails
        result["mu_macro"] = velocity / (1 + velocity + (amplitude or 0)) if good else float("nan")
        result["mu_macro"] -= 0.1 * settings["poisson"] * (1 + settings.get("stiffness", 0))
        result |= {"mu_macro_error": 4e-5, "model": "polar", "converged": good}
        result["reason"] = "" if good else "no periodic state"
        if amplitude is None:
            result |= {"mu_torque": 1 / (1 + velocity), "mu_torque_error": 1e-5}
        return SimpleNamespace(to_dict=lambda: result | {"solve_time_s": 1.0 * self.calls})

    def history(self, motion, velocity, amplitude=None, *, start="stress-free", **extent):
        self.calls += 1
        phase = np.linspace(0, 1, 5)
        force = phase if start == "stress-free" else 1 - phase
        return SimpleNamespace(
            phase=phase,
            displacement_forward=velocity * phase,
            force_forward=force,
            force_lateral=-force,
            torque=1 - force,
        )

    def traction_field(self, motion, velocity, amplitude=None, **settings):
        self.calls += 1
        x = np.array([-0.5, 0.0, 0.5])
        return {
            "lateral_position": x,
            "forward_position": 0 * x,
            "traction_lateral": 0 * x,
            "traction_forward": -np.sign(x + velocity),
            "bound": 1 - x**2,
            "centre_lateral": -velocity,
        }
