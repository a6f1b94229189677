"""Scaled coordinates of maps of drift: ranges, patches and the scaled velocity."""

import numpy as np
import pytest

from microslip.sweeps.drift_coordinates import DriftCoordinates, scaled_velocity, velocity_of
from microslip.theory import paper
from microslip.theory.drift_threshold import first_amplitude, is_known, threshold

SIDEWAYS = DriftCoordinates("transverse", 0.9, (0.0, 3.0))
TURNING = DriftCoordinates("bore", 0.95, (0.5, 5.0))


@pytest.mark.parametrize("coordinates", [SIDEWAYS, TURNING])
def test_places_have_the_scaled_coordinates_that_they_come_from(coordinates):
    rng = np.random.default_rng(3)
    rows = coordinates.patches[-1][1][1]
    nodes = np.column_stack([rng.uniform(0.05, 1, 50), rng.uniform(0, rows, 50)])
    places = np.array([coordinates.place(tuple(node)) for node in nodes.tolist()])
    # rounding of forces to nine digits leaves five near a threshold of 0.9
    assert coordinates.scaled(*places.T) == pytest.approx(nodes, abs=1e-4)


def test_a_map_reaches_from_the_threshold_to_the_largest_force():
    for row in (0.2, 0.7, 1.0, 1.6):
        low, high = (SIDEWAYS.place((share, row)) for share in (0.0, 1.0))
        assert low[1] == high[1]
        assert low[0] == pytest.approx(float(paper.static_limit_transverse(low[1])), abs=1e-8)
        assert high[0] == 0.9


def test_it_begins_where_the_threshold_is_the_largest_force_and_is_cut_where_it_is_gone():
    (begin, end), (after, last) = SIDEWAYS.patches
    assert (begin, end, after, last) == ((0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 2.0))
    first = SIDEWAYS.place((0.0, 0.0))[1]
    assert float(paper.static_limit_transverse(first)) == pytest.approx(0.9, abs=1e-8)
    assert first == pytest.approx(first_amplitude("transverse", 0.9), rel=1e-8)
    assert [SIDEWAYS.place((1.0, row))[1] for row in (1.0, 2.0)] == [1.0, 3.0]
    # the threshold of a bore is never 0, so that its map has one patch
    assert TURNING.patches == [((0.0, 0.0), (1.0, 1.0))]
    assert TURNING.place((0.0, 0.0))[1] == 0.5


def test_near_the_threshold_drift_as_the_power_3_2_is_smooth():
    """(P - threshold)^(3/2) is proportional to the third power of the scaled force."""
    shares = np.array([0.02, 0.04])
    for row in (0.5, 1.3):
        places = np.array([SIDEWAYS.place((share, row)) for share in shares])
        above = places[:, 0] - threshold("transverse", places[:, 1])
        assert np.log2(above[1] ** 1.5 / above[0] ** 1.5) == pytest.approx(3.0, abs=0.02)


def test_as_json_it_is_the_same():
    assert DriftCoordinates.from_json(SIDEWAYS.to_json()) == SIDEWAYS


def test_errors_are_absolute_where_it_is_slow_and_relative_where_it_is_fast():
    for velocity, error in ((0.0, 1e-3), (0.01, 1e-3), (1.0, 2e-3), (50.0, 0.05)):
        scaled, bound = scaled_velocity(velocity, error)
        assert bound == pytest.approx(error / np.sqrt(1.0 + velocity**2), rel=2e-3)
        back, back_error = velocity_of(np.array([scaled]), np.array([bound]))
        assert back[0] == pytest.approx(velocity, abs=1e-12)
        assert error <= back_error[0] * (1 + 1e-9) <= 1.01 * error


def test_a_velocity_is_not_below_0():
    velocity, error = velocity_of(np.array([-1e-3]), np.array([2e-3]))
    assert velocity[0] == 0.0
    assert error[0] == pytest.approx(1e-3, rel=1e-5)  # the upper end is sinh(-1e-3 + 2e-3)


def test_the_threshold_is_known_of_what_exerts_no_forward_force_by_itself():
    assert is_known("transverse", "hertz", 0.0) and is_known("bore", "hertz", 0.4)
    assert not is_known("transverse", "hertz", 0.3)
    assert not is_known("transverse", "punch", 0.0)
    assert not is_known("longitudinal", "hertz", 0.0)
