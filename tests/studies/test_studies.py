"""Studies: ladders, requests, measured times, fronts and exponents."""

import json
import math
import platform
from dataclasses import fields
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from stubs.studies_stub import asked, configured
from stubs.sweep_stub import Solver

import microslip
from microslip.adaptive import single_run
from microslip.adaptive.choice import choose_model
from microslip.config.settings import Sweep
from microslip.contact.contact import StepFailure
from microslip.contact.registry import MODELS
from microslip.foundation.canonical import canonical_json
from microslip.foundation.errors import SolverError
from microslip.motions.by_name import MOTIONS, motion_named
from microslip.motions.problem import Problem
from microslip.solver.methods import paper
from microslip.studies import ladders, registry
from microslip.studies import requests as study_requests
from microslip.studies.accuracy import accuracy_cost, fronts
from microslip.studies.requests import Point
from microslip.studies.stability import stability
from microslip.sweeps import batch, evaluate
from microslip.sweeps import request as requests_of

# Ladders


@pytest.mark.parametrize("poisson", [0.0, 0.3])
@pytest.mark.parametrize("motion", [name for name, one in MOTIONS.items() if not fields(one)])
def test_models_apply_here_exactly_where_the_solver_lets_them(motion, poisson):
    applicable = {m for m in MODELS if not single_run.applies(motion, poisson, m, "shipped")}
    assert set(ladders.models_of(motion, poisson)) == applicable
    assert ladders.exact_model(motion, poisson) == choose_model(
        Problem(motion_named(motion), 1.0, None if motion == "continuous-bore" else 1.0, poisson)
    )


@pytest.mark.parametrize("model", MODELS)
def test_ladders_climb_in_all_directions_at_once_and_tighten(model):
    rungs = ladders.ladder(model, "shipped", 6)
    assert [k for k, _, _ in rungs] == list(range(len(rungs)))
    levels = np.array([level for _, level, _ in rungs])
    assert ((np.diff(levels, axis=0) > 0) | (levels[1:] == 1)).all()
    assert (levels[:, 2] % 2 == 0).all()
    assert (np.diff([tolerance for *_, tolerance in rungs]) < 0).all()
    assert ladders.ladder(model, "shipped", 2) == rungs[:2]


def test_other_methods_climb_less_high_on_the_model_that_auto_takes():
    for motion, model, count in (("transverse", "radial", 5), ("bore", "polar", 4)):
        for method in ("full-newton", "projected-gradient:step=3"):
            assert ladders.models_for(method, motion, 0.0) == [model]
            assert len(ladders.ladder(model, method, 6)) == count
    assert ladders.models_for("shipped", "bore", 0.3) == ["rigid", "polar", "cartesian"]
    assert ladders.models_for("paper", "bore", 0.0) == ["cartesian"]
    ((_, level, _),) = ladders.ladder("cartesian", "paper", 6)
    assert level.cells == 32


# Requests


def test_references_are_ordinary_points_and_tight():
    study = configured().accuracy
    request = accuracy_cost.truth(study.points["mid"])
    sweep_of_it = {"velocity": [0.1], "amplitude": [0.5], "tolerance": 1e-6}
    (point,) = requests_of.points_of(Sweep(motion="transverse", **sweep_of_it)).requests
    assert request == point
    assert accuracy_cost.truth(Point("transverse", 0.1, 0.5, 0.5))["tolerance"] == "3e-5"
    on_map = accuracy_cost.map_truth(study, study.points["mid"])
    assert on_map["tolerance"] == "0.0001"


@pytest.mark.parametrize("study", ["accuracy", "stability"])
def test_requests_are_plain_and_named_apart(study):
    requests = [json.loads(text) for text in asked(study, configured())]
    names = {requests_of.key_of(request) for request in requests}
    assert len(names) == len({canonical_json(request) for request in requests})
    for request in requests:
        assert requests_of.label(request)
        for name in ("velocity", "tolerance"):
            assert isinstance(request.get(name, ""), str)


@pytest.mark.parametrize("study", ["accuracy", "stability"])
def test_another_method_adds_jobs_and_changes_none(study):
    def cuts(methods):
        changed = {"methods": methods}
        pieces = registry.pieces(study, configured(changed, changed).studies[study])
        return {canonical_json(piece) for piece in pieces}

    before, after = cuts(["shipped", "euler"]), cuts(["shipped", "march", "euler"])
    assert before < after
    assert all('"method":"march"' in piece for piece in after - before)


def test_what_takes_long_starts_first():
    long, short = accuracy_cost.pieces(configured({"levels": 6}).accuracy)
    early = [request for piece in long for request in piece]
    assert {request["kind"] for request in early} == {"point", "trial"}
    assert all(r["cells"] >= 64 for r in early if r["kind"] == "trial")
    assert all(len(piece) == 1 for piece in long if piece[0]["kind"] == "point")
    later = [request for piece in short for request in piece]
    assert not [r for r in later if r.get("model") == "cartesian" and r.get("cells", 0) >= 64]


# Blocks of the atlas


def test_blocks_have_names_that_the_configuration_knows():
    names = [axis.name for axis in stability.AXES]
    assert configured(stability={"axes": names}).stability.axes == tuple(names)
    study = configured(stability={"axes": ["steps", "poisson"]}).stability
    assert [axis.name for axis in stability.axes(study)] == ["steps", "poisson"]
    everything = configured(stability={"axes": None}).stability
    assert stability.axes(everything) == list(stability.AXES)


@pytest.mark.slow
def test_cases_can_be_asked():
    for axis, value, overrides in stability.cases(configured(stability={"axes": None}).stability):
        request = stability.probe(configured().stability, "shipped", axis, value, overrides)
        assert MOTIONS[request["motion"]].periodic
        assert request["amplitude"] is not None
        for name in ("cells", "steps"):
            assert request[name] is None or request[name] % 2 == 0
        if not axis.parameters:
            assert value in overrides.values()
        reference = stability.reference(configured().stability, overrides)
        assert (reference["cells"], reference["steps"]) == (None, None)
        assert {k: reference[k] for k in ("motion", "velocity", "amplitude", "poisson")} == {
            k: request[k] for k in ("motion", "velocity", "amplitude", "poisson")
        }


def test_numbers_of_a_method_are_varied_in_that_method_only():
    study = configured(stability={"axes": ["step-length"]}).stability
    values = {
        method: [
            None if request is None else request["method"]
            for case in stability.cases(study)
            for request in [stability.probe(study, method, *case)]
        ]
        for method in ("shipped", "projected-gradient", "euler")
    }
    assert values["shipped"] == ["shipped"] * 7
    assert values["euler"] == [None] * 7
    assert values["projected-gradient"][0] == "projected-gradient:step=0.25"
    assert values["projected-gradient"][-1] == "projected-gradient:step=4"


def test_methods_have_the_numbers_that_blocks_vary():
    from microslip.solver.method_names import check

    for axis in stability.AXES:
        for method, parameter in axis.parameters:
            check(f"{method}:{parameter}=1")


# Results and their times


class Clock:
    """CPU clock that advances by the given seconds at each call of `run`."""

    def __init__(self, monkeypatch, *seconds):
        self.now, self.calls, self.seconds = 0.0, 0, seconds
        monkeypatch.setattr(evaluate.time, "process_time", lambda: self.now)

    def run(self):
        self.now += self.seconds[min(self.calls, len(self.seconds) - 1)]
        self.calls += 1
        return {"call": self.calls}


def test_a_time_is_the_median_after_a_first_call(monkeypatch):
    clock = Clock(monkeypatch, 4.0, 0.3, 0.1, 0.2, 0.1, 5.0)
    result, seconds = evaluate.timed(clock.run, 5)
    assert result == {"call": 1}
    assert (clock.calls, seconds) == (6, pytest.approx(0.2))


@pytest.mark.parametrize("kind", ["trial", "choice"])
def test_times_say_on_which_computer_they_were_measured(monkeypatch, kind):
    Trials(monkeypatch)
    study = configured().accuracy
    request = {
        "trial": trial_request(),
        "choice": study_requests.choice(study.points["mid"], 1e-3, 1),
    }[kind]
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "3")
    machine = evaluate.computed(request)["machine"]
    assert machine["host"] == platform.node()
    assert machine["threads"] == 3
    listed = Path("/proc/cpuinfo")
    if listed.exists() and "model name" in listed.read_text():
        assert machine["cpu"] in " ".join(listed.read_text().split())


def test_times_of_another_cpu_have_other_keys_and_points_do_not(monkeypatch):
    def keys_of(cpu):
        monkeypatch.setattr(study_requests, "cpu_model", lambda: cpu)
        pieces = registry.pieces("accuracy", configured().accuracy)
        requests = [request for piece in pieces for request in piece]
        return {
            timed: {requests_of.key_of(r) for r in requests if (r["kind"] != "point") is timed}
            for timed in (True, False)
        }

    one, other = keys_of("AMD EPYC 7B13"), keys_of("Intel Xeon 8481C")
    assert one[True].isdisjoint(other[True])
    assert one[False] == other[False]


@pytest.mark.parametrize("seconds", [1e-2, 1e-3, 1e-5])
def test_short_runs_are_timed_together(monkeypatch, seconds):
    clock = Clock(monkeypatch, seconds)
    assert evaluate.timed(clock.run, 3)[1] == pytest.approx(seconds)
    assert clock.now >= 3 * evaluate.SHORTEST
    assert clock.now < 3 * evaluate.LONG_ENOUGH


class Trials(Solver):
    """Stub of the solver and single_run. The error of a trial is 1/cells^2; march never applies."""

    def __init__(self, monkeypatch, **settings):
        super().__init__(monkeypatch, **settings)
        self.asked = []
        for name in ("applies", "run_trial"):
            monkeypatch.setattr(f"microslip.adaptive.single_run.{name}", getattr(self, name))

    def applies(self, motion, poisson, model, method, pressure="hertz"):
        return "not here" if method == "march" else ""

    def run_trial(self, motion, velocity, amplitude, **settings):
        self.asked.append(settings)
        assert isinstance(settings["steps"], int)
        mu = velocity / (1 + velocity + (amplitude or 0)) + 1 / settings["cells"] ** 2
        work = np.int64(settings["cells"] * settings["angles"] * settings["steps"])
        return {"mu_macro": mu, "converged": True, "reason": "", "effort": work, "unknowns": 4}


def trial_request(**changes):
    study = configured().accuracy
    requests = [r for _, r in accuracy_cost.trials(study, study.points["mid"])]
    (request,) = [r for r in requests if r.get("method") == "euler" and r["cells"] == 8]
    return request | changes


def test_a_trial_is_run_as_asked_and_timed(monkeypatch):
    stub = Trials(monkeypatch)
    record, _ = batch.computed(trial_request())
    assert record["result"]["mu_macro"] == pytest.approx(0.1 / 1.6 + 1 / 64)
    assert record["result"]["seconds"] >= 0
    assert record["result"]["applies"] is True
    assert stub.asked[0] == {
        "poisson": 0.0,
        "model": "radial",
        "method": "euler",
        "cells": 8,
        "angles": 1,
        "steps": 32,
        "tolerance": pytest.approx(3e-5 / 2**1.5),
    }


def test_what_does_not_apply_is_not_run(monkeypatch):
    stub = Trials(monkeypatch)
    result = evaluate.computed(trial_request(method="march"))
    assert result == {"applies": False, "converged": False, "reason": "not here"}
    request = stability.probe(
        configured().stability, "march", stability.AXES[0], 8, stability.AXES[0].cases[0][1]
    )
    assert evaluate.computed(request)["applies"] is False
    assert not stub.asked
    assert not stub.calls


@pytest.mark.parametrize("error", [SolverError("no"), StepFailure("diverged")])
def test_a_method_that_fails_is_data(monkeypatch, error):
    Trials(monkeypatch)
    fail = Mock(side_effect=error)
    monkeypatch.setattr("microslip.adaptive.single_run.run_trial", fail)
    monkeypatch.setattr("microslip.solve", fail)
    probe = stability.probe(
        configured().stability, "projected-gradient", *stability.cases(configured().stability)[0]
    )
    for request in (trial_request(), probe):
        result = evaluate.computed(request)
        assert result["converged"] is False
        assert result["reason"] == f"{type(error).__name__}: {error}"


def test_probes_hand_on_the_method_and_the_resolution(monkeypatch):
    Trials(monkeypatch)
    fields = {"mu_macro": math.nan, "solve_time_s": 1.0}
    solve = Mock(return_value=SimpleNamespace(to_dict=lambda: fields))
    monkeypatch.setattr("microslip.solve", solve)
    study = configured(stability={"axes": ["steps"]}).stability
    result = evaluate.computed(stability.probe(study, "euler", *stability.cases(study)[2]))
    settings = {
        "poisson": 0.0,
        "model": "auto",
        "method": "euler",
        "tolerance": 1e-3,
        "cells": None,
        "steps": 32,
        "most_work": study_requests.MOST_WORK,
    }
    assert solve.call_args.kwargs.items() >= settings.items()
    assert result == {"applies": True, "mu_macro": None}


# Fronts, cheapest trials, exponents

NUMBERS = st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0, math.nan])


@given(st.lists(st.tuples(NUMBERS, NUMBERS), max_size=12))
def test_a_front_is_what_nothing_beats(pairs):
    def beaten(cost, error):
        return any(
            c <= cost and e <= error and (c < cost or e < error)
            for c, e in pairs
            if not math.isnan(c + e)
        )

    expected = [not math.isnan(c + e) and not beaten(c, e) for c, e in pairs]
    costs, errors = [c for c, _ in pairs], [e for _, e in pairs]
    assert list(fronts.on_front(costs, errors)) == expected


def test_a_rung_is_as_good_as_the_worst_of_it_and_the_finer_ones():
    models = ["mdr"] * 3 + ["radial"] * 3
    error = [0.001, 0.02, 0.01, 0.1, 0.001, 0.01]
    confirmed = fronts.confirmed(models, error, "radial")
    assert list(confirmed) == [0.02, 0.02, math.inf, 0.1, 0.01, 0.01]
    assert list(fronts.confirmed(["slider"], [0.0], "radial")) == [math.inf]


def test_the_cheapest_is_within_the_tolerance():
    cost, error = [1.0, 2.0, 3.0, math.nan], [0.1, 0.01, 0.001, 0.0]
    for tolerance, place in {1.0: 0, 0.1: 0, 0.05: 1, 0.01: 1, 0.005: 2, 1e-4: None}.items():
        assert fronts.cheapest(cost, error, tolerance) == place
    assert fronts.cheapest([1.0], [math.nan], 1.0) is None
    assert fronts.cheapest([1.2, 1.0, 3.0], [0.0, 0.0, 0.0], 1.0) == 0  # equally cheap, and coarser
    assert fronts.cheapest([], [], 1.0) is None


# Under a pressure

CONE = "power:exponent=1"


def test_a_trial_and_patches_take_the_pressure_that_is_asked_for(monkeypatch):
    """A cone has a higher pressure in the middle than a sphere, so its friction differs."""
    place = {"motion": "transverse", "velocity": "0.1", "amplitude": "0.8", "poisson": "0"}
    how = {"model": "radial", "method": "shipped", "cells": 8, "angles": 4, "steps": 16}
    trial_of = place | how | {"kind": "run", "tolerance": "1e-4"}
    sphere, cone = evaluate.computed(trial_of), evaluate.computed(trial_of | {"pressure": CONE})
    assert sphere["converged"] and cone["converged"]
    settings_of = {"cells": 8, "steps": 16, "tolerance": None, "pressure": CONE}
    certified = microslip.solve("transverse", 0.1, 0.8, **settings_of)
    assert cone["mu_macro"] == pytest.approx(certified.mu_macro, abs=1e-4)
    assert abs(cone["mu_macro"] - sphere["mu_macro"]) > 1e-3
    timed = evaluate.computed(trial_of | {"pressure": CONE, "kind": "trial", "repeats": 1})
    assert timed["mu_macro"] == cone["mu_macro"]
    sizes = {"kind": "patches", "cells": 8, "angles": 4, "steps": 16}
    sphere, cone = (evaluate.computed(place | sizes | more) for more in ({}, {"pressure": CONE}))
    assert cone["converged"] and cone["moment_share"] != sphere["moment_share"]


def test_the_papers_run_is_under_the_pressure_that_is_asked_for(monkeypatch):
    """The friction bounds of the squares are the loads of the pressure."""
    from microslip.pressures.by_name import pressure_named

    class Seen(Exception):
        pass

    def march(contact, path, state, tolerance):
        raise Seen(contact.bound * contact.widths.prod())

    monkeypatch.setattr("microslip.contact.squares.CartesianContact.march", march)
    for name in ("hertz", CONE):
        with pytest.raises(Seen) as caught:
            single_run.run_trial(
                "transverse", 0.1, 0.8, poisson=0.0, model="cartesian", method="paper",
                cells=32, angles=1, steps=100, tolerance=1e-3, pressure=name,
            )  # fmt: skip
        loads = pressure_named(name).cell_loads(paper.CELLS)
        assert np.array_equal(caught.value.args[0], loads)
