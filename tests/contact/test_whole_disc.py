"""Angular points of the whole disc: operator and marches are those of half of the disc."""

import numpy as np
import pytest

from microslip.contact.influence import ring_influence
from microslip.contact.modes import PolarContact
from microslip.contact.path import SDIRK2, make_path

RINGS, ANGLES = 5, 6
RATIOS = [0.0, 0.3, 0.5]


def whole(nu, focus=None):
    return PolarContact(RINGS, ANGLES, True, nu, focus, whole=True)


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


@pytest.mark.parametrize("contact", [PolarContact(RINGS, ANGLES, True, 0.3), whole(0.3)])
def test_the_shortest_wave_is_not_coupled(contact):
    """Its cosine, forward, is 0 at all points; its sine, lateral, alternates between the points."""
    near, _ = ring_influence(tuple(contact.rings.psi), ANGLES + 1, True)
    wave = np.zeros((2, *contact.forward_position.shape))
    wave[1] = ((-1.0) ** np.arange(wave.shape[1]))[:, None]
    expected = wave * near[ANGLES].sum(axis=1)
    assert contact.displacement(wave) == pytest.approx(expected, abs=1e-9)
