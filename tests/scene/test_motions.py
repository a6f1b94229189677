"""Motions: symmetry of the displacement, and refusals of numbers."""

import math

import numpy as np
import pytest

from microslip.foundation.errors import InputError
from microslip.scene.by_name import MOTIONS, motion_named
from microslip.scene.hertz import Hertz
from microslip.scene.motion import Motion, Wave
from microslip.scene.named import Elliptic, Transverse, TransverseBore
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Force, Problem, Spring

PERIODIC = [one() for one in MOTIONS.values() if one.periodic]
MIRRORED = [TransverseBore(phase=40), *(one for one in PERIODIC if one.half_period_mirror)]
PHASE = np.linspace(-3.0, 3.0, 101)
PLACE = {
    "motion": Transverse(),
    "velocity": 0.1,
    "amplitude": 0.5,
    "poisson": 0.3,
    "follows": False,
}


@pytest.mark.parametrize("motion", MIRRORED, ids=str)
def test_half_a_period_later_a_motion_is_its_own_mirror_image(motion):
    """The search for the periodic state relies on this symmetry, up to the drift."""
    motion = Problem(motion, 0.3, 0.7, 0.2)
    now, later = motion.displacement(PHASE), motion.displacement(PHASE + np.pi)
    ways = np.pi * motion.drift, 0.0, 0.0
    for one, other, sign, way in zip(now, later, (1, -1, -1), ways, strict=True):
        assert other == pytest.approx(sign * one + way, abs=1e-12)


@pytest.mark.parametrize("motion", PERIODIC, ids=str)
def test_a_drift_slower_than_the_rounding_of_the_oscillation_is_told_exactly(motion):
    drift = motion.drift(1.0, 0.7, 0.2)
    assert motion.drift(1e-99, 0.7, 0.2) == pytest.approx(1e-99 * drift, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("motion", [one for one in PERIODIC if one.straight], ids=str)
def test_the_oscillation_turns_at_both_ends_of_half_a_period(motion):
    ends = np.array([-0.5, 0.5]) * np.pi
    both = (motion.displacement(at, 0.0, 0.7, 0.0) for at in (PHASE, ends))
    for part, end in zip(*both, strict=True):
        assert np.abs(part).max() <= abs(end[1]) + 1e-12


def test_a_backward_motion_is_the_image_in_a_mirror_across_the_lateral_axis():
    motion = motion_named("normal:forward=1,lateral=0.5,angle=0.7,phase=40")

    def moved(ahead, aside, **settings):  # displacement of the point at these coordinates
        forward, lateral, angle = Problem(motion, 0.3, 0.7, **settings).displacement(PHASE)
        return forward + angle * aside, lateral - angle * ahead

    point, image = moved(0.2, 0.4), moved(-0.2, 0.4, backward=True)
    # the prescribed velocity itself is not reversed
    assert image[0] == pytest.approx(-point[0] + 2.0 * 0.3 * PHASE)
    assert image[1] == pytest.approx(point[1])


def own(*parts):
    """A class of motions with these displacements, as functions of phase and velocity."""

    class Own(Motion):
        def displacement(self, phase, velocity, amplitude, poisson):
            return tuple(part(phase, velocity) for part in parts)

    return Own


def ahead(phase, velocity):
    return velocity * phase


def aside(phase, velocity):
    return np.sin(phase)


def declared(base=Motion, **attributes):
    """A class of motions with these attributes."""
    return type("Own", (base,), attributes)


FORMS = {
    "form\\(-x\\)": lambda phase: phase,  # not periodic
    "lateral: .* shape \\(3,\\)": lambda phase: np.zeros(3),
    "lateral: .* not finite": lambda phase: np.full(phase.shape, np.nan),
}
STILL, LOOP = own(ahead, aside, lambda p, v: 0.0 * p), own(ahead, aside, lambda p, v: np.cos(p))
OWN = [
    Motion,
    declared(waves=[("lateral", Wave())]),
    *(
        declared(waves={"lateral": Wave(), name: one})
        for name, one in (("sideways", Wave()), ("angle", 1.0))
    ),
    *(declared(waves={"load": Wave(degrees=one)}) for one in (math.nan, 1e300, "90")),
    declared(waves={"load": Wave(), "indentation": Wave()}),
    declared(waves={"lateral": Wave()}, periodic=False),
    declared(STILL, waves={"forward": Wave()}),
    declared(LOOP, rotates=False),
    *(declared(LOOP, **{name: True}) for name in ("half_disc", "straight")),
    declared(half_period_mirror=True, waves={"lateral": Wave(cycles=2)}),
    declared(propels=False, waves={"lateral": Wave(), "forward": Wave(cycles=2)}),
    own(ahead, lambda phase, velocity: phase, aside),  # not periodic
    own(aside, aside, aside),  # does not advance
    own(ahead, aside),
    own(ahead, lambda phase, velocity: 1j * phase, aside),
]


def test_symmetries_follow_from_an_own_displacement():
    """A lead of the load relative to the displacement counts."""
    motion = declared(LOOP, waves={"load": Wave(cycles=2, degrees=90.0)})()
    assert (motion.rotates, motion.half_disc, motion.straight, motion.propels) == (
        True,
        *3 * (False,),
    )
    assert motion.half_period_mirror and STILL().straight and not STILL().rotates
    assert motion.depth(np.array([0.0]), 0.5, Hertz()) == pytest.approx(1.5 ** (2.0 / 3.0))


def test_an_own_displacement_is_accepted_while_it_is_finite():
    motion = own(ahead, aside, lambda phase, velocity: np.where(phase > 9.0, np.nan, 0.0))()
    assert motion.drift(0.5, 1.0, 0.0) == pytest.approx(0.5)
    with pytest.raises(InputError, match="^motion = 'own': displacement: .* not finite .* phase 9"):
        Problem(motion, 0.5, 1.0).displacement(np.array([1.0, 9.5]))


@pytest.mark.parametrize(
    ("build", "numbers", "argument"),
    [
        (Force, {"force": math.nan}, "force"),
        (Force, {"force": 0.5, "mass": -1.0}, "mass"),
        (Spring, {"stiffness": -1.0}, "stiffness"),
        *((one, {}, "motion = ") for one in OWN),
        *((declared(waves={"lateral": Wave(form=f)}), {}, text) for text, f in FORMS.items()),
        *((Problem, PLACE | {name: one}, name) for name in PLACE for one in (None, [1.0], 10**400)),
        (Pressure, {}, "pressure = .*defines G_star"),
        *((Elliptic, {"phase": value}, "phase") for value in (math.nan, math.inf, "1", None)),
    ],
)
def test_what_is_impossible_is_refused_by_name(build, numbers, argument):
    with pytest.raises(InputError, match=argument):
        build(**numbers)
