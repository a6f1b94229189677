"""The reduced models against the results that they reproduce exactly or approximately."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import microslip
from microslip.contact.contact import forces
from microslip.contact.path import EULER, make_path
from microslip.contact.reduced import DahlContact, mdr_contact
from microslip.contact.ring_contact import RadialContact
from microslip.pressures.hertz import HERTZ
from microslip.theory import hertz, paper


def straight(displacements):
    """Path through lateral displacements (u_lim), one Euler step each."""
    displacements = np.asarray(displacements, dtype=float)

    def displacement(phase):
        lateral = np.interp(phase, np.arange(len(displacements)), displacements)
        return 0.0 * phase, lateral, 0.0 * phase

    return make_path(displacement, np.arange(len(displacements)), EULER)


@pytest.mark.parametrize("u", [0.1, 0.4, 0.75, 0.99, 1.5])
def test_springs_in_a_row_load_like_the_half_space(u):
    """The force is that of Cattaneo and Mindlin, with an error of second order in the number of
    springs."""
    for cells in (16, 64):
        contact = mdr_contact(cells)
        march = contact.march(straight([0.0, u]), np.zeros((2, 1, cells)), 1e-13)
        expected = hertz.mindlin_force(min(u, 1.0))
        assert march.forces[-1, 1] == pytest.approx(expected, abs=0.5 / cells**2)


def test_springs_in_a_row_unload_by_masings_rule():
    path = straight([0.0, 0.8, 0.3])
    loops = []
    for contact in (mdr_contact(128), RadialContact.resolved(64)):
        state = np.zeros((2, 1, len(contact.bound)))
        loops.append(contact.march(path, state, 1e-12).forces[:, 1])
    first, turn = hertz.mindlin_force(0.8), 2.0 * hertz.mindlin_force(0.25)
    assert loops[0][1:] == pytest.approx([first, first - turn], abs=2e-4)
    assert loops[0] == pytest.approx(loops[1], abs=1e-3)


@pytest.mark.parametrize("amplitude", [0.25, 0.5, 0.75])
def test_static_limit_of_springs_in_a_row(amplitude):
    """The forward force of each spring is sqrt(bound^2 - (G* y)^2)."""
    result = microslip.solve("transverse", 0.0, amplitude, model="mdr")
    stick = np.sqrt(1.0 - amplitude)
    expected = quad(lambda x: 1.5 * np.sqrt((1 - x * x) ** 2 - amplitude**2), 0.0, stick)[0]
    assert result.converged
    assert abs(result.mu_macro - expected) <= result.mu_macro_error + 1e-9
    assert abs(expected - paper.static_limit_transverse(amplitude)) > 5e-3  # another limit


def test_springs_in_a_row_come_close_to_the_rings():
    """The neglected interaction is a few percent of friction, and less at high velocity."""
    apart = []
    for velocity in (0.03, 0.3, 3.0):
        rows, rings = (
            microslip.solve("transverse", velocity, 0.7, model=model).mu_macro
            for model in ("mdr", "radial")
        )
        apart.append(abs(rows - rings))
    assert apart[0] < 0.03 and apart[2] < 0.2 * apart[0]


def test_a_bristle_loads_exponentially():
    march = DahlContact(HERTZ.stiffness).march(
        straight([0.0, 0.2, 0.7]), np.zeros((2, 1, 1)), 1e-12
    )
    expected = 1.0 - np.exp(-HERTZ.stiffness * np.array([0.0, 0.2, 0.7]))
    assert march.forces[:, 1] == pytest.approx(expected, rel=1e-13)
    # the initial stiffness is that of the half-space
    slope = (hertz.mindlin_force(1e-6) - hertz.mindlin_force(0.0)) / 1e-6
    assert slope == pytest.approx(HERTZ.stiffness, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("velocity", "amplitude"), [(0.05, 0.5), (0.5, 2.0), (2.0, 1.0)])
def test_a_bristle_solves_its_differential_equation(velocity, amplitude):
    result = microslip.solve("transverse", velocity, amplitude, model="dahl", tolerance=1e-4)

    def rate(phase, force):
        motion = np.array([velocity, amplitude * np.cos(phase)])
        return HERTZ.stiffness * (motion - np.hypot(*motion) * force)

    periods = 4 + int(2.0 / min(velocity, 1.0))
    times = np.linspace(0.0, 2 * np.pi, 4001) + 2 * np.pi * periods
    solved = solve_ivp(rate, (0.0, times[-1]), [1.0, 0.0], t_eval=times, rtol=1e-9, atol=1e-11)
    expected = np.trapezoid(solved.y[0], times) / (2 * np.pi)
    assert result.converged and abs(result.mu_macro - expected) <= result.mu_macro_error


def test_a_bristle_resists_no_infinitely_slow_motion():
    assert microslip.solve("transverse", 0.0, 0.1, model="dahl").mu_macro == 0.0
    slow = microslip.solve("transverse", 1e-4, 0.5, model="dahl")
    assert slow.converged and slow.mu_macro < 1e-3


@pytest.mark.parametrize("model", ["slider", "dahl", "mdr"])
def test_long_strokes_make_all_models_rigid(model):
    result = microslip.solve("transverse", 20.0, 60.0, model=model)
    expected = paper.large_amplitude_transverse(20.0, 60.0)
    assert result.converged and result.mu_macro == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("model", ["dahl", "mdr"])
def test_what_has_no_extension_cannot_turn(model):
    for motion, amplitude in (("bore", 1.0), ("continuous-bore", None)):
        with pytest.raises(ValueError, match="model"):
            microslip.solve(motion, 0.5, amplitude, model=model)


def test_full_slip_carries_the_whole_friction():
    for contact in (mdr_contact(7, 0.6), DahlContact(HERTZ.stiffness)):
        ones = np.ones((1, len(contact.bound)))
        full_slip = np.stack([ones, 0.0 * ones]) * contact.bound
        assert forces(contact, full_slip)[0] == pytest.approx(1.0)
