"""Configurations: defaults, axes, numbers of YAML 1.2, files, and the reference of all keys."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from bad_input_tables.bad_configurations import GOOD
from stubs.sweep_stub import configured

from microslip.config import load as config
from microslip.config.load import ConfigError, load
from microslip.config.settings import Sweep
from microslip.scene.by_name import pressure_named
from microslip.sweeps import request

ROOT = Path(__file__).parents[2]
SHIPPED = sorted((ROOT / "config").glob("*.yaml"))


def saved(folder, text):
    path = folder / "sweep.yaml"
    path.write_text(text)
    return path


def test_a_byte_order_mark_and_line_ends_of_windows_do_no_harm(tmp_path):
    plain = load(saved(tmp_path, GOOD))
    path = tmp_path / "windows.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load(path) == plain


def test_mappings_are_merged_as_yaml_says(tmp_path):
    """Keys beside << replace merged keys, also in a mapping that is merged again."""
    slow = "slow: &slow {motion: bore, velocity: [0.1, 1], amplitude: [0, 1], poisson: 0.3}"
    text = f"sweeps:\n  {slow}\n  fast: &fast {{<<: *slow, velocity: 2}}\n"
    result = load(saved(tmp_path, text + "  again: {<<: *fast, velocity: 3}\n")).sweeps
    assert [sweep.velocity[-1] for sweep in result.values()] == [1.0, 2.0, 3.0]
    assert result["again"].amplitude == (0.0, 1.0)
    assert result["again"].poisson == (0.3,)


@pytest.mark.parametrize(
    ("axis", "values"),
    [
        ("1", (1.0,)),
        ("[1, 0.30000000000000004, 0.1]", (0.1, 0.3, 1.0)),
        ("{log: [1, 10, 4]}", (1.0, 2.15443, 4.64159, 10.0)),
        ("[{linear: [0, 1, 3]}, 0.25, 0.5]", (0.0, 0.25, 0.5, 1.0)),
        ("[1e-3, 1E2, +.5, 1., 010]", (0.001, 0.5, 1.0, 10.0, 100.0)),
    ],
)
def test_axes_are_expanded_sorted_and_numbers_are_those_of_yaml_1_2(axis, values, tmp_path):
    text = f"sweeps: {{a: {{motion: bore, velocity: {axis}, amplitude: 1}}}}\n"
    path = saved(tmp_path, text)
    assert load(path).sweeps["a"].velocity == values
    # Snakemake reads the file as YAML 1.1.
    snakemake = yaml.safe_load(text) | {"points_per_job": 7}
    again = config.from_mapping(config.reread(snakemake, [path]))
    assert (again.sweeps["a"].velocity, again.points_per_job) == (values, 7)


def test_one_value_is_a_coordinate_and_several_are_a_dimension():
    axes = {"motion": "bore", "stiffness": [1, 2], "mass": 3, "velocity": [1, 2], "amplitude": 1}
    sweep = Sweep(**axes)
    assert list(sweep.axes) == ["mass", "stiffness", "poisson", "amplitude", "velocity"]
    assert sweep.dims == ("stiffness", "velocity")
    assert sweep.drives == {"mass": (3.0,), "stiffness": (1.0, 2.0)}
    forces = Sweep(motion="bore", force=[0.1, 0.5], amplitude=[1, 2], poisson=[0.3, 0])
    assert forces.dims == ("poisson", "amplitude", "force")


@pytest.mark.slow
@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_configurations_are_good_and_jobs_read_the_same(path):
    result = load(path)
    handed = config.with_paths(config.read_yaml(path), [path.parent])
    assert config.from_mapping(json.loads(json.dumps(handed))) == result
    assert len({load(other).results for other in SHIPPED}) == len(SHIPPED)


def test_the_default_configuration_has_the_maps_and_figures_of_the_paper():
    result = load(ROOT / "config" / "config.yaml")
    for name, top in (("transverse", 3.0), ("bore", 5.0)):
        velocity, amplitude = result.sweeps[name].velocity, result.sweeps[name].amplitude
        assert (velocity[0], velocity[-1], len(velocity)) == (1e-3, 10.0, 25)
        assert (amplitude[0], amplitude[-1], len(amplitude)) == (0.0, top, 25)
    assert [name[:4] for name in result.figures] == [f"fig{i}" for i in range(1, 7)]


def test_the_tables_of_all_keys_are_those_of_the_models(tmp_path):
    """config/README.md contains the output of docs/make_configuration_tables.py."""
    copy = tmp_path / "README.md"
    shutil.copy(ROOT / "config" / "README.md", copy)
    subprocess.run(
        [sys.executable, ROOT / "docs" / "make_configuration_tables.py", copy], check=True
    )
    assert copy.read_text() == (ROOT / "config" / "README.md").read_text()


# Files


def with_pressure(folder, name):
    pad = {"motion": "transverse", "velocity": 20, "amplitude": 0.1, "pressure": name}
    return saved(folder, yaml.safe_dump({"sweeps": {"pad": pad}}))


EVEN = "forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n"


def test_files_of_a_configuration_are_looked_for_beside_it_then_here(tmp_path, monkeypatch):
    beside, here = tmp_path / "beside", tmp_path / "here"
    for folder, pressure in ((beside, 1), (here, 2)):
        folder.mkdir()
        (folder / "pad.csv").write_text(f"# {pressure}\n{EVEN}")
    monkeypatch.chdir(here)
    path = with_pressure(beside, "file:pad.csv")
    first = load(path).sweeps["pad"].pressure
    assert first == pressure_named(f"file:{beside / 'pad.csv'}").name
    (beside / "pad.csv").unlink()
    assert load(path).sweeps["pad"].pressure == pressure_named("file:pad.csv").name != first
    (here / "pad.csv").unlink()
    with pytest.raises(ConfigError) as refused:
        load(path)
    message = str(refused.value)
    assert message.startswith(f"{path}: sweeps.pad.pressure: 'file:pad.csv': pad.csv cannot be")
    assert f"No such file; looked for {beside / 'pad.csv'}, {here / 'pad.csv'}" in message


def test_a_request_names_a_file_by_its_content_and_jobs_find_it(tmp_path, monkeypatch):
    """Relative paths, absolute paths and links to one file give equal requests."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "pad.csv").write_text(EVEN)
    (tmp_path / "sub" / "link.csv").symlink_to(tmp_path / "pad.csv")
    found = []
    for folder, name in (
        (tmp_path, "file:pad.csv"),
        (tmp_path, "file:./sub/../pad.csv"),
        (tmp_path / "sub", "file:link.csv"),
        (tmp_path / "sub", f"file:{tmp_path / 'pad.csv'},grid=cells"),
    ):
        found.append(request.points_of(load(with_pressure(folder, name)).sweeps["pad"]).requests)
    assert all(requests == found[0] for requests in found)
    assert found[0][0]["pressure"].startswith("file:sha256=")
    # A job runs in another folder and process.
    handed = config.with_paths(
        config.read_yaml(with_pressure(tmp_path, "file:pad.csv")), [tmp_path]
    )
    monkeypatch.setattr("microslip.foundation.named_files.PLACES", {})
    monkeypatch.chdir(tmp_path / "sub")
    result = config.from_mapping(handed)
    assert request.points_of(result.sweeps["pad"]).requests == found[0]
    assert config.with_paths(handed) == handed


def test_equal_motions_are_asked_for_alike():
    axes = {"velocity": 1, "amplitude": 1}
    names = ("elliptic", "elliptic:phase=90", "elliptic:phase=90.0")
    sweeps = configured({f"m{i}": axes | {"motion": name} for i, name in enumerate(names)}).sweeps
    requests = [request.points_of(sweep).requests for sweep in sweeps.values()]
    assert requests[0] == requests[1] == requests[2]
    assert not {"pressure", "stiffness", "force", "method"} & requests[0][0].keys()
