"""Marches of driven contacts: against a plain reference, energy balance and limits."""

import numpy as np
import pytest
from reference_pull import pulled_march
from stubs.small_contacts import CONTACTS

from microslip.contact.contact import Body, forward_slip
from microslip.contact.path import EULER, SDIRK2, half_period_phases, make_path
from microslip.contact.ring_contact import RadialContact
from microslip.scene.by_name import motion_named

BODIES = {
    "a soft spring": (0.5, 0.0, 0.0, 0.0),
    "a stiff spring": (20.0, 0.0, 0.0, 0.0),
    "a spring and a mass": (0.5, 0.0, 0.3, 0.0),
    "a spring and a dashpot": (0.5, 0.7, 0.0, -0.1),
    "a spring, a mass and a dashpot": (0.5, 0.2, 0.3, -0.1),
    "a force and a mass": (0.0, 0.0, 0.3, 0.5),
    "a force": (0.0, 0.0, 0.0, 0.5),
}
VELOCITY, AMPLITUDE, START = 0.3, 0.8, np.array([-0.2, 0.1])


def moved(motion, poisson, contact):
    """Functions of the phase: displacement of the path, and of the points."""

    def displacement(phase):
        return motion.displacement(phase, VELOCITY, AMPLITUDE, poisson)

    def of_points(phase):
        forward, lateral, angle = displacement(phase)
        turn = np.stack([contact.lateral_position, -contact.forward_position])
        return np.array([forward, lateral])[:, None, None] + angle * turn

    return displacement, of_points


def contact_and_path(name):
    """A contact and the path of its motion."""
    build, motion, poisson = CONTACTS[name]
    contact = build()
    displacement, _ = moved(motion_named(motion), poisson, contact)
    return contact, make_path(displacement, half_period_phases(8))


def plain(contact):
    """Matrix, weights and bound for the reference march."""
    shape = forward_slip(contact).shape
    units = np.eye(int(np.prod(shape))).reshape(-1, *shape)
    matrix = np.stack([contact.displacement(unit).ravel() for unit in units], axis=1)
    return matrix, np.broadcast_to(contact.weight, shape[1:]), contact.bound


@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("name", CONTACTS)
def test_a_pulled_march_is_the_plain_one(name, body, integrator):
    build, motion, poisson = CONTACTS[name]
    contact, label, phases = build(), motion_named(motion), half_period_phases(5)
    displacement, of_points = moved(label, poisson, contact)
    start, numbers = 0.5 * forward_slip(contact), BODIES[body]
    stages = len(integrator.times)
    expected, places = pulled_march(
        plain(contact), of_points, phases, start, numbers, START, stages
    )
    path = make_path(displacement, phases, integrator)
    result = contact.march(path, start, 1e-12, body=Body(*numbers), start=START)
    assert result.state == pytest.approx(expected[-1], abs=2e-8)
    assert result.body[:, 0] == pytest.approx(places, abs=2e-8)
    assert result.forces[:, 0] == pytest.approx(
        (contact.weight * expected[:, 0]).sum(axis=(1, 2)), abs=2e-8
    )


@pytest.mark.parametrize("body", ["a soft spring", "a force and a mass", "a force"])
def test_the_error_of_a_driven_march_is_proportional_to_the_tolerance_of_its_steps(body):
    """A step of a soft drive can be solved with different displacements: the residual of a step
    counts the force, and nearly full slip changes the force little."""
    contact, path = RadialContact.resolved(12, 0.7), contact_and_path("rings")[1]
    drive, start = Body(*BODIES[body]), 0.5 * forward_slip(contact)
    exact, *others = (
        contact.march(path, start, tolerance, body=drive, start=START).body[:, 0]
        for tolerance in (1e-13, 1e-9, 1e-7, 1e-5)
    )
    errors = np.array([np.abs(other - exact).max() for other in others])
    assert (errors < 200.0 * np.array([1e-9, 1e-7, 1e-5])).all()
    assert (errors[:-1] < 0.1 * errors[1:]).all()


@pytest.mark.parametrize("name", CONTACTS)
def test_the_force_on_a_contact_without_mass_is_the_one_that_pulls(name):
    contact, path = contact_and_path(name)
    start = 0.5 * forward_slip(contact)
    result = contact.march(path, start, 1e-11, body=Body(0.0, 0.0, 0.0, 0.6), start=START)
    assert result.forces[1:, 0] == pytest.approx(0.6, abs=1e-10)
    soft = contact.march(path, start, 1e-11, body=Body(0.5, 0.0, 0.0, 0.6), start=START)
    assert soft.forces[:, 0] == pytest.approx(0.6 - 0.5 * soft.body[:, 0], abs=1e-10)


@pytest.mark.parametrize("name", CONTACTS)
def test_the_work_of_the_drive_is_stored_or_dissipated(name):
    """Energy is balanced exactly in a backward Euler step: work is done by the tractions at its
    end, and each point dissipates its bound times its slip."""
    build, motion, poisson = CONTACTS[name]
    contact, label = build(), motion_named(motion)
    displacement, of_points = moved(label, poisson, contact)
    phases = half_period_phases(1)
    path = make_path(displacement, phases, EULER)
    start, force = 0.5 * forward_slip(contact), 0.7
    result = contact.march(path, start, 1e-12, body=Body(0.0, 0.0, 0.0, force), start=START)
    q, travel = result.state, of_points(phases[1]) - of_points(phases[0])
    strained = contact.displacement(q - start)
    slip = travel - strained
    slip[0] += result.body[1, 0]
    ahead = np.diff(displacement(phases)[0])[0]
    turned = travel - np.array([ahead, 0.0])[:, None, None]
    forward = force * (ahead + result.body[1, 0])
    work = forward + np.sum(contact.weight * q * turned)
    stored = np.sum(contact.weight * q * strained)
    dissipated = np.sum(contact.weight * contact.bound * np.hypot(*slip))
    assert dissipated > 0.01
    assert work == pytest.approx(stored + dissipated, abs=1e-9)


@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
def test_a_body_on_a_stuck_contact_swings_as_an_oscillator_does(integrator):
    """Without slip the contact is a linear spring; the error has the order of the integrator."""
    rings = RadialContact.resolved(8)
    contact = RadialContact(rings.influence, rings.bound, rings.weight)  # its own stiffness
    spring, mass, place = 0.5, 0.2, 1e-9
    rate = np.sqrt((spring + contact.stiffness) / mass)
    ends = []
    swung, unit = np.array([np.sin(2.0 * rate), np.cos(2.0 * rate)]), place * np.array([1.0, rate])
    for steps in (100, 200):
        phases = np.linspace(0.0, 2.0, steps + 1)
        path = make_path(lambda phase: np.zeros((3, *np.shape(phase))), phases, integrator)
        start, at = np.zeros((2, 1, 8)), np.array([0.0, place * rate])
        result = contact.march(path, start, 1e-22, body=Body(spring, 0.0, mass, 0.0), start=at)
        ends.append(np.hypot(*(result.body[-1] / unit - swung)))
    assert ends[1] < 0.2
    assert np.log2(ends[0] / ends[1]) == pytest.approx(integrator.order, abs=0.35)
