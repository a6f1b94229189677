"""Spreads of what is given are carried through: against shares by hand and a Monte Carlo."""

import math

import numpy as np
import pytest

import microslip
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.si.uncertain import without_uncertainty

BALL = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3}
SPIN = BALL | {"speed": "1 mm/s", "rotation": "10 rad/s"}


@pytest.mark.slow
def test_a_spread_of_mu_alone_is_a_share_of_the_force():
    """A steady spin does not know u_lim: the force goes like mu, and so does its spread."""
    found = microslip.predict("continuous-bore", **SPIN | {"mu": "0.3 +- 0.03"})
    assert found.friction_force_spread_N == pytest.approx(0.1 * found.friction_force_N, rel=1e-9)
    assert found.mu_apparent_spread == pytest.approx(0.1 * found.mu_apparent, rel=1e-9)
    assert found.mu_macro_spread == pytest.approx(0.0, abs=1e-12)
    assert found.understood["mu"] == "0.3 +- 0.03"


def test_spreads_of_several_quantities_are_those_of_a_monte_carlo():
    """Eq 21 in closed form at v~ <= 1, with 10^5 drawn contacts, within its own scatter of 1 %."""
    asked = BALL | {"speed": "0.2 mm/s", "rotation": "10 rad/s", "load": "10 N +- 5 %"}
    asked |= {"mu": "0.3 +- 0.01", "radius": "5 mm ± 0.5 mm"}
    found = microslip.predict("continuous-bore", **asked)
    draw = np.random.default_rng(0).standard_normal((3, 100_000))
    mu, load, radius = 0.3 + 0.01 * draw[0], 10.0 + 0.5 * draw[1], 5e-3 + 0.5e-3 * draw[2]
    a = (0.75 * load * radius / (210e9 / (2.0 * 0.91))) ** (1.0 / 3.0)
    v = 0.2e-3 / (10.0 * a)
    assert v.max() < 1.0
    drawn = mu * load * 3.0 * math.pi / 8.0 * (v - v**3 / 4.0)
    assert found.friction_force_spread_N == pytest.approx(drawn.std(), rel=0.03)
    assert found.friction_force_N == pytest.approx(drawn.mean(), rel=5e-3)


SLIDER = {"material": "steel", "radius": "5 mm", "mu": 0.3, "frequency": "2 kHz"}


@pytest.mark.long
def test_what_is_found_is_known_as_well_as_what_was_given():
    """Of a rigid slider friction depends on the speed over the amplitude alone."""
    asked = SLIDER | {"load": "1 N", "speed": "1 m/s +- 5 %", "reduction": "50 %"}
    found = microslip.predict("transverse", **asked)
    assert found.sought_value == found.amplitude_si
    assert found.sought_spread == pytest.approx(0.05 * found.amplitude_si, rel=1e-2)
    assert found.mu_macro_spread == pytest.approx(0.0, abs=1e-3)


@pytest.mark.long
def test_where_an_end_has_no_answer_the_spread_is_endless():
    """A load of nearly nothing slides as a rigid one, of which vibration takes 22 % at 0.8 times
    the velocity of the vibration, by Eq 6, and 18 % at 0.96 times: 20 % only below some speed."""
    speed = 0.8 * 2.0 * math.pi * 2e3 * 1e-6
    asked = SLIDER | {"speed": f"{speed:.6g} m/s +- 20 %", "amplitude": "1 um"}
    found = microslip.predict("transverse", **asked, reduction=0.2, tolerance=1e-2)
    assert found.converged and found.load_N > 0.0 and math.isinf(found.sought_spread)


def test_the_command_line_takes_spreads(capsys):
    given = SPIN | {"mu": "0.3 +- 0.03"}
    words = [word for k, v in given.items() for word in (f"--{k}", str(v))]
    assert cli.main(["predict", "continuous-bore", *words]) == 0
    said = capsys.readouterr().out
    assert "\nmu                0.3 +- 0.03\n" in said and "\nspread            " in said


@pytest.mark.parametrize(
    ("mu", "ends"),
    [
        ("0.25 +- 10 %", (0.225, 0.275)),
        ("0.25 +- 0.025", (0.225, 0.275)),
        ("25 % +- 2 %", (0.23, 0.27)),  # in the unit of the value
    ],
)
def test_a_spread_in_per_cent_is_a_share_of_the_value(mu, ends):
    plain, (one,) = without_uncertainty("transverse", {"mu": mu})
    assert (one.low, one.high) == pytest.approx(ends) and "+-" not in plain["mu"]


def test_an_end_that_predict_refuses_is_named():
    with pytest.raises(InputError, match="^mu = '9': at one standard uncertainty, 14: mu: allowed"):
        microslip.predict("continuous-bore", **SPIN | {"mu": "9 +- 5"})
