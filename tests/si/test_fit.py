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

import microslip
from microslip.app import cli
from microslip.foundation.errors import InputError
from microslip.si import fit as module
from microslip.theory import paper

MU, U_LIM, LOAD, FREQUENCY = 0.3, 2e-7, 10.0, 1e3
OMEGA = 2.0 * math.pi * FREQUENCY
SHARED = {"frequency": FREQUENCY, "load": LOAD}


def ratio(velocity, amplitude):
    """Closed-form friction: Eq 6, with an effective amplitude."""
    amplitude = np.maximum(amplitude, 1e-12)
    turned = amplitude**2 / (1.0 + amplitude)
    return np.asarray(paper.large_amplitude_transverse(velocity, turned))


class Closed:
    """Replacement for `solve`."""

    off = 0.0

    def __call__(self, motion, velocity, amplitude, **settings):
        value = float(ratio(velocity, amplitude)) + self.off
        return SimpleNamespace(mu_macro=value, mu_macro_error=1e-6 + abs(self.off))


@pytest.fixture
def closed(monkeypatch):
    solver = Closed()
    monkeypatch.setattr(module, "solve", solver)
    return solver


def conditions(rows=16):
    """Rows at two amplitudes, from slow to fast."""
    speed = np.tile(np.geomspace(0.03, 3.0, rows // 2), 2) * OMEGA * U_LIM
    return {"speed": speed, "amplitude": np.repeat([0.7, 2.0], rows // 2) * U_LIM}


def force(table, u_lim=U_LIM, load=LOAD):
    return MU * load * ratio(table["speed"] / (OMEGA * u_lim), table["amplitude"] / u_lim)


def fitted(table, **more):
    return microslip.fit("transverse", table, **SHARED | more)


# Data without and with noise


def test_rows_without_noise_give_the_truth(closed):
    table = conditions()
    result = fitted(table | {"friction": force(table)})
    assert result.reason == ""
    assert (result.mu, result.u_lim_m) == pytest.approx((MU, U_LIM), rel=1e-4)
    assert result.mu_low <= MU <= result.mu_high
    assert result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
    assert result.rows["fitted"] == pytest.approx(force(table), rel=1e-3)
    groups = table["speed"] / (OMEGA * U_LIM), table["amplitude"] / U_LIM
    assert result.rows["velocity"] == pytest.approx(groups[0], rel=1e-3)
    assert result.rows["amplitude"] == pytest.approx(groups[1], rel=1e-3)


def test_a_coefficient_and_a_force_are_one_measurement(closed):
    table = conditions()
    noisy = force(table) * (1.0 + 0.01 * np.cos(np.arange(16)))
    by_force = fitted(table | {"friction": noisy})
    by_mu = fitted(table | {"mu": noisy / LOAD})
    assert by_force.mu == pytest.approx(by_mu.mu, rel=1e-6)
    assert by_force.u_lim_m == pytest.approx(by_mu.u_lim_m, rel=1e-6)
    assert by_force.standard_error == pytest.approx(LOAD * by_mu.standard_error, rel=1e-5)


def test_u_lim_is_proportional_to_the_load_to_the_power_of_two_thirds(closed):
    table = conditions()
    loads = np.tile([5.0, 10.0, 15.0, 10.0], 4)
    friction = force(table, U_LIM * (loads / 10.0) ** (2.0 / 3.0), loads)
    result = fitted(table | {"friction": friction, "load": loads}, load=None)
    assert result.load_N == 10.0
    assert (result.mu, result.u_lim_m) == pytest.approx((MU, U_LIM), rel=1e-4)


def test_a_row_without_vibration_has_the_full_friction(closed):
    table = conditions()
    table["amplitude"][:4] = 0.0
    friction = np.where(table["amplitude"] > 0.0, force(table), MU * LOAD)
    result = fitted(table | {"friction": friction})
    assert result.rows["fitted"][:4] == pytest.approx(MU * LOAD, rel=1e-4)
    assert result.u_lim_m == pytest.approx(U_LIM, rel=1e-3)


@pytest.mark.parametrize("counterbody", [None, "same"])
def test_a_radius_turns_u_lim_into_the_shear_modulus(closed, counterbody):
    """u_lim = mu d (2 - nu) / (2 (1 - nu)) with Hertz's indentation d."""
    table, nu, radius = conditions(), 0.3, 5e-3
    noisy = force(table) * (1.0 + 0.03 * np.cos(np.arange(16)))
    plain = fitted(table | {"friction": noisy}, nu=nu)
    result = fitted(table | {"friction": noisy}, nu=nu, radius=radius, counterbody=counterbody)
    assert result.reason == ""
    depth = result.u_lim_m / result.mu * 2.0 * (1.0 - nu) / (2.0 - nu)
    contact_modulus = 0.75 * LOAD / math.sqrt(radius) / depth**1.5
    bodies = 1.0 if counterbody is None else 2.0
    shear = contact_modulus * bodies * (1.0 - nu) / 2.0
    assert result.shear_modulus_Pa == pytest.approx(shear, rel=1e-6)
    assert result.shear_modulus_low_Pa < shear < result.shear_modulus_high_Pa
    same = ("mu", "mu_low", "mu_high", "u_lim_m", "u_lim_low_m", "u_lim_high_m")
    for name in same:
        assert getattr(result, name) == pytest.approx(getattr(plain, name), rel=1e-6)


@pytest.mark.long
@pytest.mark.parametrize(("reference", "confidence"), [(False, 0.95), (True, 0.68)])
def test_intervals_cover_the_truth_as_often_as_stated(closed, reference, confidence):
    """The number of intervals with the true value is in a range of probability 1 - 1e-4."""
    table, sigma, seeds = conditions(12), 0.05, 100
    modulus = 0.75 * LOAD / math.sqrt(5e-3) / (U_LIM / MU) ** 1.5 / 2.0
    true, counts = force(table), dict.fromkeys(("mu", "u_lim", "shear_modulus"), 0)
    for seed in range(seeds):
        noise = sigma * np.random.default_rng(seed).standard_normal(12)
        data = table | {"friction": true + noise}
        if reference:
            data["friction_error"] = np.full(12, sigma)
        result = fitted(data, confidence=confidence, nu=0.0, radius=5e-3)
        counts["mu"] += result.mu_low <= MU <= result.mu_high
        counts["u_lim"] += result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
        ends = result.shear_modulus_low_Pa, result.shear_modulus_high_Pa
        counts["shear_modulus"] += ends[0] <= modulus <= ends[1]
    low, high = binom.interval(1.0 - 1e-4, seeds, confidence)
    assert all(low <= count <= high for count in counts.values()), (counts, low, high)


@pytest.mark.parametrize("off", [-0.01, 0.01])
def test_intervals_include_the_error_of_the_model(closed, off):
    """The model has a constant error of 0.01, which its error estimate states."""
    table = conditions()
    closed.off = off
    result = fitted(table | {"friction": force(table)})
    assert abs(result.mu / MU - 1.0) > 1e-3
    assert result.mu_low <= MU <= result.mu_high
    assert result.u_lim_low_m <= U_LIM <= result.u_lim_high_m
    assert 0.0 < result.mu_model_share < 0.1


def test_chi_square_detects_errors_that_are_too_small(closed):
    table = conditions()
    noise = 0.05 * np.random.default_rng(3).standard_normal(16)
    data = table | {"friction": force(table) + noise}
    good = fitted(data | {"friction_error": np.full(16, 0.05)})
    bad = fitted(data | {"friction_error": np.full(16, 0.01)})
    assert good.warnings == () and good.p_value > 1e-3
    assert bad.chi_square == pytest.approx(25.0 * good.chi_square, rel=1e-3)
    assert "larger than the errors of the rows allow" in bad.warnings[0]


def test_the_curve_is_the_model_between_the_rows(closed):
    table = conditions(8)
    result = fitted(table | {"friction": force(table)})
    curve = result.curve
    assert len(curve["fitted"]) > 10 * len(result.rows["fitted"])
    for row, amplitude in enumerate(result.rows["amplitude_si"]):
        here = curve["speed_m_s"] == result.rows["speed_m_s"][row]
        here &= curve["amplitude_si"] == amplitude
        assert curve["fitted"][here] == pytest.approx([result.rows["fitted"][row]], rel=1e-9)
    fine = {"speed": curve["speed_m_s"], "amplitude": curve["amplitude_si"]}
    assert curve["fitted"] == pytest.approx(force(fine), rel=5e-3)
    for name in ("speed", "amplitude"):  # rows that share no condition
        table[name] = table[name] * np.linspace(1.0, 1.2, 8)
    assert len(fitted(table | {"friction": force(table)}).curve["fitted"]) == 0


# Undetermined numbers


def test_rows_on_the_plateau_determine_mu_alone(closed):
    """At small amplitudes and a large u_lim, friction is mu times the load."""
    table = {
        "speed": np.geomspace(0.01, 0.1, 8) * OMEGA * U_LIM,
        "amplitude": np.full(8, 0.02 * U_LIM),
    }
    noise = 0.01 * np.random.default_rng(1).standard_normal(8)
    result = fitted(table | {"friction": MU * LOAD + noise})
    assert result.u_lim_m is None and result.u_lim_high_m is None
    assert result.reason.startswith("the rows determine mu alone: any u_lim above")
    assert result.u_lim_low_m < U_LIM
    assert result.mu_low <= MU <= result.mu_high and result.mu_high < 1.02 * result.mu_low
    real = fitted(table | {"friction": MU * LOAD + noise}, nu=0.3, radius=5e-3)
    assert "any shear modulus below" in real.reason and real.shear_modulus_Pa is None


def test_large_amplitudes_do_not_determine_u_lim(closed):
    """At amplitudes far above u_lim, friction follows Eq 6, which does not contain u_lim."""
    table = {"amplitude": np.full(8, 1e-3), "speed": np.geomspace(0.1, 3.0, 8) * OMEGA * 1e-3}
    noise = 0.02 * np.random.default_rng(2).standard_normal(8)
    result = fitted(table | {"friction": force(table) + noise})
    assert result.u_lim_low_m is None
    assert "any u_lim below" in result.reason
    assert result.mu_low <= MU <= result.mu_high


# Tables


def test_a_file_and_its_frame_are_read_alike(closed, tmp_path):
    table = conditions(8)
    frame = pd.DataFrame(
        {
            "label": list("abcdefgh"),
            "speed [mm/s]": 1e3 * table["speed"],
            "amplitude [nm]": 1e9 * table["amplitude"],
            "friction [mN]": 1e3 * force(table),
        }
    )
    frame.to_csv(tmp_path / "m.csv", index=False)
    frame.loc[8] = [None] * 4  # an empty last row
    shared = {"frequency": "60000 rpm", "load": "0.01 kN"}
    one, other = (microslip.fit("transverse", m, **shared) for m in (tmp_path / "m.csv", frame))
    assert one.mu == pytest.approx(MU, rel=1e-3) and other.u_lim_m == one.u_lim_m
    assert one.labels == other.labels == {"label": list("abcdefgh")}
    assert one.rows["frequency_Hz"][0] == pytest.approx(1e3) and one.rows["row_load_N"][0] == 10.0
    assert one.understood["load"] == "0.01 kN"
    data = one.to_xarray()
    assert (data.sizes["row"], data.fitted.units, data.mu.units) == (8, "N", "1")
    assert data.speed_m_s.units == "m s-1" and data.label.values.tolist() == list("abcdefgh")
    assert json.loads(json.dumps(one.to_dict()))["mu"] == one.mu


GOOD = "speed [mm/s],amplitude [um],friction [N]\n1,0.5,1.93\n2,0.5,2.1\n"


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (("mm/s", "mm"), "line 2: speed = '1 mm': the unit is m"),
        (("1.93", ""), "line 2: friction is empty; allowed: a number in every row"),
        (("1,0.5", "-1,0.5"), "line 2: speed = '-1 mm/s': allowed is a finite value"),
    ],
)
def test_an_unreadable_line_is_left_out_with_the_reason(closed, tmp_path, changed, message):
    rows = "\n".join(f"{v},0.5,{2.2 + 0.1 * v}" for v in range(3, 9))
    (tmp_path / "m.csv").write_text(GOOD.replace(*changed) + rows + "\n")
    try:
        problem = fitted(tmp_path / "m.csv").left_out[0]
    except InputError as error:  # one for each line
        problem = str(error)
    assert message in problem and "\n" not in problem


def test_the_command_names_the_line_that_it_leaves_out(closed, tmp_path, capsys):
    unit = OMEGA * U_LIM * 1e3
    rows = [(v, float(ratio(v, 1.5))) for v in (0.2, 0.5, 1.0, 2.0)]
    text = "label,speed [mm/s],mu\n" + "".join(f"r{v},{v * unit},{0.3 * m}\n" for v, m in rows)
    (tmp_path / "m.csv").write_text(text + "bad,fast,0.1\n")
    words = ["fit", "transverse", str(tmp_path / "m.csv"), "--amplitude", "300 nm"]
    words += ["--frequency", "1 kHz", "--load", "10 N", "--output", str(tmp_path / "fit.nc")]
    assert cli.main(words) == 1
    out, complaint = capsys.readouterr()
    assert complaint.startswith("microslip fit: line 6: speed is 'fast'")
    assert complaint.endswith("; left out\n") and complaint.count("\n") == 1
    assert re.search(r"^rows +4, of", out, re.M) and re.search(
        r"^u_lim +[\d.]+ nm, from", out, re.M
    )
    labels = xr.load_dataset(tmp_path / "fit.nc").label.values
    assert labels.tolist() == ["r0.2", "r0.5", "r1.0", "r2.0"]


ONE = {"speed": [1e-4, 1.0001e-4, 1.0002e-4], "amplitude": [U_LIM] * 3, "friction": [1.0, 1.1, 0.9]}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (ONE, "determine neither number: mu from"),
        ({"speed": [1e-3] * 2, "amplitude": [1e-7] * 2, "friction": [1.0, 1.1]}, "at least 3"),
        ({"speed": [1e-3] * 4, "amplitude": [1e-7] * 4, "friction": [1.0] * 4}, "one condition"),
        ({"friction": None}, "neither friction nor mu"),
        ({"mu": [0.3] * 16}, "both friction and mu"),
        ({"friction": [0.0] * 16}, "above 0 in none of 16 rows, and negative in 0;"),
        ({"friction": [-1.0] * 16}, "above 0 in none of 16 rows, and negative in 16;"),
        ({"friction": [1.0] * 15}, "several lengths"),
        ({"friction": [1.0] * 15 + [math.nan]}, "in every row.*, in row 16"),
        ({"friction": ["1"] * 16}, "without a unit"),
        ({"friction_error": [0.1] * 15 + [0.0]}, "above 0"),
        ({"mu_error": [0.1] * 16}, "mu_error without mu"),
        ({"time": np.ones(16)}, "a column 'time'"),
        ({"speed": None}, "speed = None: it is missing"),
        ({"load": [1.0] * 16}, "load = 10.0: it is both"),
        ({"amplitude": np.zeros(16)}, "nothing vibrates"),
    ],
    ids=str,
)
def test_an_unusable_table_is_refused(closed, change, message):
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
        ("transverse", {"tolerance": 0.5}, "tolerance"),
        ("transverse", {"map": SimpleNamespace(attrs={"motion": "bore"})}, "a sweep of transverse"),
    ],
)
def test_other_bad_input_is_refused(closed, motion, more, message):
    table = conditions()
    with pytest.raises(InputError, match=message):
        microslip.fit(motion, table | {"friction": force(table)}, **SHARED | more)


def test_more_rows_than_the_solver_can_compute_need_a_map(closed):
    table = {"speed": np.linspace(1e-3, 1.0, 201), "amplitude": np.full(201, 1e-7)}
    with pytest.raises(InputError, match="with a map"):
        fitted(table | {"friction": np.ones(201)})


# Fits by the solver


@pytest.mark.long
def test_the_solver_recovers_its_own_parameters():
    """Friction by the solver at a small tolerance: the fit recovers mu and G."""
    still = {"young": 2.1e11, "nu": 0.0, "radius": 5e-3, "load": LOAD, "mu": MU}
    still |= {"speed": 1.0, "amplitude": 0.0, "frequency": 1.0}
    u_lim = microslip.predict("transverse", **still).u_lim_m
    table = {"speed": np.geomspace(0.03, 2.0, 6) * OMEGA * u_lim}
    table["amplitude"] = np.full(6, 1.5 * u_lim)
    points = [v / (OMEGA * u_lim) for v in table["speed"]]
    ratios = [microslip.solve("transverse", v, 1.5, tolerance=1e-4).mu_macro for v in points]
    table["friction"] = MU * LOAD * np.array(ratios)
    result = fitted(table, nu=0.0, radius="5 mm")
    assert result.reason == ""
    # within the effect of an error of 1e-3 of mu_macro, which the intervals include
    assert result.mu_low <= MU <= result.mu_high and result.mu_high < 1.01 * result.mu_low
    assert result.shear_modulus_low_Pa <= 1.05e11 <= result.shear_modulus_high_Pa
    assert result.u_lim_low_m <= u_lim <= result.u_lim_high_m
    again = fitted(table, nu=0.0, radius="5 mm")
    # equal to the last bit; in texts NaN equals NaN
    assert str(again.to_dict()) == str(result.to_dict())


def test_a_large_fitted_mu_has_the_warning_of_predict():
    rows = {"speed [mm/s]": [1, 2, 4, 8, 1000], "mu": [0.6, 0.9, 1.2, 1.4, 1.5]}
    common = {"amplitude": "1 um", "frequency": "1 kHz", "load": "10 N"}
    result = microslip.fit("transverse", rows, **common, tolerance=0.02)
    assert result.mu > 1.0
    assert any("Coulomb" in text for text in result.warnings)
