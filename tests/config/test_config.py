"""Configurations: defaults, expanded axes, merged mappings, and the reference of all keys."""

import itertools
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from bad_input_tables.bad_configurations import GOOD

from microslip.config import load as config
from microslip.config.load import ConfigError, load
from microslip.contact.registry import MODELS
from microslip.motions.by_name import motion_named
from microslip.motions.problem import Problem
from microslip.solver import method_names

ROOT = Path(__file__).parents[2]
PAPER = {"sweeps": {"bore": {"velocity": [1], "amplitude": [1]}}}


def saved(folder, text):
    path = folder / "sweep.yaml"
    path.write_text(text)
    return path


def test_defaults_are_filled_in(tmp_path):
    result = load(saved(tmp_path, GOOD))
    assert result.results == "results"
    assert result.points_per_job == dict.fromkeys(result.sweeps, 50)
    sweep = result.sweeps["transverse"]
    assert (sweep.poisson, sweep.poisson_is_axis) == ((0.0,), False)
    assert (sweep.model, sweep.tolerance, sweep.cells, sweep.steps) == ("auto", 1e-3, None, None)
    assert result.histories["transients"]["velocity"] == 0.8
    assert result.sweeps["continuous_bore"].motion == "continuous-bore"
    assert result.extended == result.groups == result.drives == result.certified == {}


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
    """Keys beside << replace merged keys, also in a mapping that is merged again."""
    result = load(saved(tmp_path, MERGED))
    assert result.sweeps["bore"].velocity == (2.0,)
    assert result.sweeps["bore"].amplitude == (0.0, 1.0)
    assert result.extended["again"].velocity == (3.0,)
    assert result.extended["again"].poisson == result.sweeps["transverse"].poisson == (0.3,)


def test_a_sweep_may_have_its_own_number_of_points_in_a_job(tmp_path):
    text = GOOD.replace("  bore:", "    points_per_job: 7\n  bore:") + "points_per_job: 3\n"
    result = load(saved(tmp_path, text))
    assert result.points_per_job == dict.fromkeys(result.sweeps, 3) | {"transverse": 7}
    # Datasets do not depend on it.
    plain = load(saved(tmp_path, GOOD))
    assert result.of_sweep("transverse") == plain.of_sweep("transverse")


def test_axes_are_expanded_sorted_and_rounded_to_six_digits(tmp_path):
    text = GOOD.replace("[0.1, 1]", "[1, 0.30000000000000004, 0.1]")
    result = load(saved(tmp_path, text)).sweeps
    assert result["transverse"].velocity == (0.1, 0.3, 1.0)
    assert result["bore"].velocity == (0.1, 1.0, 10.0)
    assert result["bore"].amplitude == (0.0, 0.5, 1.0)
    thirds = {"log": {"start": 1, "stop": 10, "count": 4.0}}
    ratios = {"velocity": thirds, "amplitude": [1], "poisson": [0.3, 0]}
    sweep = config.from_mapping({"sweeps": {"bore": ratios}}).sweeps["bore"]
    assert sweep.velocity == (1.0, 2.15443, 4.64159, 10.0)
    assert (sweep.poisson, sweep.poisson_is_axis) == ((0.0, 0.3), True)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["config", "smoke", "poisson", "coarse"])
def test_shipped_configurations_are_good_and_filled_ones_are_the_same(name):
    settings, folders = config.read_yaml(ROOT / "config" / f"{name}.yaml"), [ROOT / "config"]
    result = config.from_mapping(settings, folders=folders)
    filled = config.with_defaults_and_paths(settings, folders=folders)
    assert config.from_mapping(json.loads(json.dumps(filled))) == result


def test_the_default_configuration_is_that_of_the_paper():
    result = load(ROOT / "config" / "config.yaml")
    for name, top in (("transverse", 3.0), ("bore", 5.0)):
        sweep = result.sweeps[name]
        assert len(sweep.velocity) == len(sweep.amplitude) == 25
        assert (sweep.amplitude[0], sweep.amplitude[-1]) == (0.0, top)
        assert (sweep.velocity[0], sweep.velocity[-1]) == (1e-3, 10.0)
    assert {0.1, 1.0, 10.0} <= set(result.sweeps["continuous_bore"].velocity)
    # It names all methods; the atlas cannot vary two of them.
    assert set(result.accuracy.methods) == set(method_names.names())
    assert set(result.stability.methods) == set(method_names.names()) - {"paper", "aspher"}
    # Its studies equal the defaults.
    plain = config.from_mapping(PAPER)
    for study in ("accuracy", "stability", "claims"):
        one, other = getattr(plain, study), getattr(result, study)
        methods = {"methods": other.methods} if hasattr(other, "methods") else {}
        assert one.model_copy(update=methods) == other
    assert plain.accuracy.methods == list(method_names.names())


@pytest.mark.parametrize("title", [r"$\frac{", "{} % # _ ^ &", "\N{GREEK SMALL LETTER NU} > 0"])
def test_titles_may_hold_what_is_markup_elsewhere(title):
    point = {"motion": "bore", "velocity": 1, "amplitude": 1}
    points = {"named": point | {"title": title}, title: point}
    result = config.from_mapping(PAPER | {"accuracy": {"points": points}}).accuracy.points
    assert result["named"].title == title in result


LINE = {"motion": "longitudinal", "group": "g", "velocity": [1], "amplitude": [1]}


@pytest.mark.parametrize("title", ["", "  ", "x" * 101, "two\nlines", "\x00", "\ud800", "\u2028"])
def test_titles_that_cannot_be_drawn_or_written_are_refused(title):
    point = {"motion": "bore", "velocity": 1, "amplitude": 1}
    for more, where in (
        ({"extended": {"a": LINE | {"title": title}}}, "extended.a.title"),
        ({"accuracy": {"points": {"p": point | {"title": title}}}}, "accuracy.points.p.title"),
        ({"accuracy": {"points": {title: point}}}, "accuracy.points"),
    ):
        with pytest.raises(ConfigError, match=rf"^configuration: {where}: .*allowed: text on"):
            config.from_mapping(PAPER | more, ask_solver=False)


def test_the_tables_of_all_keys_are_those_of_the_models(tmp_path):
    """config/README.md contains the output of docs/make_configuration_tables.py."""
    copy = tmp_path / "README.md"
    shutil.copy(ROOT / "config" / "README.md", copy)
    subprocess.run(
        [sys.executable, ROOT / "docs" / "make_configuration_tables.py", copy], check=True
    )
    assert copy.read_text() == (ROOT / "config" / "README.md").read_text()


def test_models_are_refused_here_exactly_where_the_solver_refuses_them():
    for sweep, motion in config.MOTION_OF_SWEEP.items():
        for model, poisson in itertools.product(MODELS, (0.0, 0.3)):
            settings = {"velocity": [1], "model": model, "poisson": poisson}
            if sweep != "continuous_bore":
                settings["amplitude"] = [1]
            try:
                config.from_mapping({"sweeps": {sweep: settings}})
                refused = False
            except ConfigError:
                refused = True
            problem = Problem(
                motion_named(motion), 1.0, settings.get("amplitude", [None])[0], poisson
            )
            assert refused == bool(MODELS[model].refuses(problem))


@pytest.mark.parametrize("model", ["auto", "polar", "cartesian", "rigid"])
@pytest.mark.parametrize("poisson", [0, 0.3])
def test_the_static_limit_goes_with_all_that_the_solver_takes_it_with(model, poisson):
    axes = {"velocity": [0, 1], "amplitude": [0.5], "poisson": poisson, "model": model}
    settings = {"sweeps": {"transverse": axes, "bore": axes}, "extended": {"line": LINE | axes}}
    assert [grid.velocity[0] for grid in config.from_mapping(settings).grids.values()] == [0, 0, 0]


def test_an_imposed_resolution_goes_without_a_tolerance():
    steady = {"velocity": [1], "tolerance": None, "cells": 8}
    sweeps = {"transverse": steady | {"amplitude": [1], "steps": 16}, "continuous_bore": steady}
    result = config.from_mapping({"sweeps": sweeps}).sweeps
    assert result["transverse"].tolerance is result["continuous_bore"].tolerance is None
