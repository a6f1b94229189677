"""Response to a prescribed path, against closed forms and an independent march."""

import numpy as np
import pytest
import reference_march

from microslip.answer.along import response
from microslip.foundation.errors import InputError
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure
from microslip.theory import hertz

PEAK = 0.9


def there_and_back(rows=40):
    """Rows from 0 to the peak, to minus the peak and to the peak again."""
    up, down = np.linspace(0.0, PEAK, rows), np.linspace(PEAK, -PEAK, 2 * rows)
    return np.concatenate([up, down[1:], down[::-1][1:]])


@pytest.mark.parametrize("tolerance", [2e-3, 3e-4])
def test_mindlin_curve_and_masing_loops(tolerance):
    path = there_and_back()
    answer = response(path, tolerance=tolerance)
    up, down = path[:40], path[39:119]
    peak = hertz.mindlin_force(PEAK)
    unloading = peak - 2.0 * hertz.mindlin_force((PEAK - down) / 2.0)
    exact = np.concatenate([hertz.mindlin_force(up), unloading[1:], -unloading[1:]])
    assert answer.converged
    assert np.all(np.abs(answer.force_forward - exact) <= answer.force_error[:, 0])
    assert np.all(answer.force_error <= tolerance)
    # Mindlin and Deresiewicz (1953).  Their prefactor 9 (2 - nu) (mu F_z)^2 / (10 G a) is 24/5 mu
    # F_z u_lim.
    rest = 1.0 - peak
    loop = 24 / 5 * (1 - rest ** (5 / 3) - 5 * peak / 6 * (1 + rest ** (2 / 3)))
    energy = answer.dissipated_energy[-1] - answer.dissipated_energy[39]
    assert abs(energy - loop) <= 2 * answer.dissipated_energy_error.max()


def test_stick_zone_of_mindlin():
    answer = response(np.array([0.0, 0.3, 0.6]), tolerance=1e-4)
    exact = hertz.mindlin_stick_radius(np.array([0.3, 0.6])) ** 2
    assert np.allclose(answer.stick_fraction[1:], exact, atol=2.0 / answer.cells)


@pytest.mark.parametrize("ratio", [0.3, 0.9])
def test_oblique_loading_below_mu_sticks_and_above_slides(ratio):
    # Mindlin and Deresiewicz: T = ratio mu N from the first touch on.  At nu = 0 and without slip
    # the displacement is ratio times the indentation, and the whole contact sticks.
    indentation = np.linspace(0.0, 1.0, 40)
    answer = response(ratio * indentation, indentation=indentation, tolerance=1e-3)
    assert np.all(np.abs(answer.force_forward - ratio * indentation**1.5) <= 1e-3)
    assert abs(answer.dissipated_energy[-1]) <= answer.dissipated_energy_error[-1]
    sliding = response(2.0 * indentation, indentation=indentation, tolerance=1e-3)
    assert np.all(np.abs(sliding.force_forward - indentation**1.5) <= 1e-3)


def test_a_response_goes_on_where_another_one_ended():
    path = there_and_back()
    whole = response(path, 0.3 * path**2)
    first = response(path[:60], 0.3 * path[:60] ** 2)
    rest = response(path[59:], 0.3 * path[59:] ** 2, state=first)
    assert np.allclose(rest.force_forward, whole.force_forward[59:], atol=1e-9)
    energy = whole.dissipated_energy[59:] - whole.dissipated_energy[59]
    assert np.allclose(rest.dissipated_energy, energy, atol=1e-9)
    for other in ({"poisson": 0.3}, {"pressure": "ring:inner=0.5"}):
        with pytest.raises(InputError, match=f"^{[*other][0]} = .*that of the state"):
            response(path, path, state=first, **other)


def test_full_slip_stays_while_sliding_goes_on_and_unloads_as_masing_says():
    path = np.array([0.0, 0.5, 0.2])
    answer = response(path, state="full-slip", tolerance=1e-3)
    exact = [1.0, 1.0, 1.0 - 2.0 * hertz.mindlin_force(0.15)]
    assert np.all(np.abs(answer.force_forward - exact) <= answer.force_error[:, 0])
    assert abs(answer.dissipated_energy[1] - 0.5) <= answer.dissipated_energy_error[1]


def test_torsion_of_lubkin():
    angles = np.linspace(0.0, 1.0, 12) * hertz.lubkin_angle(0.4)
    answer = response(0.0 * angles, angle=angles, tolerance=2e-3)
    exact = hertz.lubkin_torque(0.4) / HERTZ.torque
    assert abs(answer.torque[-1] - exact) <= answer.force_error[-1, 2]


def independent_march(rows, load, rings, substeps):
    """Forces at every row by the reference march with backward Euler steps, nu = 0."""
    from microslip.contact.ring_contact import RadialContact

    largest = load.max() ** (1 / 3)
    contact = RadialContact.resolved(rings).at_indentation(largest**2, load[0] ** (2 / 3))
    edges = contact.growth.edges
    unit = np.eye(rings)[:, None, None] * np.array([1.0, 0.0])[:, None, None]
    columns = [contact.displacement(one)[0, 0] for one in unit]
    matrix = np.kron(np.eye(2), np.array(columns).T)
    state, forces = np.zeros((2, rings)), [np.zeros(2)]
    for k in range(len(rows) - 1):
        for j in range(substeps):
            at = k + (j + np.array([0.0, 1.0])) / substeps
            force = np.interp(at[1], np.arange(len(load)), load)
            radius = force ** (1 / 3)
            inside = force * (1 - np.clip(1 - (edges / radius) ** 2, 0.0, None) ** 1.5)
            bound = np.diff(inside) / (np.pi * np.diff(edges**2))

            def displacement(phase):
                place = [np.interp(phase, np.arange(len(rows)), column) for column in rows.T]
                return np.repeat(np.array(place)[:, None], rings, axis=1)

            state = reference_march.march(matrix, bound, displacement, at, state, stages=1)[-1]
        forces.append((contact.weight * state).sum(axis=1))
    return np.array(forces)


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 50))]
)
def test_random_planar_paths_with_varying_load(seed):
    random = np.random.default_rng(seed)
    steps = random.normal(size=(7, 2)) * random.choice([0.2, 0.5, 1.0])
    rows = np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    load = random.uniform(0.3, 1.7, len(rows))
    answer = response(*rows.T, load=load, tolerance=5e-3)
    coarse, fine = (independent_march(rows, load, *size) for size in ((16, 12), (32, 24)))
    other = 2.0 * fine - coarse  # it is of first order
    difference = np.abs(np.stack([answer.force_forward, answer.force_lateral], axis=1) - other)
    assert answer.converged
    assert np.all(difference <= answer.force_error[:, :2] + np.abs(fine - coarse))


def test_the_resolution_of_a_pressure_on_a_grid_is_part_of_the_error():
    place = np.linspace(-1.25, 1.25, 5)
    squares = place[:, None] ** 2 + place**2
    values = np.sqrt(np.clip(1.0 - squares, 0.0, None))
    sphere = Pressure.from_array(place, place, values, grid="samples")
    path = [0.0, 0.3, 0.6, 0.2]
    coarse, exact = response(path, pressure=sphere, tolerance=1e-2), response(path)
    off = np.abs(coarse.force_forward - exact.force_forward)
    assert off.max() > 1e-2
    assert np.all(off <= coarse.force_error[:, 0] + exact.force_error[:, 0])
    assert not coarse.converged and "resolution leaves" in coarse.reason
