"""Study of self-propelled motions: requests, dataset and figure."""

import numpy as np
import pytest
from stubs import propulsion_stub, studies_stub
from stubs.figures_stub import artists

from microslip.datasets import netcdf
from microslip.report.figures import drawing
from microslip.studies import registry
from microslip.sweeps import batches
from microslip.sweeps.store import Store


@pytest.fixture(scope="module")
def data():
    answer, _ = studies_stub.answered(propulsion_stub.propulsion_result)
    return registry.build("propulsion", propulsion_stub.configured(), answer)


def test_every_line_is_asked_for_once():
    again = propulsion_stub.DRIVING["motions"] | {"twin": propulsion_stub.EIGHT}
    configuration = propulsion_stub.configured(motions=again)
    requests = studies_stub.asked("propulsion", configuration)
    assert len(requests) == len(set(requests)) == 3
    answer, calls = studies_stub.answered(propulsion_stub.propulsion_result)
    built = registry.build("propulsion", configuration, answer)
    assert set(calls) == set(requests)
    assert built.sizes == {"line": 4, "point": 3}


def test_the_dataset_holds_what_was_answered_and_outlives_its_file(data, tmp_path):
    netcdf.write(tmp_path / "propulsion.nc", *netcdf.divide(data, registry.groups("propulsion")))
    stored = netcdf.whole(tmp_path / "propulsion.nc")
    assert stored["stall_force"].values.tolist() == [0.2, -0.2, 0.0]
    middle = stored.sel(line="back").isel(point=1)  # middle of the line from (0, -0.2) to (-0.5, 0)
    assert float(middle["velocity"]) == -0.25
    assert float(middle["force"]) == -0.1
    assert float(middle["power_out"]) == pytest.approx(0.025)
    assert np.isnan(stored["velocity"].sel(line="still")).all()
    assert all(stored[name].attrs["long_name"] for name in stored.variables)


def test_the_report_says_what_each_drives(data):
    eight, back, still = registry.report("propulsion", data)
    assert eight == "eight: stall force 0.2, no-load velocity 0.5, efficiency up to 0.25"
    assert "stall force -0.2, no-load velocity -0.5" in back
    assert still == "still: propels nothing: friction holds"


@pytest.mark.slow
def test_the_figure_draws_every_line_and_computes_nothing(data):
    figure = drawing.draw("propulsion", {"propulsion": data})
    above, beside, below, _ = figure.axes
    for axes, name in ((above, "force"), (below, "efficiency")):
        drawn = artists(axes, name)
        lines = [line for line in drawn if line.get_linestyle() != "None"]  # without error bars
        assert len(lines) == 2
        for index, line in enumerate(lines):
            assert line.get_xdata().tolist() == data["velocity"].values[index].tolist()
            assert line.get_ydata().tolist() == data[name].values[index].tolist()
    shown = [text.get_text() for text in figure.axes[3].get_legend().get_texts()]
    assert shown == [r"at \$ rest"]  # the dollar does not start a formula
    assert "normal" in beside.get_title(loc="left")


@pytest.mark.slow
def test_a_line_is_kept_and_found_again(tmp_path):
    motion = {"only": propulsion_stub.EIGHT}
    configuration = propulsion_stub.configured(motions=motion, tolerance=1e-2, points=2)
    (request,) = registry.pieces("propulsion", configuration)[1][0]
    first, _ = batches.answer(request, Store(tmp_path))
    again, seconds = batches.answer(request, Store(tmp_path))
    assert again == first and seconds == 0.0
    assert first["result"]["converged"] and len(first["result"]["velocity"]) == 2
    assert list(tmp_path.glob("propulsion_lines/elliptic/**/*.json"))
