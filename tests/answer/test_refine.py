"""Refinement of manufactured runs with known limits."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from microslip.answer import refine as refinement
from microslip.answer.ladder import Ladder
from microslip.answer.refine import READING_SAFETY, SAFETY, extrapolate
from microslip.periodic.run import Effort, Run, Spent

EXACT, EXACT_TORQUE = 0.4, 0.7
LADDER = Ladder(start=8, angles=0.5, steps=2)


def refine(run, ladder, tolerance, readings=(), **energy):
    """Refine with functions in place of problems; `readings` replace other interpolations."""
    every = (run, *readings)
    return refinement.refine(lambda run, *place: run(*place), ladder, every, tolerance, **energy)


def value_of(refined):
    return refined.estimates["friction"]


class FakeRun:
    """Runs with mu = EXACT + coefficient / cells^power."""

    def __init__(self, coefficient=0.0, power=2.0, most=99):
        self.coefficient, self.power, self.most = coefficient, power, most
        self.asked, self.guesses, self.runs = [], [], []

    def __call__(self, resolution, guess):
        if len(self.asked) == self.most:
            raise Spent("all is spent")
        excess = self.coefficient * resolution.cells**-self.power
        number = len(self.asked) + 1
        self.asked.append(resolution)
        self.guesses.append(guess)
        values = {"friction": EXACT + excess, "torque": EXACT_TORQUE - 2.0 * excess}
        left = 1e-9 / number, 1e-10 * number
        self.runs.append(Run(values, *left, number, Effort(1, 10, 100, 20)))
        return self.runs[-1]


def test_the_energy_is_extrapolated_with_errors_in_its_own_unit():
    """Energies 5 + 0.03 / cells^2 and a unit of 40 for the errors of the runs."""

    def run(resolution, guess):
        values = {"friction": 0.4, "dissipation": 5.0 + 0.03 / resolution.cells**2}
        return Run(values, 1e-6, 2e-6, 1)

    def errors(**work):
        found = refine(run, LADDER, 1e-3, energy_unit=40.0, **work).estimates
        assert found["dissipation"].value == pytest.approx(5.0, abs=1e-12)
        own, plain = (found[name].by_source for name in ("dissipation", "friction"))
        return {source: own[source] / error for source, error in plain.items()}

    # the smallest error is a fraction of the geometric mean of 5 and 40, or of a force's work
    least = pytest.approx(200.0**0.5, rel=0.01)
    unit = pytest.approx(40.0)
    assert errors() == {"resolution": least, "periodicity": unit, "solver": unit}
    assert errors(drive_work=20.0)["resolution"] == pytest.approx(20.0)


def test_three_levels_are_run_each_from_the_one_before():
    fake = FakeRun(0.1)
    result = refine(fake, LADDER, 1e-3)
    assert result.converged and result.reason == "" and result.periodic
    assert fake.asked == [LADDER.resolution(level) for level in (4, 8, 16)]
    assert fake.guesses == [None, *fake.runs[:2]]
    assert value_of(result).value == pytest.approx(EXACT, abs=1e-14)
    assert result.estimates["torque"].value == pytest.approx(EXACT_TORQUE, abs=1e-14)
    assert result.observed_order == pytest.approx(2.0) and result.cells == fake.asked[-1].cells
    assert (result.periods, result.effort) == (3, Effort(3, 30, 300, 60))


def test_levels_are_added_until_the_error_is_within_the_tolerance():
    fake = FakeRun(3.0)
    result = refine(fake, LADDER, 1e-3)
    assert result.converged and value_of(result).error <= 1e-3
    cells = [resolution.cells for resolution in fake.asked]
    assert len(set(cells)) == len(cells) and max(cells) > 64
    # each run starts from the finest one so far
    finest = [cells.index(max(cells[:k])) for k in range(1, len(cells))]
    assert fake.guesses == [None, *(fake.runs[k] for k in finest)]


def test_levels_at_which_differences_increase_are_followed_by_one_with_known_coarser_levels():
    def run(resolution, guess):
        wrong = {4: 0.0, 8: 1e-2, 16: 1e-1}.get(resolution.cells, 1.0 / resolution.cells**2)
        asked.append(resolution.cells)
        return Run({"friction": 0.4 + wrong}, 1e-6, 1e-6, 1)

    asked = []
    assert refine(run, LADDER, 1e-3).converged
    assert asked[:4] == [4, 8, 16, 32]  # 24 would need the levels 6 and 12


def test_distances_and_residuals_are_weighted_as_the_runs_enter_the_value():
    """The weight of a run is the change of the value by a change of the run."""
    fake = FakeRun(0.3)
    result = refine(fake, LADDER, 1e-3)
    step = 1e-7

    def response(resolution):
        again = FakeRun(0.3)

        def run(at, guess):
            one = again(at, guess)
            shifted = replace(one, values=one.values | {"friction": one.mu + step})
            return shifted if at == resolution else one

        return abs(value_of(refine(run, LADDER, 1e-3)).value - value_of(result).value) / step

    weights = np.array([response(resolution) for resolution in fake.asked])
    for source, name in (("periodicity", "distance"), ("solver", "residual")):
        expected = weights @ [getattr(run, name) for run in fake.runs]
        assert value_of(result).by_source[source] == pytest.approx(expected, rel=1e-6)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(
    st.floats(-2.0, 1.0).map(lambda x: 10**x),
    st.sampled_from([-1.0, 1.0]),
    st.floats(1.25, 4.0),
    st.floats(-4.0, -1.0).map(lambda x: 10**x),
)
def test_smooth_errors_are_covered(size, sign, power, tolerance):
    result = refine(FakeRun(sign * size, power), LADDER, tolerance)
    assert not result.converged or value_of(result).error <= tolerance
    assert abs(value_of(result).value - EXACT) <= value_of(result).error
    assert abs(result.estimates["torque"].value - EXACT_TORQUE) <= 2.0 * value_of(result).error


def test_an_imposed_resolution_is_the_answer_and_not_its_limit():
    """The error is the distance to the limit, and the error of the limit."""
    fake = FakeRun(3.0)
    ladder = Ladder(16, angles=0, steps=1, cells=12 / 16, imposed=64)
    result = refine(fake, ladder, 1e-3)
    assert value_of(result).value == fake.runs[-1].mu == EXACT + 3.0 / 144
    assert result.cells == 12 and len(fake.asked) == 3
    assert value_of(result).by_source["resolution"] == pytest.approx((1.0 + SAFETY) * 3.0 / 144)
    assert value_of(result).by_source["periodicity"] == pytest.approx(fake.runs[-1].distance)
    assert result.converged and result.reason == ""


@pytest.mark.parametrize("cells", [4, 8, 16])
def test_a_run_that_does_not_converge_ends_it(cells):
    fake = FakeRun(30.0)

    def run(resolution, guess):
        one = fake(resolution, guess)
        if resolution.cells == cells:
            return replace(one, reason="lost its way", distance=np.inf)
        return one

    result = refine(run, LADDER, 1e-3)
    assert not result.converged and not result.periodic and result.reason == "lost its way"
    assert len(fake.asked) == 3
    assert value_of(result).error == np.inf


ENDS = [
    (1e3, 99, 192, "the error is still {:.1e} with 192 cells"),
    (3.0, 4, 32, "all is spent: the error is still {:.1e}"),
    (3.0, 2, 0, "all is spent: there is no error"),
]


@pytest.mark.parametrize(("coefficient", "most", "cells", "reason"), ENDS)
def test_what_the_finest_or_the_last_run_gave_is_the_answer(coefficient, most, cells, reason):
    fake = FakeRun(coefficient, most=most)
    result = refine(fake, LADDER, 1e-4)
    one = value_of(result)
    assert not result.converged and result.cells == cells
    assert result.reason.startswith(reason.format(one.error))
    assert abs(one.value - EXACT) <= one.error if cells else np.isnan(one.value)


# Readings of a pressure


def test_readings_are_run_at_the_finest_level_and_their_differences_are_an_error():
    fake, other = FakeRun(), FakeRun()

    def shifted(by):
        return lambda *place: replace(other(*place), values={"friction": EXACT + by})

    result = refine(fake, LADDER, 1e-3, [shifted(4e-5), shifted(-3e-5)])
    assert value_of(result).by_source["model"] == pytest.approx(READING_SAFETY * 7e-5)
    assert other.asked == 2 * [fake.asked[-1]] and other.guesses == 2 * [fake.runs[-1]]
    assert result.converged and value_of(result).error <= 1e-3


def test_a_coarse_run_that_does_not_converge_counts_in_full():
    """The value does not depend on this run, but its error can hide the difference of the
    levels."""
    fake = FakeRun()

    def run(resolution, guess):
        made = fake(resolution, guess)
        return replace(made, reason="lost", distance=0.01) if not guess else made

    result = refine(run, LADDER, 1e-3)
    assert not result.converged and value_of(result).by_source["periodicity"] > 0.01


# Extrapolation


POWERS = [0.7, 0.8, 0.99, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 8.0]


@pytest.mark.parametrize("coefficient", [-3.0, 0.1, 5.0])
@pytest.mark.parametrize("power", POWERS)
def test_errors_of_every_order_are_covered_and_those_of_second_order_removed(power, coefficient):
    limit = extrapolate([EXACT + coefficient * n**-power for n in (4, 8, 16)])
    assert abs(limit.value - EXACT) <= limit.error
    assert limit.order == pytest.approx(power)
    if power == 2.0:
        assert limit.value == pytest.approx(EXACT, abs=1e-14)
        assert limit.error == pytest.approx(SAFETY * abs(coefficient) / 16**2)


@pytest.mark.parametrize(
    ("first", "second"), [(0.3, 0.01), (-0.13, 0.0), (-0.13, 1e-9), (-0.13, -1e-9)]
)
def test_levels_that_swing_or_agree_by_chance_are_no_better_than_the_level_before(first, second):
    """Second order would leave a third of the first difference."""
    limit = extrapolate([EXACT + 0.03 - first, EXACT + 0.03, EXACT + 0.03 - second])
    assert limit.error == pytest.approx(SAFETY * abs(first) / 3.0)
    assert abs(limit.value - EXACT) <= limit.error
