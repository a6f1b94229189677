"""Bodies on several contacts: equal contacts, closed forms, thresholds and models."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.foundation.errors import InputError
from microslip.models.driven_body import Body
from microslip.motions.body_contacts import BodyContact, contacts_of
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, contact_of, path_of
from microslip.theory import paper
from microslip.theory.drift import antiphase_drift

AGAINST = "phase=0;phase=180"
SPRING = {"velocity": 0.2, "stiffness": 0.1, "mass": 1.0}
COARSE = {"cells": 8, "steps": 24, "tolerance": None}
ALONE = {
    "a velocity": ("transverse", {"amplitude": 1.5, "velocity": 0.1}),
    "a force": ("transverse", {"amplitude": 1.5, "force": 0.3}),
    "a spring": ("transverse", {"amplitude": 1.5, "velocity": 0.1, "stiffness": 0.1}),
    "a mass on a spring": ("transverse", {"amplitude": 1.5, "damping": 0.1} | SPRING),
    "a mass": ("transverse", {"amplitude": 1.5, "force": 0.3, "mass": 1.0}),
    "a rotation under a force": ("bore", {"amplitude": 1.5, "force": 0.4}),
    "a rotation on a spring": ("bore", {"amplitude": 1.5} | SPRING),
    "nu > 0": ("transverse", {"amplitude": 1.5, "force": 0.3, "poisson": 0.3}),
    "an oscillating load": (
        "normal:lateral=1",
        {"amplitude": 0.6, "velocity": 0.3, "stiffness": 0.1, "tolerance": 1e-2},
    ),
    "an oscillating load with a rotation": (
        "normal:angle=1",
        {"amplitude": 0.6, "velocity": 0.3, "stiffness": 0.3, "tolerance": 1e-2},
    ),
    "no axis of symmetry": (
        "transverse",
        {"amplitude": 1.5, "force": 0.3, "pressure": "ellipse:ratio=0.5"} | COARSE,
    ),
}
LONG = ("a rotation on a spring", "an oscillating load with a rotation", "no axis of symmetry")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.long if n in LONG else ()) for n in ALONE]
)
@pytest.mark.parametrize("contacts", ["phase=0", "load=5,phase=77;load=5,phase=77"])
def test_equal_contacts_give_the_answer_of_one_contact(contacts, name):
    """The phase at which a period begins does not count; with phase 0 the steps are the same."""
    motion, arguments = ALONE[name]
    alone = microslip.solve(motion, **arguments)
    together = microslip.solve(motion, contacts=contacts, **arguments)
    assert_agree(alone, together)
    if contacts == "phase=0":
        assert alone.answer.value == pytest.approx(together.answer.value, abs=1e-5)
    assert alone.answer.value > 0.05  # the contact moves


THREE = {"velocity": 0.1, "contacts": "load=2;load=1,phase=90;amplitude=0.5,phase=180"}


@pytest.mark.slow
@pytest.mark.parametrize("endless", [{"stiffness": 1e6}, {"stiffness": 0.1, "mass": 1e6}])
@pytest.mark.parametrize(
    ("motion", "arguments"),
    [
        ("transverse", THREE),
        ("longitudinal", THREE),
        ("elliptic", THREE),
        pytest.param("bore", {"contacts": "load=2;load=1,phase=90"}, marks=pytest.mark.long),
        (
            "elliptic",
            {"contacts": "load=2;amplitude=0.5,phase=90", "poisson": 0.3, "tolerance": 1e-2},
        ),
        (
            "normal:lateral=1,phase=40",
            {"contacts": "phase=0;amplitude=0.5,phase=90", "tolerance": 1e-2},
        ),
    ],
)
def test_an_endlessly_stiff_or_heavy_drive_has_the_friction_of_the_velocity(
    motion, arguments, endless
):
    place = {"velocity": 0.2, "amplitude": 0.8} | arguments
    prescribed = microslip.solve(motion, **place)
    driven = microslip.solve(motion, **place, **endless)
    assert_agree(prescribed, driven)


@pytest.mark.slow
def test_a_contact_half_a_period_later_is_its_mirror_image_sideways():
    """Half a period later the forward motion is the same; a quarter of a period later it is not."""
    alone = microslip.solve("transverse", amplitude=1.5, force=0.3)
    against = microslip.solve("transverse", amplitude=1.5, force=0.3, contacts=AGAINST)
    across = microslip.solve("transverse", amplitude=1.5, force=0.3, contacts="phase=0;phase=90")
    assert_agree(alone, against)
    assert alone.velocity - across.velocity > 10.0 * across.velocity_error


REAL = {"radius": "5 mm", "young": "70 GPa", "nu": 0.0, "mu": 0.3, "frequency": "100 Hz"}
MOVED = {
    "transverse": {"amplitude": "0.12 um", "speed": "10 um/s"},
    "bore": {"amplitude": "0.3 deg", "speed": "40 um/s"},
}


@pytest.mark.slow
@pytest.mark.parametrize("motion", MOVED)
def test_at_a_velocity_each_contact_is_alone(motion):
    """Spheres in SI units, each with its own u_lim; their mean forces add up at any phases."""
    loads = (1.0, 4.0)
    each = [microslip.predict(motion, load=f"{load} N", **REAL, **MOVED[motion]) for load in loads]
    mean = microslip.predict(motion, load=f"{np.mean(loads)} N", **REAL, **MOVED[motion])
    contacts = f"load={loads[0]};load={loads[1]},phase=60"
    place = motion, mean.velocity, mean.amplitude
    result = microslip.solve(*place, contacts=contacts)
    force = sum(one.friction_force_N for one in each) / sum(loads) / 0.3
    assert result.converged
    # the two contacts differ
    assert abs(each[0].mu_macro - each[1].mu_macro) > 0.03
    assert abs(result.mu_macro - force) <= result.mu_macro_error + 1e-3
    still = microslip.solve(motion, 0.0, mean.amplitude, contacts=contacts)
    static = sum(one.mu_static * load for one, load in zip(each, loads, strict=True)) / sum(loads)
    assert abs(still.mu_macro - static) <= still.mu_macro_error + 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("force", [0.1, 0.3, 0.7])
@pytest.mark.parametrize("amplitude", [0.5, pytest.param(1.0, marks=pytest.mark.long), 5.0])
def test_two_sliders_against_each_other_have_their_closed_form(amplitude, force):
    result = microslip.solve("longitudinal", amplitude=amplitude, force=force, contacts=AGAINST)
    assert result.converged
    assert abs(result.velocity - antiphase_drift(force, amplitude)) <= result.velocity_error


@pytest.mark.slow
def test_more_sliders_that_work_against_each_other_in_pairs_do_as_well():
    four = ";".join(["phase=0", "phase=180", "load=1,phase=180", "phase=360"])
    result = microslip.solve("longitudinal", amplitude=1.0, force=0.3, contacts=four)
    assert abs(result.velocity - antiphase_drift(0.3, 1.0)) <= result.velocity_error


def velocity_of(force, contacts, friction, phases):
    """Mean of v(t), where the sum of share * friction(v, w) is the force at every instant.

    contacts: tuples (share, phase in degrees, a) with the lateral velocity w = a cos(t + phase).
    """
    phase = (np.arange(phases) + 0.5) * np.pi / phases
    sideways = [(share, a * np.cos(phase + np.deg2rad(p))) for share, p, a in contacts]
    low, high = np.zeros_like(phase), np.full_like(phase, 1e4)
    for _ in range(60):
        middle = 0.5 * (low + high)
        is_low = sum(share * friction(middle, w) for share, w in sideways) < force
        low, high = np.where(is_low, middle, low), np.where(is_low, high, middle)
    return float(middle.mean())


@pytest.mark.slow
def test_large_amplitudes_are_those_of_rigid_contacts():
    """Elasticity reduces the displacement per period by some u_lim at any amplitude."""
    contacts = "load=3;load=1,phase=90;load=2,phase=45,amplitude=2"
    shares = [(3 / 6, 0.0, 1.0), (1 / 6, 90.0, 1.0), (2 / 6, 45.0, 2.0)]
    lost = []
    for amplitude in (40.0, 160.0):
        result = microslip.solve(
            "transverse", amplitude=amplitude, force=0.4, contacts=contacts, tolerance=3e-3
        )
        assert result.converged
        contacts_there = [(share, phase, amplitude * a) for share, phase, a in shares]
        rigid = velocity_of(0.4, contacts_there, lambda v, w: v / np.hypot(v, w), 2000)
        lost.append((rigid - result.velocity) / rigid)
    assert 0.0 < lost[1] < 0.03
    assert lost[1] < 0.45 * lost[0]


UNEQUAL = "load=3;load=1,phase=45"
ITS_LOADS = (1.5, 0.5)
"""Loads of the contacts over the mean load."""


def unequal_limit(amplitude):
    """Mean of the static limits; u_lim is proportional to the indentation, load^(2/3)."""
    alone = [float(paper.static_limit_transverse(amplitude / x ** (2 / 3))) for x in ITS_LOADS]
    return float(np.dot(ITS_LOADS, alone)) / 2.0


@pytest.mark.slow
def test_the_threshold_of_a_body_is_the_mean_of_its_contacts():
    limit = unequal_limit(0.4)
    settings = {"amplitude": 0.4, "contacts": UNEQUAL}
    below = microslip.solve("transverse", force=limit - 1e-5, **settings)
    assert (below.velocity, below.velocity_error, below.converged) == (0.0, 0.0, True)
    above = microslip.solve("transverse", force=limit + 0.06, tolerance=3e-4, **settings)
    assert above.converged
    assert above.velocity > 2.0 * above.velocity_error


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["transverse", "longitudinal"])
def test_below_the_threshold_a_body_comes_to_rest(motion):
    """In a plain march the displacement per period vanishes below the threshold, not above it."""
    contacts, limit = (UNEQUAL, unequal_limit(0.4)) if motion == "transverse" else (AGAINST, None)
    limit = limit or (1.0 - 0.4) ** 1.5
    problem = Problem(motion_named(motion), 0.1, 0.4, contacts=contacts_of(contacts))
    contact, ways = contact_of(problem, "radial", Resolution(24, 1, 24)), {}
    path = path_of(problem, contact, 24)
    for share in (0.8, 1.2):
        body = Body(0.0, 0.0, 0.0, share * limit)
        state, march = np.zeros((2, 1, len(contact.bound))), None
        for _ in range(40):
            march = contact.march(path, state, 1e-10, march, body=body)
            mirrored = problem.half_period_mirror
            state = contact.mirrored(march.state) if mirrored else march.state
        # relative displacement plus that of the path
        ways[share] = march.body[-1, 0] - march.body[0, 0] + np.ptp(path.positions[:, 0])
    assert ways[1.2] > 1e-2
    assert abs(ways[0.8]) < 0.02 * ways[1.2]


REFUSED = {
    "steady": ("continuous-bore", {"velocity": 0.1}, "phase=0", "does not oscillate"),
    "a load that oscillates": (
        "normal",
        {"amplitude": 0.5, "force": 0.1},
        "load=2;load=1",
        "allowed are equal loads for normal",
    ),
    "a ring": (
        "transverse",
        {"amplitude": 0.5, "velocity": 0.1, "pressure": "ring:inner=0.5"},
        "load=2;load=1",
        "allowed are equal loads",
    ),
    "no measure": ("bore", {"amplitude": 0.5, "velocity": 0.1}, "phase=0;amplitude=0", "above 0"),
    "two units": (
        "transverse-bore",
        {"amplitude": 0.5, "velocity": 0.1},
        "load=2;load=1",
        "allowed are equal loads",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_does_not_go_with_several_contacts_is_refused(name):
    motion, settings, contacts, expected = REFUSED[name]
    with pytest.raises(InputError) as refused:
        microslip.solve(motion, contacts=contacts, **settings)
    assert (refused.value.argument, refused.value.value) == ("contacts", contacts)
    assert expected in refused.value.allowed


def test_contacts_that_do_not_vibrate_hold_as_much_as_can_be():
    """At a prescribed velocity a contact without oscillation has full friction."""
    result = microslip.solve("transverse", 0.1, 1.0, contacts="load=2;load=1,amplitude=0")
    alone = microslip.solve("transverse", 0.1 / (4 / 3) ** (2 / 3), 1.0 / (4 / 3) ** (2 / 3))
    assert result.mu_macro == pytest.approx((2.0 * alone.mu_macro + 1.0) / 3.0, abs=1e-12)
    assert result.contacts == (
        "load=1.33333333333,phase=0,amplitude=1;load=0.666666666667,phase=0,amplitude=0"
    )


@pytest.mark.slow
def test_contacts_whose_loads_differ_in_time_are_weighted_with_them():
    """The friction is the mean of the contacts, weighted by their mean loads."""
    motion, each = "normal:indentation=1,lateral=1", []
    for amplitude in (0.8, 0.4):
        result = microslip.solve(motion, 0.3, amplitude, tolerance=1e-2)
        # the load is proportional to the indentation to the power 3/2
        phase = (np.arange(4000) + 0.5) * 2.0 * np.pi / 4000
        each.append((result.mu_macro, np.mean((1.0 + amplitude * np.sin(phase)) ** 1.5)))
    both = microslip.solve(motion, 0.3, 0.8, contacts="phase=0;amplitude=0.5", tolerance=1e-2)
    expected = sum(mu * load for mu, load in each) / sum(load for _, load in each)
    assert abs(each[0][0] - each[1][0]) > 0.1
    assert both.mu_macro == pytest.approx(expected, abs=1e-4)


@pytest.mark.slow
def test_the_threshold_of_contacts_that_turn_is_the_mean_of_their_static_limits():
    """For spheres u_lim over the contact radius is proportional to load^(1/3)."""
    loads = (1.5, 0.5)
    alone = [float(paper.static_limit_bore(0.8 / load ** (1 / 3))) for load in loads]
    limit = float(np.dot(loads, alone)) / 2.0
    assert abs(alone[0] - alone[1]) > 0.1
    settings = {"amplitude": 0.8, "contacts": "load=3;load=1,phase=45"}
    below = microslip.solve("bore", force=limit - 2e-3, **settings)
    assert (below.velocity, below.velocity_error, below.converged) == (0.0, 0.0, True)
    above = microslip.solve("bore", force=limit + 0.1, **settings)
    assert above.converged
    assert above.velocity > 2.0 * above.velocity_error


@pytest.mark.long
def test_large_turns_are_those_of_rigid_contacts():
    """Eq 21 holds for each contact at every instant, at the velocity over its speed of rotation."""
    # all contacts rotate by the same angle; their radii are proportional to load^(1/3)
    contacts = [(0.75, 0.0, 1.5 ** (1 / 3)), (0.25, 60.0, 0.5 ** (1 / 3))]
    turning = np.vectorize(lambda v, w: float(paper.bore_forward(v / abs(w))))
    rigid, lost = velocity_of(0.4, contacts, turning, 400), []
    for amplitude in (10.0, 40.0):
        result = microslip.solve(
            "bore",
            amplitude=amplitude,
            force=0.4,
            contacts="load=3;load=1,phase=60",
            tolerance=1e-2,
        )
        assert result.converged
        lost.append((rigid - result.velocity) / rigid)
    assert 0.0 < lost[1] < 0.1
    assert lost[1] < 0.5 * lost[0]


@pytest.mark.long
@pytest.mark.parametrize("drive", [{"force": 0.3}, SPRING], ids=["force", "spring"])
def test_rings_angles_and_squares_agree_without_coupling_of_directions(drive):
    settings = {"amplitude": 1.5, "contacts": "load=2;load=1,phase=90"} | drive
    rings = microslip.solve("transverse", **settings)
    angles = microslip.solve("transverse", model="polar", tolerance=3e-3, **settings)
    squares = microslip.solve(
        "transverse", model="cartesian", cells=12, steps=32, tolerance=None, **settings
    )
    for other in (angles, squares):
        assert_agree(rings, other)
        assert other.answer.error < 0.02


@pytest.mark.long
def test_angles_and_squares_agree_on_contacts_that_turn():
    settings = {
        "amplitude": 1.5,
        "force": 0.4,
        "contacts": "load=2;load=1,phase=90",
        "poisson": 0.3,
    }
    angles = microslip.solve("bore", tolerance=3e-3, **settings)
    squares = microslip.solve(
        "bore", model="cartesian", cells=12, steps=32, tolerance=None, **settings
    )
    assert_agree(angles, squares)
    assert squares.velocity_error < 0.02


@pytest.mark.slow
def test_loads_in_antiphase_let_a_body_walk_that_two_in_phase_hold():
    """Loads in antiphase keep the total load constant, so the body does not run away.  The contact
    under load drags the body along."""
    motion, settings = "normal:lateral=1", {"amplitude": 0.6, "force": 0.6, "tolerance": 1e-2}
    against = microslip.solve(motion, contacts=AGAINST, **settings)
    assert against.converged and against.velocity > 10.0 * against.velocity_error
    for contacts in ("phase=0", "phase=0;phase=0"):
        together = microslip.solve(motion, contacts=contacts, **settings)
        assert "runs away" in together.reason and not together.converged


ASPERITIES = 40
DEPTHS = -np.log((np.arange(ASPERITIES) + 0.5) / ASPERITIES)
"""Depths of asperities with exponential heights, divided by the standard deviation."""


def rough(motion, velocity, amplitude):
    """Friction of these asperities, which have equal radii.  Velocity and amplitude are in the
    units of an asperity of depth 1."""
    loads = DEPTHS**1.5 / np.mean(DEPTHS**1.5)
    contacts = tuple(BodyContact(load=load) for load in loads)
    unit = np.mean(DEPTHS**1.5) ** (2.0 / 3.0)
    problem = Problem(motion_named(motion), velocity / unit, amplitude / unit, contacts=contacts)
    return microslip.solve(problem)


def mean_force_of_springs(velocity, amplitude, springs=200, steps=4_000):
    """Mean force of Mindlin's contact under a forward drift and oscillation, from sliders in series
    with springs.

    Mindlin's force is the integral of min(u, y) 3/4 (1 - y)^(-1/2) over the slip displacements y
    from 0 to 1.  With y = 1 - s^2, the density over s is constant, 3/2.
    """
    slip = 1.0 - ((np.arange(springs) + 0.5) / springs) ** 2
    phase = np.linspace(-0.5, 1.5, steps + 1) * np.pi
    change = np.diff(velocity * phase + amplitude * np.sin(phase))
    stretch, periods = np.zeros(springs), 2 + int(2.0 / (2.0 * np.pi * velocity))
    for _ in range(periods):
        forces = [1.5 * stretch.mean()]
        for step in change:
            stretch = np.clip(stretch + step, -slip, slip)
            forces.append(1.5 * stretch.mean())
    return np.trapezoid(forces) / steps


def test_the_friction_of_a_rough_contact_is_the_sum_over_its_asperities():
    """The static limit of exponential heights is exp(-A) (Greenwood and Williamson)."""
    weights = DEPTHS**1.5 / np.sum(DEPTHS**1.5)
    for amplitude in (0.2, 1.0):
        static = rough("longitudinal", 0.0, amplitude)
        mindlin = np.sum(weights * np.maximum(1.0 - amplitude / DEPTHS, 0.0) ** 1.5)
        assert static.mu_macro == pytest.approx(mindlin, abs=1e-9)
        assert static.mu_macro == pytest.approx(np.exp(-amplitude), abs=0.02)


@pytest.mark.slow
def test_a_sliding_rough_contact_is_the_sum_over_springs_with_sliders():
    weights = DEPTHS**1.5 / np.sum(DEPTHS**1.5)
    some = slice(2, None, 9)
    assert mean_force_of_springs(0.2, 1e-9) == pytest.approx(1.0, abs=1e-4)  # it slides everywhere
    for depth in DEPTHS[some]:
        alone = microslip.solve("longitudinal", 0.2 / depth, 0.8 / depth).mu_macro
        springs = mean_force_of_springs(0.2 / depth, 0.8 / depth)
        assert alone == pytest.approx(springs, abs=2e-4), depth
    each = [microslip.solve("longitudinal", 0.2 / d, 0.8 / d).mu_macro for d in DEPTHS]
    assert rough("longitudinal", 0.2, 0.8).mu_macro == pytest.approx(weights @ each, abs=1e-9)
