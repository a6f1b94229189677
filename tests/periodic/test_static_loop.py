"""The static limit of loops and of oscillating loads: closed forms, models and slow marches."""

import numpy as np
import pytest
from scipy.integrate import quad

import microslip
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.periodic.static_limit import largest_shift
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem
from microslip.theory import paper

NARROW = "elliptic:forward=0.5,phase=30"
EIGHT = "elliptic:forward=0.5,phase=0,forward_cycles=2"
ACROSS = "normal:lateral=1,normal_cycles=2"
RINGS = "radial", Resolution(32, 1, 128), (8e-3, 1e-3)
TURNING = "polar", Resolution(16, 4, 64), (2e-2, 2.5e-3)


def within(result, expected, slack=0.0):
    assert result.converged
    assert abs(result.mu_macro - expected) <= result.mu_macro_error + slack


def test_the_largest_shift_is_that_of_a_fine_grid():
    rng = np.random.default_rng(5)
    axis = np.linspace(-1.0, 1.0, 401)
    forward, lateral = np.meshgrid(axis, axis, indexing="ij")
    for _ in range(20):
        bounds = rng.uniform(0.5, 1.0, (6, 1))
        size, turn = bounds[:, 0] * rng.uniform(0.0, 1.0, 6), rng.uniform(0.0, 2.0 * np.pi, 6)
        tractions = (size * np.stack([np.cos(turn), np.sin(turn)])).T
        matrices = np.ones(forward.shape, bool)
        for q, bound in zip(tractions, bounds[:, 0], strict=True):
            matrices &= np.hypot(q[0] + forward, q[1] + lateral) <= bound
        shift = largest_shift(tractions[:, :, None], bounds)[:, 0]
        assert shift[0] == pytest.approx(forward[matrices].max(initial=0.0), abs=1.2e-2)
        sizes = np.hypot(*(tractions + shift).T)
        assert (sizes <= bounds[:, 0] + 1e-6).all()


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [0.2, 0.5, pytest.param(0.8, marks=pytest.mark.long)])
def test_a_loop_of_no_width_has_the_limit_of_its_line(amplitude):
    """The limit of so narrow a loop is within 2e-4 of the closed form for the line."""
    across = microslip.solve("elliptic:forward=0.001", 0.0, amplitude)
    within(across, float(paper.static_limit_transverse(amplitude)), 2e-4)
    along = microslip.solve("elliptic:lateral=0.001", 0.0, amplitude)
    within(along, float(paper.static_limit_longitudinal(amplitude)), 2e-4)


@pytest.mark.parametrize("amplitude", [0.1, 0.4, 0.7])
def test_springs_on_a_circle_in_closed_form(amplitude):
    """A sticking spring at x has the force `amplitude`; its shift is 1 - x^2 - amplitude."""
    result = microslip.solve("elliptic", 0.0, amplitude, model="mdr")
    within(result, (1.0 - amplitude) ** 1.5)


@pytest.mark.slow
def test_where_all_slides_the_mean_of_the_directions_is_left():
    def forward(t):
        return np.cos(2.0 * t) / np.hypot(np.cos(2.0 * t), np.cos(t))

    mean = quad(forward, 0.0, np.pi, points=[0.5 * np.pi])[0] / np.pi
    rigid = microslip.solve(EIGHT, 0.0, 0.5, model="rigid")
    within(rigid, mean)
    # an elastic contact lags by a path of about u_lim, which matters less on a longer path
    late = [abs(microslip.solve(EIGHT, 0.0, a).mu_macro - mean) for a in (10.0, 40.0)]
    assert late[0] < 0.05
    assert late[1] < 0.5 * late[0]
    assert microslip.solve("elliptic", 0.0, 3.0).mu_macro == pytest.approx(0.0, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "model", "resolution", "velocities"),
    [
        *((motion, *RINGS) for motion in ("transverse", NARROW, EIGHT, ACROSS)),
        ("normal:forward=1,phase=90", *RINGS),
        *(
            (one, "polar", Resolution(16, 4, 64), (2e-2, 2.5e-3))
            for one in ("bore", "normal:angle=1")
        ),
    ],
)
def test_slow_marches_end_there(motion, model, resolution, velocities):
    """Limit and marches use the same rings and steps, so a coarse resolution suffices."""
    problems = (Problem(motion_named(motion), v, 0.5, 0.0) for v in (0.0, *velocities))
    limit, *slow = (simulate(one, model, resolution, 1e-5) for one in problems)
    assert limit.converged and slow[0].converged and slow[1].converged
    above = [run.mu - limit.mu for run in slow]
    # the excess falls at least with v^(2/3), here to a quarter
    assert 0.0 < above[1] < 0.36 * above[0]


@pytest.mark.parametrize("amplitude", [0.3, 0.8])
def test_a_load_that_oscillates_leaves_its_least(amplitude):
    """The closed form for an oscillating load alone, against solutions over the whole period.

    The last case has a negligible lateral oscillation.
    """
    exact = microslip.solve("normal", 0.0, amplitude).mu_macro
    assert exact == pytest.approx(1.0 - amplitude, abs=1e-12)
    for motion, model in (
        ("normal", "radial"),
        ("normal", "mdr"),
        ("normal:lateral=0.001", "auto"),
    ):
        within(microslip.solve(motion, 0.0, amplitude, model=model), exact, 1e-5)


def test_a_state_that_does_not_settle_is_no_number(monkeypatch):
    monkeypatch.setattr("microslip.periodic.static_limit.MARCHES", 1)
    monkeypatch.setattr("microslip.periodic.static_limit.MOST_ROUNDS", 1)
    result = microslip.solve(NARROW, 0.0, 0.5)
    assert not result.converged and "no periodic state" in result.reason
