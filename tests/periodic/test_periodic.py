"""The accelerated search for the periodic state against a plain march until nothing changes."""

import numpy as np
import pytest

from microslip.contact.contact import energy_norm, forward_slip
from microslip.contact.path import make_path
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.search import Goal, find_periodic_state
from microslip.periodic.simulate import simulate
from microslip.scene.named import Bore, Transverse
from microslip.scene.problem import Force, Problem, Spring
from microslip.theory import paper

TOLERANCE = 1e-5
STEP_TOLERANCE = 1e-3 * TOLERANCE  # as in simulate
STEPS = 12

CASES = {
    "slider": ("slider", Transverse(), 0.0, 1, 1),
    "radial": ("radial", Transverse(), 0.0, 8, 1),
    "polar, translation": ("polar", Transverse(), 0.3, 5, 4),
    "polar, rotation": ("polar", Bore(), 0.0, 5, 4),
    "cartesian": ("cartesian", Bore(), 0.3, 6, 1),
}
"""Model, motion, nu, cells and angles of each case."""
SLOW, FAST = (0.1, 1.0), (1.0, 0.5)
POINTS = {
    "slider": [(1.0, 2.0), (0.005, 0.8)],
    "radial": [FAST, SLOW, (0.02, 2.0), (0.005, 0.5), (1e-3, 0.2)],
    "polar, translation": [SLOW, (0.02, 0.5), (0.005, 0.2)],
    "polar, rotation": [SLOW, (0.02, 2.0), (0.03, 0.1)],
    "cartesian": [FAST, SLOW],
}


def case(name, velocity, amplitude):
    """The problem of a case, its contact, and its path over half a period."""
    model, motion, nu, *sizes = CASES[name]
    problem = Problem(motion, velocity, amplitude, nu)
    contact = contact_of(problem, model, Resolution(*sizes, STEPS))
    return problem, contact, path_of(problem, contact, STEPS)


def plain_march(contact, path, state, change, most=20_000):
    """(tractions, forces) of the half period in which the plain map changes less than `change`."""
    for _ in range(most):
        march = contact.march(path, state, STEP_TOLERANCE)
        before, state = state, contact.mirrored(march.state)
        if energy_norm(contact, state - before) < change:
            return state, march.forces
    raise AssertionError("the plain march did not come to rest")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "velocity", "amplitude"),
    [(name, *point) for name, points in POINTS.items() for point in points],
)
def test_found_state_is_that_of_the_plain_march(name, velocity, amplitude):
    """The plain march starts from the stress-free contact."""
    problem, contact, path = case(name, velocity, amplitude)
    model, _, _, *sizes = CASES[name]
    run = simulate(problem, model, Resolution(*sizes, STEPS), TOLERANCE)
    assert run.converged and run.distance <= TOLERANCE
    stands_still = 1e-7 if model == "cartesian" else 1e-9  # its steps are solved less accurately
    state, forces = plain_march(contact, path, 0.0 * forward_slip(contact), stands_still)
    assert run.mu == pytest.approx((path.weights @ forces[:, 0]), abs=2 * TOLERANCE)
    assert energy_norm(contact, run.state - state) < 30 * TOLERANCE


@pytest.mark.parametrize("name", CASES)
def test_second_half_of_the_period_mirrors_the_first(name):
    """A march over the whole period makes no use of the symmetry."""
    problem, contact, path = case(name, *SLOW)
    goal = Goal(TOLERANCE, STEP_TOLERANCE)
    result = find_periodic_state(contact, path, forward_slip(contact), goal)
    assert result.converged
    phase = np.concatenate([path.phase, path.phase[1:] + np.pi])
    whole = make_path(problem.displacement, phase)
    march = contact.march(whole, result.start, STEP_TOLERANCE)
    assert energy_norm(contact, march.state - result.start) < 3 * TOLERANCE
    first, second = np.split(march.forces[1:], 2)
    assert second[:, 0] == pytest.approx(first[:, 0], abs=3 * TOLERANCE)
    turning = 2 if problem.motion.rotates else 1  # the force or torque along the oscillation
    assert second[:, turning] == pytest.approx(-first[:, turning], abs=3 * TOLERANCE)
    assert np.abs(first[:, turning]).max() > 0.1
    mean = (path.weights @ result.march.forces)[0]
    assert (whole.weights @ march.forces)[0] == pytest.approx(mean, abs=TOLERANCE)


@pytest.mark.parametrize("name", CASES)
def test_verdict_is_that_of_the_plain_map(name):
    _, contact, path = case(name, *SLOW)
    start = forward_slip(contact)
    enough = find_periodic_state(contact, path, start, Goal(TOLERANCE, STEP_TOLERANCE))
    assert enough.converged and enough.residual <= enough.distance <= TOLERANCE
    fewer = Goal(TOLERANCE, STEP_TOLERANCE, enough.marches - 1)
    few = find_periodic_state(contact, path, start, fewer)
    assert not few.converged
    assert few.marches < enough.marches
    for result in (enough, few):
        # the result of the search is one march of the plain map
        march = contact.march(path, result.start, STEP_TOLERANCE)
        loose = max(1e-6, result.march.residual)  # early steps have a larger tolerance
        assert march.forces == pytest.approx(result.march.forces, abs=loose)
        change = energy_norm(contact, contact.mirrored(march.state) - result.start)
        assert change == pytest.approx(result.residual, rel=0.02, abs=loose)


def test_run_reports_what_was_not_reached(monkeypatch):
    monkeypatch.setattr("microslip.periodic.simulate.MOST_MARCHES", 2)
    for motion, model, angles in ((Bore(), "polar", 4), (Transverse(), "radial", 1)):
        problem = Problem(motion, 0.1, 1.0, 0.0)
        run = simulate(problem, model, Resolution(6, angles, 8), TOLERANCE)
        assert not run.converged
        assert "no periodic state" in run.reason and run.distance > TOLERANCE


@pytest.mark.parametrize("amplitude", [0.2, 0.9, 1.5])
def test_rings_converge_down_to_very_small_velocities(amplitude):
    """The friction approaches the static limit from above."""
    problems = (Problem(Transverse(), 10.0**power, amplitude, 0.0) for power in (-3, -4, -5))
    runs = [simulate(one, "radial", Resolution(24, 1, 24), TOLERANCE) for one in problems]
    assert all(run.converged and run.periods < 20 for run in runs)
    assert runs[0].mu > runs[1].mu > runs[2].mu
    assert runs[2].mu == pytest.approx(paper.static_limit_transverse(amplitude), abs=3e-3)


@pytest.mark.parametrize(("velocity", "amplitude"), [(1e-3, 0.05), (3e-4, 0.5)])
def test_slow_motions_of_small_amplitude_are_not_taken_for_periodic_too_early(velocity, amplitude):
    """In a slow period every state changes little, so a small residual alone proves nothing."""
    problem = Problem(Bore(), velocity, amplitude, 0.0)
    runs = [
        simulate(problem, "polar", Resolution(6, 4, 12), tolerance) for tolerance in (3e-5, 3e-7)
    ]
    assert all(run.converged for run in runs)
    assert runs[0].mu == pytest.approx(runs[1].mu, abs=1e-4)


@pytest.mark.parametrize(
    ("velocity", "amplitude", "rings", "steps"),
    [
        # undamped Newton corrections cycle or diverge
        (1.34e-6, 0.867, 35, 78),
        (7.12e-6, 0.739, 9, 77),
        (1.14e-5, 0.518, 58, 53),
        # almost full stick; full slip
        (1e-6, 0.01, 32, 16),
        (1e-6, 1e3, 8, 32),
        (1e3, 0.01, 8, 12),
        (1e3, 1e3, 16, 96),
    ],
)
def test_rings_converge_at_the_ends_of_the_parameters(velocity, amplitude, rings, steps):
    problem = Problem(Transverse(), velocity, amplitude, 0.0)
    runs = [
        simulate(problem, "radial", Resolution(rings, 1, steps), tolerance)
        for tolerance in (1e-4, 1e-7)
    ]
    assert all(run.converged and run.periods < 40 for run in runs)
    assert runs[0].mu == pytest.approx(runs[1].mu, abs=1.5e-4)


@pytest.mark.parametrize(
    ("model", "angles", "problem"),
    [
        ("radial", 1, Problem(Transverse(), 1e-6, 0.5, 0.0)),
        ("radial", 1, Problem(Transverse(), 1e-3, 1.1, 0.0, drive=Spring(0.5))),
        ("polar", 4, Problem(Transverse(), 0.1, 1.0, 0.3)),
        ("polar", 4, Problem(Bore(), 0.1, 1.0, 0.0)),
        ("polar", 4, Problem(Bore(), 0.3, 1.0, 0.0, drive=Force(0.5, mass=0.5))),
    ],
    ids=str,
)
def test_a_run_of_fewer_rings_as_first_guess_changes_nothing(model, angles, problem):
    tolerance = 1e-6
    coarse = simulate(problem, model, Resolution(8, angles, 16), tolerance)
    fine = model, Resolution(16, angles, 16), tolerance
    alone, after = simulate(problem, *fine), simulate(problem, *fine, coarse)
    assert alone.converged and after.converged and after.effort != alone.effort
    for name, value in alone.values.items():
        assert after.values[name] == pytest.approx(value, abs=5 * tolerance)


def test_all_effort_is_counted():
    """A step has two stages, a ring two tractions, and a period two marches."""
    steps, problem = 16, Problem(Transverse(), 0.01, 0.5, 0.0)
    run = simulate(problem, "radial", Resolution(8, 1, steps), 1e-6)
    assert run.effort.solves == 2 * run.periods * 2 * steps
    assert run.effort.work == 16 * run.effort.solves
    assert run.effort.updates == 16 * run.effort.iterations >= run.effort.work
