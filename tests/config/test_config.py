"""Configurations: what is refused and how it is said, what is filled in and expanded."""

import itertools
import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest
import yaml
from bad_input_tables.bad_configurations import GOOD

from microslip.config import load as config
from microslip.config import schema as schemas
from microslip.config.load import ConfigError, load
from microslip.solver import method_names

ROOT = Path(__file__).parents[2]
TRANSVERSE = "sweeps: {transverse: {velocity: [0.1], amplitude: [1]%s}}"


def saved(folder, text):
    path = folder / "sweep.yaml"
    path.write_text(text)
    return path


def test_defaults_are_filled_in(tmp_path):
    found = load(saved(tmp_path, GOOD))
    assert found.results == "results"
    assert found.points_per_job == dict.fromkeys(found.sweeps, 50)
    sweep = found.sweeps["transverse"]
    assert (sweep.poisson, sweep.poisson_is_axis) == ((0.0,), False)
    assert (sweep.model, sweep.tolerance, sweep.cells, sweep.steps) == ("auto", 1e-3, None, None)
    assert found.histories["transients"]["velocity"] == 0.8
    assert found.sweeps["continuous_bore"].motion == "continuous-bore"


def test_a_byte_order_mark_and_line_ends_of_windows_do_no_harm(tmp_path):
    plain = load(saved(tmp_path, GOOD))
    path = tmp_path / "windows.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load(path) == plain


MERGED = """
sweeps:
  transverse: &slow
    velocity: [0.1, 1]
    amplitude: [0, 1]
    poisson: 0.3
  bore: &faster
    <<: *slow
    velocity: [2]
  continuous_bore: {velocity: [1]}
extended:
  again: {<<: *faster, velocity: [3], motion: bore, group: loops}
"""


def test_mappings_are_merged_as_yaml_says(tmp_path):
    """Keys beside << replace what is merged, in a mapping that is merged again, too."""
    found = load(saved(tmp_path, MERGED))
    assert found.sweeps["bore"].velocity == (2.0,)
    assert found.sweeps["bore"].amplitude == (0.0, 1.0)
    assert found.extended["again"].velocity == (3.0,)
    assert found.extended["again"].poisson == found.sweeps["transverse"].poisson == (0.3,)


def test_a_sweep_may_have_its_own_number_of_points_in_a_job(tmp_path):
    text = GOOD.replace("  bore:", "    points_per_job: 7\n  bore:") + "points_per_job: 3\n"
    found = load(saved(tmp_path, text))
    assert found.points_per_job == dict.fromkeys(found.sweeps, 3) | {"transverse": 7}
    # What decides who computes a point is no part of what a dataset depends on.
    plain = load(saved(tmp_path, GOOD))
    assert found.of_sweep("transverse") == plain.of_sweep("transverse")


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


@pytest.mark.slow
@pytest.mark.parametrize("name", ["config", "smoke"])
def test_shipped_configurations_are_good(name):
    found = load(ROOT / "config" / f"{name}.yaml")
    assert list(found.sweeps) == ["transverse", "bore", "continuous_bore"]
    assert found.sweeps["transverse"].amplitude[0] == 0  # where mu_macro is 1


def test_the_studies_name_every_method_that_can_be_run():
    found = load(ROOT / "config" / "config.yaml")
    assert set(found.accuracy.methods) == set(method_names.names())
    # Neither can be varied: the run of the paper comes with its own resolution, and another package
    # with its own march on squares.
    assert set(found.stability.methods) == set(method_names.names()) - {"paper", "aspher"}


def test_the_studies_need_not_be_given():
    shipped = load(ROOT / "config" / "config.yaml")
    found = config.from_mapping({"sweeps": {"bore": {"velocity": [1], "amplitude": [1]}}})
    assert found.accuracy.methods == found.stability.methods == method_names.names()
    assert replace(found.accuracy, methods=()) == replace(shipped.accuracy, methods=())
    assert replace(found.stability, methods=()) == replace(shipped.stability, methods=())
    assert found.accuracy.map_tolerance == (1e-2, 1e-3)
    assert found.claims == shipped.claims


def test_points_of_a_study_have_numbers_and_titles():
    text = "{there: {motion: zigzag, velocity: 1, amplitude: 2}, steady: {motion: continuous-bore, "
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


@pytest.mark.parametrize(
    "title",
    [
        "costs $5",
        r"$\frac{",
        r"\frac{1}{2}",
        "{} % # _ ^ &",
        "\N{GREEK SMALL LETTER NU} > 0",
        "$",
        "x" * 100,
    ],
)
def test_titles_may_hold_what_is_markup_elsewhere(title):
    """They are drawn as they stand, see test_plot_groups."""
    sweep = {
        "motion": "longitudinal",
        "group": "g",
        "velocity": [1],
        "amplitude": [1],
        "title": title,
    }
    point = {"motion": "bore", "velocity": 1, "amplitude": 1}
    given = {
        "sweeps": {"bore": {"velocity": [1], "amplitude": [1]}},
        "extended": {"a": sweep},
        "accuracy": {"points": {"named": point | {"title": title}, title: point}},
    }
    found = config.from_mapping(given, ask_solver=False)
    assert found.extended["a"].title == title
    assert [point.title for point in found.accuracy.points.values()] == [title, title]


@pytest.mark.parametrize(
    "title", ["", "  ", "x" * 101, "two\nlines", "a\tb", "\x00", "\ud800", "\u2028"]
)
def test_titles_that_cannot_be_drawn_or_written_are_refused_before_anything_is_computed(title):
    sweep = {
        "motion": "longitudinal",
        "group": "g",
        "velocity": [1],
        "amplitude": [1],
        "title": title,
    }
    point = {"motion": "bore", "velocity": 1, "amplitude": 1}
    for more, where in (
        ({"extended": {"a": sweep}}, "extended.a.title"),
        ({"accuracy": {"points": {"p": point | {"title": title}}}}, "accuracy.points.p.title"),
        ({"accuracy": {"points": {title: point}}}, "accuracy.points"),
    ):
        given = {"sweeps": {"bore": {"velocity": [1], "amplitude": [1]}}} | more
        with pytest.raises(
            ConfigError, match=rf"^configuration: {where}: .*allowed: text on"
        ) as found:
            config.from_mapping(given, ask_solver=False)
        assert "\n" not in str(found.value)


def test_default_sweeps_are_those_of_the_paper():
    sweeps = load(ROOT / "config" / "config.yaml").sweeps
    for name, top in (("transverse", 3.0), ("bore", 5.0)):
        assert len(sweeps[name].velocity) == len(sweeps[name].amplitude) == 25
        assert sweeps[name].amplitude[-1] == top
        assert (sweeps[name].velocity[0], sweeps[name].velocity[-1]) == (1e-3, 10.0)
    assert {0.1, 1.0, 10.0} <= set(sweeps["continuous_bore"].velocity)


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
    from microslip.models.registry import MODELS
    from microslip.motions.by_name import motion_named
    from microslip.motions.problem import Problem

    assert schemas.schema()["$defs"]["model"]["enum"] == ["auto", *MODELS]
    for sweep, motion in config.MOTION_OF_SWEEP.items():
        for model, poisson in itertools.product(MODELS, (0.0, 0.3)):
            given = {"velocity": [1], "model": model, "poisson": poisson}
            if sweep != "continuous_bore":
                given["amplitude"] = [1]
            try:
                config.from_mapping({"sweeps": {sweep: given}})
                refused = False
            except ConfigError:
                refused = True
            assert refused == bool(
                MODELS[model].refuses(
                    Problem(motion_named(motion), 1.0, given.get("amplitude", [None])[0], poisson)
                )
            )


def test_settings_of_a_sweep_are_plain_json(tmp_path):
    found = load(saved(tmp_path, GOOD)).of_sweep("continuous_bore")
    assert set(found["histories"]) == {"field", "transients"}
    assert json.loads(json.dumps(found))["sweep"]["velocity"] == [1.0]


@pytest.mark.parametrize("model", ["auto", "polar", "cartesian", "rigid"])
@pytest.mark.parametrize("poisson", [0, 0.3])
def test_the_static_limit_goes_with_all_that_the_solver_takes_it_with(model, poisson):
    """The solver refuses none of these, so neither does a configuration, under either key."""
    axes = {"velocity": [0, 1], "amplitude": [0.5], "poisson": poisson, "model": model}
    loaded = config.from_mapping(
        {
            "sweeps": {"transverse": axes, "bore": axes},
            "extended": {"line": {**axes, "motion": "longitudinal", "group": "g"}},
        }
    )
    assert [grid.velocity[0] for grid in loaded.grids.values()] == [0, 0, 0]


@pytest.mark.parametrize(
    ("name", "given", "missing"),
    [
        ("transverse", {"amplitude": [1]}, "cells and steps"),
        ("transverse", {"amplitude": [1], "cells": 8}, "steps"),
        ("continuous_bore", {}, "cells"),
    ],
)
def test_no_tolerance_goes_with_an_imposed_resolution_alone(name, given, missing):
    axes = {"velocity": [1], "tolerance": None, **given}
    with pytest.raises(ConfigError, match=f"{name}.tolerance: null .* {missing} imposed"):
        config.from_mapping({"sweeps": {name: axes}})
    imposed = {"cells": 8} | ({"steps": 16} if name == "transverse" else {})
    grid = config.from_mapping({"sweeps": {name: axes | imposed}}).sweeps[name]
    assert grid.tolerance is None
