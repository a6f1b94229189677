"""Runs that start from coarser runs, and a rotation that converges slowly."""

import math

import numpy as np
import pytest

import microslip
from microslip.contact.contact import forward_slip, full_slip
from microslip.periodic.discretise import Resolution, contact_of
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

BORE = Problem(motion_named("bore"), 0.3, 1.0, 0.0)


@pytest.mark.slow
def test_few_rings_that_converge_slowly_are_refined():
    """From 8 to 16 rings the error of this bore falls at first order only.  Separate refinements
    from 24 to 96 rings give 0.34733."""
    result = microslip.solve("bore", 0.11150298626945476, 3.3085697949922066)
    assert result.converged
    assert result.mu_macro == pytest.approx(0.34733, abs=result.mu_macro_error)


# Tractions on other points


def contact(cells, angles):
    return contact_of(BORE, "polar", Resolution(cells, angles, 8))


def test_full_slip_stays_full_slip_on_finer_points():
    coarse, fine = contact(8, 6), contact(24, 16)
    np.testing.assert_allclose(
        fine.prolonged(forward_slip(coarse)), forward_slip(fine), rtol=0.0, atol=1e-14
    )


def test_turning_slip_is_interpolated_between_angles():
    coarse, fine = contact(8, 6), contact(24, 16)
    settings, expected = (
        full_slip(one, one.lateral_position, -one.forward_position) for one in (coarse, fine)
    )
    # linear interpolation on a circle has an error of an eighth of the squared angle
    off = np.abs(fine.prolonged(settings) - expected) / fine.bound
    assert 0.0 < off.max() <= (math.pi / 6) ** 2 / 8.0


def test_a_run_from_a_coarser_one_ends_where_it_would_by_itself():
    fine = Resolution(24, 8, 16)
    coarse = simulate(BORE, "polar", Resolution(8, 6, 12), 1e-6)
    alone, led = (simulate(BORE, "polar", fine, 1e-6, guess) for guess in (None, coarse))
    assert alone.converged and led.converged and led.effort.iterations < alone.effort.iterations
    assert led.mu == pytest.approx(alone.mu, abs=2e-6)
