"""Oscillating normal load: independent springs, closed forms and limits."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.contact.reduced import mdr_contact
from microslip.contact.ring_contact import RadialContact
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Problem
from microslip.theory import hertz, paper

ALONE = [
    ("normal", 0.003, 0.9),
    ("normal", 0.3, 1.5),
    ("normal", 0.63, 1.01),
    ("normal:indentation=1", 0.3, 0.8),
    ("normal:normal_cycles=3", 0.5, 0.7),
]
ALONG = [
    ("normal:forward=1,phase=60", 0.1, 0.7),
    ("normal:forward=0.5,phase=180,indentation=1", 0.02, 1.3),
    ("normal:forward=0.8,forward_cycles=2,phase=30", 0.2, 0.6),
]


def marched_springs(motion, velocity, amplitude, count, periods=8):
    """Mean force over mean load of independent springs with friction, marched in small steps.  The
    friction bound of the spring at x is d - x^2, the overlap with the flat."""
    motion = motion_named(motion)
    widest = np.sqrt(motion.deepest(amplitude, HERTZ))
    edges = widest * np.sqrt(np.linspace(0.0, 1.0, count + 1))
    x, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    phase = np.linspace(-np.pi / 2, 1.5 * np.pi, 10 * count + 1)
    ahead, _, _ = motion.displacement(phase, velocity, amplitude, 0.0)
    overlap = np.maximum(motion.depth(phase, amplitude, HERTZ)[:, None] - x**2, 0.0)
    stretch, force = overlap[0], np.empty(len(phase))
    for _ in range(periods):
        force[0] = stretch @ width
        for k in range(1, len(phase)):
            stretch = np.clip(stretch + ahead[k] - ahead[k - 1], -overlap[k], overlap[k])
            force[k] = stretch @ width
    return np.trapezoid(force, phase) / np.trapezoid(overlap @ width, phase)


def run(motion, velocity, amplitude, model, cells, steps, angles=1):
    problem = Problem(motion_named(motion), velocity, amplitude, 0.0)
    return simulate(problem, model, Resolution(cells, angles, steps), 1e-7)


@pytest.mark.parametrize("place", ALONE, ids=str)
def test_the_closed_form_is_that_of_springs_marched_one_by_one(place):
    motion, velocity, amplitude = place
    exact, _ = motion_named(motion).closed_form(velocity, amplitude, HERTZ)
    coarse, fine = (marched_springs(*place, count, periods=2) for count in (100, 200))
    assert abs(fine - exact) < 1e-3
    assert 2.0 * fine - coarse == pytest.approx(exact, abs=1e-4)  # their error is of first order


@pytest.mark.parametrize("model", ["mdr", "radial"])
@pytest.mark.parametrize("place", ALONE, ids=str)
def test_springs_and_rings_agree_with_the_closed_form(place, model):
    motion, velocity, amplitude = place
    answer = microslip.solve(*place, model=model)
    assert answer.converged
    exact, energy = motion_named(motion).closed_form(velocity, amplitude, HERTZ)
    assert abs(answer.mu_macro - exact) < 1e-3
    assert abs(answer.dissipated_energy - energy) <= answer.dissipated_energy_error


@pytest.mark.parametrize("place", [("normal", 0.3, 1.5), ("normal:indentation=1", 0.3, 0.8)])
def test_rings_join_a_growing_contact_in_the_middle_of_a_step_on_average(place):
    """Joining at its end would leave errors of 6e-4 to 9e-4."""
    exact, _ = motion_named(place[0]).closed_form(*place[1:], HERTZ)
    for model in ("mdr", "radial"):
        assert run(*place, model, 32, 128).mu == pytest.approx(exact, abs=4e-4)


@pytest.mark.slow
@pytest.mark.parametrize("place", ALONG, ids=str)
def test_rings_agree_with_springs_along_one_line(place):
    """Springs are exact for motion along one line, also under an oscillating load."""
    coarse, fine = (marched_springs(*place, count) for count in (100, 200))
    for model in ("mdr", "radial"):
        answer = microslip.solve(*place, model=model)
        assert answer.converged
        assert answer.mu_macro == pytest.approx(2.0 * fine - coarse, abs=1.2e-3)


@pytest.mark.parametrize("build", [RadialContact.resolved, mdr_contact])
def test_a_contact_that_grows_keeps_load_and_stiffness(build):
    """At the reference depth the bounds do not change.  At another depth, load and stiffness (2 G*
    times the radius) are those of Hertz."""
    contact = build(12, 0.6)
    same = contact.at_indentation(1.0, 1.0)
    assert same.bound == pytest.approx(contact.bound, rel=1e-9)
    wide = contact.at_indentation(1.69, 0.5)
    depths = np.linspace(0.0, 1.69, 30)
    assert wide.bounds(depths) @ wide.weight == pytest.approx(HERTZ.total(depths), abs=1e-12)
    assert wide.bound @ wide.weight == pytest.approx(0.5**1.5)
    stuck = np.linalg.solve(wide.influence, np.ones(12)) @ wide.weight
    assert stuck == pytest.approx(1.3 * HERTZ.stiffness, rel=0.03)


@pytest.mark.parametrize(
    ("motion", "settings", "message"),
    [
        ("normal:load=0", {}, "allowed is load or indentation above 0"),
        ("normal:load=0.5,indentation=1", {}, "allowed is no load beside an indentation"),
        ("normal:lateral=2", {}, "lateral = 2: allowed is a share in 0..1"),
        ("normal:angle=2", {}, "angle = 2: allowed is a share in 0..1"),
        ("normal:normal_cycles=0.5", {}, "normal_cycles = 0.5: allowed is a whole number"),
        *(
            ("normal", {"model": model}, f"model = '{model}': .* constant normal load")
            for model in ("rigid", "slider", "dahl", "cartesian")
        ),
        (
            *("normal:angle=1,lateral=1", {"pressure": "ellipse"}),
            "pressure = 'ellipse.*: only cartesian .* load",
        ),
    ],
)
def test_what_no_model_knows_is_refused(motion, settings, message):
    with pytest.raises(ValueError, match=message):
        microslip.solve(motion, 0.1, 0.5, **settings)


@pytest.mark.slow
@pytest.mark.parametrize("place", [("normal", 0.1, 0.5), ("normal:indentation=1", 0.03, 1.4)])
@pytest.mark.parametrize("pressure", ["power:exponent=1", "power:exponent=8", "punch"])
def test_closed_form_springs_and_rings_agree_for_other_indenters(pressure, place):
    exact = microslip.solve(*place, pressure=pressure)
    assert exact.model == "closed-form"
    for model in ("mdr", "radial"):
        assert_agree(exact, microslip.solve(*place, pressure=pressure, model=model, tolerance=5e-3))


# With a rotation


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["normal", "normal:lateral=1", "normal:forward=1,phase=60"])
def test_modes_find_what_rings_find(motion):
    """At nu = 0, both models are equal at the same resolution, up to the tolerance of the steps."""
    for amplitude in (0.6, 1.3):
        rings, modes = (run(motion, 0.1, amplitude, m, 24, 96, 8) for m in ("radial", "polar"))
        assert rings.converged and modes.converged
        assert modes.mu == pytest.approx(rings.mu, abs=2e-6)


@pytest.mark.slow
@pytest.mark.parametrize("velocity", [0.5, 5.0, 40.0])
def test_where_all_slides_every_moment_is_a_steady_bore(velocity):
    """The mean is Eq 21 at the current contact radius and rotation rate, weighted with the load."""
    amplitude, share = 60.0, 0.5 / 60.0
    result = microslip.solve(
        f"normal:load={share!r},angle=1,phase=90", velocity, amplitude, tolerance=5e-3
    )
    phase = (np.arange(4000) + 0.5) * np.pi / 2000.0
    load = 1.0 + 0.5 * np.sin(phase)
    rate = np.abs(float(hertz.bore_angle(amplitude)) * np.sin(phase))
    radius = HERTZ.radius(HERTZ.of_load(load))
    steady = paper.bore_forward(velocity / (rate * radius))
    assert result.converged
    # the force follows with a delay of about u_lim, which is a small part of this path
    assert result.mu_macro == pytest.approx(np.mean(load * steady), abs=0.015)
