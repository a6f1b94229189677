"""Certified maps in JavaScript: answers and refusals equal those of microslip.at."""

import numpy as np
import pytest
import xarray as xr
from stubs import certified_stub
from stubs.in_node import answers, needs_node

from microslip.foundation.errors import InputError
from microslip.report.explorer import certified
from microslip.theory import masing, paper

pytestmark = [pytest.mark.slow, needs_node]
SCRIPTS = ("certified.js", "elliptic.js", "limits.js", "beyond.js")
TOLERANCE = 1e-12


def sideways(velocity, amplitude):
    return float(paper.large_amplitude_transverse(velocity, amplitude**1.5))


def boring(velocity, amplitude):
    share = amplitude / (1 + amplitude)
    return float(1 - share + share * paper.large_amplitude_bore(velocity))


FRICTION = {"transverse": sideways, "bore": boring}


def made(map_, friction, failed=None):
    """The dataset of a certified map with a made-up friction.

    friction, failed: functions of velocity, amplitude and, if the map has several, Poisson's
    ratio; `failed` is true at unconverged points.
    """

    def answered(request):
        place = float(request["velocity"]), float(request["amplitude"])
        if len(map_.sweeps["map"].poisson) > 1:
            place += (float(request["poisson"]),)
        is_known = failed is None or not failed(*place)
        return certified_stub.record(request, friction(*place) if is_known else None)

    return certified_stub.built(map_, answered)


def both_answers(dataset, velocity, amplitude, poisson=None):
    """The answers of the page and of microslip.at at points."""
    places = np.column_stack((velocity, amplitude, np.full(len(velocity), poisson or 0.0)))
    page_answers = answers(SCRIPTS, "frictionAt", certified.packed(dataset), places.tolist())
    velocity, amplitude = (xr.DataArray(part, dims="n") for part in (velocity, amplitude))
    return page_answers, dataset.microslip.at(velocity, amplitude, poisson=poisson)


def compare(page_answers, truth):
    assert not [one for one in page_answers if "refused" in one]
    for name, key in (("mu_macro", "value"), ("mu_macro_error", "error")):
        values = np.array([float(one[key]) for one in page_answers])
        assert values == pytest.approx(truth[name].values, abs=TOLERANCE, rel=0, nan_ok=True), name
    assert {one["source"] for one in page_answers} == {"map"}


@pytest.mark.parametrize("motion", ["transverse", "bore"])
def test_answers_on_a_map_are_those_of_at(motion):
    axes = {"velocity": [0.001, 10], "amplitude": [0, 3], "error": 1e-2}
    dataset = made(certified_stub.configured(motion, **axes), FRICTION[motion])
    rng = np.random.default_rng(7)
    velocity, amplitude = 10 ** rng.uniform(-3, 1, 200), rng.uniform(0.01, 3, 200)
    compare(*both_answers(dataset, velocity, amplitude))


@pytest.mark.parametrize("motion", ["transverse", "bore"])
def test_maps_over_poissons_ratio_answer_as_at(motion):
    axes = {"velocity": [0.001, 10], "amplitude": [0, 3], "poisson": [0, 0.5]}
    map_ = certified_stub.configured(motion, **axes, error=3e-2)
    dataset = made(map_, lambda v, a, nu: FRICTION[motion](v, a / (1 - 0.3 * nu)))
    rng = np.random.default_rng(12)
    velocity, amplitude = 10 ** rng.uniform(-3, 1, 60), rng.uniform(0.01, 3, 60)
    for poisson in (0.0, 0.17, 0.3, 0.5):
        compare(*both_answers(dataset, velocity, amplitude, poisson))
    packed = certified.packed(dataset)
    (apart,) = answers(SCRIPTS, "frictionAt", packed, [[1.0, 1.0, 0.6]])
    assert apart["refused"] == "poisson = 0.6: allowed is 0 to 0.5; microslip.solve computes any"


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
    limits = answers(SCRIPTS, f"(rule, at) => {call}", certified.gauss_rule(), at[:, None].tolist())
    assert np.array(limits, float) == pytest.approx(truth(at), abs=1e-13, rel=0)


def test_next_to_an_unconverged_point_both_answers_are_unknown():
    axes = {"velocity": [0.01, 1], "amplitude": [0.2, 0.8], "error": 3e-2}
    map_ = certified_stub.configured("bore", **axes)
    dataset = made(map_, boring, failed=lambda v, a: v < 0.02 and a < 0.3)
    velocity = 10 ** np.random.default_rng(10).uniform(-2.5, 0.5, 60)
    page_answers, truth = both_answers(dataset, np.fmax(velocity, 0.01), np.linspace(0.1, 0.8, 60))
    assert truth.mu_macro.isnull().any()
    compare(page_answers, truth)


def test_bad_arguments_are_refused_in_the_words_of_at():
    axes = {"velocity": [0.01, 1], "amplitude": [0, 1], "error": 0.05}
    dataset = made(certified_stub.configured("transverse", **axes), sideways)
    questions = [(-1.0, 1.0, 0.0), (1.0, -0.5, 0.0), (1.0, 1.0, 0.3), (1.0, 1.0, -0.1)]
    page_answers = answers(SCRIPTS, "frictionAt", certified.packed(dataset), questions)
    for (velocity, amplitude, poisson), one in zip(questions, page_answers, strict=True):
        with pytest.raises(InputError) as error:
            dataset.microslip.at(velocity, amplitude, poisson=poisson)
        refused, allowed = one["refused"].split(": ", 1)
        assert refused.split(" = ")[0] == error.value.argument
        assert error.value.allowed.startswith(allowed)


def test_a_motion_without_limits_is_refused_outside_its_map_in_the_words_of_at():
    axes = {"velocity": [0.01, 1], "amplitude": [0.1, 0.9], "error": 0.05}
    map_ = certified_stub.configured("longitudinal", **axes)
    dataset = made(map_, lambda v, a: float(masing.longitudinal(v, a)))
    compare(*both_answers(dataset, np.array([0.02, 0.2, 0.9]), np.array([0.15, 0.5, 0.85])))
    questions = [(2.0, 0.5), (0.0, 0.5), (0.5, 0.95)]
    packed = certified.packed(dataset)
    page_answers = answers(SCRIPTS, "frictionAt", packed, [[*place, 0.0] for place in questions])
    for place, one in zip(questions, page_answers, strict=True):
        with pytest.raises(ValueError) as error:
            dataset.microslip.at(*place)
        assert one["refused"] == str(error.value)
