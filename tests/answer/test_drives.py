"""Contacts under a force or on a spring: limits, thresholds, and comparison of models."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from stubs.agreement import assert_agree

import microslip
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Force, Problem
from microslip.theory import indenters, paper

CONE = pressure_named("power:exponent=1")
PLACES = {
    "bore": ("bore", 0.2, 1.0),
    "longitudinal": ("longitudinal", 0.1, 0.5),
    "loops": ("elliptic:forward_cycles=2", 0.2, 1.0),
}
ENDLESS = [{"stiffness": 1e6}, {"stiffness": 0.1, "mass": 1e6}]


@pytest.mark.slow
@pytest.mark.parametrize("body", [{"stiffness": 6e-4}, {"stiffness": 1.0, "mass": 0.3}])
def test_a_fast_contact_on_a_spring_has_the_friction_of_the_energy_bound(body):
    """The bound does not depend on Poisson's ratio, so that rings at ratio 0 can check it."""
    place = ("transverse", 9.24, 0.871)
    result = microslip.solve(*place, **body, poisson=0.3, tolerance=1e-2, time_limit=1.0)
    assert result.converged and result.model == "closed-form"
    assert result.mu_macro + result.mu_macro_error == pytest.approx(1.0, abs=1e-9)
    assert result.mu_macro_error < 0.5 / (9.24 / 0.871) ** 2
    marched = microslip.solve(*place, **body, model="radial", tolerance=1e-3)
    assert_agree(result, marched)


@pytest.mark.slow
@pytest.mark.parametrize("body", ENDLESS, ids=str)
@pytest.mark.parametrize("place", PLACES)
def test_what_does_not_give_way_has_the_friction_of_the_velocity(place, body):
    at_velocity = microslip.solve(*PLACES[place])
    under_force = microslip.solve(*PLACES[place], **body)
    assert_agree(at_velocity, under_force)
    assert abs(at_velocity.mu_macro - under_force.mu_macro) < 1.5e-3


@pytest.mark.slow
def test_the_softest_spring_is_a_force():
    """A very soft spring exerts a constant force, under which the contact has the same velocity.

    The velocity rises with the force, so the ends of the error interval of the force enclose it.
    """
    velocity, amplitude = 0.1, 1.0
    soft = microslip.solve("transverse", velocity, amplitude, stiffness=1e-5)
    assert soft.converged
    ends = soft.mu_macro - soft.mu_macro_error, soft.mu_macro + soft.mu_macro_error
    slow, fast = (microslip.solve("transverse", amplitude=amplitude, force=one) for one in ends)
    assert slow.converged and fast.converged
    assert slow.velocity - slow.velocity_error <= velocity <= fast.velocity + fast.velocity_error
    assert fast.velocity - slow.velocity < 0.05 * velocity


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "amplitude", "pressure", "limit"),
    [
        ("bore", 1.0, HERTZ, paper.static_limit_bore(1.0)),
        ("transverse", 0.5, CONE, indenters.static_transverse(CONE, 0.5)),
    ],
)
def test_the_threshold_is_the_static_limit(motion, amplitude, pressure, limit):
    place, limit = {"amplitude": amplitude, "pressure": pressure}, float(limit)
    below = microslip.solve(motion, **place, force=limit - 1e-5)
    assert (below.velocity, below.velocity_error, below.converged) == (0.0, 0.0, True)
    assert below.mu_macro == limit - 1e-5
    above = microslip.solve(motion, **place, force=limit + 0.08, tolerance=3e-4)
    assert above.converged
    assert above.velocity > 2.0 * above.velocity_error


@pytest.mark.parametrize("mass", [0.0, 1.0])
def test_a_contact_under_less_than_the_limit_comes_to_rest(mass):
    """A run from a moving start confirms the result that solve gives without a run."""

    def velocity(force):
        drive = Force(force, mass=mass)
        problem = Problem(motion_named("transverse"), 0.01, 0.5, drive=drive)
        result = simulate(problem, "radial", Resolution(24, 1, 64), 1e-5)
        assert result.converged
        return result.values["velocity"]

    limit = float(paper.static_limit_transverse(0.5))
    assert abs(velocity(limit - 0.03)) < 1e-5
    assert velocity(limit + 0.05) > 1e-3


def test_without_mass_only_what_is_across_the_force_counts():
    """The body follows the forward part of the ellipse; the rest is the transverse motion."""
    loop = microslip.solve("elliptic:phase=37", amplitude=1.5, force=0.3)
    line = microslip.solve("transverse", amplitude=1.5, force=0.3)
    assert_agree(loop, line)


@pytest.mark.parametrize(
    ("motion", "force", "amplitudes", "drift", "near"),
    [
        ("transverse", 0.3, (50.0, 400.0), paper.transverse_drift, 0.004),
        ("bore", 0.5, (15.0, 60.0), paper.bore_drift, 0.02),
    ],
)
def test_large_amplitudes_are_those_of_a_rigid_contact(motion, force, amplitudes, drift, near):
    result = [microslip.solve(motion, amplitude=one, force=force) for one in amplitudes]
    rigid = [drift(force, one) for one in amplitudes]
    left = [abs(one.velocity / exact - 1.0) for one, exact in zip(result, rigid, strict=True)]
    assert all(one.converged for one in result)
    assert left[1] < near and left[1] < 0.4 * left[0]


def test_a_force_on_a_steady_bore_inverts_equation_21():
    result = microslip.solve("continuous-bore", force=0.6)
    assert paper.bore_forward(result.velocity) == pytest.approx(0.6, abs=1e-9)
    # 1 - 0.1 / v^2, the series of Eq 21 for fast sliding
    fast = microslip.solve("continuous-bore", force=1.0 - 1e-6)
    assert fast.velocity == pytest.approx(np.sqrt(0.1e6), rel=1e-5)
    cone = microslip.solve("continuous-bore", force=0.6, pressure="power:exponent=1")
    back = microslip.solve("continuous-bore", cone.velocity, pressure="power:exponent=1")
    assert back.mu_macro == pytest.approx(0.6, abs=1e-9)
    spring = microslip.solve("continuous-bore", 0.3, stiffness=0.1, mass=2.0)
    assert spring.mu_macro == microslip.solve("continuous-bore", 0.3).mu_macro


# A period that begins without contact, and a body without memory


def springs_on_a_spring(velocity, amplitude, stiffness, count, steps):
    """Mean force over mean load of independent springs on a soft spring (exact at nu = 0).

    The spring at x can carry the overlap d - x^2 with the sphere.  The load d^(3/2) oscillates; it
    is 0 at the start, where the soft spring is relaxed.
    """
    widest = (1.0 + amplitude) ** (1.0 / 3.0)
    edges = np.linspace(0.0, widest, count + 1)
    x, width = 0.5 * (edges[1:] + edges[:-1]), 1.5 * np.diff(edges)
    phase = np.linspace(-0.5 * np.pi, 1.5 * np.pi, steps + 1)
    load = np.maximum(1.0 + amplitude * np.sin(phase), 0.0)
    stretch, place, force = np.zeros(count), velocity * phase[0], np.zeros(steps + 1)
    for k in range(1, steps + 1):
        overlap = np.maximum(load[k] ** (2.0 / 3.0) - x**2, 0.0)

        def stretch_at(step, k=k, stretch=stretch, overlap=overlap):
            return np.clip(stretch + step, -overlap, overlap)

        def imbalance(step, k=k, place=place, stretch_at=stretch_at):
            return stretch_at(step) @ width - stiffness * (velocity * phase[k] - place - step)

        step = brentq(imbalance, -10.0, 10.0, xtol=1e-12)
        stretch, place = stretch_at(step), place + step
        force[k] = stretch @ width
    return force[:-1].mean() / load[:-1].mean()


def test_a_soft_spring_pulls_a_contact_that_lifts_off():
    result = microslip.solve("normal", 0.4, 1.35, stiffness=0.05)
    expected = springs_on_a_spring(0.4, 1.35, 0.05, 400, 1000)  # 0.03288 with 1600 and 4000
    assert result.converged
    assert abs(result.mu_macro - expected) <= result.mu_macro_error


@pytest.mark.slow
def test_a_soft_spring_pulls_a_contact_that_lifts_off_and_oscillates_sideways():
    """With a small dashpot the state includes the body, and the force hardly changes."""
    place, dashpot = ("normal:lateral=0.9,phase=90", 0.15, 1.3), 1e-4
    free = microslip.solve(*place, stiffness=0.3)
    held = microslip.solve(*place, stiffness=0.3, damping=dashpot)
    assert_agree(free, held)


@pytest.mark.parametrize(
    ("motion", "force", "reason"),
    [
        *(("transverse", force, "runs away: the force") for force in (1.0, 1.7)),
        ("normal:lateral=1", 0.6, "runs away: without mass"),
        ("normal", 0.99999, "runs away: without mass"),
        # the least load 0.5^(3/2) is 0.338 of the mean load
        ("normal:indentation=1", 0.345, "runs away: without mass"),
    ],
)
def test_what_runs_away_says_so(motion, force, reason):
    result = microslip.solve(motion, amplitude=0.5, force=force)
    assert not result.converged and math.isnan(result.velocity)
    assert result.reason.startswith(reason)


def test_a_body_that_goes_along_with_its_contact_stays_under_any_force():
    assert microslip.solve("longitudinal", amplitude=0.5, force=0.99999).velocity == 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mass", "imposed"), [(1e-8, {}), (0.001453, {"cells": 12, "steps": 48})], ids=str
)
def test_a_mass_too_light_for_the_steps_is_not_converged(mass, imposed):
    place = {"amplitude": 2.356, "force": 0.8082, "tolerance": 1e-2}
    result = microslip.solve("zigzag", **place, mass=mass, **imposed)
    assert not result.converged and result.reason.startswith("mass too small")


def test_the_error_of_the_static_limit_is_part_of_the_answer():
    """If it is uncertain whether the contact moves, the error interval of the velocity includes
    0."""
    limit = microslip.solve("transverse", 0.0, 0.5, model="radial")
    assert limit.mu_macro_error > 1e-6
    result = microslip.solve("transverse", amplitude=0.5, force=limit.mu_macro, model="radial")
    assert result.converged
    assert result.velocity - result.velocity_error <= 0.0 <= result.velocity
    assert result.mean_velocity.by_source["model"] > 0.0
