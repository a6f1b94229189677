"""Certified maps, made by Snakemake in a copy of the project."""

import shutil

import pytest
from stubs.workflow_project import Project, jobs_in

import microslip
from microslip.app import leftovers
from microslip.app.plan import Plan
from microslip.config import load
from microslip.sweeps import map_rounds

pytestmark = pytest.mark.long

# The rigid model: points that cost nothing.
AXES = {"velocity": [0.1, 10], "amplitude": [0.5, 3], "model": "rigid", "tolerance": 0.01}
TINY = {
    "sweeps": {"transverse": {**AXES, "adaptive": {"error": 0.03}}},
    "points_per_job": 1000,
}


def certified(project):
    return (project.folder / "results" / "certified_transverse.nc").read_bytes()


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project with a certified map. To be left as it is."""
    project = Project(tmp_path_factory.mktemp("certified"))
    project.configure(TINY)
    project.said = project.run("certified")
    return project


def test_one_command_makes_a_map_whose_error_holds_everywhere(finished):
    data = microslip.open_map("certified_transverse", finished.folder / "results").load()
    assert float(data.cell_error.max()) <= data.error == 0.03
    assert data.points == len(finished.points()) > 25
    figure = finished.folder / "results" / "figures" / "certified_transverse.png"
    assert figure.read_bytes().startswith(b"\x89PNG")
    page = finished.folder / "results" / "summaries" / "certified_transverse.html"
    assert f"{data.points} points, all converged" in page.read_text()
    answer = data.microslip.at(velocity=0.7, amplitude=1.9)
    rigid = microslip.solve("transverse", 0.7, 1.9, model="rigid", tolerance=0.01)
    assert abs(float(answer.mu_macro) - rigid.mu_macro) <= float(answer.mu_macro_error)


def test_the_points_of_all_rounds_are_counted(finished):
    """How many there will be is known at the end alone, so the line has no total."""
    files = finished.folder.glob("results/rounds/*/*/*.json")
    rounds = map_rounds.read_rounds([file for file in files if file.stem.isdecimal()])
    assert f"points: {sum(len(one['nodes']) for one in rounds)}point [" in finished.said


def test_a_second_run_has_nothing_to_do_and_a_plain_one_makes_no_map(finished):
    assert "Nothing to be done" in finished.run("certified")
    assert "collect_certified" not in finished.planned()


def test_what_was_killed_goes_on_to_the_same_bytes(finished, tmp_path):
    """What a kill leaves: rounds that are there in part, and no dataset."""
    project = finished.copied(tmp_path / "killed")
    (project.folder / "results" / "certified_transverse.nc").unlink()
    (folder,) = project.folder.glob("results/rounds/certified_transverse/*")
    last = max(int(path.stem) for path in folder.glob("*.json") if path.stem.isdecimal())
    (folder / f"{last}.json").unlink()
    for path in folder.glob(f"{last - 1}-*.json"):
        path.unlink()
    shutil.rmtree(project.folder / ".snakemake")
    before = project.points()
    project.run("certified")
    assert certified(project) == certified(finished)
    assert project.points() == before


def test_a_looser_error_computes_nothing_anew(finished, tmp_path):
    project = finished.copied(tmp_path / "looser")
    looser = {**AXES, "adaptive": {"error": 0.1, "tolerance": 0.009}}
    project.configure({**TINY, "sweeps": {"transverse": looser}})
    before = project.points()
    assert jobs_in(project.run("certified"))
    data = microslip.open_map("certified_transverse", project.folder / "results").load()
    assert data.error == 0.1
    assert data.points <= len(before)
    assert project.points() == before


def test_nothing_of_a_map_is_left_over(finished):
    results = finished.folder / "results"
    plan = Plan(load.load(finished.folder / "tiny.yaml"))
    assert not any(leftovers.left_over(results, [plan]).values())
    without = {**TINY, "sweeps": {"transverse": AXES}}
    left = leftovers.left_over(results, [Plan(load.from_mapping(without))])
    assert len(left[leftovers.KINDS[0]]) == len(finished.points())
    files = ("nc", "html", "png", "pdf")
    made = sorted(f"certified_transverse.{kind}" for kind in files)
    assert sorted(path.name for path in left[leftovers.KINDS[2]]) == made


def test_a_sweep_of_forces_makes_a_map_of_drift(tmp_path):
    weights = {"motion": "transverse", "force": [0.1, 0.8], "amplitude": [0.5, 1.5]}
    weights |= {"adaptive": {"error": 0.1}}
    given = {"sweeps": {"transverse": AXES}, "drives": {"weights": weights}}
    project = Project(tmp_path)
    project.configure(given)
    project.run("drives")
    results = project.folder / "results"
    data = microslip.open_map("certified_weights", results).load()
    assert float(data.cell_error.max()) <= data.error == 0.1
    page = (results / "summaries" / "certified_weights.html").read_text()
    assert f"{data.points} points, all converged; within" in page
    assert "sqrt(1 + v^2) everywhere" in page
    assert (results / "figures" / "certified_weights.png").read_bytes().startswith(b"\x89PNG")
    answer = data.microslip.at(0.6, 1.2)
    asked = microslip.solve("transverse", amplitude=1.2, force=0.6, tolerance=1e-2)
    off = abs(float(answer.velocity) - asked.velocity)
    assert off <= float(answer.velocity_error) + asked.velocity_error
    plan = Plan(load.from_mapping(given))
    assert not any(leftovers.left_over(results, [plan]).values())
    assert "Nothing to be done" in project.run("drives")


def truncated(path):
    path.write_bytes(path.read_bytes()[:-80])


def with_another_node(path):
    """Valid JSON as before, with a digit of a node changed."""
    content = path.read_text()
    assert "0.5" in content
    path.write_text(content.replace("0.5", "0.4", 1))


@pytest.mark.parametrize("damaged", [truncated, with_another_node])
@pytest.mark.parametrize("which", ["round", "part"])
def test_a_damaged_file_of_a_round_is_named_and_made_again(
    finished, tmp_path, capsys, damaged, which
):
    project = finished.copied(tmp_path / "damaged")
    results = project.folder / "results"
    (folder,) = results.glob("rounds/certified_transverse/*")
    path = folder / ("1.json" if which == "round" else "0-0.json")
    whole, points = path.read_bytes(), project.points()
    damaged(path)
    configuration = str(project.folder / "tiny.yaml")
    left = leftovers.left_over(results, [Plan(load.load(configuration))])
    assert not any(left.values())
    if which == "round":
        assert f"{path} is damaged" in capsys.readouterr().err
    said = project.run("certified")
    relative = path.relative_to(project.folder).as_posix()
    assert said.count(f"{relative} is made again: it is damaged") == 1
    assert path.read_bytes() == whole
    assert certified(project) == certified(finished)
    assert project.points() == points
    assert "Nothing to be done" in project.run("certified")
