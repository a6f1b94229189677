"""Failures of methods: each one in a method that has it, and its absence in the shipped method."""

from functools import partial

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.contact.contact import FORWARD, energy_norm, forward_slip
from microslip.contact.path import make_path
from microslip.contact.reduced import slider_contact
from microslip.contact.ring_contact import RadialContact
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.methods import method_named
from microslip.periodic.methods.march import plain_march
from microslip.periodic.search import Goal, find_periodic_state
from microslip.periodic.static_limit import limit_on_a_line
from microslip.scene.named import Bore, Transverse
from microslip.scene.problem import Problem

# Ringing


@pytest.mark.parametrize(
    ("name", "ends"),
    [
        ("midpoint", pytest.approx([0.9, 1.1] * 8)),
        ("shipped", pytest.approx([1.0] * 16, abs=1e-12)),
    ],
)
def test_ringing_of_the_midpoint_rule_and_none_in_the_shipped_integrator(name, ends):
    """The elastic slider, which yields at 1, is displaced by 0.3 in each of 20 steps. The midpoint
    rule has the force at mid-step at the bound, so the forces at the ends alternate around it."""

    def displacement(phase):
        return 6.0 * phase, np.zeros_like(phase), np.zeros_like(phase)

    path = make_path(displacement, np.linspace(0.0, 1.0, 21), method_named(name).integrator)
    force = slider_contact().march(path, np.zeros((2, 1, 1)), 1e-12).forces[:, FORWARD]
    assert force[:4] == pytest.approx([0.0, 0.3, 0.6, 0.9])
    assert force[5:] == ends


@pytest.mark.parametrize("model", ["radial", "polar"])
def test_midpoint_tractions_leave_the_bound_and_shipped_ones_never_do(model):
    motion = Problem(Transverse(), 0.1, 1.0, 0.0)
    contact = contact_of(motion, model, Resolution(8, 4, 16))
    beyond = {}
    for name in ("midpoint", "shipped"):
        path = path_of(motion, contact, 16, method_named(name).integrator)
        state = contact.march(path, forward_slip(contact), 1e-10).state
        beyond[name] = np.max(np.hypot(*state) - contact.bound) / np.max(contact.bound)
    assert beyond["midpoint"] > 1e-3
    assert beyond["shipped"] <= 1e-12


# Stagnation


def test_stagnation_of_the_plain_march():
    """The transient of a slow motion takes thousands of periods, so the result is not converged."""
    plain = microslip.solve("transverse", 1e-4, 0.5, tolerance=1e-2, method="march")
    shipped = microslip.solve("transverse", 1e-4, 0.5, tolerance=1e-2)
    assert not plain.converged and "no periodic state" in plain.reason
    assert shipped.converged and shipped.periods < 20
    assert abs(plain.mu_macro - shipped.mu_macro) > 5e-2
    truth, limit = (microslip.solve("transverse", v, 0.5, tolerance=1e-4) for v in (1e-4, 0.0))
    assert abs(shipped.mu_macro - truth.mu_macro) <= shipped.mu_macro_error + truth.mu_macro_error
    assert truth.converged and limit.mu_macro < truth.mu_macro < limit.mu_macro + 0.02


# Loss of uniqueness


SHARES = (0.0, 0.5, 1.0)


def periodic_force(velocity, share, search):
    """Mean forward force of a periodic state, by the initial state of its search.

    The initial state is the traction of the oscillation, plus a share of the largest forward
    traction that is possible in addition.
    """
    motion = Problem(Transverse(), velocity, 0.5, 0.0)
    focus = Problem(Transverse(), velocity, 0.5).focus
    contact = RadialContact.resolved(16, focus)
    path = path_of(motion, contact, 32)
    room, oscillating, *_ = limit_on_a_line(
        contact, partial(motion.displacement, velocity=0.0), 1e-12
    )
    goal = Goal(1e-6, 1e-9, most_marches=1000)
    state = search(contact, path, oscillating + share * room, goal)
    assert state.converged
    return (path.weights @ state.march.forces)[FORWARD]


def test_loss_of_uniqueness_without_forward_motion():
    """Tractions in the stick zone never change. So each start has its own periodic state, with any
    friction up to the static limit."""
    limit = microslip.solve("transverse", 0.0, 0.5).mu_macro
    for share in SHARES:
        force = periodic_force(0.0, share, plain_march)
        assert force == pytest.approx(share * limit, abs=2e-3)


def test_any_forward_motion_makes_it_unique_again():
    none, half, full = (periodic_force(1e-2, share, find_periodic_state) for share in SHARES)
    assert none == pytest.approx(full, abs=1e-5) and half == pytest.approx(full, abs=1e-5)


# Methods agree with the shipped method where both converge

COMPILED = [
    pytest.param(name, marks=pytest.mark.long) for name in ("projected-gradient", "full-newton")
]
"""Methods with separate code, which takes seconds to compile."""


@pytest.mark.slow
@pytest.mark.parametrize("method", ["euler", "march", *COMPILED])
def test_methods_agree_with_what_ships(method):
    """At a fast point the difference is within the two error estimates."""
    for place in (("transverse", 1.0, 1.0), ("bore", 1.0, 1.0)):
        shipped = microslip.solve(*place, tolerance=1e-4)
        other = microslip.solve(*place, tolerance=1e-2, method=method)
        assert other.converged and other.method == method
        assert_agree(other, shipped)


@pytest.mark.parametrize("method", COMPILED)
def test_step_solvers_find_the_one_solution_of_a_step(method):
    """A step is a convex problem, so all solvers find the same tractions."""
    motion = Problem(Bore(), 0.2, 1.0, 0.3)
    contact = contact_of(motion, "polar", Resolution(6, 4, 8))
    path = path_of(motion, contact, 8)
    start = forward_slip(contact)
    one = contact.march(path, start, 1e-10).state
    parts = method_named(method)
    other = parts.dress(contact, **parts.parameters).march(path, start, 1e-10).state
    assert energy_norm(contact, one - other) < 1e-7


# Names


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("nowton", "full-newton"),
        ("projected-gradient:stap=1", "step"),
        ("projected-gradient:step", "projected-gradient:key=0.5"),
    ],
)
def test_method_names_are_refused_with_what_is_allowed(text, named):
    with pytest.raises(ValueError, match=named):
        microslip.solve("transverse", 0.1, 0.5, method=text)


# Methods that do not apply


@pytest.mark.parametrize(
    ("motion", "amplitude", "choice", "why"),
    [
        ("transverse", 0.5, {"method": "paper", "model": "cartesian"}, "cannot be refined"),
        ("transverse", 0.5, {"method": "paper"}, "a run of the model cartesian"),
        ("continuous-bore", None, {"method": "march"}, "nothing oscillates"),
        ("transverse", 0.5, {"method": "euler", "model": "dahl"}, "no step"),
        ("transverse", 0.5, {"method": "full-newton", "model": "cartesian"}, "too large"),
    ],
)
def test_methods_without_a_part_are_refused(motion, amplitude, choice, why):
    with pytest.raises(ValueError, match=f"method = '{choice['method']}': .*{why}"):
        microslip.solve(motion, 0.2, amplitude, **choice)


def test_a_step_that_fails_in_the_static_limit_is_not_a_result():
    result = microslip.solve("transverse", 0.0, 0.5, method="projected-gradient:step=4")
    assert not result.converged
    assert "step" in result.reason
    assert np.isnan(result.mu_macro)
