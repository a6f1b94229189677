"""Angular points of the whole disc: operator and marches are those of half of the disc."""

import numpy as np
import pytest

from microslip.contact.modes import PolarContact
from microslip.contact.path import SDIRK2, make_path

RINGS, ANGLES = 5, 6
RATIOS = [0.0, 0.3, 0.5]
SIGNS = np.array([1.0, -1.0])[:, None, None]


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def whole(nu, focus=None):
    return PolarContact(RINGS, ANGLES, True, nu, focus, whole=True)


def turned(field, places):
    """Rotate a field about the centre by a number of angular points."""
    forward, lateral = np.roll(field, places, axis=1)
    angle = places * np.pi / ANGLES
    return np.stack(
        [
            np.cos(angle) * forward + np.sin(angle) * lateral,
            np.cos(angle) * lateral - np.sin(angle) * forward,
        ]
    )


def smooth(contact, rng):
    """Random tractions without the shortest waves, whose cosine vanishes at the points."""
    theta = (np.arange(2 * ANGLES) + 0.5)[:, None] * np.pi / ANGLES
    waves = [wave(m * theta) for m in range(ANGLES - 1) for wave in (np.cos, np.sin)]
    return sum(rng.normal(size=(2, 1, RINGS)) * wave for wave in waves)


@pytest.mark.parametrize("nu", RATIOS)
def test_the_operator_knows_no_direction(nu, rng):
    """The displacement under rotated tractions is the rotated displacement."""
    contact = whole(nu)
    field = smooth(contact, rng)
    for places in (1, 2, 5):
        one = contact.displacement(turned(field, places))
        assert one == pytest.approx(turned(contact.displacement(field), places), abs=1e-12)


@pytest.mark.parametrize("nu", RATIOS)
def test_what_a_mirror_leaves_is_half_of_the_disc(nu, rng):
    half, disc = PolarContact(RINGS, ANGLES, True, nu), whole(nu)
    tractions = rng.normal(size=(2, ANGLES, RINGS))
    both = np.concatenate([tractions, tractions[:, ::-1] * SIGNS], axis=1)
    result = disc.displacement(both)
    assert result[:, :ANGLES] == pytest.approx(half.displacement(tractions), abs=1e-14)
    assert np.array_equal(disc.mirrored(both)[:, :ANGLES], half.mirrored(tractions))


@pytest.mark.parametrize("nu", RATIOS)
@pytest.mark.parametrize("rotates", [True, False])
def test_a_motion_with_a_symmetry_is_marched_as_on_half_of_the_disc(nu, rotates):
    half = PolarContact(RINGS, ANGLES, rotates, nu, 0.6)
    disc = whole(nu, 0.6)

    def motion(phase):
        swing = 0.7 * np.sin(phase)
        none = 0.0 * phase
        return (0.1 * phase, none, swing) if rotates else (0.1 * phase, swing, none)

    path = make_path(motion, np.linspace(-1.5, 1.5, 9), SDIRK2)
    marches = [
        contact.march(path, np.zeros((2, *contact.forward_position.shape)), 1e-9)
        for contact in (half, disc)
    ]
    # at nu > 0 the cosine of the shortest wave of a translation exists on half of the disc only
    allowed = 2e-6 if rotates or nu == 0.0 else 1e-4
    assert marches[1].state[:, :ANGLES] == pytest.approx(marches[0].state, abs=allowed)
    assert marches[1].forces == pytest.approx(marches[0].forces, abs=allowed)
    assert np.hypot(*marches[1].state).max() <= disc.bound.max() * (1.0 + 1e-12)
