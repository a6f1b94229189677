"""Approach of friction to its static limit at decreasing velocities.

    python benchmarks/static_approach.py [--tolerance T] [--markdown FILE]

There is a table for each motion (transverse and bore, nu = 0) and amplitude. It lists the velocity,
mu_macro, the error estimate, and the excess over the closed form of the limit. The last column is
the local exponent p in excess ~ velocity^p, between a velocity and the next larger velocity. It is
empty where an excess is not much larger than its error estimate. Smaller tolerances show the
exponent at smaller velocities.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import math
import sys

import tables

import microslip
from microslip.datasets.catalogue import FORMS, STATIC

VELOCITIES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
AMPLITUDES = {"transverse": (0.25, 0.5, 0.75), "bore": (0.5, 1.0, 2.0)}
CERTAIN = 5.0
"""An exponent is printed if the excess is at least this many times its error estimate."""


def exponent(points, limit):
    """Local exponent between the last two points, or None if it is uncertain, see CERTAIN."""
    if len(points) < 2:
        return None
    excess = [point.mu_macro - limit for point in points[-2:]]
    certain = all(
        point.converged and over > CERTAIN * point.mu_macro_error
        for point, over in zip(points[-2:], excess, strict=True)
    )
    if not certain:
        return None
    return math.log(excess[0] / excess[1]) / math.log(points[-2].velocity / points[-1].velocity)


def table(motion, amplitude, tolerance):
    """Markdown lines of the table for a motion and an amplitude."""
    limit = float(FORMS[motion][STATIC].function(amplitude))
    lines = [f"{motion}, amplitude {amplitude:g}: closed form of the limit {limit:.6f}", ""]
    lines += [
        "| velocity | mu_macro | error estimate | excess | exponent |",
        "|---|---|---|---|---|",
    ]
    points = []
    for velocity in VELOCITIES:
        point = microslip.solve(motion, velocity, amplitude, tolerance=tolerance)
        points.append(point)
        seconds = f"{point.solve_time_s:.1f} s {point.reason}"
        print(f"{motion} {amplitude:g} at {velocity:g}: {seconds}", file=sys.stderr, flush=True)
        if not point.converged:
            lines.append(f"| {velocity:g} | not converged: {point.reason} | | | |")
            continue
        local = exponent(points, limit)
        lines.append(
            f"| {velocity:g} | {point.mu_macro:.6f} | {point.mu_macro_error:.1e} "
            f"| {point.mu_macro - limit:.2e} | {'' if local is None else f'{local:.2f}'} |"
        )
    return lines


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--tolerance", type=float, default=1e-4)
    options = parser.parse_args()
    lines = []
    for motion, amplitudes in AMPLITUDES.items():
        for amplitude in amplitudes:
            lines += [*table(motion, amplitude, options.tolerance), ""]
    tables.publish("\n".join(lines), options)


if __name__ == "__main__":
    main()
