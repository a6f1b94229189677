"""Points and ranges of certified maps."""

import numpy as np
import pytest
from stubs import certified_stub

from microslip.config import load
from microslip.config.records import ConfigError
from microslip.sweeps import map_refinement

GIVEN = {"velocity": [0.01, 1], "amplitude": [0, 2], "adaptive": {"error": 0.02}}


def configured(**settings):
    return load.from_mapping({"sweeps": {"transverse": GIVEN | settings}})


def test_the_first_round_asks_for_points_of_the_sweep_and_is_the_last_if_all_are_equal():
    (map_,) = configured().certified.values()
    first = certified_stub.first_requests(map_)
    # 2 x 2 patches of 5 x 5 nodes, which share the nodes on their borders in amplitude
    assert len(first) == 45 + 45
    assert {request["tolerance"] for request in first} == {"0.006"}


def test_a_point_that_did_not_converge_is_not_known():
    (map_,) = configured().certified.values()
    reference, _ = map_refinement.refine(map_, lambda requests: [{"result": {}} for _ in requests])
    assert all(np.isnan(value) and np.isinf(error) for value, error in reference.values())


def test_certified_maps_are_named_after_their_sweep_and_have_its_ranges():
    result = configured(velocity=[0, 0.01, 1]).certified
    assert list(result) == ["certified_transverse"]
    map_ = result["certified_transverse"]
    assert (map_.velocity, map_.amplitude) == ((0.01, 1.0), (0.0, 2.0))
    assert (map_.error, map_.tolerance) == (0.02, 0.006)
    assert configured(adaptive=None).certified == {}


def test_points_of_a_loose_map_are_no_looser_than_their_bends_are_judged():
    (map_,) = configured(adaptive={"error": 0.1}).certified.values()
    assert (map_.error, map_.tolerance) == (0.1, 0.01)


def test_several_poissons_ratios_are_a_third_direction():
    (map_,) = configured(poisson=[0, 0.2, 0.4]).certified.values()
    assert map_.poisson == (0.0, 0.4)
    assert map_refinement.coordinates_of(map_).directions == ("velocity", "amplitude", "poisson")
    requests = certified_stub.first_requests(map_)
    assert len(requests) == 90 * 3
    assert {request["poisson"] for request in requests} == {"0", "0.2", "0.4"}
    (alone,) = configured(poisson=[0.2]).certified.values()
    assert (alone.poisson, alone.settings["poisson"]) == ((), (0.2,))


def test_other_motions_and_pressures_are_certified_likewise():
    cone = GIVEN | {"motion": "bore", "pressure": "power:exponent=1", "group": "cones"}
    settings = {"sweeps": {"transverse": GIVEN | {"adaptive": None}}, "extended": {"cone": cone}}
    (map_,) = load.from_mapping(settings).certified.values()
    assert map_.name == "certified_cone"
    # No kinks are known for this pressure.
    assert map_refinement.coordinates_of(map_).patches == [((0.0, 0.0), (1.0, 1.0))]
    request = certified_stub.first_requests(map_)[0]
    assert (request["motion"], request["pressure"]) == ("bore", "power:exponent=1")
    with pytest.raises(ConfigError, match="certified_cone: another result has this name"):
        load.from_mapping(settings | {"extended": {"cone": cone, "certified_cone": cone}})
