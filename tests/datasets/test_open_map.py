"""Opening the datasets of a results folder."""

import netCDF4
import numpy as np
import pytest
from stubs.eq6_map import eq6_map

from microslip.datasets import netcdf
from microslip.datasets.open_map import open_map
from microslip.foundation.files import CacheError


@pytest.fixture
def results(tmp_path):
    made = eq6_map(1e-4)
    made["converged"] = made.converged.astype(np.int8)
    netcdf.write(tmp_path / "transverse.nc", made)
    return tmp_path


def test_open_map_is_plain_xarray(results):
    result = open_map("transverse", results, chunks={})
    assert result.mu_macro.chunks is not None
    row = result.mu_macro.interp(amplitude=1.5)
    assert float(row.interp(velocity=0.1)) == pytest.approx(
        float(result.microslip.at(0.1, 1.5).mu_macro), abs=0.02
    )


def test_what_cannot_be_opened_is_one_line(results, tmp_path):
    with pytest.raises(ValueError, match="name = 'tranverse': did you mean transverse"):
        open_map("tranverse", results)
    with pytest.raises(CacheError, match="bore.nc is not there"):
        open_map("bore", results)
    path = results / "transverse.nc"
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(CacheError, match="transverse.nc is damaged"):
        open_map("transverse", results)


def test_a_dataset_that_declares_more_than_it_holds_is_refused_unread(tmp_path):
    """The size is checked in groups, too."""
    for group in ("/", "history"):
        path = tmp_path / f"{len(group)}.nc"
        with netCDF4.Dataset(path, "w") as file:
            file.motion = "transverse"
            place = file if group == "/" else file.createGroup(group)
            place.createDimension("velocity", 10**12)
            place.createVariable("velocity", "f8", ("velocity",), chunksizes=(1024,))
        with pytest.raises(CacheError, match="velocity has 1000000000000 values in a file of "):
            open_map(path)
    eq6_map(0.0).to_netcdf(tmp_path / "small.nc")
    with open_map(tmp_path / "small.nc") as data:
        assert data.mu_macro.shape == (41, 41)
