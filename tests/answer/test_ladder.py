"""Levels of resolution: the first level of a problem, and what a level doubles."""

import pytest

from microslip.answer.ladder import ladder_for
from microslip.periodic.discretise import Resolution
from microslip.scene.by_name import motion_named
from microslip.scene.named import Transverse
from microslip.scene.problem import Problem


def test_what_is_not_imposed_is_as_fine_as_the_tolerance_needs():
    problem = Problem(Transverse(), 0.5, 1.0, 0.0)
    free = ladder_for(problem, "radial", 1e-3)
    for tolerance in (1e-2, 1e-4):
        needed = free.resolution(free.levels(tolerance)[0])
        few = ladder_for(problem, "radial", tolerance, cells=4)
        assert few.resolution(few.start) == Resolution(4, 1, needed.steps)
        short = ladder_for(problem, "radial", tolerance, steps=16)
        assert short.resolution(short.start) == Resolution(needed.cells, 1, 8)
    # an imposed number of cells sets the level of the steps
    many = ladder_for(problem, "radial", 1e-2, cells=64)
    assert many.resolution(many.start) == free.resolution(64)


def test_steps_stay_short_against_u_lim_where_the_stroke_is_long():
    def steps(amplitude, motion=motion_named("transverse")):  # noqa: B008
        return ladder_for(Problem(motion, 0.5, amplitude, 0.0), "radial", 1e-3).steps

    assert steps(0.1) == steps(1.0) == pytest.approx(steps(9.0) / 3.0)
    assert steps(16.0) == steps(100.0) == 4.0 * steps(1.0)
    twice = motion_named("elliptic:forward=0.5,phase=0,forward_cycles=2")
    assert steps(1.0, twice) == 2.0 * steps(1.0)
