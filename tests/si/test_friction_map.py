"""Predictions from a certified map equal those of the solver within both errors."""

import numpy as np
import pytest
from stubs import certified_stub

import microslip
from microslip.foundation.errors import InputError

CONTACT = {"young": "210 GPa", "nu": 0, "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}
POINT = CONTACT | {"load": "10 N", "speed": "10 mm/s", "amplitude": "0.3 um", "tolerance": 0.05}
ERROR = 2e-2


@pytest.fixture(scope="module")
def friction():
    axes = {"velocity": [0.05, 1], "amplitude": [0, 3], "error": ERROR}
    map_ = certified_stub.configured("transverse", **axes)
    return certified_stub.built(map_, certified_stub.solved)


@pytest.mark.long
def test_a_map_answers_within_its_error(friction):
    ranges = {"speed": "2..20 mm/s, 4", "amplitude": "0.1..0.5 um, 4"}
    by_map = microslip.predict_grid("transverse", **POINT | ranges, map=friction)
    solved = microslip.predict_grid("transverse", **POINT | ranges | {"tolerance": 1e-3})
    assert set(by_map.model.values.flat) == {"map"} and bool(by_map.converged.all())
    miss = np.abs(by_map.friction_force_N - solved.friction_force_N)
    assert np.all(miss <= by_map.friction_force_error_N + solved.friction_force_error_N)
    assert float(by_map.mu_macro_error.max()) > 1e-3  # so that the errors are those of the map
    at = friction.microslip.at(float(by_map.velocity[1, 2]), float(by_map.amplitude[1, 2]))
    assert float(by_map.mu_macro[1, 2]) == float(at.mu_macro)
    assert float(by_map.mu_macro_error[1, 2]) == float(at.mu_macro_error)


@pytest.mark.long
def test_a_search_uses_the_map_and_a_static_limit_outside_it_is_unknown(friction):
    alone = microslip.predict("transverse", **POINT | {"amplitude": "0.1 um"}, map=friction)
    assert np.isnan(alone.mu_static) and "the range of the map" in alone.mu_static_reason
    assert not alone.remarks
    search = POINT | {"amplitude": None, "reduction": "40 %"}
    by_map = microslip.predict("transverse", **search, map=friction)
    solved = microslip.predict("transverse", **search | {"tolerance": 1e-3})
    miss = abs(by_map.amplitude_m - solved.amplitude_m)
    assert miss <= by_map.amplitude_error_m + solved.amplitude_error_m


@pytest.mark.long
@pytest.mark.parametrize(
    ("motion", "changes", "argument", "part"),
    [
        ("zigzag", {}, "map", "allowed is the dataset of a sweep of zigzag"),
        ("transverse", {"nu": 0.3}, "map", "nu = 0.3: allowed is 0"),
        ("transverse", {"tolerance": 1e-3}, "map", "allowed is at most 0.001"),
        ("transverse", {"amplitude": "3 um", "tolerance": 1e-2}, "map", "the range of the map"),
        ("transverse", {"speed": None, "force": "1 N"}, "force", "without a map"),
    ],
)
def test_a_map_of_something_else_is_refused(friction, motion, changes, argument, part):
    with pytest.raises(InputError, match=part) as error:
        microslip.predict(motion, **{"map": friction} | POINT | changes)
    assert error.value.argument == argument
