"""Interpolation between the points of a map, estimates outside, and their error bounds."""

import pickle
import subprocess
import sys

import netCDF4
import numpy as np
import pytest
import xarray as xr
from stubs.eq6_map import map_of, places

import microslip
from microslip.datasets import netcdf
from microslip.datasets.query.answers import SOURCES
from microslip.datasets.query.interpolation import Axis, Table
from microslip.datasets.query.open_map import open_map
from microslip.foundation.errors import InputError
from microslip.foundation.files import CacheError
from microslip.sweeps import stamps
from microslip.theory import paper

VELOCITY = np.geomspace(1e-3, 10, 13)
AMPLITUDE = np.linspace(0, 3, 13)


def made_up(velocity=VELOCITY, amplitude=AMPLITUDE, error=0.0, **more):
    """The map of an invented smooth friction: Eq 6 with the power 1.5 of the amplitude."""
    v, a = np.meshgrid(velocity, amplitude)
    return map_of(paper.large_amplitude_transverse(v, a**1.5), velocity, amplitude, error, **more)


OPENED = """
{imports}
with xr.open_dataset({path!r}) as data:
    print(float(data.microslip.at(0.3, 1.1).mu_macro))
"""


@pytest.mark.parametrize(
    "imports", ["import microslip, xarray as xr", "import xarray as xr, microslip"]
)
def test_importing_the_package_is_enough_to_ask_a_dataset(imports, tmp_path):
    made_up().to_netcdf(tmp_path / "map.nc")
    code = OPENED.format(imports=imports, path=str(tmp_path / "map.nc"))
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert float(process.stdout) == float(made_up().microslip.at(0.3, 1.1).mu_macro)


def test_a_dataset_can_be_pickled_after_it_was_asked():
    data = made_up()
    place = {"velocity": 0.3, "amplitude": 1.1}
    answer = data.microslip.at(**place)
    copy = pickle.loads(pickle.dumps(data))
    assert copy.identical(data)
    assert copy.microslip.at(**place).identical(answer)
    assert pickle.loads(pickle.dumps(data.friction)).at(**place).identical(answer)


# Interpolation


def test_a_cubic_is_met_and_known_to_be_met():
    x, y = Axis(np.linspace(0, 1, 6)), Axis(np.linspace(2, 3, 7))

    def cubic(a, b):
        return 1 + a - 2 * a**3 + b**2 * a - b**3

    table = Table(x, y, cubic(x.values[:, None], y.values), np.zeros((6, 7)))
    a, b = np.array([0.03, 0.5, 0.97]), np.array([2.9, 2.01, 2.5])
    value, error = table.at(a, b)
    assert value == pytest.approx(cubic(a, b), abs=1e-12)
    assert error == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("kink", [0.41, 0.5, 0.58])
def test_the_bound_holds_at_a_kink(kink):
    axis = Axis(np.linspace(0, 1, 13))
    values = np.tile(np.abs(axis.values - kink), (3, 1))
    table = Table(Axis(np.arange(3.0)), axis, values, np.zeros(values.shape))
    x = np.linspace(0, 1, 1001)
    value, error = table.at(np.ones(x.size), x)
    miss = np.abs(value - np.abs(x - kink))
    assert miss.max() > 5e-3  # the cubic has a large error at the kink
    assert (miss <= error + 1e-12).mean() > 0.99


# The accessor


@pytest.fixture
def friction():
    return made_up().friction


def test_the_error_covers_what_is_missed_and_what_the_nodes_are_off():
    v, a = places(500)
    truth = paper.large_amplitude_transverse(v.values, a.values**1.5)
    answer = made_up().microslip.at(v, a)
    miss = np.abs(answer.mu_macro.values - truth)
    assert (miss <= answer.mu_macro_error.values + 1e-12).mean() >= 0.99
    fine = made_up(np.geomspace(1e-3, 10, 25), np.linspace(0, 3, 25)).microslip.at(v, a)
    assert np.median(fine.mu_macro_error) < 0.1 * np.median(answer.mu_macro_error)
    off = made_up(error=0.01).microslip.at(v, a)
    more = off.mu_macro_error.values - answer.mu_macro_error.values
    assert np.median(more) == pytest.approx(0.01)  # less where the energy balance limits the error
    assert more.max() < 0.01 + 1e-12


def test_numbers_sequences_and_arrays(friction):
    one = friction.at(0.05, 0.8)
    assert one.mu_macro.dims == ()
    outer = friction.at([0.05, 0.1, 1], [0.8, 2])
    assert dict(outer.mu_macro.sizes) == {"amplitude": 2, "velocity": 3}
    assert outer.mu_macro.dims == ("amplitude", "velocity")
    assert float(outer.mu_macro.sel(velocity=0.05, amplitude=0.8)) == float(one.mu_macro)
    pairs = friction.at(xr.DataArray([0.05, 1.0], dims="n"), xr.DataArray([0.8, 2.0], dims="n"))
    assert pairs.mu_macro.dims == ("n",)
    assert pairs.mu_macro.values == pytest.approx(np.diag(outer.mu_macro.values[:, [0, 2]]))


def test_a_point_that_did_not_converge_is_not_interpolated_over():
    dataset = made_up()
    dataset["converged"][6, 6] = False
    v, a = float(VELOCITY[6]), float(AMPLITUDE[6])
    near = dataset.microslip.at(v * 1.1, a * 1.05)
    assert np.isnan(near.mu_macro) and np.isinf(near.mu_macro_error)
    far = dataset.microslip.at(VELOCITY[2], AMPLITUDE[2])
    assert np.isfinite(far.mu_macro)


def over_poisson(poissons):
    """Maps at several Poisson's ratios nu, joined; the drop below 1 is proportional to 1 - nu^2."""
    maps = [made_up().assign_coords(poisson=nu) for nu in poissons]
    for part, nu in zip(maps, poissons, strict=True):
        part["mu_macro"] = 1 - (1 - part.mu_macro) * (1 - nu**2)
    return xr.concat(maps, "poisson")


@pytest.mark.parametrize("poissons", [(0.0, 0.5), (0.5, 0.0, 0.25), (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)])
def test_between_poissons_ratios_the_error_covers_what_is_missed(poissons):
    v, a = places(300, seed=7)
    both = over_poisson(poissons)
    for nu in (0.05, 0.2, 0.33, 0.5):
        answer = both.microslip.at(v, a, poisson=nu)
        truth = paper.large_amplitude_transverse(v.values, a.values**1.5)
        truth = 1 - (1 - truth) * (1 - nu**2)
        miss = np.abs(answer.mu_macro.values - truth)
        assert (miss <= answer.mu_macro_error.values + 1e-12).mean() >= 0.99
        assert float(answer.poisson) == nu


def test_one_of_the_poissons_ratios_is_its_own_map_alone():
    both = over_poisson((0.0, 0.5))
    both["converged"][0, 6, 6] = False
    v, a = float(VELOCITY[6]), float(AMPLITUDE[6])
    alone = both.sel(poisson=0.5).microslip.at(v * 1.1, a * 1.05)
    xr.testing.assert_identical(both.microslip.at(v * 1.1, a * 1.05, poisson=0.5), alone)
    assert np.isfinite(alone.mu_macro)
    for nu in (0.0, 0.2):
        near = both.microslip.at(v * 1.1, a * 1.05, poisson=nu)
        assert np.isnan(near.mu_macro) and np.isinf(near.mu_macro_error)


@pytest.mark.parametrize(
    ("poisson", "message"),
    [
        (None, "poisson = None: allowed is 0 to 0.5: the dataset has more than one"),
        (0.6, "poisson = 0.6: allowed is 0 to 0.5; microslip.solve"),
        (-0.1, "poisson = -0.1: allowed is 0 to 0.5"),
        (np.nan, "poisson = nan: allowed is 0 to 0.5"),
        ([0, 0.5], r"poisson = \[0, 0.5\]: allowed is 0 to 0.5, one number"),
    ],
)
def test_beyond_the_poissons_ratios_nothing_is_said(poisson, message):
    with pytest.raises(InputError, match=message):
        over_poisson((0.0, 0.5)).microslip.at(0.1, 1, poisson=poisson)
    with pytest.raises(InputError, match="poisson = 0.2: allowed is 0, the dataset's only one"):
        made_up().microslip.at(0.1, 1, poisson=0.2)


def test_below_the_map_friction_lies_between_the_static_limit_and_the_edge_at_any_poissons_ratio():
    exact = paper.static_limit_transverse(AMPLITUDE)[:, None]
    data = map_of(exact + (1 - exact) * VELOCITY / (1 + VELOCITY), VELOCITY, AMPLITUDE)
    data = data.assign_coords(poisson=0.5)
    for amplitude in AMPLITUDE[[2, 3, 6]]:
        still, slow, edge = (data.microslip.at(v, amplitude) for v in (0.0, 1e-4, 1e-3))
        low, high = (float(slow.mu_macro + sign * slow.mu_macro_error) for sign in (-1, 1))
        assert low <= float(still.mu_macro + still.mu_macro_error)
        assert high >= float(edge.mu_macro) - 1e-12
        # The static limit decreases with Poisson's ratio.
        at_0 = paper.static_limit_transverse(amplitude)
        assert at_0 - 0.012 <= float(still.mu_macro) <= at_0


@pytest.mark.long
def test_the_static_limit_at_any_poissons_ratio_holds_what_the_solver_computes():
    for amplitude, poisson in ((0.75, 0.25), (0.9, 0.5)):
        still = over_poisson((0.0, 0.5)).microslip.at(0.0, amplitude, poisson=poisson)
        truth = microslip.solve("transverse", 0.0, amplitude, poisson=poisson, tolerance=1e-3)
        off = abs(float(still.mu_macro) - truth.mu_macro)
        assert off <= float(still.mu_macro_error) + truth.mu_macro_error


# Selections and joins of datasets


PARTS = {
    "two variables": lambda data: data[["mu_macro", "mu_macro_error"]],
    "without converged": lambda data: data.drop_vars("converged"),
    "a slice": lambda data: data.sel(velocity=slice(0.01, 6), amplitude=slice(0.4, 2.6)),
    "by numbers": lambda data: data.isel(velocity=slice(3, None), amplitude=slice(1, 12)),
    "in memory": lambda data: data.compute(),
    "a copy": lambda data: data.copy(deep=True),
    "lazy": lambda data: data.chunk({"velocity": 4, "amplitude": 5}),
    "turned round": lambda data: data.isel(velocity=slice(None, None, -1)).transpose(),
    "shuffled": lambda data: data.isel(amplitude=np.random.default_rng(1).permutation(13)),
    "with twins": lambda data: data.isel(velocity=[0, 0, *range(13), 12]),
    "as one ratio": lambda data: data.expand_dims("poisson"),
}


@pytest.mark.parametrize("part", PARTS)
def test_a_part_of_a_dataset_answers_as_the_whole(part):
    whole = made_up(error=1e-4, tolerance=1e-3)
    reference, answer = (data.microslip.at(0.15, 1.3) for data in (whole, PARTS[part](whole)))
    assert float(answer.mu_macro) == pytest.approx(float(reference.mu_macro), abs=1e-12)
    # the error depends on the nodes around the cell, which all selections contain
    assert float(answer.mu_macro_error) == pytest.approx(float(reference.mu_macro_error), rel=1e-9)


def test_one_column_of_a_map_knows_its_own_velocity():
    whole = made_up(error=1e-4)
    answer = whole.isel(velocity=6).microslip.at(float(VELOCITY[6]), 1.3)
    reference = whole.microslip.at(float(VELOCITY[6]), 1.3)
    assert float(answer.mu_macro) == pytest.approx(float(reference.mu_macro), abs=1e-12)
    assert SOURCES[int(whole.isel(velocity=6).microslip.at(1.0, 1.3).source)] != "map"


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        (lambda data: data[["mu_macro"]], "mu_macro_error = None: microslip.at needs it"),
        (lambda data: data[["mu_macro_error"]], "mu_macro = None: microslip.at needs it"),
        (lambda data: data.drop_vars("converged"), "converged = None: microslip.at needs it"),
        (lambda data: data.drop_vars("poisson"), "poisson = None: microslip.at needs it"),
        (lambda data: data.isel(amplitude=3, drop=True), "amplitude = None: microslip.at needs it"),
        (lambda data: data.isel(velocity=[]), "velocity = 'no entry': microslip.at needs one"),
        (
            lambda data: xr.concat([data, data], "made"),
            "made = '2 entries': microslip.at needs one of them: select it",
        ),
    ],
)
def test_what_a_dataset_has_lost_is_named(broken, message):
    with pytest.raises(InputError, match=message):
        broken(made_up()).microslip.at(0.1, 1)


def test_without_converged_the_tolerance_says_what_is_known():
    dataset = made_up(error=1e-4, tolerance=1e-3)
    dataset["mu_macro_error"][6, 6] = 2e-3
    near = float(VELOCITY[6]) * 1.1, float(AMPLITUDE[6]) * 1.05
    answer = dataset.drop_vars("converged").microslip.at(*near)
    assert np.isnan(answer.mu_macro) and np.isinf(answer.mu_macro_error)


def test_what_is_changed_in_place_counts():
    dataset = made_up()
    v, a = float(VELOCITY[6]), float(AMPLITUDE[6])
    before = dataset.microslip.at(v, a)
    dataset["converged"][6, 6] = False
    assert np.isfinite(before.mu_macro) and np.isnan(dataset.microslip.at(v, a).mu_macro)


def test_nodes_that_a_join_has_filled_in_are_not_known():
    wide = made_up(amplitude=np.linspace(0, 6, 25)).assign_coords(poisson=0.5)
    both = xr.concat([made_up(), wide], "poisson", join="outer")
    answer = both.microslip.at(0.1, 5.0, poisson=0.25)
    assert np.isnan(answer.mu_macro) and np.isinf(answer.mu_macro_error)
    assert np.isfinite(both.microslip.at(0.1, 5.0, poisson=0.5).mu_macro)


# Springs


SPRING = {"drive": "stiffness, mass"}


def test_what_is_proved_at_a_velocity_is_not_said_of_a_spring():
    dataset = made_up().assign_attrs(SPRING)
    v, a = float(VELOCITY[6]), float(AMPLITUDE[6])
    assert float(dataset.microslip.at(v, a).mu_macro) == float(dataset.mu_macro[6, 6])
    for place in ((1e-6, a), (1e3, a), (v, 50.0)):
        with pytest.raises(ValueError, match="under a spring"):
            dataset.microslip.at(*place)


def test_the_solver_is_asked_for_the_drive_of_the_dataset(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    settings = {"stiffness": 0.5, "mass": 0.0}
    spring = made_up().assign_attrs(SPRING).assign_coords(settings)
    answer = spring.microslip.at(0.3, 50.0, tolerance=1e-2)
    truth = microslip.solve("transverse", 0.3, 50.0, tolerance=1e-2, **settings)
    assert SOURCES[int(answer.source)] == "solver"
    assert float(answer.mu_macro) == truth.mu_macro
    with pytest.raises(InputError, match="mass"):
        spring.drop_vars("mass").microslip.at(0.3, 50.0, tolerance=1e-2)


def test_a_force_is_friction_and_no_map_of_it():
    with pytest.raises(ValueError, match="over a prescribed force"):
        made_up().assign_attrs(drive="force").microslip.at(0.1, 1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((-1, 1), "velocity = -1"),
        ((1, -0.1), "amplitude = -0.1"),
        ((np.nan, 1), "velocity = nan"),
        (("fast", 1), "velocity = 'fast'"),
        ((1,), "amplitude = None"),
        (([[1.0]], 1), "velocity = "),
    ],
)
def test_bad_points_are_refused_by_name(friction, arguments, message):
    with pytest.raises(ValueError, match=message):
        friction.at(*arguments)


def test_another_dataset_has_no_friction():
    with pytest.raises(ValueError, match="no motion"):
        xr.Dataset().friction  # noqa: B018


# Beyond the map


@pytest.mark.parametrize("motion", ["transverse", "bore"])
@pytest.mark.parametrize(
    ("velocity", "amplitude", "side"),
    [
        (0.1, 3.0, "large amplitude"),
        (0.1, 0.25, "no vibration"),
        (1e-3, 1.5, "static limit"),
        (10.0, 1.5, "fast sliding"),
    ],
)
def test_the_error_does_not_jump_at_the_edge_of_a_map(motion, velocity, amplitude, side):
    data = made_up(amplitude=AMPLITUDE[1:], error=1e-3, motion=motion)
    edge = data.microslip.at(velocity, amplitude)
    for step in (1e-6, 1e-3):
        out = {"large amplitude": 1 + step, "no vibration": 1 - step}.get(side, 1.0)
        along = {"fast sliding": 1 + step, "static limit": 1 - step}.get(side, 1.0)
        answer = data.microslip.at(velocity * along, amplitude * out)
        assert side in SOURCES[int(answer.source)]
        # The error changes by at most four times the relative step, from the power laws.
        assert float(answer.mu_macro_error - edge.mu_macro_error) <= 5 * step


def test_a_wide_error_outside_the_map_names_the_remedy():
    data = made_up(error=1e-3, tolerance=2e-3)
    assert "note" not in data.microslip.at([0.1, 1.0], 1.0).attrs
    answer = data.microslip.at([0.1, 1.0], 20.0)
    largest = float(answer.mu_macro_error.max())
    assert answer.attrs["note"].startswith("2 of 2 points outside the tabulated range")
    assert f"up to {largest:.2g}: microslip.at(..., tolerance=1e-3)" in answer.attrs["note"]


@pytest.mark.long
@pytest.mark.parametrize("motion", ["transverse", "bore"])
def test_brackets_hold_what_the_solver_says(tmp_path, motion):
    # The solver computes a small map, so that most points lie outside it.
    amplitude = np.linspace(0.5, 2.0, 4)
    velocity = np.geomspace(0.05, 2.0, 5)
    rows = [[microslip.solve(motion, v, a, tolerance=5e-3) for v in velocity] for a in amplitude]
    dataset = made_up(velocity, amplitude, motion=motion)
    for name in ("mu_macro", "mu_macro_error"):
        dataset[name].values[:] = [[getattr(r, name) for r in row] for row in rows]
    places = {
        "between static limit and map": [(0.01, 1.0), (0.001, 0.6), (0.03, 2.0), (0.049, 1.0)],
        "between map and fast sliding": [(3.0, 1.0), (20.0, 2.0), (5.0, 0.3), (2.1, 1.0)],
        "between map and large amplitude": [(0.2, 6.0), (1.0, 3.0), (0.06, 2.5), (3.0, 20.0)]
        + [(0.2, 2.1), (0.6, 2.3)],
        "between map and no vibration": [(0.1, 0.2), (1.0, 0.4), (0.3, 0.48), (1.0, 0.07)],
    }
    for source, points in places.items():
        for v, a in points:
            answer = dataset.microslip.at(v, a)
            truth = microslip.solve(motion, v, a, tolerance=5e-3)
            off = abs(float(answer.mu_macro) - truth.mu_macro)
            assert off <= float(answer.mu_macro_error) + truth.mu_macro_error, (v, a)
            if not (v > 2.0 and a > 2.0):
                assert SOURCES[int(answer.source)] == source
            assert float(answer.mu_macro_error) < 0.5


def test_no_error_is_larger_than_the_energy_balance_allows():
    v, a = places(300, decades=(-1, 3), amplitude=(0.1, 100))
    answer = made_up(error=0.01).microslip.at(v, a)
    drop = 1 / ((v / a) ** 2 + 0.5)
    assert (answer.mu_macro_error <= np.minimum(drop, 1.0) + 1e-9).all()
    assert (answer.mu_macro >= 1 - drop - 1e-9).all()


def test_the_steady_bore_is_a_closed_form_beyond_its_axis():
    velocity = np.geomspace(0.1, 10, 9)
    dataset = xr.Dataset(
        {
            "mu_macro": ("velocity", paper.bore_forward(velocity)),
            "mu_macro_error": ("velocity", np.full(9, 1e-4)),
            "converged": ("velocity", np.ones(9, bool)),
        },
        {"velocity": velocity, "poisson": 0.0},
        {"motion": "continuous-bore"},
    )
    for v, source in ((0.0, "closed form"), (0.5, "map"), (40.0, "closed form")):
        answer = dataset.microslip.at(v)
        assert abs(float(answer.mu_macro) - paper.bore_forward(v)) <= answer.mu_macro_error
        assert SOURCES[int(answer.source)] == source
    with pytest.raises(ValueError, match="amplitude = 1"):
        dataset.microslip.at(0.5, 1)


# Files


@pytest.fixture
def results(tmp_path):
    made = made_up(error=1e-4)
    made["converged"] = made.converged.astype(np.int8)
    netcdf.write(tmp_path / "transverse.nc", made)
    return tmp_path


def test_open_map_is_plain_xarray(results):
    result = open_map("transverse", results, chunks={})
    assert result.mu_macro.chunks is not None
    row = result.mu_macro.sel(amplitude=1.5)
    assert float(row.interp(velocity=0.1)) == pytest.approx(
        float(result.microslip.at(0.1, 1.5).mu_macro), abs=0.02
    )


def test_a_tolerance_asks_the_solver(results):
    result = open_map("transverse", results)
    plain = result.microslip.at(0.0123, 0.777)
    exact = result.microslip.at(0.0123, 0.777, tolerance=1e-3)
    assert float(plain.mu_macro_error) > 1e-3 >= float(exact.mu_macro_error)
    assert SOURCES[int(exact.source)] == "solver"
    truth = microslip.solve("transverse", 0.0123, 0.777)
    assert float(exact.mu_macro) == truth.mu_macro


def test_what_cannot_be_opened_is_one_line(results, tmp_path):
    with pytest.raises(ValueError, match="name = 'tranverse': did you mean transverse"):
        open_map("tranverse", results)
    with pytest.raises(CacheError, match="bore.nc is not there"):
        open_map("bore", results)
    with pytest.raises(CacheError, match="snakemake certified"):
        open_map("certified_bore", results)
    path = results / "transverse.nc"
    stamps.write(results / stamps.stamp_of("transverse"), "f00d", [path])
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
    made_up().to_netcdf(tmp_path / "small.nc")
    with open_map(tmp_path / "small.nc") as data:
        assert data.mu_macro.shape == (13, 13)
