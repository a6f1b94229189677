"""Uncertain inputs: spreads, intervals and outcomes, against closed forms and Monte Carlo."""

import math

import numpy as np
import pytest

import microslip
from microslip.theory import paper

STEEL = {"young": "210 GPa", "nu": 0.0}
JOINT = STEEL | {"radius": "200 mm", "load": "1 kN", "mu": 0.15, "frequency": "50 Hz"}
JOINT |= {"tolerance": 0.01}
SHAKEN = JOINT | {"amplitude": "0.25 um", "force": "90 N"}
BALL = STEEL | {"radius": "5 mm", "load": "10 N", "mu": 0.3, "frequency": "20 kHz"}
BORE = BALL | {"amplitude": "0.5 deg", "speed": "1 mm/s", "frequency": "50 Hz"}
SPIN = BALL | {"frequency": None, "speed": "1 mm/s", "rotation": "10 rad/s"}
PAIR = STEEL | {"counterbody": "210 GPa, 0", "radius": "20 mm", "load": "200 N", "mu": 0.2}
PAIR |= {"frequency": "60 Hz"}
U_LIM_OF_PAIR = 0.2 * (0.75 * 200.0 * 0.02 / 105e9) ** (2.0 / 3.0) / 0.02
"""u_lim = mu a^2 / R, with a^3 = 3 F R / (4 E*)."""
END = 1.959964
"""Quantile of a standard normal distribution at 97.5 %."""


def static_limit(size):
    """The static limit of a transverse vibration, interpolated in its closed form."""
    grid = np.linspace(0.0, 1.0, 401)
    return np.interp(size, grid, [float(paper.static_limit_transverse(one)) for one in grid])


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
    u_lim = mu * (0.75 * load * radius / 210e9) ** (2.0 / 3.0) / radius
    threshold = mu * load * static_limit(np.abs(amplitude) / u_lim)
    stays, away = force < threshold, force >= mu * load
    return np.mean(stays), np.mean(~stays & ~away), np.mean(away), threshold


@pytest.mark.slow
@pytest.mark.parametrize(
    ("settings", "drawn"),
    [
        ({"mu": "0.15 +- 0.05"}, {"mu": (0.15, 0.05)}),
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
    error = 0.012 + max(result.probability_stays_error, result.probability_moves_error)
    assert several == pytest.approx(shares, abs=error)
    assert sum(several) == pytest.approx(1.0)
    low, high = np.quantile(threshold, (0.025, 0.975))
    assert result.force_threshold_low_N == pytest.approx(low, abs=2.0)
    assert result.force_threshold_high_N == pytest.approx(high, abs=2.0)
    assert result.force_threshold_spread_N == pytest.approx(threshold.std(), rel=0.04, abs=0.3)


@pytest.mark.slow
@pytest.mark.parametrize("deviation", [0.395, 0.42])
def test_an_amplitude_that_may_be_almost_zero_has_an_exact_interval(deviation):
    """The threshold decreases with the amplitude, so their quantiles correspond.

    A negative amplitude counts as 0, where the threshold is mu F_z.
    """
    settings = PAIR | {"force": "20 N", "amplitude": f"0.8 um +- {deviation} um"}
    result = microslip.predict("transverse", **settings)
    least = max(0.0, 0.8e-6 - END * deviation * 1e-6) / U_LIM_OF_PAIR
    exact = 40.0 * float(paper.static_limit_transverse(least))
    assert result.force_threshold_high_N == pytest.approx(exact, abs=5e-3)
    assert result.safety_factor_high == pytest.approx(exact / 20.0, abs=2.5e-4)
    draws = np.maximum(0.8 + deviation * np.random.default_rng(3).standard_normal(200_000), 0.0)
    threshold = 40.0 * static_limit(draws * 1e-6 / U_LIM_OF_PAIR)
    assert result.force_threshold_spread_N == pytest.approx(threshold.std(), rel=0.02)
    assert result.probability_stays == pytest.approx(np.mean(threshold > 20.0), abs=5e-3)


@pytest.mark.parametrize(
    ("motion", "settings", "name", "values"),
    [
        # nu is at most 0.5: the draws above, up to its upper quantile of 0.59, count as 0.5
        ("bore", BORE | {"nu": "0.3 +- 0.15"}, "nu", (0.3 - END * 0.15, 0.5)),
        ("bore", BORE | {"load": "10 N +- 10 %"}, "load", (10.0 - END, 10.0 + END)),
        pytest.param(
            "transverse-bore",
            BALL
            | {"amplitude": "0.1 um +- 5 %", "rotation_amplitude": "0.05 deg"}
            | {"speed": "10 mm/s", "phase": "90 deg", "tolerance": 0.05},
            "amplitude",
            (0.1e-6 * (1 + 0.05 * END), 0.1e-6 * (1 - 0.05 * END)),
            marks=pytest.mark.long,
        ),
    ],
)
def test_the_ends_of_an_interval_are_the_values_at_the_quantiles_of_one_input(
    motion, settings, name, values
):
    """The static limit is monotonic in the input."""
    result = microslip.predict(motion, **settings)
    ends = [microslip.predict(motion, **settings | {name: one}).mu_static for one in values]
    assert [result.mu_static_low, result.mu_static_high] == pytest.approx(ends, rel=2e-3)
    assert result.probability_stays is None


def test_a_draw_without_a_result_of_the_solver_hides_no_limit_of_the_force():
    """The contact runs away if mu is below 0.09, 1.2 deviations below its value."""
    settings = JOINT | {"mu": "0.15 +- 0.05", "amplitude": 0.0, "force": "90 N"}
    result = microslip.predict("transverse", **settings)
    assert abs(result.probability_runs_away - 0.11507) <= result.probability_runs_away_error < 1e-3
    assert math.isinf(result.speed_spread_m_s) and "nan" not in str(result)
    rare = microslip.predict("transverse", **settings | {"mu": "0.15 +- 0.012"})  # 5 deviations
    assert abs(rare.probability_runs_away - 2.9e-7) <= rare.probability_runs_away_error < 1e-3


def test_a_force_that_may_vanish_has_an_unbounded_safety_factor():
    """Of the forces 0.5 N +- 0.49 N, 15 % are negative and count as 0.

    The upper quantile of the force gives the lower end of the safety factor.
    """
    result = microslip.predict("transverse", **BALL, amplitude=0.0, force="0.5 N +- 0.49 N")
    low, high = result.safety_factor_low, result.safety_factor_high
    assert low == pytest.approx(3.0 / (0.5 + END * 0.49), rel=1e-3)
    assert high == math.inf and "to inf" in str(result)


def spin(mu, load, radius, speed, turn, wear):
    """Outputs of a spin in closed form: Eqs 21 and 22, and Archard's law."""
    a = (0.75 * load * radius / 210e9) ** (1.0 / 3.0)
    v = speed / (turn * a)
    assert np.max(v) < 1.0
    force = mu * load * 3.0 * math.pi / 8.0 * (v - v**3 / 4.0)
    torque = 3.0 * math.pi / 16.0 * mu * load * a * (1.0 - v**2 + 0.375 * v**4)
    energy = (force * speed + torque * turn) * 2.0 * math.pi / turn
    result = {"friction_force": force, "torque": torque, "energy_per_cycle": energy}
    result |= {"drag_power": force * speed, "vibration_power": torque * turn}
    return result | {"wear_volume_per_cycle": wear / mu * energy}


def test_all_outputs_of_a_spin_have_the_spread_of_a_monte_carlo():
    """10^5 draws of the closed forms have a statistical error of 1 %."""
    request = SPIN | {"mu": "0.3 +- 0.03", "speed": "0.2 mm/s +- 10 %"}
    request |= {"rotation": "10 rad/s +- 5 %", "load": "10 N +- 5 %", "radius": "5 mm +- 10 %"}
    request |= {"wear_coefficient": "1e-14 m^2/N +- 20 %"}
    result = microslip.predict("continuous-bore", **request)
    exact = np.array([0.3, 10.0, 5e-3, 0.2e-3, 10.0, 1e-14])[:, None]
    shares = np.array([0.1, 0.05, 0.1, 0.1, 0.05, 0.2])[:, None]
    draws = exact * (1.0 + shares * np.random.default_rng(0).standard_normal((6, 100_000)))
    nominal, drawn = spin(*exact), spin(*draws)
    for name, values in drawn.items():
        one = result.values[name]
        assert one.value == pytest.approx(nominal[name][0], rel=2e-3), name
        assert one.spread == pytest.approx(values.std(), rel=0.03), name
        ends = np.quantile(values, (0.025, 0.975))
        assert [one.low, one.high] == pytest.approx(ends, rel=0.02, abs=0.02 * values.std()), name


def test_levels_outside_the_range_of_the_solver_are_replaced_by_nearer_ones():
    """At 1.13 standard deviations the amplitude is 1e6 times u_lim, the largest of the solver.

    At such amplitudes friction follows Eq 6.  Larger draws count as the largest solved one.
    """
    contact = STEEL | {"radius": "5 mm", "load": "1 nN", "mu": 0.3, "frequency": "2 kHz"}
    still = microslip.predict("transverse", **contact, amplitude=0.0, speed="1 mm/s")
    size = 0.885e6 * still.u_lim_m
    moving = contact | {"speed": 2.0 * math.pi * 2e3 * size, "amplitude": f"{size:.9g} m +- 10 %"}
    result = microslip.predict("transverse", **moving, tolerance=1e-2)
    draws = np.minimum(np.random.default_rng(0).standard_normal(20_000), 1.125)
    exact = [float(paper.large_amplitude_transverse(1.0, 1.0 + 0.1 * one)) for one in draws[:4000]]
    assert result.mu_macro_spread == pytest.approx(np.std(exact), rel=0.05)


# Two groups


@pytest.mark.long
def test_two_uncertain_inputs_of_a_bore_have_the_spread_of_direct_solves():
    """The standard deviation of 60 solves has a statistical error of about 9 %."""
    bore = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "frequency": "20 kHz"}
    bore |= {"tolerance": 0.01, "force": "1.2 N", "load": "10 N"}
    texts = {"mu": "0.3 +- 0.03", "amplitude": "12 mrad +- 2.4 mrad"}
    one = microslip.predict("bore", **bore | texts).values["speed"]
    values = []
    for x, y in np.random.default_rng(11).standard_normal((60, 2)):
        sizes = {"mu": 0.3 + 0.03 * x, "amplitude": 12e-3 + 2.4e-3 * y}
        values.append(microslip.predict("bore", **bore | sizes).speed_m_s)
    samples = np.random.default_rng(0).choice(values, (500, 60)).std(axis=1)
    assert abs(one.spread - np.std(values)) <= 2.5 * samples.std()


# Searches

SLIDER = {"material": "steel", "radius": "5 mm", "mu": 0.3, "frequency": "2 kHz"}


@pytest.mark.long
def test_the_result_of_a_search_has_the_relative_spread_of_the_input():
    """The friction of a rigid slider depends on the speed divided by the amplitude only."""
    request = SLIDER | {"load": "1 N", "speed": "1 m/s +- 5 %", "reduction": "50 %"}
    result = microslip.predict("transverse", **request)
    size = result.amplitude_m
    assert result.amplitude_spread_m == pytest.approx(0.05 * size, rel=1e-2)
    ends = [size * (1.0 - 0.05 * END), size * (1.0 + 0.05 * END)]
    assert [result.amplitude_low_m, result.amplitude_high_m] == pytest.approx(ends, rel=2e-3)
    assert result.mu_macro_spread == pytest.approx(0.0, abs=1e-3)


@pytest.mark.long
def test_where_an_end_has_no_answer_the_spread_is_infinite():
    """One end of the uncertain speed has no solution.

    Under a very small load the contact is a rigid slider.  By Eq 6 its friction falls by 22 % at
    0.8 times the velocity of the vibration, but by 18 % at 0.96 times.
    """
    speed = 0.8 * 2.0 * math.pi * 2e3 * 1e-6
    request = SLIDER | {"speed": f"{speed:.6g} m/s +- 20 %", "amplitude": "1 um"}
    result = microslip.predict("transverse", **request, reduction=0.2, tolerance=1e-2)
    assert result.converged and result.load_N > 0.0 and math.isinf(result.load_spread_N)
