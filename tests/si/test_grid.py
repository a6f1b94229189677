"""Ranges of quantities, and predictions over them."""

import numpy as np
import pytest

import microslip
from microslip.foundation.errors import InputError
from microslip.si.table import interpolation_errors, values_of

CONTACT = {"young": "210 GPa", "nu": 0, "radius": "5 mm", "mu": 0.3, "frequency": "20 kHz"}


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
    grid = microslip.predict_grid("transverse", **given, **CONTACT)
    assert dict(grid.sizes) == {"load_N": 2, "amplitude_m": 2}
    assert grid.load_N.values.tolist() == [10.0, 20.0] and grid.load_N.attrs["units"] == "N"
    alone = microslip.predict("transverse", load=20, amplitude=1e-7, speed=0.01, **CONTACT)
    point = grid.isel(load_N=1, amplitude_m=0)
    for name in ("mu_apparent", "mu_apparent_error", "friction_force_N", "u_lim_m"):
        assert float(point[name]) == getattr(alone, name)
    grid.to_netcdf(tmp_path / "grid.nc", engine="netcdf4")
    assert np.isnan(grid.mu_macro.isel(amplitude_m=1)).all()
    assert np.isfinite(grid.mu_macro.isel(amplitude_m=0)).all()
    assert all("allowed" in text for text in grid.error.values[:, 1])


@pytest.mark.parametrize(
    ("arguments", "argument"),
    [
        ({"amplitude": "1 um"}, "amplitude"),
        ({"amplitude": "0..1 um, 1000", "speed": "0..1 m/s, 500"}, "amplitude"),
        ({"amplitude": "0..1 s"}, "amplitude"),
        ({"amplitude": "0..1 um", "load": "1 kg"}, "load"),
        ({"amplitude": "0..1 um", "speeds": "0..1 m/s"}, "speeds"),
    ],
)
def test_bad_grids_are_refused_by_name(arguments, argument):
    whole = {"speed": "1 mm/s", "load": "1 N"} | CONTACT | arguments
    with pytest.raises(InputError) as error:
        microslip.predict_grid("transverse", **whole)
    assert error.value.argument == argument


def test_interpolation_errors_of_parabolas():
    # x^2 differs from the interpolation of its neighbours at x - h and x + k by h k
    import xarray as xr

    x, y, z = np.array([0.0, 1.0, 3.0]), np.array([0.0, 1.0]), np.array([0.0, 2.0, 4.0])
    f = x[:, None, None] ** 2 + y[:, None] ** 2 + z**2
    values = xr.DataArray(f, {"x": x, "y": y, "z": z}, dims=("x", "y", "z"))
    errors = interpolation_errors(values)
    assert errors == {"x": pytest.approx(1.0 * 2.0), "y": None, "z": pytest.approx(2.0 * 2.0)}
