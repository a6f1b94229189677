"""Tables and ranges of contacts equal the predictions of their rows and points."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import microslip
from microslip.foundation.errors import InputError
from microslip.si.table import interpolation_errors, values_of

SHARED = {"young": "210 GPa", "nu": 0, "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}
SHARED |= {"tolerance": 0.01}


def test_pandas_tables_and_files_are_cases(tmp_path):
    """A DataFrame of pandas.read_csv and its file give equal datasets."""
    text = "label;load [N];speed [mm/s];amplitude [um];reduction\na;10;1,5;1;\nb;20;2,5;0,3;\n"
    (tmp_path / "cases.csv").write_text(text)
    frame = pd.read_csv(tmp_path / "cases.csv", sep=";", decimal=",")
    by_file = microslip.predict_table("transverse", tmp_path / "cases.csv", decimal=",", **SHARED)
    by_frame = microslip.predict_table("transverse", frame, **SHARED)
    assert by_frame.mu_macro.values.tolist() == by_file.mu_macro.values.tolist()
    assert by_frame.speed_m_s.values.tolist() == [1.5e-3, 2.5e-3]
    assert by_frame.label.values.tolist() == ["a", "b"]
    assert by_file.case_load.values.tolist() == ["10 N", "20 N"]
    assert by_file.torque_N_m.isnull().all() and by_file.torque_N_m.units == "N m"
    alone = microslip.predict("transverse", load=20, speed=2.5e-3, amplitude=3e-7, **SHARED)
    row = by_file.isel(case=1)
    for name in ("mu_macro", "mu_apparent_error", "u_lim_m", "velocity", "drag_power_W"):
        assert float(row[name]) == pytest.approx(getattr(alone, name), rel=1e-9)
    assert str(row.warnings.values) == "; ".join(alone.warnings) and bool(row.converged)


# Ranges


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("0..2 um, 5", ["0 um", "0.5 um", "1 um", "1.5 um", "2 um"]),
        ("0.1..10 mm/s, 3, log", ["0.1 mm/s", "1 mm/s", "10 mm/s"]),
        ("1..100um,log,3", ["1 um", "10 um", "100 um"]),
        ("1e-1 .. .5, 2", ["0.1", "0.5"]),
        ("0 .. .5 N,2", ["0 N", "0.5 N"]),
    ],
)
def test_a_range_has_equal_steps_or_equal_ratios(text, values):
    assert values_of("load", text) == values
    assert len(values_of("load", "0..2 N")) == 11


@pytest.mark.parametrize(
    "text",
    [
        *("2..0 um", "0..um", "0..inf um", "0..1..2 um", "0...1 N, 3", "0..2 um, 1"),
        *("0..2 um, 5, 5", "0..2 um, cubic", "0..2 um, 5, log", "0..2 N, 1e9"),
    ],
)
def test_other_texts_are_refused_with_an_example(text):
    with pytest.raises(InputError, match=r"from 2 to 100000.*0.1..10 mm/s, 21, log.*with a digit"):
        values_of("load", text)


def test_points_are_predictions_and_survive_a_bad_one(tmp_path):
    given = {"load": ["10 N", 20.0], "amplitude": "0.1e-6..1 m, 2", "speed": 0.01}
    grid = microslip.predict_grid("transverse", **given, **SHARED)
    assert dict(grid.sizes) == {"load_N": 2, "amplitude_m": 2}
    assert grid.load_N.values.tolist() == [10.0, 20.0] and grid.load_N.attrs["units"] == "N"
    alone = microslip.predict("transverse", load=20, amplitude=1e-7, speed=0.01, **SHARED)
    point = grid.isel(load_N=1, amplitude_m=0)
    for name in ("mu_apparent", "mu_apparent_error", "friction_force_N", "u_lim_m"):
        assert float(point[name]) == getattr(alone, name)
    grid.to_netcdf(tmp_path / "grid.nc", engine="netcdf4")
    assert np.isnan(grid.mu_macro.isel(amplitude_m=1)).all()
    assert np.isfinite(grid.mu_macro.isel(amplitude_m=0)).all()
    assert all("allowed" in text for text in grid.error.values[:, 1])


WHOLE = SHARED | {"speed": "1 mm/s", "load": "1 N"}
CASES = {"load": ["10 N", "20 N"], "speed": [0.01, 0.1], "amplitude": ["1 um", "0.3 um"]}
REFUSED = [
    (microslip.predict_grid, {"amplitude": "0..1 um, 1000", "speed": "0..1 m/s, 500"}, "amplitude"),
    (microslip.predict_grid, {"amplitude": "0..1 s"}, "amplitude"),
    (microslip.predict_grid, {"amplitude": "0..1 um", "load": "1 kg"}, "load"),
    (microslip.predict_grid, {"amplitude": "0..1 um", "speeds": "0..1 m/s"}, "speeds"),
    (microslip.predict_response, {"path": {"forward": [0, None]}}, "path"),
    (microslip.predict_response, {"path": {"forward": 1.0}}, "forward"),
    (microslip.predict_response, {"path": {"speed": [0, 1]}}, "path"),
    (microslip.predict_response, {"path": {"forward": [0, 1], "load": [10.0, -1.0]}}, "path"),
    (microslip.predict_response, {"path": {"forward": [0, 1]}, "speed": "1 m/s"}, "speed"),
    (microslip.predict_table, {"cases": {}}, "cases"),
    (microslip.predict_table, {"cases": pd.DataFrame()}, "cases"),
    (microslip.predict_table, {"cases": {"load": ["10 N"], "speed": [0.1, 0.2]}}, "cases"),
    (microslip.predict_table, {"cases": {"load": []}}, "cases"),
    (microslip.predict_table, {"cases": {"mu": [0.3]}}, "mu"),
    (microslip.predict_table, {"cases": CASES | {"load": ["10 kg", "1 s"]}}, "load"),
]


@pytest.mark.parametrize(("function", "arguments", "argument"), REFUSED)
def test_bad_tables_grids_and_paths_are_refused_by_name(function, arguments, argument):
    given = {"motion": "transverse"} | (SHARED if "cases" in arguments else WHOLE) | arguments
    if "path" in arguments:
        given = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "material": "steel"} | arguments
    with pytest.raises(InputError) as error:
        function(**given)
    assert error.value.argument == argument


def test_interpolation_errors_of_parabolas():
    # x^2 differs from the interpolation of its neighbours at x - h and x + k by h k
    x, y, z = np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0]), np.array([0.0, 2.0, 4.0])
    f = x[:, None, None] ** 2 + y[:, None] ** 2 + z**2
    values = xr.DataArray(f, {"x": x, "y": y, "z": z}, dims=("x", "y", "z"))
    errors = interpolation_errors(values)
    assert errors == {"x": pytest.approx(1.0 * 2.0), "y": None, "z": pytest.approx(2.0 * 2.0)}
