"""Measure the friction error for each number of angles (rotations, translations at nu > 0).

    python benchmarks/angles.py [--points N] [--markdown FILE]

Random points of several motions and pressures are solved with few and with many angles, with the
same rings and steps. The table has one row for each motion, with the largest friction difference
for each number of angles on half the disc.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split


import numpy as np
import tables

from microslip.periodic.discretise import Resolution
from microslip.periodic.run import Settings
from microslip.periodic.simulate import simulate
from microslip.periodic.static_limit import edge_focus
from microslip.scene.by_name import motion_named, pressure_named
from microslip.scene.problem import Problem

LOADED = "normal:lateral=0.9,phase=90"
MOTIONS = ("transverse", "longitudinal", "elliptic", "zigzag", LOADED, "bore")
PRESSURES = ("hertz", "ring", "power:exponent=8")
ANGLES, MANY = (4, 6, 8, 12, 16, 24), 32
RINGS, STEPS = 16, 24
DISTANCE = 1e-7
"""Largest distance of a run from its periodic state."""


def differences(motion: str, place: tuple, poisson: float, pressure: str) -> list[float]:
    """Return the friction with each of ANGLES minus that with MANY, at (velocity, amplitude)."""
    problem = Problem(motion_named(motion), *place, poisson, pressure_named(pressure))
    settings = Settings(focus=edge_focus(problem, "polar"))
    steps = round(STEPS * max(problem.stroke, 1.0) ** 0.5)
    mu = [
        simulate(problem, "polar", Resolution(RINGS, angles, steps), DISTANCE, settings=settings).mu
        for angles in (*ANGLES, MANY)
    ]
    return [one - mu[-1] for one in mu[:-1]]


def main() -> None:
    """Solve all points and print the table."""
    parser = tables.parser_of(__doc__)
    parser.add_argument("--points", type=int, default=12, help="number of points of each motion")
    options = parser.parse_args()
    random, rows = np.random.default_rng(1), []
    for motion in MOTIONS:
        loads, rotates = motion_named(motion).loads, motion_named(motion).rotates
        worst = np.zeros(len(ANGLES))
        for k in range(options.points):
            place = (
                10 ** random.uniform(-3.0, 0.2),
                10 ** random.uniform(-0.5, -0.05 if loads else 1.0),
            )
            pressure = "hertz" if loads else PRESSURES[k % len(PRESSURES)]
            poisson = 0.0 if rotates else (0.3, 0.5)[k % 2]
            errors = differences(motion, place, poisson, pressure)
            worst = np.maximum(worst, np.abs(errors))
        rows.append({"motion": motion})
        rows[-1] |= {str(n): f"{one:.0e}" for n, one in zip(ANGLES, worst, strict=True)}
        print(rows[-1], flush=True)
    heading = "Each entry is the largest difference between the friction and its value with"
    text = f"{heading} {MANY} angles, at {options.points} random points of the motion.\n\n"
    tables.publish(text + tables.markdown(rows), options)


if __name__ == "__main__":
    main()
