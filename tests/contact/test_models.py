"""The contact models against Mindlin, Lubkin, closed forms of simple models, and each other.

Motions are rows of displacements (forward, lateral, angle) at the ends of steps.
"""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from microslip.contact.contact import energy_norm, forces, forward_slip, rigid_displacement
from microslip.contact.modes import PolarContact
from microslip.contact.path import EULER, SDIRK2, make_path, phases_between
from microslip.contact.reduced import slider_contact
from microslip.contact.ring_contact import RadialContact
from microslip.contact.squares import CartesianContact
from microslip.periodic.discretise import Resolution
from microslip.periodic.search import Goal, find_periodic_state
from microslip.periodic.simulate import simulate
from microslip.scene.motion import HALF_PERIOD
from microslip.scene.named import Bore, Transverse
from microslip.scene.problem import Problem
from microslip.theory import hertz, paper


def at_rest(contact):
    return np.zeros((2, *contact.forward_position.shape))


def through(motions):
    """Path along straight lines through rows of (forward, lateral, angle)."""
    motions = np.asarray(motions, dtype=float)
    phase = np.arange(len(motions))

    def displacement(t):
        return tuple(np.interp(t, phase, column) for column in motions.T)

    return make_path(displacement, phase, EULER)


def fitted_order(counts, errors):
    """Order of convergence: minus the slope of log(error) over log(count)."""
    return -np.polyfit(np.log(counts), np.log(np.abs(errors)), 1)[0]


# Cattaneo and Mindlin: translation along one line


def mindlin_deresiewicz(turns, points=8):
    """Displacements and forces of an oscillation from rest through the turning points.

    After a turning point, the force changes by twice Mindlin's law of half the displacement.
    """
    u, force = [0.0], [0.0]
    start, scale = (0.0, 0.0), 1
    for turn in turns:
        for u_k in np.linspace(u[-1], turn, points + 1)[1:]:
            way = u_k - start[0]
            law = scale * hertz.mindlin_force(abs(way) / scale)
            u.append(u_k)
            force.append(start[1] + np.sign(way) * law)
        start, scale = (u[-1], force[-1]), 2
    return np.array(u), np.array(force)


ONE_WAY = {
    "radial, focused": (lambda n: RadialContact.resolved(n, 0.5), [8, 16, 32, 64]),
    "polar": (lambda n: PolarContact(n, 4, False), [8, 16, 32, 64]),
    "cartesian": (lambda n: CartesianContact(n), [8, 12, 16, 24]),
}


@pytest.mark.parametrize("name", ONE_WAY)
def test_forces_are_those_of_mindlin_and_deresiewicz(name):
    """Loading, unloading and reloading, in an oblique direction."""
    u, expected = mindlin_deresiewicz([0.7, -0.4, 0.5])
    along = np.array([np.cos(0.4), np.sin(0.4), 0.0])
    build, cells = ONE_WAY[name]
    errors = []
    for n in cells:
        contact = build(n)
        march = contact.march(through(u[:, None] * along), at_rest(contact), 1e-7)
        assert march.forces @ [-np.sin(0.4), np.cos(0.4), 0] == pytest.approx(0.0, abs=1e-5)
        errors.append(np.abs(march.forces @ along - expected).max())
    assert errors[-1] < 3e-3
    assert fitted_order(cells, errors) == pytest.approx(2.0, abs=0.45)


# Lubkin: pure twist


TWIST = {
    "polar": (lambda n, nu: PolarContact(n, 4, True, nu), [8, 16, 32]),
    "cartesian": (lambda n, nu: CartesianContact(n, nu), [8, 12, 16, 24]),
}


@pytest.mark.parametrize("nu", [0.0, 0.3])
@pytest.mark.parametrize("name", TWIST)
def test_torque_of_pure_twist_is_lubkins(name, nu):
    stick = np.array([0.9, 0.7, 0.5, 0.3])
    build, cells = TWIST[name]
    angles = np.concatenate([[0.0], hertz.lubkin_angle(stick, nu)])
    errors = []
    for n in cells:
        contact = build(n, nu)
        march = contact.march(through(np.outer(angles, [0, 0, 1])), at_rest(contact), 1e-7)
        assert march.forces[:, 0] == pytest.approx(0.0, abs=1e-5)
        errors.append(np.abs(march.forces[1:, 2] - hertz.lubkin_torque(stick)).max())
    assert errors[-1] < 4e-3
    assert fitted_order(cells, errors) == pytest.approx(2.0, abs=0.45)


# The models without partial slip


@pytest.mark.parametrize(("velocity", "amplitude"), [(1e-3, 1.0), (0.1, 0.5), (1.0, 3.0), (10, 2)])
def test_rigid_translation_is_eq_6(velocity, amplitude):
    expected = paper.large_amplitude_transverse(velocity, amplitude)
    steps = [32, 64, 128]
    problem = Problem(Transverse(), velocity, amplitude, 0.0)
    errors = [simulate(problem, "rigid", Resolution(1, 1, n), 1e-6).mu - expected for n in steps]
    assert abs(errors[-1]) < 2e-4
    assert fitted_order(steps, errors) == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("velocity", [0.01, 0.1, 0.5, 1.0, 3.0])
def test_rigid_rotation_is_eq_29(velocity):
    resolution = Resolution(32, 32, 128)
    for amplitude in (0.3, 4.0):  # the result does not depend on it
        run = simulate(Problem(Bore(), velocity, amplitude, 0.3), "rigid", resolution, 1e-6)
        assert run.mu == pytest.approx(paper.large_amplitude_bore(velocity), abs=5e-4)


# Models against each other


@pytest.mark.parametrize("nu", [0.0, 0.3])
@pytest.mark.parametrize(
    ("motion", "velocity", "amplitude"),
    [(Transverse(), 0.2, 1.2), (Bore(), 0.5, 2.0)],
)
def test_cartesian_converges_to_polar(motion, velocity, amplitude, nu):
    """At equal steps, so that only the discretisation in space differs."""

    def mean(model, *resolution):
        problem = Problem(motion, velocity, amplitude, nu)
        run = simulate(problem, model, Resolution(*resolution), 1e-4)
        assert run.converged
        return run.mu

    cells = [8, 12, 16, 24]
    reference = mean("polar", 32, 16, 12)
    coarse = abs(mean("polar", 16, 8, 12) - reference)
    errors = np.array([mean("cartesian", n, 1, 12) for n in cells]) - reference
    assert coarse < abs(errors[-1])
    assert abs(errors[-1]) < 2e-3
    assert 1.2 < fitted_order(cells, errors) < 2.4


# One step


SMALL = {
    "radial": (lambda: RadialContact.resolved(6), "translation", 1e-11),
    "slider": (slider_contact, "translation", 1e-12),
    "polar, translation": (lambda: PolarContact(5, 4, False, 0.0, 0.5), "translation", 1e-10),
    "polar, coupled translation": (lambda: PolarContact(5, 4, False, 0.5), "translation", 1e-10),
    "polar, rotation": (lambda: PolarContact(5, 4, True, 0.0), "mirror", 1e-10),
    "polar, coupled rotation": (lambda: PolarContact(5, 4, True, 0.4, 0.5), "mirror", 1e-10),
    "cartesian, coupled": (lambda: CartesianContact(6, 0.4), "any", 1e-8),
}


@cache
def small(name):
    """The entry with its contact, which is created once."""
    build, *rest = SMALL[name]
    return build(), *rest


FREE = {"translation": [1, 1, 0], "mirror": [1, 0, 1], "any": [1, 1, 1]}
"""Symmetry of a contact -> factors 0 or 1 of the (forward, lateral, angle) that it allows."""

STEP = st.tuples(*[st.floats(-1.5, 1.5, allow_subnormal=False)] * 3)
STEPS = st.lists(STEP, min_size=1, max_size=5)


def motions_from(increments, free):
    return np.concatenate([[np.zeros(3)], np.cumsum(np.array(increments) * free, axis=0)])


@pytest.mark.parametrize("name", SMALL)
@settings(max_examples=25, deadline=None)
@given(increments=STEPS)
def test_every_step_obeys_coulomb_and_balances_energy(name, increments):
    """Slip and energy of backward Euler steps are computed from the operator and the motion, not by
    the solver.  A point dissipates at most its bound times its slip, so that the balance holds only
    if every point that slips is on its bound and slips along its traction."""
    contact, symmetry, tolerance = small(name)
    q = at_rest(contact)
    motions = motions_from(increments, FREE[symmetry])
    for before, after in pairwise(motions):
        march = contact.march(through([before, after]), q, tolerance)
        assert march.residual <= tolerance
        assert np.all(np.hypot(*march.state) <= contact.bound * (1 + 4e-16))
        sums = np.array([forces(contact, q), forces(contact, march.state)])
        if isinstance(contact, PolarContact):  # by symmetry of the disc
            sums[:, 1 if contact.rotates else 2] = 0.0
        assert march.forces == pytest.approx(sums, abs=1e-12)
        change = march.state - q
        slip = rigid_displacement(contact, after - before) - contact.displacement(change)

        def over_area(a, b):
            return np.sum(contact.weight * (a * b).sum(axis=0))

        # at the end of a step the tractions do more work than on average
        work = march.forces[1] @ (after - before)
        stored = over_area(march.state, contact.displacement(change))
        dissipation = np.sum(contact.weight * contact.bound * np.hypot(*slip))
        rounding = 1e-13 + 20 * tolerance * (1 + np.abs(after - before).sum())
        assert work == pytest.approx(stored + dissipation, abs=rounding)
        q = march.state


@pytest.mark.parametrize("name", SMALL)
def test_equal_marches_give_equal_bits_whatever_march_leads_them(name):
    """Another march as a first guess changes the effort only."""
    contact, symmetry, tolerance = small(name)
    ends = np.array([0.4, 0.3, 0.8]) * FREE[symmetry]
    path, start = through(np.outer(np.linspace(0.0, 1.0, 7), ends)), forward_slip(contact)
    one, other = (contact.march(path, start, tolerance) for _ in range(2))
    assert np.array_equal(one.fields, other.fields) and np.array_equal(one.forces, other.forces)
    led = contact.march(path, start, tolerance, previous=one)
    assert led.iterations < one.iterations or one.iterations == one.solves
    assert energy_norm(contact, led.state - one.state) < 1e3 * tolerance


# Order of the integrators


SMOOTH = {
    "radial": (lambda: RadialContact.resolved(8), Transverse()),
    "polar": (lambda: PolarContact(6, 4, True, 0.3), Bore()),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_order_of_the_integrators_in_the_periodic_mean(name):
    build, motion = SMOOTH[name]
    contact = build()

    def mean(steps, integrator):
        phases = phases_between(HALF_PERIOD, steps, 0.4)
        path = make_path(lambda t: motion.displacement(t, 0.5, 2.0, 0.3), phases, integrator)
        start, goal = forward_slip(contact), Goal(1e-7, 1e-9)
        result = find_periodic_state(contact, path, start, goal)
        assert result.converged
        return (path.weights @ result.march.forces)[0]

    reference = mean(512, SDIRK2)
    steps = [16, 32, 64]
    for integrator in (EULER, SDIRK2):
        errors = [mean(n, integrator) - reference for n in steps]
        assert fitted_order(steps, errors) == pytest.approx(integrator.order, abs=0.25)
