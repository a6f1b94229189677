"""Oscillating normal load: independent springs, closed forms and limits."""

import numpy as np
import pytest

import microslip
from microslip.contact.contact import project
from microslip.contact.path import EULER, make_path
from microslip.contact.reduced import mdr_contact
from microslip.contact.registry import MODELS
from microslip.contact.ring_contact import RadialContact
from microslip.periodic.discretise import Resolution, contact_of, path_of
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Problem

ALONE = [
    ("normal", 0.1, 0.5),
    ("normal", 0.003, 0.9),
    ("normal", 0.3, 1.5),
    ("normal", 0.63, 1.01),
    ("normal:indentation=1", 0.3, 0.8),
    ("normal:indentation=1", 0.01, 1.3),
    ("normal:normal_cycles=3", 0.5, 0.7),
]
ALONG = [
    ("normal:forward=1,phase=60", 0.1, 0.7),
    ("normal:forward=0.5,phase=180,indentation=1", 0.02, 1.3),
    ("normal:forward=0.8,forward_cycles=2,phase=30", 0.2, 0.6),
]
ASIDE = [
    pytest.param(("normal:lateral=1", 0.1, 0.7), marks=pytest.mark.long),
    ("normal:lateral=0.5,phase=90,indentation=1", 0.02, 1.2),
    pytest.param(("normal:lateral=1,normal_cycles=2", 0.1, 0.8), marks=pytest.mark.long),
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


def run(motion, velocity, amplitude, model="radial", cells=32, steps=128):
    problem = Problem(motion_named(motion), velocity, amplitude, 0.0)
    return simulate(problem, model, Resolution(cells, 1, steps), 1e-7)


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


def tractions_of(march, bounds):
    """Tractions of rings at the start and at every stage, (2, 1 + steps stages, rings)."""
    return project(np.moveaxis(march.fields[:, :, 0], 1, 0), bounds)


@pytest.mark.parametrize("place", [*ALONG, *ASIDE], ids=str)
def test_work_is_dissipated(place):
    """The work of the motion is the sum of stored energy, dissipation and the numerical loss of
    Euler steps."""
    name, velocity, amplitude = place
    motion = Problem(motion_named(name), velocity, amplitude, 0.0)
    resolution = Resolution(16, 1, 256)
    contact, result = contact_of(motion, "radial", resolution), run(*place, "radial", 16, 256)
    phase = path_of(motion, contact, 256).phase
    path = make_path(motion.displacement, phase, EULER, motion.depth)
    before = result.state
    march = contact.march(path, before, 1e-11)
    moves = np.diff(path.positions[:, :2], axis=0)
    work = np.sum(moves * march.forces[1:, :2])
    tractions = np.moveaxis(tractions_of(march, contact.bounds_along(path)), 0, 1)
    slip = moves[:, :, None] - np.diff(tractions, axis=0) @ contact.influence.T
    lost = contact.weight * np.sum(tractions[1:] * slip, axis=1)
    assert (lost >= -1e-9).all()
    stored = 0.5 * sum(
        sign * np.vdot(contact.weight * q, contact.displacement(q))
        for sign, q in ((1.0, march.state), (-1.0, before))
    )
    changes = np.diff(tractions, axis=0)
    numerical = 0.5 * np.sum(contact.weight * changes * (changes @ contact.influence.T))
    assert work == pytest.approx(lost.sum() + stored + numerical, abs=1e-7)


def test_in_step_with_the_load_an_oscillation_drives_the_contact():
    """If the load is larger during the forward motion than during the backward motion, friction
    decreases or propels."""
    motion = "normal:forward=1,phase={}"
    ahead, back = (microslip.solve(motion.format(p), 0.02, 0.8).mu_macro for p in (180, 0))
    assert ahead < -0.3 and back > 0.5


@pytest.mark.parametrize(
    ("motion", "message"),
    [
        ("normal:load=0", "allowed is load or indentation above 0"),
        ("normal:load=0.5,indentation=1", "allowed is no load beside an indentation"),
        ("normal:lateral=2", "lateral = 2: allowed is a share in 0..1"),
        ("normal:load=-1", "load = -1: allowed is a share in 0..1"),
        ("normal:normal_cycles=0.5", "normal_cycles = 0.5: allowed is a whole number"),
        ("normal:depth=1", "unknown number depth"),
    ],
)
def test_what_is_no_motion_is_refused(motion, message):
    with pytest.raises(ValueError, match=message):
        microslip.solve(motion, 0.1, 0.5)


@pytest.mark.parametrize("model", sorted(MODELS.keys() - {"mdr", "radial", "polar"}))
def test_models_that_know_one_load_are_refused(model):
    with pytest.raises(ValueError, match=f"model = '{model}': .* constant normal load"):
        microslip.solve("normal", 0.1, 0.5, model=model)


# Other indenters


@pytest.mark.slow
@pytest.mark.parametrize(
    "pressure",
    ["power:exponent=1", "power:exponent=8", pytest.param("punch", marks=pytest.mark.long)],
)
@pytest.mark.parametrize(
    ("motion", "velocity", "amplitude"), [("normal", 0.1, 0.5), ("normal:indentation=1", 0.03, 1.4)]
)
def test_closed_form_springs_and_rings_agree_for_other_indenters(
    pressure, motion, velocity, amplitude
):
    exact = microslip.solve(motion, velocity, amplitude, pressure=pressure)
    assert exact.model == "closed-form"
    for model in ("mdr", "radial"):
        settings = {"pressure": pressure, "model": model, "tolerance": 5e-3}
        result = microslip.solve(motion, velocity, amplitude, **settings)
        assert result.converged
        assert abs(result.mu_macro - exact.mu_macro) <= result.mu_macro_error
