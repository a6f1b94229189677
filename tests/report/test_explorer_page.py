"""The page in node: selection of sweeps and Poisson's ratios, and the form for a real contact."""

import math
import shlex

import numpy as np
import pytest
from stubs import certified_stub, sweep_stub
from stubs import explorer_stub as stub
from stubs.in_node import needs_node, page_says

import microslip
from microslip.report.explorer import contact_form, page
from microslip.theory import paper

pytestmark = [pytest.mark.slow, needs_node]
MAP = {"velocity": [0, 0.02, 0.1, 1], "amplitude": [0, 0.6, 1.2], "tolerance": 1e-2}
RATIOS = [0, 0.3, 0.5]


def configured():
    """A configuration with maps with and without periods, lines, and several Poisson's ratios."""
    drive = {"velocity": 0.1, "amplitude": 1, "stiffness": [0.1, 1], "mass": [0.1, 1, 10]}
    sweeps = {
        "transverse": MAP | {"poisson": RATIOS},
        "bore": MAP,
        "continuous_bore": {"velocity": {"log": [0.1, 10, 5]}},
        "along": MAP | {"motion": "longitudinal", "title": "to and fro"},
        "still": {"motion": "bore", "velocity": [0, 0.001], "amplitude": [0, 0.5, 1]},
        "drift": {"motion": "transverse", "force": [0.2, 0.4, 0.8], "amplitude": [0.5, 1]},
        "body": {"motion": "transverse"} | drive,
    }
    page = {"kind": "explorer", "sweep": ["transverse", "bore"]}
    return sweep_stub.configured(sweeps, figures={"explorer": page})


def rises(velocity, amplitude):
    """A smooth made-up friction that rises with the velocity and is 1 without oscillation."""
    return (0.1 + velocity) / (0.1 + velocity + amplitude / (1 + amplitude))


def certified(motion, **more):
    """A certified map of this friction, with an error of 0.03."""

    def answer(request):
        place = (float(request[name]) for name in ("velocity", "amplitude"))
        return certified_stub.record(request, rises(*place))

    axes = {"velocity": [0.001, 10], "amplitude": [0, 3], "error": 3e-2} | more
    return certified_stub.built(certified_stub.configured(motion, **axes), answer)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Datasets by the names of sweeps, and the contents of their page."""
    datasets, periods = stub.made_up(tmp_path_factory.mktemp("page"), configured())
    return datasets, page.build(datasets, periods, [certified("transverse", poisson=[0, 0.5])])


def entries(content, name):
    return [one for one in content["sweeps"] if one["name"] == name]


# Contents of the page


def test_maps_at_every_ratio_have_the_points_of_the_dataset(made):
    maps = entries(made[1], "transverse")
    assert [one["poisson"] for one in maps] == RATIOS
    for one in maps:
        part = made[0]["transverse"].sel(poisson=one["poisson"])
        part = part.transpose("amplitude", "velocity", ...)
        for key in ("mu_macro", "mu_macro_error"):
            assert np.array_equal(one["points"][key], part[key].values)
        # the static limit of a transverse oscillation is exact for Poisson's ratio 0 only
        labels = " ".join(limit["label"] for limit in one["limits"])
        assert ("exact limit for ν = 0" in labels) == (one["poisson"] > 0)
    assert [bool(one["periods"]["count"]) for one in maps] == [True, False, False]


def test_other_sweeps_are_lines_over_the_longest_axis(made):
    datasets, content = made
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


# Selection


def chosen(name):
    """JavaScript that selects a sweep in the list."""
    return f"element('sweeps').value = '{name}', element('sweeps').fire('change')"


def typed(field, text):
    return f"element('si-{field}').value = '{text}', element('si-{field}').fire('input')"


def picked(field, text):
    return f"element('si-{field}').value = '{text}', element('si-{field}').fire('change')"


def test_every_sweep_and_ratio_can_be_chosen(made):
    names, ready, *values = page_says(
        made[1],
        "element('sweeps').text",
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
    hidden, shown, run = values[1]
    assert (hidden, run) == (False, "The page has no periods of this map.")
    dataset = made[0]["along"].transpose("amplitude", "velocity", ...)
    assert np.array_equal(shown, dataset.mu_macro.values[:, 1:])  # without velocity 0
    assert values[3] == [True, 2 + len(entries(made[1], "still")[0]["limits"])]
    steady = made[0]["continuous_bore"].isel(velocity=1)
    assert values[6][0].startswith(f"mu_macro {float(steady.mu_macro):.5g} ± ")
    theory = float(paper.bore_forward(float(steady.velocity)))
    assert f"Eq 21 {theory:.5g}" in values[6][1] and "M_z,0" in values[6][1]
    assert values[9][:2] == [True, 0.5] and "Poisson's ratio 0.5" in values[9][2]


ASK = "element('ask').fire('click')"


def test_a_link_restores_the_state(made):
    before = page_says(
        made[1],
        chosen("bore"),
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


# Tables of friction


@pytest.mark.parametrize("poisson", [[0], [0, 0.5]])
def test_a_table_is_within_its_error_of_the_friction(made, poisson):
    dataset = certified("transverse", poisson=poisson, velocity=[0.01, 1], amplitude=[0, 2])
    rng = np.random.default_rng(3)
    ratios = rng.uniform(0, poisson[-1], 300)
    places = np.column_stack([10 ** rng.uniform(-2, 0, 300), rng.uniform(0, 2, 300), ratios])
    content = made[1] | {"certified": [contact_form.table(dataset)]}
    call = f"{places.tolist()}.map((place) => lookUp(NUMBERS.certified[0], ...place))"
    corners = [[0.01, 0, 0], [1, 2, poisson[-1]], [0.0099, 1, 0], [1, 2.1, 0], [0.1, 1, 0.6]]
    answers, ends = page_says(
        content, call, f"{corners}.map((place) => lookUp(NUMBERS.certified[0], ...place))"
    )
    for (velocity, amplitude, _), answer in zip(places, answers, strict=True):
        assert abs(answer["value"] - rises(velocity, amplitude)) <= answer["error"] < 0.04
    assert [one is None for one in ends] == [False, False, True, True, True]


# The form


def quantity(contents, name):
    return f"{contents[name]} {contents[f'{name}_unit']}".strip()


CASES = [
    ("transverse", "steel", "steel", "5", "10", "0.3", "10", "20", "0.3"),
    ("transverse", "PTFE", "rigid", "20", "1.5", "1.2", "0.4", "2", "30"),
    ("transverse", contact_form.OF_NUMBERS, "rigid", "1", "90", "0.05", "99", "150", "0.04"),
    ("bore", contact_form.OF_NUMBERS, contact_form.OF_NUMBERS, "8", "40", "0.6", "3", "5", "2"),
    ("bore", "aluminium", contact_form.OF_NUMBERS, "40", "2", "0.2", "50", "60", "9"),
]
NAMES = ("motion", "material", "counterbody", "radius", "load", "mu", "speed", "frequency")


def predicted(contents):
    """The prediction for the contents of the form, and its arguments."""
    names = "radius", "load", "mu", "speed", "frequency"
    arguments = {name: quantity(contents, name) for name in names}
    swing = {"transverse": "stroke", "bore": "angle"}[contents["motion"]]
    arguments["amplitude"] = quantity(contents, swing)
    if contents["material"] == contact_form.OF_NUMBERS:
        arguments |= {"young": quantity(contents, "young"), "nu": quantity(contents, "nu")}
    else:
        arguments["material"] = contents["material"]
    counter = contents["counterbody"]
    if counter == contact_form.OF_NUMBERS:
        counter = f"{quantity(contents, 'counter_young')}, {quantity(contents, 'counter_nu')}"
    return microslip.predict(
        contents["motion"], **arguments, counterbody=counter, tolerance=1e-1
    ), arguments | {"counterbody": counter}


def test_sizes_warnings_and_the_command_are_those_of_predict(made):
    contents = []
    for *values, swing in CASES:
        one = dict(zip(NAMES, values, strict=True)) | {"stroke": swing, "angle": swing}
        one |= {"young": "70", "nu": "0.2", "counter_young": "0.5", "counter_nu": "0.48"}
        units = {f"{name}_unit": field.units[0] for name, field in contact_form.FIELDS.items()}
        contents.append(one | units)
    calls = (
        f"[contactOf({one}), warningsOf(contactOf({one})), commandOf({one})]" for one in contents
    )
    answers = page_says(made[1], *calls)
    for one, (contact, texts, command) in zip(contents, answers, strict=True):
        truth, arguments = predicted(one)
        names = {"a": "contact_radius", "u_lim": "u_lim", "pressure": "largest_pressure"}
        names |= {name: name for name in ("velocity", "amplitude", "poisson", "indentation")}
        for ours, name in names.items():
            assert math.isclose(contact[ours], truth.values[name].value, rel_tol=1e-9), name
        told = [text.partition(": ") for text in texts]
        warnings = [text for kind, _, text in told if kind == "Warning"]
        assert [text[:20] for text in warnings] == [text[:20] for text in truth.warnings]
        assert [text for kind, _, text in told if kind != "Warning"] == list(truth.not_checked)
        program, verb, kind, *words = shlex.split(command)
        assert [program, verb, kind] == ["microslip", "predict", one["motion"]]
        options = dict(zip(words[::2], words[1::2], strict=True))
        assert options == {f"--{name}": text for name, text in arguments.items()}


def test_the_form_answers_and_marks_the_point(made):
    values = page_says(
        made[1],
        "element('contact-view').hidden",
        ASK,
        "[element('contact-view').hidden, element('point-view').hidden]",
        "STATE.contact",
        "[element('contact-value').text, element('contact-note').text]",
        "[element('map').data.at(-1).x, element('map').data.at(-1).y]",
        picked("motion", "bore"),
        "['young', 'stroke', 'angle'].map((id) => ROWS[id].hidden)",
        "[element('contact-value').text, STATE.map.name]",
        picked("motion", "transverse"),
        typed("speed", "1e9"),
        "element('contact-note').text",
        ASK,
        "[element('contact-view').hidden, element('map').data.at(-1).x, element('disc').drawn]",
    )
    assert values[0] is True and values[2] == [False, True]
    contact, (value, note), star = values[3:6]
    mu = rises(contact["velocity"], contact["amplitude"])
    assert float(value.split()[3]) == pytest.approx(0.3 * mu, abs=0.3 * 3e-2)
    assert value.endswith("instead of 3 N") and "from a certified map" in note
    assert star == [[contact["velocity"]], [contact["amplitude"]]]
    assert values[7] == [True, True, False]
    assert values[8] == ["The page has no certified map of bore.", "bore"]
    assert values[11].startswith("The map: velocity 0.001 to 10, amplitude 0 to 3")
    assert values[-1] == [True, [], True]


@pytest.mark.parametrize("text", ["1,5", "", "abc", "-3", "0", "1e400", "10 N"])
def test_bad_input_has_a_message_and_removes_the_answer(made, text):
    values = page_says(
        made[1],
        ASK,
        typed("load", text),
        "[element('contact-value').text, element('contact-value').className]",
        "[element('contact-facts').text, element('contact-command').text, STATE.contact]",
        typed("load", "15"),
        "element('contact-value').className",
    )
    value, kind = values[2]
    assert value == f"normal load = '{text} N': allowed is one number, such as 10, above 0"
    assert kind == "bad" and values[3] == ["", "", None] and values[5] == ""
