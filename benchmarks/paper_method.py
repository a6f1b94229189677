"""Measure the time of the paper's method, and of a point with an error estimate, on one core.

    python benchmarks/paper_method.py [--steps N] [--repeats N] [--markdown FILE]

The paper's method (R. Pohrt, Front. Mech. Eng. 6:566440, 2020) uses 32 x 32 squares, backward
Euler, up to 8,000 time steps from full forward slip, and a stress tolerance of 0.1 %. Here a period
has 100 steps. Each step is solved until the residual of Coulomb's law is 0.1 % of the total
friction. The result is the mean over the last period. The certified point is ``microslip.solve``
with an error of at most 1e-3. Both are compiled before timing, and they run alternately. The times
are medians.
"""

from __future__ import annotations

import one_thread  # isort: split

import time
from statistics import median

import tables

import microslip
from microslip.contact.contact import forward_slip
from microslip.contact.squares import CartesianContact
from microslip.periodic.methods.paper import (
    CELLS,
    STEPS,
    STEPS_PER_PERIOD,
    STRESS_TOLERANCE,
    last_means,
    path_of,
)
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

POINTS = [("transverse", 0.5), ("bore", 1.0)]
"""Motion and amplitude."""
VELOCITY = 0.005
TOLERANCE = 1e-3
"""Absolute tolerance of the friction of the certified point."""


def timed(function):
    """Return the result and the wall time (s) of one call."""
    started = time.perf_counter()
    result = function()
    return result, time.perf_counter() - started


def compare(name, amplitude, steps, repeats):
    """Return one row of the table. The two methods run alternately, ``repeats`` times."""
    contact = CartesianContact(CELLS)
    motion = Problem(motion_named(name), VELOCITY, amplitude, 0.0)
    path, start = path_of(motion, steps), forward_slip(contact)

    def paper():
        return contact.march(path, start, STRESS_TOLERANCE)

    def certified():
        return microslip.solve(name, VELOCITY, amplitude, tolerance=TOLERANCE)

    contact.march(path_of(motion, 4), start, STRESS_TOLERANCE)
    certified()
    march_times, point_times = [], []
    for _ in range(repeats):
        march, seconds = timed(paper)
        march_times.append(seconds)
        point, seconds = timed(certified)
        point_times.append(seconds)
    step, certified_time = median(march_times) / steps, median(point_times)
    return {
        "motion": name,
        "amplitude": amplitude,
        "velocity": VELOCITY,
        "steps timed": steps,
        f"s for {STEPS:,} steps": step * STEPS,
        "ms a step": 1e3 * step,
        "iterations a step": march.iterations / steps,
        "certified point, ms": 1e3 * certified_time,
        "ratio": step * STEPS / certified_time,
        "mu, paper's method": last_means(march)[0],
        "mu, certified": point.mu_macro,
        "its error estimate": point.mu_macro_error,
        "converged?": "yes" if point.converged else f"no: {point.reason}",
    }


def shown(value):
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def markdown(rows):
    """Return a transposed Markdown table with one column for each point."""
    lines = ["| " + " | ".join([key, *(shown(row[key]) for row in rows)]) + " |" for key in rows[0]]
    return "\n".join([lines[0], "|---" * (len(rows) + 1) + "|", *lines[1:]])


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--steps", type=int, default=STEPS, help="number of time steps")
    parser.add_argument("--repeats", type=int, default=7)
    args = parser.parse_args()
    if args.steps < STEPS_PER_PERIOD or args.repeats < 1:
        parser.error(f"at least {STEPS_PER_PERIOD} steps (one period) and one repeat")
    one_thread.stay_on_one_core()
    rows = [compare(motion, amplitude, args.steps, args.repeats) for motion, amplitude in POINTS]
    table = markdown(rows)
    if args.steps < STEPS:
        table += (
            f"\n\nOnly {args.steps:,} steps were marched; the time for {STEPS:,} is scaled from"
            " them, and the friction need not be periodic yet."
        )
    tables.publish(table, args)


if __name__ == "__main__":
    main()
