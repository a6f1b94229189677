"""``microslip gc``: finds and removes results that no configuration requests, and nothing else."""

from pathlib import Path

import pytest
import yaml
from stubs.claims_stub import CLAIMS
from stubs.studies_stub import ACCURACY, STABILITY
from stubs.sweep_stub import Solver

from microslip.app import cli
from microslip.app.plan import Plan
from microslip.config import load
from microslip.foundation.files import write_atomically
from microslip.sweeps import batches, stamps, store

AXES = {"velocity": [0.5, 2], "amplitude": [0, 1], "tolerance": 1e-2}
SMALL_STUDIES = {"accuracy": ACCURACY, "stability": STABILITY, "claims": CLAIMS}


def configured(folder, name, place="results", **bore):
    """Write a configuration with one small sweep; place: its folder of results, seen from here."""
    path = folder / f"{name}.yaml"
    settings = {"results": str(folder / place), "sweeps": {"bore": AXES | bore}}
    path.write_text(yaml.safe_dump(settings | SMALL_STUDIES))
    return str(path)


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
def files(tmp_path):
    """Two configurations of one folder of results."""
    return configured(tmp_path, "first"), configured(tmp_path, "second", velocity=[0.5, 3])


@pytest.fixture
def results(files, tmp_path, monkeypatch):
    """A folder with points and batches of two configurations, and a dataset."""
    Solver(monkeypatch)
    folder = tmp_path / "results"
    for plan in (Plan(load.load(file)) for file in files):
        inside = plan.batches_in("bore").values()
        for file, batch in zip(plan.batch_files("bore"), inside, strict=True):
            records, _ = batches.run_batch(batch.requests, store.Store(folder))
            store.write(folder / file, records)
    made(folder, "bore", "figures/fig6_bore_map", "pendulum")
    (folder / "notes.txt").write_text("mine")
    (folder / "mine.nc").write_bytes(b"without a stamp")
    (folder / "points" / "mine.json").write_text("{}")
    return folder


def names(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def gc(*words):
    return cli.main(["gc", "--configfile", *words])


def test_without_delete_nothing_is_removed(results, files, capsys):
    before = names(results)
    assert gc(files[0], "--list") == 0
    assert names(results) == before
    message = capsys.readouterr().out
    assert "2 points and single runs that no configuration requests" in message
    assert "1 batches that no configuration requests" in message
    assert "3 datasets, pages and figures" in message and "pendulum.nc" in message
    assert "nothing is removed without --delete" in message
    assert "mine" not in message


def test_what_no_configuration_requests_is_removed(results, files):
    before = names(results)
    assert gc(files[0], "--delete") == 0
    gone = before - names(results)
    pendulum = {"pendulum.nc", "summaries/pendulum.html", ".made/pendulum.json"}
    assert {Path(name).parts[0] for name in gone - pendulum} == {"points", "batches"}
    assert gone >= pendulum and len(gone) == 2 + 1 + 3
    stored, plan = store.Store(results), Plan(load.load(files[0]))
    for batch in plan.batches_in("bore").values():
        for request in batch.requests:
            assert stored.read(batches.group(request), batches.key_of(request)) is not None


@pytest.mark.parametrize("between", [[], ["--configfile"]])  # a repeated option adds files
def test_what_any_of_several_configurations_requests_stays(results, files, between, tmp_path):
    before = names(results / "points")
    (tmp_path / "link").symlink_to(results)
    again = [configured(tmp_path, place, place) for place in ("results", "link")]
    assert gc(files[0], *between, files[1], *again, "--delete") == 0
    assert names(results / "points") == before


def test_two_folders_of_results_are_refused(results, files, tmp_path, capsys):
    before, other = names(results), configured(tmp_path, "other", "elsewhere")
    assert gc(files[0], "--configfile", other, "--delete") == 2
    assert "several folders" in capsys.readouterr().err
    assert names(results) == before


@pytest.mark.parametrize("place", ["above/results/../results/.", "link"])
def test_the_folder_of_results_and_those_above_stay(tmp_path, place):
    results = tmp_path / "above" / "results"
    made(results, "pendulum")
    (tmp_path / "link").symlink_to(results)
    assert gc(configured(tmp_path, "one", place), "--delete") == 0
    assert results.is_dir() and not any(results.iterdir())


@pytest.mark.parametrize(
    ("linked", "inside"),
    [
        ("figures", "map.png"),
        ("points/bore", f"00/{'0' * 64}.json"),
        ("batches", "bore/0123456789abcdef0123.jsonl"),
    ],
)
def test_nothing_behind_a_link_is_removed(tmp_path, linked, inside):
    results, elsewhere = tmp_path / "results", tmp_path / "elsewhere"
    made(results, "pendulum")
    write_atomically(elsewhere / inside, b"content")
    if linked == "figures":
        stamp = results / stamps.stamp_of("figures/map")
        stamps.write(stamp, "f00d", [elsewhere / "map.png"])
    (results / linked).parent.mkdir(exist_ok=True)
    (results / linked).symlink_to(elsewhere)
    assert gc(configured(tmp_path, "one"), "--delete") == 0
    assert names(elsewhere) == {inside} and (results / linked).is_symlink()
    assert not (results / "pendulum.nc").exists()


def test_folders_and_links_among_the_points_stay(results, files):
    places = [results / "points" / "00" / f"{digit * 64}.json" for digit in "012"]
    places[0].mkdir(parents=True)
    places[1].symlink_to("nowhere")
    places[2].symlink_to(files[0])
    assert gc(files[0], "--delete") == 0
    assert places[0].is_dir() and places[1].is_symlink() and places[2].is_file()


@pytest.mark.parametrize("damaged", [True, False])
def test_without_the_batch_of_a_map_the_points_of_its_motion_stay(
    results, tmp_path, capsys, damaged
):
    map_ = {"velocity": [0.1, 2], "adaptive": {"error": 0.1}}
    configuration = configured(tmp_path, "map", **map_)
    (file,) = Plan(load.load(configuration)).batch_files("certified_bore")
    if damaged:
        write_atomically(results / file, b'{"key": ')
    points = names(results / "points")
    assert gc(configuration, "--delete") == 0
    assert f"{file} is missing or damaged" in capsys.readouterr().err
    assert names(results / "points") == points
    if not damaged:
        record = {"key": "0" * 64, "request": {"kind": "point", "motion": "bore"}, "result": {}}
        store.write(results / file, [record])
        assert gc(configuration, "--delete") == 0
        assert len(names(results / "points")) == 1 + 2  # the points of the sweep itself
