"""A quarter of the squares against all of them, and where it is not enough."""

from dataclasses import replace

import numpy as np
import pytest
from models.test_squares import direct_sum

from microslip.models.contact import TORQUE, energy_norm, forces, forward_slip
from microslip.models.path import make_path
from microslip.models.pull import Body
from microslip.models.registry import MODELS
from microslip.models.squares import contact as squares_contact
from microslip.models.squares.contact import CartesianContact
from microslip.models.squares.convolution import convolve, square_convolution, workspace
from microslip.models.squares.side_by_side import SquaresSideBySide
from microslip.motions.by_name import motion_named
from microslip.pressures.by_name import HERTZ, pressure_named
from microslip.solver.problem import Problem, Resolution
from microslip.solver.simulate import simulate
from microslip.solver.static_run import simulate_static

ELLIPSE = "ellipse:ratio=0.6"
LOOP = "elliptic:forward=0.6,lateral=1,phase=70"
TOLERANCE = 1e-13
"""Of steps: what differs by more than a thousand of them differs."""


@pytest.fixture
def rng():
    return np.random.default_rng(20201109)


def whole(state):
    """Even fields (..., m, m) with their images, (..., 2 m, 2 m)."""
    across = np.concatenate([state[..., ::-1], state], axis=-1)
    return np.concatenate([across[..., ::-1, :], across], axis=-2)


def both(cells, pressure=HERTZ):
    """All the squares, and a quarter of them."""
    quarter = CartesianContact(cells, pressure=pressure, translates=True)
    assert quarter.quarter
    return CartesianContact(cells, pressure=pressure), quarter


def path_of(name, steps=12, velocity=0.1, amplitude=0.8):
    motion = motion_named(name)
    phase = np.linspace(-np.pi / 2, np.pi, steps + 1)
    return make_path(lambda t: motion.displacement(t, velocity, amplitude, 0.0), phase)


@pytest.mark.parametrize("cells", [2, 4, 6, 8, 10, 12, 14, 18])
def test_a_quarter_of_the_convolution_is_that_of_the_direct_sum(cells, rng):
    """... padded to 1, 3, 6, 8, 9, 12, 16 and 18, so that every kind of butterfly is in it."""
    operator = square_convolution(cells, 0.0, quarter=True)[0]
    state = rng.normal(size=(2, cells // 2, cells // 2))
    out = np.empty_like(state)
    convolve(operator, workspace(operator), state, out)
    assert whole(out) == pytest.approx(direct_sum(cells, 0.0, whole(state)), abs=1e-13)


def test_scratch_of_other_tractions_does_not_show(rng):
    operator = square_convolution(12, 0.0, quarter=True)[0]
    scratch = workspace(operator)
    for part in scratch:
        part[:] = rng.normal(size=part.shape)
    state = rng.normal(size=(2, 6, 6))
    one, other = np.empty_like(state), np.empty_like(state)
    convolve(operator, workspace(operator), state, one)
    convolve(operator, scratch, state, other)
    assert np.array_equal(one, other)


@pytest.mark.parametrize("cells", [4, 8, 12])
def test_largest_eigenvalue_of_even_fields_is_bounded_closely(cells):
    _, contact = both(cells)
    n = cells // 2
    units = np.eye(2 * n * n).reshape(-1, 2, n, n)
    matrix = np.stack([contact.displacement(unit).ravel() for unit in units])
    largest = np.linalg.eigvalsh(matrix)[-1]
    assert largest < contact.largest < 2.5 * largest


def test_a_quarter_counts_for_the_whole(rng):
    """Areas, loads, forces and energies; a fourth of the room."""
    all_squares, quarter = both(8, pressure_named(ELLIPSE))
    state = rng.normal(size=(2, 4, 4))
    assert quarter.weight.sum() == all_squares.weight.sum() == 4.0
    assert np.sum(quarter.weight * quarter.bound) == pytest.approx(1.0, abs=1e-14)
    assert whole(quarter.bound) == pytest.approx(all_squares.bound, rel=1e-14)
    assert (quarter.forward_position > 0.0).all() and (quarter.lateral_position > 0.0).all()
    one, other = forces(all_squares, whole(state)), forces(quarter, state)
    assert other[:TORQUE] == pytest.approx(one[:TORQUE], abs=1e-13)
    energies = energy_norm(all_squares, whole(state)), energy_norm(quarter, state)
    assert energies[1] == pytest.approx(energies[0], rel=1e-13)
    assert whole(quarter.mirrored(state)) == pytest.approx(all_squares.mirrored(whole(state)))
    rooms = [workspace(contact.operator)[0].nbytes for contact in (all_squares, quarter)]
    assert 4 * rooms[1] == rooms[0]


@pytest.mark.parametrize("pressure", ["hertz", ELLIPSE, "ring:inner=0.4"])
@pytest.mark.parametrize("motion", ["transverse", "longitudinal", LOOP])
@pytest.mark.parametrize("cells", [8, 12])
def test_a_march_of_a_quarter_is_that_of_all_squares(cells, motion, pressure):
    contacts, path = both(cells, pressure_named(pressure)), path_of(motion)
    one, other = (contact.march(path, forward_slip(contact), TOLERANCE) for contact in contacts)
    assert np.ptp(one.forces[:, 0]) > 0.1
    assert other.forces == pytest.approx(one.forces, abs=1e-10)
    assert np.all(other.forces[:, TORQUE] == 0.0)
    assert whole(other.state) == pytest.approx(one.state, abs=1e-10)
    assert whole(other.stages) == pytest.approx(one.stages, abs=1e-10)
    assert other.solves == one.solves and other.residual <= other.solves * TOLERANCE


def test_a_pulled_march_of_a_quarter_is_that_of_all_squares():
    path, body = path_of("transverse", steps=8), Body(0.4, 0.0, 0.3, 0.0)
    one, other = (
        contact.pulled_march(path, forward_slip(contact), TOLERANCE, body, np.zeros(2))
        for contact in both(8)
    )
    assert np.ptp(one.body[:, 0]) > 0.1
    assert other.body == pytest.approx(one.body, abs=1e-10)
    assert other.forces == pytest.approx(one.forces, abs=1e-10)
    assert np.all(other.forces[:, TORQUE] == 0.0)
    assert whole(other.state) == pytest.approx(one.state, abs=1e-10)


def test_quarters_stand_side_by_side(rng):
    """Displacements and mirror images of two contacts on one body."""
    shares, extents = (0.7, 0.3), (1.25, 0.71)
    one, other = (SquaresSideBySide([c, c], shares, extents) for c in both(6))
    states = rng.normal(size=(2, 2, 3, 3))
    joined, joined_whole = np.concatenate(list(states), -1), np.concatenate(list(whole(states)), -1)

    def spread(field):
        return np.concatenate([whole(part) for part in np.split(field, 2, axis=-1)], axis=-1)

    assert spread(other.displacement(joined)) == pytest.approx(
        one.displacement(joined_whole), abs=1e-13
    )
    assert np.array_equal(spread(other.mirrored(joined)), one.mirrored(joined_whole))
    assert other.stiffness == one.stiffness


@pytest.mark.slow
@pytest.mark.parametrize("velocity", [0.0, 0.2])
@pytest.mark.parametrize("motion", ["transverse", LOOP])
def test_a_run_on_a_quarter_finds_what_one_on_all_squares_does(motion, velocity, monkeypatch):
    problem = Problem(motion_named(motion, ELLIPSE), velocity, 0.6, 0.0)
    run_of = simulate if velocity else simulate_static
    resolution, tolerance = Resolution(12, 1, 12), 1e-9
    other = run_of(problem, "cartesian", resolution, tolerance)
    monkeypatch.setattr(squares_contact, "_is_even", lambda loads: False)
    one = run_of(problem, "cartesian", resolution, tolerance)
    assert one.converged and other.converged
    assert other.mu == pytest.approx(one.mu, abs=2e-9)
    assert other.torque == pytest.approx(0.0, abs=1e-12)


def test_the_same_run_on_a_quarter_twice_is_the_same_to_the_bit():
    contact, path = both(12)[1], path_of("transverse")
    one, other = (contact.march(path, forward_slip(contact), 1e-6) for _ in range(2))
    assert np.array_equal(one.state, other.state) and np.array_equal(one.forces, other.forces)


def test_a_quarter_does_only_where_symmetry_lets_it():
    """Translations at nu = 0, an even number of squares; elsewhere all are there, as they were."""

    def resolved(motion, poisson, cells):
        contact = MODELS["cartesian"].build(motion_named(motion), poisson, cells, 1, None)
        return contact.bound.shape == (cells // 2, cells // 2)

    assert resolved("transverse", 0.0, 8) and resolved(LOOP, 0.0, 8)
    assert not resolved("transverse", 0.3, 8)
    assert not resolved("transverse", 0.0, 7)
    assert not resolved("bore", 0.0, 8) and not resolved("transverse-bore", 0.0, 8)


@pytest.mark.parametrize("cells", [24, 96, 192])
def test_loads_of_ellipses_are_even_but_for_rounding(cells):
    assert CartesianContact(cells, pressure=pressure_named(ELLIPSE), translates=True).quarter


@pytest.mark.parametrize("place", [(0, 3), (3, 0), (3, 3)])
@pytest.mark.parametrize("more", [1e-8, 0.5])
def test_loads_that_are_not_even_take_all_squares(place, more):
    """One more than its images, along either axis, by more than rounding."""

    def cell_loads(cells):
        loads = HERTZ.cell_loads(cells)
        loads[place] += more * loads.max()
        return loads

    pressure = replace(HERTZ, cell_loads=cell_loads)
    contact = CartesianContact(8, pressure=pressure, translates=True)
    assert contact.bound.shape == (8, 8) and not contact.quarter


def test_the_mean_of_the_images_is_taken():
    loads = np.arange(16.0).reshape(4, 4)
    expected = np.full((2, 2), 7.5)  # an arithmetic progression along both axes
    assert np.array_equal(squares_contact._mean_quarter(loads), expected)
