"""Methods that need another package: their messages without it, and their results with it."""

import math
import os
import sys
from dataclasses import fields
from importlib.util import find_spec

import numpy as np
import pytest
from stubs.studies_stub import configured

import microslip
from microslip.answer import point as trial
from microslip.contact.path import EULER, make_path
from microslip.contact.registry import MODELS
from microslip.contact.squares import CartesianContact
from microslip.foundation import canonical
from microslip.motions.by_name import MOTIONS
from microslip.motions.named import Transverse
from microslip.motions.problem import Problem
from microslip.solver import method_names
from microslip.solver.discretise import Resolution
from microslip.solver.methods import aspher
from microslip.studies import accuracy, requests

os.environ.setdefault("OMP_NUM_THREADS", "1")  # read when the package is first imported
needs_it = pytest.mark.skipif(find_spec("aspher") is None, reason="the package is not installed")


# Without the package


@pytest.fixture
def without(monkeypatch):
    """An environment without the package aspher."""

    def result(name):
        return None if name == "aspher" else find_spec(name)

    monkeypatch.setattr(method_names, "find_spec", result)
    monkeypatch.setitem(sys.modules, "aspher", None)


@pytest.fixture
def within(monkeypatch):
    """An environment that seems to have the package, which cannot be imported."""
    monkeypatch.setattr(method_names, "find_spec", lambda name: object())


def test_no_other_method_needs_a_package(without):
    lacking = {name: method_names.missing(name) for name in method_names.names()}
    assert {name for name, reason in lacking.items() if reason} == {"aspher"}
    assert "the package aspher" in lacking["aspher"]
    assert method_names.method_named("aspher").requires == "aspher"


def test_without_the_package_its_name_is_good_and_its_runs_are_refused(without):
    method_names.check("aspher")
    assert "aspher" in configured({"methods": ["shipped", "aspher"]}).accuracy.methods
    with pytest.raises(ValueError, match="needs the package aspher"):
        microslip.solve("transverse", 0.5, 3.0, model="cartesian", cells=8, method="aspher")
    where = {"poisson": 0.0, "model": "cartesian", "cells": 8, "angles": 1}
    with pytest.raises(ValueError, match="the package aspher"):
        trial.run_trial("transverse", 0.5, 3.0, **where, method="aspher", steps=8, tolerance=1e-3)


def asked(names):
    study = configured({"methods": names}).accuracy
    return [
        canonical.canonical_json(request)
        for point in study.points.values()
        for _, request in accuracy.trials(study, point)
    ]


def test_nothing_is_asked_without_the_package(without):
    assert requests.models_for("aspher", "transverse", 0.0) == []
    assert asked(["shipped", "aspher"]) == asked(["shipped"])


def test_squares_are_asked_with_the_package(within):
    more = set(asked(["shipped", "aspher"])) - set(asked(["shipped"]))
    assert len(more) == 3
    assert all('"model":"cartesian"' in text and '"transverse"' in text for text in more)


@pytest.mark.parametrize("poisson", [0.0, 0.5])
@pytest.mark.parametrize("motion", [name for name, one in MOTIONS.items() if not fields(one)])
def test_it_applies_where_it_is_asked(motion, poisson, within):
    models = [m for m in MODELS if not trial.applies(motion, poisson, m, "aspher")]
    assert requests.models_for("aspher", motion, poisson) == models
    # the slider has no rotations either
    assert bool(models) == ("slider" in requests.models_of(motion, 0.0))


def test_rotation_is_refused(within):
    where = {"poisson": 0.0, "model": "cartesian", "cells": 8, "angles": 1, "steps": 8}
    with pytest.raises(ValueError, match="translations"):
        trial.run_trial("bore", 0.1, 1.0, **where, method="aspher", tolerance=1e-3)


# The march, with a stand-in for the package


class Spring:
    """A spring of stiffness 1.5 that slips at force 1; steps with a number in `bad` fail."""

    unknowns, loaded, grading = 2, True, None

    def __init__(self, cells, poisson, bad=()):
        self.solves = self.iterations = self.failed = 0
        self.at, self.q, self.bad, self.targets = np.zeros(2), np.zeros(2), set(bad), []

    def step(self, *target):
        self.targets.append(target)
        trial = self.q + 1.5 * (np.array(target) - self.at)
        self.q, self.at = trial / max(1.0, np.hypot(*trial)), np.array(target)
        self.failed += self.solves in self.bad
        self.solves += 1
        return float(self.q[0]), 0.0


def marched(monkeypatch, tolerance, velocity=0.5, amplitude=1.0, steps=16, **settings):
    used = []

    def build(cells, poisson):
        used.append(Spring(cells, poisson, **settings))
        return used[-1]

    monkeypatch.setattr(aspher, "Solver", build)
    motion = Problem(Transverse(), velocity, amplitude, 0.0)
    resolution = Resolution(8, 1, steps)
    return aspher.METHOD.run(motion, "cartesian", resolution, tolerance), used[0], motion


def test_the_path_is_the_motion_itself(monkeypatch, within):
    run, solver, motion = marched(monkeypatch, 0.0)
    assert run.periods == aspher.MOST_PERIODS
    targets = np.array(solver.targets)
    phase = (targets[:, 0] / motion.velocity) - np.pi / 2  # forward displacement grows evenly
    assert (np.diff(phase) > 0).all()
    assert phase[-1] == pytest.approx((2 * aspher.MOST_PERIODS - 0.5) * np.pi)
    start = motion.displacement(-np.pi / 2)
    assert targets[:, 1] == pytest.approx(motion.displacement(phase)[1] - start[1], abs=1e-12)


def test_a_march_ends_where_two_periods_agree(monkeypatch, within):
    run, _, _ = marched(monkeypatch, 1e-3)
    assert run.converged and run.reason == ""
    assert 2 <= run.periods < aspher.MOST_PERIODS
    assert run.distance <= 1e-3


def test_an_unsolved_normal_contact_is_no_answer(monkeypatch, within):
    monkeypatch.setattr(Spring, "loaded", False)
    run, solver, _ = marched(monkeypatch, 1e-3)
    assert math.isnan(run.mu) and not run.converged
    assert "normal contact" in run.reason
    assert solver.solves == 0


def test_failed_steps_are_counted_and_no_answer(monkeypatch, within):
    run, _, _ = marched(monkeypatch, 1e-3, bad=(1, 5))
    assert not run.converged
    assert run.reason == f"2 of {run.effort.solves} steps failed"


def test_slow_motions_do_not_become_periodic(monkeypatch, within):
    run, _, _ = marched(monkeypatch, 1e-3, velocity=1e-3, amplitude=0.1)
    assert not run.converged
    assert run.reason.startswith("not periodic within 6 periods")


# With the package


def straight(distance, steps):
    def displacement(phase):
        return distance * phase, 0.0 * phase, 0.0 * phase

    return make_path(displacement, np.linspace(0.0, 1.0, steps + 1), EULER)


@needs_it
@pytest.mark.parametrize("poisson", [0.0, 0.5])
def test_its_half_space_is_ours(poisson):
    """Displacements of its tractions by its own kernel and by ours."""
    solver, contact = aspher.Solver(16, poisson), CartesianContact(16, poisson)
    solver.step(0.3, 0.1)
    q, change = (  # with the first component along axis 1
        np.swapaxes(array.reshape(2, 16, 16), 1, 2)
        for array in (solver._solver.q, solver._solver.u_t)
    )
    assert np.abs(q).max() > 0.1
    assert change == pytest.approx(contact.displacement(q), abs=1e-12)


@needs_it
def test_one_direction_is_cattaneo_and_mindlin():
    """F/(mu F_z) = 1 - (1 - u/u_lim)^(3/2), and the force of our squares."""
    cells, path = 24, straight(1.2, 12)
    solver = aspher.Solver(cells, 0.0)
    assert solver.bound.sum() * solver.size**2 == pytest.approx(1.0, abs=1e-6)
    result, residuals = np.transpose([solver.step(*to) for to in path.positions[1:, :2]])
    ours = CartesianContact(cells).march(path, np.zeros((2, cells, cells)), 1e-9).forces[1:, 0]
    assert solver.failed == 0
    assert residuals.max() < 1e-3
    left = np.maximum(1.0 - path.positions[1:, 0], 0.0)
    assert result == pytest.approx(1.0 - left**1.5, abs=2e-3)
    assert result == pytest.approx(ours, abs=3e-3)


def trial_at(method, velocity, amplitude, steps, tolerance):
    where = {"poisson": 0.0, "model": "cartesian", "cells": 12, "angles": 1}
    point = "transverse", velocity, amplitude
    return trial.run_trial(*point, **where, method=method, steps=steps, tolerance=tolerance)


@needs_it
@pytest.mark.parametrize(("velocity", "amplitude", "within"), [(0.05, 0.1, 1e-3), (0.1, 0.5, 1e-2)])
def test_means_agree_with_ours_on_the_same_squares_and_steps(velocity, amplitude, within):
    """The means differ by the discrete normal contact of the package and the residual of its steps.

    The residual is very small if the direction of slip hardly changes.
    """
    theirs = trial_at("aspher", velocity, amplitude, 24, 1e-3)
    ours = trial_at("euler", velocity, amplitude, 24, 1e-5)
    assert within < 0.3 * (1.0 - ours["mu_macro"])  # smaller than the effect of the vibration
    assert theirs["mu_macro"] == pytest.approx(ours["mu_macro"], abs=within)
    assert theirs["converged"] == (theirs["reason"] == "")
    assert theirs["unknowns"] == ours["unknowns"] == 2 * 12**2
    assert theirs["effort"] == theirs["iterations"] * theirs["unknowns"] > 0


@needs_it
def test_failed_steps_make_a_trial_fail(monkeypatch):
    """With a limit that no step can meet, every step has failed."""
    monkeypatch.setattr(aspher, "ACCEPTED", -1.0)
    result = trial_at("aspher", 0.5, 0.05, 8, 1e-2)
    assert not result["converged"]
    assert result["reason"].startswith(f"{result['solves']} of {result['solves']} steps failed")
    assert math.isfinite(result["mu_macro"])
