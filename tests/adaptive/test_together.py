"""Rings, angles and steps of a bore refined together, and runs that start from coarser ones."""

import math

import numpy as np
import pytest

import microslip
from microslip.adaptive.chains import FITTED_SHARES, Axis
from microslip.adaptive.refinement import certify
from microslip.adaptive.resolutions import TOGETHER_FROM, TOGETHER_RESOLVED, plan
from microslip.contacts import splitting
from microslip.models.contact import forward_slip, full_slip
from microslip.models.polar import contact as polar
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.solver.discretise import Resolution, contact_of
from microslip.solver.run import Run
from microslip.solver.simulate import simulate

EXACT = 0.4
CELLS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)
TIED = ("angles", tuple(n // 2 for n in CELLS)), ("steps", tuple(3 * n // 2 for n in CELLS))
BORE = Problem(motion_named("bore"), 0.3, 1.0, 0.0)


def together(first=0):
    four = tuple(range(first, first + 4))
    return Axis("cells", CELLS, first, four, tied=TIED, fitted=True, resolved=TOGETHER_RESOLVED)


class FakeRun:
    """Runs whose mu is EXACT and errors of a power of all levels, of which a share is random."""

    def __init__(self, coefficients, scatter=0.0, seed=0, power=2):
        self.coefficients, self.scatter, self.seed = coefficients, scatter, seed
        self.power = power
        self.asked, self.guesses, self.runs = [], [], []

    def __call__(self, resolution, guess):
        levels = resolution.cells, resolution.angles, resolution.steps
        error = sum(c / n**self.power for c, n in zip(self.coefficients, levels, strict=True))
        draw = np.random.default_rng([self.seed, *levels])
        error *= 1.0 + self.scatter * draw.uniform(-1.0, 1.0)
        self.asked.append(levels)
        self.guesses.append(guess)
        self.runs.append(Run(EXACT + error, 1.0, 1e-9, 1e-9, 1.0, 1, 1, 1, 1, True, ""))
        return self.runs[-1]


def certified(fake, tolerance, first=0):
    return certify(fake, Resolution(1, 1, 4), (together(first),), tolerance)


def test_an_error_of_second_order_is_extrapolated_to_the_exact_value():
    fake = FakeRun((1.0, -0.3, 2.0))
    found = certified(fake, 1e-3)
    assert found.converged and found.mu == pytest.approx(EXACT, abs=1e-12)
    # what the last run may still be off, by the last difference alone
    h = [(1.0 - 1.2 + 2.0 / 2.25) / n**2 for n in CELLS]
    least = TOGETHER_RESOLVED * 1e-3
    share, _ = FITTED_SHARES
    assert found.errors["space"] == pytest.approx(max(share * h[len(fake.asked) - 1], least))
    assert found.errors["time"] == 0.0


@pytest.mark.parametrize("tolerance", [1e-3, 3e-4])
@pytest.mark.parametrize("coefficient", [-0.02, 0.03, 0.1])
def test_an_error_of_first_order_is_covered(coefficient, tolerance):
    found = certified(FakeRun((coefficient, 0.0, 0.0), power=1), tolerance, first=1)
    assert abs(found.mu - EXACT) <= found.error


@pytest.mark.slow
def test_few_rings_that_converge_slowly_are_refined():
    """From 8 to 16 rings the error of this bore falls with the first power only.  Separate chains
    from bases of 24 to 96 rings settle at 0.34733."""
    result = microslip.solve("bore", 0.11150298626945476, 3.3085697949922066)
    assert result.converged
    assert result.mu_macro == pytest.approx(0.34733, abs=result.mu_macro_error)


def test_all_levels_are_refined_at_once_each_run_from_the_one_before():
    fake = FakeRun((3.0, 1.0, 1.0), scatter=0.5)
    found = certified(fake, 1e-3, first=1)
    expected = [(CELLS[i], TIED[0][1][i], TIED[1][1][i]) for i in range(1, 1 + len(fake.asked))]
    assert fake.asked == expected and len(expected) > 4
    assert fake.guesses == [None, *fake.runs[:-1]]
    assert (found.finest.cells, found.finest.angles, found.finest.steps) == expected[-1]


@pytest.mark.long
def test_scattered_errors_are_covered_nearly_always():
    draw, held = np.random.default_rng(5), []
    for seed in range(400):
        size = 10.0 ** draw.uniform(-1.5, 0.3)
        found = certified(FakeRun((size, 0.3 * size, 0.1 * size), 0.3, seed), 1e-3)
        assert found.converged and found.error <= 1e-3
        held.append(abs(found.mu - EXACT) <= found.error)
    assert np.mean(held) > 0.98


@pytest.mark.parametrize(
    ("motion", "tolerance", "imposed"),
    [
        ("bore", 2.0 * TOGETHER_FROM, {}),
        ("bore", 1e-4, {"cells": 16}),
        ("bore", 1e-4, {"steps": 32}),
        ("transverse", 1e-4, {}),
    ],
)
def test_axes_are_apart_elsewhere(motion, tolerance, imposed):
    problem = Problem(motion_named(motion), 0.3, 1.0, 0.3)
    axes = plan(problem, "polar", tolerance, **imposed, together=True)[1]
    assert [axis.name for axis in axes] == ["cells", "angles", "steps"]


@pytest.mark.slow
def test_no_claim_goes_below_a_share_of_the_tolerance():
    for tolerance in (TOGETHER_FROM, 2e-4):
        result = microslip.solve("bore", 3.0, 0.5, tolerance=tolerance)
        assert result.converged and result.error_time == 0.0
        assert TOGETHER_RESOLVED * tolerance <= result.mu_macro_error <= tolerance
        assert result.angles > 2 and result.steps_per_period > 2 * result.angles


@pytest.mark.slow
@pytest.mark.parametrize(("velocity", "amplitude"), [(0.3, 1.0), (0.02, 0.5)])
def test_tight_claims_agree_with_separate_chains(velocity, amplitude):
    tight = microslip.solve("bore", velocity, amplitude, tolerance=2e-4)
    loose = microslip.solve("bore", velocity, amplitude, tolerance=1e-3)
    assert tight.converged and loose.converged
    apart = abs(tight.mu_macro - loose.mu_macro)
    assert apart <= tight.mu_macro_error + loose.mu_macro_error


# Tractions on other points


def contact(cells, angles):
    return contact_of(BORE, "polar", Resolution(cells, angles, 8))


def test_full_slip_stays_full_slip_on_finer_points():
    coarse, fine = contact(8, 6), contact(24, 16)
    np.testing.assert_allclose(
        fine.prolonged(forward_slip(coarse)), forward_slip(fine), rtol=0.0, atol=1e-14
    )


def test_turning_slip_is_interpolated_between_angles():
    coarse, fine = contact(8, 6), contact(24, 16)
    given, expected = (
        full_slip(one, one.lateral_position, -one.forward_position) for one in (coarse, fine)
    )
    # chords of a circle miss it by an eighth of the square of their angle
    off = np.abs(fine.prolonged(given) - expected) / fine.bound
    assert 0.0 < off.max() <= (math.pi / 6) ** 2 / 8.0


def test_a_run_from_a_coarser_one_ends_where_it_would_by_itself():
    fine = Resolution(24, 8, 16)
    coarse = simulate(BORE, "polar", Resolution(8, 6, 12), 1e-6)
    alone, led = (simulate(BORE, "polar", fine, 1e-6, guess) for guess in (None, coarse))
    assert alone.converged and led.converged and led.iterations < alone.iterations
    assert led.mu == pytest.approx(alone.mu, abs=2e-6)


@pytest.mark.parametrize("factor", [1 / 16, 16])
def test_the_penalty_takes_fewer_iterations_than_others(monkeypatch, factor):
    def iterations(rings):
        polar._prepared.cache_clear()
        monkeypatch.setattr(splitting, "BALANCED_RINGS", rings)
        return simulate(BORE, "polar", Resolution(48, 4, 12), 1e-5).iterations

    shipped, other = iterations(splitting.BALANCED_RINGS), iterations(12 * factor)
    polar._prepared.cache_clear()
    assert shipped < 0.95 * other
