"""Self-propelled motions: rigid limits, energy balances, and negative velocities."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import microslip
from microslip.contact.contact import FORWARD, forward_slip
from microslip.contact.path import make_path, phases_between
from microslip.foundation.number_text import number_text
from microslip.periodic.discretise import Resolution, contact_of
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

EIGHT = "elliptic:forward_cycles=2,phase=0"


def rigid_eight(velocity):
    """Friction of a rigid contact on a figure of eight of amplitude 1."""

    def forward(t):
        ahead, aside = velocity + 2.0 * np.cos(2.0 * t), np.cos(t)
        return ahead / np.hypot(ahead, aside)

    inside = np.linspace(0.0, 2.0 * np.pi, 9)[1:-1]
    return quad(forward, 0.0, 2.0 * np.pi, points=inside, limit=400)[0] / (2.0 * np.pi)


def rigid_pressed(velocity, reach, load):
    """Friction of a rigid contact under a load 1 + load sin(t), with the forward rate -reach
    sin(t).

    The contact slides forward while sin(t) < velocity / reach.
    """
    share = velocity / reach
    return 2.0 / np.pi * (np.arcsin(share) - load * np.sqrt(1.0 - share**2))


@pytest.mark.slow
def test_a_rigid_contact_on_an_eight():
    stall = rigid_eight(0.0)
    fastest = brentq(rigid_eight, 0.0, 2.0)
    sign = -1.0 if stall > 0.0 else 1.0
    motion = EIGHT if sign > 0.0 else "elliptic:forward_cycles=2,phase=180"
    line = microslip.propulsion(motion, 1.0, model="rigid")
    assert line.converged, line.reason
    assert abs(line.stall_force + stall) <= line.stall_force_error
    assert abs(line.no_load_velocity - fastest) <= line.no_load_velocity_error


@pytest.mark.slow
def test_a_stiff_contact_under_an_oscillating_load_in_closed_form():
    """The path is forty times u_lim, and an elastic contact lags by about one u_lim."""
    line = microslip.propulsion("normal:forward=1,load=0.0125,phase=90", 40.0)
    assert line.converged, line.reason
    late = 2.0 / 40.0  # u_lim lost at each of two turns, over a half stroke
    assert line.stall_force == pytest.approx(-rigid_pressed(0.0, 40.0, 0.5), abs=late)
    fastest = brentq(lambda v: rigid_pressed(v, 40.0, 0.5), 0.0, 40.0)
    assert line.no_load_velocity == pytest.approx(fastest, rel=2.0 * late)


@pytest.mark.slow
def test_no_load_by_a_heavy_body_without_a_force():
    """A very heavy body without a force moves at the no-load velocity."""
    line = microslip.propulsion(EIGHT, 1.0)
    free = microslip.solve(EIGHT, amplitude=1.0, force=0.0, mass=1e3)
    assert free.converged
    swing = 1e-3  # oscillation of the velocity of the body
    errors = line.no_load_velocity_error + free.velocity_error
    assert abs(free.velocity - line.no_load_velocity) <= errors + swing


def test_marched_back_without_a_mirror():
    """A plain march on a backward path, from the stress-free contact."""
    velocity, phases = -0.3, phases_between((-0.5 * np.pi, 0.5 * np.pi, 1.5 * np.pi), 64)
    problem = Problem(motion_named("elliptic:forward_cycles=2,phase=20"), 0.3, 1.0, 0.0)
    contact = contact_of(problem, "radial", Resolution(24, 1, 64))
    path = make_path(replace(problem, velocity=velocity).displacement, phases)
    state = 0.0 * forward_slip(contact)
    for _ in range(4):
        march = contact.march(path, state, 1e-8)
        state = march.state
    result = microslip.solve(problem.motion.name, velocity, 1.0)
    mean = float((path.weights @ march.forces)[FORWARD])
    # 1e-3: discretisation error of the march
    assert abs(result.mu_macro - mean) <= result.mu_macro_error + 1e-3


@pytest.mark.slow
def test_a_small_oscillation_propels_nothing():
    """The holding forces are the static limits of the motion and of its mirror image."""
    result = microslip.propulsion(EIGHT, 0.5, tolerance=1e-2)
    assert result.converged and result.reason.startswith("propels nothing: friction holds")
    assert result.stall_force == result.no_load_velocity == 0.0
    ahead = microslip.solve(EIGHT, 0.0, 0.5, tolerance=1e-2)
    back = microslip.solve("elliptic:forward_cycles=2,phase=180", 0.0, 0.5, tolerance=1e-2)
    assert number_text(-back.mu_macro, back.mu_macro_error) in result.reason
    assert number_text(ahead.mu_macro, ahead.mu_macro_error) in result.reason


@pytest.mark.parametrize(
    ("bound", "reason"),
    [
        ({"time_limit": 1e-9}, "the time limit of 1e-09 s is over"),
        ({"most_work": 1e3}, "the work that the point may take, 1e+03, is spent"),
    ],
    ids=str,
)
def test_a_search_that_would_take_too_long_ends(bound, reason):
    result = microslip.propulsion(EIGHT, 1.0, **bound)
    assert not result.converged and reason in result.reason
    assert np.isinf(result.stall_force_error) and np.isinf(result.no_load_velocity_error)
