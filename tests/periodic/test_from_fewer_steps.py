"""A search for the periodic state of a driven contact starts from the state of a run with fewer
steps.

The result is the same at less effort.
"""

import pytest

from microslip.periodic import simulate as module
from microslip.periodic.discretise import Resolution
from microslip.periodic.run import Settings
from microslip.periodic.simulate import PREPARED_FROM, simulate
from microslip.scene.by_name import motion_named
from microslip.scene.drive import Force, Spring
from microslip.scene.problem import Problem
from microslip.theory import paper

PLACES = {
    "just above the threshold": (
        ("transverse", 1e-5, 0.5),
        Force(1.0001 * float(paper.static_limit_transverse(0.5))),
        (2e-6, 50.0),
    ),
    "a mass under a load that oscillates": (
        ("normal:lateral=1", 0.3, 0.6),
        Spring(stiffness=0.1, mass=1.0),
        (1e-5, 1.0),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PLACES)
def test_the_state_is_the_same_and_takes_less(name, monkeypatch):
    place, drive, (tolerance, slope) = PLACES[name]
    problem = Problem(motion_named(place[0]), *place[1:], drive=drive)
    resolution = Resolution(24, 1, 192)
    runs = []
    for first in (PREPARED_FROM, resolution.steps + 1):
        monkeypatch.setattr(module, "PREPARED_FROM", first)
        settings = Settings(slope=slope)
        runs.append(simulate(problem, "radial", resolution, tolerance, settings=settings))
    ahead, plain = runs
    assert ahead.converged and plain.converged
    answers = [run.mu if drive.force is None else run.values["velocity"] for run in runs]
    assert abs(answers[0] - answers[1]) <= 2.0 * tolerance
    # the effort includes the run with fewer steps
    assert ahead.effort.solves < 0.8 * plain.effort.solves
    assert ahead.effort.iterations < 0.8 * plain.effort.iterations
