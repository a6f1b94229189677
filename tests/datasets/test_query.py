"""Interpolation between the points of a map, and its error bound."""

import pickle

import numpy as np
import pytest
import xarray as xr
from stubs.eq6_map import map_of, places, with_checksums
from stubs.new_process import output

from microslip.datasets.interpolation import Axis, Grid
from microslip.foundation.errors import InputError
from microslip.theory import paper

VELOCITY = np.geomspace(1e-3, 10, 13)
AMPLITUDE = np.linspace(0, 3, 13)


def friction(v, a, nu=0.0):
    """An invented smooth friction: Eq 6 with the power 1.5 of the amplitude."""
    return 1.0 - (1.0 - paper.large_amplitude_transverse(v, a**1.5)) * (1.0 - nu**2)


def made_up(velocity=VELOCITY, amplitude=AMPLITUDE, error=0.0, nu=0.0, **more):
    v, a = np.meshgrid(velocity, amplitude)
    return map_of(friction(v, a, nu), velocity, amplitude, error, nu, **more)


@pytest.mark.parametrize("imports", ["microslip, xarray", "xarray, microslip"])
def test_importing_the_package_registers_the_accessor(imports, tmp_path):
    made_up().to_netcdf(tmp_path / "map.nc")
    opened = f"xarray.open_dataset({str(tmp_path / 'map.nc')!r})"
    printed = output(f"import {imports}; print({opened}.microslip.at(0.3, 1.1).mu_macro.item())")
    assert float(printed) == float(made_up().microslip.at(0.3, 1.1).mu_macro)


def test_a_cubic_is_interpolated_exactly_on_three_axes():
    axes = {"a": Axis(np.linspace(0, 1, 6)), "b": Axis(np.linspace(2, 3, 7))}
    axes["c"] = Axis(np.geomspace(0.1, 10, 5))

    def cubic(a, b, c):
        return 1 + a - 2 * a**3 + b**2 * a - b**3 + np.log(c) ** 3 * a

    nodes = cubic(*np.meshgrid(*(axis.values for axis in axes.values()), indexing="ij"))
    points = np.array([[0.03, 0.5, 0.97], [2.9, 2.01, 2.5], [0.1, 0.41, 9.9]])
    value, error = Grid(axes, nodes, np.zeros(nodes.shape)).at(
        dict(zip("abc", points, strict=True))
    )
    assert value == pytest.approx(cubic(*points), abs=1e-12)
    assert error == pytest.approx(0.0, abs=1e-12)


def covered(answer, truth):
    """Fraction of the values that are within their error of the truth."""
    miss = np.abs(answer.mu_macro.values - truth)
    return np.mean(miss <= answer.mu_macro_error.values + 1e-12)


@pytest.mark.parametrize("kink", [0.41, 0.5, 0.58])
def test_the_bound_covers_a_kink(kink):
    axis = Axis(np.linspace(0, 1, 13))
    values = np.abs(axis.values - kink)
    x = np.linspace(0, 1, 1001)
    value, error = Grid({"x": axis}, values, np.zeros(values.shape)).at({"x": x})
    miss = np.abs(value - np.abs(x - kink))
    assert miss.max() > 5e-3  # the cubic has a large error at the kink
    assert (miss <= error + 1e-12).mean() > 0.99


def test_the_bound_covers_the_interpolation_error_and_the_errors_of_the_points():
    v, a = places(500)
    answer = made_up().microslip.at(v, a)
    assert covered(answer, friction(v.values, a.values)) >= 0.99
    fine = made_up(np.geomspace(1e-3, 10, 25), np.linspace(0, 3, 25)).microslip.at(v, a)
    assert np.median(fine.mu_macro_error) < 0.1 * np.median(answer.mu_macro_error)
    data = made_up()
    data["mu_macro_error"][1::2, 1::2] = 0.01  # next to every point
    off = with_checksums(data).microslip.at(v, a)
    assert (off.mu_macro_error - answer.mu_macro_error).values == pytest.approx(0.01)


@pytest.mark.parametrize("ratios", [(0.0, 0.5), (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)])
def test_the_bound_covers_points_between_poissons_ratios(ratios):
    v, a = places(300, seed=7)
    several = xr.concat([made_up(nu=nu) for nu in ratios], "poisson")
    for nu in (0.05, 0.33, 0.5):
        answer = several.microslip.at(v, a, poisson=nu)
        assert covered(answer, friction(v.values, a.values, nu)) >= 0.99


def test_numbers_sequences_arrays_and_chunks():
    data = made_up()
    one = data.microslip.at(velocity=0.05, amplitude=0.8)
    assert one.mu_macro.dims == ()
    outer = data.microslip.at([0.05, 0.1, 1], [0.8, 2])
    assert dict(outer.mu_macro.sizes) == {"amplitude": 2, "velocity": 3}
    assert float(outer.mu_macro.sel(velocity=0.05, amplitude=0.8)) == float(one.mu_macro)
    v, a = xr.DataArray([0.05, 1.0], dims="n"), xr.DataArray([0.8, 2.0], dims="n")
    pairs = data.microslip.at(v, a)
    assert pairs.mu_macro.values == pytest.approx(np.diag(outer.mu_macro.values[:, [0, 2]]))
    lazy = data.chunk({"velocity": 4}).microslip.at(v.chunk(n=1), a.chunk(n=1))
    assert lazy.mu_macro.chunks == lazy.mu_macro_error.chunks == ((1, 1),)
    xr.testing.assert_identical(lazy.compute(), pairs)
    lazy = data.microslip.at(v.chunk(n=1), -a)
    with pytest.raises(InputError, match="amplitude"):
        lazy.compute()


def test_beside_points_that_did_not_converge_the_bound_is_infinite_and_near_them_it_holds():
    dataset = made_up()
    dataset["checksum"][6, 6] = 0
    beside = dataset.microslip.at(VELOCITY[6] * 1.1, AMPLITUDE[6] * 1.05)
    assert np.isnan(beside.mu_macro) and np.isinf(beside.mu_macro_error)
    assert "reason of the map" in beside.comment
    node = dataset.microslip.at(VELOCITY[6], AMPLITUDE[5])
    assert (node.mu_macro, node.mu_macro_error) == (dataset.mu_macro[5, 6], 0.0)
    dataset["checksum"].values[np.random.default_rng(1).random((13, 13)) < 0.08] = 0
    v, a = places(2000)
    near = dataset.microslip.at(v, a)
    solved = near.mu_macro.notnull().values
    assert solved.sum() > 1300
    assert covered(near.isel(n=solved), friction(v, a)[solved]) >= 0.99


def test_a_static_limit_is_not_interpolated():
    data = made_up(np.concatenate([[0.0], VELOCITY]))
    assert float(data.microslip.at(0.0, 1.0).mu_macro) == pytest.approx(0.0, abs=1e-12)
    assert float(data.microslip.at(0.3, 1.1).mu_macro) == float(
        made_up().microslip.at(0.3, 1.1).mu_macro
    )
    with pytest.raises(InputError, match="velocity = 0.0005: allowed is 0, or 0.001 to 10"):
        data.microslip.at(5e-4, 1.0)


def test_a_map_over_forces_has_velocities():
    data = made_up().rename(mu_macro="velocity", mu_macro_error="velocity_error", velocity="force")
    data = with_checksums(data.rename(velocity="mean").rename(mean="velocity"), "velocity")
    answer = data.microslip.at(force=0.3, amplitude=1.1)
    assert float(answer.velocity) == float(made_up().microslip.at(0.3, 1.1).mu_macro)


PARTS = {
    "three variables": lambda data: data[["mu_macro", "mu_macro_error", "checksum"]],
    "a slice": lambda data: data.sel(velocity=slice(0.01, 6), amplitude=slice(0.4, 2.6)),
    "lazy": lambda data: data.chunk({"velocity": 4, "amplitude": 5}),
    "reversed": lambda data: data.isel(velocity=slice(None, None, -1)).transpose(),
    "pickled after a query": lambda data: pickle.loads(pickle.dumps(data)),
    "without indexes": lambda data: data.drop_indexes(["velocity", "amplitude"]),
    "as one ratio": lambda data: data.expand_dims("poisson"),
    "of two ratios": lambda data: xr.concat([made_up(nu=0.5), data], "poisson").isel(poisson=1),
    "stacked": lambda data: data.stack(n=["velocity", "amplitude"]).unstack(),
    "in a file": lambda data: xr.load_dataset(data.to_netcdf()),
    "with a gap": lambda data: data.reindex(velocity=[*VELOCITY, 20]).where(data.converged),
}


@pytest.mark.parametrize("part", PARTS)
def test_a_part_of_a_dataset_answers_like_the_whole(part):
    whole = made_up(error=1e-4)
    place = {"velocity": 0.15, "amplitude": 1.3}
    more = {"poisson": 0.0} if part == "as one ratio" else {}
    reference = whole.microslip.at(**place)
    answer = PARTS[part](whole).microslip.at(**place, **more)
    assert float(answer.mu_macro) == pytest.approx(float(reference.mu_macro), abs=1e-12)
    assert float(answer.mu_macro_error) == pytest.approx(float(reference.mu_macro_error), rel=1e-9)


def test_a_single_point_answers_with_its_own_value():
    point = made_up(error=1e-4).isel(velocity=3, amplitude=3)
    answer = point.microslip.at(float(point.velocity), float(point.amplitude))
    assert float(answer.mu_macro) == float(point.mu_macro)
    assert float(answer.mu_macro_error) == float(point.mu_macro_error)


ONE = {"velocity": 1, "amplitude": 1}
OTHER = made_up().assign_attrs(motion="longitudinal")
PAIR = xr.DataArray([1.0, 2.0], dims="n")


@pytest.mark.parametrize(
    ("data", "place", "argument"),
    [
        *((made_up(), ONE | {"velocity": one}, "velocity") for one in (20, np.nan, "x", [[1.0]])),
        (made_up(), {"velocity": 1}, "amplitude"),
        *((made_up(), ONE | {name: 0.2}, name) for name in ("poisson", "mass")),
        (made_up(), {"velocity": PAIR, "amplitude": PAIR[:1]}, "velocity"),
        (made_up()[["mu_macro"]], ONE, "mu_macro_error"),
        (made_up()[["mu_macro", "mu_macro_error"]].interp(amplitude=[0.5, 1.5]), ONE, "checksum"),
        (made_up().rename(velocity="v"), ONE, "velocity"),
        (made_up().isel(velocity=[0, 0, 1]), ONE, "velocity"),
        (made_up().astype(str), ONE, "mu_macro"),
        (made_up().where(made_up().velocity < 0.5, with_checksums(OTHER)), ONE, "mu_macro"),
        (made_up().assign_coords(poisson=("velocity", VELOCITY / 20)), ONE, "poisson"),
        (made_up().expand_dims(made=2), ONE, "made"),
    ],
)
def test_bad_points_and_datasets_are_refused_by_name(data, place, argument):
    with pytest.raises(InputError) as caught:
        data.microslip.at(**place)
    assert caught.value.argument == argument


def several():
    """Maps of two Poisson's ratios, with points that did not converge."""
    data = xr.concat([made_up(nu=0.0), made_up(nu=0.5)], "poisson")
    data["converged"][:, 6, 6] = False
    return with_checksums(data)


CHANGED = {
    "midpoints": lambda data: data.interp(amplitude=AMPLITUDE[:-1] + 0.125),
    "between ratios": lambda data: data.interp(poisson=[0.0, 0.25]),
    "averaged": lambda data: data.mean("poisson"),
    "without its ratio": lambda data: data.isel(poisson=0, drop=True),
    "rolled": lambda data: data.roll(velocity=1),
    "less error": lambda data: data.assign(mu_macro_error=0.5 * data.mu_macro_error - 1e-5),
    "all converged": lambda data: data.assign(checksum=data.checksum + 1 - data.converged),
    "rolling": lambda data: data.rolling(velocity=3).mean().dropna("velocity"),
    "one changed": lambda data: data.where(data.velocity > 1e-3, data + 1e-16),
}


@pytest.mark.parametrize("change", CHANGED)
def test_a_grid_whose_points_are_not_the_computed_ones_is_refused(change):
    place = {"velocity": 1.1, "amplitude": 1.1, "poisson": 0.1}
    assert several().microslip.at(**place).mu_macro_error < 0.5
    with pytest.raises(InputError, match="^(mu_macro|poisson) = .*(is the computed map|needed)"):
        CHANGED[change](several()).microslip.at(**place)
