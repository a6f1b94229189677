"""Consistency of tractions, slip and forces over one period."""

import numpy as np
import pytest

import microslip
from microslip.scene.by_name import pressure_named

POINTS = [
    ("transverse-bore:phase=90", 0.1, 0.8, {"poisson": 0.3}),
    ("transverse", 0.1, 0.6, {}),
    ("transverse", 0.1, 0.6, {"poisson": 0.3}),
    ("bore", 0.3, 1.0, {"pressure": "ring"}),
    ("bore", 0.02, 1.0, {"poisson": 0.3}),
    ("normal:lateral=1", 0.1, 0.6, {}),
    pytest.param(
        ("normal:angle=1,normal_cycles=2", 0.1, 0.6, {"poisson": 0.3}), marks=pytest.mark.long
    ),
]


@pytest.fixture(scope="module", params=POINTS, ids=str)
def given(request):
    motion, velocity, amplitude, settings = request.param
    return request.param, microslip.period(motion, velocity, amplitude, **settings)


@pytest.mark.slow
def test_the_mean_force_is_the_certified_one(given):
    (motion, velocity, amplitude, settings), result = given
    answer = microslip.solve(motion, velocity, amplitude, **settings)
    assert result.converged
    mean = np.trapezoid(result.force_forward, result.phase) / (2 * np.pi)
    assert mean == pytest.approx(answer.mu_macro, abs=2e-3)
    # under an oscillating load, mu_macro resolves the change of the contact area within steps
    assert mean == pytest.approx(result.mu_macro, abs=1e-3 if motion.startswith("normal") else 1e-5)


def test_a_period_ends_where_it_began(given):
    _, result = given
    for name in ("traction_forward", "traction_lateral"):
        rows = getattr(result, name)
        assert np.abs(rows[-1] - rows[0]).max() < 1e-3 * result.bound.max()


def test_every_point_slips_forward_as_far_as_the_sphere_moves(given):
    _, result = given
    travel = result.forward[-1] - result.forward[0]
    assert result.slip_forward[1:].sum(axis=0) == pytest.approx(travel, rel=1e-3)


def test_tractions_keep_to_the_bound_and_oppose_no_more_than_slip(given):
    _, result = given
    size = np.hypot(result.traction_forward, result.traction_lateral)
    assert (size <= result.bound * (1 + 1e-9) + 1e-15).all()
    slip = np.hypot(result.slip_forward, result.slip_lateral)
    bound = np.broadcast_to(result.bound, slip.shape)
    held = (bound > 0.0) & (np.concatenate([bound[-2:-1], bound[:-1]]) > 0.0)
    # large slip, in contact during the whole step
    sliding = result.slips & (slip > 0.2 * slip.max()) & held
    cosine = result.slip_forward * result.traction_forward
    cosine += result.slip_lateral * result.traction_lateral
    assert (cosine[sliding] > 0.9 * (slip * size)[sliding]).all()
    assert slip[~result.slips & held].max() < 0.3 * slip.max()


def test_the_work_of_the_forces_is_dissipated(given):
    (motion, *_, settings), result = given

    def work(force, way):
        return np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(way))

    spent = work(result.force_forward, result.forward) + work(result.force_lateral, result.lateral)
    full = pressure_named(settings.get("pressure", "hertz")).torque
    spent += full * work(result.torque, result.angle)
    size = np.hypot(result.slip_forward, result.slip_lateral)
    bound = np.broadcast_to(result.bound, size.shape)
    between = 0.5 * (bound[1:] + bound[:-1])  # the bound can change in a step
    lost = np.sum(result.area * between * size[1:])
    assert spent == pytest.approx(lost, rel=0.03), motion
    assert result.dissipated_energy == pytest.approx(spent, rel=1e-3)
    assert result.area @ result.dissipated_energy_density == pytest.approx(spent, rel=1e-3)
    local = np.sum(between * size[1:], axis=0)
    off = np.abs(result.dissipated_energy_density - local)
    assert off.max() < 0.1 * local.max()


def test_areas_fill_the_contact_and_carry_the_load(given):
    (motion, _, amplitude, settings), result = given
    load = np.ones(1)
    if motion.startswith("normal"):
        cycles = 2.0 if "normal_cycles=2" in motion else 1.0
        load = 1.0 + amplitude * np.sin(cycles * result.phase)
    largest = load.max() ** (2.0 / 3.0)  # a is proportional to the cube root of the load
    area = pressure_named(settings.get("pressure", "hertz")).area
    assert result.area.sum() == pytest.approx(area * largest, rel=1e-3)
    assert (result.bound * result.area).sum(axis=-1) == pytest.approx(load, rel=1e-9)
    assert np.sum(result.area * result.lateral_position) == pytest.approx(0.0, abs=1e-12)
