"""Coupled contacts that turn, at nu > 0, of any shape or under a load that oscillates."""

import numpy as np
import pytest

import microslip
from microslip.theory import paper

AGAINST = "phase=0;phase=180"
SPRING = {"velocity": 0.2, "stiffness": 0.1, "mass": 1.0}
COARSE = {"cells": 8, "steps": 24, "tolerance": None}
ALONE = {
    "turning under a force": ("bore", {"amplitude": 1.5, "force": 0.4}),
    "turning on a spring": ("bore", {"amplitude": 1.5} | SPRING),
    "at nu > 0": ("transverse", {"amplitude": 1.5, "force": 0.3, "poisson": 0.3}),
    "a load that oscillates": (
        "normal:lateral=1",
        {"amplitude": 0.6, "velocity": 0.3, "stiffness": 0.1, "tolerance": 1e-2},
    ),
    "a load that oscillates, turning": (
        "normal:angle=1",
        {"amplitude": 0.6, "velocity": 0.3, "stiffness": 0.3, "tolerance": 1e-2},
    ),
    "no axis of symmetry": (
        "transverse",
        {"amplitude": 1.5, "force": 0.3, "pressure": "ellipse:ratio=0.5"} | COARSE,
    ),
}
LONG = ("turning on a spring", "a load that oscillates, turning", "no axis of symmetry")
ONCE = {"phase=0": 1e-5, "phase=30;load=1,phase=30": None}


def answer(found):
    """What was asked for, and its error."""
    if found.force is None:
        return found.mu_macro, found.mu_macro_error
    return found.velocity, found.velocity_error


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.long if n in LONG else ()) for n in ALONE]
)
@pytest.mark.parametrize("contacts", ONCE)
def test_contacts_that_do_the_same_are_one(contacts, name):
    """When a period begins does not count; from the same start on, steps are the very same."""
    motion, given = ALONE[name]
    alone, error = answer(microslip.solve(motion, **given))
    together, other = answer(microslip.solve(motion, contacts=contacts, **given))
    assert abs(alone - together) <= (ONCE[contacts] or error + other)
    assert alone > 0.05  # and so it moves


@pytest.mark.slow
@pytest.mark.parametrize("endless", [{"stiffness": 1e6}, {"stiffness": 0.1, "mass": 1e6}])
@pytest.mark.parametrize(
    "motion, contacts, given",
    [
        pytest.param("bore", "load=2;load=1,phase=90", {}, marks=pytest.mark.long),
        ("elliptic", "load=2;amplitude=0.5,phase=90", {"poisson": 0.3, "tolerance": 1e-2}),
        ("normal:lateral=1,phase=40", "phase=0;amplitude=0.5,phase=90", {"tolerance": 1e-2}),
    ],
)
def test_what_does_not_give_way_has_the_friction_of_the_velocity(motion, contacts, given, endless):
    """That is the mean over contacts each of which is alone, weighted with their loads."""
    place = {"velocity": 0.2, "amplitude": 0.8, "contacts": contacts} | given
    moved = microslip.solve(motion, **place)
    pulled = microslip.solve(motion, **place, **endless)
    assert moved.converged and pulled.converged
    assert abs(moved.mu_macro - pulled.mu_macro) <= moved.mu_macro_error + pulled.mu_macro_error


@pytest.mark.slow
def test_contacts_whose_loads_differ_in_time_are_weighted_with_them():
    """At a velocity far above that of the oscillation friction is all there can be, and else that
    of each under its own mean load."""
    motion, each = "normal:indentation=1,lateral=1", []
    for amplitude in (0.8, 0.4):
        found = microslip.solve(motion, 0.3, amplitude, tolerance=1e-2)
        # the load goes with the power 3/2 of the indentation
        phase = (np.arange(4000) + 0.5) * 2.0 * np.pi / 4000
        each.append((found.mu_macro, np.mean((1.0 + amplitude * np.sin(phase)) ** 1.5)))
    both = microslip.solve(motion, 0.3, 0.8, contacts="phase=0;amplitude=0.5", tolerance=1e-2)
    expected = sum(mu * load for mu, load in each) / sum(load for _, load in each)
    assert abs(each[0][0] - each[1][0]) > 0.1
    assert both.mu_macro == pytest.approx(expected, abs=1e-4)


@pytest.mark.slow
def test_the_threshold_of_contacts_that_turn_is_the_mean_of_their_static_limits():
    """Of spheres: u_lim over the radius of the contact goes with the load^(1/3)."""
    loads = (1.5, 0.5)
    alone = [float(paper.static_limit_bore(0.8 / load ** (1 / 3))) for load in loads]
    limit = float(np.dot(loads, alone)) / 2.0
    assert abs(alone[0] - alone[1]) > 0.1
    given = {"amplitude": 0.8, "contacts": "load=3;load=1,phase=45"}
    below = microslip.solve("bore", force=limit - 2e-3, **given)
    assert (below.velocity, below.velocity_error, below.converged) == (0.0, 0.0, True)
    above = microslip.solve("bore", force=limit + 0.1, **given)
    assert above.converged
    assert above.velocity > 2.0 * above.velocity_error


@pytest.mark.long
def test_large_turns_are_those_of_rigid_contacts():
    """At every instant Eq 21 of each, at the velocity over its own speed of rotation."""
    shares, leads, force = (0.75, 0.25), (0.0, np.deg2rad(60.0)), 0.4
    radii = [(2.0 * share) ** (1 / 3) for share in shares]  # of the contacts, over the mean one's
    phase = (np.arange(400) + 0.5) * np.pi / 400
    # the rotation of all is the same angle in time but for its phase
    spins = [
        radius * np.abs(np.cos(phase + lead)) for radius, lead in zip(radii, leads, strict=True)
    ]
    low, high = np.zeros_like(phase), np.full_like(phase, 10.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        friction = sum(
            share
            * np.array(
                [float(paper.bore_forward(v / s)) for v, s in zip(middle, spin, strict=True)]
            )
            for share, spin in zip(shares, spins, strict=True)
        )
        low, high = (
            np.where(friction < force, middle, low),
            np.where(friction < force, high, middle),
        )
    rigid, lost = float(middle.mean()), []
    for amplitude in (10.0, 40.0):
        found = microslip.solve(
            "bore",
            amplitude=amplitude,
            force=force,
            contacts="load=3;load=1,phase=60",
            tolerance=1e-2,
        )
        assert found.converged
        lost.append((rigid - found.velocity) / rigid)
    assert 0.0 < lost[1] < 0.1
    assert lost[1] < 0.5 * lost[0]


@pytest.mark.long
@pytest.mark.parametrize("drive", [{"force": 0.3}, SPRING], ids=["force", "spring"])
def test_rings_angles_and_squares_agree_without_coupling_of_directions(drive):
    given = {"amplitude": 1.5, "contacts": "load=2;load=1,phase=90"} | drive
    rings = microslip.solve("transverse", **given)
    angles = microslip.solve("transverse", model="polar", tolerance=3e-3, **given)
    squares = microslip.solve(
        "transverse", model="cartesian", cells=12, steps=32, tolerance=None, **given
    )
    for other in (angles, squares):
        assert abs(answer(rings)[0] - answer(other)[0]) <= answer(rings)[1] + answer(other)[1]
        assert answer(other)[1] < 0.02


@pytest.mark.long
def test_angles_and_squares_agree_on_contacts_that_turn():
    given = {"amplitude": 1.5, "force": 0.4, "contacts": "load=2;load=1,phase=90", "poisson": 0.3}
    angles = microslip.solve("bore", tolerance=3e-3, **given)
    squares = microslip.solve(
        "bore", model="cartesian", cells=12, steps=32, tolerance=None, **given
    )
    assert abs(angles.velocity - squares.velocity) <= angles.velocity_error + squares.velocity_error
    assert squares.velocity_error < 0.02


@pytest.mark.slow
def test_loads_in_antiphase_let_a_body_walk_that_two_in_phase_hold():
    """While one is pressed less the other is pressed more: on both the load never falls, so that a
    force slides off neither, and what is pressed drags it along."""
    motion, given = "normal:lateral=1", {"amplitude": 0.6, "force": 0.6, "tolerance": 1e-2}
    against = microslip.solve(motion, contacts=AGAINST, **given)
    assert against.converged and against.velocity > 10.0 * against.velocity_error
    for contacts in ("phase=0", "phase=0;phase=0"):
        together = microslip.solve(motion, contacts=contacts, **given)
        assert "runs away" in together.reason and not together.converged
