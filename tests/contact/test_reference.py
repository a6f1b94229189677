"""Compiled marches of all contacts against the plain reference marches, and their energy."""

import numpy as np
import pytest
from reference_march import march
from reference_pull import pulled_march

from microslip.contact.contact import Body, forward_slip
from microslip.contact.modes import PolarContact
from microslip.contact.path import EULER, SDIRK2, make_path, phases_between
from microslip.contact.ring_contact import RadialContact
from microslip.contact.squares import CartesianContact
from microslip.scene.by_name import motion_named
from microslip.scene.motion import HALF_PERIOD

CONTACTS = {
    "rings": (lambda: RadialContact.resolved(5, 0.7), "transverse", 0.0),
    "rings, ahead and aside": (lambda: RadialContact.resolved(5, 0.7), "elliptic", 0.0),
    "angular points": (lambda: PolarContact(4, 4, True, 0.3, 0.6), "bore", 0.3),
    "angular points of a translation": (
        *(lambda: PolarContact(4, 4, False, 0.3, 0.6), "transverse"),
        0.3,
    ),
    "squares": (lambda: CartesianContact(5, 0.3), "bore", 0.3),
}
"""Functions that build a small contact, names of motions, and Poisson's ratios."""
BODIES = {
    "a soft spring": (0.5, 0.0, 0.0, 0.0),
    "a stiff spring": (20.0, 0.0, 0.0, 0.0),
    "a spring and a mass": (0.5, 0.0, 0.3, 0.0),
    "a spring, a mass and a dashpot": (0.5, 0.2, 0.3, -0.1),
    "a force and a mass": (0.0, 0.0, 0.3, 0.5),
    "a force": (0.0, 0.0, 0.0, 0.5),
}
PLACE, START = (0.3, 0.8), np.array([-0.2, 0.1])
names = pytest.mark.parametrize("name", CONTACTS)
integrators = pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda one: one.name)


class Case:
    """A contact, the displacement of its path, and the same for the reference marches."""

    def __init__(self, name):
        build, motion, poisson = CONTACTS[name]
        self.contact = contact = build()
        self.motion, self.poisson = motion_named(motion), poisson
        self.start = 0.5 * forward_slip(contact)
        units = np.eye(self.start.size).reshape(-1, *self.start.shape)
        self.matrix = np.stack([contact.displacement(unit).ravel() for unit in units], axis=1)
        weight = np.broadcast_to(contact.weight, self.start.shape[1:])
        self.plain = self.matrix, weight, contact.bound

    def displacement(self, phase):
        return self.motion.displacement(phase, *PLACE, self.poisson)

    def of_points(self, phase):
        forward, lateral, angle = self.displacement(phase)
        turn = np.stack([self.contact.lateral_position, -self.contact.forward_position])
        return np.array([forward, lateral])[:, None, None] + angle * turn

    def march(self, phases, tolerance, integrator=SDIRK2, **drive):
        path = make_path(self.displacement, phases, integrator)
        return self.contact.march(path, self.start, tolerance, **drive)


@integrators
@names
def test_a_march_is_the_plain_one(name, integrator):
    case, phases, stages = Case(name), phases_between(HALF_PERIOD, 6), len(integrator.times)
    place = case.contact.bound, case.of_points, phases, case.start, stages
    expected = march(case.matrix, *place)
    result = case.march(phases, 1e-13, integrator)
    assert result.state == pytest.approx(expected[-1], abs=1e-9)
    sums = (case.contact.weight * expected).sum(axis=(2, 3))
    rows = [0] if name.startswith("angular") else [0, 1]  # by symmetry
    assert result.forces[:, rows] == pytest.approx(sums[:, rows], abs=1e-9)


@integrators
@pytest.mark.parametrize("body", BODIES)
@names
def test_a_pulled_march_is_the_plain_one(name, body, integrator):
    case, phases, numbers = Case(name), phases_between(HALF_PERIOD, 5), BODIES[body]
    place = case.of_points, phases, case.start, numbers, START, len(integrator.times)
    expected, places = pulled_march(case.plain, *place)
    result = case.march(phases, 1e-12, integrator, body=Body(*numbers), start=START)
    assert result.state == pytest.approx(expected[-1], abs=2e-8)
    assert result.body[:, 0] == pytest.approx(places, abs=2e-8)
    forces = (case.contact.weight * expected[:, 0]).sum(axis=(1, 2))
    assert result.forces[:, 0] == pytest.approx(forces, abs=2e-8)


@pytest.mark.parametrize("body", ["a soft spring", "a force and a mass", "a force"])
def test_the_error_of_a_driven_march_is_proportional_to_the_tolerance_of_its_steps(body):
    """A step of a soft drive can be solved with different displacements: the residual of a step
    counts the force, and nearly full slip changes the force little."""
    case, phases, drive = Case("rings"), phases_between(HALF_PERIOD, 8), Body(*BODIES[body])
    exact, *others = (
        case.march(phases, tolerance, body=drive, start=START).body[:, 0]
        for tolerance in (1e-13, 1e-9, 1e-7, 1e-5)
    )
    errors = np.array([np.abs(other - exact).max() for other in others])
    assert (errors < 200.0 * np.array([1e-9, 1e-7, 1e-5])).all()
    assert (errors[:-1] < 0.1 * errors[1:]).all()


@integrators
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
