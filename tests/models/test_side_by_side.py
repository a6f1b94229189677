"""Several contacts of one body in one system, against plain computations."""

import numpy as np
import pytest
from models.test_force_and_spring import BODIES, START, plain
from reference_pull import pulled_march

from microslip.models.contact import forward_slip
from microslip.models.driven_body import Body
from microslip.models.path import EULER, SDIRK2, BodyPath, half_period_phases, make_path
from microslip.models.polar.contact import PolarContact
from microslip.models.rings.contact import RadialContact
from microslip.models.side_by_side import SideBySide
from microslip.models.squares.contact import CartesianContact

VELOCITY = 0.3
WAYS = ((0.8, 0.0, 0.0), (0.5, 1.1, 0.3))
"""Amplitude, phase and forward share of the oscillation of two contacts."""
SHARES, EXTENTS = (0.7, 0.3), (1.25, 0.71)

KINDS = {
    "rings": (lambda: (RadialContact.resolved(3, 0.7), RadialContact.resolved(3, 0.5)), False),
    "angular points": (
        lambda: (PolarContact(3, 4, True, 0.3, 0.6), PolarContact(3, 4, True, 0.3, 0.5)),
        True,
    ),
    "angular points at nu = 0": (
        lambda: (PolarContact(3, 4, True, 0.0, 0.6), PolarContact(3, 4, True, 0.0, 0.5)),
        True,
    ),
    "angular points of a translation": (
        lambda: (PolarContact(3, 4, False, 0.3, 0.6), PolarContact(3, 4, False, 0.3, 0.5)),
        False,
    ),
    "more angular points": (
        lambda: (PolarContact(7, 8, True, 0.0), PolarContact(7, 8, True, 0.0, 0.4)),
        True,
    ),
    "squares": (lambda: (CartesianContact(5, 0.3), CartesianContact(5, 0.3)), True),
}
"""Two contacts of equal shape in their own units, and whether they rotate."""


def base(phase):
    return VELOCITY * phase, 0.0 * phase, 0.0 * phase


def besides(way, turns=False):
    amplitude, lead, forward = way
    return lambda phase: (
        amplitude * forward * np.sin(phase + lead),
        amplitude * np.sin(phase + lead),
        0.6 * turns * amplitude * np.cos(phase + lead),
    )


def path_of(phases, ways, integrator=SDIRK2, turns=False):
    each = tuple(make_path(besides(way, turns), phases, integrator) for way in ways)
    return BodyPath(**vars(make_path(base, phases, integrator)), each=each)


def plain_of_all(contacts):
    """Matrix, weights and bound of independent contacts."""
    each = [plain(one) for one in contacts]
    rows = each[0][1].shape[0]
    cells = [weight.shape[1] for _, weight, _ in each]
    unknowns = np.arange(2 * rows * sum(cells)).reshape(2, rows, sum(cells))
    matrix = np.zeros((unknowns.size, unknowns.size))
    own = np.split(unknowns, np.cumsum(cells)[:-1], axis=-1)
    for places, (alone, _, _), extent in zip(own, each, EXTENTS, strict=True):
        matrix[np.ix_(places.ravel(), places.ravel())] = extent * alone
    weight = [share * weight for (_, weight, _), share in zip(each, SHARES, strict=True)]
    bound = [bound for _, _, bound in each]
    return matrix, np.concatenate(weight, axis=-1), np.concatenate(bound, axis=-1)


def moved(contact, displacement, phase):
    """Displacement of every point of a contact."""
    forward, lateral, angle = displacement
    turn = np.stack([contact.lateral_position, -contact.forward_position])
    return np.array([forward + base(phase)[0], lateral])[:, None, None] + angle * turn


@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
@pytest.mark.parametrize("body", ["a soft spring", "a spring, a mass and a dashpot", "a force"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_march_of_two_contacts_is_the_plain_one(kind, body, integrator):
    """The reference march has a matrix of two blocks and a displacement for each point."""
    build, turns = KINDS[kind]
    contacts, phases = build(), half_period_phases(5)
    joined = SideBySide(contacts, SHARES, EXTENTS)

    def of_points(phase):
        each = zip(contacts, WAYS, strict=True)
        return np.concatenate(
            [moved(one, besides(way, turns)(phase), phase) for one, way in each], axis=-1
        )

    start, numbers = 0.5 * forward_slip(joined), BODIES[body]
    stages = len(integrator.times)
    expected, places = pulled_march(
        plain_of_all(contacts), of_points, phases, start, numbers, START, stages
    )
    path = path_of(phases, WAYS, integrator, turns)
    result = joined.march(path, start, 1e-12, body=Body(*numbers), start=START)
    assert result.state == pytest.approx(expected[-1], abs=2e-8)
    assert result.body[:, 0] == pytest.approx(places, abs=2e-8)
    again = joined.march(path, start, 1e-12, previous=result, body=Body(*numbers), start=START)
    assert again.state == pytest.approx(result.state, abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_displacements_of_contacts_side_by_side_are_their_own(kind):
    build, _ = KINDS[kind]
    contacts = build()
    joined = SideBySide(contacts, SHARES, EXTENTS)
    state = np.random.default_rng(3).normal(size=forward_slip(joined).shape)
    matrix, weight, bound = plain_of_all(contacts)
    assert joined.displacement(state).ravel() == pytest.approx(matrix @ state.ravel(), abs=1e-12)
    assert np.broadcast_to(joined.weight, weight.shape) == pytest.approx(weight)
    assert joined.bound == pytest.approx(bound)
    cells = weight.shape[1] // 2 if kind == "squares" else contacts[0].bound.shape[-1]
    for own, one in zip(np.split(joined.mirrored(state), [cells], axis=-1), contacts, strict=True):
        columns = slice(0, cells) if one is contacts[0] else slice(cells, None)
        assert np.array_equal(own, one.mirrored(state[..., columns]))


@pytest.mark.parametrize("body", ["a spring and a mass", "a force"])
def test_contacts_that_do_the_same_are_one(body):
    one = RadialContact.resolved(5, 0.7)
    three = SideBySide([one] * 3, [1 / 3] * 3, [1.0] * 3)
    assert three.stiffness == pytest.approx(one.stiffness)
    phases, way = half_period_phases(8), (0.8, 0.4, 0.2)

    def whole(phase):
        return tuple(a + b for a, b in zip(base(phase), besides(way)(phase), strict=True))

    start, body = 0.5 * forward_slip(one), Body(*BODIES[body])
    alone = one.march(make_path(whole, phases), start, 1e-12, body=body, start=START)
    path = path_of(phases, [way] * 3)
    together = three.march(path, np.tile(start, 3), 1e-12, body=body, start=START)
    assert together.state == pytest.approx(np.tile(alone.state, 3), abs=1e-9)
    assert together.body == pytest.approx(alone.body, abs=1e-9)
    assert together.forces[:, :2] == pytest.approx(alone.forces[:, :2], abs=1e-9)
