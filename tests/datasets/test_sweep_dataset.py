"""Datasets of sweeps: coordinates, variables, conventions, and equal bytes for equal results."""

import errno
import json
import time
import warnings
from unittest.mock import Mock

import netCDF4
import numpy as np
import pytest
import xarray as xr
from stubs import sweep_stub
from stubs.sweep_stub import EFFORT, RUNS, Solver

import microslip
from microslip.datasets import netcdf, sweep_dataset
from microslip.foundation import files
from microslip.foundation.errors import InputError, SolverError
from microslip.foundation.files import CacheError
from microslip.sweeps import request
from microslip.theory import paper

AXES = {"velocity": [0.1, 1, 10], "amplitude": [0, 2]}
GRIDS = {"transverse": AXES, "bore": AXES, "continuous_bore": {"velocity": [0.1, 1, 10]}}


def records_of(name, grids):
    """Configuration of sweeps with the figures of their single runs, and records of a sweep."""
    drawn = [sweep for sweep, axes in grids.items() if "stiffness" not in axes]
    figures = {name: figure for name, figure in RUNS.items() if figure["sweep"] in drawn}
    configuration = sweep_stub.configured(grids, figures=figures)
    return configuration, sweep_stub.records_of(configuration, name)


def write(name, path, grids=GRIDS):
    configuration, records = records_of(name, grids)
    netcdf.write(path, *sweep_dataset.build(configuration, name, records))


@pytest.fixture
def solver(monkeypatch):
    return Solver(monkeypatch)


def on_disk(name, folder, grids=GRIDS):
    write(name, folder / f"{name}.nc", grids)
    return xr.open_dataset(folder / f"{name}.nc")


def built(name, folder):
    """A dataset with the variables of its groups."""
    write(name, folder / f"{name}.nc")
    return netcdf.whole(folder / f"{name}.nc")


def test_points_lie_where_their_coordinates_say(tmp_path, solver):
    with on_disk("bore", tmp_path) as data:
        assert data.mu_macro.dims == ("amplitude", "velocity")
        expected = data.velocity / (1 + data.velocity + data.amplitude)
        xr.testing.assert_allclose(data.mu_macro, expected.transpose("amplitude", "velocity"))
        assert 0 < float(data.interp(velocity=5.5, amplitude=1.0).mu_macro) < 1
        assert float(data.poisson) == 0 and data.tolerance == 1e-3


@pytest.mark.parametrize("more", [{}, {"stiffness": [0.5, 2]}], ids=str)
def test_a_list_of_poissons_ratios_is_a_dimension(more, tmp_path, solver):
    grids = {"transverse": AXES | {"poisson": [0, 0.3]} | more}
    with on_disk("transverse", tmp_path, grids) as data:
        assert {*data.mu_macro.dims} == {"poisson", "amplitude", "velocity", *more}
        assert data.sel(poisson=0.3, velocity=1, amplitude=2).mu_macro.size == 2 ** len(more)
        assert data.mu_static.dims == ("amplitude",)
        change = data.mu_macro - data.mu_macro.sel(poisson=0)
        assert data.mu_macro_change.values == pytest.approx(change.values)
        assert np.all(data.mu_macro_change.sel(poisson=0.3) < 0)
        both = data.mu_macro_error + data.mu_macro_error.sel(poisson=0)
        assert data.mu_macro_change_error.values == pytest.approx(both.values)


def test_errors_convergence_and_effort_are_there(tmp_path, monkeypatch):
    Solver(monkeypatch, fails=2.0)
    with on_disk("transverse", tmp_path) as data:
        assert data.converged.dtype == bool
        assert data.converged.sel(amplitude=0).all() and not data.converged.sel(amplitude=2).any()
        assert np.isnan(data.mu_macro.sel(amplitude=2)).all()
        assert set(microslip.texts(data.reason.sel(amplitude=2)).values) == {"no periodic state"}
        assert set(microslip.texts(data.model).values.flat) == {"polar"}
        for name, value in EFFORT.items():
            assert data[name].dtype.kind == ("f" if name in ("periods", "work", "effort") else "i")
            assert (data[name] == value).all()
        assert (data.mu_macro_error == 4e-5).all()
        assert ((data.checksum != 0) == data.converged).all()
        assert list(sweep_dataset.report(data, "transverse"))[:2] == [
            "transverse: 6 points, 3 not converged",
            "  not converged: amplitude 2, velocity 0.1: no periodic state",
        ]
    with netCDF4.Dataset(tmp_path / "transverse.nc") as raw:
        flag = raw["converged"]
        assert flag.dtype == np.int8 and list(flag.flag_values) == [0, 1]
        # texts of variable length crash Python if an open file is opened again
        kinds = {str(variable.dtype) for variable in raw.variables.values()}
        assert kinds <= {"int8", "int16", "int32", "float32", "float64"}


LIMITS = {
    "transverse": {
        "mu_large_amplitude": paper.large_amplitude_transverse,
        "mu_static_slider": lambda v, a: paper.static_slider(a),
        "mu_static_stick_zone": lambda v, a: paper.static_transverse(a),
        "mu_static": lambda v, a: paper.static_limit_transverse(a),
    },
    "bore": {
        "mu_large_amplitude": lambda v, a: paper.large_amplitude_bore(v),
        "mu_static_stick_zone": lambda v, a: paper.static_bore(a),
        "mu_static_stick_zone_printed": lambda v, a: paper.static_bore_printed(a),
        "mu_static": lambda v, a: paper.static_limit_bore(a),
    },
    "continuous_bore": {
        "mu_forward_theory": lambda v, a: paper.bore_forward(v),
        "mu_torque_theory": lambda v, a: paper.bore_torque(v),
    },
}


@pytest.mark.parametrize("name", LIMITS)
def test_limits_are_at_the_points_and_on_fine_axes(name, tmp_path, solver):
    data = built(name, tmp_path)
    for limit, function in LIMITS[name].items():
        axes = set(data[limit].dims)
        assert axes <= set(data.mu_macro.dims)
        places = ((0 * data[limit] + (data[axis] if axis in axes else 0)).values for axis in AXES)
        assert data[limit].values == pytest.approx(function(*places))
        fine = data[f"{limit}_curve"]
        along = "velocity" if "velocity" in axes else "amplitude"
        place = {"velocity": 1.0, "amplitude": 2.0} | {along: data[f"{along}_curve"].values}
        assert fine.values == pytest.approx(function(*place.values()))


@pytest.mark.slow
def test_single_runs_for_the_figures_are_in_the_dataset(tmp_path, solver):
    data = built("transverse", tmp_path)
    assert data.history_force_forward.dims == ("history_step",)
    assert (float(data.history_velocity), float(data.history_amplitude)) == (0.1, 1.0)
    history = microslip.open_map("transverse", tmp_path, group="history")
    assert history.source_digest == data.source_digest and "Figure 1" in history.title
    with pytest.raises(InputError, match="group = 'field': allowed is one of velocity_curves, am"):
        microslip.open_map("transverse", tmp_path, group="field")
    data = built("continuous_bore", tmp_path)
    assert list(data.start.values) == list(request.STARTS)
    assert data.transient_torque.dims == ("start", "transient_step")
    assert data.transient_force_forward.sel(start="stress-free").values[-1] == 1
    assert data.transient_force_forward.sel(start="full-slip").values[-1] == 0
    assert float(data.transient_force_theory) == pytest.approx(float(paper.bore_forward(0.8)))
    assert data.field_traction_forward.dims == ("cell",)
    assert float(data.field_centre_lateral) == -0.5


@pytest.mark.slow
@pytest.mark.parametrize("name", GRIDS)
def test_conventions_provenance_and_equal_bytes(name, tmp_path, solver):
    for variable in built(name, tmp_path).variables.values():
        assert 0 < len(variable.attrs["long_name"]) <= 40  # long names are labels of plots
    first = (tmp_path / f"{name}.nc").read_bytes()
    time.sleep(1.1)  # HDF5 can store times in seconds
    with on_disk(name, tmp_path) as data:
        for variable in data.variables.values():
            if variable.dtype.kind in "if" and "flag_values" not in variable.attrs:
                assert variable.attrs["units"] in ("1", "rad")
        assert data.Conventions == "CF-1.11"
        assert data.source.startswith(f"microslip {microslip.__version__}") and data.institution
        assert data.mu_macro.ancillary_variables == "mu_macro_error"
        assert json.loads(data.configuration)["sweep"]["velocity"] == [0.1, 1, 10]
        assert "numba" in data.library_versions
        assert str(tmp_path) not in str(data.attrs)
    assert (tmp_path / f"{name}.nc").read_bytes() == first


def test_a_missing_or_additional_point_is_an_error(solver):
    configuration, records = records_of("bore", GRIDS)
    for wrong in (records[:-1], [*records, records[0]]):
        with pytest.raises(ValueError, match="results for 6 points|1 single runs"):
            sweep_dataset.build(configuration, "bore", wrong)


def test_a_dataset_is_replaced_whole_or_not_at_all(tmp_path, monkeypatch, solver):
    path = tmp_path / "bore.nc"
    write("bore", path)
    before = path.read_bytes()
    full = OSError(errno.ENOSPC, "No space left on device")
    monkeypatch.setattr(files.os, "fsync", Mock(side_effect=full))
    with pytest.raises(CacheError, match="No space left"):
        write("transverse", path)
    assert path.read_bytes() == before
    assert {p.name for p in tmp_path.iterdir() if p.is_file()} == {"bore.nc"}


def test_a_single_run_that_fails_is_left_out_and_listed(tmp_path, monkeypatch, solver):
    fail = Mock(side_effect=SolverError("a root finder found none"))
    monkeypatch.setattr("microslip.history", fail, raising=False)
    data = built("transverse", tmp_path)
    assert not [name for name in data.variables if name.startswith("history_")]
    assert data.converged.all()
    *_, last = sweep_dataset.report(data, "transverse")
    assert last == "  single runs left out: history: SolverError: a root finder found none"


# Texts, plots and joins in plain xarray

VERBS = {
    "stack": lambda data: data.stack(point=("velocity", "amplitude")).unstack(),
    "where": lambda data: data.where(data.converged),
    "part": lambda data: data.isel(velocity=[0, 2]),
    "table": lambda data: data.to_dataframe().to_xarray(),
}


@pytest.mark.parametrize("chunks", [None, {}, "auto"], ids=str)
def test_an_opened_map_supports_the_verbs_of_xarray(chunks, tmp_path, monkeypatch):
    Solver(monkeypatch, fails=2.0)
    write("transverse", tmp_path / "transverse.nc")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for of in (xr.open_dataset, microslip.open_map):
            with of(tmp_path / "transverse.nc", chunks=chunks) as data:
                for verb in VERBS.values():
                    assert verb(data).load().mu_macro.size
                for part in (data, VERBS["part"](data)):
                    part.to_netcdf(tmp_path / "copy.nc")
                    with xr.open_dataset(tmp_path / "copy.nc") as copy:
                        xr.testing.assert_identical(copy.load(), part.load())


def test_codes_of_texts_are_equal_in_all_files_and_texts_are_stored_exactly(tmp_path):
    """Files can therefore be joined; the texts of many points have more than 64 kB."""
    texts = [f"point {k} of \N{GREEK SMALL LETTER NU} {'_' * (k % 3)}x" for k in range(3000)]
    for name, part in (("all", ["", *texts]), ("some", texts[:2500:7])):
        netcdf.write(tmp_path / f"{name}.nc", xr.Dataset({"reason": ("point", part)}))
    with (
        xr.open_dataset(tmp_path / "all.nc") as every,
        xr.open_dataset(tmp_path / "some.nc") as some,
    ):
        assert microslip.texts(every.reason).values.tolist() == ["", *texts]
        assert some.reason.values.tolist() == every.reason[1:2501:7].values.tolist()
        assert len(set(every.reason.flag_meanings.split())) == 3001
    assert netcdf.whole(tmp_path / "some.nc").reason.values.tolist() == texts[:2500:7]
    with pytest.raises(InputError, match="codes = 'mu_macro': allowed is a variable with"):
        microslip.texts(xr.DataArray(1.0, name="mu_macro"))


def test_a_dataset_of_many_points_can_be_opened_and_long_texts_are_cut(tmp_path):
    """A file with fewer bytes than values is taken for a damaged one."""
    text = "no \u03bd " + "\u03b1" * 300
    axes = {"velocity": np.geomspace(0.01, 1, 70).tolist(), "amplitude": np.arange(70).tolist()}
    configuration, path = sweep_stub.configured({"transverse": axes}), tmp_path / "transverse.nc"
    record = {"versions": {}, "result": {"reason": text}}
    netcdf.write(path, *sweep_dataset.build(configuration, "transverse", [record] * 4900))
    reason = microslip.texts(microslip.open_map(path).reason).values
    assert reason.shape == (70, 70) and reason[0, 0].endswith("\u03b1...")
    assert text.startswith(reason[0, 0].removesuffix("..."))
    assert len(reason[0, 0]) == sweep_dataset.LONGEST_TEXT


@pytest.mark.slow
def test_files_of_parts_of_an_axis_are_one_dataset(tmp_path, solver):
    for name, velocity in (("slow", [0.1, 1]), ("fast", [10, 100])):
        write("bore", tmp_path / f"{name}.nc", {"bore": AXES | {"velocity": velocity}})
    paths = [tmp_path / "fast.nc", tmp_path / "slow.nc"]
    with xr.open_mfdataset(paths, data_vars="minimal", compat="no_conflicts") as both:
        assert both.velocity.values.tolist() == [0.1, 1, 10, 100]
        assert both.mu_static.dims == ("amplitude",)
        assert both.converged.dtype == bool
        assert float(both.mu_macro.sel(velocity=100, amplitude=2)) == pytest.approx(100 / 103)
        assert both.motion == "bore"
