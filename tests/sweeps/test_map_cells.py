"""Cells of certified maps: which points are asked, and what is promised between them."""

import numpy as np
import pytest

from microslip.config import load
from microslip.config.records import ConfigError
from microslip.sweeps import map_rounds
from microslip.sweeps.batches import key_of
from microslip.sweeps.map_cells import SHARE, SMALLEST, Cell, first_cells, refined, surpluses_of
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.theory.kinks import KINKS, Kinks, kink_velocity

PLAIN = MapCoordinates((0.01, 1.0), (0.5, 2.5))
TRANSVERSE = MapCoordinates((0.001, 10.0), (0.0, 3.0), KINKS["transverse"])
BORE = MapCoordinates((0.001, 10.0), (0.0, 5.0), KINKS["bore"])


def played(coordinates, function, error):
    """A refinement with all that it asks answered by a function of velocity and amplitude, and how
    many rounds that takes."""
    known, rounds = {}, 0
    while (found := refined(coordinates, known, error)).missing:
        known |= {node: (function(*coordinates.place(*node)), 0.0) for node in found.missing}
        rounds += 1
    return found, known, rounds


# Coordinates


@pytest.mark.parametrize("coordinates", [PLAIN, TRANSVERSE, BORE])
def test_a_place_has_the_scaled_coordinates_that_it_was_asked_for(coordinates):
    columns, rows = coordinates.patches
    x, y = (
        grid.ravel() for grid in np.meshgrid(np.linspace(0, columns, 17), np.linspace(0, rows, 9))
    )
    places = np.array([coordinates.place(*node) for node in zip(x, y, strict=True)])
    back = coordinates.scaled(*places.T)
    # nine digits of an amplitude next to a border where places gather are fewer of the square root
    assert back[0] == pytest.approx(x, abs=1e-7)
    assert back[1] == pytest.approx(y, abs=1e-4)
    assert places[:, 0].min() == coordinates.velocity[0]
    assert places[:, 0].max() == coordinates.velocity[1]
    assert (places[:, 1].min(), places[:, 1].max()) == coordinates.amplitude


def test_kinks_are_borders_of_patches():
    assert PLAIN.patches == (1, 1)
    assert TRANSVERSE.patches == (2, 2)
    assert BORE.patches == (2, 1)
    assert TRANSVERSE.place(0.3, 1.0)[1] == 1.0
    assert BORE.place(1.0, 0.3)[0] == 1.0
    amplitude = TRANSVERSE.place(1.0, 1.7)[1]
    kink = kink_velocity(KINKS["transverse"], np.array(amplitude))
    assert TRANSVERSE.place(1.0, 1.7)[0] == pytest.approx(float(kink), rel=1e-8)


def test_a_kink_outside_of_the_range_cuts_nothing():
    assert MapCoordinates((2.0, 10.0), (0.0, 5.0), KINKS["bore"]).patches == (1, 1)
    assert MapCoordinates((0.1, 10.0), (1.0, 3.0), Kinks((1.0,))).patches == (1, 1)


def test_a_kink_in_part_of_the_range_stays_clear_of_its_ends():
    inside = MapCoordinates((0.1, 10.0), (0.0, 3.0), KINKS["transverse"])
    places = [inside.place(1.0, y)[0] for y in np.linspace(0, 2, 9)]
    assert min(places) == pytest.approx(0.2)  # twice the slowest, where the kink is at 0.02


def test_coordinates_survive_as_text():
    assert MapCoordinates.from_json(TRANSVERSE.to_json()) == TRANSVERSE


# Cells


def test_no_more_than_a_cell_for_each_patch_is_asked_where_that_is_enough():
    # a polynomial of the first degree in the coordinates of one patch
    found, known, rounds = played(PLAIN, lambda v, a: np.log(v) + a, 1e-6)
    assert list(found.cells) == first_cells(PLAIN)
    assert (len(known), rounds) == (25, 1)
    assert found.errors == pytest.approx([0.0], abs=1e-8)


def test_surpluses_are_differences_of_the_fourth_order():
    x = np.arange(5.0)
    # the fourth difference of x^4 at distance 1 is 4! = 24, its third ones at most 6 (4 * 2.5) = 60
    along, across = surpluses_of(np.outer(x**4, np.ones(5)))
    assert along == pytest.approx(24.0)
    assert across == 0.0
    # a cubic has no fourth differences; a quarter of its third one, 3! = 6, counts
    assert surpluses_of(np.outer(np.ones(5), x**3)) == pytest.approx((0.0, 1.5))


def test_cells_are_halved_along_the_direction_that_is_worse():
    found, _, _ = played(PLAIN, lambda v, a: np.sin(9 * np.log(v)) + a, 1e-3)
    widths = {cell.high - cell.low for cell in found.cells}
    assert widths == {1.0}
    assert len(found.cells) > 2


def test_cells_gather_where_a_function_is_not_smooth_and_cover_the_map():
    found, _, _ = played(PLAIN, lambda v, a: abs(np.log(v) - np.log(0.03)), 1e-2)
    size = {cell: cell.right - cell.left for cell in found.cells}
    at_kink = np.log(3) / np.log(100)
    nearest = min(size, key=lambda cell: abs(0.5 * (cell.left + cell.right) - at_kink))
    assert size[nearest] == min(size.values()) < max(size.values())
    area = sum((c.right - c.left) * (c.high - c.low) for c in found.cells)
    assert area == pytest.approx(1.0)


def test_what_is_promised_holds_for_a_function_with_layers():
    def function(v, a):
        return np.tanh(4 * (np.log10(v) + 1.2)) * np.exp(-a) + 1 / (1 + 8 * (a - 1.1) ** 2)

    found, known, _ = played(PLAIN, function, 3e-3)
    rng, off = np.random.default_rng(3), []
    for cell, bound in zip(found.cells, found.errors, strict=True):
        values = np.array([known[node][0] for node in cell.nodes]).reshape(5, 5)
        x, y = rng.uniform(cell.left, cell.right, 20), rng.uniform(cell.low, cell.high, 20)
        s = 4 * (x - cell.left) / (cell.right - cell.left)
        t = 4 * (y - cell.low) / (cell.high - cell.low)
        for place in zip(x, y, s, t, strict=True):
            between = [np.polyval(np.polyfit(range(5), row, 4), place[3]) for row in values]
            value = np.polyval(np.polyfit(range(5), between, 4), place[2])
            off.append(abs(value - function(*PLAIN.place(*place[:2]))) / bound)
    assert len(off) > 400
    assert np.mean(np.array(off) <= 1.0) >= 0.99
    assert max(found.errors) <= 3e-3


def test_errors_of_nodes_count():
    (cell,) = first_cells(PLAIN)
    known = {node: (0.0, 3e-3 if node == (0.5, 0.5) else 1e-3) for node in cell.nodes}
    assert refined(PLAIN, known, 1e-2).errors == (3e-3,)


def test_all_follows_from_the_answers_in_whatever_order_they_come():
    found, known, _ = played(TRANSVERSE, lambda v, a: v / (v + a), 1e-2)
    backwards = dict(reversed(known.items()))
    assert refined(TRANSVERSE, backwards, 1e-2) == found
    # a looser error needs some of these points and no others
    looser, fewer, _ = played(TRANSVERSE, lambda v, a: v / (v + a), 5e-2)
    assert fewer.keys() < known.keys()
    assert len(looser.cells) < len(found.cells)


def test_where_a_point_failed_nothing_is_promised_and_nothing_asked():
    (cell,) = first_cells(PLAIN)
    known = dict.fromkeys(cell.nodes, (1.0, 0.0)) | {(0.5, 0.25): (np.nan, np.inf)}
    found = refined(PLAIN, known, 1e-2)
    assert found.missing == ()
    assert found.errors == (np.inf,)


def test_a_jump_ends_at_the_smallest_cells():
    found, _, _ = played(PLAIN, lambda v, a: float(v > 0.0301), 1e-2)
    assert min(cell.right - cell.left for cell in found.cells) == SMALLEST
    # which say so: the fourth differences of a jump of 1 are 3 at most, the third ones 2 of 1/4
    assert max(found.errors) == pytest.approx(3 * SHARE)


def test_halves_have_the_nodes_of_the_whole():
    cell = Cell(0.0, 1.0, 1.0, 1.5)
    for along in (True, False):
        first, second = cell.halves(along)
        assert set(cell.nodes) <= {*first.nodes, *second.nodes}


# Rounds


GIVEN = {"velocity": [0.01, 1], "amplitude": [0, 2], "adaptive": {"error": 0.02}}


def configured(**given):
    return load.from_mapping({"sweeps": {"transverse": GIVEN | given}})


def test_rounds_ask_for_points_of_the_sweep_until_all_is_answered():
    (map_,) = configured().certified.values()
    first = map_rounds.next_round(map_, {}, 50)
    # 2 x 2 patches of 5 x 5 nodes share those on their borders: 9 x 9
    assert len(first["nodes"]) == len(first["requests"]) == 81
    assert first["parts"] == 4
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


def test_other_motions_and_pressures_are_certified_likewise():
    cone = GIVEN | {"scene": "longitudinal", "pressure": "power:exponent=1", "group": "cones"}
    given = {"sweeps": {"transverse": GIVEN | {"adaptive": None}}, "extended": {"cone": cone}}
    (map_,) = load.from_mapping(given).certified.values()
    assert map_.name == "certified_cone"
    assert map_rounds.coordinates_of(map_).patches == (1, 1)  # no kink of it is known
    request = map_rounds.next_round(map_, {}, 50)["requests"][0]
    assert (request["scene"], request["pressure"]) == ("longitudinal", "power:exponent=1")
    with pytest.raises(ConfigError, match="certified_cone: another result has this name"):
        load.from_mapping(given | {"extended": {"cone": cone, "certified_cone": cone}})


@pytest.mark.parametrize(
    "given, at_fault",
    [
        ({"velocity": [0.1]}, "sweeps.transverse.adaptive"),
        ({"poisson": [0, 0.3]}, "sweeps.transverse.adaptive"),
        ({"cells": 16, "steps": 64}, "sweeps.transverse.adaptive"),
        ({"adaptive": {"error": 0.01, "tolerance": 0.01}}, "sweeps.transverse.adaptive.tolerance"),
        ({"adaptive": {"error": 0}}, "sweeps.transverse.adaptive.error"),
        ({"adaptive": {}}, "sweeps.transverse.adaptive.error"),
    ],
)
def test_what_cannot_be_certified_is_refused(given, at_fault):
    with pytest.raises(ConfigError, match=at_fault):
        configured(**given)
