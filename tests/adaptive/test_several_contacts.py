"""Bodies on several contacts: what one contact knows, limits in closed form, and thresholds."""

import numpy as np
import pytest

import microslip
from microslip.foundation.errors import InputError
from microslip.models.driven_body import Body
from microslip.motions.body_contacts import contacts_of
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, contact_of, path_of
from microslip.theory import paper
from microslip.theory.drift import antiphase_drift

DRIVES = {
    "a velocity": {"velocity": 0.1},
    "a force": {"force": 0.3},
    "a spring": {"velocity": 0.1, "stiffness": 0.1},
    "a mass on a spring": {"velocity": 0.1, "stiffness": 0.1, "mass": 1.0, "damping": 0.1},
    "a mass": {"force": 0.3, "mass": 1.0},
}
AGAINST = "phase=0;phase=180"


def answer(found):
    """What was asked for, and its error."""
    if found.force is None:
        return found.mu_macro, found.mu_macro_error
    return found.velocity, found.velocity_error


@pytest.mark.slow
@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("contacts", ["phase=0", "phase=77", "load=5,phase=77;load=5,phase=77"])
def test_contacts_that_do_the_same_are_one(contacts, drive):
    """In the groups of the one that carries the mean load; when a period begins does not count."""
    (alone, error), (together, other) = (
        answer(microslip.solve("transverse", amplitude=1.5, **DRIVES[drive], **several))
        for several in ({}, {"contacts": contacts})
    )
    assert abs(alone - together) <= error + other
    if contacts == "phase=0":  # on the very same steps
        assert together == pytest.approx(alone, abs=1e-5)


@pytest.mark.slow
def test_a_contact_half_a_period_later_is_its_mirror_image_sideways():
    """Forward it does the same: what counts is that the two are not a quarter of one apart."""
    alone = microslip.solve("transverse", amplitude=1.5, force=0.3)
    against = microslip.solve("transverse", amplitude=1.5, force=0.3, contacts=AGAINST)
    across = microslip.solve("transverse", amplitude=1.5, force=0.3, contacts="phase=0;phase=90")
    assert abs(alone.velocity - against.velocity) <= alone.velocity_error + against.velocity_error
    assert alone.velocity - across.velocity > 10.0 * across.velocity_error


REAL = {"radius": "5 mm", "young": "70 GPa", "nu": 0.0, "mu": 0.3, "frequency": "100 Hz"}
MOVED = {
    "transverse": {"amplitude": "0.12 um", "speed": "10 um/s"},
    "bore": {"amplitude": "0.3 deg", "speed": "40 um/s"},
}


@pytest.mark.slow
@pytest.mark.parametrize("motion", MOVED)
def test_at_a_velocity_each_contact_is_alone(motion):
    """Spheres in SI units, each with its own u_lim: their forces add up, whatever their phases."""
    loads = (1.0, 4.0)
    each = [microslip.predict(motion, load=f"{load} N", **REAL, **MOVED[motion]) for load in loads]
    mean = microslip.predict(motion, load=f"{np.mean(loads)} N", **REAL, **MOVED[motion])
    contacts = f"load={loads[0]};load={loads[1]},phase=60"
    place = motion, mean.velocity, mean.amplitude
    found = microslip.solve(*place, contacts=contacts)
    force = sum(one.friction_force_N for one in each) / sum(loads) / 0.3
    assert found.converged
    # so that it counts which is which
    assert abs(each[0].mu_macro - each[1].mu_macro) > 0.03
    assert abs(found.mu_macro - force) <= found.mu_macro_error + 1e-3
    still = microslip.solve(motion, 0.0, mean.amplitude, contacts=contacts)
    static = sum(one.mu_static * load for one, load in zip(each, loads, strict=True)) / sum(loads)
    assert abs(still.mu_macro - static) <= still.mu_macro_error + 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["transverse", "longitudinal", "elliptic"])
@pytest.mark.parametrize("endless", [{"stiffness": 1e6}, {"stiffness": 0.1, "mass": 1e6}])
def test_what_does_not_give_way_has_the_friction_of_the_velocity(motion, endless):
    place, contacts = (motion, 0.1, 0.8), "load=2;load=1,phase=90;amplitude=0.5,phase=180"
    moved = microslip.solve(*place, contacts=contacts)
    pulled = microslip.solve(*place, contacts=contacts, **endless)
    assert moved.converged and pulled.converged
    assert abs(moved.mu_macro - pulled.mu_macro) <= moved.mu_macro_error + pulled.mu_macro_error


@pytest.mark.slow
@pytest.mark.parametrize("force", [0.1, 0.3, 0.7])
@pytest.mark.parametrize("amplitude", [0.5, pytest.param(1.0, marks=pytest.mark.long), 5.0])
def test_two_sliders_against_each_other_have_their_closed_form(amplitude, force):
    found = microslip.solve("longitudinal", amplitude=amplitude, force=force, contacts=AGAINST)
    assert found.converged
    assert abs(found.velocity - antiphase_drift(force, amplitude)) <= found.velocity_error


@pytest.mark.slow
def test_more_sliders_that_work_against_each_other_in_pairs_do_as_well():
    four = ";".join(["phase=0", "phase=180", "load=1,phase=180", "phase=360"])
    found = microslip.solve("longitudinal", amplitude=1.0, force=0.3, contacts=four)
    assert abs(found.velocity - antiphase_drift(0.3, 1.0)) <= found.velocity_error


def rigid_velocity(force, contacts, amplitude):
    """Mean of v(t) with sum of share v / sqrt(v^2 + w^2) = force at every instant."""
    phase = (np.arange(2000) + 0.5) * np.pi / 2000
    sideways = [amplitude * a * np.cos(phase + np.deg2rad(p)) for _, p, a in contacts]
    low, high = np.zeros_like(phase), np.full_like(phase, 100.0 * amplitude)
    for _ in range(100):
        middle = 0.5 * (low + high)
        friction = sum(
            share * middle / np.hypot(middle, w)
            for (share, _, _), w in zip(contacts, sideways, strict=True)
        )
        low, high = (
            np.where(friction < force, middle, low),
            np.where(friction < force, high, middle),
        )
    return middle.mean()


@pytest.mark.slow
def test_large_amplitudes_are_those_of_rigid_contacts():
    """What elasticity takes is some u_lim a period, whatever the amplitude."""
    contacts = "load=3;load=1,phase=90;load=2,phase=45,amplitude=2"
    shares = [(3 / 6, 0.0, 1.0), (1 / 6, 90.0, 1.0), (2 / 6, 45.0, 2.0)]
    lost = []
    for amplitude in (40.0, 160.0):
        found = microslip.solve(
            "transverse", amplitude=amplitude, force=0.4, contacts=contacts, tolerance=3e-3
        )
        assert found.converged
        rigid = rigid_velocity(0.4, shares, amplitude)
        lost.append((rigid - found.velocity) / rigid)
    assert 0.0 < lost[1] < 0.03
    assert lost[1] < 0.45 * lost[0]


UNEQUAL = "load=3;load=1,phase=45"
ITS_LOADS = (1.5, 0.5)
"""Over their mean."""


def unequal_limit(amplitude):
    """Each is as far from its own u_lim, which grows with the indentation: the load^(2/3)."""
    alone = [float(paper.static_limit_transverse(amplitude / x ** (2 / 3))) for x in ITS_LOADS]
    return float(np.dot(ITS_LOADS, alone)) / 2.0


@pytest.mark.slow
def test_the_threshold_of_a_body_is_the_mean_of_its_contacts():
    limit = unequal_limit(0.4)
    given = {"amplitude": 0.4, "contacts": UNEQUAL}
    below = microslip.solve("transverse", force=limit - 1e-5, **given)
    assert (below.velocity, below.velocity_error, below.converged) == (0.0, 0.0, True)
    above = microslip.solve("transverse", force=limit + 0.06, tolerance=3e-4, **given)
    assert above.converged
    assert above.velocity > 2.0 * above.velocity_error


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["transverse", "longitudinal"])
def test_below_the_threshold_a_body_comes_to_rest(motion):
    """Marched on its own: the way of a period dies away, and above the threshold it does not."""
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
        # ahead of a path that itself goes forward
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
    motion, given, contacts, expected = REFUSED[name]
    with pytest.raises(InputError) as refused:
        microslip.solve(motion, contacts=contacts, **given)
    assert (refused.value.argument, refused.value.value) == ("contacts", contacts)
    assert expected in refused.value.allowed


def test_contacts_that_do_not_vibrate_hold_as_much_as_can_be():
    """At a velocity a contact at rest resists with all of its share."""
    found = microslip.solve("transverse", 0.1, 1.0, contacts="load=2;load=1,amplitude=0")
    alone = microslip.solve("transverse", 0.1 / (4 / 3) ** (2 / 3), 1.0 / (4 / 3) ** (2 / 3))
    assert found.mu_macro == pytest.approx((2.0 * alone.mu_macro + 1.0) / 3.0, abs=1e-12)
    assert found.contacts == (
        "load=1.33333333333,phase=0,amplitude=1;load=0.666666666667,phase=0,amplitude=0"
    )
