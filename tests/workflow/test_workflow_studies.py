"""The studies, run by Snakemake in a copy of the project: a method of one's own in one new file."""

import re

import pytest
from matplotlib.text import Text
from stubs.workflow_project import Project

from microslip.datasets import netcdf
from microslip.report.figures import drawing

pytestmark = pytest.mark.long

# A point with a closed form, maps that cost next to nothing, and a block whose cases are few.
TINY = {
    "sweeps": {"transverse": {"velocity": [1], "amplitude": [0]}},
    "accuracy": {
        "methods": ["shipped", "my-method"],
        "points": {"fast": {"motion": "longitudinal", "velocity": 0.5, "amplitude": 1}},
        "levels": 2,
        "repeats": 1,
        "map": {
            "velocity": [1, 3],
            "amplitude_transverse": [0.5, 2],
            "amplitude_bore": [0.5, 2],
            "tolerance": [0.01],
        },
    },
    "stability": {
        "methods": ["shipped", "my-method"],
        "axes": ["critical-amplitude"],
        "tolerance": 0.01,
    },
}
# All datasets, and of the figures those that name a method of one's own.
TARGETS = ["results/accuracy_cost.nc", "results/figures/accuracy_profile.png"]
TARGETS += ["results/stability.nc", "results/figures/stability_atlas.png"]
METHOD = '''
"""Backward Euler under another name."""

from microslip.solver.method import Method
from microslip.models.path import EULER

METHOD = Method("my own way", integrator=EULER)
'''


class Studies(Project):
    """A copy of the project with a method of its own."""

    def __init__(self, folder):
        super().__init__(folder)
        self.configure(TINY)
        self.write_method("my_method")

    def write_method(self, stem):
        (self.folder / f"src/microslip/solver/methods/{stem}.py").write_text(METHOD)

    def stored(self, folder):
        return {p.name: p.read_bytes() for p in self.folder.glob(f"results/{folder}/*/*/*.json")}

    def computed(self):
        logs = self.folder.glob("results/logs/solve_batch/*/*.log")
        return sum(int(n) for log in logs for n in re.findall(r"(\d+) computed", log.read_text()))


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project after both studies. To be left as it is."""
    project = Studies(tmp_path_factory.mktemp("studies"))
    project.said = project.run(*TARGETS)
    return project


@pytest.fixture
def project(finished, tmp_path):
    """A copy of the finished project to edit."""
    return finished.copied(tmp_path / "copy")


def texts(name, path):
    """All that is written in a figure drawn from the dataset at `path`."""
    with netcdf.whole(path) as data:
        figure = drawing.draw(name, {drawing.FIGURES[name][0]: data})
        return " ".join(text.get_text() for text in figure.findobj(Text))


def test_a_method_in_one_new_file_is_in_the_dataset_and_in_the_figures(finished):
    path = finished.folder / "results" / "accuracy_cost.nc"
    with netcdf.whole(path) as data:
        own = data.isel(trial=data.trial_method.values == "my-method")
        assert own.trial_model.values.tolist() == ["radial", "radial"]
        assert own.converged.values.all()
        assert (own.error.values > 0).all()
        assert (own.seconds.values > 0).all()
        assert set(data.trial_model.values) >= {"rigid", "radial", "cartesian", "auto"}
        assert (data.transverse_cheapest.values != "").all()
    assert "my-method" in texts("accuracy_profile", path)  # elsewhere it is one of the grey marks
    for form in ("png", "pdf"):
        assert (finished.folder / f"results/figures/accuracy_profile.{form}").stat().st_size > 0
    assert "fast: " in finished.said


def test_the_same_method_is_in_the_atlas(finished):
    path = finished.folder / "results" / "stability.nc"
    with netcdf.whole(path) as data:
        assert data.method.values.tolist() == ["shipped", "my-method"]
        assert data.method_summary.values[1] == "my own way"
        assert (data.outcome.values > 0).all()
        assert (data.outcome.values[0] == 1).all()
    assert "my-method" in texts("stability_atlas", path)
    assert "my-method: " in finished.said


def test_a_second_run_has_nothing_to_do(finished):
    assert "Nothing to be done" in finished.run(*TARGETS)


def test_neither_study_is_part_of_a_plain_run_and_each_has_its_figures(finished):
    assert not {"collect_study", "solve_early_batch"} & set(finished.planned())
    of_accuracy = [data for data in drawing.FIGURES.values() if data == ("accuracy_cost",)]
    left = {"draw_figure": len(of_accuracy) - 1, "accuracy": 1}  # the atlas is there
    assert finished.planned("accuracy", "stability") == left


def test_a_second_method_computes_its_own_trials_only(project):
    before, computed = project.stored("trials"), project.computed()
    project.write_method("second_way")
    methods = ["shipped", "second-way", "my-method"]
    project.configure({**TINY, "accuracy": {**TINY["accuracy"], "methods": methods}})
    assert project.planned("accuracy") == {
        "solve_batch": 1,
        "collect_study": 1,
        "draw_figure": 5,
        "accuracy": 1,
    }
    project.run("results/accuracy_cost.nc")
    after = project.stored("trials")
    assert {name: after[name] for name in before} == before
    assert len(after) == len(before) + 2
    assert project.computed() == computed + 2
    with netcdf.whole(project.folder / "results" / "accuracy_cost.nc") as data:
        numbers = {
            method: data.mu_macro.values[data.trial_method.values == method].tolist()
            for method in methods
        }
    assert numbers["second-way"] == numbers["my-method"]


def test_editing_a_method_computes_its_trials_again_but_a_comment_does_not(project):
    project.append("src/microslip/solver/methods/my_method.py", "\n# More to read.\n")
    assert project.planned(*TARGETS) == {}
    project.append("src/microslip/solver/methods/my_method.py", "\nSPARE = 1\n")
    planned = project.planned("accuracy", "stability")
    assert planned["solve_batch"] == 2
    assert "solve_early_batch" not in planned
