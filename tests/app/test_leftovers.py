"""``microslip gc``: finds and removes results that no configuration requests, and nothing else."""

from pathlib import Path

import pytest
import yaml
from stubs.sweep_stub import Solver

from microslip.app import leftovers
from microslip.app.plan import Plan
from microslip.config import load
from microslip.foundation.files import write_atomically
from microslip.sweeps import batches, stamps, store

AXES = {"velocity": [0.5, 2], "amplitude": [0, 1], "tolerance": 1e-2}


def configured(folder, name, **bore):
    """Write a configuration with one small sweep."""
    path = folder / f"{name}.yaml"
    settings = {"results": str(folder / "results"), "sweeps": {"bore": AXES | bore}}
    path.write_text(yaml.safe_dump(settings))
    return path


def made(folder, *products):
    """Write the files and stamps of products."""
    for product in products:
        kind, _, name = product.rpartition("/")
        files = ["figures/{}.png"] if kind else ["{}.nc", "summaries/{}.html"]
        paths = [folder / file.format(name) for file in files]
        for path in paths:
            write_atomically(path, b"content")
        stamps.write(folder / stamps.stamp_of(product), "f00d", paths)


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder with points and batches of two configurations, and a dataset."""
    Solver(monkeypatch)
    folder = tmp_path / "results"
    for name, more in (("first", {}), ("second", {"velocity": [0.5, 3]})):
        plan = Plan(load.load(configured(tmp_path, name, **more)))
        for file, batch in zip(
            plan.batch_files("bore"), plan.batches_in("bore").values(), strict=True
        ):
            records, _ = batches.run_batch(batch.requests, store.Store(folder))
            store.write(folder / file, records)
    made(folder, "bore", "figures/fig6_bore_map", "pendulum")
    (folder / "notes.txt").write_text("mine")
    (folder / "mine.nc").write_bytes(b"without a stamp")
    (folder / "points" / "mine.json").write_text("{}")
    return folder


def names(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.slow
def test_without_delete_nothing_is_removed(results, tmp_path, capsys):
    before = names(results)
    assert leftovers.main(["--configfile", str(tmp_path / "first.yaml"), "--list"]) == 0
    assert names(results) == before
    message = capsys.readouterr().out
    assert "2 points and single runs that no configuration requests" in message
    assert "1 batches that no configuration requests" in message
    assert "3 datasets, pages and figures" in message and "pendulum.nc" in message
    assert "nothing is removed without --delete" in message
    assert "mine" not in message


@pytest.mark.slow
def test_what_no_configuration_asks_for_is_removed(results, tmp_path):
    before = names(results)
    assert leftovers.main(["--configfile", str(tmp_path / "first.yaml"), "--delete"]) == 0
    gone = before - names(results)
    pendulum = {"pendulum.nc", "summaries/pendulum.html", ".made/pendulum.json"}
    assert {Path(name).parts[0] for name in gone - pendulum} == {"points", "batches"}
    assert gone >= pendulum and len(gone) == 2 + 1 + 3
    stored, plan = store.Store(results), Plan(load.load(tmp_path / "first.yaml"))
    for batch in plan.batches_in("bore").values():
        for request in batch.requests:
            assert stored.read(batches.group(request), batches.key_of(request)) is not None


@pytest.mark.long
def test_what_any_of_several_asks_for_stays(results, tmp_path, capsys):
    files = [str(tmp_path / "first.yaml"), str(tmp_path / "second.yaml")]
    assert leftovers.main(["--configfile", *files, "--delete"]) == 0
    assert "0 points and single runs" in capsys.readouterr().out
    assert len(list((results / "points").rglob("*.json"))) == 6 + 1


def test_two_folders_of_results_are_refused(results, tmp_path, capsys):
    other = tmp_path / "other.yaml"
    other.write_text(yaml.safe_dump({"results": "elsewhere", "sweeps": {"bore": AXES}}))
    first, before = str(tmp_path / "first.yaml"), names(results)
    for second in ([], ["--configfile"]):  # a repeated option adds files
        words = ["--configfile", first, *second, str(other), "--delete"]
        assert leftovers.main(words) == 2
        assert "several folders" in capsys.readouterr().err
        assert names(results) == before


def test_a_configuration_that_cannot_be_read_removes_nothing(results, tmp_path, capsys):
    before = names(results)
    assert leftovers.main(["--configfile", str(tmp_path / "none.yaml"), "--delete"]) == 2
    assert "none.yaml: cannot be read" in capsys.readouterr().err
    assert names(results) == before


def only_one_dataset(results, tmp_path):
    """A configuration, and a folder of results that has only a dataset of another sweep."""
    path = tmp_path / "one.yaml"
    path.write_text(yaml.safe_dump({"results": str(results), "sweeps": {"bore": AXES}}))
    made(results, "pendulum")
    return path


def test_no_folder_above_the_results_is_removed(tmp_path):
    """The folder of results stays as well, however its path is written."""
    results = tmp_path / "above" / "results"
    configuration = only_one_dataset(results, tmp_path)
    settings = f"{tmp_path}/above/results/../results/."
    configuration.write_text(yaml.safe_dump({"results": settings, "sweeps": {"bore": AXES}}))
    assert leftovers.main(["--configfile", str(configuration), "--delete"]) == 0
    assert results.is_dir() and not any(results.iterdir())


@pytest.mark.parametrize("linked", ["figures", "points", "points/bore", "batches", ".made/figures"])
def test_nothing_behind_a_link_is_removed(tmp_path, linked):
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    configuration = only_one_dataset(results, tmp_path)
    key = "0" * 64
    inside = {
        "figures": "map.png",
        ".made/figures": "map.json",
        "points": f"bore/00/{key}.json",
        "points/bore": f"00/{key}.json",
        "batches": "bore/0123456789abcdef0123.jsonl",
    }
    write_atomically(elsewhere / inside[linked], b"content")
    if linked == "figures":
        stamp = results / stamps.stamp_of("figures/map")
        stamps.write(stamp, "f00d", [elsewhere / "map.png"])
    (results / linked).parent.mkdir(exist_ok=True)
    (results / linked).symlink_to(elsewhere)
    before = names(elsewhere)
    assert leftovers.main(["--configfile", str(configuration), "--delete"]) == 0
    assert names(elsewhere) == before and (results / linked).is_symlink()
    assert not (results / "pendulum.nc").exists()


def test_a_folder_of_results_may_be_a_link(tmp_path):
    elsewhere = tmp_path / "disk"
    only_one_dataset(elsewhere, tmp_path)
    (tmp_path / "results").symlink_to(elsewhere)
    configuration = tmp_path / "linked.yaml"
    settings = {"results": str(tmp_path / "results"), "sweeps": {"bore": AXES}}
    configuration.write_text(yaml.safe_dump(settings))
    assert leftovers.main(["--configfile", str(configuration), "--delete"]) == 0
    assert elsewhere.is_dir() and not any(elsewhere.iterdir())


@pytest.mark.parametrize("damaged", [True, False])
def test_without_the_batch_of_a_map_the_points_of_its_motion_stay(
    results, tmp_path, capsys, damaged
):
    map_ = AXES | {"velocity": [0.1, 2], "adaptive": {"error": 0.1}}
    configuration = tmp_path / "map.yaml"
    settings = {"results": str(results), "sweeps": {"bore": map_}}
    configuration.write_text(yaml.safe_dump(settings))
    (file,) = Plan(load.load(configuration)).batch_files("certified_bore")
    if damaged:
        write_atomically(results / file, b'{"key": ')
    points = names(results / "points")
    assert leftovers.main(["--configfile", str(configuration), "--delete"]) == 0
    assert f"{file} is missing or damaged" in capsys.readouterr().err
    assert names(results / "points") == points
    if not damaged:
        record = {"key": "0" * 64, "request": {"kind": "point", "motion": "bore"}, "result": {}}
        store.write(results / file, [record])
        assert leftovers.main(["--configfile", str(configuration), "--delete"]) == 0
        assert len(names(results / "points")) == 1 + 2  # the points of the sweep itself
