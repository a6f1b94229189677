"""The plan of a configuration, without Snakemake."""

import pytest
from stubs.claims_stub import CLAIMS
from stubs.studies_stub import ACCURACY, STABILITY
from stubs.workflow_project import AXES, TINY

from microslip.app.plan import Plan
from microslip.config import load
from microslip.config.records import ConfigError
from microslip.foundation import source_digest
from microslip.report.figures import drawing

STUDIES = {"accuracy": ACCURACY, "stability": STABILITY, "claims": CLAIMS}


def plan(**changed):
    return Plan(load.from_mapping(TINY | STUDIES | changed))


def test_a_sweep_too_small_for_a_map_has_no_map():
    small = plan(sweeps={"transverse": {**AXES, "amplitude": [1]}})
    assert small.products_of("all") == ["transverse", "figures/fig1_force_history"]
    assert "figures/fig2_transverse_map" in plan().products_of("all")


def test_each_figure_of_the_paper_is_a_target_by_its_number():
    for number in range(1, 7):
        (figure,) = plan().products_of(f"fig{number}")
        assert figure.startswith(f"figures/fig{number}_")


def test_a_figure_without_data_is_refused():
    small = plan(sweeps={"transverse": {**AXES, "amplitude": [1]}})
    with pytest.raises(ConfigError, match="needs the sweep bore"):
        small.products_of("fig6_bore_map")
    with pytest.raises(ConfigError, match="several velocities and amplitudes"):
        small.products_of("fig2")


def changed(before, after):
    return {name for name in before.products if before.made_of(name) != after.made_of(name)}


def test_no_product_depends_on_the_size_of_jobs():
    assert changed(plan(), plan(points_per_job=1)) == set()


def test_what_a_product_is_made_of_changes_with_its_own_settings_alone():
    sweeps = {**TINY["sweeps"], "transverse": {**AXES, "amplitude": [0, 0.5, 1]}}
    pages = {"pages/explorer", "pages/explorer_all"}
    figures = {"figures/fig1_force_history", "figures/fig2_transverse_map"}
    assert changed(plan(), plan(sweeps=sweeps)) == {"transverse"} | figures | pages


MOTIONS = {
    "circle": {**AXES, "group": "motions", "motion": "elliptic:phase=90"},
    "line": {**AXES, "group": "motions", "motion": "elliptic:forward=0.5,phase=0"},
}


def test_another_way_to_write_a_motion_computes_nothing():
    before = plan(extended=MOTIONS)
    circle = MOTIONS["circle"] | {"motion": "elliptic"}
    after = plan(extended=MOTIONS | {"circle": circle})
    assert after.batch_files(*after.groups) == before.batch_files(*before.groups)


def test_a_map_with_another_error_has_another_batch_and_the_sweep_has_not():
    def certified(**adaptive):
        return plan(sweeps={"transverse": {**AXES, "adaptive": adaptive}})

    before, after = certified(error=0.05), certified(error=0.06)
    assert before.batch_files("certified_transverse") != after.batch_files("certified_transverse")
    assert before.batch_files("transverse") == after.batch_files("transverse")
    assert before.products_of("certified") == [
        "certified_transverse",
        "figures/certified_transverse",
    ]


def test_the_look_of_figures_counts_for_all_of_them_and_a_kind_for_its_own():
    made_of = {
        figure: source_digest.LOADED.closure(drawing.modules_of(figure))
        for figure in plan().figures
    }
    assert len(made_of) > 10
    assert all("report/figures/style.py" in files for files in made_of.values())
    of_field = [figure for figure, files in made_of.items() if "report/figures/field.py" in files]
    assert of_field == ["fig3_traction_field"]
