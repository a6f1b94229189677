"""The explorer's page: contents, size, independence of the network, and its Snakemake rule."""

import json
import re

import numpy as np
import pytest
from stubs import explorer_stub as stub
from stubs.in_node import needs_node, page_says
from stubs.unpacked_period import unpacked

from microslip.datasets.catalogue import FORMS
from microslip.report.explorer import explorer, page


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Datasets and periods by the names of maps, and the contents of their page."""
    folder = tmp_path_factory.mktemp("explorer")
    datasets, records = stub.computed(folder)
    return datasets, records, page.build(datasets, records)


def map_of(content, name):
    (entry,) = (one for one in content["sweeps"] if one["name"] == name)
    return entry


@pytest.mark.slow
@pytest.mark.parametrize("name", explorer.MAPS)
def test_points_and_limits_are_those_of_the_dataset(made, name):
    dataset, entry = made[0][name], map_of(made[2], name)
    assert entry["velocity"] == list(dataset.velocity.values)
    for key, values in entry["points"].items():
        if dataset[key].dtype.kind == "f":
            values = np.array(values, float)
        assert np.array_equal(values, dataset[key].values), key
    assert len(entry["limits"]) == len(FORMS[name])
    for limit, key in zip(entry["limits"], FORMS[name], strict=True):
        assert np.array_equal(limit["values"], dataset[key].values)
        assert limit["long_name"] == dataset[key].long_name
        if len(limit["dims"]) == 1:
            assert np.array_equal(limit["curve"][1], dataset[f"{key}_curve"].values)


@pytest.mark.slow
def test_every_sliding_and_oscillating_point_has_a_period_or_a_reason(made):
    for name in explorer.MAPS:
        dataset, packed = made[0][name], map_of(made[2], name)["periods"]
        moves = (dataset.amplitude > 0) & (dataset.velocity > 0)
        has = np.array(packed["index"]) >= 0
        for i, j, reason in packed["failed"]:
            assert (name, i, j) == stub.NO_PERIOD
            assert reason == "none to be found"
            has[i, j] = True
        assert (has == moves.values).all()


PLACES = [("transverse", 0.02, 0.6), ("bore", 1, 1.2)]


def chosen(name, dataset, velocity, amplitude):
    """JavaScript that selects a map and a point of it."""
    row, column = (
        int(np.flatnonzero(dataset[dim] == value)[0])
        for dim, value in (("amplitude", amplitude), ("velocity", velocity))
    )
    pick = f"element('sweeps').value = '{name}', element('sweeps').fire('change')"
    return f"{pick}, selectAndMark({row}, {column})"


@needs_node
@pytest.mark.slow
@pytest.mark.parametrize(("name", "velocity", "amplitude"), PLACES)
def test_a_selected_point_shows_its_value_its_loop_and_every_frame(made, name, velocity, amplitude):
    datasets, records, content = made
    dataset, place = datasets[name], (f"{amplitude:g}", f"{velocity:g}")
    (result,) = (one["result"] for one in records[name] if stub.place(one) == place)
    _, value, place, spent, angle, (radius, bound), frames, history, loop, hottest = page_says(
        content,
        chosen(name, dataset, velocity, amplitude),
        "element('value').text",
        "element('certificate').text",
        "element('spent').text",
        "sectorAngles(STATE.map)",
        "[STATE.period.radius, STATE.period.bound]",
        "STATE.period.phase.map((_, k) => cellsOf(STATE.period, k))",
        "element('history').data.map((trace) => [trace.x, trace.y])",
        "[element('loop').data[1].x, element('loop').data[1].y]",
        "STATE.disc.hottest",
    )
    point, truth = dataset.sel(velocity=velocity, amplitude=amplitude), unpacked(result)
    shown = re.search(r"mu_macro (-?[\d.]+) ± ([\d.e-]+)", value)
    assert float(shown[1]) == pytest.approx(float(point.mu_macro), abs=5.1e-6)
    assert float(shown[2]) == pytest.approx(float(point.mu_macro_error), rel=0.06)
    assert f"velocity {velocity:g}, amplitude {amplitude:g}" in place
    energy = f"{float(point.dissipated_energy):.4g} ± {float(point.dissipated_energy_error):.2g}"
    assert f"friction dissipates {energy} " in spent
    # forces
    phase = np.radians(history[3][0])
    assert history[2][1] == pytest.approx([float(point.mu_macro)] * 2)
    assert phase == pytest.approx(result["phase"], abs=5e-5)
    mean = stub.mean_over(phase, np.array(history[3][1]))
    assert mean == pytest.approx(result["mu_macro"], abs=1e-3)
    other = {"transverse": "force_lateral", "bore": "torque"}[name]
    for drawn, force in zip(loop, (other, "force_forward"), strict=True):
        assert drawn == pytest.approx(result[force], abs=5e-5)
    # the disc
    assert bound == pytest.approx(result["bound"], abs=8e-6)
    lateral = np.outer(np.cos(angle), radius).ravel()
    assert lateral == pytest.approx(truth["lateral_position"], abs=2e-5)
    rims = np.array([0.0, *0.5 * (np.array(radius)[1:] + np.array(radius)[:-1]), 1.0])
    density = truth["densities"][: len(truth["densities"]) // 2]
    energies = density * np.tile(np.diff(rims**2), len(density) // len(radius))
    others = np.setdiff1d(np.arange(len(density)), hottest)
    assert energies[hottest].sum() >= 0.5 * energies.sum() > energies[hottest[:-1]].sum()
    assert density[hottest].min() >= density[others].max()
    for k, cells in enumerate(frames):
        at = k % (len(frames) - 1)
        # the frame half a period later is the mirror image of the first one
        off = 2e-2 if at == len(frames) // 2 else 1e-9
        for way in ("forward", "lateral"):
            share = truth[f"traction_{way}"][at] / truth["bound"]
            assert cells[way] == pytest.approx(share, abs=off), (k, way)
        assert np.mean(np.array(cells["slips"]) != truth["slips"][at]) < off, k


@needs_node
@pytest.mark.slow
def test_unconverged_points_missing_periods_and_hidden_limits(made):
    datasets, _, content = made
    run, transverse = "element('run').text", datasets["transverse"]
    box = "element('limits').children[0].children[0]"
    visibility = (
        "element('along-amplitude').data.find((t) => t.name === STATE.map.limits[0].label).visible"
    )
    _, certificate, _, nearest, _, still, _, rest, _, bad, _, hidden, _, drawn = page_says(
        content,
        chosen("transverse", transverse, 1, 0.6),
        "element('certificate').text",
        chosen("transverse", transverse, 1, 1.2),
        run,
        chosen("transverse", transverse, 0, 1.2),
        run,
        chosen("transverse", transverse, 0, 0),
        run,
        chosen("bore", datasets["bore"], 0.02, 1.2),
        run,
        chosen("transverse", transverse, 1, 1.2)
        + f", {box}.checked = false, {box}.fire('change'), selectAndMark(1, 1)",
        visibility,
        f"{box}.checked = true, {box}.fire('change')",
        visibility,
    )
    assert "not converged: made up" in certificate
    assert nearest.startswith("No period was found: none to be found Drawn below: the nearest")
    assert nearest.endswith("at velocity 1, amplitude 0.6.")
    assert "static limit" in still and "Nothing oscillates here" in rest
    assert "It did not converge: none to be found" in bad
    assert (hidden, drawn) == (False, True)


def test_a_finer_map_has_periods_for_some_points_of_both_axes():
    axes = {"velocity": {"log": [0.001, 10, 101]}, "amplitude": [0, *range(1, 51)]}
    requests = stub.period_requests(stub.configured(**axes), "bore")
    assert 300 < len(requests) <= 625
    assert len({request["velocity"] for request in requests}) == 34
    assert len({request["amplitude"] for request in requests}) == 17


def test_the_page_needs_no_network(made, monkeypatch):
    monkeypatch.setattr(page, "get_plotlyjs", lambda: "// the library")
    text = page.page(made[2])
    # The only address is the name space of SVG.
    addresses = set(re.findall(r"\w+://[^\s\"'<>]+", text))
    assert addresses == {"http://www.w3.org/2000/svg"}
    assert not re.search(
        r"<(link|img|iframe)|\s(src|href)=|@import|fetch\(|XMLHttp|WebSocket", text
    )
    assert "default-src 'none'" in text
    assert text == page.page(made[2])


def test_text_in_a_dataset_cannot_end_the_script(made):
    content = json.loads(json.dumps(made[2]))
    content["made"]["bore"].append(["title", "</script><script>alert(1)"])
    assert page.page(content).count("</script>") == page.page(made[2]).count("</script>")
