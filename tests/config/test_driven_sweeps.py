"""The key `drives`: sweeps under a force or a spring, from the configuration to the dataset."""

import numpy as np
import pytest
import xarray as xr

import microslip
from microslip.config import load
from microslip.datasets import sweep_dataset
from microslip.sweeps import batches
from microslip.sweeps.store import Store

PAPER = {"transverse": {"velocity": [1], "amplitude": [1]}}
WEIGHTS = {"motion": "transverse", "amplitude": [0.5, 1], "force": [0.2, 0.6, 1.0]}
SPRINGS = {"motion": "transverse", "amplitude": [1], "velocity": [0.1, 0.5], "stiffness": [0.1, 10]}


def configured(**drives):
    return load.from_mapping({"sweeps": PAPER, "drives": drives})


def test_axes_and_numbers_become_requests_in_the_order_of_the_dataset():
    sweep = configured(springs=SPRINGS | {"mass": 2}).drives["springs"]
    requests = batches.points_of(sweep).requests
    places = [(r["stiffness"], r["velocity"]) for r in requests]
    assert places == [("0.1", "0.1"), ("0.1", "0.5"), ("10", "0.1"), ("10", "0.5")]
    assert {r["mass"] for r in requests} == {"2"}
    assert not any("force" in r or "damping" in r for r in requests)


def test_a_force_stands_in_the_place_of_the_velocity():
    requests = batches.points_of(configured(weights=WEIGHTS).drives["weights"]).requests
    assert [(r["amplitude"], r["force"], r["velocity"]) for r in requests][2:4] == [
        ("0.5", "1", None),
        ("1", "0.2", None),
    ]


BAD = [
    ({"motion": "transverse", "amplitude": [1], "velocity": [1]}, "required: force or stiffness"),
    (WEIGHTS | {"velocity": [1]}, "force: 0.2: allowed is a force or a velocity, not both"),
    (WEIGHTS | {"stiffness": 1}, "stiffness: 1.0: allowed is none beside a force"),
    (
        SPRINGS | {"stiffness": [0, 1]},
        "stiffness: 0.0: allowed is a finite number of at least 1e-09",
    ),
    (SPRINGS | {"stiffness": [1, 1]}, "stiffness: 1 occurs twice"),
    (SPRINGS | {"mass": -1}, "mass: -1 is not allowed"),
    (SPRINGS | {"mass": "heavy"}, "mass: "),
    (SPRINGS | {"model": "rigid"}, "model: 'rigid': supports no stiffness"),
    (SPRINGS | {"group": "g"}, "group"),
    ({"motion": "transverse", "amplitude": [1], "stiffness": 1}, "velocity: None: needed;"),
    (
        SPRINGS | {"motion": "longitudinal", "velocity": [0, 1]},
        "velocity: 0.0: allowed is a number",
    ),
    ({"motion": "transverse", "force": [0.1]}, "amplitude: missing"),
]


@pytest.mark.parametrize(("settings", "message"), BAD, ids=[message for _, message in BAD])
def test_what_does_not_go_together_is_refused_in_a_line(settings, message):
    with pytest.raises(load.ConfigError) as refused:
        configured(bad=settings)
    line = str(refused.value)
    assert line.startswith("configuration: drives.bad") and "\n" not in line
    assert message in line


def test_a_name_is_taken_once():
    extended = {"line": {"motion": "longitudinal", "group": "g", "velocity": [1], "amplitude": [1]}}
    settings = {"sweeps": PAPER, "extended": extended, "drives": {"line": SPRINGS}}
    with pytest.raises(load.ConfigError, match="drives.line: another result has this name"):
        load.from_mapping(settings)


def written(tmp_path, name, settings):
    configuration = configured(**{name: settings | {"tolerance": 1e-2}})
    sweep, store = configuration.drives[name], Store(tmp_path / "results")
    records = [batches.answer(r, store)[0] for r in batches.points_of(sweep).requests]
    path = tmp_path / f"{name}.nc"
    sweep_dataset.write_sweep(path, sweep, records, [], configuration.of_sweep(name))
    return path


def test_a_dataset_under_forces_holds_velocities(tmp_path):
    with xr.open_dataset(written(tmp_path, "weights", WEIGHTS | {"amplitude": [0.5]})) as data:
        assert data.velocity.dims == data.mu_macro.dims == ("amplitude", "force")
        assert data.drive == "force"
        point = data.sel(amplitude=0.5, force=0.6)
        answer = microslip.solve("transverse", amplitude=0.5, force=0.6, tolerance=1e-2)
        assert float(point.velocity) == answer.velocity > 0.0
        assert float(point.velocity_error) == answer.velocity_error
        assert float(point.mu_macro) == 0.6
        # the limits over the amplitude are in the dataset, those over a velocity are not
        assert float(point.mu_static) > 0.5 and "mu_slider" not in data
        assert float(data.velocity.sel(amplitude=0.5, force=0.2)) == 0.0
        away = data.sel(force=1.0)
        assert not away.converged.any() and away.velocity.isnull().all()
        assert all(text.startswith("runs away") for text in microslip.texts(away.reason).values)
        beside = data.microslip.at(force=0.6, amplitude=0.5)  # beside a contact that runs away
        assert np.isinf(float(beside.velocity_error))


def test_a_dataset_over_springs_has_their_axis(tmp_path):
    with xr.open_dataset(written(tmp_path, "springs", SPRINGS | {"mass": 2})) as data:
        assert data.mu_macro.dims == ("stiffness", "amplitude", "velocity")
        assert float(data.mass) == 2.0 and data.drive == "mass, stiffness"
        point = data.mu_macro.interp(stiffness=10.0, velocity=0.5, amplitude=1.0)
        answer = microslip.solve("transverse", 0.5, 1.0, stiffness=10, mass=2, tolerance=1e-2)
        assert float(point) == pytest.approx(answer.mu_macro, abs=1e-12)
        assert data.stiffness.attrs["formula"] == "k u_lim / (mu F_z)"
