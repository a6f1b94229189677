"""Certified maps in the browser's language: the same answers and refusals as microslip.at."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from stubs import certified_stub
from stubs.in_node import answers, needs_node

from microslip.config import load
from microslip.datasets import certified_map
from microslip.datasets.query.answers import SOURCES
from microslip.foundation.errors import InputError
from microslip.report.explorer import certified
from microslip.sweeps.batches import key_of
from microslip.theory import masing, paper

pytestmark = [pytest.mark.slow, needs_node]
SCRIPTS = ("certified.js", "elliptic.js", "limits.js", "beyond.js")
TOLERANCE = 1e-12


def sideways(velocity, amplitude):
    return float(paper.large_amplitude_transverse(velocity, amplitude**1.5))


def boring(velocity, amplitude):
    share = amplitude / (1 + amplitude)
    return float(1 - share + share * paper.large_amplitude_bore(velocity))


def made(map_, friction, failed=None):
    """The dataset of a certified map of a made-up friction; failed: a point that is not known."""

    def answered(request):
        place = float(request["velocity"]), float(request["amplitude"])
        if map_.poisson:
            place += (float(request["poisson"]),)
        result = {"mu_macro": friction(*place), "mu_macro_error": 1e-4, "converged": True}
        if failed is not None and failed(*place):
            result = {"converged": False}
        return {"key": key_of(request), "request": request, "result": result, "versions": {}}

    return certified_map.build(map_, certified_stub.played(map_, answered))


@pytest.fixture(scope="module", params=["transverse", "bore"])
def given(request):
    """A map of a motion with limits, and its motion."""
    friction, widest = {"transverse": (sideways, 3), "bore": (boring, 5)}[request.param]
    axes = {"velocity": [0.001, 10], "amplitude": [0, widest], "adaptive": {"error": 1e-2}}
    map_ = certified_stub.configured(request.param, **axes)
    return SimpleNamespace(motion=request.param, dataset=made(map_, friction), widest=widest)


def asked(dataset, velocity, amplitude, poisson=None):
    """What the page says of points, and what microslip.at says."""
    nu = poisson or 0.0
    calls = [[float(v), float(a), nu] for v, a in zip(velocity, amplitude, strict=True)]
    said = answers(SCRIPTS, "frictionAt", certified.packed(dataset), calls)
    velocity, amplitude = (xr.DataArray(part, dims="n") for part in (velocity, amplitude))
    return said, dataset.microslip.at(velocity, amplitude, poisson=poisson)


def compare(said, truth):
    assert not [one for one in said if "refused" in one]
    for name, key in (("mu_macro", "value"), ("mu_macro_error", "error")):
        found = np.array([float(one[key]) for one in said])
        assert found == pytest.approx(truth[name].values, abs=TOLERANCE, rel=0, nan_ok=True), name
    assert [one["source"] for one in said] == [SOURCES[k] for k in truth["source"].values]


def test_answers_on_the_map_are_those_of_friction_at(given):
    rng = np.random.default_rng(7)
    velocity = np.append(10 ** rng.uniform(-3, 1, 200), [0.001, 10, 1, 0.3, 0.1])
    amplitude = np.append(rng.uniform(0, given.widest, 200), [1, given.widest, 1, 0, 1])
    compare(*asked(given.dataset, velocity, amplitude))


def test_answers_beyond_the_map_are_those_of_friction_at(given):
    rng = np.random.default_rng(8)
    velocity, amplitude = 10 ** rng.uniform(-5, 3, 200), rng.uniform(0, 5 * given.widest, 200)
    velocity[:20] = 0.0
    said, truth = asked(given.dataset, velocity, amplitude)
    compare(said, truth)
    assert {one["source"] for one in said} == {
        "map",
        "static limit",
        "between static limit and map",
        "between map and fast sliding",
        "between map and large amplitude",
    }


@pytest.mark.parametrize("motion", ["transverse", "bore"])
def test_slow_contacts_of_any_poissons_ratio_are_answered_as_by_friction_at(motion):
    axes = {"velocity": [0.01, 1], "amplitude": [0.1, 0.9], "poisson": [0, 0.5]}
    map_ = certified_stub.configured(motion, **axes, adaptive={"error": 0.1})
    dataset = made(map_, lambda v, a, nu: (0.1 + v) / (0.1 + v + a * (1 - 0.1 * nu)))
    velocity = np.array([0.0, 0.0, 1e-4, 0.003, 0.0099, 5.0])
    said, truth = asked(dataset, velocity, np.array([0.5, 2.0, 0.5, 0.8, 0.3, 0.5]), 0.4)
    compare(said, truth)
    assert {one["source"] for one in said[:5]} == {"static limit", "between static limit and map"}


@pytest.mark.parametrize(
    ("call", "truth"),
    [
        ("largeTransverse(at, 1)", lambda at: paper.large_amplitude_transverse(at, 1.0)),
        ("staticTransverse(at, rule)", paper.static_limit_transverse),
        ("largeBore(at, 1, rule)", paper.large_amplitude_bore),
        ("staticBore(at, rule)", paper.static_limit_bore),
    ],
)
def test_limits_are_those_of_the_theory(call, truth):
    at = np.concatenate([[0, 0.5, 0.999, 1, 1.0001, 2, 300, 1e4], np.geomspace(1e-9, 50, 60)])
    said = answers(SCRIPTS, f"(rule, at) => {call}", certified.gauss_rule(), at[:, None].tolist())
    assert np.array(said, float) == pytest.approx(truth(at), abs=1e-13, rel=0)


def test_answers_below_the_smallest_amplitude_are_those_of_friction_at(given):
    axes = {"velocity": [0.01, 1], "amplitude": [0.5, 2], "adaptive": {"error": 3e-2}}
    friction = sideways if given.motion == "transverse" else boring
    dataset = made(certified_stub.configured(given.motion, **axes), friction)
    velocity = 10 ** np.random.default_rng(9).uniform(-2, 1, 50)
    said, truth = asked(dataset, velocity, np.linspace(0, 0.7, 50))
    compare(said, truth)
    assert "between map and no vibration" in {one["source"] for one in said}


def test_next_to_a_point_that_failed_nothing_is_known_to_both():
    axes = {"velocity": [0.01, 1], "amplitude": [0.2, 0.8], "adaptive": {"error": 3e-2}}
    map_ = certified_stub.configured("bore", **axes)
    dataset = made(map_, boring, failed=lambda v, a: v < 0.02 and a < 0.3)
    assert dataset.mu_macro.isnull().any()
    velocity = 10 ** np.random.default_rng(10).uniform(-2.5, 0.5, 60)
    velocity, amplitude = np.fmax(velocity, 0.01), np.linspace(0.1, 0.8, 60)
    said, truth = asked(dataset, velocity, amplitude)
    assert truth.mu_macro.isnull().any()
    compare(said, truth)


def test_both_refuse_the_same_with_the_same_words(given):
    packed = certified.packed(given.dataset)
    questions = [(-1.0, 1.0, 0.0), (1.0, -0.5, 0.0), (1.0, 1.0, 0.3), (1.0, 1.0, -0.1)]
    said = answers(SCRIPTS, "frictionAt", packed, questions)
    for (velocity, amplitude, poisson), one in zip(questions, said, strict=True):
        with pytest.raises(InputError) as error:
            given.dataset.microslip.at(velocity, amplitude, poisson=poisson)
        refused, allowed = one["refused"].split(": ", 1)
        assert refused.split(" = ")[0] == error.value.argument
        assert error.value.allowed.startswith(allowed)


def test_other_motions_are_refused_beyond_their_maps_as_by_friction_at():
    axes = {"velocity": [0.01, 1], "amplitude": [0.1, 0.9], "group": "lines"}
    axes |= {"motion": "longitudinal", "adaptive": {"error": 0.05}}
    paper_too = {"bore": {"velocity": [1], "amplitude": [1]}}
    map_ = load.from_mapping({"sweeps": paper_too, "extended": {"along": axes}}).certified
    dataset = made(*map_.values(), lambda v, a: float(masing.longitudinal(v, a)))
    compare(*asked(dataset, np.array([0.02, 0.2, 0.9]), np.array([0.15, 0.5, 0.85])))
    questions = [(2.0, 0.5), (0.0, 0.5), (0.5, 0.95)]
    packed = certified.packed(dataset)
    said = answers(SCRIPTS, "frictionAt", packed, [[*place, 0.0] for place in questions])
    for place, one in zip(questions, said, strict=True):
        with pytest.raises(ValueError) as error:
            dataset.microslip.at(*place)
        assert one["refused"] == str(error.value)


@pytest.mark.parametrize("motion", ["transverse", "bore"])
def test_maps_over_poissons_ratio_answer_as_friction_at(motion):
    friction, widest = {"transverse": (sideways, 3), "bore": (boring, 5)}[motion]
    axes = {"velocity": [0.001, 10], "amplitude": [0, widest], "poisson": [0, 0.5]}
    map_ = certified_stub.configured(motion, **axes, adaptive={"error": 3e-2})

    def changed(velocity, amplitude, poisson):
        return friction(velocity, amplitude / (1 - 0.3 * poisson))

    dataset, rng = made(map_, changed), np.random.default_rng(12)
    velocity, amplitude = 10 ** rng.uniform(-5, 2, 60), rng.uniform(0, widest, 60)
    packed = certified.packed(dataset)
    for poisson in (0.0, 0.17, 0.3, 0.5):
        places = zip(velocity.tolist(), amplitude.tolist(), strict=True)
        said = answers(SCRIPTS, "frictionAt", packed, [[*one, poisson] for one in places])
        at = (xr.DataArray(part, dims="n") for part in (velocity, amplitude))
        compare(said, dataset.microslip.at(*at, poisson=poisson))
    (apart,) = answers(SCRIPTS, "frictionAt", packed, [[1.0, 1.0, 0.6]])
    assert apart["refused"] == "poisson = 0.6: allowed is 0 to 0.5; microslip.solve computes any"


def test_cells_of_three_directions_give_back_a_polynomial_of_their_degrees():
    """Poisson's ratio as a third direction, of 3 nodes, linear over its range."""
    slow, fast, low, high = 0.1, 10.0, 1.0, 2.0

    def truth(x, y, z):
        return 0.3 + 0.1 * x**4 * z**2 - 0.2 * x * y**4 + 0.05 * y**3 * z

    borders = [(0, 1, 0, 1, 0, 0.5), (0, 1, 0, 1, 0.5, 1)]
    values = []
    for cell in borders:
        x, y, z = (np.linspace(*cell[k : k + 2], n) for k, n in ((0, 5), (2, 5), (4, 3)))
        values += truth(*np.meshgrid(x, y, z, indexing="ij")).ravel().tolist()
    packed = {
        "motion": "bore",
        "pressure": "hertz",
        "velocity": [slow, fast],
        "amplitude": [low, high],
        "poisson": [0.1, 0.4],
        "kink_amplitudes": [],
        "kink_velocity": [],
        "gathering": {"at_kinks": 2.0, "clear": 2.0, "spread": 2.0},
        "nodes": [5, 5, 3],
        "values": values,
        "cells": list(range(len(values))),
        "borders": np.ravel(borders).tolist(),
        "bounds": [1e-3, 2e-3],
        "has_limits": True,
    }
    x, y, z = np.random.default_rng(11).uniform(0, 1, (3, 100))
    # amplitudes are even in the logarithm of 1 + 2 A
    wide = ((1 + 2 * low) * ((1 + 2 * high) / (1 + 2 * low)) ** y - 1) / 2
    places = np.stack([slow * (fast / slow) ** x, wide, 0.1 + 0.3 * z], axis=1)
    for share, place, (value, error) in zip(
        np.stack([x, y, z], axis=1),
        places,
        answers(SCRIPTS, "inside", packed, places.tolist()),
        strict=True,
    ):
        assert value == pytest.approx(truth(*share), abs=1e-12), place
        assert error == (1e-3 if share[2] < 0.5 else 2e-3)
    (refused,) = answers(SCRIPTS, "frictionAt", packed, [[1.0, 1.5, 0.45]])
    assert (
        refused["refused"] == "poisson = 0.45: allowed is 0.1 to 0.4; microslip.solve computes any"
    )
