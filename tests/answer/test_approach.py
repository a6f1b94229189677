"""Friction at small velocities approaches the exact static limit, and not that of the paper.

No number is computed at velocity 0.  Every number is the mean force of a periodic state,
extrapolated in the rings, with an error from coarser rings and steps.

The slip of the oscillation alone grows with the power 3/2 of the distance from the stick radius.
So the drift matters in a layer of width velocity^(2/3), and the excess over the limit has the same
exponent.  Measured exponents of the transverse motion at the amplitudes 0.25, 0.5 and 0.75: 0.63,
0.67 and 0.69 below velocity 1e-3, rising to 0.70, 0.70 and 0.72 above 1e-5.  Bore: 0.72 to 0.76.
"""

import numpy as np
import pytest

from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem
from microslip.theory import paper

# motion, amplitude, fastest velocity; rings, angles and steps; error; exponents
CASES = [
    ("transverse", 0.25, 1e-3, (32, 1, 64), 1.5e-4, (0.6, 0.75)),
    ("transverse", 0.75, 1e-3, (32, 1, 64), 1.5e-4, (0.6, 0.75)),
    ("bore", 1.0, 1e-2, (16, 8, 32), 4e-4, (0.68, 0.8)),
]
LIMITS = {
    "transverse": ("radial", paper.static_limit_transverse, paper.static_transverse),
    "bore": ("polar", paper.static_limit_bore, paper.static_bore),
}
"""Model, exact limit, and formula of the paper."""


def means(motion, model, amplitude, velocities, *resolution):
    """Mean forces at decreasing velocities; each search starts from the state before."""
    runs = [None]
    for velocity in velocities:
        problem = Problem(motion_named(motion), velocity, amplitude, 0.0)
        runs.append(simulate(problem, model, Resolution(*resolution), 1e-6, runs[-1]))
        assert runs[-1].converged, f"{velocity}: {runs[-1].reason}"
    return np.array([run.mu for run in runs[1:]])


@pytest.mark.long
@pytest.mark.parametrize(("motion", "amplitude", "fastest", "sizes", "largest", "powers"), CASES)
def test_marches_fall_to_the_closed_form(motion, amplitude, fastest, sizes, largest, powers):
    model, limit, printed = LIMITS[motion]
    velocities, (rings, angles, steps) = fastest * 10.0 ** -np.arange(0.0, 2.5, 0.5), sizes
    coarse, fine, rough = (
        means(motion, model, amplitude, velocities, *resolution)
        for resolution in (sizes, (2 * rings, angles, steps), (rings, angles, steps // 2))
    )
    beyond = (fine - coarse) / 3.0
    mu, error = fine + beyond, np.abs(beyond) + np.abs(coarse - rough) + 1e-6
    excess = mu - float(limit(amplitude))
    assert error.max() < largest
    assert np.all(excess > 5 * error) and np.all(np.diff(mu) < 0.0)
    exponents = np.diff(np.log(excess)) / np.diff(np.log(velocities))
    assert powers[0] < exponents.min() and exponents.max() < powers[1]
    # the limit of a sequence with geometric differences, which assumes a constant exponent
    first, second, third = mu[-3:]
    found = (first * third - second**2) / (first + third - 2.0 * second)
    slack = 0.05 * excess[-1] if motion == "transverse" else 0.0
    assert abs(found - float(limit(amplitude))) <= error.max() + slack
    assert abs(found - float(printed(amplitude))) > 100 * error.max()
