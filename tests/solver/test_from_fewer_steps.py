"""A search for the periodic state of a driven contact starts from the state of a run with fewer
steps.

The result is the same at less effort.
"""

import pytest

from microslip.motions.by_name import motion_named
from microslip.motions.drive import Force, Spring
from microslip.motions.problem import Problem
from microslip.solver import driven_run
from microslip.solver.discretise import Resolution
from microslip.solver.driven_run import COARSENING, PREPARED_FROM, Accuracy, simulate_driven
from microslip.solver.run import AS_SHIPPED, failed_run
from microslip.theory import paper

PLACES = {
    "just above the threshold": (
        ("transverse", 1e-5, 0.5),
        Force(1.0001 * float(paper.static_limit_transverse(0.5))),
        Accuracy(2e-6, 50.0),
    ),
    "a mass under a load that oscillates": (
        ("normal:lateral=1", 0.3, 0.6),
        Spring(stiffness=0.1, mass=1.0),
        Accuracy(1e-5),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PLACES)
def test_the_state_is_the_same_and_takes_less(name, monkeypatch):
    place, drive, accuracy = PLACES[name]
    problem = Problem(motion_named(place[0]), *place[1:], drive=drive)
    resolution = Resolution(24, 1, 192)
    runs = []
    for first in (PREPARED_FROM, resolution.steps + 1):
        monkeypatch.setattr(driven_run, "PREPARED_FROM", first)
        runs.append(simulate_driven(problem, "radial", resolution, accuracy, AS_SHIPPED))
    ahead, plain = runs
    assert ahead.converged and plain.converged
    answers = [run.mu if drive.force is None else run.velocity for run in runs]
    assert abs(answers[0] - answers[1]) <= 2.0 * accuracy.tolerance
    # the effort includes the run with fewer steps
    assert ahead.effort.solves < 0.8 * plain.effort.solves
    assert ahead.effort.iterations < 0.8 * plain.effort.iterations


def test_a_search_goes_on_without_one_that_failed(monkeypatch):
    problem = Problem(motion_named("transverse"), 0.1, 1.0, drive=Spring(stiffness=1.0))
    tried, really = [], simulate_driven

    def fails(problem, model, resolution, *others, **more):
        tried.append(resolution.steps)
        return failed_run("on purpose")

    monkeypatch.setattr(driven_run, "simulate_driven", fails)
    fine = Resolution(8, 1, PREPARED_FROM)
    result = really(problem, "radial", fine, Accuracy(1e-4), AS_SHIPPED)
    assert tried == [PREPARED_FROM // COARSENING]
    assert result.converged and result.periods > 0.0
