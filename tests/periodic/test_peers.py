"""Methods that need another package: their messages without it, and their results with it."""

import os
import sys
from importlib.util import find_spec

import pytest
from stubs.studies_stub import configured

import microslip
from microslip.answer import point as trial
from microslip.foundation import canonical
from microslip.periodic import methods
from microslip.studies import accuracy, requests

os.environ.setdefault("OMP_NUM_THREADS", "1")  # read when the package is first imported
needs_it = pytest.mark.skipif(find_spec("aspher") is None, reason="the package is not installed")


# Without the package


@pytest.fixture
def without(monkeypatch):
    """An environment without the package aspher."""

    def result(name):
        return None if name == "aspher" else find_spec(name)

    monkeypatch.setattr(methods, "find_spec", result)
    monkeypatch.setitem(sys.modules, "aspher", None)


@pytest.fixture
def within(monkeypatch):
    """An environment that seems to have the package, which cannot be imported."""
    monkeypatch.setattr(methods, "find_spec", lambda name: object())


def test_no_other_method_needs_a_package(without):
    lacking = {name: methods.missing(name) for name in methods.names()}
    assert {name for name, reason in lacking.items() if reason} == {"aspher"}
    assert "the package aspher" in lacking["aspher"]
    assert methods.method_named("aspher").requires == "aspher"


def test_without_the_package_its_name_is_good_and_its_runs_are_refused(without):
    methods.split("aspher")
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


def test_rotation_is_refused(within):
    where = {"poisson": 0.0, "model": "cartesian", "cells": 8, "angles": 1, "steps": 8}
    with pytest.raises(ValueError, match="translations"):
        trial.run_trial("bore", 0.1, 1.0, **where, method="aspher", tolerance=1e-3)


# The march, with a stand-in for the package


# With the package


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
