"""Symmetric parts of the squares against all squares, and when a symmetry is used."""

import numpy as np
import pytest
from contact.test_squares import direct_sum

from microslip.contact.contact import LATERAL, TORQUE, energy_norm, forces, forward_slip
from microslip.contact.convolution import MIRROR, TURN, convolve, square_convolution, workspace
from microslip.contact.path import make_path
from microslip.contact.registry import MODELS
from microslip.contact.squares import CartesianContact
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.hertz import HERTZ, Hertz
from microslip.scene.problem import Problem

ELLIPSE = "ellipse:ratio=0.6"
LOOP = "elliptic:forward=0.6,lateral=1,phase=70"
TOLERANCE = 1e-13
"""Tolerance of steps.  Results are equal if they differ by less than 1000 times as much."""

KINDS = {
    "quarter": (4, TURN, 0.0),
    "half turn": (2, TURN, 0.3),
    "mirror image": (2, MIRROR, 0.3),
    "mirror image at nu = 0": (2, MIRROR, 0.0),
}
"""Number of images of a square, symmetry of the motion, and Poisson's ratio."""
MOTIONS = {
    "quarter": ("longitudinal", LOOP),
    "half turn": ("transverse", LOOP),
    "mirror image": ("bore", "continuous-bore"),
    "mirror image at nu = 0": ("bore",),
}


@pytest.fixture
def rng():
    return np.random.default_rng(20201109)


def whole(kind, state):
    """Fields (..., 2, m, m) or (..., 2, m, n) with their images, (..., 2, n, n)."""
    images, symmetry, _ = KINDS[kind]
    if images == 4:
        state = np.concatenate([state[..., ::-1], state], axis=-1)
    behind = state[..., ::-1, :]
    if symmetry == MIRROR:
        behind = behind * np.array([1.0, -1.0])[:, None, None]
    elif images == 2:
        behind = behind[..., ::-1]
    return np.concatenate([behind, state], axis=-2)


def some_state(kind, cells, rng):
    return rng.normal(size=(2, cells // 2, cells // 2 if KINDS[kind][0] == 4 else cells))


def both(kind, cells, pressure=HERTZ):
    """The contact with all squares, and the contact with a symmetric part of them."""
    images, symmetry, nu = KINDS[kind]
    fewer = CartesianContact(cells, nu, pressure, symmetry)
    assert fewer.images == images and fewer.bound.size * images == cells**2
    return CartesianContact(cells, nu, pressure), fewer


def path_of(name, nu, steps=12, velocity=0.1):
    motion = motion_named(name)
    amplitude = 0.8 if motion.periodic else None
    phase = np.linspace(-np.pi / 2, np.pi, steps + 1)
    return make_path(lambda t: motion.displacement(t, velocity, amplitude, nu), phase)


@pytest.mark.parametrize("cells", [2, 6, 12, 18])
@pytest.mark.parametrize("kind", KINDS)
def test_convolution_is_the_direct_sum_over_all_squares(kind, cells, rng):
    images, symmetry, nu = KINDS[kind]
    operator = square_convolution(cells, nu, images=images, symmetry=symmetry)[0]
    state = some_state(kind, cells, rng)
    out, again = np.empty_like(state), np.empty_like(state)
    scratch = workspace(operator)
    convolve(operator, scratch, state, out)
    assert whole(kind, out) == pytest.approx(direct_sum(cells, nu, whole(kind, state)), abs=1e-13)
    for part in scratch:  # old values in the scratch arrays have no effect
        part[:] = rng.normal(size=part.shape)
    convolve(operator, scratch, state, again)
    assert np.array_equal(again, out)


@pytest.mark.parametrize("kind", KINDS)
def test_squares_count_for_their_images(kind, rng):
    """Areas, loads, forces, energies and mirror images are those of all squares."""
    every, fewer = both(kind, 8, pressure_named(ELLIPSE))
    state = some_state(kind, 8, rng)
    full = whole(kind, state)
    assert fewer.weight.sum() == every.weight.sum() == pytest.approx(4.0 * 0.6)
    assert np.sum(fewer.weight * fewer.bound) == pytest.approx(1.0, abs=1e-14)
    even = whole(kind, np.stack([fewer.bound, fewer.bound]))[0]
    assert even == pytest.approx(every.bound, rel=1e-14)
    assert (fewer.forward_position > 0.0).all()
    rows = [0, LATERAL] if KINDS[kind][1] == TURN else [0, TORQUE]
    assert forces(fewer, state)[rows] == pytest.approx(forces(every, full)[rows], abs=1e-13)
    energies = energy_norm(every, full), energy_norm(fewer, state)
    assert energies[1] == pytest.approx(energies[0], rel=1e-13)
    assert np.array_equal(whole(kind, fewer.mirrored(state)), every.mirrored(full))


@pytest.mark.parametrize("pressure", ["hertz", ELLIPSE, "ring:inner=0.4"])
@pytest.mark.parametrize("kind, motion", [(k, m) for k, ms in MOTIONS.items() for m in ms])
def test_a_march_is_that_of_all_squares(kind, motion, pressure):
    contacts, path = both(kind, 12, pressure_named(pressure)), path_of(motion, KINDS[kind][2])
    one, other = (contact.march(path, forward_slip(contact), TOLERANCE) for contact in contacts)
    assert np.ptp(one.forces[:, 0]) > 0.01
    assert other.forces == pytest.approx(one.forces, abs=1e-10)
    assert np.all(other.forces[:, TORQUE if KINDS[kind][1] == TURN else LATERAL] == 0.0)
    assert whole(kind, other.state) == pytest.approx(one.state, abs=1e-10)
    assert whole(kind, other.fields) == pytest.approx(one.fields, abs=1e-10)
    assert other.solves == one.solves and other.residual <= other.solves * TOLERANCE
    again = contacts[1].march(path, forward_slip(contacts[1]), TOLERANCE)
    assert np.array_equal(again.state, other.state) and np.array_equal(again.forces, other.forces)


def images_of(motion, nu, cells=8, pressure=HERTZ):
    """Number of images of the contact that the registry builds."""
    place = (1.0, 1.0) if motion_named(motion).periodic else (1.0, None)
    problem = Problem(motion_named(motion), *place, nu, pressure)
    return MODELS["cartesian"].build(problem, cells, 1, None).images


def test_fewer_squares_do_only_where_symmetry_lets_them():
    assert images_of("transverse", 0.0) == images_of(LOOP, 0.0) == 4
    assert images_of("transverse", 0.3) == images_of(LOOP, 0.3) == 2
    assert images_of("bore", 0.0) == images_of("bore", 0.3) == images_of("continuous-bore", 0) == 2
    assert images_of("transverse-bore", 0.0) == 1
    assert images_of("transverse", 0.0, cells=7) == images_of("bore", 0.3, cells=7) == 1


@pytest.mark.parametrize(
    ("places", "images"),
    [  # squares with more load than others -> images of translations, and of rotations
        (((0, 3),), (1, 1)),
        (((0, 3), (7, 3)), (1, 2)),
        (((0, 3), (7, 4)), (2, 1)),
        (((1, 3), (1, 4), (6, 3), (6, 4)), (4, 2)),
    ],
)
def test_a_difference_between_loads_removes_a_symmetry_unless_it_is_of_rounding(places, images):
    def images_with(more):
        class Uneven(Hertz):
            def cell_loads(self, cells):
                loads = super().cell_loads(cells)
                loads[tuple(zip(*places, strict=True))] += more * loads.max()
                return loads

        pressure = Uneven()
        return images_of("transverse", 0.0, 8, pressure), images_of("bore", 0.3, 8, pressure)

    assert images_with(1e-8) == images_with(0.5) == images
    assert images_with(1e-13) == (4, 2)
