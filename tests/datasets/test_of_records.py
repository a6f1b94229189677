"""Datasets of single results: variables and their axes."""

import numpy as np
import pytest

import microslip
from microslip.foundation.errors import InputError


@pytest.mark.slow
def test_a_point_and_a_history(tmp_path):
    point = microslip.solve("transverse", 0.3, 0.5, tolerance=1e-2)
    data = microslip.to_xarray(point)
    assert float(data.mu_macro) == point.mu_macro and data.attrs["motion"] == "transverse"
    assert data.sizes == {} and "force" not in data
    history = microslip.history("transverse", 0.3, 0.5, cells=8, steps=32, periods=1)
    data = microslip.to_xarray(history)
    assert data.force_forward.dims == ("phase",) and "phase" in data.coords
    assert data.force_forward.values.tolist() == history.force_forward.tolist()
    data.to_netcdf(tmp_path / "history.nc", engine="netcdf4")


@pytest.mark.slow
def test_a_period_has_phases_and_points():
    """A force is the integral of the tractions, a sum over the axis of points."""
    data = microslip.to_xarray(microslip.period("transverse", 0.3, 0.5, cells=8, steps=32))
    assert data.traction_forward.dims == ("phase", "point") and data.area.dims == ("point",)
    assert float(data.area.sum()) == pytest.approx(np.pi)
    summed = (data.traction_forward * data.area).sum("point")
    assert summed.values == pytest.approx(data.force_forward.values, abs=1e-9)


@pytest.mark.slow
def test_a_prediction_keeps_its_texts():
    request = {"material": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3, "speed": "1 mm/s"}
    data = microslip.to_xarray(microslip.predict("continuous-bore", **request, rotation="10 rad/s"))
    assert "load: 10 N" in data.attrs["inputs"] and float(data.rotation_rad_s) == 10.0
    assert data.attrs["warnings"].startswith("the bodies are elastically dissimilar")


def test_anything_else_is_refused():
    with pytest.raises(InputError, match="record = {}: allowed is one of Result.*, RealResponse"):
        microslip.to_xarray({})
