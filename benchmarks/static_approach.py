"""Measure how friction approaches its static limit at decreasing velocities.

    python benchmarks/static_approach.py [--tolerance T] [--markdown FILE]

The table has a row for each motion (transverse and bore, nu = 0) and amplitude. It lists the closed
form of the limit, and the excess of mu_macro over this limit at each velocity. The last column is
the range of the local exponent p in excess ~ velocity^p between neighbouring velocities. An excess
that is not much larger than its error estimate is left out. Smaller tolerances show the exponent
at smaller velocities.
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
"""An exponent counts if the excess is at least this many times its error estimate."""


def exponent(points, limit):
    """Return the exponent between the last two points, or None if uncertain (see CERTAIN)."""
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


def row(motion, amplitude, tolerance):
    """Return the row of the table for a motion and an amplitude."""
    limit = float(FORMS[motion][STATIC].function(amplitude))
    cells = {"motion": motion, "amplitude": f"{amplitude:g}", "limit": f"{limit:.6f}"}
    points, exponents = [], []
    for velocity in VELOCITIES:
        point = microslip.solve(motion, velocity, amplitude, tolerance=tolerance)
        points.append(point)
        seconds = f"{point.solve_time_s:.1f} s {point.reason}"
        print(f"{motion} {amplitude:g} at {velocity:g}: {seconds}", file=sys.stderr, flush=True)
        excess = f"{point.mu_macro - limit:.2e}" if point.converged else "not converged"
        cells[f"excess at {velocity:g}"] = excess
        exponents.append(exponent(points, limit))
    local = [one for one in exponents if one is not None]
    return cells | {"exponent": f"{min(local):.2f} to {max(local):.2f}" if local else ""}


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--tolerance", type=float, default=1e-4)
    options = parser.parse_args()
    rows = [
        row(motion, amplitude, options.tolerance)
        for motion, amplitudes in AMPLITUDES.items()
        for amplitude in amplitudes
    ]
    text = "The excess is mu_macro minus its limit at velocity 0. The error estimate of mu_macro is"
    text += f" at most {options.tolerance:g}.\n\n{tables.markdown(rows)}"
    tables.publish(text, options)


if __name__ == "__main__":
    main()
