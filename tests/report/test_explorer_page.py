"""The explorer's form for a real contact, its tables of friction, and links, in node."""

import math
import shlex

import numpy as np
import pytest
from stubs import certified_stub
from stubs import explorer_stub as stub
from stubs.in_node import needs_node, page_says

import microslip
from microslip.report.explorer import contact_form, page

pytestmark = [pytest.mark.slow, needs_node]


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
    """The contents of the page."""
    datasets, periods = stub.made_up(tmp_path_factory.mktemp("page"))
    return page.build(datasets, periods, [certified("transverse", poisson=[0, 0.5])])


ASK = "element('ask').fire('click')"


def typed(field, text):
    return f"element('si-{field}').value = '{text}', element('si-{field}').fire('input')"


def picked(field, text):
    return f"element('si-{field}').value = '{text}', element('si-{field}').fire('change')"


def test_a_link_restores_the_state(made):
    before = page_says(
        made,
        "element('sweeps').value = 'bore', element('sweeps').fire('change')",
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
        made, f"readLink('#{link}'), [linkOf(STATE), STATE.contact, element('si-load').value]"
    )
    assert values == [link, contact, "7.5"]
    (values,) = page_says(made, "readLink('#sweep=none&amplitude=x'), STATE.shown.name")
    assert values == "transverse"


# Tables of friction


@pytest.mark.parametrize("poisson", [[0], [0, 0.5]])
def test_a_table_is_within_its_error_of_the_friction(made, poisson):
    dataset = certified("transverse", poisson=poisson, velocity=[0.01, 1], amplitude=[0, 2])
    rng = np.random.default_rng(3)
    ratios = rng.uniform(0, poisson[-1], 300)
    places = np.column_stack([10 ** rng.uniform(-2, 0, 300), rng.uniform(0, 2, 300), ratios])
    content = made | {"certified": [contact_form.table(dataset)]}
    call = f"{places.tolist()}.map((place) => lookUp(NUMBERS.certified[0], ...place))"
    corners = [[0.01, 0, 0], [1, 2, poisson[-1]], [0.0099, 1, 0], [1, 2.1, 0], [0.1, 1, 0.6]]
    answers, ends = page_says(
        content, call, f"{corners}.map((place) => lookUp(NUMBERS.certified[0], ...place))"
    )
    for (velocity, amplitude, _), answer in zip(places, answers, strict=True):
        assert abs(answer["value"] - rises(velocity, amplitude)) <= answer["error"] < 0.04
    assert [one is None for one in ends] == [False, False, True, True, True]


# The form


CASES = [
    ("transverse", "steel", "steel", "5", "10", "0.3", "10", "20", "0.3"),
    ("transverse", "PTFE", "rigid", "20", "1.5", "1.2", "0.4", "2", "30"),
    ("transverse", contact_form.OF_NUMBERS, "rigid", "1", "90", "0.05", "99", "150", "0.04"),
    ("bore", contact_form.OF_NUMBERS, contact_form.OF_NUMBERS, "8", "40", "0.6", "3", "5", "2"),
    ("bore", "aluminium", contact_form.OF_NUMBERS, "40", "2", "0.2", "50", "60", "9"),
]
NAMES = ("motion", "material", "counterbody", "radius", "load", "mu", "speed", "frequency")


def test_sizes_and_warnings_are_those_of_the_command(made):
    contents = []
    for *values, swing in CASES:
        one = dict(zip(NAMES, values, strict=True)) | {"stroke": swing, "angle": swing}
        one |= {"young": "70", "nu": "0.2", "counter_young": "0.5", "counter_nu": "0.48"}
        units = {f"{name}_unit": field[2][0] for name, field in contact_form.FIELDS.items()}
        contents.append(one | units)
    calls = (
        f"[contactOf({one}), warningsOf(contactOf({one})), commandOf({one})]" for one in contents
    )
    for one, (contact, texts, command) in zip(contents, page_says(made, *calls), strict=True):
        program, verb, kind, *words = shlex.split(command)
        assert [program, verb, kind] == ["microslip", "predict", one["motion"]]
        options = {words[k].removeprefix("--"): words[k + 1] for k in range(0, len(words), 2)}
        assert options["load"] == f"{one['load']} N"
        truth = microslip.predict(kind, **options, tolerance=1e-1)
        names = {"a": "contact_radius", "u_lim": "u_lim", "pressure": "largest_pressure"}
        names |= {name: name for name in ("velocity", "amplitude", "poisson", "indentation")}
        for ours, name in names.items():
            assert math.isclose(contact[ours], truth.values[name].value, rel_tol=1e-9), name
        told = [text.partition(": ") for text in texts]
        warnings = [text for kind, _, text in told if kind == "Warning"]
        assert [text[:20] for text in warnings] == [text[:20] for text in truth.warnings]
        assert [text for kind, _, text in told if kind != "Warning"] == list(truth.not_checked)


def test_the_form_answers_and_marks_the_point(made):
    values = page_says(
        made,
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
        made,
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
