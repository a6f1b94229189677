"""Points and ranges of certified maps."""

import json

import numpy as np
import pytest
from stubs import certified_stub

from microslip.sweeps import batch, map_refinement

GIVEN = {"velocity": [0.01, 1], "amplitude": [0, 2], "error": 0.02}


def configured(motion="transverse", **settings):
    return certified_stub.configured(motion, **GIVEN | settings)


def test_the_first_round_asks_for_points_of_the_sweep_and_is_the_last_if_all_are_equal():
    first = certified_stub.first_requests(configured())
    # 2 x 2 patches of 5 x 5 nodes, which share the nodes on their borders in amplitude
    assert len(first) == 45 + 45
    assert {request["tolerance"] for request in first} == {"0.006"}


def test_a_point_that_did_not_converge_is_not_known():
    sweep = configured().sweeps["map"]
    reference, _ = map_refinement.refine(sweep, lambda requests: [{"result": {}} for _ in requests])
    assert all(np.isnan(value) and np.isinf(error) for value, error in reference.values())


def test_a_map_has_the_ranges_of_its_sweep():
    coordinates = map_refinement.coordinates_of(configured(velocity=[0, 0.01, 1]).sweeps["map"])
    assert (coordinates.velocity, coordinates.amplitude) == ((0.01, 1.0), (0.0, 2.0))


def test_points_of_a_loose_map_are_no_looser_than_their_bends_are_judged():
    sweep = configured(error=0.1).sweeps["map"]
    assert (sweep.error, sweep.tolerance) == (0.1, 0.01)


def test_several_poissons_ratios_are_a_third_direction():
    map_ = configured(poisson=[0, 0.2, 0.4])
    coordinates = map_refinement.coordinates_of(map_.sweeps["map"])
    assert coordinates.poisson == (0.0, 0.4)
    assert coordinates.directions == ("velocity", "amplitude", "poisson")
    requests = certified_stub.first_requests(map_)
    assert len(requests) == 90 * 3
    assert {request["poisson"] for request in requests} == {"0", "0.2", "0.4"}
    alone = configured(poisson=[0.2])
    assert map_refinement.coordinates_of(alone.sweeps["map"]).poisson == ()
    assert {request["poisson"] for request in certified_stub.first_requests(alone)} == {"0.2"}


def test_other_motions_and_pressures_are_certified_likewise():
    map_ = configured("bore", pressure="power:exponent=1")
    # No kinks are known for this pressure.
    patches = map_refinement.coordinates_of(map_.sweeps["map"]).patches
    assert patches == [((0.0, 0.0), (1.0, 1.0))]
    request = certified_stub.first_requests(map_)[0]
    assert (request["motion"], request["pressure"]) == ("bore", "power:exponent=1")


@pytest.mark.slow
def test_points_of_a_map_are_solved_once_and_continue_from_a_journal(tmp_path):
    """The rigid model, whose points are cheap."""
    sweep = configured(model="rigid").sweeps["map"]
    first = map_refinement.solve_points(sweep, tmp_path / "a.jsonl", 2)
    assert first["points"] == first["computed"] > 80
    whole = (tmp_path / "a.jsonl").read_bytes()
    lines = whole.splitlines(keepends=True)
    (tmp_path / "a.jsonl").unlink()
    (tmp_path / "x.journal").write_bytes(b"".join(lines[1:-5]) + lines[-2][:50])
    again = map_refinement.solve_points(sweep, tmp_path / "a.jsonl", 2)
    assert (again["points"], again["computed"]) == (first["points"], 4)
    assert (tmp_path / "a.jsonl").read_bytes() == whole
    looser = configured(model="rigid", error=0.1, tolerance=sweep.tolerance).sweeps["map"]
    assert map_refinement.solve_points(looser, tmp_path / "b.jsonl", 2)["computed"] == 0
    assert json.loads(lines[0])["rows"]
    assert {r["key"] for r in batch.read(tmp_path / "b.jsonl")} <= {
        r["key"] for r in batch.read(tmp_path / "a.jsonl")
    }
