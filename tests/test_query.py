"""Answers from finished maps: within their bounds, wherever they come from."""

import json

import numpy as np
import pytest
import xarray as xr

import microslip
from microslip import theory
from microslip.cache import CacheError
from microslip.query import SOURCES, beyond, open_map
from microslip.query.interpolation import Axis, Table

VELOCITY = np.geomspace(1e-3, 10, 13)
AMPLITUDE = np.linspace(0, 3, 13)


def made_up(velocity=VELOCITY, amplitude=AMPLITUDE, error=0.0, **more):
    """A map of Eq 6 with a stiffer amplitude: smooth, 1 at amplitude 0, rising with velocity."""
    v, a = np.meshgrid(velocity, amplitude)
    mu = theory.large_amplitude_transverse(v, a**1.5)
    dims = ("amplitude", "velocity")
    return xr.Dataset(
        {
            "mu_macro": (dims, mu),
            "mu_macro_error": (dims, np.full(mu.shape, error)),
            "converged": (dims, np.ones(mu.shape, bool)),
        },
        {"velocity": velocity, "amplitude": amplitude, "poisson": 0.0},
        {"scene": "transverse"} | more,
    )


# Interpolation


def test_a_node_is_itself():
    table = Table(Axis(AMPLITUDE), Axis(VELOCITY), made_up().mu_macro.values, np.zeros((13, 13)))
    for i, amplitude in enumerate(AMPLITUDE):
        value, error = table.at(np.full(13, amplitude), VELOCITY)
        assert value == pytest.approx(table.values[i], abs=1e-13)
        assert error == pytest.approx(0.0, abs=1e-13)


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
    assert miss.max() > 5e-3  # the cubic does miss it
    assert (miss <= error + 1e-12).mean() > 0.99


def test_the_bound_falls_with_the_fourth_power_of_the_spacing():
    x = np.array([0.3333])

    def bound(count):
        axis = Axis(np.linspace(0, 1, count))
        values = np.tile(np.sin(3 * axis.values), (3, 1))
        table = Table(Axis(np.arange(3.0)), axis, values, np.zeros(values.shape))
        return float(table._miss[1][1].max()), table.at(np.ones(1), x)

    orders = np.log2([bound(n)[0] / bound(2 * n - 1)[0] for n in (17, 33)])
    assert orders == pytest.approx(4.0, abs=0.4)


def test_axes_find_their_measure():
    assert Axis(np.geomspace(0.01, 10, 7)).logarithmic
    assert not Axis(np.linspace(0.01, 10, 7)).logarithmic
    assert not Axis(np.array([0.0, 0.1, 1.0])).logarithmic


# The accessor


@pytest.fixture
def friction():
    return made_up().friction


def test_the_error_covers_what_is_missed_and_what_the_nodes_are_off():
    rng = np.random.default_rng(3)
    v = xr.DataArray(10 ** rng.uniform(-3, 1, 500), dims="n")
    a = xr.DataArray(rng.uniform(0, 3, 500), dims="n")
    truth = theory.large_amplitude_transverse(v.values, a.values**1.5)
    answer = made_up().friction.at(v, a)
    miss = np.abs(answer.mu_macro.values - truth)
    assert (miss <= answer.mu_macro_error.values + 1e-12).mean() >= 0.99
    fine = made_up(np.geomspace(1e-3, 10, 25), np.linspace(0, 3, 25)).friction.at(v, a)
    assert np.median(fine.mu_macro_error) < 0.1 * np.median(answer.mu_macro_error)
    off = made_up(error=0.01).friction.at(v, a)
    more = off.mu_macro_error.values - answer.mu_macro_error.values
    assert np.median(more) == pytest.approx(0.01)  # less where the energy balance says so
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
    near = dataset.friction.at(v * 1.1, a * 1.05)
    assert np.isnan(near.mu_macro) and np.isinf(near.mu_macro_error)
    far = dataset.friction.at(VELOCITY[2], AMPLITUDE[2])
    assert np.isfinite(far.mu_macro)


def test_poisson_must_be_one_of_the_datasets():
    half = made_up().assign_coords(poisson=0.5)
    both = xr.concat([made_up(), half * 0.5], "poisson", combine_attrs="override")
    both["converged"] = both.converged > 0
    both.attrs["scene"] = "transverse"
    assert float(both.friction.at(0.1, 1, poisson=0.5).mu_macro) == pytest.approx(
        0.5 * float(made_up().friction.at(0.1, 1).mu_macro)
    )
    with pytest.raises(ValueError, match=r"poisson = None: allowed is one of \[0.0, 0.5\]"):
        both.friction.at(0.1, 1)
    with pytest.raises(ValueError, match="velocity = 0.0001: allowed for nu = 0.5"):
        both.friction.at(1e-4, 1, poisson=0.5)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((-1, 1), "velocity = -1"),
        ((1, -0.1), "amplitude = -0.1"),
        ((np.nan, 1), "velocity = nan"),
        (("fast", 1), "velocity = 'fast'"),
        ((1,), "amplitude = None"),
        (([[1.0]], 1), "velocity: "),
    ],
)
def test_bad_points_are_refused_by_name(friction, arguments, message):
    with pytest.raises(ValueError, match=message):
        friction.at(*arguments)


def test_another_dataset_has_no_friction():
    with pytest.raises(ValueError, match="no scene"):
        xr.Dataset().friction  # noqa: B018


# Beyond the map


def test_what_is_known_without_a_map(friction):
    answer = friction.at([0.0, 0.1], [0.0, 0.5])
    assert answer.mu_macro.sel(amplitude=0).values == pytest.approx(1.0, abs=1e-12)
    static = answer.sel(velocity=0, amplitude=0.5)
    assert float(static.mu_macro) == pytest.approx(theory.static_limit_transverse(0.5))
    assert SOURCES[int(static.source)] == "static limit"


@pytest.mark.parametrize("scene", ["transverse", "bore"])
def test_brackets_hold_what_the_solver_says(tmp_path, scene):
    # The map itself is made by the solver, so small that most points lie beyond it.
    amplitude = np.linspace(0.5, 2.0, 4)
    velocity = np.geomspace(0.05, 2.0, 5)
    rows = [[microslip.solve(scene, v, a) for v in velocity] for a in amplitude]
    dataset = made_up(velocity, amplitude, scene=scene)
    for name in ("mu_macro", "mu_macro_error"):
        dataset[name].values[:] = [[getattr(r, name) for r in row] for row in rows]
    places = {
        "between static limit and map": [(0.01, 1.0), (0.001, 0.6), (0.03, 2.0)],
        "between map and fast sliding": [(3.0, 1.0), (20.0, 2.0), (5.0, 0.3)],
        "between map and large amplitude": [(0.2, 6.0), (1.0, 3.0), (0.06, 2.5), (3.0, 20.0)],
        "between map and no vibration": [(0.1, 0.2), (1.0, 0.4)],
    }
    for source, points in places.items():
        for v, a in points:
            answer, truth = dataset.friction.at(v, a), microslip.solve(scene, v, a)
            off = abs(float(answer.mu_macro) - truth.mu_macro)
            assert off <= float(answer.mu_macro_error) + truth.mu_macro_error, (v, a)
            if not (v > 2.0 and a > 2.0):
                assert SOURCES[int(answer.source)] == source
            assert float(answer.mu_macro_error) < 0.5


def test_no_error_is_larger_than_the_energy_balance_allows():
    rng = np.random.default_rng(5)
    v = xr.DataArray(10 ** rng.uniform(-1, 3, 300), dims="n")
    a = xr.DataArray(10 ** rng.uniform(-1, 2, 300), dims="n")
    answer = made_up(error=0.01).friction.at(v, a)
    drop = 1 / ((v / a) ** 2 + 0.5)
    assert (answer.mu_macro_error <= np.minimum(drop, 1.0) + 1e-9).all()
    assert (answer.mu_macro >= 1 - drop - 1e-9).all()


def test_a_bracket_is_never_left():
    value, error = beyond.faster(
        beyond.LIMITS["bore"], *(np.array([x]) for x in (0.999, 1e-4, 50.0, 1.0)), 10.0
    )
    assert 1 - 0.2 / 49**2 <= value[0] <= 1.0
    assert value[0] + error[0] >= 1.0


def test_the_steady_bore_is_a_closed_form_beyond_its_axis():
    velocity = np.geomspace(0.1, 10, 9)
    dataset = xr.Dataset(
        {
            "mu_macro": ("velocity", theory.bore_forward(velocity)),
            "mu_macro_error": ("velocity", np.full(9, 1e-4)),
            "converged": ("velocity", np.ones(9, bool)),
        },
        {"velocity": velocity, "poisson": 0.0},
        {"scene": "continuous-bore"},
    )
    for v, source in ((0.0, "closed form"), (0.5, "map"), (40.0, "closed form")):
        answer = dataset.friction.at(v)
        assert abs(float(answer.mu_macro) - theory.bore_forward(v)) <= answer.mu_macro_error
        assert SOURCES[int(answer.source)] == source
    with pytest.raises(ValueError, match="amplitude = 1"):
        dataset.friction.at(0.5, 1)


# Files


@pytest.fixture
def results(tmp_path):
    from microslip import dataset

    made = made_up(error=1e-4)
    made["converged"] = made.converged.astype(np.int8)
    dataset.write(made, tmp_path / "transverse.nc")
    return tmp_path


def test_open_map_is_plain_xarray(results):
    found = open_map("transverse", results, chunks={})
    assert found.mu_macro.chunks is not None
    row = found.mu_macro.sel(amplitude=1.5)
    assert float(row.interp(velocity=0.1)) == pytest.approx(
        float(found.friction.at(0.1, 1.5).mu_macro), abs=0.02
    )


def test_a_tolerance_asks_the_solver_and_keeps_its_answer(results):
    found = open_map("transverse", results)
    plain = found.friction.at(0.0123, 0.777)
    exact = found.friction.at(0.0123, 0.777, tolerance=1e-3)
    assert float(plain.mu_macro_error) > 1e-3 >= float(exact.mu_macro_error)
    assert SOURCES[int(exact.source)] == "solver"
    truth = microslip.solve("transverse", 0.0123, 0.777)
    assert float(exact.mu_macro) == truth.mu_macro
    (stored,) = results.glob("points/transverse/**/*.json")
    assert json.loads(stored.read_text())["record"]["request"]["velocity"] == "0.0123"


def test_what_cannot_be_opened_is_one_line(results, tmp_path):
    with pytest.raises(ValueError, match="name = 'tranverse': allowed is transverse, bore"):
        open_map("tranverse", results)
    with pytest.raises(CacheError, match="bore.nc is not there"):
        open_map("bore", results)
    path = results / "transverse.nc"
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(CacheError, match="transverse.nc is damaged"):
        open_map("transverse", results)
