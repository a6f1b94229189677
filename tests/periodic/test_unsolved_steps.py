"""Unsolved steps increase the error, prevent convergence, or raise an error."""

from copy import copy

import numpy as np
import pytest

import microslip
from microslip.answer import period
from microslip.contact.modes import PolarContact
from microslip.contact.ring_contact import RadialContact
from microslip.foundation.errors import SolverError
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem
from microslip.theory import paper

LOOSE = 5e-2
"""Tolerance of every step in these tests, a force over mu F_z."""
RINGS = 5e-4
"""Error of the limit on 32 rings with solved steps."""


@pytest.fixture
def loose_steps(monkeypatch):
    """Contacts that solve their steps to the tolerance LOOSE only."""

    def loosen(contact):
        march = contact.march

        def loosely(self, path, state, tolerance, *others, **settings):
            return march(self, path, state, LOOSE, *others, **settings)

        monkeypatch.setattr(contact, "march", loosely)

    loosen(RadialContact)
    loosen(PolarContact)


@pytest.mark.parametrize("amplitude", [0.2, 0.8])
def test_the_static_limit_on_a_line_includes_the_residual_of_its_steps(amplitude, loose_steps):
    problem = Problem(motion_named("transverse"), 0.0, amplitude, 0.0)
    run = simulate(problem, "radial", Resolution(32, 2, 1), 1e-5)
    assert not run.converged and "unsolved" in run.reason
    error = abs(run.mu - paper.static_limit_transverse(amplitude))
    assert RINGS < error <= run.residual + RINGS


def test_the_static_limit_on_a_loop_does_not_converge(loose_steps):
    problem = Problem(motion_named("elliptic"), 0.0, 0.5, 0.0)
    run = simulate(problem, "radial", Resolution(12, 2, 16), 1e-4)
    assert not run.converged and run.residual > 1e-4


def test_histories_and_traction_fields_fail(loose_steps):
    with pytest.raises(SolverError, match="a step was left unsolved: residual"):
        microslip.history("transverse", 0.1, 1.0, cells=8, steps=32, periods=1)
    with pytest.raises(SolverError, match="a step was left unsolved"):
        microslip.traction_field("continuous-bore", 0.3, cells=8)


def test_a_period_does_not_converge_where_only_its_last_march_is_unsolved(monkeypatch):
    """The steps of the search are solved, those of the last march are not."""

    def loose(*place, contact_of=period.contact_of):
        contact = copy(contact_of(*place))
        contact.march = lambda path, state, _: type(contact).march(contact, path, state, LOOSE)
        return contact

    monkeypatch.setattr(period, "contact_of", loose)
    result = microslip.period("transverse", 0.1, 1.0, cells=8, angles=4, steps=32)
    assert not result.converged and "unsolved" in result.reason
    assert np.isfinite(result.mu_macro)


@pytest.mark.slow
def test_a_shakedown_does_not_converge(loose_steps):
    result = microslip.shakedown("transverse", 0.5, 0.2, tolerance=3e-2)
    assert not result.converged and "unsolved" in result.reason
