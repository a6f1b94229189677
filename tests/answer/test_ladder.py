"""Levels of resolution: the first level of a problem, and what a level doubles."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from microslip.answer.ladder import LEVELS, Ladder, ladder_for
from microslip.answer.limits import choose_model
from microslip.contact.registry import MODELS
from microslip.periodic.discretise import Resolution
from microslip.periodic.static_limit import at_turning_points
from microslip.scene.by_name import MOTIONS, motion_named
from microslip.scene.named import Transverse
from microslip.scene.problem import Problem

decades = st.floats(-6.0, 3.0).map(lambda x: 10**x)
points = st.tuples(
    st.sampled_from([one() for one in MOTIONS.values()]),
    st.one_of(st.just(0.0), decades),
    decades,
    st.sampled_from([0.0, 0.3, 0.5]),
    st.sampled_from(["auto", *MODELS]),
)


def planned(point, tolerance=1e-3, **imposed):
    """(problem, model, ladder), or None if the model does not apply."""
    motion, velocity, amplitude, poisson, model = point
    problem = Problem(motion, velocity, amplitude if motion.periodic else None, poisson)
    try:
        name = choose_model(problem, model)
    except ValueError:
        return None
    return problem, name, ladder_for(problem, name, tolerance, **imposed)


def test_every_second_level_doubles():
    assert all(np.array(LEVELS[2:]) == 2 * np.array(LEVELS[:-2]))
    assert {level // 4 for level in LEVELS if level >= 8} <= set(LEVELS)


@pytest.mark.slow
@settings(max_examples=200, deadline=None, derandomize=True)
@given(points)
def test_a_ladder_refines_what_the_motion_and_the_model_have(point):
    result = planned(point)
    if result is None:
        return
    problem, model, ladder = result
    refined = MODELS[model].axes(problem)
    assert (ladder.cells > 0, ladder.angles > 0) == ("cells" in refined, "angles" in refined)
    marched = problem.velocity > 0.0 or not at_turning_points(problem)
    assert (ladder.steps > 0) == (problem.motion.periodic and marched)
    coarse, fine = ladder.resolution(8 * ladder.start), ladder.resolution(16 * ladder.start)
    for name in ("cells", "angles", "steps"):
        if getattr(ladder, name):
            assert getattr(fine, name) == pytest.approx(2 * getattr(coarse, name), abs=1)
        else:
            assert getattr(fine, name) == getattr(coarse, name)
    assert all(ladder.resolution(level).angles in (1, *range(2, 999, 2)) for level in LEVELS)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(points, st.integers(2, 64).map(lambda n: 2 * n), st.integers(4, 64).map(lambda n: 2 * n))
def test_imposed_numbers_are_those_of_the_level_that_is_the_answer(point, cells, steps):
    result = planned(point, cells=cells, steps=steps)
    if result is None:
        return
    ladder = result[2]
    resolution = ladder.resolution(ladder.start)
    assert resolution.cells == (cells if ladder.cells else 1)
    assert resolution.steps == (steps // 2 if ladder.steps else 4)
    assert (ladder.imposed > 0.0) == bool(ladder.cells or ladder.steps)


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


@pytest.mark.parametrize("start", [8, 16])
def test_the_first_level_doubles_with_each_decade_of_the_tolerance(start):
    ladder = Ladder(start, angles=0.5, steps=1)
    first = [ladder.levels(10.0**-k)[0] / start for k in (1, 2, 3, 4, 5, 6, 9)]
    assert first == [1, 1, 2, 4, 8, 16, 24]


def test_levels_follow_each_other_up_to_the_finest():
    ladder = Ladder(8, angles=0.5, steps=1)
    levels = ladder.levels(5e-3)
    assert levels == (12, 16, 24, 32, 48, 64, 96, 128, 192)
    assert ladder.levels(9e-4) == levels[2:]
    assert ladder.levels(1e-9) == (192,)


def test_steps_stay_short_against_u_lim_where_the_stroke_is_long():
    def steps(amplitude, motion=motion_named("transverse")):  # noqa: B008
        return ladder_for(Problem(motion, 0.5, amplitude, 0.0), "radial", 1e-3).steps

    assert steps(0.1) == steps(1.0) == pytest.approx(steps(9.0) / 3.0)
    assert steps(16.0) == steps(100.0) == 4.0 * steps(1.0)
    twice = motion_named("elliptic:forward=0.5,phase=0,forward_cycles=2")
    assert steps(1.0, twice) == 2.0 * steps(1.0)


def test_a_number_that_is_not_refined_is_the_least():
    assert Ladder(8, 0, 0, cells=0).resolution(64) == Resolution(1, 1, 4)
    assert Ladder(8, 0.25, 2).resolution(2) == Resolution(2, 4, 4)
    assert math.isclose(Ladder(8, 0.25, 2).resolution(64).angles, 16)
