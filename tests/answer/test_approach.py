"""Friction at small velocities approaches the static limit.

No number is computed at velocity 0.  Every number is the mean force of a periodic state,
extrapolated in the rings, with an error from coarser rings and steps.

The slip of the oscillation alone grows with the power 3/2 of the distance from the stick radius.
So the drift matters in a layer of width velocity^(2/3), and the excess over the limit has the same
exponent.  Measured exponents of the transverse motion at the amplitudes 0.25, 0.5 and 0.75: 0.63,
0.67 and 0.69 below velocity 1e-3, rising to 0.70, 0.70 and 0.72 above 1e-5.  Bore: 0.72 to 0.76.
"""

from functools import cache

import numpy as np
import pytest

from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem
from microslip.theory import paper

SLOW = tuple(10.0 ** -np.array([3.0, 3.5, 4.0, 4.5, 5.0]))


def ladder(motion, model, amplitude, velocities, resolution):
    """Mean forces at decreasing velocities; each search starts from the state before."""
    means, guess = [], None
    for velocity in velocities:
        problem = Problem(motion_named(motion), velocity, amplitude, 0.0)
        run = simulate(problem, model, resolution, 1e-6, guess)
        assert run.converged, f"{velocity}: {run.reason}"
        means.append(run.mu)
        guess = run
    return np.array(means)


@cache
def marched(motion, amplitude, velocities):
    """(mu, error) at each velocity, extrapolated in the rings; computed once for all tests."""
    model, rings, angles, steps = {
        "transverse": ("radial", 32, 1, 64),
        "bore": ("polar", 16, 8, 32),
    }[motion]
    coarse, fine, rough = (
        ladder(motion, model, amplitude, velocities, Resolution(*resolution))
        for resolution in [
            (rings, angles, steps),
            (2 * rings, angles, steps),
            (rings, angles, steps // 2),
        ]
    )
    beyond = (fine - coarse) / 3.0
    return fine + beyond, np.abs(beyond) + np.abs(coarse - rough) + 1e-6


def free_limit(means):
    """Limit of a sequence with geometric differences, from its last three values."""
    first, second, third = means[-3:]
    return (first * third - second**2) / (first + third - 2.0 * second)


def exponents(velocities, excess):
    return np.diff(np.log(excess)) / np.diff(np.log(velocities))


@pytest.mark.long
@pytest.mark.parametrize("amplitude", [0.25, 0.5, 0.75])
def test_transverse_marches_fall_to_the_closed_form(amplitude):
    mu, error = marched("transverse", amplitude, SLOW)
    exact = float(paper.static_limit_transverse(amplitude))
    assert error.max() < 1.5e-4
    excess = mu - exact
    # free_limit assumes a constant exponent
    assert abs(free_limit(mu) - exact) <= error.max() + 0.05 * excess[-1]
    assert np.all(excess > 5 * error) and np.all(np.diff(mu) < 0.0)
    result = exponents(SLOW, excess)
    assert result.min() > 0.6 and result.max() < 0.75
    assert np.all(np.diff(result) > 0.0)
    # the limit differs from Eq 11 of the paper
    assert abs(free_limit(mu) - float(paper.static_transverse(amplitude))) > 100 * error.max()


@pytest.mark.long
def test_bore_marches_fall_to_the_closed_form():
    velocities = tuple(10.0 ** -np.array([2.0, 2.5, 3.0, 3.5, 4.0]))
    mu, error = marched("bore", 1.0, velocities)
    exact = float(paper.static_limit_bore(1.0))
    assert error.max() < 4e-4
    assert abs(free_limit(mu) - exact) <= error.max()
    excess = mu - exact
    assert np.all(excess > 5 * error) and np.all(np.diff(mu) < 0.0)
    result = exponents(SLOW, excess)
    assert result.min() > 0.68 and result.max() < 0.8
    assert abs(free_limit(mu) - float(paper.static_bore(1.0))) > 100 * error.max()
