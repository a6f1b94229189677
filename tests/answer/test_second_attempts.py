"""Second attempts at runs that do not converge at first."""

from dataclasses import dataclass
from functools import cache, partial
from unittest.mock import Mock

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.answer import request
from microslip.periodic import simulate
from microslip.periodic.budget import Effort


@dataclass(frozen=True)
class FakeRun:
    converged: bool
    mu: float
    reason: str = ""
    iterations: int = 1
    effort: Effort = Effort.of(solves=2, iterations=1, unknowns=5)


class Stubborn:
    """Runs that converge at velocities from `easy` on, or from a guess at most `reach` times
    faster."""

    def __init__(self, easy, reach, careless=True):
        self.easy, self.reach, self.careless, self.asked = easy, reach, careless, []

    def __call__(self, velocity, guess, careful):
        self.asked.append(velocity)
        near = guess is not None and guess.mu <= self.reach * velocity * (1 + 1e-12)
        good = (careful or self.careless) and (velocity >= self.easy or near)
        return FakeRun(good, velocity, "" if good else f"failed at {velocity:g}")


FASTEST = 1e7


def attempted(run_at):
    """A second attempt at the velocity 1."""
    first = run_at(1.0, None, False)
    return request.second_attempt(first, partial(run_at, careful=True), 1.0, FASTEST)


def test_tighter_steps_come_first():
    run_at = Stubborn(easy=0.5, reach=1.0, careless=False)
    result = attempted(run_at)
    assert (result.converged, result.effort.retried, result.effort.work) == (True, 1, 20)


@pytest.mark.parametrize("reach", [8.0, 3.0, 1.5, 1.2])
def test_the_velocity_is_lowered_in_steps_that_succeed(reach):
    run_at = Stubborn(easy=100.0, reach=reach)
    result = attempted(run_at)
    assert result.converged and result.mu == 1.0 and result.effort.retried == 1
    assert result.effort.work == 10 * len(run_at.asked)
    assert run_at.asked[-1] == 1.0


def test_a_failure_is_told_as_the_first_attempt_tells_it():
    for run_at in (Stubborn(easy=100.0, reach=1.1), Stubborn(easy=1e99, reach=1.1)):
        result = attempted(run_at)
        assert not result.converged
        assert result.reason == "failed at 1"
        assert result.effort.updates == 5 * len(run_at.asked) < 5 * 100


# Points at which the first attempt fails
HARD = [
    ("transverse", 0.5, 4.45e-6, 0.179, 1e-3),
    ("zigzag", 0.3, 5.36e-7, 0.381, 1e-3),
    ("transverse", 0.0, 1.2e-8, 0.909, 1e-3),
    ("transverse", 0.0, 8.381785803921901e-09, 0.8094412724292523, 1e-2),
]
LONG = HARD[:3]


@cache
def answered(motion, poisson, velocity, amplitude, tolerance):
    """The Result of a point, computed once."""
    return microslip.solve(motion, velocity, amplitude, poisson=poisson, tolerance=tolerance)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "poisson", "velocity", "amplitude", "tolerance"),
    [pytest.param(*point, marks=pytest.mark.long if point in LONG else ()) for point in HARD],
)
def test_slowest_motions_get_their_answer_in_a_second_attempt(
    motion, poisson, velocity, amplitude, tolerance
):
    """The friction of so slow a motion is close to the static limit, which is computed
    differently."""
    settings = {"poisson": poisson, "tolerance": tolerance}
    answer = answered(motion, poisson, velocity, amplitude, tolerance)
    limit = microslip.solve(motion, 0.0, amplitude, **settings)
    assert_agree(answer, limit, slack=velocity ** (2 / 3))


@pytest.mark.long
def test_these_points_need_it(monkeypatch):
    """The point does not converge without a second attempt; with it `retried` is above 0."""
    motion, poisson, velocity, amplitude, tolerance = HARD[3]
    settings = {"poisson": poisson, "tolerance": tolerance}
    assert answered(*HARD[3]).effort.retried > 0
    monkeypatch.setattr(request, "second_attempt", lambda first, *_: first)
    answer = microslip.solve(motion, velocity, amplitude, **settings)
    assert not answer.converged
    assert "no periodic state" in answer.reason
    assert answer.effort.retried == 0


@pytest.mark.parametrize("error", [TypeError, ZeroDivisionError, np.linalg.LinAlgError])
def test_an_error_of_the_code_in_a_run_is_raised(monkeypatch, error):
    monkeypatch.setattr(simulate, "path_of", Mock(side_effect=error("wrong")))
    with pytest.raises(error):
        microslip.solve("transverse", 0.1, 0.5)
