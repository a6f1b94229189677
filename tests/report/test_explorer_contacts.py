"""The form for a real contact: its answers, warnings and messages equal those of predict."""

import itertools
import math
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from stubs import certified_stub
from stubs.in_node import answers, needs_node

import microslip
from microslip.datasets.accessor import Map
from microslip.estimate.estimate import Estimate
from microslip.foundation.errors import InputError
from microslip.foundation.units import read
from microslip.report.explorer import certified, si_form
from microslip.si.materials import MATERIALS

pytestmark = [pytest.mark.slow, needs_node]
SCRIPTS = ("certified.js", "elliptic.js", "limits.js", "beyond.js", "contact.js")
ANSWER = "({ si, maps }, texts) => answerOf(si, maps, questionOf(si, texts))"
COUNT = 100
RELATIVE = 1e-12


def texts(motion, **changes):
    """Contents of the form: defaults, replaced by (text, unit) or a choice."""
    contents = dict(si_form.CHOSEN) | {"motion": motion}
    for name, field in si_form.FIELDS.items():
        contents |= {name: field.example, f"{name}_unit": field.units[0]}
    for name, value in changes.items():
        text, *unit = [value] if isinstance(value, str) else value
        contents |= {name: text} | ({f"{name}_unit": unit[0]} if unit else {})
    return contents


def arguments_of_predict(contents):
    """Arguments of microslip.predict for the contents of the form."""

    def quantity(name):
        return f"{contents[name]} {contents[f'{name}_unit']}".strip()

    arguments = {name: quantity(name) for name in ("radius", "load", "mu", "speed", "frequency")}
    arguments["amplitude"] = quantity(si_form.AMPLITUDE_OF[contents["motion"]])
    if contents["material"] == si_form.OF_NUMBERS:
        arguments |= {"young": quantity("young"), "nu": quantity("nu")}
    else:
        arguments["material"] = contents["material"]
    other = contents["counterbody"]
    if other == si_form.OF_NUMBERS:
        other = f"{quantity('counter_young')}, {quantity('counter_nu')}"
    return arguments | {"counterbody": other}


def random_contents(rng, motion, spread, *, at_ratio_0=False):
    """Random contents of the form, whose amplitude is near that of full slip.

    spread: range of the quantities in decades.
    """
    decades = rng.uniform(-spread, spread, 5)
    contents = {
        "radius": (f"{5 * 10 ** decades[0]:.6g}", "mm"),
        "load": (f"{10 * 10 ** decades[1]:.6g}", "N"),
        "mu": (f"{rng.uniform(0.05, 1.3):.4g}", ""),
        "speed": (f"{10 * 10 ** decades[2]:.6g}", "mm/s"),
        "frequency": (f"{20 * 10 ** decades[3]:.6g}", "kHz"),
        "stroke": (f"{0.3 * 10 ** decades[4]:.6g}", "um"),
        "angle": (f"{10 ** decades[4]:.6g}", "mrad"),
        "young": (f"{rng.uniform(2, 300):.4g}", "GPa"),
        "nu": (f"{0 if at_ratio_0 else rng.uniform(0, 0.5):.3g}", ""),
        "counter_young": (f"{rng.uniform(2, 300):.4g}", "GPa"),
        "counter_nu": (f"{0 if at_ratio_0 else rng.uniform(0, 0.5):.3g}", ""),
    }
    names = [si_form.OF_NUMBERS, *([] if at_ratio_0 else MATERIALS)]
    while True:
        contents["material"], contents["counterbody"] = rng.choice(names, 2).tolist()
        if (contents["material"], contents["counterbody"]) != ("rigid", "rigid"):
            return texts(motion, **contents)


def page(maps, questions):
    data = {"si": si_form.packed(), "maps": [certified.packed(one) for one in maps]}
    return answers(SCRIPTS, ANSWER, data, [[one] for one in questions])


def rises(velocity, amplitude):
    """A smooth made-up friction that rises with the velocity and is 1 without oscillation."""
    return (0.1 + velocity) / (0.1 + velocity + amplitude / (1 + amplitude))


def made_up(request):
    softer = 1 - 0.3 * float(request["poisson"])
    place = float(request["velocity"]), float(request["amplitude"]) / softer
    return certified_stub.record(request, rises(*place))


MAPS = {
    "one ratio": {"velocity": [1e-3, 1e2], "amplitude": [0, 10], "error": 5e-2},
    "all ratios": {"velocity": [1e-5, 1e2], "amplitude": [0, 10], "poisson": [0, 0.5]}
    | {"error": 0.1},
}


@cache
def map_of(motion, which):
    """A certified map with a made-up friction."""
    return certified_stub.built(certified_stub.configured(motion, **MAPS[which]), made_up)


@pytest.fixture
def predicted(monkeypatch):
    """A function that makes microslip.predict use a map instead of the solver."""

    def by(dataset):
        def solve(name, velocity, amplitude, *, poisson, **_):
            try:
                answer = Map(dataset).at(velocity, amplitude, poisson=poisson)
            except ValueError as error:
                pair, reason = (math.nan, math.inf), str(error)
            else:
                pair, reason = (float(answer.mu_macro), float(answer.mu_macro_error)), ""
            answer = dict(zip(("mu_macro", "mu_macro_error"), pair, strict=True))
            rest = {"amplitude": amplitude, "model": "other", "converged": False, "reason": reason}
            friction = Estimate(pair[0], {"model": pair[1]})
            return SimpleNamespace(**answer, friction=friction, **rest)

        monkeypatch.setattr("microslip.si.request.solve", solve)
        return microslip.predict

    return by


PLACES = {
    "velocity": "velocity",
    "amplitude": "amplitude",
    "poisson": "poisson",
    "contact_radius": "contact_radius_m",
    "indentation": "indentation_m",
    "largest_pressure": "largest_pressure_Pa",
    "u_lim": "u_lim_m",
    "still": "sliding_friction_N",
}


def compare(answer, truth):
    for name, field in PLACES.items():
        value = getattr(truth, field)
        assert answer[name] == pytest.approx(value, rel=RELATIVE, abs=1e-300), name
    assert answer["warnings"] == list(truth.warnings)
    assert answer["not_checked"] == list(truth.not_checked)
    if math.isnan(truth.mu_macro):
        assert answer["friction"] is None and answer["refused"]
        return
    for name, expected in (("value", truth.mu_macro), ("error", truth.mu_macro_error)):
        assert answer["friction"][name] == pytest.approx(expected, abs=1e-12, rel=0), name
    static = answer["static_friction"]
    if static is not None:
        assert static["value"] == pytest.approx(truth.mu_static, abs=1e-12, rel=0)


@pytest.mark.parametrize("motion", si_form.CHOICES)
@pytest.mark.parametrize(
    ("which", "spread", "at_ratio_0", "least_answered", "least_warnings"),
    [
        ("one ratio", 1.0, True, 0.9, 3),
        ("one ratio", 3.0, False, 0.0, 6),
        pytest.param("all ratios", 1.0, False, 0.7, 3, marks=pytest.mark.long),
    ],
)
def test_the_page_answers_as_predict_does_on_the_same_map(
    predicted, motion, which, spread, at_ratio_0, least_answered, least_warnings
):
    dataset, rng = map_of(motion, which), np.random.default_rng(21)
    predict = predicted(dataset)
    questions = [random_contents(rng, motion, spread, at_ratio_0=at_ratio_0) for _ in range(COUNT)]
    warned, answered, refused = set(), 0, 0
    for contents, answer in zip(questions, page([dataset], questions), strict=True):
        try:
            truth = predict(motion, **arguments_of_predict(contents))
        except InputError as error:
            # The sphere is too small for the contact, or the amplitude is too large.
            assert error.argument in ("radius", "amplitude") and "refused" in answer
            refused += 1
            continue
        answered += answer["friction"] is not None
        compare(answer, truth)
        warned |= {text.split(",")[0][:20] for text in truth.warnings}
    assert answered >= least_answered * COUNT and refused < 0.3 * COUNT
    assert len(warned) >= least_warnings


def test_at_another_poissons_ratio_the_answer_at_the_nearest_is_shown():
    coarse = map_of("bore", "one ratio")
    (answer,) = page([coarse], [texts("bore")])
    assert answer["friction"] is None
    assert (
        answer["refused"] == "poisson = 0.3: allowed is 0, the dataset's only one; "
        "microslip.solve computes any"
    )
    near = Map(coarse).at(answer["velocity"], answer["amplitude"])
    assert answer["near"]["poisson"] == 0
    assert answer["near"]["value"] == pytest.approx(float(near.mu_macro), abs=1e-12)


def test_a_motion_without_a_map_still_has_its_contact():
    (answer,) = page([map_of("bore", "one ratio")], [texts("transverse")])
    assert answer["refused"] == "this page holds no certified map of transverse"
    assert answer["contact_radius"] > 0


NO_NUMBERS = {
    "5,5": "read 5 and stopped at ',5', since decimals follow a point and thousands "
    "have no separator",
    "−5": "its minus is no plain one (-)",
    "": "nothing: allowed is one number, such as 5",
    "5 mm": "read 5 and stopped at 'mm'",
    "0x10": "read 0 and stopped at 'x10'",
    "1_0": "read 1 and stopped at '_0'",
    "five": "stopped at its beginning",
    "NaN": "stopped at its beginning",
    "Infinity": "stopped at its beginning",
    "0": "allowed is a finite value above 0",
    "-5": "allowed is a finite value above 0",
    "1e999": "allowed is a finite value above 0",
    "1e-400": "allowed is a finite value above 0",
}


def test_texts_that_are_not_numbers_are_refused_in_one_line():
    questions = [texts("transverse", radius=text) for text in NO_NUMBERS]
    for answer, (text, problem) in zip(page([], questions), NO_NUMBERS.items(), strict=True):
        assert answer["refused"].startswith("radius of the sphere = "), text
        assert problem in answer["refused"], text
        assert "\n" not in answer["refused"]


def test_impossible_contacts_are_refused():
    rigid = {"material": "rigid", "counterbody": "rigid"}
    numbers = {"material": si_form.OF_NUMBERS}
    cases = (
        (rigid, "the counterbody = rigid: allowed is an elastic one for a rigid body"),
        (numbers | {"nu": "0.6"}, "allowed is a finite value at least 0 and at most 0.5"),
        (
            {"mu": "11"},
            "μ without vibration = 11: allowed is a finite value above 0 and at most 10",
        ),
        ({"load": ("1e9", "N")}, "by Hertz's theory, which is for contacts much smaller"),
        ({"stroke": ("1", "m"), "radius": ("1", "um"), "load": ("1e-3", "uN")}, "at most 1e+06"),
    )
    page_answers = page([], [texts("transverse", **changes) for changes, _ in cases])
    for one, (_, problem) in zip(page_answers, cases, strict=True):
        assert problem in one["refused"]


def test_units_of_the_form_are_those_of_predict():
    """Every unit of every field has the same factor as in Python."""
    units = [(name, one) for name, field in si_form.FIELDS.items() for one in field.units]
    numbers = ["0.3", "1.7e-1", ".25", "+0.125", "00.31"]
    calls = [[name, text, unit] for (name, unit), text in itertools.product(units, numbers)]
    call = "(si, name, text, unit) => siValue(si.fields[name], text, unit)"
    values = answers(SCRIPTS, call, si_form.packed(), calls)
    for (name, text, unit), value in zip(calls, values, strict=True):
        truth = read(f"{text} {unit}", si_form.FIELDS[name].unit).si
        assert value == pytest.approx(truth, rel=4e-16, abs=0), (name, text, unit)


def test_numbers_in_messages_have_the_format_of_python():
    rng = np.random.default_rng(23)
    values = [*(10 ** rng.uniform(-12, 12, 300)), 0.125, 2.5, 1.125, 99.5, 9.995, 1e-5, 1e15, 0.0]
    calls = [[float(value), count] for value in values for count in (1, 2, 3, 6)]
    values = answers(SCRIPTS, "(_, value, count) => general(value, count)", None, calls)
    assert values == [f"{value:.{count}g}" for value, count in calls]
