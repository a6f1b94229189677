"""Predictions for motions from files with units: the answers of named motions."""

import pickle

import numpy as np
import pytest
import xarray as xr

import microslip
from microslip.foundation.errors import InputError
from microslip.si.strokes import read_stroke

PHASE = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
SINE = np.sin(PHASE)
BALL = {"mu": 0.3, "radius": "5 mm", "material": "steel", "speed": "20 um/s", "tolerance": 1e-2}
SHAKEN = BALL | {"load": "10 N", "frequency": "200 Hz"}


def file_of(path, **columns):
    """File with the columns NAME_UNIT, such as lateral_um."""
    heading = ",".join("{} [{}]".format(*name.rsplit("_", 1)) for name in columns)
    rows = zip(*columns.values(), strict=True)
    path.write_text("\n".join([heading, *(",".join(map(repr, map(float, row))) for row in rows)]))
    return f"file:{path}"


FORCED = {"speed": None, "force": "1 N"}
CASES = {
    "factor, and a mean without effect": (
        {"lateral_um": 7.0 + 0.4 * SINE},
        {"amplitude": 0.5},
        "transverse",
        {"amplitude": "0.2 um"},
    ),
    "bore": ({"angle_deg": 0.3 * SINE}, {}, "bore", {"amplitude": "0.3 deg"}),
    "load": ({"load_N": 10.0 + 5.0 * SINE}, {}, "normal", {"load_amplitude": "5 N"}),
    "force": ({"lateral_um": 0.1 * SINE}, FORCED, "transverse", {"amplitude": "0.1 um"} | FORCED),
    "two directions": (
        {"forward_nm": 80.0 * np.cos(PHASE), "lateral_um": 0.2 * SINE},
        {},
        "elliptic",
        {"amplitude": "0.2 um", "forward_amplitude": "80 nm", "phase": "90 deg"},
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_a_file_gets_the_answer_of_the_named_motion(case, tmp_path):
    columns, given, motion, named = CASES[case]
    name = file_of(tmp_path / "stroke.csv", **columns)
    one = microslip.predict(name, **SHAKEN | given)
    other = microslip.predict(motion, **SHAKEN | named)
    assert one.converged and one.outcome == other.outcome
    for number in {"mu_macro", "mu_static", "force_threshold"} & other.values.keys():
        here, there = one.values[number], other.values[number]
        assert abs(here.value - there.value) <= here.error + there.error
    assert one.sliding_friction_N == pytest.approx(3.0)
    if motion == "transverse":
        assert one.amplitude == pytest.approx(other.amplitude)
    assert one.amplitude_factor == given.get("amplitude", 1.0)
    first = " ".join(str(one).split())
    assert first.startswith(f"motion {name}: the sphere slides forward and follows")


def test_a_long_period_has_a_hint_to_fold_and_a_longer_one_is_refused(tmp_path):
    usual, long, record = (
        file_of(tmp_path / f"{rows}.csv", lateral_um=np.sin(np.arange(rows)))
        for rows in (2000, 2001, 10_001)
    )
    assert read_stroke(usual).hint == "" and "microslip fold" in read_stroke(long).hint
    with pytest.raises(InputError, match="10001 rows; allowed .* 10000 rows.* `microslip fold`"):
        read_stroke(record)


def test_time_gives_the_frequency_and_the_file_the_load(tmp_path):
    time = np.arange(64) / 64 * 5.0
    columns = {"time_ms": time, "load_N": 10.0 + 5.0 * SINE, "lateral_um": 0.1 * np.cos(PHASE)}
    name = file_of(tmp_path / "stroke.csv", **columns)
    assert read_stroke(name).frequency == pytest.approx(200.0)
    answer = microslip.predict(name, **BALL)
    assert answer.frequency_Hz == pytest.approx(200.0)
    assert answer.load_N == pytest.approx(10.0)
    refused = {"frequency": "200 Hz", "map": xr.Dataset(attrs={"motion": "transverse"})}
    for argument, value in refused.items():
        with pytest.raises(InputError, match=f"{argument} = .*allowed.* without a"):
            microslip.predict(name, **BALL | {argument: value})


def test_forces_do_not_depend_on_the_reference_load_beside_a_column_of_loads(tmp_path):
    name = file_of(tmp_path / "stroke.csv", load_N=10.0 + 5.0 * SINE)
    one, other = (microslip.predict(name, **SHAKEN | {"load": load}) for load in ("10 N", "8 N"))
    left = one.friction_force_error_N + other.friction_force_error_N
    assert abs(one.friction_force_N - other.friction_force_N) <= left
    assert other.sliding_friction_N == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("factor", "amplitude", "load"),
    [
        ("1", "0.1 um", "10 N +- 5 %"),
        pytest.param("1 +- 5 %", "0.1 um +- 5 %", "10 N", marks=pytest.mark.long),
    ],
)
def test_a_file_has_the_uncertainty_of_the_named_motion(factor, amplitude, load, tmp_path):
    name = file_of(tmp_path / "stroke.csv", lateral_um=0.1 * SINE)
    shared = SHAKEN | {"tolerance": 1e-3, "load": load}
    one = microslip.predict(name, **shared, amplitude=factor)
    other = microslip.predict("transverse", **shared, amplitude=amplitude)
    for spread in ("mu_macro_spread", "mu_static_spread"):
        assert getattr(one, spread) == pytest.approx(getattr(other, spread), rel=0.2)


def test_a_file_of_an_indentation_determines_the_load(tmp_path):
    name = file_of(tmp_path / "stroke.csv", indentation_nm=900.0 + 60.0 * SINE[::8])
    given = SHAKEN | {"tolerance": 0.05}
    one = microslip.predict(name, **given | {"load": "10 N +- 5 %"})
    other = microslip.predict(name, **given | {"load": "11 N"})
    assert other.friction_force_N == pytest.approx(one.friction_force_N, rel=1e-3)
    assert one.friction_force_spread_N < 0.01 * one.friction_force_N


def test_largest_speed_is_that_of_all_harmonics(tmp_path):
    name = file_of(tmp_path / "stroke.csv", lateral_um=SINE + 0.5 * np.sin(3.0 * PHASE))
    # the slope of sin x + 0.5 sin 3 x at x = 0 is 2.5
    assert read_stroke(name).pace[0] == pytest.approx(2.5e-6)
    assert read_stroke(name).reach[0] == pytest.approx(1e-6, rel=0.2)


def test_a_prediction_of_a_file_prints_without_the_file(tmp_path):
    name = file_of(tmp_path / "stroke.csv", lateral_um=0.1 * SINE)
    result = microslip.predict(name, **SHAKEN | {"tolerance": 0.1})
    text = str(result)
    file_of(tmp_path / "stroke.csv", lateral_um=0.2 * SINE)
    assert str(result) == text
    (tmp_path / "stroke.csv").unlink()
    assert str(pickle.loads(pickle.dumps(result))) == text
