"""Second attempts at runs that do not converge at first."""

import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.answer import request
from microslip.periodic import simulate
from microslip.periodic.run import Effort, Run


class Stubborn:
    """Runs that converge at velocities from `easy` on, or from a guess at most `reach` times
    faster."""

    def __init__(self, easy, reach):
        self.easy, self.reach, self.velocities = easy, reach, []

    def __call__(self, velocity, guess):
        self.velocities.append(velocity)
        near = guess is not None and guess.mu <= self.reach * velocity * (1 + 1e-12)
        reason = "" if near or velocity >= self.easy else f"failed at {velocity:g}"
        return Run({"friction": velocity}, 0.0, 0.0, effort=Effort.of(2, 1, 5), reason=reason)


def attempt(run_at, fastest=1e3):
    """A second attempt at the velocity 1, and the number of its runs."""
    first = Run({"friction": 0.0}, 0.0, 0.0, effort=Effort.of(2, 1, 5), reason="failed at first")
    result = request.second_attempt(first, run_at, 1.0, fastest)
    assert result.effort.retried == 1
    assert result.effort.work == 10 * (1 + len(run_at.velocities))
    return result


@pytest.mark.parametrize("reach", [8.0, 3.0, 1.5, 1.2])
def test_the_velocity_is_lowered_in_steps_that_succeed(reach):
    run_at = Stubborn(easy=100.0, reach=reach)
    result = attempt(run_at)
    assert result.converged and result.mu == 1.0 and run_at.velocities[-1] == 1.0


@pytest.mark.parametrize(("easy", "fastest"), [(100.0, 1e3), (1e99, 1e3), (1e99, 0.1)])
def test_a_failure_has_the_first_reason_and_a_bounded_number_of_runs(easy, fastest):
    run_at = Stubborn(easy, reach=1.1)
    assert attempt(run_at, fastest).reason == "failed at first"
    assert max(run_at.velocities) <= max(fastest, request.FACTOR)


HARD = "transverse", 8.381785803921901e-09, 0.8094412724292523
"""A point that does not converge at first."""


def test_a_slow_motion_is_solved_by_a_second_attempt(monkeypatch):
    """Its friction is close to the static limit, which is computed differently."""
    result = microslip.solve(*HARD, tolerance=1e-2)
    assert result.effort.retried > 0
    assert_agree(result, microslip.solve("transverse", 0.0, HARD[2]), slack=HARD[1] ** (2 / 3))
    monkeypatch.setattr(request, "second_attempt", lambda first, *_: first)
    alone = microslip.solve(*HARD, tolerance=1e-2)
    assert not alone.converged and "no periodic state" in alone.reason


def test_an_error_of_the_code_in_a_run_is_raised(monkeypatch):
    monkeypatch.setattr(simulate, "path_of", None)
    with pytest.raises(TypeError):
        microslip.solve("transverse", 0.1, 0.5)
