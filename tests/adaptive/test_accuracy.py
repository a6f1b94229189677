"""Certificates of synthetic runs, whose errors are known because they are made up.

A run gives exact + Sum C_axis level^-p + mixed terms + scatter, and remembers that it was asked.
"""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from microslip.adaptive.chains import CALIBRATED, EXTRAPOLATED_SHARES, RESOLVED, SPREAD, Axis
from microslip.adaptive.refinement import MOST_REBASED, PERIODICITY_SHARE, certify, run_tolerance
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution
from microslip.solver.simulate import Run

EXACT, EXACT_TORQUE = 0.4, 0.7
COARSEST = Resolution(cells=3, angles=1, steps=5)
LEVELS = {
    "cells": (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256),
    "angles": (2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96),
    "steps": (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768),
}


def axis(name, regular=None, base=3, most=None):
    levels = LEVELS[name][:most]
    regular = name == "cells" if regular is None else regular
    return Axis(name, levels, base, (base - 1, base, base + 1), regular, mixed=name == "angles")


def imposed(name, level):
    return Axis(name, (level // 2, level), 1, (0, 1), imposed=True)


class FakeRun:
    """Runs whose mu is EXACT plus the terms (coefficient, {axis: power}); scatter: share of the
    terms that is random."""

    def __init__(self, *terms, scatter=0.0, distance=1e-9, residual=1e-10, fails=()):
        self.terms, self.scatter, self.fails = terms, scatter, fails
        self.distance, self.residual = distance, residual
        self.asked, self.guesses, self.runs = [], [], []

    def excess(self, resolution):
        at = vars(resolution)
        total = sum(
            c * math.prod(at[a] ** -p for a, p in powers.items()) for c, powers in self.terms
        )
        if not self.scatter:
            return total
        seed = list(at.values())
        return total * (1.0 + self.scatter * np.random.default_rng(seed).uniform(-1.0, 1.0))

    def __call__(self, resolution, guess):
        excess, number = self.excess(resolution), len(self.asked) + 1
        failed = resolution in self.fails
        mu, torque = EXACT + excess, EXACT_TORQUE - 2.0 * excess
        left = self.distance / number, self.residual * number
        effort = number, 10 * number, 0, 100 * number, 0
        run = Run(mu, torque, *left, *effort, not failed, "lost its way" if failed else "")
        self.asked.append(resolution)
        self.guesses.append(guess)
        self.runs.append(run)
        return run


def check(fake, found, axes, tolerance):
    """What holds for every certificate."""
    assert len(set(fake.asked)) == len(fake.asked)
    assert found.error == pytest.approx(sum(found.errors.values()), rel=1e-14)
    assert found.errors.keys() == {"space", "time", "periodicity", "solver"}
    assert min(found.errors.values()) >= 0.0 and found.torque_error >= 0.0
    assert found.converged == (found.reason == "")
    if found.converged and not any(axis.imposed for axis in axes):
        runs_are_to_blame = found.errors["periodicity"] + found.errors["solver"] > 0.5 * tolerance
        assert found.error <= tolerance or runs_are_to_blame
    count = len(fake.asked)
    # the weights of the runs in the answer add up to 1
    assert found.errors["periodicity"] >= fake.distance / count * (1.0 - 1e-12)
    assert found.errors["solver"] >= fake.residual * (1.0 - 1e-12)
    assert found.periods == count
    assert found.iterations == 10 * sum(range(count + 1))
    assert found.work == 100 * sum(range(count + 1))


def certified(fake, axes, tolerance):
    found = certify(fake, COARSEST, axes, tolerance)
    check(fake, found, axes, tolerance)
    return found


# Distances from the periodic state and residuals enter as the runs enter the answer

PLANS = {
    "cells": (axis("cells"),),
    "steps": (axis("steps"),),
    "cells, angles, steps": (axis("cells"), axis("angles", base=2), axis("steps", base=5)),
    "mixed steps": (axis("cells"), replace(axis("steps"), mixed=True)),
    "fitted": (replace(axis("cells"), regular=False, first=(2, 3, 4, 5), fitted=True),),
}


@pytest.mark.parametrize("axes", PLANS.values(), ids=PLANS)
def test_periodicity_and_solver_errors_are_weighted_sums_over_the_runs(axes):
    """The answer is changed by each run in turn; its response is the weight of the run."""
    terms = (0.02, {"cells": 2}), (0.01, {"angles": 2}), (0.03, {"steps": 2})
    fake = FakeRun(*terms)
    found = certified(fake, axes, 1e-2)
    step = 1e-7  # small enough for the same runs to be enough

    def response(moved):
        again = FakeRun(*terms)

        def run(resolution, guess):
            one = again(resolution, guess)
            return replace(one, mu=one.mu + step) if resolution == moved else one

        return abs(certify(run, COARSEST, axes, 1e-2).mu - found.mu) / step

    weights = np.array([response(resolution) for resolution in fake.asked])
    for source, name in (("periodicity", "distance"), ("solver", "solver_residual")):
        expected = weights @ [getattr(run, name) for run in fake.runs]
        assert found.errors[source] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("axes", PLANS.values(), ids=PLANS)
def test_runs_that_keep_to_their_tolerance_leave_the_answer_its_share(axes):
    allowed = run_tolerance(COARSEST, axes, 1e-2)
    fake = FakeRun((0.02, {"cells": 2}), distance=0.0)

    def run(resolution, guess):
        return replace(fake(resolution, guess), distance=allowed)

    found = certify(run, COARSEST, axes, 1e-2)
    assert len(fake.asked) == len(set(fake.asked)) and found.converged
    assert found.errors["periodicity"] == pytest.approx(PERIODICITY_SHARE * 1e-2, rel=1e-9)


# Errors are covered


@pytest.mark.parametrize("coefficient", [-3.0, 0.1, 5.0])
def test_second_order_in_cells_is_extrapolated_to_the_exact_value(coefficient):
    fake = FakeRun((coefficient, {"cells": 2}))
    found = certified(fake, (axis("cells"),), 1e-4)
    assert found.converged and found.mu == pytest.approx(EXACT, abs=1e-12)
    assert found.torque == pytest.approx(EXACT_TORQUE, abs=1e-12)
    # most of what was extrapolated stays as error, times what random points call for
    finest = max(fake.asked)
    assert found.finest == finest
    share = CALIBRATED * EXTRAPOLATED_SHARES[0] * abs(fake.excess(finest))
    expected = max(share, RESOLVED * 1e-4)
    assert found.errors["space"] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "power"),
    [
        *product(["cells", "angles", "steps"], [1.5, 1.75, 2.0, 2.5, 3.0]),
        *product(["angles", "steps"], [1.0, 1.25]),
    ],
)
def test_smooth_errors_are_covered(name, power):
    for coefficient, tolerance in product((-10.0, -0.1, 0.01, 1.0), (1e-2, 1e-3, 1e-4)):
        fake = FakeRun((coefficient, {name: power}))
        found = certified(fake, (axis(name),), tolerance)
        assert abs(found.mu - EXACT) <= found.error
        assert abs(found.torque - EXACT_TORQUE) <= found.torque_error + 2e-9


def test_first_order_in_cells_is_underestimated_by_less_than_two():
    """What is said to converge with the second power, but does not, is not quite covered."""
    found = certified(FakeRun((0.1, {"cells": 1})), (axis("cells"),), 1e-3)
    assert abs(found.mu - EXACT) < 2.0 * found.error


coefficients = st.tuples(st.sampled_from([-1.0, 1.0]), st.floats(-2.0, 1.0)).map(
    lambda c: c[0] * 10 ** c[1]
)


@pytest.mark.long
@settings(max_examples=100, deadline=None, derandomize=True)
@given(
    st.tuples(coefficients, coefficients, coefficients),
    st.floats(1.2, 3.0),
    st.floats(-4.0, -1.0).map(lambda x: 10**x),
)
def test_errors_along_three_axes_are_covered(c, power, tolerance):
    fake = FakeRun((c[0], {"cells": 2}), (c[1], {"angles": power}), (c[2], {"steps": power}))
    found = certified(
        fake, (axis("cells"), axis("angles", base=2), axis("steps", base=5)), tolerance
    )
    assert abs(found.mu - EXACT) <= found.error
    assert abs(found.torque - EXACT_TORQUE) <= 2.0 * found.error


def share_covered(scatter, *terms, axes=("cells", "angles", "steps")):
    """Share of certificates that hold, over random coefficients."""
    draw, held = np.random.default_rng(7), []
    for _ in range(100):
        c = draw.choice([-1.0, 1.0], len(terms)) * 10 ** draw.uniform(-2.0, 0.5, len(terms))
        fake = FakeRun(*zip(c, terms, strict=True), scatter=scatter)
        found = certified(fake, [axis(name) for name in axes], 10 ** draw.uniform(-4.0, -2.0))
        held.append(abs(found.mu - EXACT) <= found.error)
    return np.mean(held)


SEPARATE = ({"cells": 2}, {"angles": 2}, {"steps": 2})


@pytest.mark.long
def test_scattered_errors_are_covered_nearly_always():
    assert share_covered(0.5, *SEPARATE) > 0.98
    assert share_covered(0.3, {"steps": 2}, axes=["steps"]) > 0.98


@pytest.mark.long
def test_mixed_errors_are_covered():
    mixed = {"cells": 2, "angles": 2}
    assert share_covered(0.0, *SEPARATE, mixed) > 0.98
    assert share_covered(0.0, *SEPARATE, mixed, {"cells": 1, "steps": 2}) > 0.98


# How the runs are chosen


def test_first_run_is_the_base_and_guesses_are_runs_at_the_base():
    fake = FakeRun((3.0, {"cells": 2}), (0.2, {"steps": 2}))
    certified(fake, (axis("cells", base=4), axis("steps", base=5)), 1e-3)
    assert fake.asked[0] == Resolution(cells=16, angles=1, steps=24)
    assert fake.guesses[0] is None
    assert all(guess is fake.runs[0] for guess in fake.guesses[1:])
    # each chain goes along its own axis: no run is fine in both
    assert all(r.cells == 16 or r.steps == 24 for r in fake.asked)
    assert all(r.angles == COARSEST.angles for r in fake.asked)


def test_nothing_is_refined_that_is_fine_enough():
    fake = FakeRun((0.1, {"cells": 2}), (0.1, {"steps": 2}))
    found = certified(fake, (axis("cells"), axis("steps")), 1e-2)
    assert found.converged and len(fake.asked) == 5
    assert found.finest == Resolution(16, 1, 16)
    # finer was not run, and no smaller error is claimed
    assert 0.05 < RESOLVED < 0.3
    assert found.errors["space"] >= RESOLVED * 1e-2 and found.errors["time"] >= RESOLVED * 1e-2


def test_another_axis_makes_room_for_one_that_is_at_its_finest():
    cells, angles = axis("cells", regular=False, most=5), axis("angles", regular=False)
    # spreads of 8, 12, 16 cells and of 6, 8, 12 angles: errors of 0.6 and 0.5 tolerances
    of_cells = 0.6e-3 / SPREAD / (8**-2 - 16**-2)
    of_angles = 0.5e-3 / SPREAD / (6**-2 - 12**-2)
    fake = FakeRun((of_cells, {"cells": 2}), (of_angles, {"angles": 2}))
    found = certified(fake, (cells, angles), 1e-3)
    assert found.converged and (found.finest.cells, found.finest.angles) == (16, 16)
    # beyond a tolerance no other axis can make room for it, and none is tried
    fake = FakeRun((2.0 * of_cells, {"cells": 2}), (of_angles, {"angles": 2}))
    found = certified(fake, (cells, angles), 1e-3)
    assert found.reason.endswith("over cells is still 1.2e-03 at 16") and found.finest.angles == 12


@pytest.mark.parametrize("judged", [0, 4])
def test_an_axis_that_was_refined_is_judged_by_its_last_runs(judged):
    cells = Axis("cells", LEVELS["cells"], 0, tuple(range(6)), judged=judged)
    fake = FakeRun((1.0, {"cells": 2}))
    found = certified(fake, (cells,), 1e-2)
    last = [n**-2 for n in LEVELS["cells"] if n <= found.finest.cells][-(judged or 6) :]
    assert len(fake.asked) > 6 and found.errors["space"] == pytest.approx(
        SPREAD * (last[0] - last[-1])
    )
    # as many as it began with, before
    assert certify(fake, COARSEST, (cells,), 0.1).errors["space"] == pytest.approx(
        SPREAD * (4**-2 - 24**-2)
    )


def test_imposed_axes_are_reported_but_not_refined():
    terms = (5.0, {"cells": 2}), (1.0, {"steps": 2})
    fake = FakeRun(*terms)
    found = certified(fake, (imposed("cells", 10), axis("steps")), 1e-3)
    assert {r.cells for r in fake.asked} == {5, 10}
    assert found.finest.cells == 10 and found.mu - EXACT == pytest.approx(5e-2, abs=1e-3)
    assert found.errors["space"] == pytest.approx(5.0 * (5**-2 - 10**-2), rel=1e-9)
    # what is left to the tolerance keeps to it all the same
    assert found.errors["time"] <= 1e-3 and found.reason == ""


def test_imposed_axes_alone_take_three_runs():
    fake = FakeRun((5.0, {"cells": 2}), (1.0, {"steps": 2}))
    found = certified(fake, (imposed("cells", 10), imposed("steps", 8)), 1e-3)
    at = [(r.cells, r.steps) for r in fake.asked]
    assert at[0] == (10, 8) and set(at) == {(10, 8), (5, 8), (10, 4)}
    assert found.mu == fake.runs[0].mu and found.reason == ""


def test_without_axes_there_is_one_run():
    found = certified(fake := FakeRun(), (), 1e-3)
    assert fake.asked == [COARSEST] == [found.finest] and found.mu == EXACT and found.converged


# What ends it


@pytest.mark.parametrize(
    ("failing", "count"),
    [(Resolution(12, 1, 12), 5), (Resolution(8, 1, 12), 5), (Resolution(48, 1, 12), 8)],
)
def test_a_run_that_does_not_converge_ends_it(failing, count):
    fake = FakeRun((10.0, {"cells": 2}), fails=[failing])
    found = certified(fake, (axis("cells"), axis("steps")), 1e-4)
    assert not found.converged and found.reason == "lost its way"
    assert failing in fake.asked and len(fake.asked) == count


@pytest.mark.parametrize("name", ["cells", "angles", "steps"])
def test_exhausted_levels_are_named(name):
    fake = FakeRun((1e3, {name: 2}))
    found = certified(fake, (axis(name, most=7),), 1e-4)
    last = LEVELS[name][6]
    assert not found.converged and getattr(fake.asked[-1], name) == last
    assert f"over {name} " in found.reason and found.reason.endswith(f"at {last}")
    assert f"{found.errors['time' if name == 'steps' else 'space']:.1e}" in found.reason
    assert abs(found.mu - EXACT) <= found.error


def test_errors_that_no_refinement_cures_are_reported():
    for spoilt in ({"distance": 3e-3}, {"residual": 1e-3}):
        fake = FakeRun((0.1, {"cells": 2}), **spoilt)
        assert certified(fake, (axis("cells"),), 1e-3).error > 1e-3 and len(fake.asked) < 8


# Corrections that do not add up


def test_mixed_difference_is_added_and_counts_as_error():
    fake = FakeRun((0.5, {"cells": 1, "angles": 1}), (0.1, {"cells": 1}), (-0.2, {"angles": 1}))
    axes = axis("cells", regular=False), axis("angles")
    found = certified(fake, axes, 1e-1)
    # nothing is extrapolated here, so that all corrections together end at the finest resolution
    assert found.finest == Resolution(16, 12, 5) == fake.asked[-1]
    assert found.mu == pytest.approx(EXACT + fake.excess(found.finest), abs=1e-14)
    failing_to_add_up = CALIBRATED * 0.5 * (1 / 12 - 1 / 16) * (1 / 8 - 1 / 12)
    spread = {name: np.ptp([run.mu for run in along(fake, name)]) for name in ("cells", "angles")}
    seen = [max(SPREAD * one, RESOLVED * 1e-1) for one in spread.values()]
    expected = failing_to_add_up + sum(seen)
    assert found.errors["space"] == pytest.approx(expected, rel=1e-9)


def test_errors_in_time_that_cancel_on_the_base_are_seen_where_they_are_measured():
    """On the cells of the base all steps agree, and on others they do not."""
    for regular, coefficient in product((True, False), (3.0, -3.0)):
        base = LEVELS["cells"][3]
        cancels = -coefficient * base**12, {"steps": 2, "cells": 12}
        terms = (coefficient, {"steps": 2}), cancels, (0.02, {"cells": 2})
        doubled = replace(axis("steps"), first=(1, 3, 5))
        alone, measured = (
            certified(FakeRun(*terms), (axis("cells", regular), steps), 1e-2)
            for steps in (doubled, replace(doubled, mixed=True))
        )
        assert alone.converged and abs(alone.mu - EXACT) > alone.error
        assert measured.converged and abs(measured.mu - EXACT) <= measured.error


def along(fake, name):
    """Runs that differ from the first one along this axis alone."""
    first, *_ = fake.asked
    pairs = zip(fake.runs, fake.asked, strict=True)
    return [run for run, asked in pairs if replace(asked, **{name: getattr(first, name)}) == first]


def test_base_is_refined_where_a_mixed_term_dominates():
    fake = FakeRun((30.0, {"cells": 2, "angles": 2}))
    found = certified(fake, (axis("cells"), axis("angles", base=2)), 1e-3)
    assert found.converged and abs(found.mu - EXACT) <= found.error <= 1e-3
    bases = {id(guess): fake.asked[fake.runs.index(guess)] for guess in fake.guesses if guess}
    assert len(bases) > 1  # guesses come from each base in turn
    for one, next_one in zip(list(bases.values())[:-1], list(bases.values())[1:], strict=True):
        assert next_one.cells > one.cells and next_one.angles > one.angles


def test_base_in_time_is_refined_where_time_scatters():
    """The scatter of coarse steps hides what the rings do."""
    fake = FakeRun((30.0, {"steps": 2}), (1.0, {"cells": 2}), scatter=0.1)
    found = certified(fake, (axis("cells"), axis("steps", base=2)), 1e-2)
    assert found.converged and abs(found.mu - EXACT) <= found.error
    used = [r.steps for r in fake.asked if r.cells != 12]
    assert used[0] == 8 and used[-1] >= 24
    # half of what the steps still change counts as what their scatter may hide
    last = max(LEVELS["steps"][k] for k, n in enumerate(LEVELS["steps"]) if n in used)
    correction = 30.0 * (found.finest.steps**-2 - last**-2)
    assert found.errors["time"] >= 0.4 * abs(correction)


def test_rebasing_ends():
    fake = FakeRun((1e4, {"cells": 2, "angles": 2}))
    found = certified(fake, (axis("cells", base=1), axis("angles", base=1)), 1e-5)
    assert not found.converged and "error over" in found.reason
    guessed_from = {id(guess) for guess in fake.guesses if guess is not None}
    assert MOST_REBASED <= len(guessed_from) <= 1 + MOST_REBASED


# Budgets


class Limited(FakeRun):
    """... that may be asked so many times only."""

    def __init__(self, most, *terms):
        super().__init__(*terms)
        self.most = most

    def __call__(self, resolution, guess):
        if len(self.asked) == self.most:
            raise Spent("all is spent")
        return super().__call__(resolution, guess)


def test_what_was_known_before_the_budget_was_spent_is_the_answer():
    term = (1.0, {"steps": 2})
    axes = (axis("steps", base=2),)
    enough = certify(FakeRun(term), COARSEST, axes, 0.02)
    found = certify(Limited(4, term), COARSEST, axes, 1e-6)
    assert not found.converged
    assert found.reason == f"all is spent: the error is still {found.error:.1e}"
    assert abs(found.mu - EXACT) <= found.error
    assert found.finest.steps >= enough.finest.steps


def test_of_a_budget_that_is_spent_at_once_nothing_is_known():
    found = certify(Limited(1, (1.0, {"steps": 2})), COARSEST, (axis("steps"),), 1e-3)
    assert not found.converged and np.isnan(found.mu) and found.error == np.inf
    assert found.reason == "all is spent: no error is known yet"
