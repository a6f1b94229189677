"""Uncertain inputs: static limit and outcomes, against a Monte Carlo of closed forms."""

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
    assert several == pytest.approx(
        shares, abs=0.012 + max(result.probability_stays_error, result.probability_moves_error)
    )
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
    assert result.probability_stays is None


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


def test_draws_above_the_largest_physical_value_count_as_that_value():
    """Poisson's ratio is at most 0.5: its upper quantile, 0.59, counts as 0.5."""
    result = microslip.predict("bore", **SPIN | {"nu": "0.3 +- 0.15"})
    ends = [microslip.predict("bore", **SPIN | {"nu": nu}).mu_static for nu in (0.006, 0.5)]
    assert [result.mu_static_low, result.mu_static_high] == pytest.approx(ends, rel=5e-3)


@pytest.mark.slow
def test_a_contact_that_stays_one_deviation_around_its_inputs_may_move():
    """The force is 1.5 standard deviations below the threshold; 6.68 % of the draws are above."""
    settings = JOINT | {"amplitude": "0.25 um"}
    threshold = microslip.predict("transverse", **settings, speed=0.0).force_threshold_N
    result = microslip.predict("transverse", **settings, force=f"{threshold - 3.0!r} N +- 2 N")
    assert result.outcome == "stays" and result.speed_spread_m_s > 0.0
    assert result.probability_moves == pytest.approx(0.0668, abs=2e-3)


def test_all_outputs_of_a_spin_have_the_spread_of_a_monte_carlo():
    """10^5 draws of the closed forms (Eqs 21 and 22, v~ <= 1) have a statistical error of 1 %."""
    request = BALL | {"mu": "0.3 +- 0.03", "frequency": None, "speed": "0.2 mm/s +- 10 %"}
    request |= {"rotation": "10 rad/s +- 5 %", "load": "10 N +- 5 %", "radius": "5 mm +- 10 %"}
    request |= {"wear_coefficient": "1e-14 m^2/N +- 20 %"}
    result = microslip.predict("continuous-bore", **request)
    draw = np.random.default_rng(0).standard_normal((6, 100_000))
    mu, load, radius = 0.3 + 0.03 * draw[0], 10.0 + 0.5 * draw[1], 5e-3 * (1.0 + 0.1 * draw[2])
    speed, turn = 0.2e-3 * (1.0 + 0.1 * draw[3]), 10.0 * (1.0 + 0.05 * draw[4])
    a = (0.75 * load * radius / 210e9) ** (1.0 / 3.0)
    v = speed / (turn * a)
    assert v.max() < 1.0
    force = mu * load * 3.0 * math.pi / 8.0 * (v - v**3 / 4.0)
    torque = 3.0 * math.pi / 16.0 * mu * load * a * (1.0 - v**2 + 0.375 * v**4)
    energy = (force * speed + torque * turn) * 2.0 * math.pi / turn
    drawn = {"friction_force_N": force, "torque_N_m": torque, "energy_per_cycle_J": energy}
    drawn |= {"drag_power_W": force * speed, "vibration_power_W": torque * turn}
    drawn |= {"wear_volume_per_cycle_m3": 1e-14 * (1.0 + 0.2 * draw[5]) / mu * energy}
    columns = result.to_dict()
    for name, values in drawn.items():
        stem, _, unit = name.rpartition("_")
        stem, unit = ("torque", "N_m") if stem.startswith("torque") else (stem, unit)
        assert columns[f"{stem}_spread_{unit}"] == pytest.approx(values.std(), rel=0.03), name
        ends = np.quantile(values, (0.025, 0.975))
        found = [columns[f"{stem}_{side}_{unit}"] for side in ("low", "high")]
        assert found == pytest.approx(ends, rel=0.02, abs=0.02 * values.std()), name


@pytest.mark.parametrize(
    ("name", "text"), [("nu", "0.49 +- 0.02"), ("mu", "0.1 +- 0.1"), ("mu", "9 +- 5")]
)
def test_draws_outside_a_range_count_as_its_end(name, text):
    """The draws of nu end at 0.5, those of mu at 0 and at 10."""
    spin = BALL | {"frequency": None, "rotation": 10.0, "speed": "1 mm/s", name: text}
    result = microslip.predict("continuous-bore", **spin)
    low, high = getattr(result, f"{name}_low"), getattr(result, f"{name}_high")
    centre, deviation = (float(one) for one in text.split("+-"))
    ends = [centre - 1.959964 * deviation, centre + 1.959964 * deviation]
    limits = {"nu": (0.0, 0.5), "mu": (0.0, 10.0)}[name]
    assert [low, high] == pytest.approx(np.clip(ends, *limits), abs=1e-3 * centre)
    assert math.isfinite(result.friction_force_spread_N)
