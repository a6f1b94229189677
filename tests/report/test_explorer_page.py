"""The whole page in node: selection of sweeps and Poisson's ratios, and the form."""

import numpy as np
import pytest
from stubs import certified_stub, sweep_stub
from stubs import explorer_stub as stub
from stubs.in_node import needs_node, page_says

from microslip.datasets.accessor import Map
from microslip.report.explorer import payload
from microslip.theory import paper

pytestmark = [pytest.mark.slow, needs_node]
MAP = {"velocity": [0, 0.02, 0.1, 1], "amplitude": [0, 0.6, 1.2], "tolerance": 1e-2}
RATIOS = [0, 0.3, 0.5]


def configured():
    """A configuration with maps with and without periods, lines, and several Poisson's ratios."""
    others = {
        "along": MAP | {"motion": "longitudinal", "title": "to and fro"},
        "ratios": MAP | {"motion": "bore", "poisson": RATIOS},
        "still": {
            "motion": "bore",
            "velocity": [0, 0.001],
            "amplitude": [0, 0.5, 1, 2],
        },
    }
    others |= {
        "drift": {"motion": "transverse", "force": [0.2, 0.4, 0.8], "amplitude": [0.5, 1]},
        "body": {
            "motion": "transverse",
            "velocity": [0.1],
            "amplitude": [1],
            "stiffness": [0.1, 1],
            "mass": [0.1, 1, 10],
        },
    }
    steady = {"velocity": {"log": [0.1, 10, 5]}}
    sweeps = {"transverse": MAP | {"poisson": RATIOS}, "bore": MAP, "continuous_bore": steady}
    page = {"kind": "explorer", "sweep": ["transverse", "bore"]}
    return sweep_stub.configured(sweeps | others, figures={"explorer": page})


def smooth(request):
    place = float(request["velocity"]), float(request["amplitude"]) ** 1.5
    return certified_stub.record(request, float(paper.large_amplitude_transverse(*place)))


@pytest.fixture(scope="module")
def certified():
    """A certified map of transverse oscillation with a made-up friction."""
    axes = {"velocity": [0.001, 10], "amplitude": [0, 3], "error": 1e-2}
    return certified_stub.built(certified_stub.configured("transverse", **axes), smooth)


@pytest.fixture(scope="module")
def made(tmp_path_factory, certified):
    """Datasets by the names of sweeps, and the contents of their page."""
    datasets, periods = stub.made_up(tmp_path_factory.mktemp("page"), configured())
    return datasets, payload.build(datasets, periods, [certified])


def entries(content, kind, name):
    return [one for one in content[kind] if one["name"] == name]


# Contents of the page


@pytest.mark.long
def test_every_sweep_is_a_map_or_lines_at_every_poissons_ratio(made):
    datasets, content = made
    maps = {"transverse": 3, "bore": 1, "along": 1, "ratios": 3}
    lines = {"continuous_bore": 1, "still": 1, "drift": 1, "body": 1}
    for kind, expected in (("maps", maps), ("lines", lines)):
        assert {one["name"]: len(entries(content, kind, one["name"])) for one in content[kind]} == (
            expected
        )
    assert set(datasets) == set(maps) | set(lines) == set(content["made"])


@pytest.mark.long
@pytest.mark.parametrize("name", ["transverse", "ratios"])
def test_maps_at_every_ratio_hold_the_points_of_the_dataset(made, name):
    dataset = made[0][name]
    maps = entries(made[1], "maps", name)
    assert sorted(one["poisson"] for one in maps) == RATIOS
    for one in maps:
        part = dataset.sel(poisson=one["poisson"]).transpose("amplitude", "velocity", ...)
        for key in ("mu_macro", "mu_macro_error"):
            assert np.array_equal(one["points"][key], part[key].values)
        # the static limit of a transverse oscillation is exact for Poisson's ratio 0 only
        labels = " ".join(limit["label"] for limit in one["limits"])
        sideways = name == "transverse" and one["poisson"] > 0
        assert ("exact limit for ν = 0" in labels) == sideways
    with_periods = [one for one in maps if one["periods"]["count"]]
    assert [one["poisson"] for one in with_periods] == ([0] if name == "transverse" else [])


def test_lines_run_over_the_longest_axis(made):
    datasets, content = made
    (steady,), (still,) = (entries(content, "lines", one) for one in ("continuous_bore", "still"))
    assert steady["x"]["values"] == datasets["continuous_bore"].velocity.values.tolist()
    assert steady["x"]["log"] and not still["x"]["log"]
    assert steady["series"][0]["values"] == datasets["continuous_bore"].mu_macro.values.tolist()
    assert [limit["label"] for limit in steady["limits"]] == ["force, Eq 21"]
    assert [one["label"] for one in still["series"]] == ["velocity 0", "velocity 0.001"]
    for one, velocity in zip(still["series"], (0, 0.001), strict=True):
        assert one["values"] == datasets["still"].mu_macro.sel(velocity=velocity).values.tolist()


def test_sweeps_with_a_drive_are_lines_of_the_response(made):
    datasets, content = made
    (drift,), (body,) = (entries(content, "lines", one) for one in ("drift", "body"))
    assert drift["y"]["label"] == "mean velocity"
    assert drift["x"]["values"] == [0.2, 0.4, 0.8]
    for one, amplitude in zip(drift["series"], (0.5, 1), strict=True):
        assert one["label"] == f"amplitude {amplitude:g}"
        assert one["values"] == datasets["drift"].velocity.sel(amplitude=amplitude).values.tolist()
    assert body["x"]["values"] == [0.1, 1, 10]
    for one, stiffness in zip(body["series"], (0.1, 1), strict=True):
        part = datasets["body"].mu_macro.sel(stiffness=stiffness).transpose("mass", ...)
        assert one["values"] == part.values.ravel().tolist()


# Texts on the page


def chosen(name):
    """JavaScript that selects a sweep in the list."""
    return f"element('others').value = '{name}', element('others').fire('change')"


def typed(field, text):
    return f"element('si-{field}').value = '{text}', element('si-{field}').fire('input')"


def picked(field, text):
    return f"element('si-{field}').value = '{text}', element('si-{field}').fire('change')"


def test_every_sweep_can_be_chosen_and_left_again(made):
    tabs, others, ready, *values = page_says(
        made[1],
        "element('tabs').text",
        "element('others').text",
        "document.body.dataset.ready",
        chosen("along"),
        "[element('map-view').hidden, element('map').data[0].z, element('run').text]",
        chosen("still"),
        "[element('map-view').hidden, element('lines-chart').data.length]",
        "element('tabs').children[2].fire('click')",
        "[element('lines-title').text, element('lines-chart').data.at(-1).y]",
        "element('tabs').children[1].fire('click')",
        "[element('lines-view').hidden, element('point-view').hidden, element('disc').drawn]",
    )
    assert tabs == "Transverse oscillation Oscillating bore Continuous bore"
    # titles of groups are in labels, not in the text
    assert others == "other sweeps to and fro ratios still drift body"
    assert ready == "yes"
    dataset = made[0]["along"].transpose("amplitude", "velocity", ...)
    hidden, shown, run = values[1]
    assert (hidden, run) == (False, "The page has no periods of this map.")
    assert np.array_equal(shown, dataset.mu_macro.values[:, 1:])  # without velocity 0
    limits = len(entries(made[1], "lines", "still")[0]["limits"])
    assert values[3] == [True, 2 + limits]
    assert values[5][0] == "Continuous bore"
    assert values[5][1] == made[0]["continuous_bore"].mu_macro.values.tolist()
    assert values[7] == [True, False, True]


def test_the_steady_bore_has_values_at_every_velocity(made):
    dataset = made[0]["continuous_bore"]
    values = page_says(
        made[1],
        "element('tabs').children[2].fire('click')",
        "element('along').value = '1', element('along').fire('input', { target: { value: '1' } })",
        "[element('line-view').hidden, element('line-value').text, element('line-facts').text]",
        "[element('along-value').value, element('lines-chart').layout.shapes[0].x0]",
    )
    hidden, value, facts = values[2]
    mu, torque = (float(dataset[name][1]) for name in ("mu_macro", "mu_torque"))
    assert not hidden and value.startswith(f"mu_macro {mu:.5g} ± ")
    theory = paper.bore_forward(float(dataset.velocity[1]))
    assert f"Eq 21 {float(theory):.5g}" in facts and f"M_z,0 {torque:.5g} ± " in facts
    assert values[3][1] == float(dataset.velocity[1])


SLOW = (typed("speed", "0.001"), picked("speed_unit", "um/s"))


def test_a_contact_slower_than_the_map_is_interpolated_from_the_static_limit(made):
    values = page_says(
        made[1],
        ASK,
        *NO_NU,
        *SLOW,
        "STATE.contact",
        "[element('contact-note').text, element('contact-still').text]",
    )
    contact, (note, still) = values[-2:]
    assert contact["friction"]["source"] == "between static limit and map"
    static = paper.static_limit_transverse(contact["amplitude"])
    assert contact["static_friction"]["value"] == pytest.approx(static, abs=1e-9)
    assert contact["slowest"]["speed"] == pytest.approx(1e-3 / contact["velocity"] * 1e-9, rel=1e-9)
    speed = note.split("begins at a forward speed of ")[1].split(" for this contact")[0]
    number, unit = speed.split()
    assert unit == "um/s"
    assert float(number) == pytest.approx(1e6 * contact["slowest"]["speed"], rel=1e-3)
    assert still.startswith(f"Coefficient at vanishing speed: {0.3 * static:.3g}"[:-1])


def test_the_coefficient_at_vanishing_speed_needs_no_map(made):
    values = page_says(
        made[1], ASK, picked("motion", "bore"), "[STATE.contact, element('contact-still').text]"
    )
    contact, still = values[-1]
    assert contact["refused"].startswith("this page holds no certified map")
    static = paper.static_limit_bore(contact["amplitude"])
    assert contact["static_friction"]["value"] == pytest.approx(static, abs=1e-9)
    assert still.startswith("Coefficient at vanishing speed: ")


def test_a_link_restores_the_state(made):
    before = page_says(
        made[1],
        "element('tabs').children[1].fire('click')",
        "selectAndMark(1, 2)",
        "element('limits').children[0].children[0].checked = false",
        "element('limits').children[0].children[0].fire('change')",
        ASK,
        picked("motion", "bore"),
        typed("load", "7.5"),
        picked("load_unit", "kgf"),
        "[linkOf(STATE), STATE.contact]",
    )
    link, contact = before[-1]
    (values,) = page_says(
        made[1], f"readLink('#{link}'), [linkOf(STATE), STATE.contact, element('si-load').value]"
    )
    assert values == [link, contact, "7.5"]
    (values,) = page_says(made[1], "readLink('#sweep=none&amplitude=x'), STATE.shown.name")
    assert values == "transverse"


def test_poissons_ratios_are_a_list(made):
    values = page_says(
        made[1],
        "[element('poisson').hidden, element('poisson').text]",
        "element('poisson').value = '2', element('poisson').fire('change')",
        "[STATE.map.poisson, element('certificate').text, element('poisson').value]",
        "element('tabs').children[1].fire('click')",
        "element('poisson').hidden",
    )
    ratios = "Poisson's ratio 0 Poisson's ratio 0.3 Poisson's ratio 0.5"
    assert values[0] == [False, ratios]
    assert values[2][0] == 0.5 and "Poisson's ratio 0.5" in values[2][1] and values[2][2] == "2"
    assert values[4] is True


ASK = "element('ask').fire('click')"
NO_NU = (picked("material", "by E and ν"), typed("nu", "0"), picked("counterbody", "rigid"))


def test_the_form_answers_and_marks_the_point(made, certified):
    values = page_says(
        made[1],
        "element('contact-view').hidden",
        ASK,
        "[element('contact-view').hidden, element('point-view').hidden]",
        *NO_NU,
        "STATE.contact",
        "[element('contact-value').text, element('contact-note').text]",
        "[element('map').data.at(-1).x, element('map').data.at(-1).y]",
        "element('contact-warnings').text",
        ASK,
        "[element('contact-view').hidden, element('map').data.at(-1).x, element('disc').drawn]",
    )
    contact, (value, note), star, warnings = values[6:10]
    truth = Map(certified).at(contact["velocity"], contact["amplitude"])
    mu, error = float(truth.mu_macro), float(truth.mu_macro_error)
    assert contact["friction"]["value"] == pytest.approx(mu, abs=1e-12)
    assert abs(float(value.split()[3]) - 0.3 * mu) <= 0.3 * error / 10
    assert float(note.split(" ± ")[1].split(";")[0]) == pytest.approx(error, rel=0.05)
    assert "instead of 0.3: a force of " in value and value.endswith("instead of 3 N")
    assert star == [[contact["velocity"]], [contact["amplitude"]]]
    assert "Warning: the largest pressure" not in warnings
    whose = "the hardness of the body is missing"
    assert f"Not checked: whether the bodies stay elastic ({whose})" in warnings
    assert values[-1] == [True, [], True]


def test_the_form_shows_the_necessary_fields_only(made):
    hidden = "['young', 'counter_nu', 'stroke', 'angle'].map((id) => offerContact.rows[id].hidden)"
    values = page_says(
        made[1],
        ASK,
        hidden,
        picked("material", "by E and ν"),
        picked("motion", "bore"),
        hidden,
        "[element('contact-value').text, STATE.map.name]",
    )
    assert values[1] == [True, True, False, True]
    assert values[4] == [False, True, True, False]
    value, map_name = values[5]
    assert map_name == "bore"  # the map of the motion is drawn beside the form
    assert value == "No certified friction: this page holds no certified map of bore."


def test_bad_input_has_a_message_and_removes_the_answer(made):
    values = page_says(
        made[1],
        ASK,
        *NO_NU,
        typed("load", "1,5"),
        "[element('contact-value').text, element('contact-value').className]",
        "[element('contact-facts').text, element('contact-warnings').text, STATE.contact]",
        typed("load", "1.5"),
        "element('contact-value').className",
    )
    value, kind = values[5]
    assert value.startswith("normal load = '1,5': read 1 and stopped at ',5', since decimals")
    assert kind == "bad"
    assert values[6] == ["", "", None]
    assert values[8] == ""
