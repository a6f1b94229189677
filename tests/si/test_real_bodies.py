"""Bodies on several contacts in SI units: load and drive of each contact."""

import math

import numpy as np
import pytest

import microslip
from microslip.si.bodies import TwoBodies
from microslip.si.materials import RIGID, Material
from microslip.si.several import read_carriers
from microslip.si.shapes import of_size
from microslip.theory.drift import antiphase_drift

BALL = {"radius": "5 mm", "mu": 0.3, "young": "210 GPa", "nu": 0.0, "frequency": "20 kHz"}
OMEGA = 2.0 * math.pi * 20e3
AGAINST = "phase=0;phase=180"


def one_of(load):
    return TwoBodies(Material(210e9, 0.0), RIGID, 0.005, load, 0.3)


PULLED = {
    "a speed": ({"speed": 0.02}, {}),
    "a force": ({}, {"force": 1.5}),
    "a mass on a spring": ({"speed": 0.02}, {"drive_stiffness": 4e6, "mass": 2e-4, "damping": 3.0}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PULLED)
def test_three_contacts_in_phase_are_three_times_one(name):
    """Each contact has a third of the load and of the drive."""
    same, of_the_body = PULLED[name]
    ball = BALL | {"amplitude": one_of(10.0).u_lim}
    alone = microslip.predict("transverse", load=10.0, **ball, **same, **of_the_body)
    body = {key: 3.0 * value for key, value in of_the_body.items()}
    three = "phase=20;phase=20;phase=20"
    result = microslip.predict("transverse", load=30.0, contacts=three, **ball, **same, **body)
    assert result.u_lim_m == pytest.approx(alone.u_lim_m)
    for key in ("friction_force_still_N", "force_threshold_N"):
        assert getattr(result, key) == pytest.approx(3.0 * getattr(alone, key), rel=1e-9)
    error = 3.0 * alone.mu_apparent_error * 10.0 + 3.0 * result.mu_apparent_error * 10.0
    assert abs(result.friction_force_N - 3.0 * alone.friction_force_N) <= max(error, 1e-9)
    assert result.drag_power_W == pytest.approx(3.0 * alone.drag_power_W, rel=1e-2)
    if name == "a force":
        errors = result.speed_error_m_s + alone.speed_error_m_s
        assert abs(result.speed_m_s - alone.speed_m_s) <= errors
        assert result.safety_factor == pytest.approx(alone.safety_factor)
        assert result.outcome == alone.outcome == "moves"


MOVED = {
    "transverse": {"amplitude": "0.6 um", "speed": "20 mm/s", "nu": 0.3},
    "bore": {"amplitude": "0.5 deg", "speed": "20 mm/s"},
}


@pytest.mark.slow
@pytest.mark.parametrize("motion", MOVED)
def test_the_friction_of_a_body_at_a_speed_is_the_sum_of_its_contacts(motion):
    """The reference is a prediction for each contact alone, under its own load."""
    settings = BALL | MOVED[motion]
    each = [microslip.predict(motion, load=load, **settings) for load in (4.0, 16.0)]
    assert abs(each[0].mu_macro - each[1].mu_macro) > 0.05
    result = microslip.predict(motion, load=20.0, contacts="load=1;load=4,phase=60", **settings)
    forces = sum(one.friction_force_N for one in each)
    errors = 20.0 * result.mu_apparent_error + sum(
        load * one.mu_apparent_error for load, one in zip((4.0, 16.0), each, strict=True)
    )
    assert abs(result.friction_force_N - forces) <= errors
    assert result.friction_force_still_N == pytest.approx(0.3 * 20.0)


@pytest.mark.slow
def test_two_feet_that_work_against_each_other_walk_as_fast_as_the_closed_form():
    unit = one_of(10.0).u_lim
    settings = BALL | {"load": 20.0, "contacts": AGAINST}
    result = microslip.predict("longitudinal", amplitude=unit, force=1.8, **settings)
    expected = float(antiphase_drift(0.3, 1.0)) * OMEGA * unit
    assert result.outcome == "moves" and result.converged
    assert abs(result.speed_m_s - expected) <= result.speed_error_m_s
    # the threshold of each contact is (1 - A)^(3/2) mu times its load
    still = microslip.predict("longitudinal", amplitude=0.5 * unit, force=1.8, **settings)
    assert still.force_threshold_N == pytest.approx(6.0 * 0.5**1.5, abs=6.0 * 1e-3)
    assert still.outcome == "stays"
    # in phase the contacts move with the body, and all of friction holds it
    together = settings | {"contacts": "phase=0;phase=0"}
    held = microslip.predict("longitudinal", amplitude=unit, force=1.8, **together)
    assert held.outcome == "stays" and held.force_threshold_N == pytest.approx(6.0)


@pytest.mark.slow
def test_no_threshold_is_claimed_where_contacts_move_the_body_by_themselves():
    """At a phase of 100 degrees the forces of the two contacts at rest do not cancel."""
    settings = BALL | {"load": 20.0, "contacts": "phase=0;phase=100", "tolerance": 0.1}
    result = microslip.predict("longitudinal", amplitude="1 um", force=3.0, **settings)
    assert result.force_threshold_N is None and result.safety_factor is None


def test_the_contact_that_carries_most():
    carriers = read_carriers(" load=3 ; load=1, phase=90, amplitude=2 ")
    assert (carriers.count, carriers.heaviest, carriers.widest) == (2, 1.5, 2.0)
    for contact in (one_of(8.0), of_size(one_of(8.0), one_of(8.0).contact_radius, "hertz")):
        most = carriers.most_loaded(contact)
        # Hertz: the radius is proportional to the cube root of the load, u_lim to its square
        assert most.load == pytest.approx(12.0)
        assert most.contact_radius == pytest.approx(one_of(12.0).contact_radius)
        assert most.u_lim == pytest.approx(one_of(12.0).u_lim)
        assert most.largest_pressure == pytest.approx(one_of(12.0).largest_pressure, rel=1e-9)


def test_warnings_are_about_the_contact_that_carries_most():
    """A sphere yields at a largest pressure of 0.57 times the hardness."""
    pressure = one_of(10.0).largest_pressure
    settings = BALL | {"load": 20.0, "amplitude": "0.5 um", "speed": "1 m/s", "tolerance": 0.1}
    settings["hardness"] = 1.05 * pressure / 0.57
    result = {
        contacts: microslip.predict("transverse", contacts=contacts, **settings).warnings
        for contacts in ("load=1;load=1", "load=5;load=1")
    }
    assert np.cbrt(5 / 3) > 1.05
    yields = [any("hardness" in text for text in texts) for texts in result.values()]
    assert yields == [False, True]


def test_warnings_are_about_the_largest_load_of_a_period():
    """Hertz's pressure is proportional to the cube root of the load: 5 % more for 1.16 times."""
    settings = BALL | {"load": 10.0, "speed": "1 m/s", "tolerance": 0.1}
    settings["hardness"] = 1.05 * one_of(10.0).largest_pressure / 0.57
    texts = [
        " ".join(microslip.predict("normal", load_amplitude=one, **settings).warnings)
        for one in ("1.4 N", "1.8 N")
    ]
    assert ["hardness" in text for text in texts] == [False, True]
