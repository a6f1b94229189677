"""Self-propelled motions: rigid limits, energy balances, and negative velocities."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import microslip
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.models.contact import FORWARD, forward_slip
from microslip.models.path import make_path, phases_between
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.discretise import Resolution, contact_of

EIGHT = "elliptic:forward_cycles=2,phase=0"


def rigid_eight(velocity):
    """Friction and power in of a rigid contact on a figure of eight of amplitude 1."""

    def rates(t):
        return 2.0 * np.cos(2.0 * t), np.cos(t)

    def forward(t):
        ahead, aside = rates(t)
        return (velocity + ahead) / np.hypot(velocity + ahead, aside)

    def work(t):
        ahead, aside = rates(t)
        return (ahead * (velocity + ahead) + aside**2) / np.hypot(velocity + ahead, aside)

    inside = np.linspace(0.0, 2.0 * np.pi, 9)[1:-1]
    return tuple(
        quad(part, 0.0, 2.0 * np.pi, points=inside, limit=400)[0] / (2.0 * np.pi)
        for part in (forward, work)
    )


def rigid_pressed(velocity, reach, load):
    """Friction of a rigid contact under a load 1 + load sin(t), with the forward rate -reach
    sin(t).

    The contact slides forward while sin(t) < velocity / reach.
    """
    share = velocity / reach
    return 2.0 / np.pi * (np.arcsin(share) - load * np.sqrt(1.0 - share**2))


@pytest.mark.slow
def test_a_rigid_contact_on_an_eight():
    stall, _ = rigid_eight(0.0)
    fastest = brentq(lambda v: rigid_eight(v)[0], 0.0, 2.0)
    sign = -1.0 if stall > 0.0 else 1.0
    motion = EIGHT if sign > 0.0 else "elliptic:forward_cycles=2,phase=180"
    line = microslip.propulsion(motion, 1.0, model="rigid", points=5)
    assert line.converged, line.reason
    assert abs(line.stall_force + stall) <= line.stall_force_error
    assert abs(line.no_load_velocity - fastest) <= line.no_load_velocity_error
    for index, velocity in enumerate(line.velocity):
        friction, power = rigid_eight(velocity)
        assert abs(line.force[index] + friction) <= line.force_error[index]
        assert abs(line.power_in[index] - power) <= line.power_in_error[index]


@pytest.mark.slow
def test_a_stiff_contact_under_an_oscillating_load_in_closed_form():
    """The path is forty times u_lim, and an elastic contact lags by about one u_lim."""
    line = microslip.propulsion("normal:forward=1,load=0.0125,phase=90", 40.0, points=3)
    assert line.converged, line.reason
    late = 2.0 / 40.0  # u_lim lost at each of two turns, over a half stroke
    assert line.stall_force == pytest.approx(-rigid_pressed(0.0, 40.0, 0.5), abs=late)
    fastest = brentq(lambda v: rigid_pressed(v, 40.0, 0.5), 0.0, 40.0)
    assert line.no_load_velocity == pytest.approx(fastest, rel=2.0 * late)


@pytest.mark.slow
def test_no_load_by_a_heavy_body_without_a_force():
    """A very heavy body without a force moves at the no-load velocity."""
    line = microslip.propulsion(EIGHT, 1.0, points=2)
    free = microslip.solve(EIGHT, amplitude=1.0, force=0.0, mass=1e3)
    assert free.converged
    swing = 1e-3  # oscillation of the velocity of the body
    errors = line.no_load_velocity_error + free.velocity_error
    assert abs(free.velocity - line.no_load_velocity) <= errors + swing


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "amplitude"),
    [(EIGHT, 1.0), pytest.param("normal:forward=1,phase=225", 0.8, marks=pytest.mark.long)],
)
def test_what_goes_in_and_not_out_is_dissipated(motion, amplitude):
    """The dissipation is slip times traction, summed over the points of another model."""
    line = microslip.propulsion(motion, amplitude, points=3)
    assert line.converged, line.reason
    velocity = float(line.velocity[1])
    there = microslip.period(motion, velocity, amplitude, cells=16, angles=4, steps=256)
    slip = np.array([there.slip_forward, there.slip_lateral])[:, 1:]
    traction = np.array([there.traction_forward, there.traction_lateral])[:, 1:]
    dissipated = float(np.sum(there.area * traction * slip)) / (2.0 * np.pi)
    lost = line.power_in[1] - line.power_out[1]
    assert dissipated == pytest.approx(lost, rel=0.02)
    assert np.all(line.power_in - line.power_out > 0.0)
    assert np.all(line.efficiency < 1.0) and line.efficiency[1] > 0.0
    # the power out is not negligible
    assert line.power_out[1] > 0.01 * lost


@pytest.mark.parametrize("amplitude", [0.9, 1.5])  # 1.5: contact is lost
def test_an_oscillating_load_does_no_work_over_a_period(amplitude):
    """The sum of the work over a period vanishes, compared with the sum of its absolute values."""
    motion = motion_named("normal:indentation=1,load=1,forward=1,phase=40")
    depth = motion.depth(np.linspace(0.0, 2.0 * np.pi, 20001), amplitude, HERTZ)
    load = HERTZ.total(depth)
    middle = 0.5 * (load[1:] + load[:-1])
    work = middle * np.diff(depth)
    assert abs(work.sum()) < 1e-9 * np.abs(work).sum()
    assert np.abs(work).sum() > 1.0


@pytest.mark.long
def test_two_models_drive_alike():
    """At nu = 0 the radial and the polar model describe the same contact."""
    rings, modes = (
        microslip.propulsion(EIGHT, 1.0, model=model, tolerance=1e-2, points=3)
        for model in ("radial", "polar")
    )
    errors = rings.no_load_velocity_error + modes.no_load_velocity_error
    assert abs(rings.no_load_velocity - modes.no_load_velocity) <= errors
    for name in ("force", "power_in", "efficiency"):
        one, other = getattr(rings, name), getattr(modes, name)
        allowed = getattr(rings, f"{name}_error") + getattr(modes, f"{name}_error")
        # the velocities of the two lines differ by their errors
        assert np.all(np.abs(one - other) <= allowed + errors)


@pytest.mark.slow
def test_stall_is_the_limit_of_slow_velocities():
    line = microslip.propulsion(EIGHT, 1.2, points=2)
    slow = [-microslip.solve(EIGHT, v, 1.2).mu_macro for v in (4e-3, 1e-3)]
    assert line.stall_force > slow[1] > slow[0]
    assert slow[1] == pytest.approx(line.stall_force, abs=3e-3)


@pytest.mark.long
def test_a_reversed_loop_drives_backward():
    ahead = microslip.propulsion("elliptic:forward_cycles=2,phase=20", 1.0, points=4)
    back = microslip.propulsion("elliptic:forward_cycles=2,phase=200", 1.0, points=4)
    assert ahead.stall_force > 0.0 > back.stall_force
    errors = ahead.stall_force_error + back.stall_force_error
    assert abs(ahead.stall_force + back.stall_force) <= errors
    errors = ahead.no_load_velocity_error + back.no_load_velocity_error
    assert abs(ahead.no_load_velocity + back.no_load_velocity) <= errors
    assert np.all(back.velocity <= 0.0) and np.all(back.power_out >= -back.power_out_error)


@pytest.mark.slow
def test_friction_grows_through_zero_velocity():
    """At negative velocities the contact resists more than at the stall."""
    force = [microslip.solve(EIGHT, v, 1.0).mu_macro for v in (-0.5, -0.1, 0.1, 0.5)]
    assert np.all(np.diff(force) > 0.0)
    assert force[0] < -microslip.propulsion(EIGHT, 1.0, points=2).stall_force
    fast = microslip.solve(EIGHT, -3.0, 0.1)
    assert fast.mu_macro == pytest.approx(-1.0, abs=1e-2)


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
    mean = float(path.mean(march.forces)[FORWARD])
    # 1e-3: discretisation error of the march
    assert abs(result.mu_macro - mean) <= result.mu_macro_error + 1e-3


def test_a_rigid_contact_pushed_back():
    result = microslip.solve(EIGHT, -0.7, 1.0, model="rigid")
    assert abs(result.mu_macro - rigid_eight(-0.7)[0]) <= result.mu_macro_error
    assert result.velocity == -0.7


@pytest.mark.slow
def test_the_holding_forces_have_errors_and_the_digits_that_these_allow():
    """The holding forces are the static limits of the motion and of its mirror image.

    The figure of eight with a phase of 180 degrees is the mirror image.
    """
    line = microslip.propulsion(EIGHT, 0.5, tolerance=1e-2)
    assert line.converged and line.reason.startswith("propels nothing: friction holds")
    assert line.stall_force == line.no_load_velocity == 0.0
    assert line.velocity.size == line.efficiency.size == 0
    mirrored = "elliptic:forward_cycles=2,phase=180"
    for name, motion, sign in (("low", mirrored, -1.0), ("high", EIGHT, 1.0)):
        finer = microslip.solve(motion, 0.0, 0.5, tolerance=2e-3)
        force = getattr(line, f"holding_force_{name}")
        error = getattr(line, f"holding_force_{name}_error")
        assert 0.0 < error <= 1e-2
        assert abs(force - sign * finer.mu_macro) <= error + finer.mu_macro_error
        assert number_text(force, error) in line.reason


def test_a_motion_that_drives_has_no_holding_forces():
    line = microslip.propulsion(EIGHT, 1.0, model="rigid", points=2, tolerance=1e-2)
    assert line.stall_force != 0.0
    assert line.holding_force_low is line.holding_force_high is None


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("transverse", 1.0), "motion = 'transverse': allowed is a self-propelled motion"),
        (("elliptic", 1.0), "motion = 'elliptic': allowed is a self-propelled motion"),
        # the motion is symmetric under half the common period
        (("elliptic:lateral=0.8,lateral_cycles=2,phase=70", 1.7), "a self-propelled motion"),
        (("elliptic:forward_cycles=6,lateral_cycles=2,phase=30", 1.0), "a self-propelled motion"),
        (("normal:forward=1,normal_cycles=2", 1.0), "a self-propelled motion"),
        (("normal:forward=1,lateral=1,lateral_cycles=2,normal_cycles=4", 1.0), "self-propelled"),
        ((EIGHT, 0.0), "amplitude = 0.0: allowed is a number above 0"),
        ((EIGHT, -1.0), "amplitude = -1.0"),
        ((EIGHT, None), "amplitude = None"),
    ],
)
def test_what_does_not_drive_is_refused(arguments, named):
    with pytest.raises(InputError, match=named):
        microslip.propulsion(*arguments)


def test_points_and_tolerance_are_checked():
    with pytest.raises(InputError, match="points = 1: "):
        microslip.propulsion(EIGHT, 1.0, points=1)
    with pytest.raises(InputError, match="tolerance = None: "):
        microslip.propulsion(EIGHT, 1.0, tolerance=None)


@pytest.mark.parametrize("motion", ["transverse", "bore", "elliptic"])
def test_what_is_odd_in_the_velocity_is_not_asked_for_below_zero(motion):
    with pytest.raises(InputError, match="velocity = -0.1: allowed is a finite number of at least"):
        microslip.solve(motion, -0.1, 1.0)


def test_a_line_that_would_take_too_long_is_given_up():
    """A line without any estimate has no points, and its reason names the exceeded limit."""
    late = microslip.propulsion(EIGHT, 1.0, points=3, time_limit=1e-9)
    assert not late.converged and len(late.velocity) == 0
    assert "the time limit of 1e-09 s is over" in late.reason
    idle = microslip.propulsion(EIGHT, 1.0, points=3, most_work=1e3)
    assert not idle.converged
    assert "the work that the point may take, 1e+03, is spent" in idle.reason
    assert np.isinf(idle.stall_force_error) and np.isinf(late.no_load_velocity_error)
    for bound in ("most_work", "time_limit"):
        with pytest.raises(InputError, match=f"{bound} = 0: allowed is a number above 0"):
            microslip.propulsion(EIGHT, 1.0, **{bound: 0})


@pytest.mark.slow
def test_a_line_within_its_bounds_is_the_same():
    free, bound = (
        microslip.propulsion(EIGHT, 1.0, tolerance=1e-2, points=3, **settings).to_dict()
        for settings in ({}, {"most_work": 1e12, "time_limit": 1e6})
    )
    free.pop("solve_time_s"), bound.pop("solve_time_s")
    assert free == bound
