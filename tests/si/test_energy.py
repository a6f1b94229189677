"""Torque, power, energy and wear of contacts in SI units: energy balances and closed forms."""

import math

import pytest

import microslip

BALL = {"material": "steel", "counterbody": "steel", "radius": "5 mm", "load": "10 N", "mu": 0.3}
SHAKEN = BALL | {"speed": "10 mm/s", "amplitude": "0.3 um", "frequency": "20 kHz"}
SHAKEN |= {"tolerance": 1e-2}


def test_the_powers_of_an_oscillation_add_up_to_the_dissipation():
    result = microslip.predict("transverse", **SHAKEN)
    point = result.velocity, result.amplitude
    answer = microslip.solve("transverse", *point, poisson=result.poisson, tolerance=1e-2)
    unit = 3.0 * result.u_lim_m
    assert result.energy_per_cycle_J == pytest.approx(unit * answer.dissipated_energy, rel=1e-12)
    error = unit * answer.dissipated_energy_error
    assert result.energy_per_cycle_error_J == pytest.approx(error, rel=1e-12)
    assert result.drag_power_W == pytest.approx(result.friction_force_N * 0.01, rel=1e-12)
    assert result.dissipated_power_W == pytest.approx(result.energy_per_cycle_J * 20e3, rel=1e-12)
    both = result.vibration_power_W + result.drag_power_W
    assert result.dissipated_power_W == pytest.approx(both, rel=1e-12)


@pytest.mark.parametrize(
    ("motion", "change"),
    [
        ("transverse", {"speed": "300 m/s"}),
        ("bore", {"amplitude": 0.0}),
        ("longitudinal", {"amplitude": "50 nm"}),
    ],
)
def test_without_an_effect_of_the_vibration_the_energy_is_that_of_the_drag(motion, change):
    """Archard: the worn volume is k times the load times the sliding distance."""
    wear = {"wear_coefficient": "1e-5 mm^3/N/m"}
    result = microslip.predict(motion, **SHAKEN | change | wear)
    way = result.speed_m_s / 20e3
    assert result.energy_per_cycle_J == pytest.approx(3.0 * way, rel=1e-3)  # closed forms
    volume = 1e-14 * 10.0 * way
    assert result.wear_volume_per_cycle_m3 == pytest.approx(volume, rel=1e-3)
    depth = volume / (math.pi * result.contact_radius_m**2)
    assert result.wear_depth_per_cycle_m == pytest.approx(depth, rel=1e-3)
