"""What a configuration leads to, asked without Snakemake."""

import pytest
from stubs.workflow_project import AXES, TINY

from microslip.app import figure_targets
from microslip.app.plan import Plan
from microslip.app.sweep_command import TARGETS
from microslip.config import load
from microslip.foundation import source_digest
from microslip.report.figures import drawing


def plan(**changed):
    return Plan(load.from_mapping({**TINY, **changed}))


def test_a_sweep_too_small_for_a_map_has_no_map():
    small = plan(sweeps={"transverse": {**AXES, "amplitude": [1]}})
    assert small.figure_files(["transverse"]) == [
        "figures/fig1_force_history.png",
        "figures/fig1_force_history.pdf",
    ]
    assert "figures/fig2_transverse_map.png" in plan().figure_files(["transverse"])


def test_each_figure_is_a_target_and_those_of_the_paper_by_their_numbers():
    targets = figure_targets.targets_of(plan())
    paper = {f"fig{n}" for n in range(1, 7)}
    assert paper <= set(targets)
    assert all(targets[name].startswith(f"{name}_") for name in paper)
    assert set(plan().figures) <= {*targets, *TARGETS}
    assert not set(targets) & set(TARGETS)


def test_a_figure_without_data_says_what_it_lacks():
    small = plan(sweeps={"transverse": {**AXES, "amplitude": [1]}})
    assert "needs the sweep bore" in figure_targets.why_no_figure(small, "fig6_bore_map")
    assert "several velocities and amplitudes" in figure_targets.why_no_figure(
        small, "fig2_transverse_map"
    )


def test_a_job_may_be_a_point():
    alone = plan(points_per_job=1)
    assert [len(batch) for batch in alone.batches_in("transverse").values()] == [1] * 4
    assert [len(batch) for batch in plan().batches_in("transverse").values()] == [4]


@pytest.mark.slow
def test_what_a_file_is_made_of_changes_with_its_own_settings_alone():
    sweeps = {**TINY["sweeps"], "transverse": {**AXES, "amplitude": [0, 0.5, 1]}}
    before, after = plan(), plan(sweeps=sweeps)
    files = [*before.dataset_files(before.datasets), *before.figure_files(before.datasets)]
    changed = {f for f in files if before.fingerprint_of(f) != after.fingerprint_of(f)}
    assert changed == {
        "transverse.nc",
        "summaries/transverse.html",
        *after.figure_files(["transverse"]),
    }


def test_the_look_of_figures_counts_for_all_of_them_and_a_kind_for_its_own():
    made_of = {
        figure: source_digest.LOADED.closure(drawing.modules_of(figure))
        for figure in plan().figures
    }
    assert len(made_of) > 10
    assert all("report/figures/style.py" in files for files in made_of.values())
    of_field = [figure for figure, files in made_of.items() if "report/figures/field.py" in files]
    assert of_field == ["fig3_traction_field"]
