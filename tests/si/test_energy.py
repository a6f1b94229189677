"""Torque, power and energy of contacts in SI units: energy balances, limits, closed forms."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import microslip
from microslip.adaptive.vibration_power import vibration_power
from microslip.foundation.errors import InputError

BALL = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3}
SHAKEN = BALL | {"speed": "10 mm/s", "amplitude": "0.3 um", "frequency": "20 kHz"}


@pytest.mark.slow
@pytest.mark.parametrize(
    "motion",
    ["transverse", "longitudinal", "bore", pytest.param("elliptic", marks=pytest.mark.long)],
)
def test_drag_and_vibration_are_what_slip_dissipates(motion):
    """The work of drag and vibration in a period equals the integral of traction times slip."""
    velocity, amplitude = 0.3, 1.2
    power = vibration_power(motion, velocity, amplitude)
    assert power.reason == "" and power.value > 0.0
    result = microslip.solve(motion, velocity, amplitude)
    period = microslip.period(motion, velocity, amplitude, cells=32, steps=256)
    slipped = period.traction_forward * period.slip_forward
    slipped = slipped + period.traction_lateral * period.slip_lateral
    dissipated = float(np.sum(slipped[1:] @ period.area)) / (2.0 * math.pi)
    drift = (period.forward[-1] - period.forward[0]) / (2.0 * math.pi)
    # The period has one resolution; its error is about 1e-3 mu F_z times the path.
    put_in = power.value + result.mu_macro * drift
    assert put_in == pytest.approx(dissipated, abs=3e-3 * (amplitude + velocity))


@pytest.mark.slow
def test_a_rigid_contact_dissipates_its_way():
    """At large amplitudes the power is mu F_z times the mean speed, except at the two reversals.

    In each reversal the contact sticks over at most 2 u_lim.
    """
    power = vibration_power("transverse", 3.0, 30.0)
    drag = 3.0 * microslip.solve("transverse", 3.0, 30.0).mu_macro
    way = quad(lambda t: math.hypot(3.0, 30.0 * math.cos(t)), 0.0, 2.0 * math.pi)[0]
    lost = way / (2.0 * math.pi) - (power.value + drag)
    assert 0.0 < lost < 4.0 / (2.0 * math.pi)


def test_a_steady_spin_takes_a_torque():
    """Torque and force at v = 1/2 follow from Eqs 22 and 21.

    The torque is (3 pi/16) mu F a (1 - v^2 + 3/8 v^4), the force (3 pi/8) mu F (v - v^3/4).
    """
    at_rest = microslip.predict("continuous-bore", **BALL, speed="1 mm/s", rotation="1 rad/s")
    a = at_rest.contact_radius_m
    request = BALL | {"speed": 0.5 * a * 100.0, "rotation": "100 rad/s"}
    result = microslip.predict("continuous-bore", **request)
    whole = 3.0 * math.pi / 16.0 * 3.0 * a
    assert result.torque_N_m == pytest.approx(whole * (1.0 - 0.25 + 0.375 * 0.5**4), rel=2e-3)
    force = 3.0 * 3.0 * math.pi / 8.0 * (0.5 - 0.125 / 4.0)
    assert result.drag_power_W == pytest.approx(force * 50.0 * a, rel=2e-3)
    assert result.vibration_power_W == pytest.approx(100.0 * result.torque_N_m)
    both = result.drag_power_W + result.vibration_power_W
    assert result.energy_per_cycle_J == pytest.approx(both * 2.0 * math.pi / 100.0)


@pytest.mark.slow
def test_power_is_in_watts():
    result = microslip.predict("transverse", **SHAKEN, power=True)
    unit = 3.0 * result.u_lim_m * 2.0 * math.pi * 20e3
    working = vibration_power(
        "transverse", result.velocity, result.amplitude, poisson=result.poisson
    )
    assert result.vibration_power_W == pytest.approx(unit * working.value, rel=1e-12)
    assert result.drag_power_W == pytest.approx(result.friction_force_N * 0.01, rel=1e-12)
    assert result.energy_per_cycle_J == pytest.approx(result.dissipated_power_W / 20e3, rel=1e-12)
    plain = microslip.predict("transverse", **SHAKEN)
    assert plain.vibration_power_W is None and plain.drag_power_W == result.drag_power_W


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"power": "yes"}, "power = 'yes': allowed is True or False"),
        ({"speed": 0.0}, "speed = 0.0: allowed is above 0"),
        ({"amplitude": 0.0}, "amplitude = 0.0: allowed is above 0"),
        ({"drive_stiffness": "1 N/um"}, "power = True: allowed only without a force and a spring"),
    ],
)
def test_a_power_that_nothing_can_have_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        microslip.predict("transverse", **SHAKEN | {"power": True} | change)
