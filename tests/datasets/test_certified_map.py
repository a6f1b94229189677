"""Interpolation in certified maps, and arrays of dask."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from stubs import certified_stub
from stubs.eq6_map import places

from microslip.datasets import certified_map, netcdf
from microslip.foundation.errors import InputError
from microslip.theory import paper

ERROR = 1e-2


def friction(velocity, amplitude):
    """An invented smooth friction: Eq 6 with the power 1.5 of the amplitude."""
    return paper.large_amplitude_transverse(velocity, np.asarray(amplitude) ** 1.5)


def record(request):
    place = float(request["velocity"]), float(request["amplitude"])
    return certified_stub.record(request, float(friction(*place)))


@pytest.fixture(scope="module")
def made():
    """A certified map of the invented friction, and the records of its points."""
    axes = {"velocity": [0.001, 10], "amplitude": [0, 3], "error": ERROR}
    map_ = certified_stub.configured("transverse", **axes)
    return SimpleNamespace(map=map_, records=certified_stub.played(map_, record))


@pytest.fixture(scope="module")
def dataset(made, tmp_path_factory):
    """The dataset of `made`, read from a file."""
    built = certified_map.build(made.map, "map", made.records)[0]
    return certified_stub.reopened(built, tmp_path_factory.mktemp("certified"))


def test_answers_are_within_their_errors_and_these_within_what_was_asked(dataset):
    velocity, amplitude = places(2000)
    answer = dataset.microslip.at(velocity, amplitude)
    miss = abs(answer.mu_macro - friction(velocity.values, amplitude.values))
    assert float((miss <= answer.mu_macro_error).mean()) >= 0.999
    assert float(answer.mu_macro_error.max()) <= ERROR
    assert dataset.sizes["point"] == len(np.unique(dataset.cell_node))
    solved = zip(dataset.velocity.values, dataset.amplitude.values, strict=True)
    assert dataset.points == len(set(solved))


def test_at_a_node_the_answer_is_the_node(dataset):
    answer = dataset.microslip.at(dataset.velocity.drop_vars("velocity"), dataset.amplitude)
    off = abs(answer.mu_macro - dataset.mu_macro).values
    assert (off <= answer.mu_macro_error.values).all()
    # on a border the value may come from the neighbouring cell
    inside = np.unique(dataset.cell_node.values.reshape(-1, 5, 5)[:, 1:-1, 1:-1])
    assert off[inside].max() < 1e-6


def test_equal_answers_give_equal_files(made, tmp_path):
    for name, records in (("a.nc", made.records), ("b.nc", made.records[::-1])):
        netcdf.write(tmp_path / name, certified_map.build(made.map, "map", records)[0])
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


def test_a_point_that_failed_leaves_its_cells_unanswered(made):
    requests = [record["request"] for record in made.records]
    bad = next(r for r in requests if 0.01 < float(r["velocity"]) < 0.1 < float(r["amplitude"]))
    failed = [r for r in made.records if r["request"] != bad] + [certified_stub.record(bad, None)]
    data = certified_map.build(made.map, "map", failed)[0]
    there = float(bad["velocity"]) * 1.01, float(bad["amplitude"]) * 0.99
    answer = data.microslip.at(*there)
    assert np.isnan(answer.mu_macro) and np.isinf(answer.mu_macro_error)
    message = list(certified_map.report(data, "certified_transverse"))
    assert "1 not converged" in message[0]
    assert "cells are not within 0.01" in message[1]


def test_in_chunks_the_answer_is_the_same_and_waits(dataset):
    velocity, amplitude = places(1000)
    at_once = dataset.microslip.at(velocity, amplitude)
    lazy = dataset.microslip.at(velocity.chunk(n=300), amplitude.chunk(n=300))
    assert {name: lazy[name].chunks for name in lazy.data_vars} == dict.fromkeys(
        at_once.data_vars, ((300, 300, 300, 100),)
    )
    xr.testing.assert_identical(lazy.compute(), at_once)
    outer = velocity[:20].chunk(n=7), amplitude[:30].rename(n="a")
    lazy = dataset.microslip.at(*outer)
    assert lazy.mu_macro.dims == ("a", "n")
    xr.testing.assert_identical(lazy.compute(), dataset.microslip.at(outer[0].compute(), outer[1]))


def test_in_chunks_a_bad_question_is_refused_when_it_is_looked_at(dataset):
    lazy = dataset.microslip.at(xr.DataArray([1.0, -1.0], dims="n").chunk(n=2), 1.0)
    with pytest.raises(InputError, match="velocity"):
        lazy.compute()


@pytest.mark.parametrize("name", ["mu_macro", "cell_error", "cell_low"])
def test_what_a_map_has_lost_is_named(dataset, name):
    with pytest.raises(InputError, match=f"{name} = None: microslip.at needs it"):
        dataset.drop_vars(name).microslip.at(0.1, 1.0)


def test_a_map_without_all_its_points_is_refused(dataset):
    with pytest.raises(InputError, match="all points"):
        dataset.isel(point=slice(0, 20)).microslip.at(0.1, 1.0)
