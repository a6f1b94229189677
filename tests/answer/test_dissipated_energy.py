"""Dissipated energy per period: closed forms, limits and drives."""

import math

import pytest
from scipy.integrate import quad
from stubs.agreement import assert_agree

import microslip
from microslip.scene.by_name import pressure_named
from microslip.theory import hertz, masing
from microslip.theory.indenters import torsion_energy


def mindlin_deresiewicz(force):
    """24/5 (1 - (1 - L)^(5/3)) - 4 L (1 + (1 - L)^(2/3)) for the amplitude L of the force."""
    rest = 1.0 - force
    return 24.0 / 5.0 * (1.0 - rest ** (5 / 3)) - 4.0 * force * (1.0 + rest ** (2 / 3))


@pytest.mark.parametrize("amplitude", [1e-3, 0.5, 1.0, 3.0])
def test_a_loop_of_a_sphere(amplitude):
    """Beyond u_lim both strokes of the loop are longer, under full friction."""
    longer = max(amplitude - 1.0, 0.0)
    force = hertz.mindlin_force(min(amplitude, 1.0))
    exact = mindlin_deresiewicz(force) + 4.0 * longer
    assert masing.loop_energy(amplitude) == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("amplitude", [0.01, 0.5, 1.0, 4.0])
@pytest.mark.parametrize("poisson", [0.0, 0.4])
def test_a_loop_of_torsion(amplitude, poisson):
    """8 W - 4 T phi, with the work of Lubkin's torque over the angle."""
    angle = float(hertz.bore_angle(amplitude, poisson))

    def torque(turned):
        return float(hertz.lubkin_torque(hertz.lubkin_stick_radius(turned, poisson)))

    work = quad(torque, 0.0, angle, epsabs=1e-13, epsrel=1e-12)[0]
    loop = 8.0 * work - 4.0 * torque(angle) * angle
    sphere = pressure_named("hertz")
    assert torsion_energy(sphere, angle, poisson) == pytest.approx(loop, rel=1e-7, abs=1e-9)


def assert_energies_agree(one, other):
    apart = abs(one.dissipated_energy - other.dissipated_energy)
    assert apart <= one.dissipated_energy_error + other.dissipated_energy_error


CLOSED = [
    *(
        (motion, model, 0.0, 0.6, pressure)
        for motion, model in (("transverse", "radial"), ("bore", "polar"))
        for pressure in ("hertz", "power:exponent=1", "punch:flat=0.5")
    ),
    ("longitudinal", "radial", 0.2, 0.7, "hertz"),
    # the bounds of fast sliding
    ("transverse", "radial", 40.0, 1.0, "hertz"),
    ("bore", "polar", 20.0, 1.0, "hertz"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("motion", "model", "velocity", "amplitude", "pressure"), CLOSED)
def test_runs_agree_with_closed_forms(motion, model, velocity, amplitude, pressure):
    place = {"velocity": velocity, "amplitude": amplitude, "pressure": pressure}
    exact = microslip.solve(motion, **place)
    result = microslip.solve(
        motion, **place, model=model, tolerance=1e-4 if velocity > 1.0 else 1e-3
    )
    assert exact.model == "closed-form"
    assert_agree(exact, result)
    assert_energies_agree(exact, result)
    assert result.dissipated_energy_error < 0.02 * exact.dissipated_energy


@pytest.mark.slow
@pytest.mark.parametrize("model", ["radial", "mdr", "polar", "cartesian"])
def test_a_slow_motion_dissipates_the_loop_of_mindlin_and_deresiewicz(model):
    """The slow advance adds its own work, mu_macro times the way."""
    velocity, amplitude = 1e-3, 0.4
    exact = mindlin_deresiewicz(hertz.mindlin_force(amplitude))
    result = microslip.solve("transverse", velocity, amplitude, model=model, tolerance=1e-2)
    way = 2.0 * math.pi * velocity
    assert exact < result.dissipated_energy + result.dissipated_energy_error
    assert result.dissipated_energy - result.dissipated_energy_error < exact + 2.0 * way


@pytest.mark.slow
def test_a_rigid_contact_dissipates_its_way():
    """At large amplitudes the energy is mu F_z times the way, except at the two reversals.

    In each reversal the contact sticks over at most 2 u_lim.
    """
    way = quad(lambda t: math.hypot(3.0, 30.0 * math.cos(t)), 0.0, 2.0 * math.pi)[0]
    result = microslip.solve("transverse", 3.0, 30.0)
    assert 0.0 < way - result.dissipated_energy < 4.0
    rigid = microslip.solve("transverse", 3.0, 30.0, model="rigid")
    assert rigid.dissipated_energy == pytest.approx(way, abs=rigid.dissipated_energy_error)


def test_the_energy_of_a_fast_contact_has_the_relative_error_of_its_velocity():
    result = microslip.solve("transverse", amplitude=12.0, force=0.98, tolerance=1e-3)
    finer = microslip.solve("transverse", amplitude=12.0, force=0.98, tolerance=1e-4)
    assert result.velocity > 30.0
    assert result.dissipated_energy_error < 1e-3 * result.dissipated_energy
    apart = abs(result.dissipated_energy - finer.dissipated_energy)
    assert apart <= result.dissipated_energy_error
