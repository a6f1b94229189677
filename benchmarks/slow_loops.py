"""Do the claimed errors of slow loops hold, under pressures with steep edges and none?

    python benchmarks/slow_loops.py [--points N] [--seed S] [--workers W]
                                    [--output FILE] [--markdown FILE]

Random motions on a loop, of up to three cycles along and across, under seven pressures, half of
them at amplitudes at which the stick zone is small: there few rings and steps agree by chance.  The
reference is a run on many rings with many steps, and what it leaves open is how far it lies from
one on two thirds of them.  Where that is too far to judge a claim, a third run has more of both.

Results go to a file of JSON lines, point by point, and an interrupted run goes on where it stopped.
"""

from __future__ import annotations

import one_thread  # noqa: F401

# isort: split

import argparse
import time
from pathlib import Path

import numpy as np
import resumable
import tables

import microslip

PRESSURES = (
    *("hertz", "power:exponent=1", "power:exponent=8", "power:exponent=30"),
    *("punch", "punch:flat=0.95", "ring"),
)
CYCLES = ((1, 1), (1, 1), (2, 1), (1, 2), (3, 1), (3, 2))
PHASES = (0, 10, 30, 45, 60, 90, 120)
VELOCITIES = -4.5, -1.0
"""Decimal logarithms."""
SMALL_STICK_ZONES = 0.55, 1.1
"""Amplitudes."""
TOLERANCES = (1e-2, 5e-3, 2e-3)
FINER = (32, 64), (48, 96), (64, 192)
"""Rings, and steps in a cycle, of the runs of a reference."""
TOO_FAR = 0.3
"""Share of the smallest tolerance beyond which two references are too far apart."""


def drawn(seed: int, k: int) -> tuple[dict, int]:
    """Point k of a seed, as arguments of `microslip.solve`, and its cycles in a period."""
    draw = np.random.default_rng([seed, k])
    forward, lateral = CYCLES[draw.integers(len(CYCLES))]
    share, phase = round(float(draw.uniform(0.2, 1.0)), 2), int(draw.choice(PHASES))
    path = f"forward={share},phase={phase},forward_cycles={forward},lateral_cycles={lateral}"
    small = draw.random() < 0.5
    amplitude = draw.uniform(*SMALL_STICK_ZONES) if small else 10.0 ** draw.uniform(-1.0, 0.3)
    point = {
        "motion": f"elliptic:{path}",
        "pressure": str(draw.choice(PRESSURES)),
        "velocity": float(f"{10.0 ** draw.uniform(*VELOCITIES):.4g}"),
        "amplitude": float(f"{amplitude:.4g}"),
    }
    return point, max(forward, lateral)


def examine(seed: int, k: int) -> dict:
    """One line of the output: the point, its reference, and a claim at each tolerance."""
    point, cycles = drawn(seed, k)
    found = []
    for cells, steps in FINER:
        if len(found) == 2 and abs(found[1] - found[0]) <= TOO_FAR * min(TOLERANCES):
            break
        run = microslip.solve(**point, tolerance=None, cells=cells, steps=steps * cycles)
        found.append(run.mu_macro if run.periodic else np.nan)
    claims = []
    for tolerance in TOLERANCES:
        begun = time.process_time()
        result = microslip.solve(**point, tolerance=tolerance)
        claims.append(
            {
                "tolerance": tolerance,
                "mu": result.mu_macro,
                "error": result.mu_macro_error,
                "converged": result.converged,
                "seconds": round(time.process_time() - begun, 3),
            }
        )
    left = abs(found[-1] - found[-2])
    return {"k": k, **point, "reference": found[-1], "uncertainty": left, "claims": claims}


def summary(lines: list[dict]) -> str:
    """Markdown table by tolerance, and what does not hold."""
    rows, missed = [], []
    for tolerance in TOLERANCES:
        row, of = _judged(lines, tolerance)
        rows.append(row)
        missed += of
    return "\n".join([tables.markdown(rows), *missed]) + "\n"


def _judged(lines, tolerance):
    """Row of the table for one tolerance, and sentences on what does not hold."""
    ratios, offs, seconds, open_, missed, converged = [], [], [], 0, [], 0
    for line in lines:
        claim = next(one for one in line["claims"] if one["tolerance"] == tolerance)
        seconds.append(claim["seconds"])
        converged += claim["converged"]
        off = abs(claim["mu"] - line["reference"])
        if not claim["converged"]:
            continue
        if not abs(off - claim["error"]) >= line["uncertainty"]:  # or the reference is NaN
            open_ += 1
            continue
        ratios.append(off / claim["error"])
        offs.append(off / tolerance)
        if ratios[-1] > 1.0:
            missed.append(
                f"\nDoes not hold: {line['motion']} under {line['pressure']}, velocity"
                f" {line['velocity']:g}, amplitude {line['amplitude']:g} at {tolerance:g}: error"
                f" {off:.1e} (+- {line['uncertainty']:.0e}), claimed {claim['error']:.1e}."
            )
    return {
        "tolerance": f"{tolerance:g}",
        "number": len(lines),
        "converged": converged,
        "not decided": open_,
        "do not hold": len(missed),
        "error / claim: median": f"{np.median(ratios):.2f}",
        "99 %": f"{np.quantile(ratios, 0.99):.2f}",
        "largest": f"{max(ratios):.2f}",
        "largest error / tolerance": f"{max(offs):.2f}",
        "median seconds": f"{np.median(seconds):.2f}",
    }, missed


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--output", type=Path, help="results/slow-loops-SEED.jsonl unless given")
    tables.add_markdown(parser)
    options = parser.parse_args()
    output = options.output or Path(f"results/slow-loops-{options.seed}.jsonl")
    output.parent.mkdir(parents=True, exist_ok=True)
    lines = {line["k"]: line for line in tables.parsed(output)}
    resumable.add_lines(
        output, lines, range(options.points), lambda k: (examine, options.seed, k), options.workers
    )
    tables.publish(summary([lines[k] for k in range(options.points)]), options)


if __name__ == "__main__":
    main()
