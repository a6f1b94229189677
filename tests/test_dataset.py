"""Datasets: coordinates, contents, conventions, and bytes that depend on the results alone."""

import json
import time

import netCDF4
import numpy as np
import pytest
import xarray as xr
from sweep_stub import EFFORT, Solver

import microslip
from microslip import cache, columns, config, dataset, sweep, theory
from microslip.cache import CacheError, Store

GRIDS = {
    "transverse": {"velocity": [0.1, 1, 10], "amplitude": [0, 2]},
    "bore": {"velocity": [0.1, 1, 10], "amplitude": [0, 2]},
    "continuous_bore": {"velocity": [0.1, 1, 10]},
}
NU = {"transverse": {**GRIDS["transverse"], "poisson": [0, 0.3]}}


def write(name, folder, path, grids=GRIDS):
    configuration = config.from_mapping({"sweeps": grids})
    store = Store(folder)
    grid = configuration.sweeps[name]
    requests = sweep.history_requests(configuration, name)
    dataset.write_sweep(
        path,
        grid,
        (sweep.answer(request, store)[0] for request in sweep.PointRequests(grid)),
        [sweep.answer(request, store)[0] for request in requests],
        configuration.of_sweep(name),
    )


@pytest.fixture
def solver(monkeypatch):
    return Solver(monkeypatch)


def on_disk(name, folder, grids=GRIDS):
    write(name, folder, folder / f"{name}.nc", grids)
    return xr.open_dataset(folder / f"{name}.nc")


def built(name, folder):
    with on_disk(name, folder) as data:
        return data.load()


@pytest.mark.parametrize("name", ["transverse", "bore"])
def test_points_lie_where_their_coordinates_say(name, tmp_path, solver):
    with on_disk(name, tmp_path) as data:
        assert data.mu_macro.dims == ("amplitude", "velocity")
        expected = data.velocity / (1 + data.velocity + data.amplitude)
        xr.testing.assert_allclose(data.mu_macro, expected.transpose("amplitude", "velocity"))
        assert float(data.mu_macro.sel(velocity=10, amplitude=2)) == pytest.approx(10 / 13)
        between = data.interp(velocity=5.5, amplitude=1.0)
        assert 0 < float(between.mu_macro) < 1
        assert float(data.poisson) == 0


def test_a_continuous_bore_has_one_dimension_and_a_torque(tmp_path, solver):
    with on_disk("continuous_bore", tmp_path) as data:
        assert data.mu_macro.dims == data.mu_torque.dims == ("velocity",)
        assert data.mu_torque.values == pytest.approx(1 / (1 + data.velocity.values))
        assert float(data.mu_macro.interp(velocity=0.5)) > 0


def test_a_list_of_poissons_ratios_is_a_dimension(tmp_path, solver):
    with on_disk("transverse", tmp_path, NU) as data:
        assert data.mu_macro.dims == ("poisson", "amplitude", "velocity")
        assert data.sel(poisson=0.3, velocity=1, amplitude=2).mu_macro.size == 1
        assert data.mu_static.dims == ("amplitude",)
        change = data.mu_macro - data.mu_macro.sel(poisson=0)
        assert data.mu_macro_change.values == pytest.approx(change.values)
        both = data.mu_macro_error + data.mu_macro_error.sel(poisson=0)
        assert data.mu_macro_change_error.values == pytest.approx(both.values)


def test_one_poissons_ratio_changes_nothing(tmp_path, solver):
    with on_disk("transverse", tmp_path) as data:
        assert "mu_macro_change" not in data


def test_errors_convergence_and_effort_are_there(tmp_path, monkeypatch):
    Solver(monkeypatch, fails=2.0)
    with on_disk("transverse", tmp_path) as data:
        assert data.converged.dtype == bool
        assert data.converged.sel(amplitude=0).all()
        assert not data.converged.sel(amplitude=2).any()
        assert np.isnan(data.mu_macro.sel(amplitude=2)).all()
        assert set(data.reason.sel(amplitude=2).values) == {"no periodic state"}
        assert set(data.model.values.flat) == {"polar"}
        for name, value in EFFORT.items():
            assert data[name].dtype.kind == ("f" if name == "periods" else "i")
            assert (data[name] == value).all()
        assert (data.mu_macro_error == 4e-5).all()
        assert list(dataset.report(data)) == [
            "transverse: 6 points, 3 not converged",
            *(
                f"  not converged: amplitude 2, velocity {v}: no periodic state"
                for v in (0.1, 1, 10)
            ),
        ]
    with netCDF4.Dataset(tmp_path / "transverse.nc") as raw:
        flag = raw["converged"]
        assert flag.dtype == np.int8
        assert list(flag.flag_values) == [0, 1]
        assert flag.flag_meanings == "not_converged converged"


def test_a_point_that_the_solver_failed_at_is_a_gap(tmp_path, monkeypatch, solver):
    def fail(*_, **__):
        raise RuntimeError("stalled")

    monkeypatch.setattr("microslip.solve", fail)
    data = built("continuous_bore", tmp_path)
    assert np.isnan(data.mu_macro).all()
    assert not data.converged.any()
    assert (data.cells == 0).all()


def test_limits_of_the_transverse_scene(tmp_path, solver):
    data = built("transverse", tmp_path)
    v, a = data.velocity.values, data.amplitude.values
    assert data.mu_large_amplitude.dims == ("amplitude", "velocity")
    assert float(data.mu_large_amplitude.sel(velocity=1, amplitude=2)) == pytest.approx(
        float(theory.large_amplitude_transverse(1.0, 2.0))
    )
    assert (data.mu_large_amplitude.sel(amplitude=0) == 1).all()
    assert data.mu_static_slider.values == pytest.approx(theory.static_slider(a))
    assert data.mu_static_stick_zone.values == pytest.approx(theory.static_transverse(a))
    assert data.mu_static.values == pytest.approx(theory.static_limit_transverse(a))
    assert v.size == 3


def test_limits_of_the_bore_scenes(tmp_path, solver):
    data = built("bore", tmp_path)
    v, a = data.velocity.values, data.amplitude.values
    assert data.mu_large_amplitude.values == pytest.approx(theory.large_amplitude_bore(v))
    assert data.mu_static_stick_zone.values == pytest.approx(theory.static_bore(a))
    assert data.mu_static_stick_zone_printed.values == pytest.approx(theory.static_bore_printed(a))
    assert data.mu_static.values == pytest.approx(theory.static_limit_bore(a))
    data = built("continuous_bore", tmp_path)
    assert data.mu_forward_theory.values == pytest.approx(theory.bore_forward(v))
    assert data.mu_torque_theory.values == pytest.approx(theory.bore_torque(v))


def test_single_runs_for_the_figures_are_in_the_dataset(tmp_path, solver):
    data = built("transverse", tmp_path)
    assert data.history_force_forward.dims == ("history_step",)
    assert data.history_phase.attrs["units"] == "rad"
    assert (float(data.history_velocity), float(data.history_amplitude)) == (0.1, 1.0)
    data = built("continuous_bore", tmp_path)
    assert list(data.start.values) == list(sweep.STARTS)
    assert data.transient_torque.dims == ("start", "transient_step")
    assert data.transient_force_forward.sel(start="stress-free").values[-1] == 1
    assert data.transient_force_forward.sel(start="full-slip").values[-1] == 0
    assert float(data.transient_force_theory) == pytest.approx(float(theory.bore_forward(0.8)))
    assert data.field_traction_forward.dims == ("cell",)
    assert float(data.field_centre_lateral) == -0.5


@pytest.mark.parametrize("name", GRIDS)
def test_conventions_and_provenance(name, tmp_path, solver):
    with on_disk(name, tmp_path) as data:
        for variable in data.variables.values():
            assert variable.attrs["long_name"]
            if variable.dtype.kind in "if":
                assert variable.attrs["units"] in ("1", "rad")
                assert not np.isin("_FillValue", list(variable.encoding)) or variable.ndim == 0
        assert data.Conventions == "CF-1.11"
        assert data.microslip_version == microslip.__version__
        assert len(data.source_digest) == 64
        assert json.loads(data.configuration)["sweep"]["velocity"] == [0.1, 1, 10]
        assert "numba" in data.library_versions
        assert str(tmp_path) not in str(data.attrs)


@pytest.mark.parametrize("name", GRIDS)
def test_equal_results_give_equal_bytes(name, tmp_path, solver):
    first, second = tmp_path / "first.nc", tmp_path / "elsewhere" / "second.nc"
    write(name, tmp_path, first)
    time.sleep(1.1)  # HDF5 can hold times, in seconds
    write(name, tmp_path, second)
    assert first.read_bytes() == second.read_bytes()


def test_a_missing_or_additional_point_is_an_error(tmp_path, solver):
    configuration = config.from_mapping({"sweeps": GRIDS})
    grid, store = configuration.sweeps["bore"], Store(tmp_path)
    records = [sweep.answer(request, store)[0] for request in sweep.PointRequests(grid)]
    for wrong in (records[:-1], [*records, records[0]]):
        with pytest.raises(ValueError, match="results for 6 points"):
            dataset.write_sweep(tmp_path / "bore.nc", grid, wrong, [], {})
        assert not list(tmp_path.glob("*.nc*"))


def test_a_dataset_is_replaced_whole_or_not_at_all(tmp_path, monkeypatch, solver):
    path = tmp_path / "bore.nc"
    write("bore", tmp_path, path)
    before = path.read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache.os, "fsync", full)
    with pytest.raises(CacheError, match="No space left"):
        write("transverse", tmp_path, path, NU)
    assert path.read_bytes() == before
    assert {p.name for p in tmp_path.glob("*.nc*")} == {"bore.nc", ".bore.nc.sha256"}


@pytest.mark.parametrize("block", [1, 2, 3, 4, 6, 7, 12])
def test_blocks_of_any_size_give_the_same_dataset(block, tmp_path, monkeypatch, solver):
    with on_disk("transverse", tmp_path, NU) as whole:
        whole.load()
    monkeypatch.setattr(columns, "BLOCK", block)
    held = []
    seen = columns._column
    monkeypatch.setattr(columns, "_column", lambda b, *rest: held.append(len(b)) or seen(b, *rest))
    with on_disk("transverse", tmp_path, NU) as cut:
        xr.testing.assert_identical(cut.load(), whole)
    assert max(held) <= block


def test_large_datasets_are_chunked_and_open_with_dask(tmp_path, monkeypatch, solver):
    monkeypatch.setattr(columns, "BLOCK", 3)
    write("transverse", tmp_path, tmp_path / "transverse.nc", NU)
    with xr.open_dataset(tmp_path / "transverse.nc", chunks={}) as data:
        assert data.mu_macro.chunks == ((1, 1), (1, 1), (3,))
        assert float(data.mu_macro.mean()) == pytest.approx(float(data.mu_macro.load().mean()))


def test_a_single_run_that_fails_is_left_out_and_listed(tmp_path, monkeypatch, solver):
    def fail(*_, **__):
        raise ValueError("a root finder found none")

    monkeypatch.setattr("microslip.history", fail, raising=False)
    data = built("transverse", tmp_path)
    assert not [name for name in data.variables if name.startswith("history_")]
    assert data.converged.all()
    *_, last = dataset.report(data)
    assert last == "  single runs left out: history: ValueError: a root finder found none"
    with on_disk("continuous_bore", tmp_path) as data:
        assert "transient_torque" not in data and "field_bound" not in data


def test_a_sweep_at_an_imposed_resolution_counts_what_misses_its_tolerance(tmp_path):
    """Not so without a tolerance: then its attribute is not a number."""
    axes = {"velocity": [0.1, 0.3], "amplitude": [1], "cells": 8, "steps": 16}
    for tolerance, count in ((1e-3, "2"), (None, "none")):
        grids = {"transverse": {**axes, "tolerance": tolerance}}
        with on_disk("transverse", tmp_path / str(tolerance), grids) as data:
            summed = next(dataset.report(data))
            assert summed == f"transverse: 2 points, {count} not converged"
            assert (data.mu_macro_error > 1e-3).all()
            assert np.isnan(data.tolerance) == (tolerance is None)
            if tolerance:
                assert all("at the imposed resolution" in str(r) for r in data.reason.values.flat)


def test_the_static_limit_at_any_poissons_ratio_is_a_point_of_a_sweep(tmp_path, solver):
    axes = {"velocity": [0, 0.1], "amplitude": [0.5, 1], "poisson": [0, 0.3], "model": "polar"}
    with on_disk("transverse", tmp_path, {"transverse": axes}) as data:
        assert data.mu_macro.dims == ("poisson", "amplitude", "velocity")
        assert float(data.velocity[0]) == 0.0


def test_periods_are_halves_of_full_ones_in_the_file(tmp_path, solver):
    with on_disk("transverse", tmp_path) as data:
        assert data.periods.dtype == float and set(data.periods.values.flat) == {2.5}
        assert "full periods" in data.periods.long_name
