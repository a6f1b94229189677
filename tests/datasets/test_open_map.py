"""Opening the datasets of a results folder."""

import netCDF4
import pytest
from stubs.eq6_map import eq6_map

from microslip.datasets import netcdf
from microslip.datasets.open_map import open_map
from microslip.foundation.files import CacheError


def test_what_cannot_be_opened_is_one_line(tmp_path):
    path = tmp_path / "transverse.nc"
    netcdf.write(path, eq6_map(1e-4))
    with pytest.raises(ValueError, match="name = 'tranverse': did you mean transverse"):
        open_map("tranverse", tmp_path)
    with pytest.raises(CacheError, match="bore.nc is not there"):
        open_map("bore", tmp_path)
    eq6_map(1e-4).drop_vars("checksum").to_netcdf(tmp_path / "old.nc")
    with pytest.raises(CacheError, match="older version: run the sweep again"):
        open_map("old", tmp_path)
    path.write_bytes(path.read_bytes()[:-100])
    (tmp_path / "link.nc").symlink_to(path)
    (tmp_path / "lost.nc").symlink_to("data/lost.nc")
    with pytest.raises(CacheError, match="lost.nc is a link to .*data/lost.nc, which is not there"):
        open_map("lost", tmp_path)
    with pytest.raises(CacheError, match=f"link.nc: it is truncated .* delete {path} and run the"):
        open_map("link", tmp_path)


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
