"""Standard uncertainties of predictions, against closed forms and a Monte Carlo."""

import math

import numpy as np
import pytest

import microslip

BALL = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3}
SPIN = BALL | {"speed": "1 mm/s", "rotation": "10 rad/s"}


def test_a_spread_of_mu_alone_is_a_share_of_the_force():
    """The friction of a steady spin is independent of u_lim and proportional to mu."""
    result = microslip.predict("continuous-bore", **SPIN | {"mu": "0.3 +- 0.03"})
    assert result.friction_force_spread_N == pytest.approx(0.1 * result.friction_force_N, rel=1e-3)
    assert result.mu_apparent_spread == pytest.approx(0.1 * result.mu_apparent, rel=1e-3)
    assert result.mu_macro_spread == pytest.approx(0.0, abs=1e-12)
    assert result.inputs["mu"] == "0.3 +- 0.03"


def test_spreads_of_several_quantities_are_those_of_a_monte_carlo():
    """10^5 draws of the closed form (Eq 21, v~ <= 1) have a statistical error of 1 %."""
    request = BALL | {"speed": "0.2 mm/s", "rotation": "10 rad/s", "load": "10 N +- 5 %"}
    request |= {"mu": "0.3 +- 0.01", "radius": "5 mm ± 0.5 mm"}
    result = microslip.predict("continuous-bore", **request)
    draw = np.random.default_rng(0).standard_normal((3, 100_000))
    mu, load, radius = 0.3 + 0.01 * draw[0], 10.0 + 0.5 * draw[1], 5e-3 + 0.5e-3 * draw[2]
    a = (0.75 * load * radius / (210e9 / (2.0 * 0.91))) ** (1.0 / 3.0)
    v = 0.2e-3 / (10.0 * a)
    assert v.max() < 1.0
    drawn = mu * load * 3.0 * math.pi / 8.0 * (v - v**3 / 4.0)
    assert result.friction_force_spread_N == pytest.approx(drawn.std(), rel=0.03)
    assert result.friction_force_N == pytest.approx(drawn.mean(), rel=5e-3)


SLIDER = {"material": "steel", "radius": "5 mm", "mu": 0.3, "frequency": "2 kHz"}


@pytest.mark.long
def test_what_is_found_is_known_as_well_as_what_was_given():
    """The friction of a rigid slider depends on the speed divided by the amplitude only."""
    request = SLIDER | {"load": "1 N", "speed": "1 m/s +- 5 %", "reduction": "50 %"}
    result = microslip.predict("transverse", **request)
    assert result.amplitude_spread_m == pytest.approx(0.05 * result.amplitude_m, rel=1e-2)
    assert result.mu_macro_spread == pytest.approx(0.0, abs=1e-3)


@pytest.mark.long
def test_where_an_end_has_no_answer_the_spread_is_endless():
    """One end of the uncertain speed has no solution, so the uncertainty is infinite.

    Under a very small load the contact is a rigid slider.  By Eq 6 its friction falls by 22 % at
    0.8 times the velocity of the vibration, but by 18 % at 0.96 times.
    """
    speed = 0.8 * 2.0 * math.pi * 2e3 * 1e-6
    request = SLIDER | {"speed": f"{speed:.6g} m/s +- 20 %", "amplitude": "1 um"}
    result = microslip.predict("transverse", **request, reduction=0.2, tolerance=1e-2)
    assert result.converged and result.load_N > 0.0 and math.isinf(result.load_spread_N)
