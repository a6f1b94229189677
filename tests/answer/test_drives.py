"""Contacts under a force or on a spring: limits, thresholds, and comparison of models."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from stubs.agreement import assert_agree

import microslip
from microslip.answer import force as under_force
from microslip.answer.answer import Answer, Estimate
from microslip.contact.path import EULER
from microslip.foundation.arguments import SMALLEST_STIFFNESS
from microslip.foundation.errors import InputError
from microslip.periodic.discretise import Resolution
from microslip.periodic.method import Method
from microslip.periodic.run import Settings
from microslip.periodic.simulate import simulate
from microslip.pressures.by_name import pressure_named
from microslip.scene.by_name import motion_named
from microslip.scene.drive import Force, Spring
from microslip.scene.problem import Problem
from microslip.theory import indenters, paper

PLACES = {
    "transverse": ("transverse", 0.1, 1.0),
    "bore": ("bore", 0.2, 1.0),
    "longitudinal": ("longitudinal", 0.1, 0.5),
    "loops": ("elliptic:forward_cycles=2", 0.2, 1.0),
}
ENDLESS = {"stiff": {"stiffness": 1e6}, "heavy": {"stiffness": 0.1, "mass": 1e6}}


@pytest.mark.slow
@pytest.mark.parametrize("body", [{"stiffness": 6e-4}, {"stiffness": 1.0, "mass": 0.3}])
def test_a_fast_contact_on_a_spring_has_the_friction_of_the_energy_bound(body):
    """The bound does not depend on Poisson's ratio, so that rings at ratio 0 can check it."""
    place = ("transverse", 9.24, 0.871)
    result = microslip.solve(*place, **body, poisson=0.3, tolerance=1e-2, time_limit=1.0)
    assert result.converged and result.model == "closed-form"
    assert result.mu_macro + result.mu_macro_error == pytest.approx(1.0, abs=1e-9)
    assert result.mu_macro_error < 0.5 / (9.24 / 0.871) ** 2
    marched = microslip.solve(*place, **body, model="radial", tolerance=1e-3)
    assert_agree(result, marched)


@pytest.mark.slow
@pytest.mark.parametrize("body", ENDLESS)
@pytest.mark.parametrize("place", PLACES)
def test_what_does_not_give_way_has_the_friction_of_the_velocity(place, body):
    at_velocity = microslip.solve(*PLACES[place])
    under_force = microslip.solve(*PLACES[place], **ENDLESS[body])
    assert_agree(at_velocity, under_force)
    assert abs(at_velocity.mu_macro - under_force.mu_macro) < 1.5e-3


@pytest.mark.slow
@pytest.mark.parametrize("place", ["transverse", pytest.param("bore", marks=pytest.mark.long)])
def test_the_softest_spring_is_a_force(place):
    """A very soft spring exerts a constant force, under which the contact has the same velocity.

    The velocity rises with the force, so the ends of the error interval of the force enclose it.
    """
    motion, velocity, amplitude = PLACES[place]
    soft = microslip.solve(motion, velocity, amplitude, stiffness=1e-5)
    assert soft.converged
    ends = soft.mu_macro - soft.mu_macro_error, soft.mu_macro + soft.mu_macro_error
    slow, fast = (microslip.solve(motion, amplitude=amplitude, force=force) for force in ends)
    assert slow.converged and fast.converged
    assert slow.velocity - slow.velocity_error <= velocity <= fast.velocity + fast.velocity_error
    assert fast.velocity - slow.velocity < 0.05 * velocity


@pytest.mark.slow
def test_a_fast_contact_on_the_softest_spring_is_solved():
    """The friction hardly rises with the velocity, so small forces cause large displacements.

    Under the mean force of the spring the contact has the velocity of the far end.
    """
    velocity, amplitude, tolerance = 3.0, 0.2, 2e-4
    soft = microslip.solve(
        "transverse", velocity, amplitude, stiffness=1e-5, tolerance=tolerance, most_work=1e9
    )
    assert soft.converged
    ends = soft.mu_macro - tolerance, soft.mu_macro + tolerance
    slow, fast = (microslip.solve("transverse", amplitude=amplitude, force=force) for force in ends)
    assert slow.velocity - slow.velocity_error < velocity < fast.velocity + fast.velocity_error


LIMITS = {
    "transverse": ("transverse", 0.5, "hertz", lambda: paper.static_limit_transverse(0.5)),
    "bore": ("bore", 1.0, "hertz", lambda: paper.static_limit_bore(1.0)),
    "a cone": (
        "transverse",
        0.5,
        "power:exponent=1",
        lambda: indenters.static_transverse(pressure_named("power:exponent=1"), 0.5),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LIMITS)
def test_the_threshold_is_the_static_limit(name):
    motion, amplitude, pressure, limit = LIMITS[name]
    limit = float(limit())
    below = microslip.solve(motion, amplitude=amplitude, force=limit - 1e-5, pressure=pressure)
    assert (below.velocity, below.velocity_error, below.converged) == (0.0, 0.0, True)
    assert below.mu_macro == limit - 1e-5
    above = microslip.solve(
        motion, amplitude=amplitude, force=limit + 0.08, pressure=pressure, tolerance=3e-4
    )
    assert above.converged
    assert above.velocity > 2.0 * above.velocity_error


@pytest.mark.parametrize("mass", [None, 1.0])
def test_a_contact_under_less_than_the_limit_comes_to_rest(mass):
    """A run from a moving start confirms the result that solve gives without a run."""
    limit = paper.static_limit_transverse(0.5)
    problem = Problem(motion_named("transverse"), 0.01, 0.5, 0.0)
    rest = moving_at(problem, Force(limit - 0.03, mass=mass or 0.0))
    assert abs(rest.values["velocity"]) < 1e-5
    moves = moving_at(problem, Force(limit + 0.05, mass=mass or 0.0))
    assert moves.values["velocity"] > 1e-3


def moving_at(problem, drive, cells=24, steps=64, method=None):
    settings = Settings() if method is None else Settings(method)
    driven, resolution = replace(problem, drive=drive), Resolution(cells, 1, steps)
    result = simulate(driven, "radial", resolution, 1e-5, settings=settings)
    assert result.converged
    return result


def test_a_force_next_to_the_limit_is_told_from_it_by_a_finer_limit():
    """The limit at Poisson's ratio 0.3 is at most 1e-3 below the closed form at ratio 0.

    So a force of 0.9975 is below it, by less than the tolerance.
    """
    limit = microslip.solve("transverse", 0.0, 1e-3).mu_macro
    assert limit > 0.9995
    result = microslip.solve(
        "transverse", amplitude=1e-3, force=0.9975, poisson=0.3, tolerance=1e-2
    )
    assert (result.velocity, result.velocity_error, result.converged) == (0.0, 0.0, True)


def test_a_limit_that_leaves_no_force_to_march_at_gives_no_velocity():
    """The force is within the error of the limit, and no run at a larger force is possible.

    Then the velocity is unknown.
    """
    limit = microslip.solve("transverse", 0.0, 1e-3, poisson=0.3)
    assert abs(limit.mu_macro - 0.9998) < limit.mu_macro_error
    result = microslip.solve(
        "transverse", amplitude=1e-3, force=0.9998, poisson=0.3, tolerance=1e-2
    )
    assert math.isnan(result.velocity) and result.velocity_error == math.inf
    assert not result.converged and "force threshold" in result.reason


def test_a_velocity_with_an_unsolved_step_and_a_larger_error_is_no_number(monkeypatch):
    def unsolved(request, *_, **__):
        velocity = {"velocity": Estimate(5.4, {"solver": 1e9}), "friction": Estimate(0.8)}
        return Answer(request.problem, {}, velocity, "a step was left unsolved")

    monkeypatch.setattr(under_force, "runs", unsolved)
    result = microslip.solve("transverse", amplitude=1.0, force=0.8)
    assert math.isnan(result.velocity) and result.velocity_error == math.inf
    assert (result.converged, result.reason) == (False, "a step was left unsolved")


def test_a_heavy_contact_that_oscillates_along_the_force_moves_from_its_static_limit_on():
    """Without mass it follows the oscillation, and only full friction moves it."""
    limit = paper.static_limit_longitudinal(0.5)
    heavy = {"amplitude": 0.5, "mass": 1e5}
    below = microslip.solve("longitudinal", force=limit - 0.03, **heavy)
    assert below.converged and below.velocity <= below.velocity_error
    above = microslip.solve("longitudinal", force=limit + 0.03, **heavy)
    assert above.converged and above.velocity > 3.0 * above.velocity_error
    light = microslip.solve("longitudinal", amplitude=0.5, force=0.99)
    assert (light.velocity, light.converged) == (0.0, True)


def test_without_mass_only_what_is_across_the_force_counts():
    """The body follows the forward part of the ellipse; the rest is the transverse motion."""
    loop = microslip.solve("elliptic:phase=37", amplitude=1.5, force=0.3)
    line = microslip.solve("transverse", amplitude=1.5, force=0.3)
    assert_agree(loop, line)


RISING = [(0.5, 0.75, 0.0244), (1.5, 0.30, 0.138), (1.5, 0.60, 0.399), (3.0, 0.30, 0.438)]


@pytest.mark.parametrize("force", [0.3, 0.7])
def test_large_transverse_amplitudes_are_those_of_a_rigid_contact(force):
    """The force P is the cosine of the slip direction: v = P |w| / sqrt(1 - P^2), mean |w| = 2/pi
    A."""
    rigid = 2.0 / np.pi * force / math.sqrt(1.0 - force**2)
    result = [microslip.solve("transverse", amplitude=a, force=force) for a in (50.0, 400.0)]
    left = [abs(one.velocity / one.amplitude - rigid) / rigid for one in result]
    assert all(one.converged for one in result)
    assert left[1] < 0.004 and left[1] < 0.4 * left[0]


@pytest.mark.long
def test_large_bore_amplitudes_are_those_of_a_rigid_contact():
    """Eq 21 holds at every instant for the ratio of velocity and rotation, whose mean is 2/pi."""
    steady = brentq(lambda v: paper.bore_forward(v) - 0.5, 0.1, 2.0)
    result = [microslip.solve("bore", amplitude=a, force=0.5) for a in (30.0, 200.0)]
    left = [abs(one.velocity - 2.0 / np.pi * steady) for one in result]
    assert all(one.converged for one in result)
    assert left[1] < 0.003 and left[1] < 0.5 * left[0]


def test_a_force_on_a_steady_bore_inverts_equation_21():
    result = microslip.solve("continuous-bore", force=0.6)
    assert paper.bore_forward(result.velocity) == pytest.approx(0.6, abs=1e-9)
    spring = microslip.solve("continuous-bore", 0.3, stiffness=0.1, mass=2.0)
    assert spring.mu_macro == microslip.solve("continuous-bore", 0.3).mu_macro


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "drive", "models"),
    [
        ("transverse", {"force": 0.5}, {"radial": 1e-3, "polar": 1e-3, "cartesian": 1e-2}),
        pytest.param(
            *("transverse", {"velocity": 0.1, "stiffness": 0.5}),
            {"radial": 1e-3, "polar": 1e-3, "cartesian": 1e-2},
            marks=pytest.mark.long,
        ),
        pytest.param(
            *("bore", {"force": 0.6}, {"polar": 1e-3, "cartesian": 2e-2}), marks=pytest.mark.long
        ),
    ],
)
def test_rings_angular_points_and_squares_agree(motion, drive, models):
    """models: tolerances by name."""
    one, *others = (
        microslip.solve(motion, amplitude=1.0, model=model, tolerance=tolerance, **drive)
        for model, tolerance in models.items()
    )
    for other in others:
        assert_agree(one, other)


@pytest.mark.parametrize(("amplitude", "force", "velocity"), RISING)
def test_a_force_moves_the_contact_faster_than_the_friction_of_a_velocity_says(
    amplitude, force, velocity
):
    """Values of an independent prototype with 20 to 24 rings, accurate to one percent."""
    result = microslip.solve("transverse", amplitude=amplitude, force=force, tolerance=1e-4)
    assert result.velocity == pytest.approx(velocity, rel=0.01)
    at_velocity = microslip.solve("transverse", result.velocity, amplitude)
    assert at_velocity.mu_macro - at_velocity.mu_macro_error > force


SPRINGS = {
    (0.1, 0.0): 0.498,
    (0.3, 0.0): 0.502,
    (1.0, 0.0): 0.509,
    (3.0, 0.0): 0.517,
    (10.0, 0.0): 0.523,
    (100.0, 0.0): 0.526,
    (0.1, 0.1): 0.486,
    (0.1, 1.0): 0.544,
    (0.1, 10.0): 0.529,
    (0.1, 100.0): 0.527,
}
"""Friction by stiffness and mass, of an independent prototype: backward Euler, 128 steps a
period."""


@pytest.mark.parametrize("body", SPRINGS)
def test_friction_through_a_spring_is_that_of_the_prototype(body):
    problem = Problem(motion_named("transverse"), 0.1, 1.0, 0.0)
    euler = Method("backward Euler", integrator=EULER)
    stiffness, mass = body
    result = moving_at(problem, Spring(stiffness=stiffness, mass=mass), method=euler)
    assert result.mu == pytest.approx(SPRINGS[body], rel=0.003)


# A period that begins without contact, and a body without memory


def springs_on_a_spring(velocity, amplitude, stiffness, count, steps):
    """Mean force over mean load of independent springs on a soft spring (exact at nu = 0).

    The spring at x can carry the overlap d - x^2 with the sphere.  The load d^(3/2) oscillates; it
    is 0 at the start, where the soft spring is relaxed.
    """
    widest = (1.0 + amplitude) ** (1.0 / 3.0)
    edges = np.linspace(0.0, widest, count + 1)
    x, width = 0.5 * (edges[1:] + edges[:-1]), 1.5 * np.diff(edges)
    phase = np.linspace(-0.5 * np.pi, 1.5 * np.pi, steps + 1)
    load = np.maximum(1.0 + amplitude * np.sin(phase), 0.0)
    stretch, place, force = np.zeros(count), velocity * phase[0], np.zeros(steps + 1)
    for k in range(1, steps + 1):
        overlap = np.maximum(load[k] ** (2.0 / 3.0) - x**2, 0.0)

        def stretch_at(step, k=k, stretch=stretch, overlap=overlap):
            return np.clip(stretch + step, -overlap, overlap)

        def imbalance(step, k=k, place=place, stretch_at=stretch_at):
            return stretch_at(step) @ width - stiffness * (velocity * phase[k] - place - step)

        step = brentq(imbalance, -10.0, 10.0, xtol=1e-12)
        stretch, place = stretch_at(step), place + step
        force[k] = stretch @ width
    return force[:-1].mean() / load[:-1].mean()


def test_a_soft_spring_pulls_a_contact_that_lifts_off():
    result = microslip.solve("normal", 0.4, 1.35, stiffness=0.05)
    expected = springs_on_a_spring(0.4, 1.35, 0.05, 400, 1000)  # 0.03288 with 1600 and 4000
    assert result.converged
    assert abs(result.mu_macro - expected) <= result.mu_macro_error


@pytest.mark.slow
def test_a_soft_spring_pulls_a_contact_that_lifts_off_and_oscillates_sideways():
    """With a small dashpot the state includes the body, and the force hardly changes."""
    place, dashpot = ("normal:lateral=0.9,phase=90", 0.15, 1.3), 1e-4
    free = microslip.solve(*place, stiffness=0.3)
    held = microslip.solve(*place, stiffness=0.3, damping=dashpot)
    assert_agree(free, held)
    # 0.05777 with 48 rings and 1024 steps of the plain march of reference_pull.py
    assert abs(free.mu_macro - 0.0577) <= free.mu_macro_error


CLOSE = [
    ("transverse", 0.9999, {}),
    ("elliptic:forward_cycles=2", -0.99999, {}),
    ("bore", 1.0 - 1e-12, {}),
    ("normal", 0.9999, {"mass": 1.0}),
]


@pytest.mark.parametrize(("motion", "force", "body"), CLOSE)
def test_a_force_next_to_full_friction_is_refused_before_anything_runs(motion, force, body):
    with pytest.raises(InputError, match=f"force = {force!r}: allowed is a force below 0.9999 "):
        microslip.solve(motion, amplitude=1.0, force=force, progress=fail, **body)


def fail(resolution):
    raise AssertionError("work has started")


def test_a_steady_rotation_is_refused_only_where_rounding_hides_its_velocity():
    with pytest.raises(InputError, match="force = .*: allowed is a force below 0.9999999 "):
        microslip.solve("continuous-bore", force=1.0 - 1e-9)
    result = microslip.solve("continuous-bore", force=1.0 - 1e-6)
    # 1 - 0.1 / v^2, the series of Eq 21 for fast sliding
    assert result.velocity == pytest.approx(np.sqrt(0.1e6), rel=1e-5)


def test_where_nothing_has_to_be_found_any_force_is_answered():
    assert microslip.solve("longitudinal", amplitude=0.5, force=0.99999).velocity == 0.0
    away = microslip.solve("normal", amplitude=0.5, force=0.99999)
    assert "runs away" in away.reason
    assert "runs away" in microslip.solve("transverse", amplitude=0.5, force=1.0).reason


@pytest.mark.filterwarnings("error")
def test_a_spring_softer_than_rounding_allows_is_refused():
    with pytest.raises(InputError, match="stiffness = 1e-300: allowed is a finite number of at"):
        microslip.solve("transverse", 0.1, 1.0, stiffness=1e-300)


@pytest.mark.slow
def test_the_softest_spring_allowed_has_the_friction_of_a_soft_one():
    soft = microslip.solve("transverse", 0.1, 1.0, stiffness=1e-3)
    softest = microslip.solve("transverse", 0.1, 1.0, stiffness=SMALLEST_STIFFNESS)
    assert_agree(soft, softest)


def test_a_fast_contact_is_where_its_friction_is_the_force():
    """Friction hardly rises there, so a small unbalanced force is a large error of the velocity."""
    place = {"amplitude": 15.0, "force": 0.93, "mass": 1.0}
    result, finer = (microslip.solve("elliptic", **place, tolerance=t) for t in (2e-3, 1e-4))
    assert_agree(result, finer)


def test_a_small_mass_that_moves_far_slower_than_a_contact_without_mass_is_solved():
    """The tolerance is relative to the resulting velocity, not to the initial estimate."""
    place = {"amplitude": 4.189, "force": 0.2761, "mass": 0.04953, "poisson": 0.3}
    motion, pressure = "elliptic:forward=0.5,phase=0,forward_cycles=2", "power:exponent=8"
    result, finer = (
        microslip.solve(motion, **place, pressure=pressure, tolerance=t) for t in (1e-3, 5e-4)
    )
    assert result.velocity_error <= 1e-3
    assert_agree(result, finer)


LIGHT = {
    "natural frequency 32": ({"amplitude": 2.356, "force": 0.8082, "mass": 0.001453}, 1.65908),
    "natural frequency 30": ({"amplitude": 1.906, "force": 0.7855, "mass": 0.00162}, 1.14432),
    "natural frequency 36": ({"amplitude": 0.8955, "force": 0.8108, "mass": 0.001146}, 0.38067),
}


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
@pytest.mark.parametrize(("place", "velocity"), LIGHT.values(), ids=LIGHT)
def test_steps_resolve_the_natural_oscillation_of_a_light_mass(place, velocity, tolerance):
    """The expected velocities come from runs with 3072 imposed steps in a period."""
    result = microslip.solve("zigzag", **place, tolerance=tolerance)
    assert result.converged
    assert result.velocity == pytest.approx(velocity, abs=result.velocity_error)


@pytest.mark.slow
def test_steps_resolve_a_light_mass_on_a_spring():
    """The expected friction comes from a run with 48 rings and 4056 imposed steps in a period."""
    body = {"stiffness": 0.3379, "mass": 0.001225}
    result = microslip.solve("zigzag", 0.948, 1.93, **body, pressure="punch")
    assert result.converged
    assert result.mu_macro == pytest.approx(0.773748, abs=result.mu_macro_error)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mass", "imposed"),
    [(1e-8, {}), (0.001453, {"cells": 12, "steps": 48})],
    ids=["free", "imposed"],
)
def test_a_mass_too_light_for_the_steps_is_not_converged(mass, imposed):
    result = microslip.solve(
        "zigzag", amplitude=2.356, force=0.8082, mass=mass, tolerance=1e-2, **imposed
    )
    assert not result.converged
    assert result.reason.startswith("mass too small")


def test_what_runs_away_says_so():
    for force in (1.0, 1.7):
        result = microslip.solve("transverse", amplitude=0.5, force=force)
        assert not result.converged and math.isnan(result.velocity)
        assert result.reason.startswith("runs away: ")
    light = microslip.solve("normal:lateral=1", amplitude=0.5, force=0.6)
    assert light.reason.startswith("runs away: without mass")


@pytest.mark.slow
def test_a_mass_holds_on_where_the_load_is_least():
    heavy = microslip.solve("normal:lateral=1", amplitude=0.5, force=0.6, mass=100.0)
    assert heavy.converged and heavy.velocity > 0.0


def test_the_error_of_the_static_limit_is_part_of_the_answer():
    """If it is uncertain whether the contact moves, the error interval of the velocity includes
    0."""
    limit = microslip.solve("transverse", 0.0, 0.5, model="radial")
    assert limit.mu_macro_error > 1e-6
    result = microslip.solve("transverse", amplitude=0.5, force=limit.mu_macro, model="radial")
    assert result.converged
    assert result.velocity - result.velocity_error <= 0.0 <= result.velocity
