"""The method of the paper: 8,000 backward Euler steps on 32 x 32 squares.

The time integration starts from full slip. There is no search for the periodic state.

In the paper, stresses are accurate to 0.1 %. The result of the paper is the mean over the last
period.  In this module, a period has 100 steps, and a step is solved when its residual is at most
0.1 % of the total friction.  The requested resolution is ignored.

Paper: R. Pohrt, Front. Mech. Eng. 6:566440, 2020.
"""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import FORWARD, March, forward_slip
from microslip.contact.path import EULER, Path, make_path
from microslip.contact.squares import CartesianContact
from microslip.periodic.discretise import Resolution
from microslip.periodic.method import Method
from microslip.periodic.run import Effort, Run
from microslip.scene.problem import Problem

CELLS, STEPS_PER_PERIOD = 32, 100
STEPS = 8000
STRESS_TOLERANCE = 1e-3


def path_of(problem: Problem, steps: int = STEPS) -> Path:
    """Return a path with the given number of steps.

    The path starts in the middle of a stroke.
    """
    phase = 2.0 * np.pi / STEPS_PER_PERIOD * np.arange(steps + 1)
    return make_path(problem.displacement, phase, EULER)


def last_means(march: March) -> tuple[float, float]:
    """Return two mean forward forces: over the last period, and over the second-to-last period."""
    force = march.forces[1:, FORWARD]
    last, before = force[-STEPS_PER_PERIOD:], force[-2 * STEPS_PER_PERIOD : -STEPS_PER_PERIOD]
    return float(last.mean()), float(before.mean())


def _run(problem: Problem, model: str, resolution: Resolution, tolerance: float) -> Run:
    contact = CartesianContact(CELLS, problem.poisson, problem.pressure)
    march = contact.march(path_of(problem), forward_slip(contact), STRESS_TOLERANCE)
    mean, before = last_means(march)
    effort = Effort.of(march.solves, march.iterations, march.state.size)
    periods = STEPS / STEPS_PER_PERIOD
    return Run({"friction": mean}, abs(mean - before), march.residual, periods, effort)


METHOD = Method(
    "the paper's run: squares, 8,000 steps of backward Euler",
    run=_run,
    model="cartesian",
    resolution=(32, 1, 100),
)
