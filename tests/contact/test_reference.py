"""Compiled marches against a plain reference march, for rings, angular points and squares."""

import numpy as np
import pytest
from reference_march import march, periodic
from stubs import small_contacts

from microslip.contact.contact import forward_slip
from microslip.contact.path import EULER, SDIRK2, half_period_phases, make_path
from microslip.contact.ring_contact import RadialContact
from microslip.periodic.search import Goal, PeriodMap, find_periodic_state
from microslip.scene.by_name import motion_named

CONTACTS = small_contacts.CONTACTS | {
    "rings, ahead and aside": (lambda: RadialContact.resolved(5, 0.7), "elliptic", 0.0)
}
VELOCITY, AMPLITUDE = 0.3, 0.8


def plain_parts(contact, motion, poisson):
    """Matrix of a contact, and displacement of its points, for the reference march."""
    shape = forward_slip(contact).shape
    units = np.eye(int(np.prod(shape))).reshape(-1, *shape)
    matrix = np.stack([contact.displacement(unit).ravel() for unit in units], axis=1)

    def displacement(phase):
        forward, lateral, angle = motion.displacement(phase, VELOCITY, AMPLITUDE, poisson)
        turn = np.stack([contact.lateral_position, -contact.forward_position])
        return np.array([forward, lateral])[:, None, None] + angle * turn

    return matrix, displacement


@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
@pytest.mark.parametrize("name", CONTACTS)
def test_a_march_is_the_plain_one(name, integrator):
    build, motion, poisson = CONTACTS[name]
    contact, label, phases = build(), motion_named(motion), half_period_phases(6)
    start = 0.5 * forward_slip(contact)
    matrix, displacement = plain_parts(contact, label, poisson)
    stages = len(integrator.times)
    expected = march(matrix, contact.bound, displacement, phases, start, stages)
    path = make_path(
        lambda phase: label.displacement(phase, VELOCITY, AMPLITUDE, poisson), phases, integrator
    )
    result = contact.march(path, start, 1e-13)
    assert result.state == pytest.approx(expected[-1], abs=1e-9)
    sums = (contact.weight * expected).sum(axis=(2, 3))
    rows = [0] if name.startswith("angular") else [0, 1]  # by symmetry
    assert result.forces[:, rows] == pytest.approx(sums[:, rows], abs=1e-9)


@pytest.mark.slow
def test_the_periodic_state_is_the_one_that_the_plain_march_ends_in():
    contact, motion = RadialContact.resolved(5, 0.7), motion_named("transverse")
    matrix, displacement = plain_parts(contact, motion, 0.0)
    phases, start = half_period_phases(8), forward_slip(contact)
    expected = periodic(matrix, contact.bound, displacement, phases, start, contact.mirrored)
    path = make_path(lambda phase: motion.displacement(phase, VELOCITY, AMPLITUDE, 0.0), phases)
    result = find_periodic_state(PeriodMap(contact, path), start, Goal(1e-10, 1e-13))
    assert result.converged
    assert result.start == pytest.approx(expected[0], abs=1e-9)
    forces = (contact.weight * expected[:, 0]).sum(axis=(1, 2))
    assert result.march.forces[:, 0] == pytest.approx(forces, abs=1e-9)
