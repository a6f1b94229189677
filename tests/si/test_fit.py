"""Fits of friction with known parameters: intervals contain them with the stated probability."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.stats import binom

import microslip
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.si import fit as module
from microslip.theory import paper

MU, U_LIM, LOAD, FREQUENCY = 0.3, 2e-7, 10.0, 1e3
OMEGA = 2.0 * math.pi * FREQUENCY
SHARED = {"frequency": FREQUENCY, "load": LOAD}
BALL = {"nu": 0.3, "radius": 5e-3}


def ratio(velocity, amplitude):
    """Closed-form friction: Eq 6, with an effective amplitude."""
    amplitude = np.maximum(amplitude, 1e-12)
    turned = amplitude**2 / (1.0 + amplitude)
    return np.asarray(paper.large_amplitude_transverse(velocity, turned))


@pytest.fixture
def closed(monkeypatch):
    """Replacement for `solve` with a constant error `off`, which its error estimate contains."""
    model = SimpleNamespace(off=0.0)

    def solve(motion, velocity, amplitude, **settings):
        value = float(ratio(velocity, amplitude)) + model.off
        return SimpleNamespace(mu_macro=value, mu_macro_error=1e-6 + abs(model.off))

    monkeypatch.setattr(module, "solve", solve)
    return model


def conditions(rows=16):
    """Rows at two amplitudes, from slow to fast."""
    speed = np.tile(np.geomspace(0.03, 3.0, rows // 2), 2) * OMEGA * U_LIM
    return {"speed": speed, "amplitude": np.repeat([0.7, 2.0], rows // 2) * U_LIM}


def force(table, u_lim=U_LIM, load=LOAD):
    return MU * load * ratio(table["speed"] / (OMEGA * u_lim), table["amplitude"] / u_lim)


def fitted(table, **more):
    return microslip.fit("transverse", table, **SHARED | more)


def contains_the_truth(result):
    u_lim = result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
    return result.mu_low <= MU <= result.mu_high and u_lim


# Data without and with noise


def test_rows_without_noise_give_the_truth(closed):
    table = conditions()
    result = fitted(table | {"friction": force(table)})
    assert (result.mu, result.u_lim_m) == pytest.approx((MU, U_LIM), rel=1e-4)
    assert contains_the_truth(result) and result.reason == ""
    assert result.rows["fitted"] == pytest.approx(force(table), rel=1e-3)
    assert result.rows["velocity"] == pytest.approx(table["speed"] / (OMEGA * U_LIM), rel=1e-3)
    assert result.rows["amplitude"] == pytest.approx(table["amplitude"] / U_LIM, rel=1e-3)


def test_a_coefficient_and_a_force_are_one_measurement(closed):
    table = conditions()
    noisy = force(table) * (1.0 + 0.01 * np.cos(np.arange(16)))
    by_force, by_mu = fitted(table | {"friction": noisy}), fitted(table | {"mu": noisy / LOAD})
    numbers = by_mu.mu, by_mu.u_lim_m, LOAD * by_mu.standard_error
    assert (by_force.mu, by_force.u_lim_m, by_force.standard_error) == pytest.approx(numbers, 1e-5)


def test_u_lim_is_proportional_to_the_load_to_the_power_of_two_thirds(closed):
    table, loads = conditions(), np.tile([5.0, 10.0, 15.0, 10.0], 4)
    friction = force(table, U_LIM * (loads / 10.0) ** (2.0 / 3.0), loads)
    result = fitted(table | {"friction": friction, "load": loads}, load=None)
    assert (result.load_N, result.mu, result.u_lim_m) == pytest.approx((10.0, MU, U_LIM), rel=1e-4)


def test_a_row_without_vibration_has_the_full_friction(closed):
    table = conditions()
    table["amplitude"][:4] = 0.0
    friction = np.where(table["amplitude"] > 0.0, force(table), MU * LOAD)
    result = fitted(table | {"friction": friction})
    assert result.rows["fitted"][:4] == pytest.approx(MU * LOAD, rel=1e-4)
    assert result.u_lim_m == pytest.approx(U_LIM, rel=1e-3)


@pytest.mark.parametrize(("counterbody", "bodies"), [(None, 1.0), ("same", 2.0)])
def test_a_radius_turns_u_lim_into_the_shear_modulus(closed, counterbody, bodies):
    """u_lim = mu d (2 - nu) / (2 (1 - nu)) with Hertz's indentation d."""
    table, nu = conditions(), BALL["nu"]
    table["friction"] = force(table) * (1.0 + 0.03 * np.cos(np.arange(16)))
    plain, result = fitted(table, nu=nu), fitted(table, **BALL, counterbody=counterbody)
    depth = result.u_lim_m / result.mu * 2.0 * (1.0 - nu) / (2.0 - nu)
    contact_modulus = 0.75 * LOAD / math.sqrt(BALL["radius"]) / depth**1.5
    shear = contact_modulus * bodies * (1.0 - nu) / 2.0
    assert result.shear_modulus_Pa == pytest.approx(shear, rel=1e-6)
    assert result.shear_modulus_low_Pa < shear < result.shear_modulus_high_Pa
    for name in ("mu", "mu_low", "mu_high", "u_lim_m", "u_lim_low_m", "u_lim_high_m"):
        assert getattr(result, name) == pytest.approx(getattr(plain, name), rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize("reference", [False, True])
def test_intervals_cover_the_truth_as_often_as_stated(closed, reference):
    """The number of intervals with the true value is in a range of probability 1 - 1e-4."""
    table, sigma, seeds, confidence = conditions(12), 0.05, 100, 0.68
    modulus = 0.75 * LOAD / math.sqrt(5e-3) / (U_LIM / MU) ** 1.5 / 2.0
    true, counts = force(table), np.zeros(3, int)
    table |= {"friction_error": np.full(12, sigma)} if reference else {}
    for seed in range(seeds):
        noise = sigma * np.random.default_rng(seed).standard_normal(12)
        one = fitted(table | {"friction": true + noise}, confidence=confidence, nu=0.0, radius=5e-3)
        low = [one.mu_low, one.u_lim_low_m, one.shear_modulus_low_Pa]
        high = [one.mu_high, one.u_lim_high_m, one.shear_modulus_high_Pa]
        counts += np.less_equal(low, [MU, U_LIM, modulus]) & np.less_equal(
            [MU, U_LIM, modulus], high
        )
    low, high = binom.interval(1.0 - 1e-4, seeds, confidence)
    assert low <= counts.min() and counts.max() <= high, (counts, low, high)


@pytest.mark.parametrize("off", [-0.01, 0.01])
def test_intervals_include_the_error_of_the_model(closed, off):
    table, closed.off = conditions(), off
    result = fitted(table | {"friction": force(table)})
    assert abs(result.mu / MU - 1.0) > 1e-3 and contains_the_truth(result)
    assert 0.0 < result.mu_model_share < 0.1
    assert result.rows["fitted_error"] == pytest.approx(0.01 * result.mu * LOAD, rel=1e-3)


def test_chi_square_detects_errors_that_are_too_small(closed):
    table = conditions()
    table["friction"] = force(table) + 0.05 * np.random.default_rng(3).standard_normal(16)
    good, bad = (fitted(table | {"friction_error": np.full(16, x)}) for x in (0.05, 0.01))
    assert good.warnings == () and good.p_value > 1e-3
    assert np.sum(good.rows["residual"] ** 2) == pytest.approx(good.chi_square)
    assert bad.chi_square == pytest.approx(25.0 * good.chi_square, rel=1e-3)
    assert "larger than the errors of the rows allow" in bad.warnings[0]


def test_the_curve_is_the_model_between_the_rows(closed):
    table = conditions(8)
    result = fitted(table | {"friction": force(table)})
    curve = result.curve
    assert len(curve["fitted"]) > 10 * len(result.rows["fitted"])
    place = [curve[name] for name in ("speed_m_s", "amplitude_si")]
    for speed, amplitude in zip(table["speed"], table["amplitude"], strict=True):
        assert np.isclose(place, [[speed], [amplitude]], rtol=1e-9, atol=0.0).all(axis=0).sum() == 1
    fine = {"speed": curve["speed_m_s"], "amplitude": curve["amplitude_si"]}
    assert curve["fitted"] == pytest.approx(force(fine), rel=5e-3)
    for name in ("speed", "amplitude"):  # rows that share no condition
        table[name] = table[name] * np.linspace(1.0, 1.2, 8)
    assert len(fitted(table | {"friction": force(table)}).curve["fitted"]) == 0


def test_two_minima_are_two_answers(closed):
    """At an equal ratio of velocity to amplitude, friction is equal at small and large u_lim."""
    amplitude = np.tile([0.05, 0.5], 4) * U_LIM
    table = {"speed": 0.2 * OMEGA * amplitude, "amplitude": amplitude}
    table |= {"friction": force(table), "friction_error": 0.05 * force(table)}
    result = fitted(table)
    (text,) = (one for one in result.warnings if "two answers" in one)
    mu, u_lim = map(float, re.search(r"mu (\S+) with (\S+) m", text).groups())
    assert result.u_lim_m == pytest.approx(U_LIM, rel=1e-3) and not 0.5 < u_lim / U_LIM < 2.0
    assert mu / MU * force(table, u_lim) == pytest.approx(table["friction"], rel=0.1)


# Undetermined numbers


def test_rows_on_the_plateau_determine_mu_alone(closed):
    """At small amplitudes and a large u_lim, friction is mu times the load."""
    table = {"speed": np.geomspace(0.01, 0.1, 8) * OMEGA * U_LIM, "amplitude": [0.02 * U_LIM] * 8}
    table["friction"] = MU * LOAD + 0.01 * np.random.default_rng(1).standard_normal(8)
    result, real = fitted(table), fitted(table, **BALL)
    assert result.reason.startswith("the rows determine mu alone: any u_lim above")
    assert result.u_lim_m is None and result.u_lim_high_m is None and result.u_lim_low_m < U_LIM
    assert result.mu_low <= MU <= result.mu_high < 1.02 * result.mu_low
    assert "any shear modulus below" in real.reason and real.shear_modulus_Pa is None


def test_large_amplitudes_do_not_determine_u_lim(closed):
    """At amplitudes far above u_lim, friction follows Eq 6, which does not contain u_lim."""
    table = {"amplitude": np.full(8, 1e-3), "speed": np.geomspace(0.1, 3.0, 8) * OMEGA * 1e-3}
    noise = 0.02 * np.random.default_rng(2).standard_normal(8)
    result = fitted(table | {"friction": force(table) + noise})
    assert "any u_lim below" in result.reason and result.u_lim_low_m is None
    assert result.mu_low <= MU <= result.mu_high


# Tables


def test_a_file_and_its_frame_are_read_alike(closed, tmp_path):
    table = conditions(8)
    frame = pd.DataFrame({"label": list("abcdefgh"), "speed [mm/s]": 1e3 * table["speed"]})
    frame["amplitude [nm]"], frame["friction [mN]"] = 1e9 * table["amplitude"], 1e3 * force(table)
    frame.to_csv(tmp_path / "m.csv", index=False)
    frame.loc[8] = [None] * 4  # an empty last row
    shared = {"frequency": "60000 rpm", "load": "0.01 kN"}
    one, other = (microslip.fit("transverse", m, **shared) for m in (tmp_path / "m.csv", frame))
    assert one.mu == other.mu == pytest.approx(MU, rel=1e-3)
    assert one.rows["frequency_Hz"][0] == pytest.approx(1e3) and one.rows["row_load_N"][0] == 10.0
    data = one.to_xarray()
    units = [data[name].units for name in ("fitted", "mu", "speed_m_s")]
    assert units == ["N", "1", "m s-1"] and data.label.values.tolist() == list("abcdefgh")


def test_the_command_names_the_lines_that_it_leaves_out(closed, tmp_path, capsys):
    unit = OMEGA * U_LIM * 1e3
    rows = [f"r{v},{v * unit},{0.3 * float(ratio(v, 1.5))}" for v in (0.2, 0.5, 1.0, 2.0)]
    rows += ["bad,fast,0.1", "empty,1,", "low,-1,0.1"]
    (tmp_path / "m.csv").write_text("\n".join(["label,speed [mm/s],mu", *rows]))
    words = ["fit", "transverse", str(tmp_path / "m.csv"), "--amplitude", "300 nm"]
    words += ["--frequency", "1 kHz", "--load", "10 N", "--output", str(tmp_path / "fit.nc")]
    assert cli.main(words) == 1
    out, complaint = capsys.readouterr()
    reasons = ["line 6: speed is 'fast'", "line 7: mu is empty", "line 8: speed = '-1 mm/s'"]
    for text, reason in zip(complaint.splitlines(), reasons, strict=True):
        assert text.startswith(f"microslip fit: {reason}") and text.endswith("; left out")
    assert re.search(r"^rows +4, of", out, re.M)
    assert re.search(r"^u_lim +[\d.]+ nm, from", out, re.M)
    labels = xr.load_dataset(tmp_path / "fit.nc").label.values
    assert labels.tolist() == ["r0.2", "r0.5", "r1.0", "r2.0"]


GOOD = conditions() | {"friction": force(conditions())}
THREE = {"speed": [1e-4, 1.0001e-4, 1.0002e-4], "amplitude": [U_LIM] * 3}
MANY = {"speed": np.linspace(1e-3, 1.0, 201), "amplitude": [1e-7] * 201, "friction": np.ones(201)}
REFUSED = [
    (THREE | {"friction": [1.0, 1.1, 0.9]}, {}, "determine neither number: mu from"),
    ({name: column[:2] for name, column in GOOD.items()}, {}, "2 rows; allowed are at least 3"),
    (MANY, {}, "with a map"),
    (conditions(), {}, "neither friction nor mu"),
    (GOOD | {"mu": [0.3] * 16}, {}, "both friction and mu"),
    (GOOD | {"friction": [0.0] * 8 + [-1.0] * 8}, {}, "0 in none of 16 rows, and negative in 8"),
    (GOOD | {"friction": [1.0] * 15 + [math.nan]}, {}, "in every row.*, in row 16"),
    (GOOD | {"friction_error": [0.1] * 15 + [0.0]}, {}, "friction_error = 0.0: .*above 0"),
    (GOOD | {"mu_error": [0.1] * 16}, {}, "mu_error without mu"),
    (GOOD | {"time": np.ones(16)}, {}, "a column 'time'"),
    (GOOD | {"load": [1.0] * 16}, {}, "load = 10.0: it is both"),
    (GOOD | {"amplitude": np.zeros(16)}, {}, "nothing vibrates"),
    ({"speed": GOOD["speed"], "friction": GOOD["friction"]}, {}, "amplitude = None: it is missing"),
    (GOOD, {"counterbody": "same"}, "counterbody = 'same': allowed with a radius"),
    (GOOD, {"radius": "5 mm"}, "nu = None"),
    (GOOD, BALL | {"counterbody": "glass"}, "counterbody = 'glass'"),
    (GOOD, {"confidence": 1.0}, "confidence = 1.0"),
    (GOOD, {"tolerance": 0.5}, "tolerance = 0.5"),
    (GOOD, {"map": SimpleNamespace(attrs={"motion": "bore"})}, "map = .*a sweep of transverse"),
]


@pytest.mark.parametrize(("table", "more", "message"), REFUSED, ids=lambda one: str(one)[:20])
def test_an_unusable_table_or_argument_is_refused(closed, table, more, message):
    with pytest.raises(InputError, match=message):
        fitted(table, **more)
    with pytest.raises(InputError, match="^motion = 'bore': allowed is one of transverse"):
        microslip.fit("bore", table)


# Fits by the solver


@pytest.mark.long
def test_the_solver_recovers_its_own_parameters():
    """Within the effect of an error of 1e-3 of mu_macro, which the intervals include."""
    still = {"young": 2.1e11, "nu": 0.0, "radius": 5e-3, "load": LOAD, "mu": MU}
    still |= {"speed": 1.0, "amplitude": 0.0, "frequency": 1.0}
    u_lim = microslip.predict("transverse", **still).u_lim_m
    points = np.geomspace(0.03, 2.0, 6)
    ratios = [microslip.solve("transverse", v, 1.5, tolerance=1e-4).mu_macro for v in points]
    table = {"speed": points * OMEGA * u_lim, "amplitude": np.full(6, 1.5 * u_lim)}
    table["friction"] = MU * LOAD * np.array(ratios)
    result, again = (fitted(table, nu=0.0, radius="5 mm") for _ in range(2))
    assert result.mu_low <= MU <= result.mu_high < 1.01 * result.mu_low
    assert result.shear_modulus_low_Pa <= 1.05e11 <= result.shear_modulus_high_Pa
    assert result.u_lim_low_m <= u_lim <= result.u_lim_high_m
    assert str(again.to_dict()) == str(result.to_dict())  # in texts NaN equals NaN


def test_a_large_fitted_mu_has_the_warning_of_predict():
    rows = {"speed [mm/s]": [1, 2, 4, 8, 1000], "mu": [0.6, 0.9, 1.2, 1.4, 1.5]}
    common = {"amplitude": "1 um", "frequency": "1 kHz", "load": "10 N"}
    result = microslip.fit("transverse", rows, **common, tolerance=0.02)
    assert result.mu > 1.0 and any("Coulomb" in text for text in result.warnings)
