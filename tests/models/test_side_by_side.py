"""Contacts of one body, side by side in one system of rings, against what is plainer."""

import numpy as np
import pytest
from models.test_pulled import BODIES, START
from reference_pull import pulled_march
from scipy.linalg import block_diag

from microslip.models.contact import forward_slip
from microslip.models.path import EULER, SDIRK2, half_period_phases, make_path
from microslip.models.pull import Body
from microslip.models.rings.contact import RadialContact
from microslip.models.rings.side_by_side import BodyPath, RingsSideBySide

VELOCITY = 0.3
WAYS = ((0.8, 0.0, 0.0), (0.5, 1.1, 0.3))
"""Amplitude, phase and share of it forward of two contacts."""
SHARES, EXTENTS = (0.7, 0.3), (1.25, 0.71)


def small():
    """Two contacts of a few rings, in their own units."""
    return RadialContact.resolved(3, 0.7), RadialContact.resolved(4, 0.5)


def base(phase):
    return VELOCITY * phase, 0.0 * phase, 0.0 * phase


def besides(way):
    amplitude, lead, forward = way
    return lambda phase: (
        amplitude * forward * np.sin(phase + lead),
        amplitude * np.sin(phase + lead),
        0.0 * phase,
    )


def path_of(phases, ways, integrator=SDIRK2):
    each = tuple(make_path(besides(way), phases, integrator) for way in ways)
    return BodyPath(**vars(make_path(base, phases, integrator)), each=each)


@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
@pytest.mark.parametrize("body", BODIES)
def test_a_march_of_two_contacts_is_the_plain_one(body, integrator):
    """The plain march knows nothing of contacts: a matrix of two blocks, and points that move each
    as they like."""
    contacts, phases = small(), half_period_phases(5)
    joined = RingsSideBySide(contacts, SHARES, EXTENTS)
    matrix = block_diag(*(e * one.influence for one, e in zip(contacts, EXTENTS, strict=True)))
    weight = np.concatenate([s * one.weight for one, s in zip(contacts, SHARES, strict=True)])
    bound = np.concatenate([one.bound for one in contacts])
    cells = [len(one.bound) for one in contacts]

    def of_points(phase):
        rows = [np.array(besides(way)(phase)[:2]) for way in WAYS]
        rows = [row + np.array([base(phase)[0], 0.0]) for row in rows]
        return np.repeat(np.stack(rows, axis=1), cells, axis=1)[:, None]

    start, numbers = 0.5 * forward_slip(joined), BODIES[body]
    plain = np.kron(np.eye(2), matrix), weight[None], bound
    stages = len(integrator.times)
    expected, places = pulled_march(plain, of_points, phases, start, numbers, START, stages)
    path = path_of(phases, WAYS, integrator)
    found = joined.pulled_march(path, start, 1e-12, Body(*numbers), START)
    assert found.state == pytest.approx(expected[-1], abs=2e-8)
    assert found.body[:, 0] == pytest.approx(places, abs=2e-8)
    again = joined.pulled_march(path, start, 1e-12, Body(*numbers), START, previous=found)
    assert again.state == pytest.approx(found.state, abs=1e-9)


@pytest.mark.parametrize("body", ["a spring and a mass", "a force"])
def test_contacts_that_do_the_same_are_one(body):
    one = RadialContact.resolved(5, 0.7)
    three = RingsSideBySide([one] * 3, [1 / 3] * 3, [1.0] * 3)
    assert three.stiffness == pytest.approx(one.stiffness)
    phases, way = half_period_phases(8), (0.8, 0.4, 0.2)

    def whole(phase):
        return tuple(a + b for a, b in zip(base(phase), besides(way)(phase), strict=True))

    start, body = 0.5 * forward_slip(one), Body(*BODIES[body])
    alone = one.pulled_march(make_path(whole, phases), start, 1e-12, body, START)
    path = path_of(phases, [way] * 3)
    together = three.pulled_march(path, np.tile(start, 3), 1e-12, body, START)
    assert together.state == pytest.approx(np.tile(alone.state, 3), abs=1e-9)
    assert together.body == pytest.approx(alone.body, abs=1e-9)
    assert together.forces[:, :2] == pytest.approx(alone.forces[:, :2], abs=1e-9)
