"""Unusable files and folders: one line before any work, and no loss of data."""

import errno
import logging
import os

import numpy as np
import pytest
import xarray as xr
from stubs.new_process import output

from microslip.foundation import files
from microslip.foundation.errors import CacheError
from microslip.report.figures.data import loaded
from microslip.sweeps import batch, evaluate

POINT = ["point", "continuous-bore", "--velocity", "2"]
REQUEST = {"kind": "point", "motion": "continuous-bore", "velocity": "2", "poisson": "0"}
REQUEST |= {"model": "auto", "tolerance": "0.001", "amplitude": None, "cells": None, "steps": None}


def one_line(error):
    assert "\n" not in str(error.value)
    return str(error.value)


# Unusable folders of results


def full(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("new", "No space left on device"),
        ("file/new", "Not a directory"),
        ("half", "Not a directory"),
        ("link", "File exists"),
    ],
)
def test_a_folder_that_cannot_keep_results_is_refused_before_work(
    name, part, tmp_path, monkeypatch
):
    (tmp_path / "file").write_text("kept")
    (tmp_path / "link").symlink_to("nowhere/at/all")
    (tmp_path / "half").mkdir()
    (tmp_path / "half" / "batches").write_text("kept")
    if name == "new":
        monkeypatch.setattr(files.os, "fsync", full)
    monkeypatch.setattr(evaluate, "computed", lambda _: pytest.fail("work has started"))
    with pytest.raises(CacheError) as caught:
        batch.solve([REQUEST], tmp_path / name / "batches" / "bore" / "0.jsonl")
    message = one_line(caught)
    assert str(tmp_path / name) in message and part in message and "another folder" in message
    names = [p.name for p in tmp_path.rglob("*") if p.is_file()]
    assert sorted(names) == ["batches", "file"]


@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda there: there.symlink_to("nowhere"), "results is not a folder"),
        (lambda there: (there.mkdir(), (there / "points").touch()), "points is not a folder"),
        (lambda there: (there / "bore.nc").mkdir(parents=True), "bore.nc is a folder"),
    ],
)
def test_files_and_folders_that_have_changed_places_are_refused(make, part, tmp_path):
    there = tmp_path / "results"
    needed = [there / "points", there / "figures"], [there / "bore.nc"]
    files.refuse_unusable(*needed)  # nothing is there yet
    make(there)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(CacheError, match="allowed") as caught:
        files.refuse_unusable(*needed)
    assert part in one_line(caught)
    assert sorted(tmp_path.rglob("*")) == before


# Damaged files


def test_a_damaged_batch_is_computed_again_and_said(tmp_path, caplog):
    path = tmp_path / "a.jsonl"
    batch.solve([REQUEST], path)
    whole = path.read_bytes()
    path.write_bytes(whole[:-100])
    with caplog.at_level(logging.WARNING):
        batch.solve([REQUEST], path)
    assert caplog.messages == [f"{path} is damaged; run again: finished points are kept"]
    assert path.read_bytes() == whole


def data():
    values = {"mu_macro": ("velocity", np.linspace(0.0, 1.0, 2000))}
    return xr.Dataset(values, attrs={"motion": "bore"})


@pytest.fixture
def dataset(tmp_path):
    """A dataset of the workflow."""
    path = tmp_path / "bore.nc"
    data().to_netcdf(path)
    return path


@pytest.mark.parametrize(
    "spoil",
    [
        lambda path: os.truncate(path, path.stat().st_size // 2),
        lambda path: path.unlink(),
        lambda path: (path.unlink(), path.mkdir()),
    ],
)
def test_a_dataset_that_cannot_be_read_is_one_line(spoil, dataset):
    assert loaded(dataset).identical(data())
    spoil(dataset)
    with pytest.raises(CacheError, match="allowed: a netCDF file") as caught:
        loaded(dataset)
    assert f"cannot read the dataset {dataset}: " in one_line(caught)


FULL_DISK = """
import resource, sys
import numpy, xarray
from microslip.datasets import netcdf
from microslip.foundation.errors import CacheError
data = xarray.Dataset({"a": ("x", numpy.random.default_rng(1).random(99999))})
resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))
try:
    netcdf.write(sys.argv[1], data)
except CacheError as error:
    print(error)
"""


@pytest.mark.slow
def test_a_disk_that_fills_up_under_a_dataset_leaves_the_old_one(dataset):
    """A limit on the size of files stands for a full disk: both interrupt a write."""
    before = dataset.read_bytes()
    message = output(FULL_DISK, dataset)
    assert message.count("\n") == 1
    assert f"cannot write {dataset}: " in message and "make room" in message
    assert dataset.read_bytes() == before
    assert {p.name for p in dataset.parent.iterdir()} == {"bore.nc"}
