"""Contacts in SI units under a force or on a spring: groups and limits."""

import math

import pytest
from stubs.si_contact import contact as contact_of

import microslip
from microslip.foundation.arguments import LARGEST_BODY
from microslip.foundation.errors import InputError
from microslip.si import solve
from microslip.si.solve import within_range
from microslip.theory import paper

BALL = {"radius": "5 mm", "load": "10 N", "mu": 0.3, "young": "210 GPa", "nu": 0.0}
SIDEWAYS = BALL | {"frequency": "20 kHz"}
CONTACT = contact_of(**BALL)
STILL = 3.0
"""Friction mu F_z of the ball, N."""


def stroke(share):
    """The amplitude in metres for a dimensionless one."""
    return share * CONTACT.u_lim


# Groups


def test_the_groups_of_a_drive_by_hand():
    """The stiffness of a sticking Hertz contact is 2 G* a = 1.5 mu F_z / u_lim.

    A spring of this stiffness, a mass in resonance with it, and a dashpot of this impedance all
    have a group of 1.5.
    """
    stiffness, omega = 2.0 * CONTACT.G_star * CONTACT.contact_radius, 2.0 * math.pi * 20e3
    drive = {"drive_stiffness": stiffness, "mass": stiffness / omega**2}
    moving = {"speed": 1e-3, "amplitude": 1e-6, "damping": stiffness / omega}
    contact = contact_of("transverse", **SIDEWAYS, **drive, **moving)
    assert contact.drive() == pytest.approx({"stiffness": 1.5, "mass": 1.5, "damping": 1.5})
    forced = contact_of("transverse", **SIDEWAYS, amplitude=1e-6, force=1.5)
    assert forced.drive() == pytest.approx({"force": 0.5})


# Under a force


@pytest.mark.slow
@pytest.mark.parametrize(
    ("amplitude", "force", "velocity", "digits"),
    [(0.5, 0.75, 0.0244, 3e-4), (3.0, 0.30, 0.438, 4e-3)],
)
def test_drift_under_a_force_is_that_of_a_second_program(amplitude, force, velocity, digits):
    """The references are coarse: a prototype with about twenty rings and backward Euler."""
    result = microslip.predict(
        "transverse", amplitude=stroke(amplitude), force=force * STILL, **SIDEWAYS
    )
    unit = 2.0 * math.pi * 20e3 * CONTACT.u_lim
    assert result.outcome == "moves" and result.converged
    assert result.speed_m_s == pytest.approx(velocity * unit, abs=digits * unit)
    assert result.speed_error_m_s <= 1.01e-2 * result.speed_m_s
    assert result.speed_m_s * result.time_to_1_mm_s == pytest.approx(1e-3)
    assert result.speed_m_s * result.time_to_contact_radius_s == pytest.approx(
        result.contact_radius_m
    )
    assert result.displacement_per_cycle_m * 20e3 == pytest.approx(result.speed_m_s)
    assert result.mu_macro == pytest.approx(force)


@pytest.mark.parametrize("share", [0.9, 1e-3])
def test_a_force_below_the_threshold_moves_nothing(share):
    """The threshold equals the friction at a speed of 0."""
    request = SIDEWAYS | {"amplitude": stroke(0.5)}
    held = microslip.predict("transverse", speed=0.0, **request)
    threshold = held.friction_force_N
    result = microslip.predict("transverse", force=share * threshold, **request)
    assert (result.outcome, result.speed_m_s, result.speed_error_m_s) == ("stays", 0.0, 0.0)
    assert result.force_threshold_N == pytest.approx(threshold)
    assert held.force_threshold_N == pytest.approx(threshold)
    assert result.safety_factor == pytest.approx(1.0 / share)
    assert result.time_to_1_mm_s is None and result.converged


@pytest.mark.parametrize("force", [3.0, 1e12])
def test_all_of_friction_and_more_runs_away(force):
    result = microslip.predict("transverse", amplitude=stroke(0.5), force=force, **SIDEWAYS)
    assert result.outcome == "runs away" and not result.converged
    assert math.isnan(result.speed_m_s) and result.time_to_1_mm_s is None
    assert result.reason.startswith("runs away")


@pytest.mark.parametrize("side", [-0.5, 0.5])
def test_a_force_within_the_error_of_its_threshold_is_not_converged(side):
    """A drift with a small relative error would take minutes there."""
    contact = SIDEWAYS | {"amplitude": stroke(0.5), "tolerance": 1e-2}
    held = microslip.predict("transverse", speed=0.0, **contact)
    force = held.force_threshold_N + side * held.force_threshold_error_N
    result = microslip.predict("transverse", force=force, **contact)
    assert result.outcome == "undecided" and not result.converged
    assert result.displacement_m is None and not result.displacement_reason
    assert result.reason.startswith("the force differs from its threshold by less than")
    assert "undecided within the error" in str(result)


def test_an_unknown_displacement_of_a_contact_that_stays_has_its_reason():
    requests = SIDEWAYS | {"amplitude": stroke(0.5), "force": 1.0}
    heavy = microslip.predict("transverse", **requests, mass="1 mg")
    assert (heavy.outcome, heavy.displacement_m) == ("stays", None)
    assert "unknown: computed for a contact without mass only" in str(heavy)


def test_a_contact_without_mass_goes_along_with_what_shakes_it_along_the_force():
    result = microslip.predict("longitudinal", amplitude=stroke(3.0), force=2.9, **SIDEWAYS)
    assert (result.outcome, result.speed_m_s) == ("stays", 0.0)
    assert result.force_threshold_N == pytest.approx(STILL)
    heavy = SIDEWAYS | {"amplitude": stroke(3.0), "force": 1.0, "mass": "1 kg"}
    result = microslip.predict("longitudinal", **heavy)
    assert result.outcome == "moves"
    assert (result.force_threshold_N, result.safety_factor) == (None, None)


def test_a_steady_spin_gives_way_to_any_force():
    """The velocity and the force satisfy Eq 21."""
    result = microslip.predict("continuous-bore", rotation="10 Hz", force=0.5 * STILL, **BALL)
    assert float(paper.bore_forward(result.velocity)) == pytest.approx(0.5, abs=1e-8)
    edge = 2.0 * math.pi * 10.0 * result.contact_radius_m
    assert result.speed_m_s == pytest.approx(result.velocity * edge)
    assert (result.outcome, result.force_threshold_N) == ("moves", 0.0)
    assert result.displacement_per_cycle_m is None


# Through a spring


def test_a_body_beyond_what_the_solver_takes_swings_as_it_did():
    """Stiffness and mass are scaled by one factor, which keeps the natural frequency."""
    requests = within_range({"stiffness": 4e9, "mass": 1e9, "damping": 3.0})
    assert max(requests.values()) == LARGEST_BODY
    assert requests["stiffness"] / requests["mass"] == pytest.approx(4.0)
    as_given = {"stiffness": 4.0, "mass": 0.5}
    assert within_range(as_given) == as_given


@pytest.mark.parametrize(
    ("argument", "option"), [("stiffness", "drive_stiffness"), ("velocity", "speed")]
)
def test_a_refusal_of_the_solver_names_the_argument_of_predict(monkeypatch, argument, option):
    def refuse(problem, **settings):
        if problem.velocity == 0.0:
            return microslip.solve(problem, **settings)
        raise InputError(argument, 2e6, "allowed is at most 1e+06")

    monkeypatch.setattr(solve, "solve", refuse)
    drive = {"speed": "10 mm/s", "drive_stiffness": "10 N/um"}
    with pytest.raises(InputError) as caught:
        microslip.predict("transverse", amplitude=stroke(1.0), **SIDEWAYS | drive)
    error = caught.value
    assert (error.argument, error.value) == (option, drive[option])
    assert error.allowed == "dimensionless 2e+06: allowed is at most 1e+06"


def test_the_natural_frequency_is_that_of_the_mass_on_both_springs():
    """sqrt((k + 3/2) / m): a sticking Hertz contact has the stiffness 3/2."""
    unit = 0.3 * 10.0 / CONTACT.u_lim
    drive = {"drive_stiffness": 2.5 * unit, "mass": unit / (2.0 * math.pi * 20e3) ** 2}
    moving = {"amplitude": stroke(1.0), "speed": 1.0, "tolerance": 0.1}
    result = microslip.predict("transverse", **SIDEWAYS, **drive, **moving)
    assert result.natural_frequency_Hz == pytest.approx(2.0 * 20e3)


PARTS = {"amplitude": stroke(0.5), "forward_amplitude": stroke(0.3), "phase": "90 deg"}


def test_a_contact_that_goes_along_with_the_vibration_has_the_threshold_of_what_is_left():
    """The threshold is that of the lateral part, whose closed form is exact at nu = 0."""
    result = {
        share: microslip.predict("elliptic", **SIDEWAYS, **PARTS, force=share * STILL)
        for share in (0.4, 0.8)
    }
    assert [one.outcome for one in result.values()] == ["stays", "moves"]
    exact = STILL * paper.static_limit_transverse(0.5)
    for share, one in result.items():
        assert one.force_threshold_N == pytest.approx(exact, abs=one.force_threshold_error_N)
        assert one.safety_factor == pytest.approx(one.force_threshold_N / (share * STILL))
    assert result[0.4].displacement_m > 0.0


def test_probabilities_of_a_contact_that_follows_part_of_the_vibration():
    """The threshold is that of the lateral part, so the force decides by its distribution."""
    exact = STILL * float(paper.static_limit_transverse(0.5))
    force = f"{exact - 0.05} N +- 0.1 N"  # half a standard deviation below the threshold
    result = microslip.predict("elliptic", **SIDEWAYS, **PARTS, tolerance=0.1, force=force)
    assert result.probability_stays == pytest.approx(0.6915, abs=0.01)
    assert result.probability_runs_away == 0.0
