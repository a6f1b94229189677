"""Measure iterations and CPU time of a backward Euler step on meshes of several sizes.

    python benchmarks/step_cost.py

The integration starts from full slip and covers half a period at velocity 0.1 and amplitude 1. The
motion is transverse for rings and bore for all other models.
"""

import time
from statistics import median

from microslip.contact.contact import forward_slip
from microslip.contact.path import EULER, make_path, phases_between
from microslip.periodic.discretise import Resolution, contact_of
from microslip.scene.motion import HALF_PERIOD
from microslip.scene.named import Bore, Transverse
from microslip.scene.problem import Problem

SIZES = {
    "radial": [(n, 1) for n in (16, 32, 64, 128)],
    "polar": [(n, n) for n in (8, 16, 32)],
    "cartesian": [(n, 1) for n in (16, 32, 64, 128)],
}
STEPS, TOLERANCE = 16, 1e-6
"""Number of steps in half a period, and tolerance of a step as a force divided by mu F_z."""


def cost(model, cells, angles):
    """Return unknowns, iterations per step, and CPU seconds per step (median of three runs)."""
    problem = Problem(Transverse() if model == "radial" else Bore(), 0.1, 1.0)
    contact = contact_of(problem, model, Resolution(cells, angles, STEPS))
    path = make_path(problem.displacement, phases_between(HALF_PERIOD, STEPS), EULER)
    start = forward_slip(contact)
    contact.march(path, start, TOLERANCE)  # compiles
    times = []
    for _ in range(3):
        began = time.process_time()
        march = contact.march(path, start, TOLERANCE)
        times.append(time.process_time() - began)
    return march.state.size, march.iterations / march.solves, median(times) / march.solves


def main():
    print(f"{'model':10s}{'cells':>7s}{'unknowns':>10s}{'iterations':>12s}{'seconds':>10s}")
    for model, sizes in SIZES.items():
        for cells, angles in sizes:
            unknowns, iterations, seconds = cost(model, cells, angles)
            print(f"{model:10s}{cells:7d}{unknowns:10d}{iterations:12.1f}{seconds:10.1e}")


if __name__ == "__main__":
    main()
