"""Limits of the work and of the time of a point, and interruption by Ctrl-C."""

import os
import signal
import threading
from unittest.mock import Mock

import numpy as np
import pytest
from stubs.new_process import output

import microslip
from microslip.answer import request
from microslip.contact import ring_contact
from microslip.contact.contact import forward_slip
from microslip.contact.registry import MODELS
from microslip.periodic.budget import Budget, Spent
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.simulate import Settings, simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

SLOW = ("transverse", 1e-9, 0.5)


@pytest.mark.slow
def test_a_point_that_would_take_hours_ends_as_not_converged():
    """The limit is checked inside a run: the first run alone would take ten times the work."""
    result = microslip.solve(*SLOW, tolerance=1e-6, most_work=5e5)
    assert not result.converged and result.exhausted == "work"
    assert result.reason.startswith("the work that the point may take, 5e+05, is spent")
    assert 5e5 < result.effort.work < 6e5  # at most one march more
    again = microslip.solve(*SLOW, tolerance=1e-6, most_work=5e5)
    assert again.effort == result.effort
    assert np.array_equal(again.mu_macro, result.mu_macro, equal_nan=True)


@pytest.mark.slow
def test_what_is_known_by_then_is_told():
    """The value before the limit is within its error of the value without a limit."""
    whole = microslip.solve("transverse", 0.02, 0.95, tolerance=1e-4)
    part = microslip.solve(
        "transverse", 0.02, 0.95, tolerance=1e-4, most_work=0.9 * whole.effort.work
    )
    assert whole.converged and not part.converged
    assert whole.mu_macro_error < part.mu_macro_error < 0.1
    assert abs(part.mu_macro - whole.mu_macro) <= part.mu_macro_error + whole.mu_macro_error
    assert f"{part.mu_macro_error:.1e}" in part.reason


@pytest.mark.parametrize("model", MODELS)
def test_every_point_has_a_bound(monkeypatch, model):
    """The default limit is finite and far above the work of this point."""
    budget = Mock(wraps=Budget)
    monkeypatch.setattr(request, "Budget", budget)
    result = microslip.solve("transverse", 0.3, 1.0, model=model, tolerance=0.1)
    most_work, time_limit = budget.call_args.args
    assert result.effort.work < 1e-2 * most_work < np.inf
    assert time_limit == np.inf


def test_every_march_counts():
    """Marches of searches, of the static limit and of steady motions count."""
    problem, resolution = Problem(motion_named("transverse"), 0.01, 0.5, 0.0), Resolution(8, 1, 16)
    budget = Budget()
    run = simulate(problem, "radial", resolution, 1e-6, settings=Settings(budget=budget))
    assert budget.taken.work >= run.effort.work > 0
    loop = Problem(motion_named("elliptic"), 0.0, 0.5, 0.0)
    for spent_at in (0, 100):
        with pytest.raises(Spent):
            bounded = Settings(budget=Budget(spent_at))
            simulate(loop, "radial", resolution, 1e-3, settings=bounded)
    with pytest.raises(Spent):
        steady, bounded = Problem(motion_named("continuous-bore"), 0.5, None, 0.0), Budget(10)
        simulate(steady, "polar", Resolution(4, 4, 1), 1e-3, settings=Settings(budget=bounded))


def test_the_time_limit_ends_a_point_and_says_so():
    result = microslip.solve(*SLOW, tolerance=1e-6, time_limit=1e-9)
    assert not result.converged and result.exhausted == "time"
    assert result.reason.startswith("the time limit of 1e-09 s is over")
    assert microslip.solve("transverse", 0.3, 1.0, time_limit=1e9).converged


@pytest.mark.long
def test_compilation_does_not_count(tmp_path):
    """The first point of a process compiles for longer than the limit, and marches far less."""
    point = "microslip.solve('transverse', 0.3, 1.0, time_limit=3.0)"
    environment = {"NUMBA_CACHE_DIR": str(tmp_path)}
    assert output(f"import microslip; print({point}.converged)", **environment) == "True\n"
    assert list(tmp_path.rglob("*.nbi"))


@pytest.mark.parametrize("name", ["most_work", "time_limit"])
@pytest.mark.parametrize("value", [0, -1.0, float("nan"), True, "1"])
def test_bad_bounds_are_refused(name, value):
    with pytest.raises(microslip.InputError, match=f"^{name} = "):
        microslip.solve("transverse", 0.3, 1.0, **{name: value})


# Ctrl-C


MARCHES = {
    "radial": ("transverse", "radial", Resolution(256, 1, 768)),
    "polar": ("bore", "polar", Resolution(128, 64, 768)),
    "cartesian": ("transverse-bore", "cartesian", Resolution(96, 1, 768)),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", MARCHES)
def test_ctrl_c_ends_a_march_that_would_take_minutes(name):
    """The march is one call of a compiled function, which takes minutes if it is not
    interrupted."""
    label, model, resolution = MARCHES[name]
    motion = Problem(motion_named(label), 0.01, 0.5, 0.0)
    contact = contact_of(motion, model, Resolution(4, 4, 2))
    contact.march(path_of(motion, contact, 2), forward_slip(contact), 1e-3)  # compiles
    contact = contact_of(motion, model, resolution)
    path, returned = path_of(motion, contact, resolution.steps), threading.Event()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            contact.march(path, forward_slip(contact), 1e-10)
            returned.set()
    finally:
        timer.join()
    assert not returned.is_set()


def test_a_march_is_done_again_where_the_program_goes_on_after_ctrl_c(monkeypatch):
    """With a signal handler that does not raise, the result is the same as without a signal."""
    motion = Problem(motion_named("transverse"), 0.1, 0.5, 0.0)
    contact = contact_of(motion, "radial", Resolution(4, 1, 4))
    path, state = path_of(motion, contact, 4), forward_slip(contact)
    expected, march, calls, heard = contact.march(path, state, 1e-8), ring_contact.march, [], []

    def broken_once(*arguments):
        calls.append(arguments)
        *rest, iterations = march(*arguments)
        return *rest, -1 if len(calls) == 1 else iterations

    monkeypatch.setattr(ring_contact, "march", broken_once)
    before = signal.signal(signal.SIGINT, lambda *_: heard.append(True))
    try:
        result = contact.march(path, state, 1e-8)
    finally:
        signal.signal(signal.SIGINT, before)
    assert np.array_equal(result.forces, expected.forces)
    assert len(calls) == 2 and heard == [True]
