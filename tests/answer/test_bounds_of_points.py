"""Limits of the work and of the time of a point, and interruption by Ctrl-C."""

import os
import signal
import threading

import pytest
from stubs.new_process import output

import microslip
from microslip.contact.contact import forward_slip
from microslip.periodic.discretise import Resolution, contact_of, path_of
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


def test_the_time_limit_ends_a_point_and_says_so():
    result = microslip.solve(*SLOW, tolerance=1e-6, time_limit=1e-9)
    assert not result.converged and result.exhausted == "time"
    assert result.reason.startswith("the time limit of 1e-09 s is over")
    assert microslip.solve("transverse", 0.3, 1.0, time_limit=1e9).converged
    calls, place = [], ("transverse", 0.5, 0.3)
    assert not microslip.shakedown(*place, time_limit=1e-9, progress=calls.append).converged
    assert len(calls) == 1  # the limit is checked inside a run to rest, too


@pytest.mark.long
def test_compilation_does_not_count(tmp_path):
    """The first point of a process compiles for longer than the limit, and marches far less."""
    point = "microslip.solve('transverse', 0.3, 1.0, time_limit=3.0)"
    environment = {"NUMBA_CACHE_DIR": str(tmp_path)}
    assert output(f"import microslip; print({point}.converged)", **environment) == "True\n"
    assert list(tmp_path.rglob("*.nbi"))


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
