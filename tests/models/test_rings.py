"""Steps and marches on rings against results of an independent solver."""

import numpy as np
import pytest
from models.test_models import larger_residual

from microslip.contact.contact import energy_norm, forward_slip
from microslip.contact.coulomb import coulomb_residual, project
from microslip.contact.path import EULER, SDIRK2, half_period_phases, make_path
from microslip.contact.reduced import slider_contact
from microslip.contact.ring_contact import RadialContact
from microslip.motions.named import Transverse

# Friction of ``exponential_contact`` after six half periods from forward slip, from a solver in
# complex numbers, Gauss-Seidel and dense Newton, which shares no code with this one
KNOWN = [
    (4, 12, 0.005, 0.5, 0.3443567651),
    (8, 16, 0.005, 0.5, 0.3207923574),
    (12, 12, 0.0001, 0.9, 0.0005847364),
    (10, 12, 0.1, 0.1, 0.9928784007),
    (16, 16, 0.1, 1.5, 0.1959517441),
    (8, 24, 1, 0.5, 0.9621146413),
    (9, 12, 1, 5, 0.4176065584),
    (32, 24, 0.01, 0.7, 0.0947968418),
]
"""(rings, steps, velocity, amplitude, mean forward force in the last half period)"""


def half_period(velocity, amplitude, steps, integrator=SDIRK2):
    def displacement(phase):
        return Transverse().displacement(phase, velocity, amplitude, 0.0)

    return make_path(displacement, half_period_phases(steps), integrator)


def plain_half_period(velocity, amplitude, steps):
    """Half a period in equal steps."""
    phase = np.linspace(-np.pi / 2, np.pi / 2, steps + 1)
    return make_path(lambda t: Transverse().displacement(t, velocity, amplitude, 0.0), phase)


def exponential_contact(cells):
    """Rings with an artificial influence matrix, which no other code of the package computes."""
    edges = np.sin(np.linspace(0.0, np.pi / 2, cells + 1))
    radius, weight = 0.5 * (edges[1:] + edges[:-1]), np.pi * np.diff(edges**2)
    kernel = 0.8 * np.exp(-2.0 * np.abs(radius[:, None] - radius))
    return RadialContact(kernel * weight, 1.5 / np.pi * np.sqrt(1.0 - radius**2), weight)


def some_state(contact, seed, share=1.0):
    q = np.random.default_rng(seed).normal(size=(2, 1, len(contact.bound)))
    return share * project(q * contact.bound, contact.bound)


@pytest.mark.parametrize("cells", [1, 5, 16, 48])
def test_every_stage_obeys_coulomb_to_the_tolerance(cells):
    contact = RadialContact.resolved(cells, 0.7) if cells > 1 else slider_contact()
    for tolerance in (1e-4, 1e-8, 1e-12):
        path = half_period(0.05, 0.8, 10, EULER)
        march = contact.march(path, some_state(contact, 1), tolerance)
        assert march.residual <= march.solves * tolerance
        bound = contact.bound
        tractions = project(np.moveaxis(march.fields[:, :, 0], 1, 0), bound)
        stages = np.moveaxis(tractions, 1, 0)
        moves = np.diff(path.positions[:, :2], axis=0)
        for before, after, move in zip(stages, stages[1:], moves, strict=False):
            slip = move[:, None] - (after - before) @ contact.influence.T
            left = coulomb_residual(
                after[:, None], slip[:, None], bound, contact.weight, contact.compliance
            )
            assert left <= larger_residual(contact) * tolerance + 1e-14


def test_another_march_as_first_guess_changes_the_effort_only():
    contact, tolerance = RadialContact.resolved(12, 0.7), 1e-12
    path = half_period(0.02, 0.5, 16)
    start = contact.march(path, forward_slip(contact), tolerance).state
    near = contact.march(path, 0.999 * start, tolerance)
    alone = contact.march(path, start, tolerance)
    for previous in (near, alone):
        led = contact.march(path, start, tolerance, previous=previous)
        assert led.iterations < alone.iterations
        assert energy_norm(contact, led.state - alone.state) < 1e-9
    other = contact.march(half_period(0.02, 0.5, 12), start, tolerance)  # other steps
    assert np.array_equal(contact.march(path, start, tolerance, previous=other).state, alone.state)


@pytest.mark.parametrize(("cells", "steps", "velocity", "amplitude", "mu"), KNOWN)
def test_friction_is_what_it_was(cells, steps, velocity, amplitude, mu):
    contact = exponential_contact(cells)
    path = plain_half_period(velocity, amplitude, steps)
    state, march = forward_slip(contact), None
    for _ in range(6):
        march = contact.march(path, state, 1e-10, previous=march)
        state = contact.mirrored(march.state)
    assert path.mean(march.forces[:, 0]) == pytest.approx(mu, abs=1e-8)
