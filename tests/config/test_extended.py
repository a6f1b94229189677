"""Sweeps of other motions and pressures: configuration, requests, files and datasets."""

import json

import pytest
import xarray as xr
from stubs.sweep_stub import Solver

import microslip
from microslip.config import load
from microslip.config import records as settings
from microslip.datasets import sweep_dataset
from microslip.motions.by_name import motion_named
from microslip.pressures.by_name import pressure_named
from microslip.studies import registry
from microslip.sweeps import batches as sweep
from microslip.sweeps.store import Store
from microslip.theory import masing, paper

PAPER = {"bore": {"velocity": [1], "amplitude": [1]}}
CIRCLE = {"motion": "elliptic", "group": "loops", "velocity": [0.1, 1], "amplitude": [0, 1]}


def configured(**sweeps):
    return load.from_mapping({"sweeps": PAPER, "extended": sweeps})


POWER = "power:exponent=1"


# Configuration


def test_defaults_are_those_of_other_sweeps():
    result = configured(circle=CIRCLE)
    sweep = result.extended["circle"]
    assert (sweep.pressure, sweep.group, sweep.title) == ("hertz", "loops", "circle")
    assert (sweep.model, sweep.tolerance, sweep.poisson) == ("auto", 1e-3, (0.0,))
    assert list(result.grids) == ["bore", "circle"]
    assert result.of_sweep("circle")["histories"] == {}


def test_groups_keep_the_order_of_their_sweeps():
    lines = CIRCLE | {"group": "still", "velocity": [0.1]}
    result = configured(b=CIRCLE, c=lines, a=CIRCLE)
    assert result.groups == {"loops": ("b", "a"), "still": ("c",)}
    assert result.extended["c"].drawn_over == "amplitude"


def test_a_steady_motion_has_no_amplitude():
    steady = {"motion": "continuous-bore", "group": "steady", "velocity": [0.1, 1]}
    (sweep,) = configured(spin=steady).extended.values()
    assert (sweep.amplitude, sweep.drawn_over) == (None, "velocity")


def test_names_of_other_results_are_taken():
    assert {*registry.DATASETS, *registry.DATASETS.values()} <= set(settings.RESERVED)
    for name in ("transverse", "claims", "bore_histories"):
        with pytest.raises(load.ConfigError, match=f"extended.{name}: another result has this"):
            configured(**{name: CIRCLE})
    assert configured(claims_first=CIRCLE).extended.keys() == {"claims_first"}


def test_a_figure_has_room_for_so_many():
    configured(**{f"a{i}": CIRCLE for i in range(12)})
    with pytest.raises(load.ConfigError, match=r"a12.group: loops has 13 .* allowed: up to 12"):
        configured(**{f"a{i}": CIRCLE for i in range(13)})
    lines = CIRCLE | {"velocity": [0.1]}
    with pytest.raises(load.ConfigError, match="allowed: up to 8"):
        configured(**{f"a{i}": lines for i in range(9)})
    # each Poisson's ratio is drawn
    ratios = CIRCLE | {"poisson": [0, 0.3, 0.5]}
    configured(**{f"a{i}": ratios for i in range(4)})
    with pytest.raises(load.ConfigError, match=r"loops has 15 sweeps at their Poisson's .* 12"):
        configured(**{f"a{i}": ratios for i in range(5)})


def test_jobs_do_not_ask_the_solver():
    mapping = {"sweeps": PAPER, "extended": {"circle": CIRCLE | {"motion": "no such"}}}
    result = load.from_mapping(mapping, ask_solver=False)
    assert result.extended["circle"].motion == "no such"


# Requests


def requests_of(**changes):
    return sweep.points_of(configured(circle=CIRCLE | changes).extended["circle"]).requests


def test_a_plain_point_mentions_no_pressure_and_no_drive():
    """The name of a result is the hash of its request."""
    plain = load.from_mapping({"sweeps": {"bore": {"velocity": [1], "amplitude": [1]}}})
    (expected,) = sweep.points_of(plain.sweeps["bore"]).requests
    names = {"kind", "motion", "model", "tolerance", "cells", "steps"}
    assert set(expected) == names | {"poisson", "amplitude", "velocity"}
    assert "drives" not in plain.of_sweep("bore")["sweep"]
    (result,) = requests_of(motion="bore", velocity=[1], amplitude=[1])
    assert result == expected


def test_equal_motions_are_asked_for_alike():
    assert requests_of(motion="elliptic:phase=90,forward=1") == requests_of()
    one, other = (f"elliptic:{n}" for n in ("forward=0.5,phase=30", "phase=30.0,forward=0.50"))
    assert requests_of(motion=one) == requests_of(motion=other) != requests_of()


def test_a_pressure_is_part_of_the_request_and_is_handed_to_the_solver(monkeypatch, tmp_path):
    solver, calls = Solver(monkeypatch), []

    def solve(*place, **arguments):
        calls.append(arguments.get("pressure"))
        return solver.solve(*place, **arguments)

    monkeypatch.setattr("microslip.solve", solve)
    requests = requests_of(pressure="power:exponent=1.0")
    assert {request["pressure"] for request in requests} == {POWER}
    sweep.run_batch(requests, Store(tmp_path))
    sweep.run_batch(requests_of(), Store(tmp_path))
    assert calls == 4 * [POWER] + 4 * [None]
    assert sweep.label(requests[0]).startswith("elliptic at pressure power:exponent=1, poisson 0")


EVEN = "forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n"


def with_pressure(folder, pressure):
    """Write a configuration with one sweep under a pressure to a folder."""
    path = folder / "mine.yaml"
    sweep = CIRCLE | {"motion": "transverse", "pressure": pressure}
    path.write_text(json.dumps({"sweeps": PAPER, "extended": {"pad": sweep}}))
    return path


def test_files_of_a_configuration_are_looked_for_beside_it_then_here(tmp_path, monkeypatch):
    beside, here = tmp_path / "beside", tmp_path / "here"
    for folder, pressure in ((beside, 1), (here, 2)):
        folder.mkdir()
        (folder / "pad.csv").write_text(f"# {pressure}\n{EVEN}")
    monkeypatch.chdir(here)
    path = with_pressure(beside, "file:pad.csv")

    def digest(result):
        return result.extended["pad"].pressure

    first = digest(load.load(path))
    assert first == pressure_named(f"file:{beside / 'pad.csv'}").name
    (beside / "pad.csv").unlink()
    assert digest(load.load(path)) == pressure_named("file:pad.csv").name != first
    (here / "pad.csv").unlink()
    with pytest.raises(load.ConfigError) as refused:
        load.load(path)
    message = str(refused.value)
    assert message.startswith(
        f"{path}: extended.pad.pressure: 'file:pad.csv': pad.csv cannot be read"
    )
    assert f"No such file; looked for {beside / 'pad.csv'}, {here / 'pad.csv'}" in message
    # A job for other sweeps does not need the file.
    mapping = load.read_yaml(path)
    assert load.from_mapping(mapping, ask_solver=False).extended["pad"].name == "pad"


def test_a_request_names_a_file_by_its_content_and_jobs_find_it(tmp_path, monkeypatch):
    """Relative paths, absolute paths and links to one file give equal requests."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "pad.csv").write_text(EVEN)
    (tmp_path / "sub" / "link.csv").symlink_to(tmp_path / "pad.csv")
    batches = []
    for folder, name in (
        (tmp_path, "file:pad.csv"),
        (tmp_path, "file:./sub/../pad.csv"),
        (tmp_path / "sub", "file:link.csv"),
        (tmp_path / "sub", f"file:{tmp_path / 'pad.csv'},grid=cells"),
    ):
        result = load.load(with_pressure(folder, name))
        batches.append(sweep.points_of(result.extended["pad"]).requests)
        assert str(tmp_path) not in json.dumps(result.of_sweep("pad"))
    assert all(requests == batches[0] for requests in batches)
    assert batches[0][0]["pressure"].startswith("file:sha256=")
    # A job runs in another folder and process.
    mapping = load.read_yaml(with_pressure(tmp_path, "file:pad.csv"))
    handed = load.with_defaults_and_paths(mapping, folders=[tmp_path])
    monkeypatch.setattr("microslip.foundation.named_files.PLACES", {})
    monkeypatch.chdir(tmp_path / "sub")
    result = load.from_mapping(handed, ask_solver=False)
    assert sweep.points_of(result.extended["pad"]).requests == batches[0]
    assert load.with_defaults_and_paths(handed) == handed


def test_a_file_of_a_motion_is_handed_on_like_that_of_a_pressure(tmp_path, monkeypatch):
    """Sweeps name it by its content, and jobs find it."""
    (tmp_path / "stroke.csv").write_text("forward,lateral\n0,1\n1,0\n-0.5,-1\n-0.5,0\n")
    mapping = {
        "sweeps": PAPER,
        "extended": {"stroke": CIRCLE | {"motion": "file:stroke.csv"}},
    }
    result = load.from_mapping(mapping, folders=[tmp_path])
    name = motion_named(f"file:{tmp_path / 'stroke.csv'}").name
    requests = sweep.points_of(result.extended["stroke"]).requests
    assert {request["motion"] for request in requests} == {name}
    handed = load.with_defaults_and_paths(mapping, folders=[tmp_path])
    monkeypatch.setattr("microslip.foundation.named_files.PLACES", {})
    monkeypatch.chdir("/")
    load.remember_files(handed)
    assert motion_named(name).name == name
    assert load.from_mapping(handed).extended == result.extended
    with pytest.raises(load.ConfigError, match=r"extended.stroke.motion: .* cannot be read: No"):
        load.from_mapping(mapping)


def test_a_dataset_says_what_its_file_is_called(monkeypatch, tmp_path):
    Solver(monkeypatch)
    (tmp_path / "pad.csv").write_text(EVEN)
    grid = load.load(with_pressure(tmp_path, "file:pad.csv")).extended["pad"]
    store, path = Store(tmp_path / "results"), tmp_path / "pad.nc"
    records = [sweep.answer(request, store)[0] for request in sweep.points_of(grid).requests]
    sweep_dataset.write_sweep(path, grid, records, [], {})
    with xr.open_dataset(path) as data:
        assert data.attrs["pressure"] == grid.pressure
        assert data.attrs["pressure_file"] == "pad.csv"


def test_a_dataset_of_a_file_is_read_without_the_file(monkeypatch, tmp_path):
    Solver(monkeypatch)
    (tmp_path / "stroke.csv").write_text("lateral\n0\n1\n0\n-1\n")
    motion = f"file:{tmp_path / 'stroke.csv'}"
    data = built(tmp_path, "stroke", motion=motion, amplitude=[0.5, 1])
    assert data.attrs["motion_file"] == "stroke.csv"
    monkeypatch.setattr("microslip.foundation.named_files.PLACES", {})
    place = {"velocity": 0.1, "amplitude": 0.5}
    answer = data.microslip.at(**place)
    assert float(answer.mu_macro) == pytest.approx(float(data.mu_macro.sel(**place)))


# Datasets


def built(folder, name="circle", **changes):
    configuration = configured(**{name: CIRCLE | changes})
    grid, store = configuration.grids[name], Store(folder)
    points = (sweep.answer(request, store)[0] for request in sweep.points_of(grid).requests)
    path = folder / f"{name}.nc"
    sweep_dataset.write_sweep(path, grid, points, [], configuration.of_sweep(name))
    with xr.open_dataset(path) as data:
        return data.load()


def test_a_dataset_says_what_it_is_of(monkeypatch, tmp_path):
    Solver(monkeypatch)
    data = built(tmp_path, motion="elliptic:phase=90.0", title="a circle")
    assert data.mu_macro.dims == ("amplitude", "velocity")
    attributes = {key: data.attrs[key] for key in ("motion", "pressure", "title", "group")}
    assert attributes == {
        "motion": "elliptic",
        "pressure": "hertz",
        "title": "a circle",
        "group": "loops",
    }
    motion = motion_named("elliptic")
    assert data.velocity.formula == motion.velocity_label
    assert data.amplitude.long_name == f"amplitude, {motion.amplitude_label}"
    assert not [name for name in data if "static" in name]
    assert list(sweep_dataset.report(data, "circle")) == ["circle: 4 points, all converged"]
    for variable in data.variables.values():
        assert variable.attrs["long_name"]


def test_limits_stand_beside_the_points_of_motions_that_have_some(monkeypatch, tmp_path):
    Solver(monkeypatch)
    data = built(tmp_path, "along", motion="longitudinal", amplitude=[0, 0.5, 1])
    a = data.amplitude.values
    assert data.mu_static.values == pytest.approx(paper.static_limit_longitudinal(a))
    assert float(data.mu_closed_form.sel(velocity=0.1, amplitude=0.5)) == pytest.approx(
        float(masing.longitudinal(0.1, 0.5))
    )


# Static friction


def test_static_friction_is_interpolated_along_the_amplitude(monkeypatch, tmp_path):
    Solver(monkeypatch)
    line = {"motion": "elliptic:phase=0", "velocity": [0, 0.1], "amplitude": [0, 0.5, 1, 1.5]}
    built(tmp_path, **line)
    friction = microslip.open_map("circle", tmp_path).microslip
    assert float(friction.at(0, 0.7).mu_macro) == 0
    assert float(friction.at(0.1, 0.5).mu_macro) == pytest.approx(0.1 / 1.6)
