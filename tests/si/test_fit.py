"""Fits of friction with known parameters: intervals contain them with the stated probability."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import binom

import microslip
from microslip.foundation.errors import InputError
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import MovingContact, RealMotion
from microslip.si.fitting import fit as fitting
from microslip.si.fitting.friction_models import SolvedFriction
from microslip.si.fitting.measured import Measured
from microslip.si.fitting.scales import Modulus, Points
from microslip.si.materials import RIGID, Material
from microslip.theory import paper

MU, U_LIM, LOAD, FREQUENCY = 0.3, 2e-7, 10.0, 1e3
OMEGA = 2.0 * math.pi * FREQUENCY


class Closed(SolvedFriction):
    """Closed-form friction: Eq 6, with an effective amplitude."""

    off = 0.0

    def __init__(self, *asked):
        self.count = len(asked[-1][0].velocity)

    def at(self, points):
        return ratio(points) + self.off

    def anchor(self, points):
        pass

    def errors(self, points):
        return np.full(self.count, 1e-6 + abs(self.off))

    def rough(self, points):
        return ratio(points)


def ratio(points):
    amplitude = np.maximum(points.amplitude, 1e-12)
    turned = amplitude**2 / (1.0 + amplitude)
    return np.asarray(paper.large_amplitude_transverse(points.velocity, turned))


@pytest.fixture
def closed(monkeypatch):
    monkeypatch.setattr(fitting, "SolvedFriction", Closed)


def conditions(rows=16):
    """Rows at two amplitudes, from slow to fast."""
    speed = np.tile(np.geomspace(0.03, 3.0, rows // 2), 2) * OMEGA * U_LIM
    return {"speed": speed, "amplitude": np.repeat([0.7, 2.0], rows // 2) * U_LIM}


def force(table, u_lim=U_LIM, load=LOAD):
    scaled = table["speed"] / (OMEGA * u_lim), table["amplitude"] / u_lim
    return MU * load * ratio(Points(*scaled))


SHARED = {"frequency": FREQUENCY, "load": LOAD}


def fitted(table, **more):
    return microslip.fit("transverse", table, **SHARED | more)


# The curve of the model


def test_the_curve_is_that_of_the_model_between_the_rows(closed):
    table = conditions(8)
    table["friction"] = force(table)
    result = microslip.fit("transverse", table, **SHARED)
    curve = result.curve
    assert len(curve.fitted) > 10 * len(result.fitted)
    for row, amplitude in enumerate(result.amplitude_si):
        here = (curve.speed_m_s == result.speed_m_s[row]) & (curve.amplitude_si == amplitude)
        assert curve.fitted[here] == pytest.approx([result.fitted[row]], rel=1e-12)
    fine = {"speed": curve.speed_m_s, "amplitude": curve.amplitude_si}
    assert curve.fitted == pytest.approx(force(fine), rel=1e-4)


def test_rows_that_share_no_condition_have_no_curve(closed):
    table = conditions(8)
    for name in ("speed", "amplitude"):
        table[name] = table[name] * np.linspace(1.0, 1.2, 8)
    table["friction"] = force(table)
    assert len(microslip.fit("transverse", table, **SHARED).curve.fitted) == 0


# Dimensionless groups


@pytest.mark.parametrize("alike", [False, True])
def test_rows_are_the_points_of_predict_under_every_load(alike):
    load, size = np.array([5.0, 10.0, 40.0]), np.array([1e-7, 3e-7, 1e-6])
    speed, frequency = np.array([1e-3, 1e-2, 0.1]), np.array([10.0, 1e3, 2e4])
    rows = Measured(speed, size, frequency, load, load, load, "friction", {})
    scale = Modulus(rows, 0.3, alike, 5e-3)
    points = scale.points(0.25, 80e9)
    body = Material(2.0 * 80e9 * 1.3, 0.3)
    for k in range(3):
        contact = TwoBodies(body, body if alike else RIGID, 5e-3, load[k], 0.25)
        real = RealMotion("transverse", "m", speed[k], size[k], frequency[k])
        expected = MovingContact(contact, real).groups
        assert (points.velocity[k], points.amplitude[k]) == pytest.approx(expected, rel=1e-12)


# Data without and with noise


def test_rows_without_noise_give_the_truth(closed):
    table = conditions()
    result = fitted(table | {"friction": force(table)})
    assert result.told == ("mu", "u_lim") and result.reason == ""
    assert result.mu == pytest.approx(MU, rel=1e-5)
    assert result.u_lim_m == pytest.approx(U_LIM, rel=1e-5)
    assert (
        result.mu_low <= MU <= result.mu_high and result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
    )
    assert result.fitted == pytest.approx(force(table), rel=1e-4)


def test_a_coefficient_and_a_force_are_one_measurement(closed):
    table = conditions()
    noisy = force(table) * (1.0 + 0.01 * np.cos(np.arange(16)))
    by_force = fitted(table | {"friction": noisy})
    by_mu = fitted(table | {"mu": noisy / LOAD})
    assert by_force.mu == pytest.approx(by_mu.mu, rel=1e-6)
    assert by_force.u_lim_m == pytest.approx(by_mu.u_lim_m, rel=1e-6)
    assert by_force.standard_error == pytest.approx(LOAD * by_mu.standard_error, rel=1e-5)


def test_rows_under_several_loads_are_brought_together(closed):
    table = conditions()
    loads = np.tile([5.0, 10.0, 15.0, 10.0], 4)
    rows = [
        force(
            {k: v[i : i + 1] for k, v in table.items()},
            U_LIM * (loads[i] / 10.0) ** (2 / 3),
            loads[i],
        )
        for i in range(16)
    ]
    result = fitted(table | {"friction": np.concatenate(rows), "load": loads}, load=None)
    assert result.load_N == 10.0
    assert (result.mu, result.u_lim_m) == pytest.approx((MU, U_LIM), rel=1e-5)


@pytest.mark.long
@pytest.mark.parametrize(("reference", "confidence"), [(False, 0.95), (True, 0.68)])
def test_intervals_cover_the_truth_as_often_as_they_say(closed, reference, confidence):
    """The number of intervals with the true value is in a range of probability 1 - 1e-4."""
    table, sigma, seeds = conditions(12), 0.05, 100
    true, held = force(table), {"mu": 0, "u_lim": 0}
    for seed in range(seeds):
        noise = sigma * np.random.default_rng(seed).standard_normal(12)
        data = table | {"friction": true + noise}
        if reference:
            data["friction_error"] = np.full(12, sigma)
        result = fitted(data, confidence=confidence)
        assert result.told == ("mu", "u_lim")
        held["mu"] += result.mu_low <= MU <= result.mu_high
        held["u_lim"] += result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
    low, high = binom.interval(1.0 - 1e-4, seeds, confidence)
    assert all(low <= count <= high for count in held.values()), (held, low, high)


def test_intervals_hold_what_the_model_is_off(closed, monkeypatch):
    """Intervals include the error estimate of the model, here a constant error of 0.01."""
    table = conditions()
    data = table | {"friction": force(table)}
    for off in (-0.01, 0.01):
        monkeypatch.setattr(Closed, "off", off)
        result = fitted(data)
        assert abs(result.mu / MU - 1.0) > 1e-3  # a constant error
        assert result.mu_low <= MU <= result.mu_high
        assert result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
        assert 0.0 < result.mu_model_share < 0.1


def test_chi_square_tells_errors_that_are_too_small(closed):
    table = conditions()
    noise = 0.05 * np.random.default_rng(3).standard_normal(16)
    data = table | {"friction": force(table) + noise}
    good = fitted(data | {"friction_error": np.full(16, 0.05)})
    bad = fitted(data | {"friction_error": np.full(16, 0.01)})
    assert good.warnings == () and good.p_value > 1e-3
    assert bad.chi_square == pytest.approx(25.0 * good.chi_square, rel=1e-3)
    assert "larger than the errors of the rows allow" in bad.warnings[0]


# Undetermined numbers


def test_rows_on_the_plateau_tell_mu_alone(closed):
    """At small amplitudes and a large u_lim, friction is mu times the load."""
    table = {
        "speed": np.geomspace(0.01, 0.1, 8) * OMEGA * U_LIM,
        "amplitude": np.full(8, 0.02 * U_LIM),
    }
    noise = 0.01 * np.random.default_rng(1).standard_normal(8)
    result = fitted(table | {"friction": MU * LOAD + noise})
    assert result.told == ("mu",) and result.u_lim_m is None and result.u_lim_high_m is None
    assert result.reason.startswith("the rows determine mu alone: any u_lim above")
    assert result.u_lim_low_m < U_LIM
    assert result.mu_low <= MU <= result.mu_high and result.mu_high < 1.02 * result.mu_low


def test_large_amplitudes_tell_no_u_lim(closed):
    """At amplitudes far above u_lim, friction follows Eq 6, which does not contain u_lim."""
    table = {"amplitude": np.full(8, 1e-3), "speed": np.geomspace(0.1, 3.0, 8) * OMEGA * 1e-3}
    noise = 0.02 * np.random.default_rng(2).standard_normal(8)
    result = fitted(table | {"friction": force(table) + noise})
    assert result.told == ("mu",) and result.u_lim_low_m is None
    assert "any u_lim below" in result.reason
    assert result.mu_low <= MU <= result.mu_high


def test_rows_that_tell_neither_are_refused(closed):
    table = {"speed": [1e-4, 1.0001e-4, 1.0002e-4], "amplitude": [U_LIM] * 3}
    with pytest.raises(InputError, match="determine neither number"):
        fitted(table | {"friction": [1.0, 1.1, 0.9]})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"speed": [1e-3] * 2, "amplitude": [1e-7] * 2, "friction": [1.0, 1.1]}, "at least 3"),
        ({"speed": [1e-3] * 4, "amplitude": [1e-7] * 4, "friction": [1.0] * 4}, "one condition"),
        ({"friction": None}, "neither friction nor mu"),
        ({"mu": [0.3] * 16}, "both friction and mu"),
        ({"friction": [1.0] * 15}, "several lengths"),
        ({"friction": [1.0] * 15 + [math.nan]}, "in every row.*, in row 16"),
        ({"friction": ["1"] * 16}, "without a unit"),
        ({"friction_error": [0.1] * 15 + [0.0]}, "above 0"),
        ({"time": np.ones(16)}, "a column 'time'"),
        ({"speed": None}, "speed = None: it is missing"),
        ({"amplitude": np.zeros(16)}, "nothing vibrates"),
    ],
    ids=str,
)
def test_a_table_that_cannot_be_used_is_refused(closed, change, message):
    table = conditions()
    table |= {"friction": force(table)}
    table = change if len(change) == 3 else table | change
    with pytest.raises(InputError, match=message):
        fitted({name: column for name, column in table.items() if column is not None})


@pytest.mark.parametrize(
    ("motion", "more", "message"),
    [
        ("bore", {}, "allowed is one of transverse"),
        ("transverse", {"counterbody": "same"}, "with a radius"),
        ("transverse", {"radius": "5 mm"}, "nu"),
        ("transverse", {"radius": "5 mm", "nu": 0.3, "counterbody": "glass"}, "rigid or same"),
        ("transverse", {"confidence": 1.0}, "confidence"),
        ("transverse", {"map": SimpleNamespace(attrs={"motion": "bore"})}, "a sweep of transverse"),
    ],
)
def test_other_bad_input_is_refused(closed, motion, more, message):
    table = conditions()
    with pytest.raises(InputError, match=message):
        microslip.fit(motion, table | {"friction": force(table)}, **SHARED | more)


def test_more_rows_than_the_solver_answers_for_need_a_map():
    table = {"speed": np.linspace(1e-3, 1.0, 201), "amplitude": np.full(201, 1e-7)}
    with pytest.raises(InputError, match="with a map"):
        fitted(table | {"friction": np.ones(201)})


# Fits by the solver


@pytest.mark.long
def test_the_solver_finds_the_truth_that_it_made():
    """Friction by the solver at a small tolerance: the fit recovers mu and G."""
    contact = TwoBodies(Material(2.1e11, 0.0), RIGID, 5e-3, LOAD, MU)
    table = {"speed": np.geomspace(0.03, 2.0, 6) * OMEGA * contact.u_lim}
    table["amplitude"] = np.full(6, 1.5 * contact.u_lim)
    points = [v / (OMEGA * contact.u_lim) for v in table["speed"]]
    ratios = [microslip.solve("transverse", v, 1.5, tolerance=1e-4).mu_macro for v in points]
    table["friction"] = MU * LOAD * np.array(ratios)
    result = microslip.fit("transverse", table, **SHARED, nu=0.0, radius="5 mm")
    assert result.told == ("mu", "shear_modulus")
    # Within the effect of an error of 1e-3 of mu_macro, which the intervals include.
    assert result.mu_low <= MU <= result.mu_high and result.mu_high < 1.01 * result.mu_low
    assert result.shear_modulus_low_Pa <= contact.G <= result.shear_modulus_high_Pa
    assert result.u_lim_low_m <= contact.u_lim <= result.u_lim_high_m
    assert result.u_lim_m == pytest.approx(contact.u_lim, rel=0.01)
    again = microslip.fit("transverse", table, **SHARED, nu=0.0)
    assert again.u_lim_m == pytest.approx(result.u_lim_m, rel=2e-3)
    once_more = microslip.fit("transverse", table, **SHARED, nu=0.0)
    # Equal to the last bit; in texts NaN equals NaN.
    assert str(once_more.to_dict()) == str(again.to_dict())
