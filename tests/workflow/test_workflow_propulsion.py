"""The study of what motions drive, as Snakemake plans it in a copy of the project: nothing runs."""

import pytest
from stubs.propulsion_stub import DRIVING
from stubs.workflow_project import Project

pytestmark = pytest.mark.slow

SWEEPS = {"transverse": {"velocity": [1], "amplitude": [0]}}


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    project = Project(tmp_path_factory.mktemp("propulsion"))
    project.configure({"sweeps": SWEEPS, "propulsion": DRIVING})
    return project


def test_lines_are_answered_in_batches_collected_and_drawn(project):
    """Three lines, two to a job, one dataset and one figure."""
    planned = project.planned("propulsion")
    assert planned.pop("warm_up") == planned.pop("warm_up_angles") == 1
    assert planned == {"solve_batch": 2, "collect_study": 1, "draw_figure": 1, "propulsion": 1}


@pytest.mark.long
def test_what_is_drawn_twice_is_answered_once(project, tmp_path):
    """Two titles of one line are one request; two lines more are one job more."""
    other = project.copied(tmp_path / "other")
    motions = DRIVING["motions"]
    twin = {"twin": motions["eight"] | {"title": "again"}}
    other.configure({"sweeps": SWEEPS, "propulsion": DRIVING | {"motions": motions | twin}})
    assert other.planned("propulsion")["solve_batch"] == 2
    more = {name: motions["eight"] | {"amplitude": size} for name, size in (("b", 2), ("c", 3))}
    other.configure({"sweeps": SWEEPS, "propulsion": DRIVING | {"motions": motions | twin | more}})
    assert other.planned("propulsion")["solve_batch"] == 3


def test_a_plain_run_does_not_need_it(project):
    assert not {"collect_study", "propulsion"} & set(project.planned())
