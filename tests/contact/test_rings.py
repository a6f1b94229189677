"""Steps and marches on rings against results of an independent solver."""

import numpy as np
import pytest
from contact.test_models import larger_residual

from microslip.contact.contact import coulomb_residual, energy_norm, forward_slip, project
from microslip.contact.path import EULER, SDIRK2, half_period_phases, make_path
from microslip.contact.reduced import slider_contact
from microslip.contact.ring_contact import RadialContact
from microslip.scene.named import Transverse


def half_period(velocity, amplitude, steps, integrator=SDIRK2):
    def displacement(phase):
        return Transverse().displacement(phase, velocity, amplitude, 0.0)

    return make_path(displacement, half_period_phases(steps), integrator)


def some_state(contact, seed, share=1.0):
    q = np.random.default_rng(seed).normal(size=(2, 1, len(contact.bound)))
    return share * project(q * contact.bound, contact.bound)


@pytest.mark.parametrize("cells", [1, 5, 16, 48])
def test_every_stage_obeys_coulomb_to_the_tolerance(cells):
    contact = RadialContact.resolved(cells, 0.7) if cells > 1 else slider_contact()
    for tolerance in (1e-4, 1e-8, 1e-12):
        path = half_period(0.05, 0.8, 10, EULER)
        march = contact.march(path, some_state(contact, 1), tolerance)
        assert march.residual <= march.solves * tolerance
        bound = contact.bound
        tractions = project(np.moveaxis(march.fields[:, :, 0], 1, 0), bound)
        stages = np.moveaxis(tractions, 1, 0)
        moves = np.diff(path.positions[:, :2], axis=0)
        for before, after, move in zip(stages, stages[1:], moves, strict=False):
            slip = move[:, None] - (after - before) @ contact.influence.T
            left = coulomb_residual(
                after[:, None], slip[:, None], bound, contact.weight, contact.compliance
            )
            assert left <= larger_residual(contact) * tolerance + 1e-14


def test_another_march_as_first_guess_changes_the_effort_only():
    contact, tolerance = RadialContact.resolved(12, 0.7), 1e-12
    path = half_period(0.02, 0.5, 16)
    start = contact.march(path, forward_slip(contact), tolerance).state
    near = contact.march(path, 0.999 * start, tolerance)
    alone = contact.march(path, start, tolerance)
    for previous in (near, alone):
        led = contact.march(path, start, tolerance, previous=previous)
        assert led.iterations < alone.iterations
        assert energy_norm(contact, led.state - alone.state) < 1e-9
    other = contact.march(half_period(0.02, 0.5, 12), start, tolerance)  # other steps
    assert np.array_equal(contact.march(path, start, tolerance, previous=other).state, alone.state)
