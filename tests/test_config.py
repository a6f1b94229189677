"""Configurations: what is refused and how it is said, what is filled in and expanded."""

import itertools
import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest
import yaml

from microslip import config, methods, schemas
from microslip.config import ConfigError, load

ROOT = Path(__file__).parent.parent
GOOD = """
sweeps:
  transverse:
    velocity: [0.1, 1]
    amplitude: [0, 1]
  bore:
    velocity: {log: {start: 0.1, stop: 10, count: 3}}
    amplitude: {linear: {start: 0, stop: 1, count: 3}}
  continuous_bore:
    velocity: [1]
"""
TRANSVERSE = "sweeps: {transverse: {velocity: [0.1], amplitude: [1]%s}}"


def saved(folder, text):
    path = folder / "sweep.yaml"
    path.write_text(text)
    return path


def test_defaults_are_filled_in(tmp_path):
    found = load(saved(tmp_path, GOOD))
    assert (found.results, found.points_per_job) == ("results", 50)
    sweep = found.sweeps["transverse"]
    assert (sweep.poisson, sweep.poisson_is_axis) == ((0.0,), False)
    assert (sweep.model, sweep.tolerance, sweep.cells, sweep.steps) == ("auto", 1e-3, None, None)
    assert found.histories["transients"]["velocity"] == 0.8
    assert found.sweeps["continuous_bore"].scene == "continuous-bore"


def test_axes_are_expanded_sorted_and_rounded_to_six_digits(tmp_path):
    text = GOOD.replace("[0.1, 1]", "[1, 0.30000000000000004, 0.1]")
    found = load(saved(tmp_path, text)).sweeps
    assert found["transverse"].velocity == (0.1, 0.3, 1.0)
    assert found["bore"].velocity == (0.1, 1.0, 10.0)
    assert found["bore"].amplitude == (0.0, 0.5, 1.0)
    thirds = {"log": {"start": 1, "stop": 10, "count": 4}}
    bore = {"velocity": thirds, "amplitude": [1]}
    sweep = config.from_mapping({"sweeps": {"bore": bore}}).sweeps["bore"]
    assert sweep.velocity == (1.0, 2.15443, 4.64159, 10.0)


def test_a_list_of_poissons_ratios_is_an_axis(tmp_path):
    text = TRANSVERSE % ", poisson: [0.3, 0]"
    sweep = load(saved(tmp_path, text)).sweeps["transverse"]
    assert (sweep.poisson, sweep.poisson_is_axis) == ((0.0, 0.3), True)


@pytest.mark.parametrize("name", ["config", "smoke"])
def test_shipped_configurations_are_good(name):
    found = load(ROOT / "config" / f"{name}.yaml")
    assert list(found.sweeps) == ["transverse", "bore", "continuous_bore"]
    assert found.sweeps["transverse"].amplitude[0] == 0  # where mu_macro is 1


def test_the_studies_name_every_method_that_can_be_run():
    found = load(ROOT / "config" / "config.yaml")
    assert set(found.accuracy.methods) == set(methods.names())
    # Neither can be varied: the run of the paper comes with its own resolution, and another package
    # with its own march on squares.
    assert set(found.stability.methods) == set(methods.names()) - {"paper", "aspher"}


def test_the_studies_need_not_be_given():
    shipped = load(ROOT / "config" / "config.yaml")
    found = config.from_mapping({"sweeps": {"bore": {"velocity": [1], "amplitude": [1]}}})
    assert found.accuracy.methods == found.stability.methods == methods.names()
    assert replace(found.accuracy, methods=()) == replace(shipped.accuracy, methods=())
    assert replace(found.stability, methods=()) == replace(shipped.stability, methods=())
    assert found.accuracy.map_tolerance == (1e-2, 1e-3)


def test_points_of_a_study_have_numbers_and_titles():
    text = "{there: {scene: zigzag, velocity: 1, amplitude: 2}, steady: {scene: continuous-bore, "
    points = yaml.safe_load(text + "velocity: 3, poisson: 0.5, title: at rest}}")
    given = {
        "sweeps": {"bore": {"velocity": [1], "amplitude": [1]}},
        "accuracy": {"points": points},
    }
    found = config.from_mapping(given).accuracy.points
    assert found == {
        "there": config.StudyPoint("there", "zigzag", 1.0, 2.0, 0.0, "there"),
        "steady": config.StudyPoint("steady", "continuous-bore", 3.0, None, 0.5, "at rest"),
    }


def test_default_sweeps_are_those_of_the_paper():
    sweeps = load(ROOT / "config" / "config.yaml").sweeps
    for name, top in (("transverse", 3.0), ("bore", 5.0)):
        assert len(sweeps[name].velocity) == len(sweeps[name].amplitude) == 25
        assert sweeps[name].amplitude[-1] == top
        assert (sweeps[name].velocity[0], sweeps[name].velocity[-1]) == (1e-3, 10.0)
    assert {0.1, 1.0, 10.0} <= set(sweeps["continuous_bore"].velocity)


# Each case: what to replace in GOOD, by what, and the parts that the message must have.
BAD = {
    "unknown key at the top": ("sweeps:", "reslts: x\nsweeps:", ["reslts", "did you mean results"]),
    "unknown sweep": ("  bore:", "  bores:", ["sweeps.bores: unknown", "did you mean bore?"]),
    "unknown key in a sweep": ("    amplitude: [0, 1]", "    amplitud: [0, 1]", ["e.amplitud:"]),
    "amplitude where there is none": ("[1]", "[1]\n    amplitude: [1]", ["continuous_bore.amplit"]),
    "missing axis": ("    amplitude: [0, 1]\n", "", ["sweeps.transverse.amplitude: missing"]),
    "no sweeps": (GOOD, "results: here", ["sweeps: missing"]),
    "empty sweeps": (GOOD, "sweeps: {}", ["sweeps: {}", "transverse, bore, continuous_bore"]),
    "null for a sweep": ("continuous_bore:\n    velocity: [1]", "continuous_bore:", ["null"]),
    "negative amplitude": (
        "amplitude: [0, 1]",
        "amplitude: [0, -1]",
        ["e.amplitude[1]: -1", ">= 0"],
    ),
    "negative velocity": ("[0.1, 1]", "[-0.1, 1]", ["transverse.velocity[0]: -0.1", ">= 0"]),
    "text for a number": ("[0.1, 1]", "[0.1, fast]", ['velocity[1]: "fast" is text', "a number"]),
    "a quoted number": ("[0.1, 1]", "['0.1', 1]", ["velocity[0]", "without quotes: 0.1"]),
    "an exponent without a point": ("[0.1, 1]", "[1e-8, 1]", ["velocity[0]", "write 1.0e-8"]),
    "an exponent without a sign": ("[0.1, 1]", "[1.5e3, 1]", ["velocity[0]", "write 1.5e+3"]),
    "text for an axis": ("[0.1, 1]", "all", ["transverse.velocity", '"all"', "a list of"]),
    "a number for an axis": ("[0.1, 1]", "0.1", ["transverse.velocity: 0.1", "a list of"]),
    "not a number": ("[0.1, 1]", "[.nan, 1]", ["transverse.velocity[0]: nan", "finite"]),
    "infinite": ("[0.1, 1]", "[0.1, .inf]", ["transverse.velocity[1]: inf", "finite"]),
    "infinite in text": ("[0.1, 1]", "['inf']", ["transverse.velocity[0]", "finite"]),
    "huge": ("[0.1, 1]", "[0.1, 1.0e+9]", ["transverse.velocity[1]", "<= 1e+06"]),
    "empty axis": ("[0.1, 1]", "[]", ["transverse.velocity: []", "a list of"]),
    "empty spacing": ("[0.1, 1]", "{}", ["transverse.velocity: {}", "linear or log"]),
    "two spacings": (
        "{log: {start: 0.1, stop: 10, count: 3}}",
        "{log: {start: 0.1, stop: 10, count: 3}, linear: {start: 0, stop: 1, count: 2}}",
        ["bore.velocity", "linear or log"],
    ),
    "unknown spacing": ("{log:", "{logs:", ["bore.velocity.logs: unknown", "did you mean log?"]),
    "logarithm of 0": ("start: 0.1", "start: 0", ["bore.velocity.log.start: 0", "> 0"]),
    "stop before start": ("stop: 10", "stop: 0.01", ["bore.velocity.log.stop: 0.01", "above 0.1"]),
    "one coordinate": ("stop: 10, count: 3", "stop: 10, count: 1", ["log.count: 1", ">= 2"]),
    "half a coordinate": (
        "stop: 10, count: 3",
        "stop: 10, count: 2.5",
        ["log.count: 2.5", "whole"],
    ),
    "no count": ("stop: 10, count: 3", "stop: 10", ["bore.velocity.log.count: missing"]),
    "spacing finer than six digits": (
        "{start: 0, stop: 1, count: 3}",
        "{start: 1, stop: 1.000001, count: 9}",
        ["bore.amplitude", "occurs twice"],
    ),
    "duplicates": ("[0.1, 1]", "[0.1, 1, 0.1]", ["transverse.velocity: 0.1 occurs twice"]),
    "duplicates but for rounding": (
        "[0.1, 1]",
        "[0.3, 0.30000000000000004]",
        ["transverse.velocity: 0.3 occurs twice"],
    ),
    "a key twice": ("  bore:", "  transverse: {}\n  bore:", ["transverse occurs twice", "line 6"]),
    "a boolean for a number": ("[0.1, 1]", "[true, 1]", ["velocity[0]: true", "a number"]),
    "no folder": ("sweeps:", "results: ''\nsweeps:", ["results", "folder"]),
    "a pattern for a folder": (
        "sweeps:",
        "results: 'r{x}'\nsweeps:",
        ["results", "without braces"],
    ),
    "a number for a folder": ("sweeps:", "results: 5\nsweeps:", ["results: 5", "folder"]),
    "no points in a job": ("sweeps:", "points_per_job: 0\nsweeps:", ["points_per_job: 0", ">= 1"]),
    "half a point": ("sweeps:", "points_per_job: 1.5\nsweeps:", ["points_per_job", "whole number"]),
    "all points": ("sweeps:", "points_per_job: all\nsweeps:", ['points_per_job: "all" is text']),
    "poisson below 0": (
        "[1]",
        "[1]\n    poisson: -0.1",
        ["continuous_bore.poisson: -0.1", "<= 0.5"],
    ),
    "poisson above 0.5": (
        "[1]",
        "[1]\n    poisson: 0.6",
        ["continuous_bore.poisson: 0.6", "<= 0.5"],
    ),
    "poisson in a list": ("[1]", "[1]\n    poisson: [0, 2]", ["bore.poisson[1]: 2", "<= 0.5"]),
    "no poisson": ("[1]", "[1]\n    poisson: []", ["continuous_bore.poisson: []", "a list"]),
    "unknown model": ("[1]", "[1]\n    model: exact", ['model: "exact"', "auto, rigid"]),
    "model of another scene": (
        "[1]",
        "[1]\n    model: radial",
        ["model", "continuous-bore", "polar"],
    ),
    "static limit of a model": (
        "[0.1, 1]",
        "[0]\n    model: polar",
        ["transverse.velocity: 0", "model polar"],
    ),
    "static limit with poisson": (
        "[0.1, 1]",
        "[0]\n    poisson: 0.3",
        ["transverse.velocity: 0", "poisson 0 only"],
    ),
    "rings with poisson": (
        "[0.1, 1]",
        "[1]\n    model: radial\n    poisson: 0.3",
        ["transverse.poisson: 0.3", "radial"],
    ),
    "tolerance 0": ("[1]", "[1]\n    tolerance: 0", ["bore.tolerance: 0", ">= 1e-06"]),
    "tolerance as text": ("[1]", "[1]\n    tolerance: 1e-3", ["bore.tolerance", "write 1.0e-3"]),
    "odd cells": ("[1]", "[1]\n    cells: 7", ["continuous_bore.cells: 7", "even number"]),
    "unknown history": ("sweeps:", "histories: {bore: {}}\nsweeps:", ["histories.bore: unknown"]),
    "history at rest": (
        "sweeps:",
        "histories: {transients: {velocity: 0}}\nsweeps:",
        ["histories.transients.velocity: 0", "> 0"],
    ),
    "unknown study key": ("sweeps:", "accuracy: {point: {}}\nsweeps:", ["did you mean points?"]),
    "unknown method": (
        "sweeps:",
        "accuracy: {methods: [shipped, ful-newton]}\nsweeps:",
        ["accuracy.methods[1]", "'ful-newton'", "full-newton, "],
    ),
    "unknown number of a method": (
        "sweeps:",
        "stability: {methods: ['admm:penalt=1']}\nsweeps:",
        ["stability.methods[0]", "penalt", "penalty"],
    ),
    "number of a method that is none": (
        "sweeps:",
        "stability: {methods: ['admm:penalty=high']}\nsweeps:",
        ["stability.methods[0]", "admm:penalty=high"],
    ),
    "a method twice": (
        "sweeps:",
        "stability: {methods: [admm, admm]}\nsweeps:",
        ["stability.methods: admm occurs twice"],
    ),
    "one method without brackets": (
        "sweeps:",
        "accuracy: {methods: admm}\nsweeps:",
        ['accuracy.methods: "admm"', "a list of text or null"],
    ),
    "no methods": ("sweeps:", "accuracy: {methods: []}\nsweeps:", ["accuracy.methods: []", "list"]),
    "no points": ("sweeps:", "accuracy: {points: {}}\nsweeps:", ["accuracy.points: {}", "names"]),
    "point without a scene": (
        "sweeps:",
        "accuracy: {points: {a: {velocity: 1}}}\nsweeps:",
        ["accuracy.points.a.scene: missing"],
    ),
    "point of an unknown scene": (
        "sweeps:",
        "accuracy: {points: {a: {scene: bores, velocity: 1}}}\nsweeps:",
        ["accuracy.points.a.scene", '"bores"', "transverse, bore, "],
    ),
    "point at rest": (
        "sweeps:",
        "accuracy: {points: {a: {scene: bore, velocity: 0, amplitude: 1}}}\nsweeps:",
        ["accuracy.points.a.velocity: 0", "> 0"],
    ),
    "point without an amplitude": (
        "sweeps:",
        "accuracy: {points: {a: {scene: bore, velocity: 1}}}\nsweeps:",
        ["accuracy.points.a.amplitude: missing", "bore"],
    ),
    "point with an amplitude where there is none": (
        "sweeps:",
        "accuracy: {points: {a: {scene: continuous-bore, velocity: 1, amplitude: 1}}}\nsweeps:",
        ["accuracy.points.a.amplitude: 1", "continuous-bore has no amplitude"],
    ),
    "unknown key of a point": (
        "sweeps:",
        "accuracy: {points: {a: {scene: bore, velocity: 1, amplitud: 1}}}\nsweeps:",
        ["accuracy.points.a.amplitud", "did you mean amplitude?"],
    ),
    "too many levels": (
        "sweeps:",
        "accuracy: {levels: 7}\nsweeps:",
        ["accuracy.levels: 7", "<= 6"],
    ),
    "a map at rest": (
        "sweeps:",
        "accuracy: {map: {velocity: [0, 1]}}\nsweeps:",
        ["accuracy.map.velocity: 0", "> 0"],
    ),
    "a map of one row": (
        "sweeps:",
        "accuracy: {map: {amplitude_bore: [1]}}\nsweeps:",
        ["accuracy.map.amplitude_bore", "two numbers"],
    ),
    "a map without tolerances": (
        "sweeps:",
        "accuracy: {map: {tolerance: []}}\nsweeps:",
        ["accuracy.map.tolerance: []", "a list of a number"],
    ),
    "unknown block": (
        "sweeps:",
        "stability: {axes: [step]}\nsweeps:",
        ["stability.axes[0]", '"step"', "steps, slow-transverse"],
    ),
    "a block twice": (
        "sweeps:",
        "stability: {axes: [steps, steps]}\nsweeps:",
        ["stability.axes: steps occurs twice"],
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_configuration_gives_one_line_that_names_the_key(case, tmp_path):
    old, new, parts = BAD[case]
    assert old in GOOD
    path = saved(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(ConfigError) as caught:
        load(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    for part in parts:
        assert part in message


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (b"sweeps: [", "not valid YAML"),
        (b"", "is empty; allowed: keys and values"),
        (b"- 1\n- 2\n", "[1, 2] is not a mapping"),
        (b"\xff\xfe\xfa", "not text: byte 0xff; allowed: UTF-8"),
    ],
)
def test_a_file_that_is_no_configuration(content, part, tmp_path):
    path = tmp_path / "sweep.yaml"
    path.write_bytes(content)
    with pytest.raises(ConfigError, match=r"^[^\n]*$") as caught:
        load(path)
    assert part in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ConfigError, match="cannot be read"):
        load(tmp_path / "nothing.yaml")


def test_the_schema_is_valid_closed_and_describes_every_key():
    schema = schemas.schema()
    jsonschema.Draft202012Validator.check_schema(schema)

    def check(rule, where):
        for name, inner in rule.get("properties", {}).items():
            assert schemas._resolved(inner).get("description"), f"{where}.{name}"
        if "properties" in rule:
            assert rule["additionalProperties"] is False, where
        for name in ("properties", "$defs"):
            for key, inner in rule.get(name, {}).items():
                check(inner, f"{where}.{key}")

    check(schema, "schema")


def test_the_workflow_shows_the_same_schema():
    shown = ROOT / "workflow" / "schemas" / "config.schema.yaml"
    assert yaml.safe_load(shown.read_text()) == schemas.schema()


def test_models_are_refused_here_exactly_where_the_solver_refuses_them():
    from microslip.models import MODELS
    from microslip.scenes import scene_named

    assert schemas.schema()["$defs"]["model"]["enum"] == ["auto", *MODELS]
    for sweep, scene in config.SCENE_OF_SWEEP.items():
        for model, poisson in itertools.product(MODELS, (0.0, 0.3)):
            given = {"velocity": [1], "model": model, "poisson": poisson}
            if sweep != "continuous_bore":
                given["amplitude"] = [1]
            try:
                config.from_mapping({"sweeps": {sweep: given}})
                refused = False
            except ConfigError:
                refused = True
            assert refused == bool(MODELS[model].refuses(scene_named(scene), poisson))


def test_settings_of_a_sweep_are_plain_json(tmp_path):
    found = load(saved(tmp_path, GOOD)).of_sweep("continuous_bore")
    assert set(found["histories"]) == {"field", "transients"}
    assert json.loads(json.dumps(found))["sweep"]["velocity"] == [1.0]
