"""The explorer's page: contents, independence of the network, selection, pictures of a point."""

import json
import re

import numpy as np
import pytest
from stubs import explorer_stub as stub
from stubs.in_node import needs_node, page_says
from stubs.unpacked_period import unpacked

from microslip.datasets.catalogue import FORMS
from microslip.report.explorer import page
from microslip.report.motions import MOTIONS
from microslip.theory import paper

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Datasets and periods by the names of sweeps, and the contents of their page."""
    datasets, periods = stub.made_up(tmp_path_factory.mktemp("explorer"))
    return datasets, periods, page.build(datasets, periods)


def entries(content, name):
    return [one for one in content["sweeps"] if one["name"] == name]


def test_maps_have_the_points_limits_and_periods_of_every_ratio(made):
    for name, ratios in (("transverse", stub.RATIOS), ("bore", [0])):
        maps = entries(made[2], name)
        assert [one["poisson"] for one in maps] == ratios
        assert [one["periods"] is not None for one in maps] == [nu == 0 for nu in ratios]
        for one in maps:
            dataset = made[0][name]
            dataset = dataset.sel(poisson=one["poisson"]) if "poisson" in dataset.dims else dataset
            dataset = dataset.transpose("amplitude", "velocity", ...)
            assert one["velocity"] == list(dataset.velocity.values)
            assert {"mu_macro", "mu_macro_error", "converged"} <= one["points"].keys()
            for key, values in one["points"].items():
                kind = float if dataset[key].dtype.kind == "f" else None
                np.testing.assert_array_equal(np.array(values, kind), dataset[key].values)
            assert len(one["limits"]) == len(FORMS[name])
            for limit, key in zip(one["limits"], FORMS[name], strict=True):
                assert np.array_equal(limit["values"], dataset[key].values)
                assert limit["long_name"] == dataset[key].long_name
                if len(limit["dims"]) == 1:
                    assert np.array_equal(limit["curve"][1], dataset[f"{key}_curve"].values)
            # the static limit of a transverse oscillation is exact for Poisson's ratio 0 only
            labels = " ".join(limit["label"] for limit in one["limits"])
            assert ("exact limit for ν = 0" in labels) == (one["poisson"] > 0)


def test_every_sliding_and_oscillating_point_has_a_period_or_a_reason(made):
    for name in MOTIONS:
        dataset, table = made[0][name], entries(made[2], name)[0]["periods"]
        moves = (dataset.amplitude > 0) & (dataset.velocity > 0)
        assert [[one is not None for one in row] for row in table] == moves.values.tolist()
    assert entries(made[2], "transverse")[0]["periods"][2][3] == stub.NOT


def test_other_sweeps_are_lines_over_the_longest_axis(made):
    datasets, _, content = made
    steady, still, drift, body = (
        entries(content, name)[0] for name in ("continuous_bore", "still", "drift", "body")
    )
    assert steady["series"][0]["values"] == datasets["continuous_bore"].mu_macro.values.tolist()
    assert steady["x"]["log"] and [one["label"] for one in steady["limits"]] == ["force, Eq 21"]
    assert [one["label"] for one in still["series"]] == ["velocity 0", "velocity 0.001"]
    assert drift["y"]["label"] == "mean velocity" and drift["x"]["values"] == [0.2, 0.4, 0.8]
    for one, amplitude in zip(drift["series"], (0.5, 1), strict=True):
        assert one["values"] == datasets["drift"].velocity.sel(amplitude=amplitude).values.tolist()
    for one, stiffness in zip(body["series"], (0.1, 1), strict=True):
        part = datasets["body"].mu_macro.sel(stiffness=stiffness)
        assert one["values"] == part.values.ravel().tolist()


def test_a_finer_map_has_periods_for_some_points_of_both_axes():
    axes = {"velocity": {"log": [0.001, 10, 101]}, "amplitude": [0, *range(1, 51)]}
    requests = stub.period_requests(stub.configured(**axes), "bore")
    assert 300 < len(requests) <= 625
    assert len({request["velocity"] for request in requests}) == 34
    assert len({request["amplitude"] for request in requests}) == 17


def test_the_page_needs_no_network_and_text_cannot_end_the_script(made, monkeypatch):
    monkeypatch.setattr(page, "get_plotlyjs", lambda: "// the library")
    text = page.page(made[2])
    # The only address is the name space of SVG.
    assert set(re.findall(r"\w+://[^\s\"'<>]+", text)) == {"http://www.w3.org/2000/svg"}
    assert not re.search(
        r"<(link|img|iframe)|\s(src|href)=|@import|fetch\(|XMLHttp|WebSocket", text
    )
    assert "default-src 'none'" in text and text == page.page(made[2])
    content = json.loads(json.dumps(made[2]))
    content["made"].append("</script><script>alert(1)")
    assert page.page(content).count("</script>") == text.count("</script>")


# In node


def chosen(name):
    """JavaScript that selects a sweep in the list."""
    return f"element('sweeps').value = '{name}', element('sweeps').fire('change')"


def at(name, dataset, velocity, amplitude):
    """JavaScript that selects a map and a point of it."""
    row, column = (
        int(np.flatnonzero(dataset[dim] == value)[0])
        for dim, value in (("amplitude", amplitude), ("velocity", velocity))
    )
    return f"{chosen(name)}, selectAndMark({row}, {column})"


@needs_node
@pytest.mark.parametrize(
    ("name", "velocity", "amplitude"), [("transverse", 0.02, 0.6), ("bore", 1, 1.2)]
)
def test_a_selected_point_shows_its_value_its_loop_and_every_frame(made, name, velocity, amplitude):
    datasets, records, content = made
    dataset, place = datasets[name], (f"{amplitude:g}", f"{velocity:g}")
    (result,) = (
        one["result"]
        for one in records[name]
        if (one["request"]["amplitude"], one["request"]["velocity"]) == place
    )
    _, value, text, spent, angle, (radius, bound), frames, history, loop, hottest = page_says(
        content,
        at(name, dataset, velocity, amplitude),
        "element('value').text",
        "element('certificate').text",
        "element('spent').text",
        "sectorAngles(STATE.period)",
        "[STATE.period.radius, STATE.period.bound]",
        "STATE.period.phase.map((_, k) => cellsOf(STATE.period, k))",
        "element('history').data.map((trace) => [trace.x, trace.y])",
        "[element('loop').data[1].x, element('loop').data[1].y]",
        "STATE.disc.hottest",
    )
    point, truth = dataset.sel(velocity=velocity, amplitude=amplitude), unpacked(result)
    point = point.isel(poisson=0, missing_dims="ignore")
    shown = re.search(r"mu_macro (-?[\d.]+) ± ([\d.e-]+)", value)
    assert float(shown[1]) == pytest.approx(float(point.mu_macro), abs=5.1e-6)
    assert float(shown[2]) == pytest.approx(float(point.mu_macro_error), rel=0.06)
    assert f"velocity {velocity:g}, amplitude {amplitude:g}" in text
    assert "friction dissipates 0.25 ± 0.001 " in spent
    # forces
    phase = np.radians(history[3][0])
    assert history[2][1] == pytest.approx([float(point.mu_macro)] * 2)
    assert phase == pytest.approx(result["phase"], abs=1e-5)
    mean = np.trapezoid(history[3][1], phase) / (phase[-1] - phase[0])
    assert mean == pytest.approx(result["mu_macro"], abs=1e-3)
    other = {"transverse": "force_lateral", "bore": "torque"}[name]
    for drawn, force in zip(loop, (other, "force_forward"), strict=True):
        assert drawn == pytest.approx(result[force], abs=1e-5)
    # the disc
    assert bound == pytest.approx(result["bound"], abs=1e-5)
    lateral = np.outer(np.cos(angle), radius).ravel()
    assert lateral == pytest.approx(truth["lateral_position"], abs=1e-5)
    rims = np.array([0.0, *0.5 * (np.array(radius)[1:] + np.array(radius)[:-1]), 1.0])
    density = truth["densities"][: len(truth["densities"]) // 2]
    energies = density * np.tile(np.diff(rims**2), len(density) // len(radius))
    others = np.setdiff1d(np.arange(len(density)), hottest)
    assert energies[hottest].sum() >= 0.5 * energies.sum() > energies[hottest[:-1]].sum()
    assert density[hottest].min() >= density[others].max()
    for k, cells in enumerate(frames):
        at_k = k % (len(frames) - 1)
        # the frame half a period later is the mirror image of the first one
        off = 2e-2 if at_k == len(frames) // 2 else 1e-9
        for way in ("forward", "lateral"):
            share = truth[f"traction_{way}"][at_k] / truth["bound"]
            assert cells[way] == pytest.approx(share, abs=off), (k, way)
        assert np.mean(np.array(cells["slips"]) != truth["slips"][at_k]) < off, k


@needs_node
def test_unconverged_points_missing_periods_and_hidden_limits(made):
    datasets, _, content = made
    run, transverse = "element('run').text", datasets["transverse"]
    box = "element('limits').children[0].children[0]"
    visibility = (
        "element('along-amplitude').data.find((t) => t.name === STATE.map.limits[0].label).visible"
    )
    _, certificate, _, nearest, _, still, _, rest, _, bad, _, hidden, _, drawn = page_says(
        content,
        at("transverse", transverse, 1, 0.6),
        "element('certificate').text",
        at("transverse", transverse, 1, 1.2),
        run,
        at("transverse", transverse, 0, 1.2),
        run,
        at("transverse", transverse, 0, 0),
        run,
        at("bore", datasets["bore"], 0.02, 1.2),
        run,
        at("transverse", transverse, 1, 1.2)
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


@needs_node
def test_every_sweep_and_ratio_can_be_chosen(made):
    names, sources, ready, *values = page_says(
        made[2],
        "element('sweeps').text",
        "element('made').text",
        "document.body.dataset.ready",
        chosen("along"),
        "[element('map-view').hidden, element('map').data[0].z, element('run').text]",
        chosen("still"),
        "[element('map-view').hidden, element('lines-chart').data.length]",
        chosen("continuous_bore"),
        "element('along').value = '1', element('along').fire('input', { target: { value: '1' } })",
        "[element('line-value').text, element('line-facts').text]",
        chosen("transverse"),
        "element('poisson').value = '2', element('poisson').fire('change')",
        "[element('lines-view').hidden, STATE.map.poisson, element('certificate').text]",
    )
    assert names == "Transverse Bore Continuous bore to and fro Still Drift Body" and ready == "yes"
    assert "periods of the polar model: cells 10, angles 12, steps 32" in sources
    hidden, shown, run = values[1]
    assert (hidden, run) == (False, "The page has no periods of this map.")
    dataset = made[0]["along"].transpose("amplitude", "velocity", ...)
    assert np.array_equal(shown, dataset.mu_macro.values[:, 1:])  # without velocity 0
    assert values[3] == [True, 2 + len(entries(made[2], "still")[0]["limits"])]
    steady = made[0]["continuous_bore"].isel(velocity=1)
    assert values[6][0].startswith(f"mu_macro {float(steady.mu_macro):.5g} ± ")
    for name, form in (("Eq 21", paper.bore_forward), ("Eq 22", paper.bore_torque)):
        assert f"{name} {float(form(float(steady.velocity))):.5g}" in values[6][1]
    assert values[9][:2] == [True, 0.5] and "Poisson's ratio 0.5" in values[9][2]
