"""Fits of friction with known parameters: intervals contain them with the stated probability."""

import json
import math
import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.stats import binom
from stubs.eq6_map import eq6_map
from stubs.in_process import answer

import microslip
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


def force(table, u_lim=U_LIM):
    """Exact friction forces of the rows.  u_lim: that at the load LOAD."""
    load = table.get("load", LOAD)
    unit = u_lim * (load / LOAD) ** (2.0 / 3.0)
    return MU * load * ratio(table["speed"] / (OMEGA * unit), table["amplitude"] / unit)


def fitted(table, **more):
    return microslip.fit("transverse", table, **SHARED | more)


def contains_the_truth(result):
    u_lim = result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
    return result.mu_low <= MU <= result.mu_high and u_lim


# Data without and with noise


@pytest.mark.parametrize(
    ("columns", "digits"),
    [
        ({}, 1e-4),
        ({"load": np.tile([5.0, 10.0, 15.0, 10.0], 4)}, 1e-4),
        # rows without vibration, which have the full friction
        ({"amplitude": np.repeat([0.0, 0.7, 2.0], [4, 4, 8]) * U_LIM}, 1e-3),
    ],
)
def test_rows_without_noise_give_the_truth(closed, columns, digits):
    """u_lim is proportional to the load to the power 2/3."""
    table = conditions() | columns
    exact, shared = force(table), {"load": None if "load" in columns else LOAD}
    result = fitted(table | {"friction": exact}, **shared)
    assert (result.load_N, result.mu) == pytest.approx((LOAD, MU), rel=1e-4)
    assert result.u_lim_m == pytest.approx(U_LIM, rel=digits)
    assert contains_the_truth(result) and result.reason == ""
    assert result.rows["fitted"] == pytest.approx(exact, rel=1e-4)
    unit = U_LIM * (table.get("load", LOAD) / LOAD) ** (2.0 / 3.0)
    assert result.rows["velocity"] == pytest.approx(table["speed"] / (OMEGA * unit), rel=1e-3)
    assert result.rows["amplitude"] == pytest.approx(table["amplitude"] / unit, rel=1e-3)


def test_a_coefficient_and_a_force_are_one_measurement(closed):
    table = conditions()
    noisy = force(table) * (1.0 + 0.01 * np.cos(np.arange(16)))
    by_force, by_mu = fitted(table | {"friction": noisy}), fitted(table | {"mu": noisy / LOAD})
    numbers = by_mu.mu, by_mu.u_lim_m, LOAD * by_mu.standard_error
    assert (by_force.mu, by_force.u_lim_m, by_force.standard_error) == pytest.approx(numbers, 1e-5)
    large = fitted(table | {"mu": 5.0 * noisy / LOAD})
    assert large.mu > 1.0 and any("Coulomb" in text for text in large.warnings)


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


@pytest.mark.parametrize(
    ("size", "speeds", "sigma", "sides"),
    [
        # most of the contact sticks, and friction is mu times the load
        (0.02 * U_LIM, (0.5, 5.0), 0.01, ["above", "below"]),
        # all of the contact slides, and friction follows Eq 6, which does not contain u_lim
        (1e-3, (0.1, 3.0), 0.02, ["below", "above"]),
    ],
)
def test_rows_of_one_state_determine_mu_alone(closed, size, speeds, sigma, sides):
    """The shear modulus is unknown on the other side, because it decreases with u_lim."""
    table = {"amplitude": np.full(8, size), "speed": np.geomspace(*speeds, 8) * OMEGA * size}
    table["friction"] = force(table) + sigma * np.random.default_rng(1).standard_normal(8)
    result, real = fitted(table), fitted(table, **BALL)
    bounds = {"above": result.u_lim_low_m, "below": result.u_lim_high_m}
    assert result.reason.startswith(f"the rows determine mu alone: any u_lim {sides[0]} ")
    assert [result.u_lim_m, bounds[sides[1]]] == [None, None] and bounds[sides[0]] > 0.0
    assert result.mu_low <= MU <= result.mu_high < (1.0 + 2.0 * sigma) * result.mu_low
    assert f"any shear modulus {sides[1]}" in real.reason and real.shear_modulus_Pa is None


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
    assert one.understood["nu"] == "0 (default)"
    units = [data[name].units for name in ("fitted", "mu", "speed_m_s")]
    assert units == ["N", "1", "m/s"] and data.label.values.tolist() == list("abcdefgh")


@pytest.mark.slow
def test_the_command_fits_by_a_map_and_names_the_lines_that_it_leaves_out(tmp_path, monkeypatch):
    """The rows are exact values of the map, whose error estimates are bounds."""
    monkeypatch.chdir(tmp_path)
    table, dataset = conditions(12), eq6_map(1e-3)
    place = table["speed"] / (OMEGA * U_LIM), table["amplitude"] / U_LIM
    macro = dataset.microslip.at(*(xr.DataArray(one, dims="row") for one in place)).mu_macro
    columns = {"speed [m/s]": table["speed"], "amplitude [m]": table["amplitude"]}
    frame = pd.DataFrame({"label": list("abcdefghijkl"), **columns, "mu": MU * macro})
    frame.to_csv("m.csv", index=False)
    dataset.to_netcdf("map.nc")
    line = "fit transverse m.csv --load '10 N' --frequency '1 kHz' --map map.nc"
    message = json.loads(answer(f"{line} --figure fit.png --json"))
    assert (message["mu"], message["u_lim_m"]) == pytest.approx((MU, U_LIM), rel=1e-5)
    assert message["u_lim_low_m"] < U_LIM < message["u_lim_high_m"] and message["reason"] == ""
    assert (tmp_path / "fit.png").read_bytes().startswith(b"\x89PNG")
    answer(f"{line} --nu 0.3", 2, ["--nu = '0.3': allowed is 0"])
    answer(f"{line} --amplitude '1 mm'", 2, ["--amplitude = '1 mm': it is both"])
    with open("m.csv", "a") as file:
        file.write("bad,fast,1,0.1\nempty,1,1,\nlow,-1,1,0.1\n")
    reasons = ["14: speed is 'fast'", "15: mu is empty", "16: speed = '-1 m/s'"]
    complaints = [f"microslip fit: line {reason}" for reason in reasons]
    text = answer(f"{line} --output fit.nc", 1, complaints)
    assert re.search(r"^nu +0 \(map\)\n(.*\n)*rows +12, of", text, re.M)
    assert re.search(r"^u_lim +200\.0\ nm,\ from", text, re.M)
    rows = xr.load_dataset("fit.nc")
    assert float(rows.mu) == message["mu"] and rows.label.values.tolist() == [*frame.label]
    still = {"speed [m/s]": OMEGA * U_LIM * np.geomspace(0.03, 0.3, 12)}
    still |= {"amplitude [m]": 0.06 * U_LIM, "mu": MU * (1.0 + 1e-3 * np.cos(3.0 * np.arange(12)))}
    frame.assign(**still).to_csv("m.csv", index=False)
    text = answer(line, 1)
    assert "NOT DETERMINED: the rows determine mu alone: any u_lim above" in text
    assert re.search(r"^mu +0\.3", text, re.M) and "\nu_lim" not in text


GOOD = conditions() | {"friction": force(conditions())}
THREE = {"speed": [1e-4, 1.0001e-4, 1.0002e-4], "amplitude": [U_LIM] * 3}
MANY = {"speed": np.linspace(1e-3, 1.0, 201), "amplitude": [1e-7] * 201, "friction": np.ones(201)}
REFUSED = [
    (THREE | {"friction": [1.0, 1.1, -0.9]}, {}, "neither number: mu from.* is row 3, where fric"),
    ({name: column[:2] for name, column in GOOD.items()}, {}, "2 rows; allowed are at least 3"),
    (MANY, {}, "with a map"),
    (conditions(), {}, "neither friction nor mu"),
    (GOOD | {"mu": [0.3] * 16}, {}, "both friction and mu"),
    (GOOD | {"friction": [0.0] * 8 + [-1.0] * 8}, {}, "0 in none of 16 rows, and negative in 8"),
    (GOOD | {"friction": [1.0] * 15 + [math.nan]}, {}, "in every row.*, in row 16"),
    (GOOD | {"friction": 1e-9 * GOOD["friction"]}, {}, "mu is at most 1e-05; check the units"),
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
