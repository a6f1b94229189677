"""Rounds of certified maps, and what a sweep may say under `adaptive`."""

import numpy as np
import pytest

from microslip.config import load
from microslip.config.records import ConfigError
from microslip.sweeps import map_rounds
from microslip.sweeps.batches import key_of
from microslip.sweeps.sealed_files import CacheError

GIVEN = {"velocity": [0.01, 1], "amplitude": [0, 2], "adaptive": {"error": 0.02}}


def configured(**given):
    return load.from_mapping({"sweeps": {"transverse": GIVEN | given}})


def test_rounds_ask_for_points_of_the_sweep_until_all_is_answered():
    (map_,) = configured().certified.values()
    first = map_rounds.next_round(map_, {}, 50)
    # slow and fast ones, two patches of 5 x 5 nodes each, share those on the border between them
    assert len(first["nodes"]) == len(first["requests"]) == 45 + 45
    assert first["parts"] == 4
    assert [map_rounds.next_round(map_, {}, size)["parts"] for size in (10, 600)] == [9, 1]
    parts = [map_rounds.part_of(first, part) for part in range(4)]
    assert sorted(map(key_of, sum(parts, []))) == sorted(map(key_of, first["requests"]))
    assert {request["tolerance"] for request in first["requests"]} == {"0.006"}
    records = [
        {"key": key_of(r), "result": {"mu_macro": 0.5, "mu_macro_error": 0.0, "converged": True}}
        for r in first["requests"]
    ]
    known = map_rounds.answers_in([first], records)
    assert map_rounds.next_round(map_, known, 50) == {"nodes": [], "requests": [], "parts": 0}


def test_a_point_that_did_not_converge_is_not_known():
    (map_,) = configured().certified.values()
    first = map_rounds.next_round(map_, {}, 50)
    records = [{"key": key_of(r), "result": {"converged": False}} for r in first["requests"]]
    known = map_rounds.answers_in([first], records)
    assert all(np.isnan(value) and np.isinf(error) for value, error in known.values())


def test_certified_maps_are_named_after_their_sweep_and_have_its_ranges():
    found = configured(velocity=[0, 0.01, 1]).certified
    assert list(found) == ["certified_transverse"]
    map_ = found["certified_transverse"]
    assert (map_.velocity, map_.amplitude) == ((0.01, 1.0), (0.0, 2.0))
    assert (map_.error, map_.tolerance) == (0.02, 0.006)
    assert configured(adaptive=None).certified == {}


def test_points_of_a_loose_map_are_no_looser_than_their_bends_are_judged():
    (map_,) = configured(adaptive={"error": 0.1}).certified.values()
    assert (map_.error, map_.tolerance) == (0.1, 0.01)


def test_several_poissons_ratios_are_a_third_direction():
    (map_,) = configured(poisson=[0, 0.2, 0.4]).certified.values()
    assert map_.poisson == (0.0, 0.4)
    assert map_rounds.coordinates_of(map_).directions == ("velocity", "amplitude", "poisson")
    requests = map_rounds.next_round(map_, {}, 50)["requests"]
    assert len(requests) == 90 * 3
    assert {request["poisson"] for request in requests} == {"0", "0.2", "0.4"}
    (alone,) = configured(poisson=[0.2]).certified.values()
    assert (alone.poisson, alone.settings["poisson"]) == ((), (0.2,))


def test_other_motions_and_pressures_are_certified_likewise():
    cone = GIVEN | {"motion": "bore", "pressure": "power:exponent=1", "group": "cones"}
    given = {"sweeps": {"transverse": GIVEN | {"adaptive": None}}, "extended": {"cone": cone}}
    (map_,) = load.from_mapping(given).certified.values()
    assert map_.name == "certified_cone"
    assert map_rounds.coordinates_of(map_).patches == [
        ((0.0, 0.0), (1.0, 1.0))
    ]  # no kink of it is known
    request = map_rounds.next_round(map_, {}, 50)["requests"][0]
    assert (request["motion"], request["pressure"]) == ("bore", "power:exponent=1")
    with pytest.raises(ConfigError, match="certified_cone: another result has this name"):
        load.from_mapping(given | {"extended": {"cone": cone, "certified_cone": cone}})


@pytest.mark.parametrize(
    "given, at_fault",
    [
        ({"velocity": [0.1]}, "sweeps.transverse.adaptive"),
        ({"cells": 16, "steps": 64}, "sweeps.transverse.adaptive"),
        ({"adaptive": {"error": 0.01, "tolerance": 0.01}}, "sweeps.transverse.adaptive.tolerance"),
        ({"adaptive": {"error": 0.1, "tolerance": 0.02}}, "sweeps.transverse.adaptive.tolerance"),
        ({"adaptive": {"error": 0}}, "sweeps.transverse.adaptive.error"),
        ({"adaptive": {}}, "sweeps.transverse.adaptive.error"),
    ],
)
def test_what_cannot_be_certified_is_refused(given, at_fault):
    with pytest.raises(ConfigError, match=at_fault):
        configured(**given)


def test_a_file_of_a_round_is_whole_or_refused_by_name(tmp_path):
    """A flipped bit that leaves valid JSON is found, too."""
    (map_,) = configured().certified.values()
    first = map_rounds.next_round(map_, {}, 50)
    path, content = tmp_path / "0.json", map_rounds.text_of(first)
    path.write_bytes(content)
    assert map_rounds.read_round(path) == first
    assert map_rounds.why_not_whole(path) == ""
    other_node = content.replace(b"0.5", b"0.4", 1)
    assert other_node != content
    for damaged in (other_node, content[:-1], content[: len(content) // 2], b"", b"[]", b"\xff"):
        path.write_bytes(damaged)
        assert map_rounds.why_not_whole(path) == "it is damaged"
        with pytest.raises(CacheError, match="0.json is damaged; run again"):
            map_rounds.read_round(path)
    path.unlink()
    with pytest.raises(CacheError, match="cannot read .*0.json"):
        map_rounds.read_round(path)
