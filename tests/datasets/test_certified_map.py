"""Certified maps over velocity, amplitude and Poisson's ratio, and of the static limit."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from stubs import certified_stub
from stubs.eq6_map import places

from microslip.datasets import certified_map, netcdf
from microslip.datasets.interpolation import CHECKSUMS, COORDINATES
from microslip.foundation.errors import InputError
from microslip.theory import paper

AXES = ("velocity", "amplitude", "poisson")
PLAIN = {"velocity": [0.001, 10], "amplitude": [0, 3], "error": 1e-2}
STATIC = {"velocity": [0], "amplitude": [0, 1.5], "error": 2e-3}
MAPS = {
    "plain": PLAIN,
    "poisson": PLAIN | {"velocity": [0.01, 10], "poisson": [0, 0.4], "error": 3e-2},
    "static": STATIC,
    "static poisson": STATIC | {"poisson": [0, 0.5]},
}


def friction(velocity, amplitude, poisson):
    """The static limit, and an invented friction: Eq 6 with the power 1.5 of the amplitude.  Both
    depend on Poisson's ratio."""
    moving = paper.large_amplitude_transverse(np.maximum(velocity, 1e-9), amplitude**1.5)
    static = paper.static_limit_transverse(amplitude) * (1.0 - 0.1 * poisson**2)
    return np.where(velocity > 0, 1.0 - (1.0 - moving) * (1.0 - poisson**2), static)


def record(request):
    place = (np.array(float(request[name])) for name in AXES)
    error = 1e-5 if request["velocity"] == "0" else 1e-4
    return certified_stub.record(request, float(friction(*place)), error)


def made_of(name):
    """A certified map and the records of its points."""
    map_ = certified_stub.configured("transverse", **MAPS[name])
    return SimpleNamespace(map=map_, records=certified_stub.played(map_, record))


def reopened(made, folder):
    return certified_stub.reopened(certified_map.build(made.map, "map", made.records)[0], folder)


@pytest.fixture(scope="module")
def made():
    return made_of("plain")


@pytest.fixture(scope="module")
def dataset(made, tmp_path_factory):
    """The dataset of `made`, read from a file."""
    return reopened(made, tmp_path_factory.mktemp("certified"))


@pytest.mark.parametrize("name", MAPS)
def test_answers_are_within_their_errors_and_these_within_what_was_asked(name, tmp_path):
    data, settings, count = reopened(made_of(name), tmp_path), MAPS[name], 5000
    directions = [axis for axis in AXES if len(settings.get(axis, ())) > 1]
    decades = np.log10(settings["velocity"]) if len(settings["velocity"]) > 1 else (0, 0)
    velocity, amplitude = places(count, decades, settings["amplitude"])
    velocity = velocity if "velocity" in directions else 0.0 * velocity
    poisson = places(count, amplitude=settings.get("poisson", (0, 0)), seed=2)[1]
    more = {"poisson": poisson} if "poisson" in settings else {}
    answer = data.microslip.at(velocity, amplitude, **more)
    miss = abs(answer.mu_macro - friction(velocity.values, amplitude.values, poisson.values))
    assert float((miss <= answer.mu_macro_error).mean()) >= 0.999
    assert float(answer.mu_macro_error.max()) <= settings["error"]
    assert data.directions == " ".join(directions)
    assert data.sizes["point"] == len(np.unique(data.cell_node))
    solved = [np.broadcast_to(data[axis], data.sizes["point"]) for axis in AXES]
    assert data.points == len(set(zip(*solved, strict=True)))
    assert data.points < 50 or name != "static"


def test_points_of_a_cell_are_listed_with_the_last_direction_fastest(tmp_path):
    data = reopened(made_of("static poisson"), tmp_path)
    assert data.degrees.tolist() == [4, 2] and data.sizes["node"] == 5 * 3
    poisson = data.poisson.values[data.cell_node.values[:, :3]]
    assert (np.diff(poisson) > 0.0).all()
    assert set(np.unique(data.poisson)) >= {0.0, 0.25, 0.5}
    assert (data.cell_poisson_low < data.cell_poisson_high).all()
    with pytest.raises(InputError, match="velocity = 0.1: allowed is 0"):
        data.microslip.at(0.1, 0.5, poisson=0.1)


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
    lost = data.mu_macro.isnull().values[data.cell_node.values].any(axis=1)
    assert message[1] == f"  {lost.sum()} of {lost.size} cells are not within 0.01"


BACK, FEW, REST = slice(None, None, -1), slice(9), slice(9, None)
KEPT = {
    "sorted": lambda c: c.sortby("mu_macro").sortby("cell_error"),
    "reversed": lambda c: c.isel(point=BACK, cell=BACK, node=BACK).transpose("node", ...),
    "chunked": lambda c: c.chunk(point=9),
    "single precision": lambda c: c.astype("f4"),
    "fewer variables": lambda c: c.drop_vars(["mu_macro_error", "velocity", "amplitude"]),
    "more variables": lambda c: c.assign(half=c.mu_macro / 2).assign_attrs(note="own"),
    "joined": lambda c: xr.concat([c.isel(cell=REST), c.isel(cell=FEW)], "cell", "minimal"),
    "other dimensions": lambda c: c.expand_dims("run").swap_dims(point="velocity"),
}
"""Changes of a dataset after which the map is still whole."""
REFUSED = {
    "rolled points": (lambda c: c.roll(point=1), "mu_macro"),
    "rolled nodes": (lambda c: c.roll(node=1), "cell_node"),
    "joined": (lambda c: xr.concat([c.head(node=9), c.tail(node=16)], "node", "all"), "mu_macro"),
    "less error": (lambda c: c.assign(cell_error=0.1 * c.cell_error), "cell_error"),
    "other ratio": (lambda c: c.assign_coords(poisson=0.3), "poisson"),
    "other range": (lambda c: c.assign_attrs({COORDINATES: "[]"}), COORDINATES),
    "strings": (lambda c: c.astype(str), "mu_macro"),
    "few points": (lambda c: c.isel(point=slice(20)), "point"),
    "no border": (lambda c: c.drop_vars("cell_low"), "cell_low"),
    "no attributes": (lambda c: c.drop_attrs(), CHECKSUMS),
}
"""Changes of a dataset after which the map is not whole, and the part that the message names."""


@pytest.mark.parametrize("change", KEPT)
def test_a_whole_map_answers_in_any_form(dataset, change):
    answer = KEPT[change](dataset).microslip.at(0.1, 1.0)
    xr.testing.assert_allclose(answer, dataset.microslip.at(0.1, 1.0), rtol=1e-6)


@pytest.mark.parametrize("change", REFUSED)
def test_a_map_that_is_not_whole_is_refused_by_the_part_that_has_changed(dataset, change):
    changed, part = REFUSED[change]
    with pytest.raises(InputError, match="allowed is the computed map") as caught:
        changed(dataset).microslip.at(0.1, 1.0)
    assert caught.value.argument == part
