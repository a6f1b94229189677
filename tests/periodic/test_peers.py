"""A method that needs another package: its messages without it, and its results with it."""

import os
import sys
from importlib.util import find_spec

import pytest
from stubs.studies_stub import configured

import microslip
from microslip.answer import point
from microslip.periodic import methods
from microslip.studies import accuracy, requests

os.environ.setdefault("OMP_NUM_THREADS", "1")  # read when the package is first imported


def trial(method, tolerance, *place, cells=8, steps=8):
    where = {"poisson": 0.0, "model": "cartesian", "cells": cells, "angles": 1, "steps": steps}
    return point.run_trial(*place, **where, method=method, tolerance=tolerance)


@pytest.fixture
def without(monkeypatch):
    """An environment without the package aspher."""
    monkeypatch.setattr(methods, "find_spec", lambda name: None if name == "aspher" else name)
    monkeypatch.setitem(sys.modules, "aspher", None)


def test_without_the_package_its_name_is_good_and_its_runs_are_refused(without):
    assert [name for name in methods.names() if methods.missing(name)] == ["aspher"]
    with pytest.raises(ValueError, match="needs the package aspher"):
        microslip.solve("transverse", 0.5, 3.0, model="cartesian", cells=8, method="aspher")
    with pytest.raises(ValueError, match="the package aspher"):
        trial("aspher", 1e-3, "transverse", 0.5, 3.0)


def test_nothing_is_asked_without_the_package(without):
    assert requests.models_for("aspher", "transverse", 0.0) == []
    asked = []
    for names in (["shipped", "aspher"], ["shipped"]):
        study = configured({"methods": names}).accuracy
        points = study.points.values()
        asked.append([one for point in points for _, one in accuracy.trials(study, point)])
    assert asked[0] == asked[1]


def test_rotation_is_refused(monkeypatch):
    monkeypatch.setattr(methods, "find_spec", lambda name: name)  # seems to be installed
    with pytest.raises(ValueError, match="translations"):
        trial("aspher", 1e-3, "bore", 0.1, 1.0)


@pytest.mark.skipif(find_spec("aspher") is None, reason="the package is not installed")
@pytest.mark.parametrize(("velocity", "amplitude", "within"), [(0.05, 0.1, 1e-3), (0.1, 0.5, 1e-2)])
def test_means_agree_with_ours_on_the_same_squares_and_steps(velocity, amplitude, within):
    """The means differ by the discrete normal contact of the package and the residual of its steps.

    The residual is very small if the direction of slip hardly changes.
    """
    place, sizes = ("transverse", velocity, amplitude), {"cells": 12, "steps": 24}
    theirs = trial("aspher", 1e-3, *place, **sizes)
    ours = trial("euler", 1e-5, *place, **sizes)
    assert within < 0.3 * (1.0 - ours["mu_macro"])  # smaller than the effect of the vibration
    assert theirs["mu_macro"] == pytest.approx(ours["mu_macro"], abs=within)
    assert theirs["converged"] == (theirs["reason"] == "")
    assert theirs["unknowns"] == ours["unknowns"] == 2 * 12**2
    assert theirs["effort"] == theirs["iterations"] * theirs["unknowns"] > 0
