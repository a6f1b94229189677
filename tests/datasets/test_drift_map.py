"""Certified maps of drift: configuration, requests, and velocity under a force."""

import numpy as np
import pytest
import xarray as xr
from stubs import certified_stub

import microslip
from microslip.config import load
from microslip.config.records import ConfigError
from microslip.datasets import certified_map
from microslip.datasets.query.accessor import Friction
from microslip.datasets.query.drift import STATES, Drift
from microslip.foundation.errors import InputError
from microslip.theory.drift_threshold import threshold

ERROR = 5e-3
DRIFT = certified_stub.DRIFT | {"adaptive": {"error": ERROR}}


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    """A map of an invented drift, read from a file."""
    map_ = certified_stub.drifting(adaptive={"error": ERROR})
    return certified_stub.reopened(map_, tmp_path_factory.mktemp("drift"))


def configured(**settings):
    drives = {"weights": DRIFT | settings}
    return load.from_mapping({"sweeps": certified_stub.PAPER, "drives": drives})


def test_answers_are_within_their_errors_and_these_within_what_was_asked(dataset):
    rng = np.random.default_rng(8)
    places = [rng.uniform(0.0, largest, 2000) for largest in (0.95, 3.0)]
    answer = dataset.microslip.at(*(xr.DataArray(place, dims="n") for place in places))
    exact = xr.DataArray(certified_stub.drift(*places), dims="n")
    covered = abs(answer.velocity - exact) <= answer.velocity_error
    assert float(covered.mean()) >= 0.999
    assert bool((answer.velocity_error <= 1.01 * ERROR * np.sqrt(1 + answer.velocity**2)).all())
    moves = answer.state.values == STATES.index("drifts")
    assert 0.5 < moves.mean() < 0.95
    assert np.array_equal(moves, exact.values > 0.0)


def test_below_the_threshold_a_contact_stays_and_from_1_on_it_runs_away(dataset):
    least = float(threshold("transverse", 0.5))
    answer = dataset.microslip.at([0.0, 0.99 * least, least, 1.01 * least, 1.0, 2.0], 0.5)
    states = [STATES[code] for code in answer.state.values]
    assert states == ["stays", "stays", "undecided", "drifts", "runs away", "runs away"]
    assert not answer.velocity.values[:2].any() and not answer.velocity_error.values[:2].any()
    assert np.isinf(answer.velocity.values[4:]).all()
    assert answer.threshold.values == pytest.approx(least)
    still = dataset.microslip.at([0.0, 0.5, 0.99], 0.0)  # without oscillation the threshold is 1
    assert set(still.state.values) == {STATES.index("stays")}
    # where the threshold is 0, the force 0 moves nothing
    assert STATES[int(dataset.microslip.at(0.0, 2.0).state)] == "stays"


def test_what_drifts_beyond_the_map_is_refused(dataset):
    with pytest.raises(InputError, match="force = 0.97: allowed is 0 to 0.95"):
        dataset.microslip.at(0.97, 1.0)
    with pytest.raises(InputError, match="amplitude = 4.0: allowed is 0 to 3"):
        dataset.microslip.at(0.5, 4.0)
    with pytest.raises(InputError, match="force = -0.5: allowed is a finite number"):
        dataset.microslip.at(-0.5, 1.0)


def test_a_grid_answers_as_points_do(dataset):
    grid = dataset.microslip.on_grid(force=[0.2, 0.8], amplitude=[0.5, 1.0, 2.0])
    assert grid.velocity.dims == ("amplitude", "force")
    assert float(grid.velocity[1, 0]) == float(dataset.microslip.at(0.2, 1.0).velocity)


def test_each_accessor_refuses_what_is_not_its_own(dataset):
    with pytest.raises(ValueError, match="microslip.at of a certified map"):
        dataset.friction  # noqa: B018
    with pytest.raises(ValueError, match="no certified map of drift"):
        Drift(certified_stub.bore())
    assert isinstance(dataset.microslip, Drift)
    assert isinstance(certified_stub.bore().microslip, Friction)
    with pytest.raises(InputError, match="velocity_error = None: microslip.at needs it"):
        dataset.drop_vars("velocity_error").microslip.at(0.5, 1.0)


def test_a_point_that_failed_leaves_its_cell_unanswered():
    data = certified_stub.drifting(fails=lambda force, amplitude: force == 0.95 and amplitude > 2.9)
    answer = data.microslip.at(0.94, 2.99)
    assert np.isnan(answer.velocity) and np.isinf(answer.velocity_error)
    assert "1 not converged" in next(certified_map.report(data, "weights"))


def test_points_are_asked_for_by_force():
    (map_,) = configured().certified.values()
    requests = certified_stub.first_requests(map_)
    assert len(requests) == 45  # two patches of 5 x 5 nodes share the row at the amplitude 1
    assert {request["velocity"] for request in requests} == {None}
    assert {request["tolerance"] for request in requests} == {"0.0015"}
    assert max(float(request["force"]) for request in requests) == 0.95
    assert map_.name == "certified_weights" and map_.settings["force"] == 0.95


BAD = [
    ({"mass": 1}, "not allowed with mass, force; allowed: a force alone"),
    ({"force": [0.5, 1.0]}, "up to the force 1; allowed: above 0 and below 1, the force"),
    ({"amplitude": [1]}, "with two amplitudes at least"),
    ({"poisson": [0, 0.3]}, "one Poisson's ratio"),
    ({"poisson": 0.3}, "transverse under hertz at Poisson's ratio 0.3, whose threshold"),
    ({"pressure": "punch"}, "transverse under punch"),
    ({"motion": "longitudinal"}, "longitudinal under hertz"),
    ({"model": "mdr"}, "not allowed with model mdr, which has another threshold"),
    ({"amplitude": [0, 0.1], "force": [0.1, 0.5]}, "move nothing; allowed: a force above"),
    ({"force": None, "velocity": [0.1, 1], "stiffness": 1}, "not allowed with stiffness"),
]


@pytest.mark.parametrize(("settings", "message"), BAD, ids=[message for _, message in BAD])
def test_what_has_no_such_map_is_refused_in_a_line(settings, message):
    settings = {name: value for name, value in (DRIFT | settings).items() if value is not None}
    with pytest.raises(ConfigError) as refused:
        load.from_mapping({"sweeps": certified_stub.PAPER, "drives": {"weights": settings}})
    line = str(refused.value)
    assert line.startswith("configuration: drives.weights.adaptive: ") and "\n" not in line
    assert message in line


@pytest.mark.long
def test_the_solver_agrees_at_places_that_no_map_has_used():
    (map_,) = configured(adaptive={"error": 3e-2}, amplitude=[0.3, 2]).certified.values()
    data = certified_stub.built(map_, certified_stub.solved)
    rng = np.random.default_rng(17)
    for amplitude in rng.uniform(0.3, 2.0, 6):
        force = rng.uniform(float(threshold("transverse", amplitude)), 0.95)
        result = microslip.solve("transverse", None, amplitude, force=force, tolerance=3e-3)
        answer = data.microslip.at(force, amplitude)
        off = abs(float(answer.velocity) - result.velocity)
        assert off <= float(answer.velocity_error) + result.velocity_error
