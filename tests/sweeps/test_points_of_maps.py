"""Certified maps: scaled coordinates, refinement, error bounds, and the points of a sweep."""

from itertools import product

import numpy as np
import pytest
from stubs import certified_stub

from microslip.sweeps import batch, map_refinement
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.sweeps.map_refinement import (
    RESOLVED,
    SHARE,
    SMALLEST,
    nodes_of,
    refine_cells,
)
from microslip.theory.exact import Kinks, kink_velocity, kinks_of

PLAIN = MapCoordinates((0.01, 1.0), (0.5, 2.5))
TRANSVERSE = MapCoordinates((0.001, 10.0), (0.0, 3.0), kinks_of("transverse"))
BORE = MapCoordinates((0.001, 10.0), (0.0, 5.0), kinks_of("bore"))
DEEP = MapCoordinates((0.001, 10.0), (0.0, 3.0), kinks_of("transverse"), (0.1, 0.5))
STATIC = MapCoordinates((), (0.5, 3.0), kinks_of("transverse"), (0.0, 0.5))
ALL = [PLAIN, TRANSVERSE, BORE, DEEP, STATIC]


def played(coordinates, function, error):
    """Refine a map of a function of its axes; return the result and the answers."""
    answers = {}
    while (result := refine_cells(coordinates, answers, error)).missing:
        answers |= {node: (function(*coordinates.place(node)), 0.0) for node in result.missing}
    return result, answers


def widths(result, direction):
    return {end[direction] - begin[direction] for begin, end in result.cells}


# Coordinates


@pytest.mark.parametrize("coordinates", ALL)
def test_scaled_coordinates_are_the_inverse_of_places(coordinates):
    # positions in patches, without their ends in velocity, where two patches meet
    inner, whole = np.linspace(0, 1, 17)[1:-1], np.linspace(0, 1, 9)
    shares = [inner if name == "velocity" else whole for name in coordinates.directions]
    shares = np.array(list(product(*shares)))
    nodes = [begin + shares * np.subtract(end, begin) for begin, end in coordinates.patches]
    nodes = np.concatenate(nodes)
    places = np.array([coordinates.place(tuple(node)) for node in nodes])
    # near a border the square root amplifies the rounding of amplitudes to nine digits
    assert coordinates.scaled(*places.T) == pytest.approx(nodes, abs=1e-4)
    ends = coordinates.patches[0][0], coordinates.patches[-1][1]
    if coordinates.velocity:
        assert tuple(coordinates.place(end)[0] for end in ends) == coordinates.velocity
    for name, values in zip(coordinates.directions, places.T, strict=True):
        low, high = getattr(coordinates, name)
        if name != "velocity":
            assert (values.min(), values.max()) == (low, high)
    assert MapCoordinates.from_json(coordinates.to_json()) == coordinates


def test_kinks_are_borders_of_patches():
    slow = ((0.0, 0.0), (1.0, 1.0))
    fast = [((2.0, 0.0), (2.5, 1.0)), ((2.5, 0.0), (3.0, 1.0))]
    assert PLAIN.patches == [slow]
    assert TRANSVERSE.patches == [slow, ((0.0, 1.0), (1.0, 2.0)), *fast]
    assert BORE.patches == [slow, *fast]
    assert DEEP.patches[2] == ((2.0, 0.0, 0.0), (2.5, 1.0, 1.0))
    assert STATIC.patches == [((0.0, 0.0), (1.0, 1.0)), ((1.0, 0.0), (2.0, 1.0))]
    assert TRANSVERSE.place((0.3, 1.0))[1] == 1.0
    assert BORE.place((1.0, 0.3))[0] == BORE.place((2.0, 0.3))[0] == 1.0
    for node in ((1.0, 1.7), (2.0, 0.7)):
        velocity, amplitude = TRANSVERSE.place(node)
        kink = kink_velocity(kinks_of("transverse"), np.array(amplitude))
        assert velocity == pytest.approx(float(kink), rel=1e-8)


def test_kinks_outside_the_range_divide_nothing_and_others_stay_clear_of_its_ends():
    assert MapCoordinates((2.0, 10.0), (0.0, 5.0), kinks_of("bore")).patches == PLAIN.patches
    assert MapCoordinates((0.1, 10.0), (1.0, 3.0), Kinks((1.0,))).patches == PLAIN.patches
    inside = MapCoordinates((0.1, 10.0), (0.0, 3.0), kinks_of("transverse"))
    places = [inside.place((1.0, y))[0] for y in np.linspace(0, 2, 9)]
    assert min(places) == pytest.approx(0.2)  # twice the smallest velocity; the kink is at 0.002


# Cells


def test_cells_are_halved_along_the_worst_direction():
    result, _ = played(PLAIN, lambda v, a: np.sin(9 * np.log(v)) + np.log(1 + 2 * a), 1e-3)
    assert widths(result, 1) == {1.0} and len(result.cells) > 2
    deep = PLAIN._replace(poisson=(0.0, 0.5))
    result, _ = played(deep, lambda v, a, nu: 0.1 * np.sin(12 * nu) + a, 3e-3)
    assert widths(result, 0) == widths(result, 1) == {1.0} and len(result.cells) > 1


def test_the_error_bound_covers_a_function_with_layers():
    def function(v, a):
        return np.tanh(4 * (np.log10(v) + 1.2)) * np.exp(-a) + 1 / (1 + 8 * (a - 1.1) ** 2)

    result, answers = played(PLAIN, function, 3e-3)
    rng, off = np.random.default_rng(3), []
    for cell, bound in zip(result.cells, result.errors, strict=True):
        values = np.array([answers[node][0] for node in nodes_of(cell, (4, 4))]).reshape(5, 5)
        for node in rng.uniform(*cell, (20, 2)):
            s, t = 4 * (node - cell[0]) / np.subtract(*cell[::-1])
            between = [np.polyval(np.polyfit(range(5), row, 4), t) for row in values]
            value = np.polyval(np.polyfit(range(5), between, 4), s)
            off.append(abs(value - function(*PLAIN.place(tuple(node)))) / bound)
    assert len(off) > 400
    assert np.mean(np.array(off) <= 1.0) >= 0.99
    assert max(result.errors) <= 3e-3


def test_a_large_surplus_is_halved_however_loose_the_error():
    # The fourth difference of x^4 over steps of 1/4 is 4! / 4^4 = 3/32; in halves it is 1/16 of it.
    result, _ = played(PLAIN, lambda v, a: 0.6 * (np.log(v / 0.01) / np.log(100)) ** 4, 0.1)
    assert 0.6 * 3 / 32 > RESOLVED > 0.6 * 3 / 32 / 16
    assert widths(result, 0) == {0.5}


def test_errors_of_nodes_count_and_a_failed_node_has_no_bound():
    nodes = nodes_of(PLAIN.patches[0], (4, 4))
    answers = {node: (0.0, 3e-3 if node == (0.5, 0.5) else 1e-3) for node in nodes}
    assert refine_cells(PLAIN, answers, 1e-2).errors == (3e-3,)
    result = refine_cells(PLAIN, answers | {(0.5, 0.25): (np.nan, np.inf)}, 1e-2)
    assert (result.missing, result.errors) == ((), (np.inf,))


def test_cells_depend_on_the_answers_only():
    result, answers = played(TRANSVERSE, lambda v, a: v / (v + a), 3e-3)
    assert refine_cells(TRANSVERSE, dict(reversed(answers.items())), 3e-3) == result
    # a larger error needs a subset of these points
    looser, fewer = played(TRANSVERSE, lambda v, a: v / (v + a), 1e-2)
    assert fewer.keys() < answers.keys()
    assert len(looser.cells) < len(result.cells)


def test_a_jump_ends_at_the_smallest_cells():
    result, _ = played(PLAIN, lambda v, a: float(v > 0.0301), 1e-2)
    assert min(widths(result, 0)) == SMALLEST
    # the fourth differences of a jump of 1 are at most 3
    assert max(result.errors) == pytest.approx(3 * SHARE)


# Points of a sweep


def configured(motion="transverse", **settings):
    axes = {"velocity": [0.01, 1], "amplitude": [0, 2], "error": 0.02}
    return certified_stub.configured(motion, **axes | settings)


def test_the_points_of_a_map_are_those_of_its_sweep():
    first = certified_stub.first_requests(configured())
    # 2 x 2 patches of 5 x 5 nodes, which share the nodes on their borders in amplitude
    assert len(first) == 45 + 45
    assert {request["tolerance"] for request in first} == {"0.006"}
    sweep = configured(velocity=[0, 0.01, 1], error=0.1).sweeps["map"]
    coordinates = map_refinement.coordinates_of(sweep)
    assert (coordinates.velocity, coordinates.amplitude) == ((0.01, 1.0), (0.0, 2.0))
    assert sweep.tolerance == 0.01


def test_several_poissons_ratios_are_a_third_direction():
    map_ = configured(poisson=[0, 0.2, 0.4])
    assert map_refinement.coordinates_of(map_.sweeps["map"]).poisson == (0.0, 0.4)
    requests = certified_stub.first_requests(map_)
    assert len(requests) == 90 * 3
    assert {request["poisson"] for request in requests} == {"0", "0.2", "0.4"}


def test_without_known_kinks_a_map_is_one_patch():
    map_ = configured("bore", pressure="power:exponent=1")
    patches = map_refinement.coordinates_of(map_.sweeps["map"]).patches
    assert patches == [((0.0, 0.0), (1.0, 1.0))]


def test_a_point_that_did_not_converge_is_unknown():
    sweep = configured().sweeps["map"]
    result = {"mu_macro": 0.5, "mu_macro_error": 1e-3, "converged": False}
    answers, _ = map_refinement.refine(sweep, lambda asked: [{"result": result}] * len(asked))
    assert all(np.isnan(value) and np.isinf(error) for value, error in answers.values())


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
    keys = [{r["key"] for r in batch.read(tmp_path / f"{name}.jsonl")} for name in "ab"]
    assert keys[1] <= keys[0]
