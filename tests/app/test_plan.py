"""The plan of a configuration and the state of its results folder, without Snakemake."""

import json
import tracemalloc

import pytest
from bad_input_tables.bad_configurations import STUDIED
from stubs.sweep_stub import configured
from stubs.workflow_project import AXES, TINY

from microslip.app.plan import Plan, Results
from microslip.config import load
from microslip.foundation import source_digest
from microslip.report.figures import drawing
from microslip.sweeps import batch, content

FIGURES = {
    "profile": {"kind": "accuracy_profile"},
    "explorer": {"kind": "explorer", "sweep": ["transverse", "bore"]},
}


def plan(sweeps=None, **changed):
    figures = TINY["figures"] | FIGURES
    sweeps = TINY["sweeps"] | (sweeps or {})
    return Plan(
        load.from_mapping(TINY | STUDIED | {"figures": figures, "sweeps": sweeps} | changed)
    )


def changed(before, after):
    return {n for n in before.products if before.products[n].stem != after.products[n].stem}


def test_the_name_of_a_product_changes_with_its_own_settings_alone():
    transverse = TINY["sweeps"]["transverse"] | {"amplitude": [0, 0.5, 1]}
    names = {"transverse", "fig1_force_history", "fig2_transverse_map", "explorer"}
    assert changed(plan(), plan({"transverse": transverse})) == names
    history = TINY["figures"]["fig1_force_history"] | {"periods": 2}
    figures = TINY["figures"] | FIGURES | {"fig1_force_history": history}
    assert changed(plan(), plan(figures=figures)) == names  # the run is in the dataset
    assert changed(plan(), plan(points_per_job=1)) == set()
    assert changed(plan(), plan(claims=STUDIED["claims"] | {"tolerance": 2e-3})) == {"claims"}


def test_another_way_to_write_a_motion_computes_nothing():
    def batches(motion):
        one = {"circle": {**AXES, "motion": motion}}
        return plan(one).batches("circle").keys()

    assert batches("elliptic") == batches("elliptic:phase=90")


def test_an_edit_of_a_builder_or_of_the_script_renames_what_it_makes(monkeypatch):
    axes = {"velocity": [0.1, 10], "amplitude": [0, 1]}
    sure = {"sure": axes | {"motion": "bore", "error": 0.01}}
    before, digest = plan(sure), source_digest.of_builder
    parts = {"studies": {*STUDIED, "profile"}, "sweeps/map_refinement.py": {"sure"}}
    for part, names in parts.items():

        def edited(*files, part=part):
            return "edited" if part in files else digest(*files)

        monkeypatch.setattr(source_digest, "of_builder", edited)
        assert changed(before, plan(sure)) == names
    monkeypatch.setattr(source_digest, "of_builder", digest)
    monkeypatch.setattr(source_digest, "of_script", lambda path: "edited")
    assert changed(before, plan(sure)) == before.products.keys()


def test_the_look_of_figures_counts_for_all_of_them():
    files = (source_digest.LOADED.builder(*drawing.modules_of(kind)) for kind in drawing.DRAWN)
    assert all("report/figures/style.py" in some for some in files)


# The results folder


def test_a_link_does_not_replace_a_file_of_the_user_and_may_be_a_copy(tmp_path, monkeypatch):
    planned = Plan(configured({"bore": {"velocity": [0.1, 1], "amplitude": [0, 1, 2]}}))
    (tmp_path / "data").mkdir()
    for file in Results(planned, tmp_path).files("bore"):
        (tmp_path / file).write_text("<html></html>")
    (tmp_path / "bore.nc").write_text("mine")
    monkeypatch.setattr("pathlib.Path.symlink_to", lambda *_: (_ for _ in ()).throw(OSError))
    monkeypatch.setattr(content, "is_whole", lambda _: True)
    for _ in range(2):
        Results(planned, tmp_path).link()
        assert (tmp_path / "bore.nc").read_text() == "<html></html>"
        assert (tmp_path / "bore.nc.replaced").read_text() == "mine"
        assert not (tmp_path / "bore.nc").is_symlink()


def test_a_batch_is_ordered_as_a_whole_and_a_map_by_its_name():
    axes = {"velocity": [0.1, 10], "amplitude": [0, 1]}
    planned = Plan(
        configured({"bore": axes, "certified": axes | {"motion": "bore", "error": 0.01}})
    )
    state = Results(planned, "none")
    (one,) = state.batches(certified=False)
    assert json.loads(state.order_of_batch("bore", one))["axis"] == "velocity"
    (one,) = state.batches(certified=True)
    assert json.loads(state.order_of_batch("bore", one)) == "certified"
    with pytest.raises(batch.SourcesEdited):
        state.order_of_batch("bore", "0123")


def test_a_hundred_thousand_points_are_planned_in_few_files_and_little_memory():
    axes = {"velocity": {"log": [0.001, 10, 250]}, "amplitude": {"linear": [0, 3, 400]}}
    tracemalloc.start()
    planned = Plan(configured({"transverse": axes}))
    state = Results(planned, "none")
    assert sum(len(one.requests) for one in planned.batches("transverse").values()) == 100_000
    assert len(state.batch_files("transverse")) < 480  # and as many logs
    assert tracemalloc.get_traced_memory()[1] < 2.5e8
    tracemalloc.stop()
