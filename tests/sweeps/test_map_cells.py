"""Cells of certified maps: scaled coordinates, refinement and error bounds."""

from itertools import product

import numpy as np
import pytest

from microslip.sweeps.map_cells import (
    LOWER_ORDER,
    RESOLVED,
    SHARE,
    SMALLEST,
    Cell,
    first_cells,
    refine_cells,
    surpluses_of,
)
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.theory.kinks import Kinks, kink_velocity, kinks_of

PLAIN = MapCoordinates((0.01, 1.0), (0.5, 2.5))
TRANSVERSE = MapCoordinates((0.001, 10.0), (0.0, 3.0), kinks_of("transverse"))
BORE = MapCoordinates((0.001, 10.0), (0.0, 5.0), kinks_of("bore"))
DEEP = MapCoordinates((0.001, 10.0), (0.0, 3.0), kinks_of("transverse"), (0.1, 0.5))


def played(coordinates, function, error):
    """Refine a map of a function of velocity and amplitude; return the answers and the number of
    rounds, too."""
    reference, rounds = {}, 0
    while (result := refine_cells(coordinates, reference, error)).missing:
        reference |= {node: (function(*coordinates.place(node)), 0.0) for node in result.missing}
        rounds += 1
    return result, reference, rounds


# Coordinates


@pytest.mark.parametrize("coordinates", [PLAIN, TRANSVERSE, BORE, DEEP])
def test_a_place_has_the_scaled_coordinates_that_it_was_asked_for(coordinates):
    # positions in patches, without their ends in velocity, where two patches meet
    shares = np.linspace(0, 1, 17)[1:-1], *[np.linspace(0, 1, 9)] * 2
    shares = np.array(list(product(*shares[: len(coordinates.directions)])))
    nodes = [begin + shares * np.subtract(end, begin) for begin, end in coordinates.patches]
    nodes = np.concatenate(nodes)
    places = np.array([coordinates.place(tuple(node)) for node in nodes])
    back = coordinates.scaled(*places.T)
    # near a border the square root amplifies the rounding of amplitudes to nine digits
    assert back[:, 0] == pytest.approx(nodes[:, 0], abs=1e-7)
    assert back[:, 1] == pytest.approx(nodes[:, 1], abs=1e-4)
    assert (places[:, 1].min(), places[:, 1].max()) == coordinates.amplitude
    if coordinates.poisson:
        assert back[:, 2] == pytest.approx(nodes[:, 2], abs=1e-7)
        assert (places[:, 2].min(), places[:, 2].max()) == coordinates.poisson


@pytest.mark.parametrize("coordinates", [PLAIN, TRANSVERSE, BORE])
def test_velocities_reach_from_the_slowest_to_the_fastest(coordinates):
    ends = coordinates.patches[0][0][0], coordinates.patches[-1][1][0]
    result = tuple(coordinates.place((x, 0.3))[0] for x in ends)
    assert result == coordinates.velocity


def test_kinks_are_borders_of_patches():
    slow = ((0.0, 0.0), (1.0, 1.0))
    fast = [((2.0, 0.0), (2.5, 1.0)), ((2.5, 0.0), (3.0, 1.0))]
    assert PLAIN.patches == [slow]
    assert TRANSVERSE.patches == [slow, ((0.0, 1.0), (1.0, 2.0)), *fast]
    assert BORE.patches == [slow, *fast]
    assert DEEP.patches[2] == ((2.0, 0.0, 0.0), (2.5, 1.0, 1.0))
    assert TRANSVERSE.place((0.3, 1.0))[1] == 1.0
    assert BORE.place((1.0, 0.3))[0] == BORE.place((2.0, 0.3))[0] == 1.0
    for node in ((1.0, 1.7), (2.0, 0.7)):
        velocity, amplitude = TRANSVERSE.place(node)
        kink = kink_velocity(kinks_of("transverse"), np.array(amplitude))
        assert velocity == pytest.approx(float(kink), rel=1e-8)


def test_places_are_even_in_what_they_are_said_to_be_even_in():
    # slow: even in the cube root of the velocity; fast: even in log(velocity) and log(1 + 2 A)
    slow = np.cbrt([BORE.place((x, 0.5))[0] for x in (0.0, 0.25, 0.5, 0.75, 1.0)])
    assert np.diff(slow) == pytest.approx(np.full(4, (1.0 - 0.1) / 4), rel=1e-7)
    fast = [BORE.place((x, 0.5))[0] for x in (2.0, 2.25, 2.5, 2.75, 3.0)]
    assert fast == pytest.approx(np.geomspace(1.0, 10.0, 5))
    amplitudes = [BORE.place((2.5, y))[1] for y in (0.0, 0.5, 1.0)]
    assert amplitudes == pytest.approx([0.0, (np.sqrt(11.0) - 1.0) / 2.0, 5.0])


def test_a_kink_outside_of_the_range_cuts_nothing():
    assert MapCoordinates((2.0, 10.0), (0.0, 5.0), kinks_of("bore")).patches == PLAIN.patches
    assert MapCoordinates((0.1, 10.0), (1.0, 3.0), Kinks((1.0,))).patches == PLAIN.patches


def test_a_kink_in_part_of_the_range_stays_clear_of_its_ends():
    inside = MapCoordinates((0.1, 10.0), (0.0, 3.0), kinks_of("transverse"))
    places = [inside.place((1.0, y))[0] for y in np.linspace(0, 2, 9)]
    assert min(places) == pytest.approx(0.2)  # twice the smallest velocity; the kink is at 0.002


def test_coordinates_survive_as_text():
    for coordinates in (TRANSVERSE, DEEP):
        assert MapCoordinates.from_json(coordinates.to_json()) == coordinates


# Cells


def test_no_more_than_a_cell_for_each_patch_is_asked_where_that_is_enough():
    # a linear function of the scaled coordinates
    result, reference, rounds = played(PLAIN, lambda v, a: np.log(v) + np.log(1 + 2 * a), 1e-6)
    assert list(result.cells) == first_cells(PLAIN)
    assert (len(reference), rounds) == (25, 1)
    assert result.errors == pytest.approx([0.0], abs=1e-8)


def test_surpluses_are_differences_of_the_fourth_order():
    x = np.arange(5.0)
    # the fourth difference of x^4 is 4! = 24, and its third differences are at most 60
    along, across = surpluses_of(np.outer(x**4, np.ones(5)))
    assert along == pytest.approx(24.0)
    assert across == 0.0
    # a cubic has no fourth differences; its third differences are 3! = 6
    assert surpluses_of(np.outer(np.ones(5), x**3)) == pytest.approx((0.0, 6 * LOWER_ORDER))


def test_cells_are_halved_along_the_direction_that_is_worse():
    result, _, _ = played(PLAIN, lambda v, a: np.sin(9 * np.log(v)) + np.log(1 + 2 * a), 1e-3)
    widths = {cell.end[1] - cell.begin[1] for cell in result.cells}
    assert widths == {1.0}
    assert len(result.cells) > 2


def test_cells_gather_where_a_function_is_not_smooth_and_cover_the_map():
    result, _, _ = played(PLAIN, lambda v, a: abs(np.log(v) - np.log(0.03)), 1e-2)
    size = {cell: cell.end[0] - cell.begin[0] for cell in result.cells}
    at_kink = np.log(3) / np.log(100)
    nearest = min(size, key=lambda cell: abs(0.5 * (cell.begin[0] + cell.end[0]) - at_kink))
    assert size[nearest] == min(size.values()) < max(size.values())
    area = sum(np.prod(np.subtract(cell.end, cell.begin)) for cell in result.cells)
    assert area == pytest.approx(1.0)


def test_what_is_promised_holds_for_a_function_with_layers():
    def function(v, a):
        return np.tanh(4 * (np.log10(v) + 1.2)) * np.exp(-a) + 1 / (1 + 8 * (a - 1.1) ** 2)

    result, reference, _ = played(PLAIN, function, 3e-3)
    rng, off = np.random.default_rng(3), []
    for cell, bound in zip(result.cells, result.errors, strict=True):
        values = np.array([reference[node][0] for node in cell.nodes((4, 4))]).reshape(5, 5)
        for node in rng.uniform(cell.begin, cell.end, (20, 2)):
            s, t = 4 * (node - cell.begin) / np.subtract(cell.end, cell.begin)
            between = [np.polyval(np.polyfit(range(5), row, 4), t) for row in values]
            value = np.polyval(np.polyfit(range(5), between, 4), s)
            off.append(abs(value - function(*PLAIN.place(tuple(node)))) / bound)
    assert len(off) > 400
    assert np.mean(np.array(off) <= 1.0) >= 0.99
    assert max(result.errors) <= 3e-3


def test_what_five_nodes_do_not_show_is_halved_however_loose_the_error():
    # The fourth difference of x^4 over steps of 1/4 is 4! / 4^4 = 3/32; in halves it is 1/16 of
    # that.
    def function(v, a):
        return 0.6 * (np.log(v / 0.01) / np.log(100)) ** 4

    result, _, _ = played(PLAIN, function, 0.1)
    assert 0.6 * 3 / 32 > RESOLVED > 0.6 * 3 / 32 / 16
    assert {cell.end[0] - cell.begin[0] for cell in result.cells} == {0.5}


def test_errors_of_nodes_count():
    (cell,) = first_cells(PLAIN)
    nodes = cell.nodes((4, 4))
    reference = {node: (0.0, 3e-3 if node == (0.5, 0.5) else 1e-3) for node in nodes}
    assert refine_cells(PLAIN, reference, 1e-2).errors == (3e-3,)


def test_all_follows_from_the_answers_in_whatever_order_they_come():
    result, reference, _ = played(TRANSVERSE, lambda v, a: v / (v + a), 3e-3)
    backwards = dict(reversed(reference.items()))
    assert refine_cells(TRANSVERSE, backwards, 3e-3) == result
    # a larger error needs a subset of these points
    looser, fewer, _ = played(TRANSVERSE, lambda v, a: v / (v + a), 1e-2)
    assert fewer.keys() < reference.keys()
    assert len(looser.cells) < len(result.cells)


def test_where_a_point_failed_nothing_is_promised_and_nothing_asked():
    (cell,) = first_cells(PLAIN)
    reference = dict.fromkeys(cell.nodes((4, 4)), (1.0, 0.0)) | {(0.5, 0.25): (np.nan, np.inf)}
    result = refine_cells(PLAIN, reference, 1e-2)
    assert result.missing == ()
    assert result.errors == (np.inf,)


def test_a_jump_ends_at_the_smallest_cells():
    result, _, _ = played(PLAIN, lambda v, a: float(v > 0.0301), 1e-2)
    assert min(cell.end[0] - cell.begin[0] for cell in result.cells) == SMALLEST
    # the fourth differences of a jump of 1 are at most 3
    assert max(result.errors) == pytest.approx(3 * SHARE)


def test_halves_have_the_nodes_of_the_whole():
    cell, degrees = Cell((0.0, 1.0, 0.0), (1.0, 1.5, 1.0)), (4, 4, 2)
    for direction in range(3):
        nodes = [half.nodes(degrees) for half in cell.halves(direction)]
        assert set(cell.nodes(degrees)) <= {*nodes[0], *nodes[1]}


def test_a_third_direction_is_halved_where_friction_bends_over_it_and_only_there():
    deep = PLAIN._replace(poisson=(0.0, 0.5))
    result, reference, _ = played(deep, lambda v, a, nu: 0.1 * np.sin(12 * nu) + a, 3e-3)
    widths = {(c.end[0] - c.begin[0], c.end[1] - c.begin[1]) for c in result.cells}
    assert widths == {(1.0, 1.0)}
    assert len(result.cells) > 1
    straight, fewer, _ = played(deep, lambda v, a, nu: 0.1 * nu + a, 3e-3)
    assert (len(straight.cells), len(fewer)) == (1, 5 * 5 * 3)


def test_surpluses_of_three_nodes_are_twice_their_second_differences():
    # The second differences of x^2 are 2.
    values = np.multiply.outer(np.ones((5, 5)), [0.0, 1.0, 4.0])
    assert surpluses_of(values) == pytest.approx((0.0, 0.0, 4.0))
