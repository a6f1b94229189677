"""Uncertain inputs: static limit and outcomes, against a Monte Carlo of closed forms."""

import math

import numpy as np
import pytest

import microslip
from microslip.si.printed_lines import probability_text
from microslip.theory import paper

STEEL = {"young": "210 GPa", "nu": 0.0}
JOINT = STEEL | {"radius": "200 mm", "load": "1 kN", "mu": 0.15, "frequency": "50 Hz"}
JOINT |= {"tolerance": 0.01}
SHAKEN = JOINT | {"amplitude": "0.25 um", "force": "90 N"}
BALL = STEEL | {"radius": "5 mm", "load": "10 N", "mu": 0.3, "frequency": "20 kHz"}
SPIN = BALL | {"amplitude": "0.5 deg", "speed": "1 mm/s", "frequency": "50 Hz"}
PAIR = STEEL | {"counterbody": "210 GPa, 0", "radius": "20 mm", "load": "200 N", "mu": 0.2}
PAIR |= {"frequency": "60 Hz"}
U_LIM_OF_PAIR = 0.2 * (0.75 * 200.0 * 0.02 / 105e9) ** (2.0 / 3.0) / 0.02
"""u_lim = mu a^2 / R, with a^3 = 3 F R / (4 E*)."""


def monte_carlo(mu, load, amplitude, force):
    """Fractions of draws that stay, move and run away, and their thresholds, in closed form.

    The counterbody is rigid and nu = 0, so a^3 = 3 F R / (4 E) and u_lim = mu d.
    """
    radius, draw = 0.2, np.random.default_rng(7).standard_normal((4, 20_000))
    mu, load, amplitude, force = (
        value + deviation * one
        for (value, deviation), one in zip((mu, load, amplitude, force), draw, strict=True)
    )
    mu, load = np.maximum(mu, 1e-9), np.maximum(load, 1e-9)
    a = (0.75 * load * radius / 210e9) ** (1.0 / 3.0)
    u_lim = mu * a**2 / radius
    threshold = mu * load * static_limit(np.abs(amplitude) / u_lim)
    stays, away = force < threshold, force >= mu * load
    return np.mean(stays), np.mean(~stays & ~away), np.mean(away), threshold


def static_limit(size):
    """The static limit of a transverse vibration, interpolated in its closed form."""
    grid = np.linspace(0.0, 1.0, 401)
    return np.interp(size, grid, [float(paper.static_limit_transverse(one)) for one in grid])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("settings", "drawn"),
    [
        ({"mu": "0.15 +- 0.05"}, {"mu": (0.15, 0.05)}),
        ({"force": "90 N +- 5 %"}, {"force": (90.0, 4.5)}),
        ({"amplitude": "0.25 um +- 0.05 um"}, {"amplitude": (0.25e-6, 0.05e-6)}),
        (
            {"mu": "0.15 +- 0.01", "load": "1 kN +- 5 %", "force": "80 N +- 10 N"},
            {"mu": (0.15, 0.01), "load": (1e3, 50.0), "force": (80.0, 10.0)},
        ),
    ],
    ids=lambda one: "-".join(one),
)
def test_outcomes_and_intervals_are_those_of_a_monte_carlo(settings, drawn):
    """The probabilities of 20 000 draws have statistical errors below 0.004."""
    result = microslip.predict("transverse", **SHAKEN | settings)
    exact = {"mu": (0.15, 0.0), "load": (1e3, 0.0), "amplitude": (0.25e-6, 0.0), "force": (90.0, 0)}
    *shares, threshold = monte_carlo(**exact | drawn)
    several = (result.probability_stays, result.probability_moves, result.probability_runs_away)
    assert several == pytest.approx(shares, abs=0.012 + result.probability_error)
    assert sum(several) == pytest.approx(1.0)
    low, high = np.quantile(threshold, (0.025, 0.975))
    assert result.force_threshold_low_N == pytest.approx(low, abs=2.0)
    assert result.force_threshold_high_N == pytest.approx(high, abs=2.0)
    assert result.force_threshold_spread_N == pytest.approx(threshold.std(), rel=0.04, abs=0.3)


def test_an_uncertain_load_moves_the_static_friction_of_a_spin():
    """The interval of the static limit follows from the interval of the load."""
    result = microslip.predict("bore", **SPIN | {"load": "10 N +- 10 %"})
    ends = [
        microslip.predict("bore", **SPIN | {"load": 10.0 + sign * 1.959964}).mu_static
        for sign in (-1.0, 1.0)
    ]
    assert [result.mu_static_low, result.mu_static_high] == pytest.approx(sorted(ends), rel=2e-3)
    assert result.probability_stays is None and result.interval_method == "quantiles"
    assert "to first order" not in str(result)


def test_without_uncertain_inputs_there_is_no_probability():
    result = microslip.predict("transverse", **SHAKEN)
    assert result.probability_stays is None and result.force_threshold_spread_N is None
    assert math.isfinite(result.safety_factor_error)
    assert "probability" not in str(result)


def test_a_contact_that_may_run_away_has_no_spread_of_its_speed():
    """Friction of 3 N +- 0.2 N is below the force of 2.9 N at one standard deviation."""
    settings = BALL | {"mu": "0.3 +- 0.02", "amplitude": 0.0, "force": "2.9 N"}
    result = microslip.predict("transverse", **settings)
    assert math.isinf(result.speed_spread_m_s) and "nan" not in str(result)
    assert result.probability_stays == pytest.approx(0.6915, abs=1e-3)  # 0.5 deviations above


@pytest.mark.filterwarnings("error")
def test_a_steady_spin_gives_way_to_any_force_that_is_drawn():
    settings = BALL | {"frequency": None, "rotation": 10.0, "force": "1 N +- 0.9 N"}
    result, again = (microslip.predict("continuous-bore", **settings) for _ in range(2))
    assert (result.probability_stays, result.safety_factor_high) == (0.0, 0.0)
    assert result.probability_runs_away == pytest.approx(0.0131, abs=1e-3)  # 2 / 0.9 deviations
    assert result.to_dict() == again.to_dict()  # equal inputs have equal draws


@pytest.mark.slow
def test_the_threshold_beside_a_reduction_has_an_interval():
    settings = BALL | {"speed": "0.3 mm/s +- 5 %", "reduction": "30 %", "tolerance": 0.02}
    result = microslip.predict("transverse", **settings)
    ends = result.force_threshold_low_N, result.force_threshold_high_N
    deviation = result.force_threshold_spread_N
    assert deviation > 0.0 and result.interval_method == "first order"
    assert ends == pytest.approx(
        [result.force_threshold_N + sign * 1.959964 * deviation for sign in (-1, 1)]
    )
    (line, again) = [line for line in str(result).splitlines() if "95 % interval" in line]
    for text in (line, again):
        assert "from the uncertain inputs to first order" in text


@pytest.mark.long
def test_an_uncertain_ratio_of_amplitudes_has_an_interval_to_first_order():
    """The standard deviation is half the difference of static friction at both ends.

    The interval is that of a normal distribution, 1.96 standard deviations on either side.
    """
    settings = BALL | {"speed": "10 mm/s", "tolerance": 0.05}
    settings |= {"rotation_amplitude": "0.05 deg", "phase": "90 deg"}
    result = microslip.predict("transverse-bore", **settings | {"amplitude": "0.1 um +- 5 %"})
    low, high = (
        microslip.predict("transverse-bore", **settings | {"amplitude": size}).mu_static
        for size in (0.095e-6, 0.105e-6)
    )
    assert result.interval_method == "first order"
    assert result.mu_static_spread == pytest.approx(0.5 * abs(high - low), rel=0.02)
    ends = [result.mu_static + 1.96 * (high - result.mu_static)]
    ends.append(result.mu_static + 1.96 * (low - result.mu_static))
    assert [result.mu_static_low, result.mu_static_high] == pytest.approx(sorted(ends), rel=1e-3)
    assert "to first order: static friction is assumed" in str(result)


@pytest.mark.slow
@pytest.mark.parametrize("deviation", [0.395, 0.42])
def test_an_amplitude_that_may_be_almost_zero_has_an_exact_interval(deviation):
    """The threshold decreases with the amplitude, so their quantiles correspond.

    A negative amplitude counts as 0, where the threshold is mu F_z.
    """
    settings = PAIR | {"force": "20 N", "amplitude": f"0.8 um +- {deviation} um"}
    result = microslip.predict("transverse", **settings)
    least = max(0.0, 0.8e-6 - 1.959964 * deviation * 1e-6) / U_LIM_OF_PAIR
    exact = 40.0 * float(paper.static_limit_transverse(least))
    assert result.force_threshold_high_N == pytest.approx(exact, abs=5e-3)
    assert result.safety_factor_high == pytest.approx(exact / 20.0, abs=2.5e-4)
    draws = np.maximum(0.8 + deviation * np.random.default_rng(3).standard_normal(200_000), 0.0)
    threshold = 40.0 * static_limit(draws * 1e-6 / U_LIM_OF_PAIR)
    assert result.force_threshold_spread_N == pytest.approx(threshold.std(), rel=0.02)
    assert result.probability_stays == pytest.approx(np.mean(threshold > 20.0), abs=5e-3)


def test_a_force_that_may_vanish_has_an_unbounded_safety_factor():
    """Of the forces 0.5 N +- 0.49 N, 15 % are negative and count as 0.

    The upper quantile of the force, 0.5 N + 1.959964 * 0.49 N, gives the lower end of the safety
    factor.
    """
    result = microslip.predict("transverse", **BALL, amplitude=0.0, force="0.5 N +- 0.49 N")
    low, high = result.safety_factor_low, result.safety_factor_high
    assert low == pytest.approx(3.0 / (0.5 + 1.959964 * 0.49), rel=1e-3)
    assert high == math.inf and "to inf" in str(result)


@pytest.mark.slow
def test_an_unlikely_outcome_has_a_bound_of_its_probability():
    """The contact stays only at an amplitude 4 standard deviations below its centre."""
    settings = PAIR | {"force": "38 N", "amplitude": "0.3 um +- 0.05 um"}
    result = microslip.predict("transverse", **settings)
    draws = 0.3 + 0.05 * np.random.default_rng(5).standard_normal(1_000_000)
    threshold = 40.0 * static_limit(draws * 1e-6 / U_LIM_OF_PAIR)
    share = np.mean(threshold > 38.0)
    assert 0.0 < share < 1e-4
    assert abs(result.probability_stays - share) <= result.probability_error
    message = "below 0.1 % that it stays, above 99.9 % that it moves, below 0.1 % that it runs away"
    assert message in str(result)


def test_draws_above_the_largest_physical_value_count_as_that_value():
    """Poisson's ratio is at most 0.5: its upper quantile, 0.59, counts as 0.5."""
    result = microslip.predict("bore", **SPIN | {"nu": "0.3 +- 0.15"})
    ends = [microslip.predict("bore", **SPIN | {"nu": nu}).mu_static for nu in (0.006, 0.5)]
    assert [result.mu_static_low, result.mu_static_high] == pytest.approx(ends, rel=5e-3)


@pytest.mark.parametrize(
    ("chance", "error", "text"),
    [
        (0.5, 0.001, "50.00 +- 0.10 %"),
        (0.0, 0.0, "below 0.1 %"),
        (1.0, 2e-4, "above 99.9 %"),
        (0.004, 0.0123, "below 1.7 %"),
        (0.995, 0.0123, "above 98.2 %"),
    ],
)
def test_a_probability_is_printed_with_its_error_or_a_bound(chance, error, text):
    """The bound includes the error: 0.4 % + 1.23 % is rounded up to 1.7 %."""
    assert probability_text(chance, error) == text


@pytest.mark.slow
def test_a_contact_that_stays_one_deviation_around_its_inputs_may_move():
    """The force is 1.5 standard deviations below the threshold; 6.68 % of the draws are above."""
    settings = JOINT | {"amplitude": "0.25 um"}
    threshold = microslip.predict("transverse", **settings, speed=0.0).force_threshold_N
    result = microslip.predict("transverse", **settings, force=f"{threshold - 3.0!r} N +- 2 N")
    assert result.outcome == "stays" and result.speed_spread_m_s == 0.0
    assert result.probability_moves == pytest.approx(0.0668, abs=2e-3)
    assert "none of the speed: the contact can move" in str(result)
