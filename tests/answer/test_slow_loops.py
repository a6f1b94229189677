"""Slow loops, whose coarse levels agree by chance, against fine resolutions."""

import pytest

import microslip

SHARP = "punch:flat=0.95"
# motion, pressure, velocity, amplitude, cells and steps of a reference
OFF = [
    ("forward=0.97,phase=90,forward_cycles=2", SHARP,
     0.00022886554043705838, 0.9254990785352156, 24, 512),
    ("forward=0.44,phase=60,forward_cycles=2", "power:exponent=30",
     7.71668330440097e-05, 0.6332575478397949, 64, 256),
    ("forward=0.59,phase=10,forward_cycles=2", SHARP,
     0.0005260909952791848, 0.9504824781053628, 96, 256),
    ("forward=0.81,phase=0", "power:exponent=30",
     0.0005146847055429344, 0.7300692973793619, 64, 128),
]  # fmt: skip


@pytest.mark.parametrize(("path", "pressure", "velocity", "amplitude", "cells", "steps"), OFF)
def test_errors_are_covered_where_few_rings_and_steps_agree_by_chance(
    path, pressure, velocity, amplitude, cells, steps
):
    point = {"velocity": velocity, "amplitude": amplitude, "pressure": pressure}
    many = microslip.solve(f"elliptic:{path}", **point, tolerance=None, cells=cells, steps=steps)
    for tolerance in (1e-2, 5e-3):
        answer = microslip.solve(f"elliptic:{path}", **point, tolerance=tolerance)
        assert answer.converged
        assert abs(answer.mu_macro - many.mu_macro) <= answer.mu_macro_error


def test_a_slow_loop_that_lost_what_it_takes_long_to_gain_is_not_periodic():
    """Under a wide tolerance the search once ended at a force of 0.015 instead of 0.114."""
    motion = "elliptic:forward=0.73,phase=90,forward_cycles=3,lateral_cycles=2"
    point = {
        "velocity": 0.00013964177566075554,
        "amplitude": 0.7675388662707612,
        "pressure": "punch:flat=0.8",
    }
    many = microslip.solve(motion, **point, tolerance=None, cells=24, steps=288)
    answer = microslip.solve(motion, **point, tolerance=0.1)
    assert abs(answer.mu_macro - many.mu_macro) <= answer.mu_macro_error < 0.1
